//! Triangles as indices into columns of vertex values, the raster's input format.
//!
//! A triangle is always three indices, and nothing copies it: culling, set-up and the pixel stages each read the values
//! they need from the columns. A [`Pick`] says which triangle to draw, which of its sides is visible, and which class
//! culling assigned to it.

#[cfg(feature = "alloc")]
use glam::Vec3;

use super::pick::Pick;
use super::vertex::Vertex;
use crate::fixed::{I24F8, U8F8};
use crate::lanes::{LANES, three};

/// Screen position of a vertex, x and y in 1/256 pixel within the guard band, or a mark that it
/// needs clipping, packed into one integer so that a single load reads it.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
#[repr(transparent)]
pub(crate) struct ScreenPos(u64);

impl ScreenPos {
    /// The x of a vertex that needs clipping: far outside the guard band.
    pub(crate) const BEYOND: i32 = i32::MIN;
    #[cfg(any(feature = "alloc", test))]
    pub(crate) const NEEDS_CLIPPING: Self = Self::new(Self::BEYOND, 0);
    /// A vertex nearer than the near plane. A triangle of three such vertices is not drawn.
    #[cfg(any(feature = "alloc", test))]
    pub(crate) const TOO_NEAR: Self = Self::new(Self::BEYOND, Self::TOO_NEAR_Y);
    /// The y of such a vertex; 0 for others that need clipping.
    pub(crate) const TOO_NEAR_Y: i32 = 1;

    #[inline(always)]
    pub(crate) const fn new(x: i32, y: i32) -> Self {
        Self(x.cast_unsigned() as u64 | (y.cast_unsigned() as u64) << 32)
    }

    /// The position of a vertex.
    #[inline(always)]
    pub(crate) fn of(vertex: &Vertex) -> Self {
        Self::new(vertex.x().to_bits(), vertex.y().to_bits())
    }

    #[inline(always)]
    pub(crate) const fn x(self) -> i32 {
        // The lower half.
        self.0 as i32
    }

    #[inline(always)]
    pub(crate) const fn y(self) -> i32 {
        // The upper half.
        (self.0 >> 32) as i32
    }

    #[inline]
    pub(crate) const fn needs_clipping(self) -> bool {
        self.x() == Self::BEYOND
    }
}

/// x in the lower half, y in the upper.
impl From<ScreenPos> for u64 {
    #[inline(always)]
    fn from(pos: ScreenPos) -> Self {
        pos.0
    }
}

/// Vertex values, one array per value. Arrays for unused effects are empty.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Columns<'a> {
    pub(crate) at: &'a [ScreenPos],
    pub(crate) depth: &'a [u32],
    /// Front and back.
    pub(crate) shade: &'a [[U8F8; 2]],
    #[cfg(feature = "alloc")]
    pub(crate) effects: EffectColumns<'a>,
}

/// The values of a column, stored by corner, at the corners of eight consecutive triangles.
#[inline(always)]
pub(super) fn eight_corners<T>(column: &[T], [a, b, c]: [usize; 3]) -> Option<[&[T; LANES]; 3]> {
    let from = |corner: usize| column.get(corner..)?.first_chunk();
    Some([from(a)?, from(b)?, from(c)?])
}

/// Vertex values for effects.
#[cfg(feature = "alloc")]
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct EffectColumns<'a> {
    /// Texture coordinates in texels, 16.16.
    pub(crate) texture: &'a [[i32; 2]],
    /// Density of the fog, 0 to 0xFF00.
    pub(crate) fog: &'a [U8F8],
    /// Red, green and blue, front and back.
    pub(crate) channels: &'a [[[U8F8; 3]; 2]],
    /// Column and row in a table of normals, for the front.
    pub(crate) slope: &'a [[U8F8; 2]],
    pub(crate) lit: LitColumn<'a>,
}

