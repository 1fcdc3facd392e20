//! Conversion of the caller's vertices to the rasterizer's: in floats, or in 16.16 without floats.

use core::ops::{Add, Mul, Neg, Sub};

use mode13h::fixed::{I16F16, I24F8, U8F8};
use mode13h::raster::Vertex;

use crate::abi::{ABSENT, Mesh, Outcome, Refusal};

/// The values of a corner besides its position and depth, in the units of the [`Door`] that reads them.
#[derive(Clone, Copy, Default)]
pub(crate) struct Values<N> {
    pub(crate) shade: N,
    pub(crate) texture: [N; 2],
    pub(crate) fog: N,
    pub(crate) slope: [N; 2],
}

impl<N: Copy> Values<N> {
    /// Combines each value with that of `other`; `with` is told whether it is a texture coordinate.
    pub(crate) fn zip(self, other: Self, mut with: impl FnMut(N, N, bool) -> N) -> Self {
        Self {
            shade: with(self.shade, other.shade, false),
            texture: [with(self.texture[0], other.texture[0], true), with(self.texture[1], other.texture[1], true)],
            fog: with(self.fog, other.fog, false),
            slope: [with(self.slope[0], other.slope[0], false), with(self.slope[1], other.slope[1], false)],
        }
    }
}

/// The values that effect stages read, in the rasterizer's form.
#[cfg_attr(not(feature = "effects"), allow(dead_code, reason = "nothing reads them"))]
#[derive(Clone, Copy, Default)]
pub(crate) struct Attributes {
    pub(crate) texture: [i32; 2],
    pub(crate) fog: u16,
    pub(crate) slope: [u16; 2],
}

/// A corner as it is stored in a list: a vertex, with its attributes if there are effects.
pub(crate) trait Kept: Copy + Default {
    /// True if attributes are read.
    const HAS_ATTRIBUTES: bool;

    /// Makes one of both; without effects, attributes are left out.
    fn new(vertex: Vertex, attributes: Attributes) -> Self;

    /// The vertex.
    fn vertex(&self) -> &Vertex;
}

impl Kept for Vertex {
    const HAS_ATTRIBUTES: bool = false;

    #[inline(always)]
    fn new(vertex: Vertex, _: Attributes) -> Self {
        vertex
    }

    #[inline(always)]
    fn vertex(&self) -> &Vertex {
        self
    }
}

/// A vertex with its attributes.
#[cfg(feature = "effects")]
#[derive(Clone, Copy, Default)]
pub(crate) struct Ready {
    pub(crate) vertex: Vertex,
    pub(crate) attributes: Attributes,
}

#[cfg(feature = "effects")]
impl Kept for Ready {
    const HAS_ATTRIBUTES: bool = true;

    #[inline(always)]
    fn new(vertex: Vertex, attributes: Attributes) -> Self {
        Self { vertex, attributes }
    }

    #[inline(always)]
    fn vertex(&self) -> &Vertex {
        &self.vertex
    }
}

/// A corner before its division, in numbers wide enough to be clipped.
#[derive(Clone, Copy)]
pub(crate) struct Wide<N, K> {
    pub(crate) x: N,
    pub(crate) y: N,
    pub(crate) w: N,
    /// The mesh's depth, if it has one; otherwise it follows from w.
    pub(crate) depth: N,
    pub(crate) values: Values<N>,
    /// The corner, if it needs no clipping. It stays exactly as it is, because a neighbour that is not clipped uses it
    /// too.
    pub(crate) ready: Option<K>,
}

/// Pixels from the frame's corner to where triangles are cut: the end of the guard band, and of the largest frame.
const LIMIT: i32 = 4_096;

/// A format of vertices: how they are read, projected and cut.
pub(crate) trait Door {
    /// A number in memory.
    type Raw: Copy + Default;
    /// A number wide enough for clipping.
    type Wide: Copy
        + PartialOrd
        + Default
        + From<i32>
        + Add<Output = Self::Wide>
        + Sub<Output = Self::Wide>
        + Mul<Output = Self::Wide>
        + Neg<Output = Self::Wide>;

