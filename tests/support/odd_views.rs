//! Odd views on either vertex path, byte by byte.

use mode13h::Angle;
use mode13h::glam::Vec3;
use mode13h::light::Light;
use mode13h::mesh::shapes;
use mode13h::render::{Renderer, Screen};
use mode13h::settings::VertexPath;

use super::judged::judged;
use super::scenes::framed;
use super::tried::Tried;
use mode13h_conformance::Random;

/// C4: fields of view from 1° to 179°, the eye inside a torus, on one of its vertices or faces, or anywhere near; with
/// one to three lights of any direction and strength, on screens of any size.
pub fn odd_views(mut tried: Tried, path: VertexPath) {
    let mut random = Random::named("c4");
    let mesh = shapes::torus(16, 8);
    let (mut seen, mut clipped, mut bright) = (0, 0, 0);
    while tried.more() {
        let (width, height) =
            random.one_of(&[(1, 1), (1, 90), (90, 1), (7, 5), (64, 40), (64, 40), (97, 33), (160, 100)]);
        let screen = Screen { width, height, ..Screen::MODE_13H };
        let mut scene = framed(mesh.clone());
        scene.background = 7;
        let mut place = || Vec3::from_array([0.0; 3].map(|_| random.unit() as f32 - 0.5));
        scene.camera.eye = place() * 2.0;
        scene.camera.target = place();
        scene.camera.near = 1e-3;
        let toward = [place(), place(), place()];
        scene.clear_lights();
        for toward in &toward[..random.within(1, 3) as usize] {
            let strength = random.one_of(&[-0.5, 0.3, 1.0, 3.0]);
            // The integer path has no lamps.
            scene.add_light(match path == VertexPath::Float && random.below(2) == 0 {
                true => Light::lamp(*toward, 0.2 + 3.0 * random.unit() as f32).with_intensity(strength),
                false => Light::sun(*toward).with_intensity(strength),
            });
        }
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
        renderer.settings.vertex_path = Some(path);
        let (judged, stats) = judged(&mut renderer, &scene, screen);
        assert_eq!(stats.faces, 256);
        seen += u64::from(judged.counts.iter().any(|&times| times > 0));
        clipped += u64::from(stats.clipped > 0);
        let shades =
            || judged.triangles.iter().flat_map(|(vertices, _)| vertices.map(|vertex| vertex.shade().to_bits()));
        bright += u64::from(shades().any(|shade| shade == 65_280) && shades().any(|shade| shade < 32_640));
    }
    tried.worst("views that show something", seen as f64);
    tried.worst("views with clipped faces", clipped as f64);
    tried.worst("views with dark and with full light", bright as f64);
    let enough = seen * 2 > tried.stated() && clipped * 4 > tried.stated() && bright * 10 > tried.stated();
    assert!(enough, "{seen} show something, {clipped} are clipped, {bright} are bright and dark");
}
