//! Floors seen from an eye at the origin.

use mode13h::Angle;
use mode13h::glam::Vec3;
use mode13h::internals::raster::reference::cover::SortedTriangle;
use mode13h::mesh::Mesh;
use mode13h::raster::Rect;
use mode13h::render::{Renderer, Screen, Stats};
use mode13h::scene::{Camera, Object, Scene};
use mode13h::vga::Vga;

pub(crate) const WIDTH: usize = Vga::WIDTH;
pub(crate) const HEIGHT: usize = Vga::HEIGHT;

/// How often what `renderer` draws covers each pixel.
pub(crate) fn counts_by(renderer: &mut Renderer, scene: &Scene) -> (Vec<u32>, Stats) {
    let mut counts = vec![0; WIDTH * HEIGHT];
    let clip = Rect { x0: 0, y0: 0, x1: WIDTH as u32, y1: HEIGHT as u32 };
    let stats = renderer
        .for_each_triangle(scene, Screen::MODE_13H, |vertices, _| {
            SortedTriangle::new(vertices).rows(WIDTH as u32, clip, |row| {
                for x in row.x0..row.x1 {
                    counts[row.y as usize * WIDTH + x as usize] += 1;
                }
            });
        })
        .expect("a legal scene");
    (counts, stats)
}

/// An eye at the origin that looks along −z.
pub(crate) fn scene(mesh: Mesh) -> Scene {
    let mut scene = Scene::new();
    scene.camera = Camera {
        eye: Vec3::ZERO,
        target: Vec3::NEG_Z,
        up: Vec3::Y,
        field_of_view: Angle::from_radians(1.0),
        near: 0.25,
    };
    scene.add(Object::new(mesh));
    scene
}

/// A floor one below the eye, extending `reach` to all sides, of `n × n` squares of two triangles each.
pub(crate) fn floor(reach: f32, n: u32) -> Mesh {
    let at = |i: u32| reach * (i as f32 / n as f32 * 2.0 - 1.0);
    let positions = (0..=n).flat_map(|z| (0..=n).map(move |x| Vec3::new(at(x), -1.0, at(z)))).collect();
    let corner = |x, z| z * (n + 1) + x;
    let triangles = (0..n * n)
        .flat_map(|i| {
            let (x, z) = (i % n, i / n);
            let (a, b, c, d) = (corner(x, z), corner(x + 1, z), corner(x, z + 1), corner(x + 1, z + 1));
            if (x + z) % 2 == 0 { [[a, c, b], [b, c, d]] } else { [[a, c, d], [a, d, b]] }
        })
        .collect();
    Mesh::new(positions, triangles).expect("a mesh")
}
