//! Helpers that several test files share.
#![expect(dead_code, unreachable_pub, reason = "each test program uses its part")]

#[path = "../../../tests/support/picture.rs"]
pub mod picture;
#[path = "../../../tests/support/property.rs"]
pub mod property;
#[path = "../../../tests/support/scenes.rs"]
pub mod scenes;
#[path = "../../../tests/support/shipped.rs"]
pub mod shipped;
#[path = "../../../tests/support/triangles.rs"]
pub mod triangles;
#[path = "../../../tests/support/tried.rs"]
pub mod tried;
#[path = "../../../tests/support/vector.rs"]
pub mod vector;
#[path = "../../../tests/support/workspace.rs"]
pub mod workspace;

use mode13h::render::Renderer;
use mode13h::settings::Accuracy;

pub use scenes::shaded;

/// A renderer that draws within this error.
pub fn within(max_error: f32) -> Renderer {
    let mut renderer = Renderer::new();
    renderer.settings.accuracy = Some(Accuracy::WithinError(max_error));
    renderer
}