    /// The near plane of a mesh, which must be above 0.
    fn near(mesh: &Mesh) -> Outcome<Self::Wide>;
    /// Widens a number; `None` if it is not finite.
    fn widen(raw: Self::Raw) -> Option<Self::Wide>;
    /// The depth of a mesh's vertex from its 32 bits in memory; `None` if it is out of range.
    fn depth(bits: u32) -> Option<Self::Wide>;
    /// The w of a mesh whose vertices have none: 1.
    fn one() -> Self::Wide;
    /// The vertex with this x, y, w, depth and shade; `None` if it must be clipped. `near` is given if the mesh has w.
    fn vertex(numbers: [Self::Wide; 5], near: Option<Self::Wide>) -> Option<Vertex>;
    /// Values as attributes.
    fn attributes(values: &Values<Self::Wide>) -> Attributes;
    /// The distance of a point from a plane of the guard band: `LIMIT·w ± c`.
    fn distance(w: Self::Wide, c: Self::Wide, positive: bool) -> Self::Wide {
        let limit = Self::at_limit(w, true);
        if positive { limit + c } else { limit - c }
    }
    /// `LIMIT·w`, or its negative.
    fn at_limit(w: Self::Wide, positive: bool) -> Self::Wide {
        let limit = Self::Wide::from(LIMIT) * w;
        if positive { limit } else { -limit }
    }
    /// The point between `a`, inside, and `b`, outside, whose distances from a plane are `inside` and `outside`. With
    /// `by`, which holds `b`'s w and the point's, values are linear on the screen.
    fn between(
        a: Self::Wide,
        b: Self::Wide,
        inside: Self::Wide,
        outside: Self::Wide,
        by: Option<[Self::Wide; 2]>,
    ) -> Self::Wide;
}

/// Floats: positions in pixels, shades 0 to 255, depths 0 to 1, texture coordinates in texels.
pub(crate) struct Floats;

/// 16.16: the same, but depths are u32, of which 2³⁰ lies at the near plane.
pub(crate) struct Fixed;

/// Texture coordinates from here on are multiples of 65,536 texels: 2⁴⁷.
const LARGEST: f64 = 140_737_488_355_328.0;

/// `floor(x)`, for numbers that fit.
fn floor(x: f64) -> i64 {
    let whole = x as i64;
    if whole as f64 > x { whole - 1 } else { whole }
}

/// Converts a shade from 0 to 255 to 8.8.
fn byte_of_float(x: f64) -> u16 {
    (x.clamp(0.0, 255.0) * 256.0 + 0.5) as u16
}

fn byte_of_fixed(x: i64) -> u16 {
    ((x.clamp(0, 255 << 16) + 128) >> 8) as u16
}

/// The vertex at coordinates in 1/256 pixel; `None` if it must be clipped.
#[inline(always)]
fn vertex(x: I24F8, y: I24F8, shade: u16, depth: u32) -> Option<Vertex> {
    Vertex::new(x, y, U8F8::from_bits(shade), depth).ok()
}

impl Door for Floats {
    type Raw = f32;
    type Wide = f64;

    fn near(mesh: &Mesh) -> Outcome<f64> {
        if mesh.near_w.is_finite() && mesh.near_w > 0.0 { Ok(mesh.near_w.into()) } else { Err(Refusal::Value) }
    }

    #[inline]
    fn widen(raw: f32) -> Option<f64> {
        raw.is_finite().then_some(raw.into())
    }

    #[inline]
    fn depth(bits: u32) -> Option<f64> {
        let depth = f32::from_bits(bits);
        (0.0..=1.0).contains(&depth).then_some(depth.into())
    }

    fn one() -> f64 {
        1.0
    }

    #[inline(always)]
    fn vertex([x, y, w, depth, shade]: [f64; 5], near: Option<f64>) -> Option<Vertex> {
        let (x, y, depth) = match near {
            None => (x, y, depth),
            Some(near) if w >= near => (x / w, y / w, (near / w).min(1.0)),
            Some(_) => return None,
        };
        // At most 2³⁰.
        let depth = (depth * 1_073_741_824.0 + 0.5) as u32;
        vertex(I24F8::round_from_f64(x)?, I24F8::round_from_f64(y)?, byte_of_float(shade), depth)
    }

