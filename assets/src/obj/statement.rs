//! The statements of an OBJ file, read into lists in their order.

use std::io::BufRead;
use std::path::Path;

use mode13h::glam::{Vec2, Vec3};
use mode13h::mesh::Mesh;

use super::line::{Lines, keyword, name, number, numbers, shown, wide_numbers, words};
use super::{ObjError, ObjErrorKind};

/// Position, texture coordinates, normal, from 0; [`NONE`](Self::NONE) for one that was left out.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug)]
pub(super) struct Corner {
    pub(super) position: u32,
    pub(super) texcoord: u32,
    pub(super) normal: u32,
}

impl Corner {
    pub(super) const NONE: u32 = u32::MAX;
}

/// The statements of an OBJ file.
#[derive(Default)]
pub(super) struct Model {
    pub(super) positions: Vec<Vec3>,
    pub(super) texcoords: Vec<Vec2>,
    pub(super) normals: Vec<Vec3>,
    /// The corners of all faces in turn.
    pub(super) corners: Vec<Corner>,
    /// The number of corners of each face, three or more.
    pub(super) sizes: Vec<u32>,
    /// The line of each face; of those beyond 2³² the last number that fits.
    pub(super) lines: Vec<u32>,
    /// The first face of each run of one material, and the material's place in `names`.
    pub(super) runs: Vec<(usize, usize)>,
    /// The first face of each run of one smoothing group, and the group's number, or 0 for none. Before the first run
    /// the group is unknown.
    pub(super) smoothing: Vec<(usize, u32)>,
    /// The names of `usemtl`, each once, in order. The first is empty: that of faces before any `usemtl`.
    pub(super) names: Vec<String>,
    /// Line and text of each `mtllib`.
    pub(super) libraries: Vec<(u64, String)>,
    /// Line of the first `usemtl` of each name.
    pub(super) name_lines: Vec<u64>,
    /// The line of the first face of fewer than three corners, and the number of them. They are left out.
    pub(super) short: Option<(u64, usize)>,
    /// The line of the first vertex with a colour; 0 if there is none. Colours are left out.
    pub(super) colored: u64,
    /// The point of the file that lies at 0 in `positions`, if it is another.
    pub(super) middle: Option<[f64; 3]>,
}

/// Positions are kept about 0 if their middle is farther from it than this many times their half extent. Up to there f32
/// rounds them by less than 2⁻²⁰ of the extent, which is 1/256 pixel in the largest frame.
const FAR: f64 = 16.0;

/// Reads all lines.
pub(super) fn read(reader: impl BufRead, path: &Path) -> Result<Model, ObjError> {
    let mut model = Model { runs: vec![(0, 0)], names: vec![String::new()], name_lines: vec![0], ..Model::default() };
    let mut later = Later::default();
    let mut positions: Vec<Wide> = Vec::new();
    let mut known = std::collections::HashMap::from([(String::new(), 0)]);
    let mut lines = Lines::new(reader);
    while let Some((line, text)) = lines.next().map_err(|error| ObjError::of_file(path, ObjErrorKind::Read(error)))? {
        let (word, rest) = keyword(text);
        let result = match word {
            b"v" => {
                if model.colored == 0 && words(rest).nth(5).is_some() {
                    model.colored = line;
                }
                position(&mut positions, rest)
            }
            b"vt" => texcoord(&mut model, rest),
            b"vn" => normal(&mut model, rest),
            b"f" => face(&mut model, positions.len(), &mut later, line, rest),
            b"usemtl" => {
                let next = model.names.len();
                let number = *known.entry(name(rest)).or_insert_with_key(|name| {
                    model.names.push(name.clone());
                    model.name_lines.push(line);
                    next
                });
                model.runs.push((model.sizes.len(), number));
                Ok(())
            }
            b"s" => {
                if let Some(group) = group(rest) {
                    model.smoothing.push((model.sizes.len(), group));
                }
                Ok(())
            }
            b"mtllib" => {
                model.libraries.push((line, name(rest)));
                Ok(())
            }
            _ => foreign(word, text),
        };
        result.map_err(|kind| ObjError::of_line(path, line, kind))?;
    }
    later.check(positions.len(), &model).map_err(|(line, kind)| ObjError::of_line(path, line, kind))?;
    if model.sizes.is_empty() {
        return Err(ObjError::of_file(path, ObjErrorKind::NoFaces));
    }
    model.middle = far_middle(&positions, &model.corners);
    // In place, as a file may hold many.
    model.positions = positions.into_iter().map(|p| p.narrow(model.middle)).collect();
    Ok(model)
}

