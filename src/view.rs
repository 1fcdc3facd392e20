//! From a mesh's own coordinates to the screen: one matrix per object, then one division per vertex.
//!
//! Camera space is chosen so that projecting takes two products and two sums:
//!
//! ```text
//! X = fx·(right · d)    Y = −fy·(up · d)    W = forward · d        d from the eye to the point
//! x = cx + X / W        y = cy + Y / W                             in pixels
//! ```
//!
//! fy is half the picture's height over the tangent of half the field of view, and fx is fy times the height of a pixel
//! over its width: 6/5 in mode 13h, whose 320 × 200 pixels fill a 4:3 screen.

use glam::{Mat3, Vec3};

use crate::angle::Angle;
use crate::fixed::{I24F8, U8F8};
use crate::mesh::Bounds;
use crate::mesh::wide::{dot, sub, widen};
use crate::raster::{Rect, Vertex};
use crate::scene::framing::{axes, unit};
use crate::scene::object::Placement;
use crate::scene::{Camera, Object, matrix_product};

/// The screen: size in pixels, and the shape of a pixel.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug)]
pub struct Screen {
    /// The number of columns, at most 4,096 to be drawn.
    pub width: u32,
    /// The number of rows, at most 4,096 to be drawn.
    pub height: u32,
    /// The aspect ratio of a pixel, width to height.
    pub pixel_aspect: (u32, u32),
}

impl Screen {
    /// 320 × 200, with 5:6 pixels.
    pub const MODE_13H: Self = Self { width: 320, height: 200, pixel_aspect: (5, 6) };

    /// Checks that the screen's size and pixel aspect ratio are above 0.
    pub(crate) fn check(self) -> Result<(), &'static str> {
        let Self { width, height, pixel_aspect: (pixel_width, pixel_height) } = self;
        match [width, height, pixel_width, pixel_height].contains(&0) {
            true => Err("its width, height and pixel aspect ratio must be above 0"),
            false => Ok(()),
        }
    }

    /// fx and fy, in pixels, for a vertical field of view.
    pub(crate) fn focal_lengths(self, field_of_view: Angle) -> [f64; 2] {
        let (pixel_width, pixel_height) = self.pixel_aspect;
        let fy = f64::from(self.height) / 2.0 / libm::tan(field_of_view.to_radians() / 2.0);
        [fy * f64::from(pixel_height) / f64::from(pixel_width), fy]
    }
}

type Row = [f64; 3];
type Matrix = [Row; 3];

/// The camera's part of the transform: from the world to the screen.
#[derive(Clone, Copy, Debug)]
pub(crate) struct View {
    eye: Row,
    /// The rows that give X, Y and W.
    rows: Matrix,
    /// Unit vectors right, up and towards the eye.
    axes: Matrix,
    /// The screen, in pixels.
    size: (f64, f64),
    /// The centre of the screen, in pixels.
    centre: (f32, f32),
    near: f32,
}

impl View {
    pub(crate) fn new(camera: &Camera, screen: Screen) -> Result<Self, &'static str> {
        let Camera { eye, target, up, field_of_view, near } = *camera;
        if !(eye.is_finite() && target.is_finite() && up.is_finite()) {
            return Err("its positions must be finite");
        }
        // NaN fails this comparison.
        if !(near > 0.0 && near <= f32::MAX) {
            return Err("its near distance must be above 0 and finite");
        }
        if !(field_of_view > Angle::default() && field_of_view < Angle::TURN / 2.0) {
            return Err("its field of view must be above 0 and below 180°");
        }
        let (eye, up) = (widen(eye), widen(up));
        let Some(forward) = unit(sub(widen(target), eye)) else {
            return Err("it looks at its own position");
        };
        let Some([right, up, backward]) = axes(forward, up) else {
            return Err("it has no right-hand side");
        };

