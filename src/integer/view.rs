//! From a mesh's own coordinates to the screen: one matrix per object, one division per coordinate.
//!
//! ```text
//! X = right · d    Y = −(up · d)    W = forward · d         d from the eye to the point; 1/65,536 unit
//! x = cx + fx · X / W               y = cy + fy · Y / W     in pixels; fx, fy in 1/65,536 pixel
//! ```
//!
//! **What is rounded.** X, Y and W are integers: a sum of three products of 16.16 numbers, rounded
//! to the nearest 1/65,536 once. The projected coordinate is then the exact rational
//! `cx + fx·X / (65,536·W)`, which is rounded to floor(256·x + ½) exactly:
//!
//! ```text
//! floor(256·x + ½) = 256·cx + floor((fx·X + 128·W) / (256·W))       256·cx = 128·width: whole
//! ```
//!
//! **Why nothing overflows.** An object is rejected unless all of it stays within 2³² units of 1/65,536
//! ([`ObjectView::REACH`]) of the eye along each axis of the view, and focal lengths are at most 2³⁰. So fx·X is at
//! most 2⁶² and 128·W at most 2³⁹: the sum fits in i64, and 256·W is at most 2⁴⁰. Bounds on the intermediate sums are
//! given where they are computed.

use super::IntegerError;
use super::angle::{BinaryAngle, SINE_BITS};
use super::mesh::{FixedMesh, VertexIndex, square};
use super::vector::{Matrix, Vector, Wide, cross, dot, product, round_shift, unit, wide_turn, widen};
use crate::fixed::{I16F16, I24F8, U8F8};
use crate::raster::{Frame, Vertex};

/// The picture's size in pixels, and its focal lengths.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug)]
pub struct Lens {
    pub(super) width: u32,
    pub(super) height: u32,
    /// fx and fy in 1/65,536 pixel, 1 to 2³⁰.
    pub(super) focal: [i64; 2],
}

impl Lens {
    /// The longest focal length: 16,384 pixels, in 1/65,536 pixel.
    const LONGEST: i64 = 1 << 30;

    /// A picture of `width` × `height` pixels, each 1 to 4,096, whose pixels have the aspect ratio `pixel_aspect`,
    /// width to height: 5:6 in mode 13h. `field_of_view` is the vertical one.
    ///
    /// fy = height/2 · cot(½ field of view), fx = fy · pixel height / pixel width.
    ///
    /// # Errors
    /// A side or a part of the aspect ratio is 0 or too large; the angle is 0, half a turn or more, or so small that a
    /// focal length exceeds 16,384 pixels.
    pub fn new(
        width: u32,
        height: u32,
        pixel_aspect: (u32, u32),
        field_of_view: BinaryAngle,
    ) -> Result<Self, IntegerError> {
        if field_of_view == BinaryAngle::default()
            || u16::from(field_of_view) >= u16::from(BinaryAngle::HALF)
            || pixel_aspect.0 == 0
        {
            return Err(IntegerError::FieldOfView);
        }
        let (sine, cosine) = field_of_view.sin_cos();
        // cot(a/2) = (1 + cos a) / sin a; the sine of the least angle is 102,944. Below 2¹² · 2¹⁵ · 2³¹.
        let fy = (i64::from(height.min(Frame::MAX_SIDE)) << 15) * ((1 << SINE_BITS) + cosine) / sine;
        // fy is below 2⁴², and the aspect below 2³².
        let fx = i128::from(fy) * i128::from(pixel_aspect.1) / i128::from(pixel_aspect.0);
        Self::checked(width, height, [fx, i128::from(fy)])
    }

    /// A picture of `width` × `height` pixels, with the focal lengths fx and fy in pixels.
    ///
    /// # Errors
    /// A side is 0 or above 4,096; a focal length is not above 0, or is above 16,384 pixels.
    pub fn with_focal_lengths(width: u32, height: u32, focal: [I16F16; 2]) -> Result<Self, IntegerError> {
        Self::checked(width, height, focal.map(|f| i128::from(f.to_bits())))
    }

    fn checked(width: u32, height: u32, focal: [i128; 2]) -> Result<Self, IntegerError> {
        let sides = 1..=Frame::MAX_SIDE;
        if !sides.contains(&width) || !sides.contains(&height) {
            return Err(IntegerError::Size);
        }
        if focal.iter().any(|f| !(1..=i128::from(Self::LONGEST)).contains(f)) {
            return Err(IntegerError::FieldOfView);
        }
        // In range, as checked above.
        Ok(Self { width, height, focal: focal.map(|f| f as i64) })
    }
}

/// A perspective camera in 16.16.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug)]
pub struct Camera {
    /// The position of the eye, in units of the scene.
    pub eye: Vector,
    /// The point that it looks at, in the middle of the picture.
    pub target: Vector,
    /// The direction that is up in the picture; any length. If it is parallel to the view, another axis is used.
    pub up: Vector,
    /// The near distance, above 0: nothing nearer is drawn. It also sets the unit of depth.
    pub near: I16F16,
}