/// A position in some 48 bits: the nearest of f32, and what is left of each coordinate.
#[derive(Clone, Copy)]
struct Wide([f32; 3], [f32; 3]);

impl Wide {
    fn new(position: [f64; 3]) -> Self {
        let near = position.map(|c| c as f32);
        Self(near, [0, 1, 2].map(|axis| (position[axis] - f64::from(near[axis])) as f32))
    }

    fn get(self) -> [f64; 3] {
        [0, 1, 2].map(|axis| f64::from(self.0[axis]) + f64::from(self.1[axis]))
    }

    /// The position in f32, about another one if there is any.
    fn narrow(self, middle: Option<[f64; 3]>) -> Vec3 {
        let Some(middle) = middle else { return Vec3::from_array(self.0) };
        let position = self.get();
        Vec3::from_array([0, 1, 2].map(|axis| (position[axis] - middle[axis]) as f32))
    }
}

/// The middle of the positions that faces use, if it is [`FAR`] from 0.
fn far_middle(positions: &[Wide], corners: &[Corner]) -> Option<[f64; 3]> {
    let (mut low, mut high) = ([f64::MAX; 3], [f64::MIN; 3]);
    for corner in corners {
        for (axis, c) in positions[corner.position as usize].get().into_iter().enumerate() {
            (low[axis], high[axis]) = (low[axis].min(c), high[axis].max(c));
        }
    }
    let half = |axis: usize| (high[axis] - low[axis]) / 2.0;
    let extent = half(0).max(half(1)).max(half(2));
    let middle = [0, 1, 2].map(|axis| low[axis] + half(axis));
    middle.iter().any(|c| c.abs() > FAR * extent).then_some(middle)
}

/// One more, if there is room for it.
fn push<T>(list: &mut Vec<T>, value: T) -> Result<(), ObjErrorKind> {
    if list.len() >= Mesh::MAX_COUNT {
        return Err(ObjErrorKind::TooLarge("more than 1,431,655,765 of a kind"));
    }
    list.push(value);
    Ok(())
}

fn position(positions: &mut Vec<Wide>, rest: &[u8]) -> Result<(), ObjErrorKind> {
    push(positions, Wide::new(wide_numbers(&mut words(rest), "a position (3)")?))
}

fn texcoord(model: &mut Model, rest: &[u8]) -> Result<(), ObjErrorKind> {
    let mut words = words(rest);
    let [u] = numbers(&mut words, "texture coordinates (2)")?;
    let v = number(&mut words)?.unwrap_or(0.0);
    push(&mut model.texcoords, Vec2::new(u, v))
}

fn normal(model: &mut Model, rest: &[u8]) -> Result<(), ObjErrorKind> {
    push(&mut model.normals, Vec3::from_array(numbers(&mut words(rest), "a normal (3)")?))
}

/// The number of a smoothing group: 0 for `off`, 1 for `on`. Anything else is left alone.
fn group(rest: &[u8]) -> Option<u32> {
    match words(rest).next()? {
        b"off" => Some(0),
        b"on" => Some(1),
        // The greatest number stands for no group that is known.
        word => whole(word).and_then(|number| u32::try_from(number).ok()).filter(|&group| group < u32::MAX),
    }
}

/// A statement that is not for us, unless the file is no text at all.
fn foreign(word: &[u8], text: &[u8]) -> Result<(), ObjErrorKind> {
    let binary = |byte: &u8| *byte < b' ' && !matches!(byte, b'\t' | b'\r' | 0x0B | 0x0C | 0x1A);
    if !word.starts_with(b"#") && text.iter().any(binary) { Err(ObjErrorKind::NotText) } else { Ok(()) }
}

