//! From the caller's vertices to the raster's: by floats, or by 16.16 without a float.

use mode13h::fixed::{I16F16, I24F8, U8F8};
use mode13h::raster::Vertex;

use crate::abi::{ABSENT, Mesh, Outcome, Refusal};

/// The values of a corner beside its position and depth, in the units of the door that reads them.
#[derive(Clone, Copy, Default)]
pub(crate) struct Values<N> {
    pub(crate) shade: N,
    pub(crate) texture: [N; 2],
    pub(crate) fog: N,
    pub(crate) slope: [N; 2],
}

impl<N: Copy> Values<N> {
    /// Each value and its partner of other values; the second says whether it is a texture coordinate.
    pub(crate) fn zip(self, other: Self, mut with: impl FnMut(N, N, bool) -> N) -> Self {
        Self {
            shade: with(self.shade, other.shade, false),
            texture: [with(self.texture[0], other.texture[0], true), with(self.texture[1], other.texture[1], true)],
            fog: with(self.fog, other.fog, false),
            slope: [with(self.slope[0], other.slope[0], false), with(self.slope[1], other.slope[1], false)],
        }
    }
}

/// The values that the stages of effects read, as the raster has them.
#[cfg_attr(not(feature = "effects"), allow(dead_code, reason = "nothing reads them"))]
#[derive(Clone, Copy, Default)]
pub(crate) struct Attributes {
    pub(crate) texture: [i32; 2],
    pub(crate) fog: u16,
    pub(crate) slope: [u16; 2],
}

/// A corner that the raster takes.
#[cfg_attr(not(feature = "effects"), allow(dead_code, reason = "nothing reads its attributes"))]
#[derive(Clone, Copy, Default)]
pub(crate) struct Ready {
    pub(crate) vertex: Vertex,
    pub(crate) attributes: Attributes,
}

/// A corner before its division, in numbers wide enough to be clipped.
#[derive(Clone, Copy)]
pub(crate) struct Wide<N> {
    pub(crate) x: N,
    pub(crate) y: N,
    pub(crate) w: N,
    /// Where the mesh gives it; otherwise it follows from w.
    pub(crate) depth: N,
    pub(crate) values: Values<N>,
    /// The corner that needs no clipping. It stays as it is, because a neighbour that needs none either draws with it.
    pub(crate) ready: Option<Ready>,
}

/// Coordinates that need no clipping: up to a quarter of a pixel beyond where the guard band is cut, because rounding may
/// take a cut point off it. In pixels, and in 1/256 pixel.
pub(crate) const LIMIT: i32 = 4_095;
const REACH: i32 = LIMIT * 256 + 64;

/// A door: how vertices are read, projected and cut.
pub(crate) trait Door {
    /// A number in memory.
    type Raw: Copy + Default;
    /// A number that is wide enough.
    type Wide: Copy + PartialOrd + Default;

