//! The truth: the right picture of any scene in f64, slow and plain, to measure the engine by.
//!
//! It shares nothing with the engine but the scene and its meshes; camera, rotation, clipping, coverage and light are
//! implemented here a second time, from their formulas. What "right" means depends on the question, so there are
//! several [`Standard`]s:
//!
//! | standard | vertices on the screen | intensity at a pixel | shows the error |
//! |---|---|---|---|
//! | [`Gouraud`](Standard::Gouraud) | rounded to 1/256 pixel | those of the vertices, linear on the screen | of the arithmetic |
//! | [`GouraudPerspective`](Standard::GouraudPerspective) | rounded | the same, linear on the face in space | of the arithmetic |
//! | [`GouraudUnrounded`](Standard::GouraudUnrounded) | unrounded | linear on the screen | of vertex rounding too |
//! | [`Lit`](Standard::Lit) | unrounded | the whole lighting model at the pixel | of the model too |
//!
//! **Coverage.** A pixel shows a face if its centre lies inside, or on a top or left edge. With rounded vertices
//! (floor(256·x + ½), as in the engine) that is decided exactly, in integers; with unrounded vertices, by the ray from
//! the eye through the centre, to the precision of f64, some 10⁻¹² pixel.
//!
//! **Visible surface.** The face with the greatest 1/w at the pixel; of equal ones, the first in scene order. w, the
//! distance along the view, is that of the unrounded vertices, and 1/w is linear on the screen. A closed mesh that
//! faces outward shows no back faces; in other meshes a face seen from behind has its normals flipped. Of two faces
//! back to back, the one that faces the eye is seen. Nothing is nearer than the near plane. Translucent objects count
//! as opaque.
//!
//! **Intensity.** 0 to 1, before ramp, texture, fog, dither and blending, and never rounded. The sum of light is
//! clamped once, at the vertex or, for `Lit`, at the pixel: there position and vertex normals are interpolated on the
//! face's own plane, and the normal is normalized again. If light or one of an object's materials is coloured there are
//! three channels, each multiplied by the material's own colour; otherwise there is one, which fills all three entries.
//!
//! **Clipped faces.** On the face in space (`Lit`, `GouraudPerspective`) clipping changes nothing. A value that is
//! linear on the screen cannot be extended to a vertex behind the eye, so there the engine's rule is the definition:
//! the intensity where an edge meets the near plane is linear along the edge in space, and what remains of the face is
//! drawn as the fan from its first corner. The guard band, 4,095.75 pixels from the frame's corner, clips after the
//! near plane, and changes no intensity that is linear on the screen.
//!
//! [`ErrorMap`] compares the engine's picture of the scene, given as [`Shown`], with the truth. [`Tiles`] draws `Lit`
//! in parts.

mod body;
mod bound;
mod clip;
mod cover;
mod error;
mod eye;
mod light;
mod ray;
mod tiles;
pub(crate) mod vector;

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

