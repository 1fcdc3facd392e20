//! The workloads: prepared triangles, back to front, and the meshes that they come from.

use std::error::Error;
use std::path::Path;

use mode13h::Angle;
use mode13h::glam::{Vec2, Vec3};
use mode13h::mesh::{Mesh, shapes};
use mode13h::raster::Vertex;
use mode13h::render::{Renderer, Screen};
use mode13h::scene::{Camera, Scene};
use mode13h_assets::model_file;

use crate::candidate::{Corner, Triangle};
use crate::refine::refined;
use crate::{HEIGHT, WIDTH};

/// Triangles, back to front, and the mesh that they come from.
pub struct Workload {
    pub name: String,
    pub triangles: Vec<Triangle>,
    /// With texture coordinates.
    pub mesh: Mesh,
}

impl Workload {
    /// The front faces of a mesh that fills the frame, sorted by the mean depth of their vertices.
    fn of_mesh(name: String, mesh: Mesh) -> Result<Self, Box<dyn Error>> {
        let mut scene = Scene::showing(mesh.clone());
        scene.camera = Camera::framing(Vec3::ZERO, scene.objects()[0].mesh().bounds().radius);
        scene.objects_mut()[0].angles = [0.4, 0.6, 0.0].map(Angle::from_radians);
        let mut triangles = Vec::new();
        Renderer::new().for_each_triangle(&scene, Screen::MODE_13H, |vertices, _| triangles.push(*vertices))?;
        triangles.sort_by_key(|vertices| vertices.iter().map(|v| u64::from(v.depth())).sum::<u64>());
        let radius = mesh.bounds().radius;
        let texcoords = mesh.positions().iter().map(|p| Vec2::new(p.x + p.z / 2.0, p.y) / radius).collect();
        Ok(Self { name, triangles: with_texels(&triangles), mesh: mesh.with_texcoords(texcoords)? })
    }

    /// The shapes, the rabbit (or, without one, a rough sphere) refined up to this many faces, and the files.
    pub fn all(rabbit: Option<&Path>, most_faces: usize, files: &[String]) -> Result<Vec<Self>, Box<dyn Error>> {
        let mut all = Vec::new();
        for name in ["cube", "torus", "teapot"] {
            all.push(Self::of_mesh(name.to_owned(), shapes::by_name(name).ok_or("a shape that is not there")?)?);
        }
        let (name, mesh) = match rabbit {
            Some(path) => (name_of(path), model_file::load(path)?.mesh),
            None => ("sphere".to_owned(), refined(&shapes::by_name("cube").ok_or("no cube")?, 3_600)),
        };
        all.push(Self::of_mesh(name.clone(), mesh.clone())?);
        for thousands in [11, 48, 200, 870].into_iter().filter(|thousands| thousands * 1_000 <= most_faces) {
            all.push(Self::of_mesh(format!("{name}, {thousands} thousand"), refined(&mesh, thousands * 1_000))?);
        }
        for file in files {
            let path = Path::new(file);
            all.push(Self::of_mesh(name_of(path), model_file::load(path)?.mesh)?);
        }
        Ok(all)
    }
}

fn name_of(path: &Path) -> String {
    path.file_stem().map_or_else(|| path.display().to_string(), |stem| stem.to_string_lossy().into_owned())
}

/// Triangles with the distances given by their depths, and an image mapped onto them by a function that is linear in
/// space, so that neighbours agree at their corners and in between.
fn with_texels(triangles: &[[Vertex; 3]]) -> Vec<Triangle> {
    // A depth is 2³⁰ times the near plane's distance divided by its own.
    let distance = |v: &Vertex| (1_u64 << 30) as f32 / v.depth().max(1) as f32;
    let corners = triangles.iter().flatten();
    let mean = corners.clone().map(distance).sum::<f32>() / corners.count().max(1) as f32;
    let corner = |vertex: Vertex| {
        let w = distance(&vertex);
        let across = |bits: i32, side: usize| (bits as f32 / 256.0 - side as f32 / 2.0) * w / mean;
        let (x, y) = (across(vertex.x().to_bits(), WIDTH), across(vertex.y().to_bits(), HEIGHT));
        // Half a texel per pixel, so at most 256 texels, for which f32 resolves 1/65,536.
        let texel =
            [x + 0.3 * (w / mean - 1.0) * WIDTH as f32, y].map(|t| ((t / 2.0 + 128.0) * 65_536.0).round() / 65_536.0);
        Corner { vertex, w, texel }
    };
    triangles.iter().map(|vertices| vertices.map(corner)).collect()
}