/// The camera's part of the transform: from the scene to the screen.
#[derive(Clone, Copy, Debug)]
pub struct View {
    eye: Wide,
    /// Right, down and forward, of length 2³⁰.
    axes: Matrix,
    lens: Lens,
    near: i64,
}

impl View {
    /// Makes the view of `camera` through `lens`.
    ///
    /// # Errors
    /// The camera's target is its own position; the near distance is not above 0.
    pub fn new(camera: &Camera, lens: Lens) -> Result<Self, IntegerError> {
        let near = i64::from(camera.near.to_bits());
        if near <= 0 {
            return Err(IntegerError::Near);
        }
        let (eye, target) = (widen(camera.eye), widen(camera.target));
        let to_target = [0, 1, 2].map(|i| i128::from(target[i] - eye[i]));
        let forward = unit(to_target, SINE_BITS).ok_or(IntegerError::Direction)?;
        let right = right_of(forward, camera.up).ok_or(IntegerError::Direction)?;
        let up = unit(cross(right, forward), SINE_BITS).ok_or(IntegerError::Direction)?;
        Ok(Self { eye, axes: [right, up.map(|c| -c), forward], lens, near })
    }

    /// Checks that `mesh` can be drawn with this placement.
    ///
    /// # Errors
    /// A scale below 0; a mesh that may reach farther than 65,535 units from the eye.
    pub fn check<I: VertexIndex>(&self, placement: &Placement, mesh: &FixedMesh<'_, I>) -> Result<(), IntegerError> {
        ObjectView::new(self, placement, mesh).map(|_| ())
    }
}

/// The unit vector to the right of `forward`. If `up` is within 10⁻⁶ of the view direction, the axis farthest from it
/// is used, as in the f32 path.
fn right_of(forward: Wide, up: Vector) -> Option<Wide> {
    let least = (0..3).fold(0, |best, i| if forward[i].abs() < forward[best].abs() { i } else { best });
    let mut axis = [0; 3];
    axis[least] = 1 << SINE_BITS;
    let by_up = unit(widen(up).map(i128::from), SINE_BITS).map(|up| cross(forward, up));
    // Components with 60 fractional bits, at most 2⁶¹; 2⁶⁰ · 10⁻⁶ is 2⁴⁰.
    let is_aslant = |right: &[i128; 3]| right.iter().map(|c| c * c).sum::<i128>() > 1 << 80;
    by_up.filter(is_aslant).and_then(|right| unit(right, SINE_BITS)).or_else(|| unit(cross(forward, axis), SINE_BITS))
}

/// An object's position, rotation and scale.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug)]
pub struct Placement {
    /// The position of the pivot, in units of the scene.
    pub position: Vector,
    /// The point that it rotates about, in the mesh's coordinates.
    pub pivot: Vector,
    /// The angles about x, y and z: the rotation about z is applied first, then y, then x.
    pub angles: [BinaryAngle; 3],
    /// The scale factor of the mesh; not negative.
    pub scale: I16F16,
}

impl Default for Placement {
    /// Places the mesh at the origin, unscaled and unrotated.
    fn default() -> Self {
        Self {
            position: Vector::default(),
            pivot: Vector::default(),
            angles: [BinaryAngle::default(); 3],
            scale: I16F16::ONE,
        }
    }
}

/// A vertex before the perspective division: X, Y and W in 1/65,536 of the scene's unit, within
/// ±2³².
pub(super) type Homogeneous = Wide;

/// The whole transform of an object, from its mesh to the screen.
///
/// A vertex p becomes `((matrix · p + offset) >> shift) + translation`: the matrix is the object's rotation in camera
/// space times the scale, whose power of two is left to the shift, so that the entries keep 16 fractional bits at any
/// scale.
#[derive(Clone, Copy, Debug)]
pub(super) struct ObjectView {
    matrix: Matrix,
    offset: Wide,
    shift: u32,
    translation: Wide,
    /// The object's rotation alone, from object space to the scene; rows have length 2³⁰.
    turn: Matrix,
    pub(super) lens: Lens,
    pub(super) near: i64,
}

impl ObjectView {
    /// The max distance of an object's point from the eye along an axis of the view: 65,536 units, in 1/65,536.
    pub(super) const REACH: i64 = 1 << 32;

    /// The limit of projected coordinates, in quarter pixels, in both directions; points beyond it are clipped. It is
    /// beyond the last pixel centre of the largest frame, 4,095.5, and inside the raster's guard band by a quarter of a
    /// pixel.
    pub(super) const LIMIT: i64 = 4 * 4096 - 1;

    /// The greatest coordinate of a vertex, in 1/256 pixel: a quarter of a pixel beyond the limit, because rounding may
    /// move a clipped point off it.
    pub(super) const FARTHEST: i128 = (Self::LIMIT * 64 + 64) as i128;

