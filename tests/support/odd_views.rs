//! Odd views on either vertex path, byte by byte.

use mode13h::Angle;
use mode13h::glam::Vec3;
use mode13h::light::Light;
use mode13h::mesh::shapes;
use mode13h::render::{Renderer, Screen, VertexPath};

use super::judged::judged;
use super::scenes::framed;
use super::tried::Tried;
use mode13h_conformance::Random;

/// C4: fields of view from 1° to 179°, the eye inside a torus, on a vertex or a face of it, or anywhere near.
pub fn odd_views(mut tried: Tried, path: VertexPath) {
    let mut random = Random::named("c4");
    let mesh = shapes::torus(16, 8);
    let screen = Screen { width: 64, height: 40, ..Screen::MODE_13H };
    let (mut seen, mut clipped) = (0, 0);
    while tried.more() {
        let mut scene = framed(mesh.clone());
        scene.background = 7;
        scene.add_light(Light::sun([0.3, 0.5, -1.0]));
        let mut place =
            || Vec3::new(random.unit() as f32 - 0.5, random.unit() as f32 - 0.5, random.unit() as f32 - 0.5);
        scene.camera.eye = place() * 2.0;
        scene.camera.target = place();
        scene.camera.near = 1e-3;
        let [a, b, c] = random.one_of(mesh.triangles()).map(|corner| mesh.positions()[corner as usize]);
        match random.within(0, 3) {
            0 => scene.camera.eye = a,
            1 => {
                let (s, t) = (random.unit() as f32, random.unit() as f32);
                scene.camera.eye = a + (b - a) * (s * t) + (c - a) * (s * (1.0 - t));
            }
            _ => {}
        }
        scene.camera.field_of_view = Angle::from_degrees(random.one_of(&[1.0, 40.0, 90.0, 179.0]));
        let mut renderer = Renderer::new();
        renderer.settings.vertex_path = path;
        let judged = judged(&mut renderer, &scene, screen);
        assert_eq!(judged.stats.faces, 256);
        seen += u64::from(judged.counts.iter().any(|&times| times > 0));
        clipped += u64::from(judged.stats.clipped > 0);
    }
    tried.worst("views that show something", seen as f64);
    tried.worst("views with clipped faces", clipped as f64);
    assert!(seen * 2 > tried.stated() && clipped * 4 > tried.stated(), "{seen} show something, {clipped} are clipped");
}
