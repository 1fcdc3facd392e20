//! What the pixel under the mouse says of itself.

use mode13h::render::Renderer;
use mode13h::scene::Scene;

use super::magnifier::Pixel;

/// The account of a pixel of the frame that `renderer`, as it is set, draws of `scene`.
pub(super) fn lines(_renderer: &mut Renderer, _scene: &Scene, pixel: Pixel) -> Vec<String> {
    vec![format!("({}, {})", pixel.x, pixel.y)]
}