/// A standard of truth.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Debug)]
#[non_exhaustive]
pub enum Standard {
    /// Vertex intensities, linear on the screen between vertices rounded to 1/256 pixel.
    Gouraud,
    /// Vertex intensities, linear on the face in space (perspective-correct), between rounded vertices.
    GouraudPerspective,
    /// Vertex intensities, linear on the screen between unrounded vertices.
    GouraudUnrounded,
    /// The lighting model at every pixel, with unrounded vertices.
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

/// Error in a scene.
#[derive(Clone, Copy, PartialEq, Eq, Debug, thiserror::Error)]
#[non_exhaustive]
pub enum TruthError {
    /// The camera, with what is wrong.
    #[error("camera: {0}")]
    Camera(&'static str),
    /// An object, by its index in the scene.
    #[error("object {index}: {what}")]
    Object {
        /// The index in [`Scene::objects`].
        index: usize,
        /// The fault.
        what: &'static str,
    },
    /// A light, by its index in the scene.
    #[error("light {index}: {what}")]
    Light {
        /// The index in [`Scene::lights`].
        index: usize,
        /// The fault.
        what: &'static str,
    },
    /// The scene's ambient light is not finite.
    #[error("the ambient light must be finite")]
    Ambient,
    /// The screen, with what is wrong.
    #[error("screen: {0}")]
    Screen(&'static str),
}

/// A triangle of a scene.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Debug)]
pub struct Face {
    /// Index of the object in [`Scene::objects`].
    pub object: usize,
    /// Index of the triangle in [`Mesh::triangles`](mode13h::mesh::Mesh::triangles).
    pub triangle: usize,
}

/// The truth at a point of the picture.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct TruePixel {
    /// The visible face.
    pub face: Face,
    /// Red, green and blue, 0 to 1 each, without texture, fog and dither; on one channel the same value three times.
    pub intensity: [f64; 3],
    /// The distance along the view.
    pub w: f64,
}

/// The truth at every pixel.
#[derive(Clone, PartialEq, Debug)]
pub struct TruthFrame {
    /// Number of columns.
    pub width: u32,
    /// Number of rows.
    pub height: u32,
    /// Pixels, width × height, row-major; `None` where there is no face.
    pub pixels: Vec<Option<TruePixel>>,
}

impl TruthFrame {
    /// The pixel in column `x` of row `y`; `None` where there is no face, and outside the frame.
    #[must_use]
    pub fn at(&self, x: u32, y: u32) -> Option<&TruePixel> {
        if x >= self.width {
            return None;
        }
        self.pixels.get(y as usize * self.width as usize + x as usize)?.as_ref()
    }
}

/// A scene as the camera sees it, in f64.
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
    /// Weights of its three vertices at the point.
    weights: [f64; 3],
    inverse_w: f64,
}

impl<'a> Truth<'a> {
    /// Places the scene before the camera.
    ///
    /// # Errors
    /// A number in camera, objects, lights or ambient light that is not finite or out of range; a screen with a side
    /// above 4,096, or with a pixel side of 0.
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
            // Inside the frame.
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

    /// The truth by [`Standard::Lit`] at a point of the picture, if `face` is seen there; x and y are in pixels from
    /// the frame's upper left corner. `None` if the face cannot be seen there; faces in front of it are ignored.
    #[must_use]
    pub fn sampling(&self, face: Face, x: f64, y: f64) -> Option<TruePixel> {
        self.pixel(Standard::Lit, self.met(face, [x, y])?)
    }

    /// How much the light on `face` changes, in shades, around the centre of a pixel within the distance that a vertex
    /// may be misplaced: half of 1/256 pixel by rounding, a thousandth of a pixel by f32, and half a step of its depth.
    /// If a face's corners move by no more than that across the screen, neither does the point seen at a pixel; its
    /// shift by rounded depths is added. A fifth is added for changes of the light between the sampled positions.
    /// `None` if the face is not seen at the centre itself.
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