    fn attributes(values: &Values<f64>) -> Attributes {
        Attributes {
            // Coordinates wrap, as the texture does.
            texture: values.texture.map(|c| if c.abs() < LARGEST { floor(c * 65_536.0 + 0.5) as i32 } else { 0 }),
            fog: byte_of_float(values.fog),
            slope: values.slope.map(byte_of_float),
        }
    }

    /// The mean of both, each weighted with the other's distance, so that no digits are lost between numbers of the
    /// same sign. Rounding may not take it beyond either: two that are at the near plane are cut there.
    fn between(a: f64, b: f64, inside: f64, outside: f64, by: Option<[f64; 2]>) -> f64 {
        let point = match by {
            None => (b * inside - a * outside) / (inside - outside),
            Some([of, to]) => a + (b - a) * (inside / (inside - outside) * (of / to)),
        };
        point.max(a.min(b)).min(a.max(b))
    }
}

impl Door for Fixed {
    type Raw = i32;
    type Wide = i64;

    fn near(mesh: &Mesh) -> Outcome<i64> {
        if mesh.near_w_x > 0 { Ok(mesh.near_w_x.into()) } else { Err(Refusal::Value) }
    }

    #[inline]
    fn widen(raw: i32) -> Option<i64> {
        Some(raw.into())
    }

    #[inline]
    fn depth(bits: u32) -> Option<i64> {
        Some(bits.into())
    }

    fn one() -> i64 {
        1 << 16
    }

    #[inline(always)]
    fn vertex([x, y, w, depth, shade]: [i64; 5], near: Option<i64>) -> Option<Vertex> {
        let (x, y, depth) = match near {
            // Numbers of a mesh have 32 bits; those of a cut lie between two of them.
            None => {
                let pixels = |c: i64| I24F8::round_from_i16f16(I16F16::from_bits(c as i32));
                (pixels(x), pixels(y), depth as u32)
            }
            Some(near) if w >= near => {
                // floor(256·x/w + ½); i32 after the check.
                let pixels = |c: i64| {
                    let c = (512 * c + w).div_euclid(2 * w);
                    i32::try_from(c).ok().map(I24F8::from_bits)
                };
                // nearest(2³⁰·near/w), at most 2³⁰.
                (pixels(x)?, pixels(y)?, (((near << 31) + w) / (2 * w)) as u32)
            }
            Some(_) => return None,
        };
        vertex(x, y, byte_of_fixed(shade), depth)
    }

    fn attributes(values: &Values<i64>) -> Attributes {
        Attributes {
            texture: values.texture.map(|c| c as i32),
            fog: byte_of_fixed(values.fog),
            slope: values.slope.map(byte_of_fixed),
        }
    }

    /// Rounded to the nearest, halves upward. Numbers are below 2⁴⁵ (13 bits of the limit, 31 of w and a sign),
    /// products below 2⁹².
    fn between(a: i64, b: i64, inside: i64, outside: i64, by: Option<[i64; 2]>) -> i64 {
        let (a, b, inside, outside) = (i128::from(a), i128::from(b), i128::from(inside), i128::from(outside));
        let whole = inside - outside;
        let point = match by {
            None => floor_of(2 * (b * inside - a * outside) + whole, 2 * whole),
            Some([of, to]) => {
                // 2³⁰ parts, so that products stay small.
                let part = floor_of((inside * i128::from(of)) << 30, whole);
                let part = floor_of(part, to.into()).clamp(0, 1 << 30);
                a + (((b - a) * part) >> 30)
            }
        };
        point.clamp(a.min(b), a.max(b)) as i64
    }
}

/// The floor of n / d for a positive d, which is within i64.
#[cfg(feature = "effects")]
fn floor_of(n: i128, d: i128) -> i128 {
    // Its code is long on 32 bits, so it is shared.
    mode13h::fixed::floor_of_wide(n, d).into()
}
#[cfg(not(feature = "effects"))]
#[inline(never)]
fn floor_of(n: i128, d: i128) -> i128 {
    n.div_euclid(d)
}

