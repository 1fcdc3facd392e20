//! The functions that `mode13h/__init__.py` calls: bytes in, bytes out. That module checks types and shapes, and moves
//! the model into the unit cube; this one checks values.

use mode13h::Angle;
use mode13h::export::{ExportErrorKind, Picture, PixelShape, Png};
use mode13h::glam::{Quat, Vec3};
use mode13h::light::Light;
use mode13h::mesh::Mesh;
use mode13h::palette::{Palette, Rgb, builtin};
use mode13h::render::Renderer;
use mode13h::scene::framing::{Swept, Turning, Viewpoint};
use mode13h::scene::{Camera, Object, Scene};
use mode13h::settings::{Accuracy, Shading};
use mode13h::vga::Vga;
use pyo3::exceptions::{
    PyFileNotFoundError, PyIsADirectoryError, PyNotADirectoryError, PyOSError, PyPermissionError, PyValueError,
};
use pyo3::prelude::*;
use pyo3::types::PyBytes;

/// Where the model is seen from.
#[derive(FromPyObject)]
#[pyo3(from_item_all)]
struct View {
    /// The direction towards the eye; by default the view is from the front, a little from the right and above.
    direction: Option<[f64; 3]>,
    up: [f64; 3],
    /// The eye; by default where the model fills the picture.
    eye: Option<[f64; 3]>,
    target: [f64; 3],
    field_of_view: f64,
}

/// How the model is drawn.
#[derive(FromPyObject)]
#[pyo3(from_item_all)]
struct Look {
    /// Towards the sun, as the eye sees it: to the right, up, towards the eye.
    light: [f64; 3],
    shading: String,
    max_error: Option<f64>,
    palette: Colors,
}

/// A palette.
#[derive(FromPyObject)]
enum Colors {
    /// The name of a built-in one.
    Name(String),
    /// 256 times red, green and blue.
    Bytes(Vec<u8>),
}

fn fault(what: impl ToString) -> PyErr {
    PyValueError::new_err(what.to_string())
}

/// Points or directions from three f32 each.
fn points(bytes: &[u8]) -> Vec<Vec3> {
    let numbers = bytes.as_chunks::<4>().0.iter().map(|number| f32::from_ne_bytes(*number));
    let numbers: Vec<f32> = numbers.collect();
    numbers.as_chunks::<3>().0.iter().map(|point| Vec3::from_array(*point)).collect()
}

/// A direction of any length, scaled to a length of 1 to √3, so that no square overflows or vanishes.
fn scaled(name: &str, direction: [f64; 3]) -> PyResult<Vec3> {
    let longest = direction.iter().fold(0.0_f64, |longest, number| longest.max(number.abs()));
    if !direction.iter().all(|number| number.is_finite()) {
        return Err(fault(format!("{name} must be finite")));
    }
    if longest == 0.0 {
        return Err(fault(format!("{name} must not be zero")));
    }
    Ok(narrow(direction.map(|number| number / longest)))
}

fn narrow(point: [f64; 3]) -> Vec3 {
    Vec3::from_array(point.map(|number| number as f32))
}

impl View {
    /// The camera, and the directions right, up and towards the eye.
    fn camera(&self, object: &Object) -> PyResult<(Camera, [Vec3; 3])> {
        let mut up = scaled("up", self.up)?.normalize();
        let towards = match (self.eye, self.direction) {
            (Some(eye), _) => {
                let way = std::array::from_fn(|i| eye[i] - self.target[i]);
                scaled("the vector from target to eye", way)?
            }
            (None, Some(direction)) => scaled("direction", direction)?,
            (None, None) => Quat::from_rotation_arc(Vec3::Y, up) * Vec3::new(0.5, 0.4, 1.0),
        };
        let towards = towards.normalize();
        // If the view is along `up`, any other direction will do.
        if up.cross(towards).length_squared() < 1e-6 {
            up = towards.any_orthonormal_vector();
        }
        let right = up.cross(towards).normalize();
        if !(self.field_of_view > 0.0 && self.field_of_view < 180.0) {
            return Err(fault("field_of_view must be above 0 and below 180 degrees"));
        }
        let field_of_view = Angle::from_degrees(self.field_of_view);
        let camera = match self.eye {
            Some(eye) => {
                // A point that is far away may be nearer on the same line, where squares are within range.
                let way: [f64; 3] = std::array::from_fn(|i| self.target[i] - eye[i]);
                let longest = way.iter().fold(0.0_f64, |longest, number| longest.max(number.abs()));
                // Not so near that f32 cannot tell it from the eye.
                let far = eye.iter().fold(1e6_f64, |far, number| far.max(number.abs()));
                let target = std::array::from_fn(|i| eye[i] + way[i] * (far / longest).min(1.0));
                let (eye, target) = (narrow(eye), narrow(target));
                // The model, in the cube from −1 to 1, may be nearer than the target, or around the eye.
                let distance = eye.distance(target).min(eye.length().max(1.0));
                Camera { eye, target, up, field_of_view, near: Camera::near_for(distance) }
            }
            None => {
                let from = Viewpoint { direction: towards, up, field_of_view, target: None };
                let everything = [Swept::new(object, Turning::Still, None)];
                from.camera(&everything).ok_or_else(|| fault("no camera can frame these vertices"))?
            }
        };
        Ok((camera, [right, towards.cross(right), towards]))
    }
}