        let (width, height) = (f64::from(screen.width), f64::from(screen.height));
        let [fx, fy] = screen.focal_lengths(field_of_view);
        Ok(Self {
            eye,
            rows: [right.map(|c| fx * c), up.map(|c| -fy * c), forward],
            axes: [right, up, backward],
            size: (width, height),
            // Halves of integers up to 4,096: exact.
            centre: ((width / 2.0) as f32, (height / 2.0) as f32),
            near,
        })
    }

    /// The screen position of a world point, in pixels, and its distance in front of the eye; `None` if it is nearer
    /// than the near distance.
    pub(crate) fn on_screen(&self, world: Vec3) -> Option<[f64; 3]> {
        let from_eye = sub(widen(world), self.eye);
        let [x, y, distance] = self.rows.map(|row| dot(row, from_eye));
        let (cx, cy) = (f64::from(self.centre.0), f64::from(self.centre.1));
        // NaN fails.
        (distance >= f64::from(self.near)).then(|| [cx + x / distance, cy + y / distance, distance])
    }

    /// Transforms a world direction to a unit vector in eye space (right, up, towards the eye); `None` for the zero
    /// vector.
    pub(crate) fn direction_to_eye(&self, world: Vec3) -> Option<Vec3> {
        let world = unit(widen(world))?;
        let [x, y, z] = self.axes.map(|axis| dot(axis, world) as f32);
        Some(Vec3::new(x, y, z))
    }
}

impl Camera {
    /// Projects a point of the scene onto the screen, for labels, crosshairs and flares: x and y in pixels from the
    /// upper left corner, and the distance in front of the eye, along the view. The point may be off the screen. `None`
    /// if it is nearer than the near distance, behind the eye, or not finite, or if the camera or the screen is
    /// invalid.
    ///
    /// ```
    /// use mode13h::glam::Vec3;
    /// use mode13h::render::Screen;
    /// use mode13h::scene::Camera;
    ///
    /// let camera = Camera::framing(Vec3::ZERO, 2.0);
    /// let [x, y, distance] = camera.project(Vec3::ZERO, Screen::MODE_13H).expect("it looks at the point");
    /// assert_eq!([x, y], [160.0, 100.0]);
    /// assert!((distance - camera.eye.z).abs() < 1e-5);
    /// assert_eq!(camera.project(camera.eye, Screen::MODE_13H), None);
    /// ```
    #[must_use]
    pub fn project(&self, point: impl Into<Vec3>, screen: Screen) -> Option<[f32; 3]> {
        screen.check().ok()?;
        let on_screen = View::new(self, screen).ok()?.on_screen(point.into())?;
        Some(on_screen.map(|c| c as f32)).filter(|on_screen| on_screen.iter().all(|c| c.is_finite()))
    }

    /// The direction from the eye through a point of the screen, as a unit vector, for picking: the inverse of
    /// [`project`](Self::project). The point is in pixels from the upper left corner, and may be off the screen; the
    /// centre of pixel (x, y) is at (x + ½, y + ½). `None` if the point is not finite, or the camera or the screen is
    /// invalid.
    ///
    /// ```
    /// use mode13h::glam::Vec3;
    /// use mode13h::render::Screen;
    /// use mode13h::scene::Camera;
    ///
    /// let camera = Camera::framing(Vec3::ZERO, 2.0);
    /// let centre = camera.ray([160.0, 100.0], Screen::MODE_13H).expect("a valid camera");
    /// assert_eq!(centre, -Vec3::Z);
    /// ```
    #[must_use]
    pub fn ray(&self, [x, y]: [f32; 2], screen: Screen) -> Option<Vec3> {
        screen.check().ok()?;
        let view = View::new(self, screen).ok()?;
        let [fx, fy] = screen.focal_lengths(self.field_of_view);
        let right = (f64::from(x) - f64::from(view.centre.0)) / fx;
        let up = (f64::from(view.centre.1) - f64::from(y)) / fy;
        let along: Row = core::array::from_fn(|i| right * view.axes[0][i] + up * view.axes[1][i] - view.axes[2][i]);
        let [x, y, z] = unit(along).filter(|along| along.iter().all(|c| c.is_finite()))?;
        Some(Vec3::new(x as f32, y as f32, z as f32))
    }
}