/// A mesh whose arrays have been checked.
pub(crate) struct Source {
    mesh: Mesh,
}

/// The values of vertices that a call reads, besides their positions.
#[derive(Clone, Copy)]
pub(crate) struct Needs {
    pub(crate) shade: bool,
    pub(crate) depth: bool,
    pub(crate) texture: bool,
    pub(crate) fog: bool,
    pub(crate) slope: bool,
}

/// The memory of a mesh's parts.
pub(crate) struct Parts {
    pub(crate) vertices: usize,
    pub(crate) indices: usize,
}

impl Source {
    /// Checks all of a mesh except the values of its indices. Vertices with w need no depth.
    pub(crate) fn new(mesh: Mesh, needs: Needs) -> Outcome<(Self, Parts)> {
        let Mesh { stride, position, depth, shade, texture, fog, slope, .. } = mesh;
        if mesh.homogeneous > 1 {
            return Err(Refusal::Value);
        }
        let fits = |offset: u32, numbers: u32, needed: bool| match offset {
            ABSENT if needed => false,
            ABSENT => true,
            _ => offset.checked_add(4 * numbers).is_some_and(|end| end <= stride),
        };
        let all = fits(position, 2 + mesh.homogeneous, true)
            && fits(depth, 1, needs.depth && mesh.homogeneous == 0)
            && fits(shade, 1, needs.shade)
            && fits(texture, 2, needs.texture)
            && fits(fog, 1, needs.fog)
            && fits(slope, 2, needs.slope);
        if !all {
            return Err(Refusal::Layout);
        }
        let bytes = |count: u32, each: u32| usize::try_from(u64::from(count) * u64::from(each));
        let corners = if mesh.indices.is_null() { mesh.vertex_count } else { mesh.index_count };
        if !corners.is_multiple_of(3) {
            return Err(Refusal::Count);
        }
        if !mesh.indices.is_null() && !matches!(mesh.index_bits, 8 | 16 | 32) {
            return Err(Refusal::Value);
        }
        let parts = Parts {
            vertices: bytes(mesh.vertex_count, stride).map_err(|_| Refusal::Short)?,
            indices: if mesh.indices.is_null() {
                0
            } else {
                bytes(mesh.index_count, mesh.index_bits / 8).map_err(|_| Refusal::Short)?
            },
        };
        // What nobody needs is not read, so it may be anything.
        let read = |needed: bool, offset: u32| if needed { offset } else { ABSENT };
        let mesh = Mesh {
            depth: read(needs.depth, depth),
            shade: read(needs.shade, shade),
            texture: read(needs.texture, texture),
            fog: read(needs.fog, fog),
            slope: read(needs.slope, slope),
            ..mesh
        };
        Ok((Self { mesh }, parts))
    }

    /// The number of its triangles.
    pub(crate) fn triangles(&self) -> u32 {
        if self.mesh.indices.is_null() { self.mesh.vertex_count / 3 } else { self.mesh.index_count / 3 }
    }

    /// The indices of triangle `i`, which is below their number.
    ///
    /// # Safety
    /// The mesh holds as many indices as it says.
    #[inline(always)]
    pub(crate) unsafe fn indices(&self, i: u32) -> [u32; 3] {
        let Mesh { indices, index_bits, .. } = self.mesh;
        let at = i as usize;
        // SAFETY: the bytes of the indices are there, and no more than half of memory.
        unsafe {
            match index_bits {
                _ if indices.is_null() => [3 * i, 3 * i + 1, 3 * i + 2],
                8 => indices.cast::<[u8; 3]>().add(at).read().map(u32::from),
                16 => indices.cast::<[u16; 3]>().add(at).read_unaligned().map(u32::from),
                _ => indices.cast::<[u32; 3]>().add(at).read_unaligned(),
            }
        }
    }