impl Look {
    fn accuracy(&self) -> PyResult<Accuracy> {
        let shading = match self.shading.as_str() {
            "gouraud" => Shading::default(),
            name => name.parse().map_err(|error| fault(format!("shading {name:?}: {error}")))?,
        };
        Ok(self.max_error.map_or(shading.into(), |shades| Accuracy::WithinError(shades as f32)))
    }

    fn palette(&self) -> PyResult<Palette> {
        match &self.palette {
            Colors::Name(name) => match builtin::by_name(name) {
                Some(builtin) => Ok(builtin.palette.clone()),
                None => {
                    let names: Vec<&str> = builtin::ALL.iter().map(|builtin| builtin.name).collect();
                    Err(fault(format!("palette {name:?}: unknown palette; there are {}", names.join(", "))))
                }
            },
            Colors::Bytes(bytes) => palette_of(bytes),
        }
    }
}

fn palette_of(bytes: &[u8]) -> PyResult<Palette> {
    let colors: Vec<Rgb> = bytes.as_chunks::<3>().0.iter().map(|&[r, g, b]| Rgb::new(r, g, b)).collect();
    colors.try_into().map(Palette::from_colors).map_err(|_| fault("a palette has 256 colours"))
}

/// Draws a mesh; returns 64,000 bytes, and 768 of their palette.
#[pyfunction]
fn draw<'py>(
    py: Python<'py>,
    positions: &[u8],
    faces: &[u8],
    normals: Option<&[u8]>,
    view: View,
    look: Look,
) -> PyResult<(Bound<'py, PyBytes>, Bound<'py, PyBytes>)> {
    let positions = points(positions);
    let indices: Vec<u32> = faces.as_chunks::<4>().0.iter().map(|index| u32::from_ne_bytes(*index)).collect();
    let triangles = indices.as_chunks::<3>().0.to_vec();
    let normals = normals.map(points);
    // Other threads of Python run meanwhile.
    let vga = py.detach(|| {
        let mesh = match normals {
            Some(normals) => Mesh::with_normals(positions, normals, triangles),
            None => Mesh::new(positions, triangles),
        };
        let object = Object::new(mesh.map_err(fault)?);
        let mut scene = Scene::new();
        let (camera, [right, up, towards]) = view.camera(&object)?;
        scene.camera = camera;
        let light = scaled("light", look.light)?;
        scene.add_light(Light::sun(right * light.x + up * light.y + towards * light.z));
        scene.settings.accuracy = Some(look.accuracy()?);
        scene.palette = Some(look.palette()?);
        scene.add(object);
        let mut vga = Box::new(Vga::new());
        Renderer::new().draw(&scene, &mut vga).map_err(fault)?;
        Ok::<_, PyErr>(vga)
    })?;
    let palette: Vec<u8> = vga.palette().colors().iter().flat_map(|color| [color.r, color.g, color.b]).collect();
    Ok((PyBytes::new(py, vga.pixels()), PyBytes::new(py, &palette)))
}

/// Writes an indexed PNG.
#[pyfunction]
fn save(py: Python<'_>, path: std::path::PathBuf, pixels: &[u8], width: usize, palette: &[u8]) -> PyResult<()> {
    let palette = palette_of(palette)?;
    let mut picture = Picture::of(pixels, width, &palette);
    if (picture.width, picture.height) == (Vga::WIDTH, Vga::HEIGHT) {
        picture.shape = PixelShape::MODE_13H;
    }
    picture.check().map_err(fault)?;
    // Other threads of Python run meanwhile.
    py.detach(|| Png::default().save(&picture, path)).map_err(|error| {
        let what = error.to_string();
        match error.kind {
            ExportErrorKind::MissingDirectory => PyFileNotFoundError::new_err(what),
            ExportErrorKind::NotADirectory => PyNotADirectoryError::new_err(what),
            ExportErrorKind::IsDirectory => PyIsADirectoryError::new_err(what),
            ExportErrorKind::NotPermitted => PyPermissionError::new_err(what),
            _ => PyOSError::new_err(what),
        }
    })
}

#[pymodule]
mod _engine {
    #[pymodule_export]
    use super::{draw, save};
}