fn face(model: &mut Model, positions: usize, later: &mut Later, line: u64, rest: &[u8]) -> Result<(), ObjErrorKind> {
    let counts = [positions, model.texcoords.len(), model.normals.len()];
    let first = model.corners.len();
    for word in words(rest) {
        let mut indices = [Corner::NONE; 3];
        let mut parts = 0;
        for (kind, part) in word.split(|&byte| byte == b'/').enumerate() {
            parts += 1;
            if kind > 2 || (part.is_empty() && kind == 0) {
                return Err(ObjErrorKind::NotCorner(shown(word)));
            }
            if !part.is_empty() {
                let index = whole(part).ok_or_else(|| ObjErrorKind::NotCorner(shown(word)))?;
                indices[kind] = later.resolve(kind, index, counts[kind], line)?;
            }
        }
        debug_assert!(parts > 0);
        let [position, texcoord, normal] = indices;
        model.corners.push(Corner { position, texcoord, normal });
    }
    let size = model.corners.len() - first;
    if size < 3 {
        model.corners.truncate(first);
        model.short.get_or_insert((line, 0)).1 += 1;
        return Ok(());
    }
    if model.corners.len() > u32::MAX as usize {
        return Err(ObjErrorKind::TooLarge("more than 4,294,967,295 corners"));
    }
    if model.corners.len() - 2 * model.sizes.len() > Mesh::MAX_COUNT + 2 {
        return Err(ObjErrorKind::TooLarge("more than 1,431,655,765 triangles"));
    }
    // Fits by the lines above.
    model.sizes.push(size as u32);
    model.lines.push(u32::try_from(line).unwrap_or(u32::MAX));
    Ok(())
}

/// A whole number with an optional sign; `None` if it is none or does not fit.
fn whole(digits: &[u8]) -> Option<i64> {
    let (sign, digits) = match digits {
        [b'-', rest @ ..] => (-1, rest),
        [b'+', rest @ ..] => (1, rest),
        _ => (1, digits),
    };
    if digits.is_empty() {
        return None;
    }
    let mut value: i64 = 0;
    for &digit in digits {
        if !digit.is_ascii_digit() {
            return None;
        }
        value = value.checked_mul(10)?.checked_add(i64::from(digit - b'0'))?;
    }
    Some(sign * value)
}

/// Indices of what had not come yet: position, texture coordinates, normal. Whether it came is known
/// at the end. It is enough to keep each index that is greater than all before it: the first that
/// turns out too great is among them.
#[derive(Default)]
struct Later {
    records: [Vec<(i64, u64)>; 3],
}

const WHAT: [&str; 3] = ["vertex", "texture coordinate", "normal"];

impl Later {
    /// Counted from 0. `count`: how many there are so far.
    fn resolve(&mut self, kind: usize, index: i64, count: usize, line: u64) -> Result<u32, ObjErrorKind> {
        // `count` is at most `Mesh::MAX_COUNT`, see `push`.
        let from_zero = match index {
            0 => return Err(ObjErrorKind::IndexZero),
            1.. => index - 1,
            _ => count as i64 + index,
        };
        if from_zero < 0 || from_zero >= Mesh::MAX_COUNT as i64 {
            return Err(ObjErrorKind::IndexOutOfRange { what: WHAT[kind], index, count });
        }
        if from_zero >= count as i64 && self.records[kind].last().is_none_or(|&(greatest, _)| index > greatest) {
            self.records[kind].push((index, line));
        }
        // Below 2³¹ by the line above.
        Ok(from_zero as u32)
    }

    fn check(&self, positions: usize, model: &Model) -> Result<(), (u64, ObjErrorKind)> {
        let counts = [positions, model.texcoords.len(), model.normals.len()];
        let missing = (0..3).filter_map(|kind| {
            let count = counts[kind];
            let &(index, line) = self.records[kind].iter().find(|&&(index, _)| index > count as i64)?;
            Some((line, ObjErrorKind::IndexOutOfRange { what: WHAT[kind], index, count }))
        });
        missing.min_by_key(|&(line, _)| line).map_or(Ok(()), Err)
    }
}