    /// Rejects an index of a vertex that does not exist.
    ///
    /// # Safety
    /// The mesh holds as many indices as it says.
    pub(crate) unsafe fn check_indices(&self) -> Outcome {
        let Mesh { indices, index_bits, vertex_count, .. } = self.mesh;
        let count = 3 * self.triangles() as usize;
        macro_rules! most {
            ($index:ty) => {
                // SAFETY: below the number of indices.
                (0..count).map(|i| unsafe { indices.cast::<$index>().add(i).read_unaligned() }).max().map(u64::from)
            };
        }
        let most = match index_bits {
            _ if indices.is_null() => return Ok(()),
            8 => most!(u8),
            16 => most!(u16),
            _ => most!(u32),
        };
        // An empty list has none.
        if most.is_some_and(|most| most >= u64::from(vertex_count)) { Err(Refusal::Index) } else { Ok(()) }
    }

    /// The near plane of a mesh that has w; it has been checked.
    pub(crate) fn near<D: Door>(&self) -> Option<D::Wide> {
        if self.mesh.homogeneous == 1 { D::near(&self.mesh).ok() } else { None }
    }

    /// Returns whether vertices are named by indices, so that several triangles may share one.
    pub(crate) fn is_indexed(&self) -> bool {
        !self.mesh.indices.is_null()
    }

    /// One number of a vertex, 0 if vertices lack it; `None` if it is not finite.
    ///
    /// # Safety
    /// `vertex` is one of the mesh, and the offset one that was checked.
    #[inline(always)]
    unsafe fn number<D: Door>(vertex: *const u8, offset: u32) -> Option<D::Wide> {
        if offset == ABSENT {
            return Some(D::Wide::default());
        }
        // SAFETY: the number ends within the stride.
        D::widen(unsafe { vertex.add(offset as usize).cast::<D::Raw>().read_unaligned() })
    }

    /// x, y, w, depth and shade of vertex `i`, and its address; `None` if one of them is not a number, or out of range.
    ///
    /// # Safety
    /// `i` is below the number of vertices, and the mesh holds as many as it says.
    #[inline(always)]
    unsafe fn numbers<D: Door>(&self, i: u32, has_w: bool) -> Option<([D::Wide; 5], *const u8)> {
        let Mesh { vertices, stride, position, depth, shade, .. } = self.mesh;
        // SAFETY: the bytes of the vertices are there, and no more than half of memory; each number ends within the stride.
        unsafe {
            let vertex = vertices.cast::<u8>().add(i as usize * stride as usize);
            let (x, y) = (Self::number::<D>(vertex, position)?, Self::number::<D>(vertex, position + 4)?);
            let w = if has_w { Self::number::<D>(vertex, position + 8)? } else { D::one() };
            let depth = if depth == ABSENT || has_w {
                D::Wide::default()
            } else {
                D::depth(vertex.add(depth as usize).cast::<u32>().read_unaligned())?
            };
            Some(([x, y, w, depth, Self::number::<D>(vertex, shade)?], vertex))
        }
    }

    /// The further values of a vertex.
    ///
    /// # Safety
    /// `vertex` is one of the mesh.
    #[inline(always)]
    unsafe fn values<D: Door>(&self, vertex: *const u8, shade: D::Wide) -> Option<Values<D::Wide>> {
        let Mesh { texture, fog, slope, .. } = self.mesh;
        // SAFETY: offsets have been checked.
        let number = |offset: u32| unsafe { Self::number::<D>(vertex, offset) };
        // If the first of two is absent, so is the second.
        let two = |offset: u32| Some([number(offset)?, number(if offset == ABSENT { ABSENT } else { offset + 4 })?]);
        Some(Values { shade, texture: two(texture)?, fog: number(fog)?, slope: two(slope)? })
    }