    pub(super) fn new<I: VertexIndex>(
        view: &View,
        placement: &Placement,
        mesh: &FixedMesh<'_, I>,
    ) -> Result<Self, IntegerError> {
        let turn = wide_turn(placement.angles);
        let turned = product(&view.axes, &turn);
        let (mantissa, exponent) = normalised(placement.scale)?;
        // At most slightly above 2¹⁷ · 2³⁰; the matrix then at most slightly above 2¹⁷.
        let matrix = turned.map(|row| row.map(|c| round_shift(mantissa * c, SINE_BITS)));

        // At most 2³² each; a row has length 2³⁰, so the sum, and each part of it, is at most √3 · 2³² · 2³⁰ < 2⁶³.
        let position = widen(placement.position);
        let to_position = [0, 1, 2].map(|i| position[i] - view.eye[i]);
        let translation = view.axes.map(|axis| round_shift(dot(axis, to_position), SINE_BITS));

        // A position of 2¹⁶ in the mesh, times a scale of 2¹⁶, is 2^exponent in the scene.
        let shift = 16 - (exponent + mesh.parts.exponent);
        if shift < 0 {
            return Err(IntegerError::TooFar);
        }
        // A shift by more than 50 bits leaves nothing of any sum: the object is a point.
        let shift = shift.min(62) as u32;
        let far = mesh.radius + square(placement.pivot).isqrt() + 1;
        // The max distance of a vertex from the pivot along any axis: at most 2³³ · (2¹⁷ + 2) < 2⁵¹. The rows exceed
        // the scale by less than 2, because their entries are rounded.
        let reach = ((far as i64 * (mantissa + 2)) >> shift) + 1;
        if translation.iter().any(|c| c.abs() + reach >= Self::REACH) {
            return Err(IntegerError::TooFar);
        }
        // The offset includes the half unit that makes the shift round to the nearest. It is at
        // most 2⁶¹ + 3 · 2¹⁷ · 2³¹, and a vertex adds at most 3 · 2¹⁷ · 2³¹.
        let half = if shift == 0 { 0 } else { 1 << (shift - 1) };
        let pivot = widen(placement.pivot);
        let offset = matrix.map(|row| half - dot(row, pivot));
        Ok(Self { matrix, offset, shift, translation, turn, lens: view.lens, near: view.near })
    }

    /// Transforms a direction of the scene, of length 2³⁰, into object space, with length 65,536.
    pub(super) fn direction_in_object(&self, world: Wide) -> Vector {
        let column = |j: usize| [self.turn[0][j], self.turn[1][j], self.turn[2][j]];
        // Sums are below 2⁶²; results within ±65,536.
        [0, 1, 2].map(|j| I16F16::from_bits(round_shift(dot(column(j), world), 2 * SINE_BITS - 16) as i32))
    }

    /// A vertex before the perspective division.
    #[inline]
    pub(super) fn homogeneous(&self, p: Vector) -> Homogeneous {
        let p = widen(p);
        [0, 1, 2].map(|i| ((dot(self.matrix[i], p) + self.offset[i]) >> self.shift) + self.translation[i])
    }

    /// The vertex on the screen, without its shade; `None` if it must be clipped.
    #[inline]
    pub(super) fn project(&self, [x, y, w]: Homogeneous) -> Option<Vertex> {
        if w < self.near {
            return None;
        }
        let [fx, fy] = self.lens.focal;
        let (cx, cy) = (i64::from(self.lens.width) * 128, i64::from(self.lens.height) * 128);
        let x = cx + (fx * x + 128 * w).div_euclid(256 * w);
        let y = cy + (fy * y + 128 * w).div_euclid(256 * w);
        // nearest(2³⁰ · near / w), at most 2³⁰: near is at most w, and below 2³¹.
        let depth = (((self.near << 31) + w) / (2 * w)) as u32;
        vertex(i128::from(x), i128::from(y), U8F8::default(), depth)
    }
}

/// A vertex from coordinates in 1/256 pixel; `None` if they exceed [`ObjectView::FARTHEST`].
#[inline]
pub(super) fn vertex(x: i128, y: i128, shade: U8F8, depth: u32) -> Option<Vertex> {
    let most = ObjectView::FARTHEST;
    let within = |c: i128| (-most..=most).contains(&c).then_some(I24F8::from_bits(c as i32));
    Vertex::new(within(x)?, within(y)?, shade, depth).ok()
}

/// Splits a scale into a mantissa, 65,536 to 131,071, and an exponent; for 0 the mantissa is 0.
fn normalised(scale: I16F16) -> Result<(i64, i32), IntegerError> {
    let bits = scale.to_bits();
    if bits < 0 {
        return Err(IntegerError::Scale);
    }
    if bits == 0 {
        return Ok((0, 0));
    }
    // 0 to 30 bits below the highest.
    let exponent = 15 - bits.leading_zeros() as i32;
    let bits = i64::from(bits);
    Ok((if exponent >= 0 { bits >> exponent } else { bits << -exponent }, exponent))
}