    /// How far rounding depths to 2⁻³⁰ moves the point of a face that is seen at a pixel, in pixels.
    ///
    /// A pixel has weights aᵢ on the screen, and on the face weights in proportion to aᵢ·near/wᵢ. Depths that are off
    /// by a share of up to ε give it the weights on the face of the point that has aᵢ(1 ± ε) on the screen. These
    /// weights change as in Lemma 9 of `docs/budget.md`, with ρ = (1 + ε)/(1 − ε), so the point moves by that share of
    /// the longest edge. Clipped faces are no farther away, and their edges lie in the guard band.
    fn depth_shift(&self, corners: &[Corner; 3]) -> f64 {
        let farthest = corners.iter().fold(0.0_f64, |most, corner| most.max(corner.seen[2]));
        // Beyond 1 the depth may be anything.
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

    /// The truth by any standard at the centre of a pixel, if `face` is seen there. `None` if the face does not cover
    /// the pixel; faces in front of it are ignored.
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

    /// The triangles that the face is drawn as, each three corners (x and y) in 1/256 pixel from the frame's upper left
    /// corner: one, or none to six if it is clipped. Also none if it is a back face or has no area.
    #[must_use]
    pub fn rounded_triangles(&self, face: Face) -> Vec<[[i64; 2]; 3]> {
        match self.drawn(face) {
            Some(rounded) => rounded.parts.iter().map(|part| part.points).collect(),
            None => Vec::new(),
        }
    }

    /// Number of triangles of an object; 0 if there is no such object.
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

    /// A face clipped and rounded; `None` for a back face.
    fn drawn(&self, face: Face) -> Option<Rounded> {
        let (body, corners) = self.triangle(face)?;
        let rounded = Rounded::new(&self.eye, &corners);
        body.shows(face.triangle, rounded.turned).then_some(rounded)
    }

    /// Visits every pixel that the face covers with rounded vertices.
    fn rounded(&self, standard: Standard, face: Face, seen: &mut impl FnMut(Hit, i64, i64)) {
        let Some(Rounded { parts, turned }) = self.drawn(face) else { return };
        for part in parts {
            let in_pixels = part.points.map(|point| point.map(|c| c as f64 / 256.0));
            self.pixels_about(&in_pixels, |x, y| {
                if let Some(hit) = part_hit(standard, (face, turned), &part, x, y) {
                    seen(hit, x, y);
                }
            });
        }
    }

    /// Visits every pixel that the face covers with unrounded vertices.
    fn unrounded(&self, standard: Standard, face: Face, seen: &mut impl FnMut(Hit, i64, i64)) {
        let Some((_, corners)) = self.triangle(face) else { return };
        self.pixels_about(&clip::outline(&self.eye, &corners), |x, y| {
            if let Some(hit) = self.unrounded_hit(standard, face, &corners, x, y) {
                seen(hit, x, y);
            }
        });
    }

    /// The hit on a face with unrounded vertices at the centre of a pixel, if the face covers that.
    fn unrounded_hit(&self, standard: Standard, face: Face, corners: &[Corner; 3], x: i64, y: i64) -> Option<Hit> {
        let centre = [x as f64 + 0.5, y as f64 + 0.5];
        let mut hit = self.met(face, centre)?;
        if standard == Standard::GouraudUnrounded {
            hit.weights = ray::on_screen(&self.eye, corners, centre);
        }
        Some(hit)
    }

    /// The hit on a face of the ray through a point of the picture, unless the face is turned away.
    fn met(&self, face: Face, at: [f64; 2]) -> Option<Hit> {
        let (body, corners) = self.triangle(face)?;
        Self::hit(&self.eye, face, (body, &corners), at)
    }

    /// The hit on a face whose corners are already computed.
    fn hit(eye: &Eye, face: Face, (body, corners): (&Body<'a>, &[Corner; 3]), at: [f64; 2]) -> Option<Hit> {
        ray::meet(eye, face, corners, at).filter(|hit| body.shows(face.triangle, hit.turned))
    }

    /// Calls `pixel` for all pixels of the frame within the bounding box of the points, and a few more.
    fn pixels_about(&self, points: &[[f64; 2]], mut pixel: impl FnMut(i64, i64)) {
        let [columns, rows] = [(0, self.screen.width), (1, self.screen.height)].map(|(axis, size)| {
            let (low, high) = clip::bounds(points, axis);
            // Below 2³²; without points the range is empty.
            (low - 1.0).max(0.0) as i64..(high + 1.0).min(f64::from(size)).max(0.0) as i64
        });
        for y in rows {
            for x in columns.clone() {
                pixel(x, y);
            }
        }
    }

    /// The truth at a hit.
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
                // There is no normal where those of the vertices cancel.
                light(weighted(corners.map(|corner| corner.world), hit.weights), unit(normal).unwrap_or_default())
            }
            _ => weighted(corners.map(|corner| light(corner.world, corner.normal)), hit.weights),
        };
        Some(TruePixel { face: hit.face, intensity, w: 1.0 / hit.inverse_w })
    }
}

/// The hit on a part of a face with rounded vertices at the centre of a pixel, if the part covers that.
fn part_hit(standard: Standard, (face, turned): (Face, bool), part: &cover::Part, x: i64, y: i64) -> Option<Hit> {
    let on_part = part.weights(x, y)?;
    // A value linear on the face becomes linear on the screen when divided by w.
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
