//! Truth: the right picture of any scene in f64, slow and plain, to measure the engine by.
//!
//! It shares nothing with the engine but the scene and its meshes; camera, rotation, clipping, coverage and light are
//! written here a second time, from their formulas. What "should be" means depends on what one wants to know, so
//! there is a [`Standard`] for each:
//!
//! | standard | vertices on the screen | intensity at a pixel | shows the error |
//! |---|---|---|---|
//! | [`Gouraud`](Standard::Gouraud) | rounded to 1/256 pixel | those of the vertices, linear on the screen | of the numbers |
//! | [`GouraudPerspective`](Standard::GouraudPerspective) | rounded | the same, linear on the face in space | of the numbers |
//! | [`GouraudUnrounded`](Standard::GouraudUnrounded) | as they are | linear on the screen | of vertex rounding too |
//! | [`Lit`](Standard::Lit) | as they are | the whole lighting model at the pixel | of the model too |
//!
//! **Cover.** A pixel shows a face if its centre lies inside, or on a top or left edge. With rounded vertices
//! (floor(256·x + ½), as the engine rounds) that is decided in whole numbers, exactly; with vertices as
//! they are, by the ray from the eye through the centre, to the rounding of f64, some 10⁻¹² pixel.
//!
//! **Visible surface.** The face with the greatest 1/w at the pixel; of equal ones the first in the order of
//! the scene. w, the distance along the view, is that of the unrounded vertices, and 1/w linear on the
//! screen. A closed mesh that looks outward has no backs; in others a face whose back is seen has its normals turned
//! round. With two faces back to back the one that looks toward the eye is seen.
//! Nothing is nearer than the near plane. A body that shines through counts as an opaque one.
//!
//! **Intensity.** 0 to 1, before ramp, texture, fog, dither and blending, and rounded nowhere. The sum of
//! light is clamped once, at a vertex or, `Lit`, at the pixel: there position and vertex normals are
//! interpolated on the face's own plane, and the normal is made unit again. Where light or one of an object's
//! materials is coloured there are three channels, each times the material's own colour; otherwise one,
//! which stands in all three places.
//!
//! **Clipped faces.** On the face in space (`Lit`, `GouraudPerspective`) a cut changes nothing. A value linear on
//! the screen cannot be continued to a vertex behind the eye, so there the engine's rule is the definition:
//! the intensity where an edge meets the near plane is linear along the edge in space; what is left of the
//! face is drawn as the fan from its first corner. The guard band, which lies 4,095.75 pixels from the frame's corner, cuts
//! after the near plane, and changes no intensity that is linear on the screen.
//!
//! [`ErrorMap`] compares the engine's picture of the scene, as [`Shown`]. [`Tiles`] gives `Lit` part by part.

mod body;
mod bound;
mod clip;
mod cover;
mod error;
mod eye;
mod light;
mod ray;
mod tiles;
mod vector;

use alloc::vec;
use alloc::vec::Vec;
use core::fmt;

use self::body::{Body, Corner};
pub use self::bound::Bound;
use self::cover::Rounded;
pub use self::error::{ErrorMap, Figures, Shown, Swim};
use self::eye::Eye;
pub use self::tiles::Tiles;
use self::vector::{times, unit, weighted};
use mode13h::internals;
pub use mode13h::render::Screen;
use mode13h::scene::Scene;

/// Standard of truth.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Debug)]
#[non_exhaustive]
pub enum Standard {
    /// Vertex intensities, linear on the screen between vertices rounded to 1/256 pixel.
    Gouraud,
    /// Vertex intensities, linear on the face in space (perspective-correct), between rounded vertices.
    GouraudPerspective,
    /// Vertex intensities, linear on the screen between unrounded vertices.
    GouraudUnrounded,
    /// The lighting model at every pixel, unrounded vertices.
    Lit,
}

impl fmt::Display for Standard {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(self.name())
    }
}

impl Standard {
    /// All standards, in the order of the enum.
    pub const ALL: [Self; 4] = [Self::Gouraud, Self::GouraudPerspective, Self::GouraudUnrounded, Self::Lit];