/// The whole transform of an object, from object space to the screen.
#[derive(Clone, Copy, PartialEq, Debug)]
pub(crate) struct ObjectView {
    exact: (Matrix, Row),
    /// The transform of `exact` in f32; `None` if the object extends so far that f32 could overflow.
    fast: Option<(Mat3, Vec3)>,
    centre: (f32, f32),
    /// The near plane's distance.
    pub(crate) near: f32,
    /// The rotation alone, from object space to the world.
    turn: Matrix,
    /// The rotation from object space to eye space: right, up, towards the eye.
    to_eye: Matrix,
    /// The eye, in object space.
    pub(crate) eye: Row,
    position: Row,
    pivot: Row,
    /// The scale factor of the mesh.
    pub(crate) scale: f64,
    size: (f64, f64),
}

/// The region of space and screen where an object may be visible after near clipping: slightly larger than the object.
#[derive(Clone, Copy, PartialEq, Debug)]
pub(crate) struct ScreenBounds {
    /// The least distance along the view; may be negative.
    pub(crate) nearest: f64,
    /// The greatest distance along the view.
    pub(crate) farthest: f64,
    /// Whether part of it may be nearer than the near plane.
    pub(crate) crosses_near: bool,
    /// Whether part of it may be projected beyond the screen's edges.
    pub(crate) leaves_screen: bool,
    /// The part of the screen where it may be.
    pub(crate) seen: Rect,
}

impl ScreenBounds {
    /// Returns whether none of it can be seen: all of it is off the screen, or nearer than this near plane.
    pub(crate) fn is_out_of_sight(&self, near: f32) -> bool {
        self.seen.is_empty() || self.farthest < f64::from(near)
    }
}

/// A vertex before the perspective division: X and Y in pixels times W; W along the view.
#[derive(Clone, Copy, PartialEq, Debug)]
pub(crate) struct Homogeneous {
    pub(crate) x: f64,
    pub(crate) y: f64,
    pub(crate) w: f64,
}

/// An object's transform to the screen in f32, for vertices that are projected eight at a time.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Narrow {
    pub(crate) matrix: Mat3,
    pub(crate) offset: Vec3,
    pub(crate) centre: (f32, f32),
    pub(crate) near: f32,
}

impl Narrow {
    /// The largest coordinate, in pixels.
    pub(crate) const LIMIT: f32 = (ObjectView::LIMIT + ObjectView::ROOM) as f32;
}

const _: () = assert!(Vertex::GUARD_BAND as f32 >= Narrow::LIMIT * 256.0);

impl ObjectView {
    /// The limit of projected coordinates, in pixels, in both directions; points beyond it are clipped. It is beyond
    /// the last pixel centre of the largest frame, 4,095.5, and inside the raster's guard band by [`ROOM`](Self::ROOM).
    pub(crate) const LIMIT: f64 = 4095.75;

    /// The margin beyond the limit for the rounding error of clipped points, in pixels.
    pub(crate) const ROOM: f64 = 0.25;

    /// The reach beyond which a sum of products might overflow f32, or, below its inverse, underflow.
    const FAST_REACH: f64 = 1e30;

    /// The transform of an object without a parent.
    #[cfg(test)]
    pub(crate) fn new(view: &View, object: &Object) -> Self {
        Self::placed(view, object, &Placement::of(object))
    }

    pub(crate) fn placed(view: &View, object: &Object, placement: &Placement) -> Self {
        let Placement { turn, scale, position } = *placement;
        let matrix = matrix_product(&view.rows, &turn).map(|row| row.map(|c| c * scale));
        let pivot = widen(object.pivot);
        let to_position = [position[0] - view.eye[0], position[1] - view.eye[1], position[2] - view.eye[2]];
        let mut offset = [0.0; 3];
        for (i, c) in offset.iter_mut().enumerate() {
            *c = dot(view.rows[i], to_position) - dot(matrix[i], pivot);
        }
        let bounds = object.mesh().bounds();
        let far = widen(bounds.min.abs().max(bounds.max.abs()));
        let reach = |i: usize| dot(matrix[i].map(f64::abs), far) + offset[i].abs();
        let farthest = reach(0).max(reach(1)).max(reach(2));
        let fits = farthest < Self::FAST_REACH && farthest > 1.0 / Self::FAST_REACH;
        let fast = fits.then(|| {
            let narrow = |[x, y, z]: Row| Vec3::new(x as f32, y as f32, z as f32);
            (Mat3::from_cols(narrow(matrix[0]), narrow(matrix[1]), narrow(matrix[2])).transpose(), narrow(offset))
        });
        let mut this = Self {
            exact: (matrix, offset),
            fast,
            centre: view.centre,
            near: view.near,
            turn,
            to_eye: matrix_product(&view.axes, &turn),
            eye: [0.0; 3],
            position,
            pivot,
            scale,
            size: view.size,
        };
        this.eye = this.point_in_object(view.eye);
        this
    }

