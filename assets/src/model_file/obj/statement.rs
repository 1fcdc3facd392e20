//! The statements of an OBJ file, read into lists in order.

use std::io::BufRead;
use std::path::Path;

use mode13h::glam::{Vec2, Vec3};
use mode13h::mesh::Mesh;

use super::line::{Lines, keyword, number, numbers};
use crate::model_file::lists::{Corner, Lists, Wide, push, reserve};
use crate::model_file::word::{name, shown, words};
use crate::model_file::{ModelFileError, ModelFileErrorKind, Place};

/// The statements of an OBJ file.
#[derive(Default)]
pub(super) struct Statements {
    /// Positions, faces and so on. Surface numbers are indices into `names`.
    pub(super) lists: Lists,
    /// The names in `usemtl`, each once, in order. The first is empty, for faces before any `usemtl`.
    pub(super) names: Vec<String>,
    /// The line and text of each `mtllib`.
    pub(super) libraries: Vec<(u64, String)>,
    /// The line of the first `usemtl` with each name.
    pub(super) name_lines: Vec<u64>,
    /// The line of the first vertex with a colour; 0 if there is none.
    pub(super) colored: u64,
    /// The colours of the first vertices, up to one that has none; usually in 0 to 1, in some files in 0 to 255.
    pub(super) colors: Vec<[f32; 3]>,
}

/// Reads all lines.
pub(super) fn read(reader: impl BufRead, path: &Path) -> Result<Statements, ModelFileError> {
    let mut model = Statements { names: vec![String::new()], name_lines: vec![0], ..Statements::default() };
    let mut later = Later::default();
    let mut known = std::collections::HashMap::from([(String::new(), 0)]);
    let mut lines = Lines::new(reader);
    while let Some((line, text)) =
        lines.next().map_err(|error| ModelFileError::of_file(path, ModelFileErrorKind::Read(error)))?
    {
        let (word, rest) = keyword(text);
        let result = match word {
            b"v" => vertex(&mut model, line, rest),
            b"vt" => texcoord(&mut model.lists, rest),
            b"vn" => normal(&mut model.lists, rest),
            b"f" => face(&mut model.lists, &mut later, line, rest),
            b"usemtl" => {
                let next = model.names.len();
                let number = *known.entry(name(rest)).or_insert_with_key(|name| {
                    model.names.push(name.clone());
                    model.name_lines.push(line);
                    next
                });
                model.lists.runs.push((model.lists.sizes.len(), number));
                Ok(())
            }
            b"s" => {
                if let Some(group) = group(rest) {
                    model.lists.smoothing.push((model.lists.sizes.len(), group));
                }
                Ok(())
            }
            b"mtllib" => {
                model.libraries.push((line, name(rest)));
                Ok(())
            }
            _ => foreign(word, text),
        };
        result.map_err(|kind| ModelFileError::of_line(path, line, kind))?;
    }
    later.check(&model.lists).map_err(|(line, kind)| ModelFileError::of_line(path, line, kind))?;
    if model.lists.sizes.is_empty() {
        return Err(ModelFileError::of_file(path, ModelFileErrorKind::NoFaces));
    }
    Ok(model)
}

fn vertex(model: &mut Statements, line: u64, rest: &[u8]) -> Result<(), ModelFileErrorKind> {
    let is_first = model.colors.len() == model.lists.positions.len();
    // In f64, but within the range of f32.
    let position = numbers(&mut words(rest), |value: f64| (value as f32).is_finite(), "a position (3)")?;
    push(&mut model.lists.positions, Wide::new(position))?;
    if let Some(color) = color(rest)? {
        if model.colored == 0 {
            model.colored = line;
        }
        if is_first {
            push(&mut model.colors, color)?;
        }
    }
    Ok(())
}

/// The colour after a position, if there is one: three more numbers.
fn color(rest: &[u8]) -> Result<Option<[f32; 3]>, ModelFileErrorKind> {
    match numbers(&mut words(rest).skip(3), f32::is_finite, "a colour (3)") {
        Ok(color) => Ok(Some(color)),
        Err(ModelFileErrorKind::Missing(_) | ModelFileErrorKind::NotNumber(_)) => Ok(None),
        Err(error) => Err(error),
    }
}

fn texcoord(lists: &mut Lists, rest: &[u8]) -> Result<(), ModelFileErrorKind> {
    let mut words = words(rest);
    let [u] = numbers(&mut words, f32::is_finite, "texture coordinates (2)")?;
    let v = number(&mut words)?.unwrap_or(0.0);
    push(&mut lists.texcoords, Vec2::new(u, v))
}