    /// The name in figures and reports.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Gouraud => "gouraud",
            Self::GouraudPerspective => "gouraud-perspective",
            Self::GouraudUnrounded => "gouraud-unrounded",
            Self::Lit => "lit",
        }
    }

    /// Returns whether vertices are rounded to 1/256 pixel.
    #[must_use]
    pub const fn rounds_vertices(self) -> bool {
        matches!(self, Self::Gouraud | Self::GouraudPerspective)
    }
}

/// Errors of a scene.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
#[non_exhaustive]
pub enum TruthError {
    /// The camera.
    Camera(&'static str),
    /// An object, by its place in the scene.
    Object {
        /// Its place, from 0.
        index: usize,
        /// The fault.
        what: &'static str,
    },
    /// A light, by its place in the scene.
    Light {
        /// Its place, from 0.
        index: usize,
        /// The fault.
        what: &'static str,
    },
    /// The scene's ambient light is not finite.
    Ambient,
    /// The screen.
    Screen(&'static str),
}

impl fmt::Display for TruthError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Camera(what) => write!(f, "camera: {what}"),
            Self::Object { index, what } => write!(f, "object {index}: {what}"),
            Self::Light { index, what } => write!(f, "light {index}: {what}"),
            Self::Ambient => f.write_str("the ambient light must be finite"),
            Self::Screen(what) => write!(f, "screen: {what}"),
        }
    }
}

impl core::error::Error for TruthError {}

/// A triangle of a scene.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Debug)]
pub struct Face {
    /// The object's place in [`Scene::objects`].
    pub object: usize,
    /// The triangle's place in [`Mesh::triangles`](mode13h::mesh::Mesh::triangles).
    pub triangle: usize,
}

/// Truth at a point of the picture.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct TruePixel {
    /// The face that is seen.
    pub face: Face,
    /// Red, green and blue, 0 to 1 each, without texture, fog and dither; on one channel three times the same.
    pub intensity: [f64; 3],
    /// The distance along the view.
    pub w: f64,
}

/// Truth at every pixel.
#[derive(Clone, PartialEq, Debug)]
pub struct TruthFrame {
    /// Columns.
    pub width: u32,
    /// Rows.
    pub height: u32,
    /// width × height, row-major; `None` where there is no face.
    pub pixels: Vec<Option<TruePixel>>,
}

impl TruthFrame {
    /// The pixel in column `x` of row `y`; `None` where there is no face, and outside of the frame.
    #[must_use]
    pub fn at(&self, x: u32, y: u32) -> Option<&TruePixel> {
        if x >= self.width {
            return None;
        }
        self.pixels.get(y as usize * self.width as usize + x as usize)?.as_ref()
    }
}

/// A scene in its place before the eye, in f64.
///
/// ```
/// use mode13h::light::Light;
/// use mode13h::mesh::shapes;
/// use mode13h::render::Screen;
/// use mode13h::scene::{Object, Scene};
/// use mode13h_lab::truth::{Standard, Truth};
///
/// let mut scene = Scene::new();
/// scene.add(Object::new(shapes::wall(1, 1)));
/// scene.add_light(Light::sun([0.0, 0.0, 1.0]));
/// let frame = Truth::new(&scene, Screen::MODE_13H)?.draw(Standard::Lit);
/// let middle = frame.at(160, 100).expect("the wall is there");
/// // 15 % ambient and 85 % diffuse light, which falls on it straight.
/// assert!((middle.intensity[0] - 1.0).abs() < 1e-7);
/// # Ok::<(), mode13h_lab::truth::TruthError>(())
/// ```
#[derive(Clone, Debug)]
pub struct Truth<'a> {
    scene: &'a Scene,
    screen: Screen,
    eye: Eye,
    bodies: Vec<Body<'a>>,
}

/// A face at a point of the picture.
#[derive(Clone, Copy, Debug)]
struct Hit {
    face: Face,
    turned: bool,
    /// Weights of its three vertices there.
    weights: [f64; 3],
    inverse_w: f64,
}

