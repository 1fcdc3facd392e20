//! The output of every format's reader: lists of positions, texture coordinates and normals, and faces with any number
//! of corners that index them.

use mode13h::glam::{Vec2, Vec3};
use mode13h::mesh::Mesh;

use super::ModelFileErrorKind;

/// The indices of position, texture coordinates and normal, from 0; [`NONE`](Self::NONE) for a missing one.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug)]
pub(crate) struct Corner {
    pub(crate) position: u32,
    pub(crate) texcoord: u32,
    pub(crate) normal: u32,
}

impl Corner {
    pub(crate) const NONE: u32 = u32::MAX;
}

/// The lists of a model file.
#[derive(Default)]
pub(crate) struct Lists {
    pub(crate) positions: Vec<Wide>,
    pub(crate) texcoords: Vec<Vec2>,
    pub(crate) normals: Vec<Vec3>,
    /// The corners of all faces in order.
    pub(crate) corners: Vec<Corner>,
    /// The number of corners of each face, three or more.
    pub(crate) sizes: Vec<u32>,
    /// The line of each face, capped at 2³² − 1. Empty for a file without lines.
    pub(crate) lines: Vec<u32>,
    /// The first face of each run with one surface, and the surface's index. Faces before the first run have surface 0.
    pub(crate) runs: Vec<(usize, usize)>,
    /// The first face of each run with one smoothing group, and the group's number, or 0 for none. Before the first run
    /// the group is unknown.
    pub(crate) smoothing: Vec<(usize, u32)>,
    /// The position of the first face with fewer than three corners, and the number of such faces. They are dropped.
    pub(crate) short: Option<(super::Place, usize)>,
}

impl Lists {
    /// Ends a face whose corners start at `first`. A face with fewer than three corners is dropped.
    ///
    /// # Errors
    /// Too many corners or triangles.
    pub(crate) fn end_face(&mut self, first: usize, place: super::Place) -> Result<(), ModelFileErrorKind> {
        let size = self.corners.len() - first;
        if size < 3 {
            self.corners.truncate(first);
            self.short.get_or_insert((place, 0)).1 += 1;
            return Ok(());
        }
        if self.corners.len() > u32::MAX as usize {
            return Err(ModelFileErrorKind::TooLarge("more than 4,294,967,295 corners"));
        }
        if self.corners.len() - 2 * self.sizes.len() > Mesh::MAX_COUNT + 2 {
            return Err(ModelFileErrorKind::TooLarge("more than 268,435,456 triangles"));
        }
        reserve(&mut self.sizes)?;
        // Fits, as checked above.
        self.sizes.push(size as u32);
        if let super::Place::Line(line) = place {
            reserve(&mut self.lines)?;
            self.lines.push(u32::try_from(line).unwrap_or(u32::MAX));
        }
        Ok(())
    }
}

/// Adds an entry to a list, if there is room for it.
pub(crate) fn push<T>(list: &mut Vec<T>, value: T) -> Result<(), ModelFileErrorKind> {
    if list.len() >= Mesh::MAX_COUNT {
        return Err(ModelFileErrorKind::TooLarge("more than 268,435,456 of a kind"));
    }
    reserve(list)?;
    list.push(value);
    Ok(())
}

/// Makes room for one more entry: a small packed file may unpack to more than fits into memory.
pub(crate) fn reserve<T>(list: &mut Vec<T>) -> Result<(), ModelFileErrorKind> {
    list.try_reserve(1).map_err(|error| ModelFileErrorKind::Read(error.into()))
}

/// Positions are moved to be centred on 0 if their centre is farther from it than this many times their half extent. Up
/// to there f32 rounds them by less than 2⁻²⁰ of the extent, which is 1/256 pixel in the largest frame.
const FAR: f64 = 16.0;

/// A position with about 48 bits per coordinate: the nearest f32 values, and the remainders.
#[derive(Clone, Copy)]
pub(crate) struct Wide([f32; 3], [f32; 3]);

impl Wide {
    pub(crate) fn new(position: [f64; 3]) -> Self {
        let near = position.map(|c| c as f32);
        Self(near, [0, 1, 2].map(|axis| (position[axis] - f64::from(near[axis])) as f32))
    }

    fn get(self) -> [f64; 3] {
        [0, 1, 2].map(|axis| f64::from(self.0[axis]) + f64::from(self.1[axis]))
    }

    /// The position in f32, relative to `middle` if it is given.
    pub(crate) fn narrow(self, middle: Option<[f64; 3]>) -> Vec3 {
        let Some(middle) = middle else { return Vec3::from_array(self.0) };
        let position = self.get();
        Vec3::from_array([0, 1, 2].map(|axis| (position[axis] - middle[axis]) as f32))
    }
}

/// The centre of the positions used by faces, if it is [`FAR`] from 0.
pub(crate) fn far_middle(positions: &[Wide], corners: &[Corner]) -> Option<[f64; 3]> {
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