    /// The near plane of a mesh, which must be above 0.
    fn near(mesh: &Mesh) -> Outcome<Self::Wide>;
    /// Widens a number; `None` if it is none.
    fn widen(raw: Self::Raw) -> Option<Self::Wide>;
    /// The depth of a mesh's vertex as it stands in memory, 32 bits; `None` if it is out of range.
    fn depth(bits: u32) -> Option<Self::Wide>;
    /// The w of a mesh whose vertices have none: 1.
    fn one() -> Self::Wide;
    /// The corner as the raster takes it; `None` if it must be clipped. `near` is that of a mesh that has w.
    fn project(corner: &Wide<Self::Wide>, near: Option<Self::Wide>) -> Option<Ready>;
    /// The distance of a point from a plane of the guard band: `LIMIT·w ± c`.
    fn distance(w: Self::Wide, c: Self::Wide, positive: bool) -> Self::Wide;
    /// The difference of two numbers.
    fn minus(a: Self::Wide, b: Self::Wide) -> Self::Wide;
    /// `LIMIT·w`, or what is as far on the other side.
    fn at_limit(w: Self::Wide, positive: bool) -> Self::Wide;
    /// The point between `a`, inside, and `b`, outside, whose distances from a plane are `inside` and `outside`. With `by`
    /// it is that of values that are linear on the screen: the ratio of `b`'s w to the point's.
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

/// The least whole number that is not below `x`'s floor: `floor(x)`, for what fits.
fn floor(x: f64) -> i64 {
    let whole = x as i64;
    if whole as f64 > x { whole - 1 } else { whole }
}

/// 0 to 255 in 8.8.
fn byte_of_float(x: f64) -> u16 {
    (x.clamp(0.0, 255.0) * 256.0 + 0.5) as u16
}

fn byte_of_fixed(x: i64) -> u16 {
    ((x.clamp(0, 255 << 16) + 128) >> 8) as u16
}

/// A corner of coordinates in 1/256 pixel; `None` if it must be clipped.
fn ready(x: I24F8, y: I24F8, shade: u16, depth: u32, attributes: Attributes) -> Option<Ready> {
    let inside = |c: I24F8| (-REACH..=REACH).contains(&c.to_bits());
    if !inside(x) || !inside(y) {
        return None;
    }
    let vertex = Vertex::new(x, y, U8F8::from_bits(shade), depth).ok()?;
    Some(Ready { vertex, attributes })
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

    #[inline]
    fn project(corner: &Wide<f64>, near: Option<f64>) -> Option<Ready> {
        let Wide { x, y, w, depth, values, .. } = corner;
        let (x, y, depth) = match near {
            None => (*x, *y, *depth),
            Some(near) if *w >= near => (x / w, y / w, (near / w).min(1.0)),
            Some(_) => return None,
        };
        let attributes = Attributes {
            // What is too large wraps, as the texture does.
            texture: values.texture.map(|c| floor(c * 65_536.0 + 0.5) as i32),
            fog: byte_of_float(values.fog),
            slope: values.slope.map(byte_of_float),
        };
        // At most 2³⁰.
        let depth = (depth * 1_073_741_824.0 + 0.5) as u32;
        ready(I24F8::round_from_f64(x)?, I24F8::round_from_f64(y)?, byte_of_float(values.shade), depth, attributes)
    }

    fn distance(w: f64, c: f64, positive: bool) -> f64 {
        let limit = f64::from(LIMIT) * w;
        if positive { limit + c } else { limit - c }
    }

    fn minus(a: f64, b: f64) -> f64 {
        a - b
    }

    fn at_limit(w: f64, positive: bool) -> f64 {
        let limit = f64::from(LIMIT) * w;
        if positive { limit } else { -limit }
    }

    /// The mean of both, each weighted with the other's distance: of numbers of one sign no digit is lost.
    fn between(a: f64, b: f64, inside: f64, outside: f64, by: Option<[f64; 2]>) -> f64 {
        match by {
            None => (b * inside - a * outside) / (inside - outside),
            Some([of, to]) => {
                let part = inside / (inside - outside) * (of / to);
                (a + (b - a) * part).max(a.min(b)).min(a.max(b))
            }
        }
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

    #[inline]
    fn project(corner: &Wide<i64>, near: Option<i64>) -> Option<Ready> {
        let Wide { x, y, w, depth, values, .. } = corner;
        let attributes = Attributes {
            texture: values.texture.map(|c| c as i32),
            fog: byte_of_fixed(values.fog),
            slope: values.slope.map(byte_of_fixed),
        };
        let (x, y, depth) = match near {
            // Those of a mesh are 32 bits; of a cut, between two that are.
            None => {
                let pixels = |c: i64| I24F8::round_from_i16f16(I16F16::from_bits(c as i32));
                (pixels(*x), pixels(*y), *depth as u32)
            }
            Some(near) if *w >= near => {
                // floor(256·x/w + ½); i32 after the check.
                let pixels = |c: i64| {
                    let c = (512 * c + w).div_euclid(2 * w);
                    i32::try_from(c).ok().map(I24F8::from_bits)
                };
                // nearest(2³⁰·near/w), at most 2³⁰.
                (pixels(*x)?, pixels(*y)?, (((near << 31) + w) / (2 * w)) as u32)
            }
            Some(_) => return None,
        };
        ready(x, y, byte_of_fixed(values.shade), depth, attributes)
    }

    fn distance(w: i64, c: i64, positive: bool) -> i64 {
        let limit = i64::from(LIMIT) * w;
        if positive { limit + c } else { limit - c }
    }

    fn minus(a: i64, b: i64) -> i64 {
        a - b
    }

    fn at_limit(w: i64, positive: bool) -> i64 {
        let limit = i64::from(LIMIT) * w;
        if positive { limit } else { -limit }
    }

    /// The nearest, halves upward. Numbers are below 2⁴⁵ (12 bits of the limit, 32 of w and a sign), products below 2⁹².
    fn between(a: i64, b: i64, inside: i64, outside: i64, by: Option<[i64; 2]>) -> i64 {
        let (a, b, inside, outside) = (i128::from(a), i128::from(b), i128::from(inside), i128::from(outside));
        let whole = inside - outside;
        let point = match by {
            None => (2 * (b * inside - a * outside) + whole).div_euclid(2 * whole),
            Some([of, to]) => {
                // 2³⁰ parts, so that products stay small.
                let part = (((inside * i128::from(of)) << 30) / whole / i128::from(to)).clamp(0, 1 << 30);
                a + (((b - a) * part) >> 30)
            }
        };
        point.clamp(a.min(b), a.max(b)) as i64
    }
}

/// A mesh whose arrays have been checked.
pub(crate) struct Source {
    mesh: Mesh,
    /// The values that the material reads.
    wants_effects: bool,
}

/// Bytes of a mesh's parts.
pub(crate) struct Parts {
    pub(crate) vertices: usize,
    pub(crate) indices: usize,
}

impl Source {
    /// Checks all of a mesh but its indices' values.
    pub(crate) fn new(mesh: Mesh, has_shade: bool, wants_effects: bool) -> Outcome<(Self, Parts)> {
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
            && fits(depth, 1, false)
            && fits(shade, 1, has_shade)
            && fits(texture, 2, false)
            && fits(fog, 1, false)
            && fits(slope, 2, false);
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
        Ok((Self { mesh, wants_effects }, parts))
    }

    /// The number of its triangles.
    pub(crate) fn triangles(&self) -> u32 {
        if self.mesh.indices.is_null() { self.mesh.vertex_count / 3 } else { self.mesh.index_count / 3 }
    }

    /// Index `i`, which is below the number of indices.
    ///
    /// # Safety
    /// The mesh holds as many indices as it says.
    #[inline]
    pub(crate) unsafe fn index(&self, i: u32) -> u32 {
        let Mesh { indices, index_bits, .. } = self.mesh;
        let i = i as usize;
        // SAFETY: the bytes of the indices are there, and no more than half of memory.
        unsafe {
            match index_bits {
                _ if indices.is_null() => i as u32,
                8 => indices.cast::<u8>().add(i).read().into(),
                16 => indices.cast::<u16>().add(i).read_unaligned().into(),
                _ => indices.cast::<u32>().add(i).read_unaligned(),
            }
        }
    }

    /// Refuses an index of a vertex that is not there.
    ///
    /// # Safety
    /// The mesh holds as many indices as it says.
    pub(crate) unsafe fn check_indices(&self) -> Outcome {
        let mut most = 0;
        for i in 0..3 * self.triangles() {
            // SAFETY: by the caller.
            most = most.max(unsafe { self.index(i) });
        }
        // An empty list has none.
        if self.triangles() > 0 && most >= self.mesh.vertex_count { Err(Refusal::Index) } else { Ok(()) }
    }

    /// Vertex `i`; `None` if one of its numbers is none, or out of range.
    ///
    /// # Safety
    /// It is below the number of vertices, and the mesh holds as many as it says.
    #[inline]
    pub(crate) unsafe fn corner<D: Door>(&self, i: u32, near: Option<D::Wide>) -> Option<Wide<D::Wide>> {
        let Mesh { vertices, stride, position, depth, shade, texture, fog, slope, .. } = self.mesh;
        // SAFETY: the bytes of the vertices are there, and no more than half of memory.
        let vertex = unsafe { vertices.cast::<u8>().add(i as usize * stride as usize) };
        let number = |offset: u32| {
            // SAFETY: the number ends within the stride.
            D::widen(unsafe { vertex.add(offset as usize).cast::<D::Raw>().read_unaligned() })
        };
        let optional = |offset: u32| if offset == ABSENT { Some(D::Wide::default()) } else { number(offset) };
        let two = |offset: u32| match offset {
            ABSENT => Some([D::Wide::default(); 2]),
            _ => Some([number(offset)?, number(offset + 4)?]),
        };
        let [x, y] = two(position)?;
        let values = if self.wants_effects {
            Values { shade: optional(shade)?, texture: two(texture)?, fog: optional(fog)?, slope: two(slope)? }
        } else {
            Values { shade: optional(shade)?, ..Values::default() }
        };
        let w = if near.is_some() { number(position + 8)? } else { D::one() };
        let depth = if depth == ABSENT || near.is_some() {
            D::Wide::default()
        } else {
            // SAFETY: the number ends within the stride.
            D::depth(unsafe { vertex.add(depth as usize).cast::<u32>().read_unaligned() })?
        };
        let mut corner = Wide { x, y, w, depth, values, ready: None };
        corner.ready = D::project(&corner, near);
        Some(corner)
    }
}