    /// Transforms a world point to object space; for an object of scale 0, returns the pivot.
    pub(crate) fn point_in_object(&self, world: [f64; 3]) -> [f64; 3] {
        if self.scale <= 0.0 {
            return self.pivot;
        }
        let from = [world[0] - self.position[0], world[1] - self.position[1], world[2] - self.position[2]];
        core::array::from_fn(|j| {
            self.pivot[j] + dot([self.turn[0][j], self.turn[1][j], self.turn[2][j]], from) / self.scale
        })
    }

    /// The transform in f32, unless f32 could overflow.
    pub(crate) fn narrow(&self) -> Option<Narrow> {
        let (matrix, offset) = self.fast?;
        Some(Narrow { matrix, offset, centre: self.centre, near: self.near })
    }

    /// The world position of the object's pivot.
    pub(crate) fn position(&self) -> Vec3 {
        Vec3::from_array(self.position.map(|c| c as f32))
    }

    /// The matrix from object space to eye space, for directions: right, up, towards the eye.
    pub(crate) fn directions_to_eye(&self) -> Mat3 {
        Mat3::from_cols_array_2d(&self.to_eye.map(|row| row.map(|c| c as f32))).transpose()
    }

    /// The bounds, in depth and on the screen, of a box in object space.
    ///
    /// Never inlined, so that `.ci/off_is_free` compares builds that compile it equally.
    #[inline(never)]
    pub(crate) fn reach(&self, bounds: Bounds) -> ScreenBounds {
        let (matrix, offset) = &self.exact;
        let (min, max) = (widen(bounds.min), widen(bounds.max));
        let far: Row = core::array::from_fn(|i| min[i].abs().max(max[i].abs()));
        let reach = |i: usize| dot(matrix[i].map(f64::abs), far) + offset[i].abs();
        // As in `depths`: more than the error of either vertex path.
        let slack: Row = core::array::from_fn(|i| reach(i) / 4096.0);
        // The products of each coordinate with its end, once for all corners.
        let products: [[Row; 2]; 3] = matrix.map(|row| [min, max].map(|end| core::array::from_fn(|i| row[i] * end[i])));
        let (mut nearest, mut farthest) = (f64::INFINITY, f64::NEG_INFINITY);
        let (mut low, mut high) = ([f64::INFINITY; 2], [f64::NEG_INFINITY; 2]);
        // Like `min` and `max`, these skip NaN in `b`, but compile to one instruction.
        let lesser = |a: f64, b: f64| if b < a { b } else { a };
        let greater = |a: f64, b: f64| if b > a { b } else { a };
        for corner in 0..8 {
            let [x, y, w] = core::array::from_fn(|i| {
                products[i][corner & 1][0] + products[i][corner >> 1 & 1][1] + products[i][corner >> 2][2] + offset[i]
            });
            (nearest, farthest) = (lesser(nearest, w), greater(farthest, w));
            // Only valid for corners in front of the eye. If one is not, the object crosses the
            // near plane, and these are not used.
            for (i, at) in [x / w, y / w].into_iter().enumerate() {
                (low[i], high[i]) = (lesser(low[i], at), greater(high[i], at));
            }
        }
        let (nearest, farthest) = (nearest - slack[2], farthest + slack[2]);
        let crosses_near = nearest <= f64::from(self.near) || nearest.is_nan();
        // A box in front of the eye projects into the convex hull of its projected corners. The
        // error of x = X/W is that of X plus |x| times that of W, over W, plus a pixel for
        // rounding.
        let (centre, size) = ([f64::from(self.centre.0), f64::from(self.centre.1)], [self.size.0, self.size.1]);
        let ends = |i: usize| {
            let off = (slack[i] + low[i].abs().max(high[i].abs()) * slack[2]) / nearest + 1.0;
            (centre[i] + low[i] - off, centre[i] + high[i] + off)
        };
        let inside = |i: usize| ends(i).0 >= 0.0 && ends(i).1 <= size[i];
        // Clamped to the screen, at most 4,096 pixels; NaN becomes the screen's edge.
        let pixels = |i: usize| {
            let (from, to) = if crosses_near { (0.0, size[i]) } else { ends(i) };
            (from.max(0.0) as u32, libm::ceil(to).min(size[i]).max(0.0) as u32)
        };
        let ((x0, x1), (y0, y1)) = (pixels(0), pixels(1));
        let leaves_screen = crosses_near || !(inside(0) && inside(1));
        ScreenBounds { nearest, farthest, crosses_near, leaves_screen, seen: Rect { x0, y0, x1, y1 } }
    }

