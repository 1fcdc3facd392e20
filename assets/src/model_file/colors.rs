//! Colours of faces, as scans have them: a texture whose texels are the model's colours.
//!
//! Each face gets one of up to 256 colours, found by median cut, and its corners the texture coordinates of that
//! colour's texel. So the faces of a scan are one material, lit and shaded as any texture, and no table is made for each
//! colour. A face has one colour all over.

use mode13h::glam::Vec2;
use mode13h::mesh::Surface;
use mode13h::palette::{MedianCut, NearestColors, Rgb};
use mode13h::scene::Shared;
use mode13h::texture::Texture;

use super::Draft;

/// The side of the texture, in texels.
const SIDE: u8 = 16;

/// Gives each face of the draft its colour, by a texture of that name. `colors` has one for each face.
pub(crate) fn paint(draft: &mut Draft, colors: &[Rgb], name: String) {
    let mut sorted = colors.to_vec();
    sorted.sort_unstable();
    // At most 2³¹ faces.
    let counted = sorted.chunk_by(|a, b| a == b).map(|same| (same[0], same.len() as u32)).collect();
    let mut cut = MedianCut::new(counted);
    cut.cut_to(256);
    let means: Vec<Rgb> = cut.means().collect();
    let search = NearestColors::new(&means);
    let lists = &mut draft.lists;
    let centre = |index: u8| (f32::from(index) + 0.5) / f32::from(SIDE);
    lists.texcoords = (0..=255).map(|i| Vec2::new(centre(i % SIDE), centre(i / SIDE))).collect();
    let mut corners = lists.corners.iter_mut();
    for (&size, &color) in lists.sizes.iter().zip(colors) {
        let texel = search.nearest(color);
        corners.by_ref().take(size as usize).for_each(|corner| corner.texcoord = u32::from(texel));
    }
    let mut entries = [Rgb::BLACK; 256];
    entries.iter_mut().zip(means).for_each(|(entry, mean)| *entry = mean);
    let Ok(texture) = Texture::new(SIDE.into(), SIDE.into(), (0..=255).collect(), entries) else { return };
    draft.textures.insert(name.clone(), Shared::new(texture));
    draft.surfaces = [Surface { name: "colours".into(), texture: Some(name), ..Surface::default() }].into();
}
