//! Words on the pixel under the mouse.

use mode13h::render::{Renderer, Screen};
use mode13h::scene::Scene;
use mode13h_lab::explain::{self, Edge, FaceHere, Seen};

use super::pixel::Pixel;
use super::step::Traced;

/// Letters of a line beyond which it is cut: more than any has.
const LONGEST: usize = 200;

/// The account of a pixel of the frame that `renderer`, as it is set, draws of `scene`: what became of its byte, then its
/// edges, why it is shaded as it is, and the effects. And the triangle that is seen there, if one is.
pub(super) fn lines(renderer: &mut Renderer, scene: &Scene, pixel: Pixel) -> (Vec<String>, Option<Traced>) {
    let (x, y) = (u32::from(pixel.x), u32::from(pixel.y));
    let shade_trace = match explain::pixel(renderer, scene, Screen::MODE_13H, x, y) {
        Ok(shade_trace) => shade_trace,
        Err(error) => return (vec![error.to_string()], None),
    };
    let mut lines = shade_trace.lines(LONGEST);
    if let Some((face, seen)) = shade_trace.front() {
        if seen.exact_cover {
            lines.push(edges(face, x, y));
        }
        lines.extend(exact(seen));
        lines.push(format!("shading: {}", shade_trace.shading_why));
        lines.push(format!("on: {}", effects(seen)));
    }
    (lines, Traced::of(&shade_trace))
}

/// The three edges: what kind each is, and how far inside of it the centre lies.
fn edges(face: &FaceHere, x: u32, y: u32) -> String {
    let edge = |Edge { kind, value }: &Edge| match value {
        0 => format!("{kind} 0 ({})", if kind.owns_ties() { "its own" } else { "not its own" }),
        _ => format!("{kind} {value}"),
    };
    let edges = face.edges(x, y);
    format!("edges: {}", edges.each_ref().map(edge).join(", "))
}

/// Words on the exact value of linear shades, or of quotients, without any rounding.
fn exact(seen: &Seen) -> Option<String> {
    let shade_trace = seen.accounts.first()?;
    let shade = shade_trace.exact?.to_f64() / 256.0;
    Some(format!("exact {shade:.4}: the byte is off by {:+.4}", f64::from(shade_trace.byte) - shade))
}

fn effects(seen: &Seen) -> String {
    let names: Vec<String> = seen.effects.iter().map(|row| row.effect.to_string()).collect();
    names.join(", ")
}

#[cfg(test)]
mod tests {
    use super::*;
    use mode13h::mesh::shapes;
    use mode13h::settings::Shading;

    #[test]
    fn an_account_begins_with_the_pixel() {
        let scene = Scene::showing(shapes::torus(24, 12));
        for shading in Shading::ALL {
            let mut renderer = Renderer::new();
            renderer.settings.accuracy = Some(shading.into());
            let mut vga = mode13h::vga::Vga::new();
            renderer.draw(&scene, &mut vga).expect("a legal scene");
            for (x, y) in [(0, 0), (160, 60), (100, 100), (319, 199)] {
                let (lines, seen) = lines(&mut renderer, &scene, Pixel { x, y });
                let byte = vga.pixels()[usize::from(y) * 320 + usize::from(x)];
                assert!(lines[0].starts_with(&format!("({x}, {y}) byte {byte} ")), "{lines:#?}");
                assert!(lines.iter().all(|line| line.chars().count() < LONGEST), "{lines:#?}");
                // Where there is a face it says more than its place.
                assert_eq!(lines.len() > 4, byte != scene.background, "{lines:#?}");
                assert_eq!(seen.is_some(), byte != scene.background, "{lines:#?}");
            }
        }
    }
}
