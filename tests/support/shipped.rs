//! The compiled-in scenes.

use mode13h::scene::Scene;
use mode13h_assets::auto_palette;
use mode13h_assets::shipped;

/// Every shipped scene with its name and palette, at two fifths of its duration.
pub fn scenes() -> impl Iterator<Item = (String, Scene)> {
    shipped::ALL.iter().map(|shipped| {
        let mut scene = shipped.load().expect("a scene that loads").scene;
        if scene.auto_palette {
            auto_palette::of_scene(&scene).expect("a legal scene").apply(&mut scene);
        }
        scene.set_time(0.4 * scene.duration);
        (format!("scene {}", shipped.name), scene)
    })
}