    /// Writes vertex `i` in the rasterizer's form to two places. Returns false if it must be clipped, or a number of it
    /// is invalid or out of range. (Copying from the first place to the second would load in one piece what had just
    /// been stored in four.)
    ///
    /// # Safety
    /// `i` is below the number of vertices, and the mesh holds as many as it says.
    #[inline(never)]
    pub(crate) unsafe fn corner<D: Door, K: Kept>(
        &self,
        i: u32,
        near: Option<D::Wide>,
        to: &mut K,
        and_to: &mut K,
    ) -> bool {
        // SAFETY: by the caller.
        let Some((numbers, vertex)) = (unsafe { self.numbers::<D>(i, near.is_some()) }) else { return false };
        let mut attributes = Attributes::default();
        if K::HAS_ATTRIBUTES {
            // SAFETY: a vertex of the mesh.
            let Some(values) = (unsafe { self.values::<D>(vertex, numbers[4]) }) else { return false };
            attributes = D::attributes(&values);
        }
        let Some(vertex) = D::vertex(numbers, near) else { return false };
        *to = K::new(vertex, attributes);
        *and_to = K::new(vertex, attributes);
        true
    }

    /// Vertex `i` in the rasterizer's form, without effects; `None` if it must be clipped, or a number of it is invalid
    /// or out of range.
    ///
    /// # Safety
    /// `i` is below the number of vertices, and the mesh holds as many as it says.
    #[inline(always)]
    pub(crate) unsafe fn vertex<D: Door>(&self, i: u32, near: Option<D::Wide>) -> Option<Vertex> {
        // SAFETY: by the caller.
        let (numbers, _) = unsafe { self.numbers::<D>(i, near.is_some()) }?;
        D::vertex(numbers, near)
    }

    /// Vertex `i`, for clipping; `None` if one of its numbers is invalid or out of range.
    ///
    /// # Safety
    /// `i` is below the number of vertices, and the mesh holds as many as it says.
    pub(crate) unsafe fn wide<D: Door, K: Kept>(&self, i: u32, near: Option<D::Wide>) -> Option<Wide<D::Wide, K>> {
        // SAFETY: by the caller.
        let ([x, y, w, depth, shade], vertex) = unsafe { self.numbers::<D>(i, near.is_some()) }?;
        let values = if K::HAS_ATTRIBUTES {
            // SAFETY: a vertex of the mesh.
            unsafe { self.values::<D>(vertex, shade) }?
        } else {
            Values { shade, ..Values::default() }
        };
        // As in a corner that is not cut, before it is interpolated.
        let (least, most) = (D::Wide::default(), D::Wide::from(255) * D::one());
        let clamped = |c: D::Wide| if c < least { least } else { c };
        let clamped = |c: D::Wide| if c > most { most } else { clamped(c) };
        let Values { shade, texture, fog, slope } = values;
        let values = Values { shade: clamped(shade), texture, fog: clamped(fog), slope: slope.map(clamped) };
        let mut corner = Wide { x, y, w, depth, values, ready: None };
        corner.ready = corner.project::<D>(near);
        Some(corner)
    }
}

impl<N: Copy, K: Kept> Wide<N, K> {
    /// The corner moved to the end of the guard band if it is beyond, as rounding may take one that was cut.
    pub(crate) fn in_band<D: Door<Wide = N>>(self) -> Self
    where
        N: PartialOrd,
    {
        let [least, most] = [false, true].map(|positive| D::at_limit(self.w, positive));
        let inside = |c: N| if c < least { least } else { c };
        let inside = |c: N| if c > most { most } else { inside(c) };
        Self { x: inside(self.x), y: inside(self.y), ..self }
    }

    /// The corner in the rasterizer's form; `None` if it must be clipped.
    pub(crate) fn project<D: Door<Wide = N>>(&self, near: Option<N>) -> Option<K> {
        let Self { x, y, w, depth, values, .. } = self;
        let attributes = if K::HAS_ATTRIBUTES { D::attributes(values) } else { Attributes::default() };
        Some(K::new(D::vertex([*x, *y, *w, *depth, values.shade], near)?, attributes))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Texture coordinates of any size wrap every 65,536 texels.
    #[test]
    fn large_texture_coordinates_wrap() {
        for (c, wrapped) in [(2e14, 0), (-1e20, 0), (f32::MAX, 0), (-65_537.0, -65_536), (16_777_215.0, -65_536)] {
            let values = Values { texture: [f64::from(c); 2], ..Values::default() };
            assert_eq!(Floats::attributes(&values).texture, [wrapped; 2], "{c}");
        }
    }
}