fn normal(lists: &mut Lists, rest: &[u8]) -> Result<(), ModelFileErrorKind> {
    push(&mut lists.normals, Vec3::from_array(numbers(&mut words(rest), f32::is_finite, "a normal (3)")?))
}

/// The number of a smoothing group: 0 for `off`, 1 for `on`. Anything else is ignored.
fn group(rest: &[u8]) -> Option<u32> {
    match words(rest).next()? {
        b"off" => Some(0),
        b"on" => Some(1),
        // The greatest number is reserved for an unknown group.
        word => whole(word).map(|number| u32::try_from(number).unwrap_or(u32::MAX).min(u32::MAX - 1)),
    }
}

/// Ignores an unknown statement, unless the file is not text at all.
fn foreign(word: &[u8], text: &[u8]) -> Result<(), ModelFileErrorKind> {
    let binary = |byte: &u8| *byte < b' ' && !matches!(byte, b'\t' | b'\r' | 0x0B | 0x0C | 0x1A);
    if !word.starts_with(b"#") && text.iter().any(binary) { Err(ModelFileErrorKind::NotText) } else { Ok(()) }
}

fn face(lists: &mut Lists, later: &mut Later, line: u64, rest: &[u8]) -> Result<(), ModelFileErrorKind> {
    let counts = counts(lists);
    let first = lists.corners.len();
    for word in words(rest) {
        let mut indices = [Corner::NONE; 3];
        let mut parts = 0;
        for (kind, part) in word.split(|&byte| byte == b'/').enumerate() {
            parts += 1;
            if kind > 2 || (part.is_empty() && kind == 0) {
                return Err(ModelFileErrorKind::NotCorner(shown(word)));
            }
            if !part.is_empty() {
                let index = whole(part).ok_or_else(|| ModelFileErrorKind::NotCorner(shown(word)))?;
                indices[kind] = later.resolve(kind, index, counts[kind], line)?;
            }
        }
        debug_assert!(parts > 0);
        let [position, texcoord, normal] = indices;
        reserve(&mut lists.corners)?;
        lists.corners.push(Corner { position, texcoord, normal });
    }
    lists.end_face(first, Place::Line(line))
}

/// The number of positions, texture coordinates and normals.
fn counts(lists: &Lists) -> [usize; 3] {
    [lists.positions.len(), lists.texcoords.len(), lists.normals.len()]
}

/// Parses an integer with an optional sign; `None` if it is not one or does not fit.
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

/// Forward references: indices of positions, texture coordinates or normals that have not appeared yet, which are
/// checked at the end. Only each index greater than all before it need be recorded: the first that turns out too great
/// is among them.
#[derive(Default)]
struct Later {
    records: [Vec<(i64, u64)>; 3],
}

const WHAT: [&str; 3] = ["vertex", "texture coordinate", "normal"];

impl Later {
    /// Converts an index to one that counts from 0. `count` is the number of entries so far.
    fn resolve(&mut self, kind: usize, index: i64, count: usize, line: u64) -> Result<u32, ModelFileErrorKind> {
        // `count` is at most `Mesh::MAX_COUNT`, see `push`.
        let from_zero = match index {
            0 => return Err(ModelFileErrorKind::IndexZero),
            1.. => index - 1,
            _ => count as i64 + index,
        };
        if from_zero < 0 || from_zero >= Mesh::MAX_COUNT as i64 {
            return Err(ModelFileErrorKind::IndexOutOfRange { what: WHAT[kind], index, count });
        }
        if from_zero >= count as i64 && self.records[kind].last().is_none_or(|&(greatest, _)| index > greatest) {
            self.records[kind].push((index, line));
        }
        // Below 2³¹, as checked above.
        Ok(from_zero as u32)
    }

    fn check(&self, lists: &Lists) -> Result<(), (u64, ModelFileErrorKind)> {
        let counts = counts(lists);
        let missing = (0..3).filter_map(|kind| {
            let count = counts[kind];
            let &(index, line) = self.records[kind].iter().find(|&&(index, _)| index > count as i64)?;
            Some((line, ModelFileErrorKind::IndexOutOfRange { what: WHAT[kind], index, count }))
        });
        missing.min_by_key(|&(line, _)| line).map_or(Ok(()), Err)
    }
}