impl<'a> Truth<'a> {
    /// Puts the scene in its place before the eye.
    ///
    /// # Errors
    /// A number in camera, objects, lights or ambient light that is not finite or not in its range; a screen
    /// with a side above 4,096, or whose pixels have one of 0.
    pub fn new(scene: &'a Scene, screen: Screen) -> Result<Self, TruthError> {
        let (pixel_width, pixel_height) = screen.pixel_aspect;
        if screen.width.max(screen.height) > 4096 {
            return Err(TruthError::Screen("its sides must be at most 4,096 pixels"));
        }
        if pixel_width == 0 || pixel_height == 0 {
            return Err(TruthError::Screen("the sides of its pixels must be above 0"));
        }
        if !scene.ambient.is_finite() {
            return Err(TruthError::Ambient);
        }
        for (index, light) in scene.lights().iter().enumerate() {
            internals::check_light(light).map_err(|what| TruthError::Light { index, what })?;
        }
        for index in 0..scene.objects().len() {
            internals::check_object(scene, index).map_err(|what| TruthError::Object { index, what })?;
        }
        let eye = Eye::new(&scene.camera, screen).map_err(TruthError::Camera)?;
        let bodies = (0..scene.objects().len()).map(|index| Body::new(scene, index, &eye)).collect();
        Ok(Self { scene, screen, eye, bodies })
    }

    /// Draws the truth at every pixel.
    #[must_use]
    pub fn draw(&self, standard: Standard) -> TruthFrame {
        let Screen { width, height, .. } = self.screen;
        let mut hits: Vec<Option<Hit>> = vec![None; width as usize * height as usize];
        let mut seen = |hit: Hit, x: i64, y: i64| {
            // Inside of the frame.
            if let Some(place) = hits.get_mut(y as usize * width as usize + x as usize)
                && place.is_none_or(|nearest| hit.inverse_w > nearest.inverse_w)
            {
                *place = Some(hit);
            }
        };
        for (object, body) in self.bodies.iter().enumerate() {
            for triangle in 0..body.object.mesh().triangles().len() {
                let face = Face { object, triangle };
                if standard.rounds_vertices() {
                    self.rounded(standard, face, &mut seen);
                } else {
                    self.unrounded(standard, face, &mut seen);
                }
            }
        }
        let pixels = hits.into_iter().map(|hit| self.pixel(standard, hit?)).collect();
        TruthFrame { width, height, pixels }
    }

    /// Truth at a point of the picture if `face` is seen there, by [`Standard::Lit`]; x and y in pixels from the
    /// frame's upper left corner. `None` if the face cannot be seen there, whatever may hide it.
    #[must_use]
    pub fn sampling(&self, face: Face, x: f64, y: f64) -> Option<TruePixel> {
        self.pixel(Standard::Lit, self.met(face, [x, y])?)
    }

    /// How many shades light on `face` changes by about the centre of a pixel, as far as a vertex may be from its place: half
    /// of 1/256 pixel by rounding, a thousandth of a pixel by f32, and half a step of its depth. On a face whose corners are
    /// moved by no more than that across the screen, the point seen at a pixel is moved by no more, and what depths move
    /// it by comes on top. A fifth is added for what light does between the places looked at. `None` if the face is not
    /// seen at the centre itself.
    #[must_use]
    pub fn rounding_shift(&self, face: Face, x: u32, y: u32) -> Option<f64> {
        let reach = 0.5 / 256.0 + 0.001 + self.depth_shift(&self.triangle(face)?.1);
        let (x, y) = (f64::from(x) + 0.5, f64::from(y) + 0.5);
        let here = self.sampling(face, x, y)?.intensity;
        let places = (-4..=4).flat_map(|i| (-4..=4).map(move |j| [i, j].map(|k: i32| reach * f64::from(k) / 4.0)));
        let near = places.filter_map(|[dx, dy]| Some(self.sampling(face, x + dx, y + dy)?.intensity));
        let change = near.map(|near| (0..3).fold(0.0, |most, i| f64::max(most, (near[i] - here[i]).abs())));
        Some(1.2 * 255.0 * change.fold(0.0, f64::max))
    }