/// The values of a corner besides its position, shade and depth. Values that a pipeline does not use are ignored, and
/// numbers above 0xFF00 count as 0xFF00.
#[cfg(feature = "alloc")]
#[derive(Clone, Copy, PartialEq, Debug, Default)]
pub struct Attributes {
    /// Texture coordinates, across and up, in texels with 16 fraction bits. Row 0 of a
    /// [`Texture`](crate::texture::Texture) is the bottom row of its picture.
    pub texture: [i32; 2],
    /// The density of the fog, 0 to 0xFF00.
    pub fog: U8F8,
    /// Red, green and blue, each 0 to 0xFF00.
    pub channels: [U8F8; 3],
    /// The column and the row in the table of [`ShadeSource::NormalTable`](super::effects::ShadeSource::NormalTable),
    /// each 0 to 0xFF00.
    pub slope: [U8F8; 2],
    /// The input of [`PixelLighting`](super::effects::PixelLighting): a normal and a position.
    ///
    /// For [`ShadeSource::Curved`](super::effects::ShadeSource::Curved) these are the shade at the corner, or its three
    /// channels, and then the shade or channels at the midpoint (on the screen) of the opposite edge. They are in 8.8
    /// and may exceed the displayable range; the limits clamp them.
    pub lit: [f32; 6],
}

/// A value other than the shade that is linear over a triangle, 0 to 0xFF00.
#[cfg(feature = "alloc")]
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(crate) enum Value {
    /// Density of the fog.
    Fog,
    /// Red, green or blue.
    Channel(usize),
    /// Column or row in a table of normals.
    Slope(usize),
}

#[cfg(feature = "alloc")]
impl Value {
    /// The maximum number of values that one pipeline needs.
    pub(crate) const MAX_COUNT: usize = 4;

    /// Index among the values of a pipeline, which has either channels or a table of normals.
    #[inline(always)]
    pub(crate) const fn slot(self) -> usize {
        match self {
            Self::Fog => 0,
            Self::Channel(i) | Self::Slope(i) => (1 + i) % Self::MAX_COUNT,
        }
    }
}

#[cfg(feature = "alloc")]
impl EffectColumns<'_> {
    /// A value at a vertex, as seen from one side.
    #[inline(always)]
    pub(crate) fn value(&self, value: Value, vertex: usize, side: usize) -> u16 {
        match value {
            Value::Fog => self.fog[vertex].to_bits(),
            Value::Channel(i) => self.channels[vertex][side][i].to_bits(),
            Value::Slope(i) => seen_slope(self.slope[vertex], side)[i].to_bits(),
        }
    }
}

/// The input of per-pixel lighting.
#[cfg(feature = "alloc")]
#[derive(Clone, Copy, Debug)]
pub(crate) enum LitColumn<'a> {
    /// Normals (of the front) and positions of a mesh.
    Points(&'a [Vec3], &'a [Vec3]),
    /// Normal and position, or a curve, for the visible side; see [`Attributes::lit`].
    Values(&'a [[f32; 6]]),
}

#[cfg(feature = "alloc")]
impl Default for LitColumn<'_> {
    fn default() -> Self {
        Self::Values(&[])
    }
}

#[cfg(feature = "alloc")]
impl LitColumn<'_> {
    /// The values at a vertex, as seen from one side.
    #[inline]
    pub(crate) fn get(&self, vertex: usize, side: usize) -> [f32; 6] {
        match self {
            Self::Points(normals, positions) => {
                let (n, p) = (normals[vertex], positions[vertex]);
                let n = if side == 0 { n } else { -n };
                [n.x, n.y, n.z, p.x, p.y, p.z]
            }
            Self::Values(values) => values[vertex],
        }
    }
}

/// Triangles as indices into columns.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Triangles<'a> {
    pub(crate) columns: Columns<'a>,
    pub(crate) indices: &'a [[u32; 3]],
    /// The most triangles that the columns hold, if they are [`Corners`](super::triangles::Corners): eight triangles
    /// are then loaded without gathering.
    pub(crate) by_corner: Option<usize>,
}

/// Triangles to be drawn, in order. None of them needs clipping.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Picks<'a> {
    /// One [`Pick`] per triangle.
    pub(crate) picks: &'a [u32],
    /// The single shade of each triangle, or its three channels; empty where the corners have their own.
    pub(crate) flat: &'a [[U8F8; 3]],
}

impl<'a> Picks<'a> {
    /// Picks `first` to `end`, which must exist.
    #[inline(always)]
    pub(crate) fn range(&self, first: usize, end: usize) -> Self {
        let flat = if self.flat.is_empty() { self.flat } else { &self.flat[first..end] };
        Self { picks: &self.picks[first..end], flat }
    }

