//! The integer vertex path: from a mesh in 16.16 to the raster without a float.
//!
//! The Hungarian tutorial uses fixed point throughout, with unit vectors of length 65,536. Here a
//! whole frame is computed like that: rotation, projection, normals, light, clipping. The path
//! needs neither `std` nor an allocator, and links no soft-float routine: meshes, materials and suns
//! are borrowed slices, the caller provides storage for vertices, and triangles go to a closure. So
//! a chip without a floating-point unit can draw what the f32 path of `render` draws, in the same
//! stages and with the same conventions.
//!
//! A frame may be drawn in bands of rows: the vertices are computed once, the faces drawn into each band.
//!
//! ```
//! use mode13h::fixed::I16F16;
//! use mode13h::integer::{BinaryAngle, Camera, FixedMesh, Lens, Material, Object, Placement, Sun, VertexStage, View};
//! use mode13h::settings::Shading;
//! use mode13h::palette::Ramp;
//! use mode13h::raster::{Frame, Raster};
//!
//! let at = |x, y, z| [x, y, z].map(I16F16::from_int);
//! let positions = [at(-1, -1, 0), at(1, -1, 0), at(0, 1, 0)];
//! let normals = [at(0, 0, 1); 3];
//! let mesh = FixedMesh::new(&positions, &normals, &[[0_u16, 1, 2]], false)?;
//!
//! let lens = Lens::new(320, 200, (5, 6), BinaryAngle::from_degrees(40))?;
//! let camera = Camera { eye: at(0, 0, 4), target: at(0, 0, 0), up: at(0, 1, 0), near: I16F16::ONE };
//! let view = View::new(&camera, lens)?;
//! let material = Material { ambient: I16F16::default(), diffuse: I16F16::ONE, ramp: Ramp::WHOLE };
//! let placement = Placement { angles: [BinaryAngle::default(), BinaryAngle::from_degrees(45), BinaryAngle::default()], ..Placement::default() };
//! let object = Object { mesh, placement, materials: &[material] };
//! let suns = [Sun { direction: at(0, 0, 1), intensity: I16F16::ONE }];
//!
//! let (mut lit, mut beams) = ([Default::default(); 3], [Default::default(); 1]);
//! let stage = VertexStage::new(&view, object, &suns, Shading::default(), &mut lit, &mut beams)?;
//! let mut bytes = [0; 320 * 200];
//! let mut raster = Raster::new(Frame::new(&mut bytes, 320, 200, 320)?);
//! let faces = stage.faces(|vertices, interpolation| {
//!     raster.triangle(vertices, interpolation);
//! });
//! assert_eq!(faces.drawn, 1);
//! assert_eq!(bytes[100 * 320 + 160], 180); // lit under 45°: 255 · √½
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

// | file | what |
// |---|---|
// | `angle` | binary angles and their sines |
// | `vector` | unit vectors, the rotation of an object |
// | `mesh` | a mesh in 16.16; averaged normals |
// | `view` | camera and object to one matrix; projection; the one rounding |
// | `light` | suns, materials, the shade of a vertex |
// | `clip` | near plane and guard band |
// | `stage` | an object's vertices, lit and projected, then its faces |

mod angle;
mod clip;
mod light;
mod mesh;
mod stage;
mod vector;
mod view;

use core::fmt;

pub use angle::BinaryAngle;
pub use light::{Material, ObjectSun, Sun};
pub use mesh::{FixedMesh, average_normals, face_normal};
pub use mesh::{FixedMeshParts, VertexIndex};
pub use stage::{Faces, LitVertex, Object, VertexStage};
pub use vector::{Vector, turn, unit_vector};
pub use view::{Camera, Lens, Placement, View};

/// The errors of the integer path: of a mesh, a camera, lights or materials.
#[derive(Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum IntegerError {
    /// A side of the picture is 0 or above 4,096 pixels.
    Size,
    /// The field of view is 0, half a turn or more, or so small that a focal length exceeds 16,384 pixels; or a side of
    /// a pixel is 0.
    FieldOfView,
    /// The near distance is not above 0.
    Near,
    /// The camera's target is its own position.
    Direction,
    /// A scale is below 0.
    Scale,
    /// A part of an object may be more than 65,535 units from the eye.
    TooFar,
    /// There are more than 4,096 suns, or one has no direction.
    Light,
    /// There are fewer materials than the mesh has surfaces.
    Materials {
        /// The number needed.
        needed: usize,
    },
    /// There is too little storage for vertices or beams.
    Room {
        /// The number that must fit.
        needed: usize,
    },
    /// A slice of a mesh has a wrong length.
    Count {
        /// The name of what was counted.
        what: &'static str,
        /// The number given.
        given: usize,
        /// The number needed.
        needed: usize,
    },
    /// A coordinate of a mesh is outside ±32,767.
    Position {
        /// The vertex.
        vertex: usize,
    },
    /// A normal's length is not within 2⁻¹⁴ of 1.
    NormalNotUnit {
        /// The vertex.
        vertex: usize,
    },
    /// A triangle refers to a vertex that does not exist.
    IndexOutOfRange {
        /// The triangle.
        triangle: usize,
    },
}

impl IntegerError {
    /// The error as text, without its numbers.
    pub(crate) const fn what(&self) -> &'static str {
        match self {
            Self::Size => "each side of the picture must be 1 to 4,096 pixels",
            Self::FieldOfView => {
                "the field of view must be above 0° and below 180°, a pixel's sides above 0, and focal lengths 1/65,536 to \
                 16,384 pixels"
            }
            Self::Near => "the near distance must be above 0",
            Self::Direction => "the camera looks at its own position",
            Self::Scale => "an object's scale must not be negative",
            Self::TooFar => "an object reaches farther than 65,535 units from the eye",
            Self::Light => "every sun needs a direction, and there may be at most 4,096",
            Self::Materials { .. } => "each surface of a mesh must have a material",
            Self::Room { .. } => "there is too little room for vertices or lights",
            Self::Count { .. } => "the slices of a mesh must fit together",
            Self::Position { .. } => "each vertex of a mesh must lie within ±32,767",
            Self::NormalNotUnit { .. } => "each normal of a mesh must be of length 1",
            Self::IndexOutOfRange { .. } => "each triangle of a mesh must refer to vertices that exist",
        }
    }
}

impl fmt::Display for IntegerError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.what())?;
        match self {
            Self::Materials { needed } | Self::Room { needed } => write!(f, ": {needed} are needed"),
            Self::Count { what, given, needed } => write!(f, ": {given} {what} given where {needed} are needed"),
            Self::Position { vertex } | Self::NormalNotUnit { vertex } => write!(f, ": vertex {vertex} is not"),
            Self::IndexOutOfRange { triangle } => write!(f, ": triangle {triangle} does not"),
            _ => Ok(()),
        }
    }
}

crate::errors::debug_as_display!(IntegerError);

impl core::error::Error for IntegerError {}