    /// Where a vertex is on the screen, in pixels, and its distance along the view.
    #[inline]
    fn screen_position(&self, p: Vec3) -> [f64; 3] {
        if let Some((matrix, offset)) = self.fast {
            let v = matrix * p + offset;
            let inverse = 1.0 / v.z;
            let (x, y) = (self.centre.0 + v.x * inverse, self.centre.1 + v.y * inverse);
            return [f64::from(x), f64::from(y), f64::from(v.z)];
        }
        let Homogeneous { x, y, w } = self.homogeneous(p);
        let (cx, cy) = self.centre();
        [cx + x / w, cy + y / w, w]
    }

    /// Projects a vertex of an object that neither crosses the near plane nor leaves the screen.
    /// The results equal those of [`project`](Self::project).
    #[inline]
    pub(crate) fn project_inside(&self, p: Vec3) -> Vertex {
        let [x, y, w] = self.screen_position(p);
        let at = |c: f64| I24F8::round_from_f64(c).unwrap_or_default();
        Vertex::new(at(x), at(y), U8F8::default(), self.depth(w)).unwrap_or_default()
    }

    /// Transforms a world direction to a unit vector in object space; `None` for the zero vector.
    pub(crate) fn direction_in_object(&self, world: Vec3) -> Option<[f64; 3]> {
        let world = unit(widen(world))?;
        Some(core::array::from_fn(|j| dot([self.turn[0][j], self.turn[1][j], self.turn[2][j]], world)))
    }

    /// The longer side of a pixel at a distance along the view, in units of the object's mesh.
    pub(crate) fn longest_pixel(&self, distance: f64) -> f64 {
        // The lengths of the matrix's first two rows are the width and height in pixels of a mesh
        // unit at distance 1.
        let [across, down, _] = self.exact.0.map(|row| libm::sqrt(dot(row, row)));
        distance / across.min(down)
    }

    /// Returns whether a vertex is at least as far away as the near plane, by the test that clipping uses.
    pub(crate) fn is_far_enough(&self, p: Vec3) -> bool {
        self.homogeneous(p).w >= f64::from(self.near)
    }

    /// Returns whether the part of a triangle beyond the near plane is off the screen: all corners lie to one side of
    /// the screen, by more than a pixel.
    ///
    /// With f = x + (cx + 1)·w, a point is a pixel left of the screen where f < 0. Clipping interpolates its points
    /// between two corners in f64, at most five times in succession, so their f is off by less than 2⁻⁴⁰ of a corner's
    /// largest term; and rounding to 1/256 pixel moves them by less than the pixel.
    pub(crate) fn is_off_screen(&self, corners: &[Homogeneous; 3]) -> bool {
        const SLACK: f64 = 1.0 / (1_u64 << 40) as f64;
        let (cx, cy) = self.centre();
        let (width, height) = self.size;
        let all_beyond = |c: fn(&Homogeneous) -> f64, pixels: f64| {
            let magnitude = corners.iter().fold(0.0_f64, |most, at| most.max(c(at).abs()).max((at.w * pixels).abs()));
            // False for NaN.
            corners.iter().all(|at| c(at) + at.w * pixels < -SLACK * magnitude)
        };
        all_beyond(|corner| corner.x, cx + 1.0)
            || all_beyond(|corner| -corner.x, width - cx + 1.0)
            || all_beyond(|corner| corner.y, cy + 1.0)
            || all_beyond(|corner| -corner.y, height - cy + 1.0)
    }