    /// How many pixels the rounding of depths to 2⁻³⁰ moves the point of a face that is seen at a pixel by.
    ///
    /// A pixel has weights aᵢ on the screen, and on the face weights in proportion to aᵢ·near/wᵢ. Depths that are off by a
    /// share of up to ε give it the weights on the face of the point that has aᵢ(1 ± ε) on the screen. These weights
    /// change as in Lemma 9 of `docs/budget.md`, with ρ = (1 + ε)/(1 − ε), so the point moves by that share of the
    /// longest edge. What is clipped is no farther away, and its edges lie in the guard band.
    fn depth_shift(&self, corners: &[Corner; 3]) -> f64 {
        let farthest = corners.iter().fold(0.0_f64, |most, corner| most.max(corner.seen[2]));
        // Beyond 1 a depth may be anything.
        let off = (farthest / self.eye.near * f64::powi(2.0, -31)).min(1.0);
        let (more, less) = (libm::sqrt(1.0 + off), libm::sqrt(1.0 - off));
        let diagonal = 2.0 * core::f64::consts::SQRT_2 * clip::LIMIT;
        let edge = |[a, b]: [usize; 2]| {
            let [[ax, ay], [bx, by]] = [a, b].map(|corner| self.eye.project(corners[corner].seen));
            libm::hypot(ax - bx, ay - by)
        };
        let is_whole = corners.iter().all(|corner| corner.seen[2] >= self.eye.near);
        let longest =
            if is_whole { [[0, 1], [1, 2], [2, 0]].map(edge).into_iter().fold(0.0, f64::max) } else { diagonal };
        (more - less) / (more + less) * longest.min(diagonal)
    }

    /// Truth at the centre of a pixel if `face` is seen there, by any standard. `None` if the face does not cover the
    /// pixel, whatever may hide it.
    #[must_use]
    pub fn of_face_at(&self, standard: Standard, face: Face, x: u32, y: u32) -> Option<TruePixel> {
        let (x, y) = (i64::from(x), i64::from(y));
        let hit = if standard.rounds_vertices() {
            let Rounded { parts, turned } = self.drawn(face)?;
            parts.iter().find_map(|part| part_hit(standard, (face, turned), part, x, y))
        } else {
            let (_, corners) = self.triangle(face)?;
            self.unrounded_hit(standard, face, &corners, x, y)
        };
        self.pixel(standard, hit?)
    }

    /// The triangles that the face is drawn in, each three corners (x and y) in 1/256 pixel from the frame's
    /// upper left corner: one, or if it is clipped none to six. None, too, if it is a back face or has no area.
    #[must_use]
    pub fn rounded_triangles(&self, face: Face) -> Vec<[[i64; 2]; 3]> {
        match self.drawn(face) {
            Some(rounded) => rounded.parts.iter().map(cover::Part::points).collect(),
            None => Vec::new(),
        }
    }

    /// Number of an object's triangles; none if there is no such object.
    pub(crate) fn triangles(&self, object: usize) -> usize {
        self.bodies.get(object).map_or(0, |body| body.object.mesh().triangles().len())
    }

    /// The near plane's distance along the view.
    pub(crate) fn near(&self) -> f64 {
        self.eye.near
    }

    fn triangle(&self, face: Face) -> Option<(&Body<'a>, [Corner; 3])> {
        let body = self.bodies.get(face.object)?;
        Some((body, body.triangle(face.triangle)?))
    }

    /// A face clipped and rounded, if it is no back face.
    fn drawn(&self, face: Face) -> Option<Rounded> {
        let (body, corners) = self.triangle(face)?;
        let rounded = Rounded::new(&self.eye, &corners);
        body.shows(face.triangle, rounded.turned).then_some(rounded)
    }

    /// Every pixel that the face covers with rounded vertices.
    fn rounded(&self, standard: Standard, face: Face, seen: &mut impl FnMut(Hit, i64, i64)) {
        let Some(Rounded { parts, turned }) = self.drawn(face) else { return };
        for part in parts {
            let in_pixels = part.points().map(|point| point.map(|c| c as f64 / 256.0));
            self.pixels_about(&in_pixels, |x, y| {
                if let Some(hit) = part_hit(standard, (face, turned), &part, x, y) {
                    seen(hit, x, y);
                }
            });
        }
    }

