//! Colours that are on no ramp: in fog, behind transparent surfaces, under coloured light.
//!
//! They are found by rendering the scene in true colour, as three grey pictures, one for each channel, in which lights,
//! materials, images and fog have their intensity on that channel. So light, fog, glass and images are the renderer's
//! own, and no pixel depends on a palette.

use alloc::collections::BTreeMap;
use alloc::vec::Vec;

use mode13h::light::Blend;
use mode13h::palette::{Palette, Rgb};
use mode13h::render::RenderError;
use mode13h::scene::{Fog, Scene, Shared};
use mode13h::texture::Texture;
use mode13h::vga::Vga;

use super::seen::{Numbers, Picture, Round};

/// The colour of a material, and that of its highlight, on three channels.
pub(super) type OwnColors = ([f32; 3], [f32; 3]);

/// The colours of mixed pixels, or of all pixels if `everywhere`, as the card shows them, each with its area as a
/// fraction of all covered pixels. The background's colour is among them, if one was chosen. `own` are the colours of
/// the scene's materials, of all objects in order.
pub(super) fn colors(
    scene: &Scene,
    round: &Round<'_>,
    own: &[OwnColors],
    everywhere: bool,
) -> Result<Vec<(Rgb, f32)>, RenderError> {
    let materials = scene.objects().iter().flat_map(|object| &object.materials);
    let shines: Vec<bool> = materials.clone().map(|material| material.blend != Blend::Opaque).collect();
    let mixes = everywhere || shines.contains(&true);
    if !mixes && scene.background_color.is_none() {
        return Ok(Vec::new());
    }
    let mut numbers = Numbers::new(scene, false);
    // If everything is grey, the three channels are equal.
    let is_grey = scene.fog.is_none()
        && !has_colored_light(scene)
        && own.iter().all(|colors| *colors == ([1.0; 3], [1.0; 3]))
        && materials.clone().all(|material| material.texture.is_none() && material.environment.is_none());
    let last = if is_grey { 0 } else { 2 };
    let mut channels = mixes.then(|| (0..=last).map(|channel| picture(scene, own, channel)).collect::<Vec<_>>());
    let grey = grey();
    let mut counts: BTreeMap<Rgb, u32> = BTreeMap::new();
    let mut covered = 0_u32;
    for moment in round.moments() {
        let numbers = numbers.at(moment)?;
        let background = numbers.iter().filter(|number| number.is_none()).count() as u32;
        covered += Vga::SHOWN as u32 - background;
        if let Some(color) = scene.background_color {
            *counts.entry(color.nearest_on_dac()).or_default() += background;
        }
        let Some(channels) = &mut channels else { continue };
        let seen = channels.iter_mut().map(|channel| channel.at(moment)).collect::<Result<Vec<_>, _>>()?;
        for (i, number) in numbers.iter().enumerate() {
            if number.is_some_and(|number| everywhere || shines[number]) {
                let [r, g, b] = [0, 1, 2].map(|channel| grey[seen[last.min(channel)][i]].r);
                *counts.entry(Rgb::new(r, g, b)).or_default() += 1;
            }
        }
    }
    // 64 pictures at most: 4,096,000 pixels.
    Ok(counts.into_iter().map(|(color, count)| (color, count as f32 / covered.max(1) as f32)).collect())
}

/// Returns whether a light in the scene is coloured, so that everything is lit on three channels.
pub(super) fn has_colored_light(scene: &Scene) -> bool {
    scene.lights().iter().any(|light| light.is_colored() && light.intensity() != 0.0)
}

/// The palette whose entry i is the grey nearest to i that the card can show.
fn grey() -> Palette {
    // Below 256.
    Palette::from_colors(core::array::from_fn(|i| even(i as u8).nearest_on_dac()))
}

fn even(value: u8) -> Rgb {
    Rgb::new(value, value, value)
}

/// One channel of the scene, 0 to 2, as a grey picture.
fn picture(scene: &Scene, own: &[OwnColors], channel: usize) -> Picture {
    let of = |color: Rgb| [color.r, color.g, color.b][channel];
    let mut images: Vec<(Shared<Texture>, Shared<Texture>)> = Vec::new();
    let mut in_grey = |image: &Shared<Texture>| {
        if let Some((_, known)) = images.iter().find(|(of, _)| Shared::ptr_eq(of, image)) {
            return Shared::clone(known);
        }
        let made = Shared::new(image.recolored(image.colors().map(|color| even(of(color)))));
        images.push((Shared::clone(image), Shared::clone(&made)));
        made
    };
    let mut picture = Picture::new(scene, |number, material| {
        let (color, highlight) = own[number];
        material.ambient *= color[channel];
        material.diffuse *= color[channel];
        material.specular *= highlight[channel];
        material.texture = material.texture.as_ref().map(&mut in_grey);
        material.environment = material.environment.as_ref().map(&mut in_grey);
    });
    let grey_scene = picture.scene_mut();
    for light in grey_scene.lights_mut() {
        *light = light.with_intensity(light.intensity() * light.color()[channel]).with_color([1.0; 3]);
    }
    grey_scene.palette = Some(grey());
    grey_scene.fog = scene.fog.map(|fog| Fog { color: even(of(fog.color)), ..fog });
    grey_scene.background = scene.background_color.map_or(0, of);
    picture
}