    /// The gradient of the distance along the view, in object space, and the distance of its origin.
    pub(crate) fn along_view(&self) -> ([f32; 3], f32) {
        let ([.., row], [.., offset]) = &self.exact;
        (row.map(|c| c as f32), *offset as f32)
    }

    /// A vertex before the perspective division. It does not depend on the triangle, so triangles
    /// that share the vertex agree on its position.
    #[inline]
    pub(crate) fn homogeneous(&self, p: Vec3) -> Homogeneous {
        match self.fast {
            Some((matrix, offset)) => {
                let v = matrix * p + offset;
                Homogeneous { x: f64::from(v.x), y: f64::from(v.y), w: f64::from(v.z) }
            }
            None => {
                let ([mx, my, mw], [ox, oy, ow]) = self.exact;
                let p = widen(p);
                Homogeneous { x: dot(mx, p) + ox, y: dot(my, p) + oy, w: dot(mw, p) + ow }
            }
        }
    }

    /// Projects a vertex, without its shade; `None` if it must be clipped.
    #[inline]
    pub(crate) fn project(&self, p: Vec3) -> Option<Vertex> {
        let [x, y, w] = self.screen_position(p);
        if w < f64::from(self.near) { None } else { self.vertex(x, y, w, U8F8::default()) }
    }

    /// Projects a point at or beyond the near plane to a vertex on the screen; `None` if it is
    /// beyond the limit.
    #[inline]
    pub(crate) fn divide(&self, h: Homogeneous, shade: U8F8) -> Option<Vertex> {
        let (cx, cy) = (f64::from(self.centre.0), f64::from(self.centre.1));
        self.vertex(cx + h.x / h.w, cy + h.y / h.w, h.w, shade)
    }

    /// The centre of the screen, in pixels.
    pub(crate) fn centre(&self) -> (f64, f64) {
        (f64::from(self.centre.0), f64::from(self.centre.1))
    }

    #[inline]
    fn vertex(&self, x: f64, y: f64, w: f64, shade: U8F8) -> Option<Vertex> {
        // NaN fails.
        if !(x.abs() <= Self::LIMIT + Self::ROOM && y.abs() <= Self::LIMIT + Self::ROOM) {
            return None;
        }
        Vertex::new(I24F8::round_from_f64(x)?, I24F8::round_from_f64(y)?, shade, self.depth(w)).ok()
    }

    /// The depth: round(2³⁰ · near / w).
    #[inline]
    fn depth(&self, w: f64) -> u32 {
        // near ≤ w, so this is at most 2³⁰, apart from a clipped point's rounding; the cast
        // truncates. There is no far plane: beyond 2³¹ times the near distance the formula gives 0,
        // the background's depth, and the maximum with 1 keeps faces in front of it.
        ((f64::from(self.near) / w * 1_073_741_824.0 + 0.5) as u32).max(1)
    }

    /// The least and the greatest depth that a vertex within `bounds` may have after near clipping;
    /// slightly wider than the true range.
    pub(crate) fn depths(&self, bounds: Bounds) -> (u32, u32) {
        let (row, offset) = (self.exact.0[2], self.exact.1[2]);
        let (min, max) = (widen(bounds.min), widen(bounds.max));
        let middle = dot(row, [0, 1, 2].map(|i| (min[i] + max[i]) / 2.0)) + offset;
        let size = dot(row.map(f64::abs), [0, 1, 2].map(|i| (max[i] - min[i]) / 2.0));
        let reach = dot(row.map(f64::abs), [0, 1, 2].map(|i| min[i].abs().max(max[i].abs()))) + offset.abs();
        // In f32, w takes four roundings of the matrix, three of products and three of sums, each of at most 2⁻²⁴ of
        // their reach. In 16.16, each of three angles has an error of at most π · 2⁻¹⁶, and each entry of the matrix
        // one of 2⁻¹⁷: in all less than 2⁻¹².
        let slack = reach / 4096.0;
        let near = f64::from(self.near);
        let at = |w: f64| self.depth(w.max(near));
        (at(middle + size + slack), at(middle - size - slack))
    }
}