    /// Every pixel that the face covers with vertices as they are.
    fn unrounded(&self, standard: Standard, face: Face, seen: &mut impl FnMut(Hit, i64, i64)) {
        let Some((_, corners)) = self.triangle(face) else { return };
        let polygon: Vec<[f64; 2]> =
            clip::clip(&self.eye, &corners).iter().map(|corner| self.eye.project(corner.seen)).collect();
        self.pixels_about(&polygon, |x, y| {
            if let Some(hit) = self.unrounded_hit(standard, face, &corners, x, y) {
                seen(hit, x, y);
            }
        });
    }

    /// A face with vertices as they are at the centre of a pixel, if it covers it.
    fn unrounded_hit(&self, standard: Standard, face: Face, corners: &[Corner; 3], x: i64, y: i64) -> Option<Hit> {
        let centre = [x as f64 + 0.5, y as f64 + 0.5];
        let mut hit = self.met(face, centre)?;
        if standard == Standard::GouraudUnrounded {
            hit.weights = ray::on_screen(&self.eye, corners, centre);
        }
        Some(hit)
    }

    /// Hit of the ray through a point of the picture on a face, if that does not turn its back on the eye.
    fn met(&self, face: Face, at: [f64; 2]) -> Option<Hit> {
        let (body, corners) = self.triangle(face)?;
        Self::hit(&self.eye, face, (body, &corners), at)
    }

    /// Finds the hit on a face whose corners are at hand.
    fn hit(eye: &Eye, face: Face, (body, corners): (&Body<'a>, &[Corner; 3]), at: [f64; 2]) -> Option<Hit> {
        let met = ray::meet(eye, corners, at)?;
        let hit = Hit { face, turned: met.turned, weights: met.on_face, inverse_w: 1.0 / met.w };
        body.shows(face.triangle, met.turned).then_some(hit)
    }

    /// Calls `pixel` for all pixels of the frame that points round it may enclose, and some more.
    fn pixels_about(&self, points: &[[f64; 2]], mut pixel: impl FnMut(i64, i64)) {
        let [columns, rows] = [(0, self.screen.width), (1, self.screen.height)].map(|(axis, size)| {
            let low = points.iter().map(|point| point[axis]).fold(f64::INFINITY, f64::min);
            let high = points.iter().map(|point| point[axis]).fold(f64::NEG_INFINITY, f64::max);
            // Below 2³²; of no points at all the range is empty.
            (low - 1.0).max(0.0) as i64..(high + 1.0).min(f64::from(size)).max(0.0) as i64
        });
        for y in rows {
            for x in columns.clone() {
                pixel(x, y);
            }
        }
    }

    /// The intensity of what is seen.
    fn pixel(&self, standard: Standard, hit: Hit) -> Option<TruePixel> {
        let (body, corners) = self.triangle(hit.face)?;
        let material = body.material(hit.face.triangle)?;
        let light = |at, normal| {
            let normal = if hit.turned { times(normal, -1.0) } else { normal };
            light::intensity(self.scene, material, body.in_color, (at, normal), self.eye.at)
        };
        let intensity = match standard {
            Standard::Lit => {
                let normal = weighted(corners.map(|corner| corner.normal), hit.weights);
                // Where the vertices' normals cancel there is none.
                light(weighted(corners.map(|corner| corner.world), hit.weights), unit(normal).unwrap_or_default())
            }
            _ => weighted(corners.map(|corner| light(corner.world, corner.normal)), hit.weights),
        };
        Some(TruePixel { face: hit.face, intensity, w: 1.0 / hit.inverse_w })
    }
}

/// A triangle of a face with rounded vertices at the centre of a pixel, if it covers it.
fn part_hit(standard: Standard, (face, turned): (Face, bool), part: &cover::Part, x: i64, y: i64) -> Option<Hit> {
    let on_part = part.weights(x, y)?;
    // What is linear on the face is linear on the screen once divided by w.
    let over_w = [0, 1, 2].map(|i| on_part[i] / part.corners[i].seen[2]);
    let inverse_w = over_w[0] + over_w[1] + over_w[2];
    let weights = match standard {
        Standard::GouraudPerspective => {
            weighted(part.corners.map(|corner| corner.on_face), over_w.map(|weight| weight / inverse_w))
        }
        _ => weighted(part.corners.map(|corner| corner.on_screen), on_part),
    };
    Some(Hit { face, turned, weights, inverse_w })
}
