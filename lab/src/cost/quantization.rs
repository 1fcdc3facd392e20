//! Quantization error: the difference between a shade and the nearest entry of a ramp or a palette.

use std::collections::{BTreeMap, BTreeSet};

use crate::truth::Shown;
use mode13h::palette::{BIOS, Palette, Ramp, Rgb};
use mode13h::plan::Effect;
use mode13h::render::{Renderer, Screen};
use mode13h::scene::Scene;

/// Collects what was shown, each shade of each ramp and each colour once.
///
/// - On a ramp of n entries a shade s of 0 to 255 is shown by the nearest entry: s is off by |s − 255·k/(n − 1)|, k =
///   round(s·(n − 1)/255).
/// - Where light or material is coloured, the error is the difference between the wanted colour and the palette's
///   nearest entry, on the channel where it is greatest.
/// - A surface with an image contributes every colour of its image in every shade seen on it, as if each pair met
///   somewhere: no pixel is off by more.
///
/// Fog, dither and translucent objects are left out.
#[derive(Clone, Debug, Default)]
pub(super) struct Entries {
    /// The largest error among them, in shades.
    pub(super) most: f64,
    /// Colours looked up for objects on three channels.
    colors: BTreeSet<[u8; 3]>,
    /// Object, surface and shade of the textured pixels seen.
    shades: BTreeSet<(usize, u16, u8)>,
}

impl Entries {
    /// Adds what is shown of a scene.
    pub(super) fn count(&mut self, scene: &Scene, shown: &Shown, renderer: &mut Renderer) {
        // A scene that was drawn has a plan.
        let Ok(plan) = renderer.make_plan(scene, Screen::MODE_13H) else { return };
        let channels: Vec<bool> =
            (0..scene.objects().len()).map(|object| plan.objects()[object].is_on(Effect::RgbChannels)).collect();
        let palette = scene.palette.as_ref().unwrap_or(&BIOS);
        let mut ramps: BTreeMap<(usize, u16), Option<Ramp>> = BTreeMap::new();
        for (face, shades) in shown.faces.iter().zip(&shown.shades) {
            let Some(face) = face else { continue };
            // Bytes.
            let color = shades.map(|shade| shade as u8);
            if channels[face.object] {
                if self.colors.insert(color) {
                    self.most = self.most.max(nearest_error(palette, color));
                }
                continue;
            }
            let object = &scene.objects()[face.object];
            let surface = object.mesh().triangle_surfaces()[face.triangle];
            let ramp = ramps.entry((face.object, surface)).or_insert_with(|| {
                let material = object.materials.get(usize::from(surface))?;
                let has_image = material.texture.is_some() || material.environment.is_some();
                (!has_image).then(|| material.ramp.in_palette(scene.palette.as_ref()))
            });
            match ramp {
                Some(ramp) => self.most = self.most.max(ramp_error(*ramp, shades[0])),
                None if self.shades.insert((face.object, surface, color[0])) => {
                    self.most = self.most.max(image_error(scene, palette, (face.object, surface), color[0]));
                }
                None => {}
            }
        }
    }

    pub(super) fn add(&mut self, other: Self) {
        self.most = self.most.max(other.most);
    }
}

/// Difference between a shade and the nearest entry of a ramp.
fn ramp_error(ramp: Ramp, shade: f64) -> f64 {
    let steps = f64::from(ramp.entries()) - 1.0;
    if steps < 1.0 {
        return shade.max(255.0 - shade);
    }
    let entry = libm::floor(shade * steps / 255.0 + 0.5);
    (shade - 255.0 * entry / steps).abs()
}

/// Difference between a colour and a palette's nearest entry, on the channel where it is greatest.
fn nearest_error(palette: &Palette, [r, g, b]: [u8; 3]) -> f64 {
    let near = palette[palette.nearest(Rgb::new(r, g, b))];
    let off = [r.abs_diff(near.r), g.abs_diff(near.g), b.abs_diff(near.b)];
    f64::from(off.into_iter().max().unwrap_or(0))
}

/// The greatest [`nearest_error`] over all colours of a surface's image in one shade.
fn image_error(scene: &Scene, palette: &Palette, (object, surface): (usize, u16), shade: u8) -> f64 {
    let material = scene.objects()[object].materials.get(usize::from(surface));
    let Some(image) = material.and_then(|m| m.texture.as_ref().or(m.environment.as_ref())) else { return 0.0 };
    let used = image.colors().iter().zip(image.histogram()).filter(|(_, count)| *count > 0);
    used.map(|(color, _)| {
        let Rgb { r, g, b } = color.modulate(Rgb::new(shade, shade, shade));
        nearest_error(palette, [r, g, b])
    })
    .fold(0.0, f64::max)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_ramp_of_few_entries_adds_up_to_half_a_step() {
        assert!(ramp_error(Ramp::WHOLE, 77.0) == 0.0);
        let five = Ramp::new(16, 5).expect("within 256");
        // Entries stand for 0, 63.75, 127.5, 191.25 and 255.
        for (shade, off) in [(0.0, 0.0), (31.0, 31.0), (32.0, 31.75), (64.0, 0.25), (255.0, 0.0)] {
            assert!((ramp_error(five, shade) - off).abs() < 1e-9, "{shade}");
        }
        assert!(ramp_error(Ramp::single(3), 200.0) == 200.0);
    }

    #[test]
    fn a_palette_adds_what_its_nearest_entry_lacks() {
        let mut colors = [Rgb::BLACK; 256];
        colors[1] = Rgb::new(100, 90, 80);
        let palette = Palette::from_colors(colors);
        assert!(nearest_error(&palette, [97, 95, 80]) == 5.0);
    }
}