    /// Pick `k`.
    #[inline(always)]
    pub(crate) fn get(&self, k: usize) -> Pick {
        Pick(self.picks[k])
    }
}

/// Triangles, and which of them are drawn.
#[derive(Clone, Copy, Debug)]
pub(crate) struct PickedTriangles<'a> {
    pub(crate) triangles: &'a Triangles<'a>,
    pub(crate) picks: Picks<'a>,
}

impl<'a> PickedTriangles<'a> {
    /// Picks `first` to `end`, which must exist.
    #[inline(always)]
    pub(super) fn range(&self, first: usize, end: usize) -> Self {
        Self { picks: self.picks.range(first, end), ..*self }
    }

    /// The vertices of pick `k`.
    #[inline]
    pub(crate) fn vertices(&self, k: usize) -> [Vertex; 3] {
        let pick = self.picks.get(k);
        let flat = self.picks.flat.get(k).map(|flat| flat[0]);
        three(self.triangles.corners(pick), |i| self.triangles.columns.vertex(i, pick.side(), flat))
    }
}

impl Triangles<'_> {
    /// No triangles.
    #[cfg(feature = "alloc")]
    pub(crate) const NONE: Self = {
        let lit = LitColumn::Values(&[]);
        let effects = EffectColumns { texture: &[], fog: &[], channels: &[], slope: &[], lit };
        Self { columns: Columns { at: &[], depth: &[], shade: &[], effects }, indices: &[], by_corner: None }
    };

    /// The indices of the corners of the first of eight consecutive triangles, if columns are by corner.
    #[inline(always)]
    pub(super) fn consecutive(&self, picks: &Picks<'_>) -> Option<[usize; 3]> {
        let (room, first) = (self.by_corner?, Pick(*picks.picks.first()?).index());
        Some([first, room + first, 2 * room + first])
    }

    /// The corners of a triangle.
    #[inline(always)]
    pub(crate) fn corners(&self, pick: Pick) -> [usize; 3] {
        three(self.indices[pick.index()], |i| i as usize)
    }
}

impl<'a> Columns<'a> {
    /// Columns without those for effects.
    #[inline]
    pub(super) fn plain(at: &'a [ScreenPos], depth: &'a [u32], shade: &'a [[U8F8; 2]]) -> Self {
        Self {
            at,
            depth,
            shade,
            #[cfg(feature = "alloc")]
            effects: EffectColumns::default(),
        }
    }

    /// Vertex `i`, which needs no clipping, as seen from one side, or with another shade.
    #[inline]
    pub(crate) fn vertex(&self, i: usize, side: usize, shade: Option<U8F8>) -> Vertex {
        let at = self.at[i];
        let shade = shade.unwrap_or(self.shade[i][side]);
        Vertex::of_projected(I24F8::from_bits(at.x()), I24F8::from_bits(at.y()), shade, self.depth[i])
    }

    /// The remaining values of vertex `i`, if any, as seen from one side; lighting input only with
    /// `lit`.
    #[cfg(feature = "alloc")]
    pub(crate) fn attributes(&self, i: usize, side: usize, lit: bool) -> Attributes {
        let EffectColumns { texture, fog, channels, slope, lit: points } = self.effects;
        Attributes {
            texture: texture.get(i).copied().unwrap_or_default(),
            fog: fog.get(i).copied().unwrap_or_default(),
            channels: channels.get(i).map(|sides| sides[side]).unwrap_or_default(),
            slope: slope.get(i).map(|slope| seen_slope(*slope, side)).unwrap_or_default(),
            lit: if lit { points.get(i, side) } else { [0.0; 6] },
        }
    }
}

/// A column and row in a table of normals, as seen from one side: the back sees the normal from behind.
#[cfg(feature = "alloc")]
#[inline]
pub(crate) fn seen_slope(slope: [U8F8; 2], side: usize) -> [U8F8; 2] {
    match side {
        0 => slope,
        _ => slope.map(|slope| U8F8::from_bits(U8F8::MAX_VERTEX.to_bits() - slope.to_bits())),
    }
}
