//! Face colours, as scans have them, as a texture whose texels are the model's colours.
//!
//! Each such face gets one of up to 256 colours, found by median cut, and its corners the texture coordinates of that
//! colour's texel. So the faces of a scan are one material, lit and shaded like any texture, and no table per colour is
//! needed. A face has a single colour.

use mode13h::glam::Vec2;
use mode13h::mesh::Surface;
use mode13h::palette::{MedianCut, NearestColors, Rgb};
use mode13h::scene::Shared;
use mode13h::texture::Texture;

use super::Draft;
use super::lists::{Corner, Lists};

/// The side of the texture, in texels.
const SIDE: u8 = 16;

/// Sets the colours of faces in the draft with a texture of that name; `colors` has the faces' indices, in ascending
/// order. Returns the surface that these faces must have.
pub(crate) fn paint(draft: &mut Draft, colors: &[(usize, Rgb)], name: String) -> Surface {
    let mut sorted: Vec<Rgb> = colors.iter().map(|(_, color)| *color).collect();
    sorted.sort_unstable();
    // At most 2³¹ faces.
    let counted = sorted.chunk_by(|a, b| a == b).map(|same| (same[0], same.len() as u32)).collect();
    let mut cut = MedianCut::new(counted);
    cut.cut_to(256);
    let means: Vec<Rgb> = cut.means().collect();
    let search = NearestColors::new(&means);
    let lists = &mut draft.lists;
    // Fewer than 2³² corners, and about as many pairs.
    let first_pair = lists.texcoords.len() as u32;
    let centre = |index: u8| (f32::from(index) + 0.5) / f32::from(SIDE);
    lists.texcoords.extend((0..=255).map(|i| Vec2::new(centre(i % SIDE), centre(i / SIDE))));
    let mut corners = lists.corners.iter_mut();
    let mut colors = colors.iter().peekable();
    for (face, &size) in lists.sizes.iter().enumerate() {
        let corners = corners.by_ref().take(size as usize);
        match colors.next_if(|(colored, _)| *colored == face) {
            Some((_, color)) => {
                let pair = first_pair + u32::from(search.nearest(*color));
                corners.for_each(|corner| corner.texcoord = pair);
            }
            None => corners.for_each(drop),
        }
    }
    let mut entries = [Rgb::BLACK; 256];
    entries.iter_mut().zip(means).for_each(|(entry, mean)| *entry = mean);
    let texture = Texture::new(SIDE.into(), SIDE.into(), (0..=255).collect(), entries).ok().map(|texture| {
        draft.textures.insert(name.clone(), Shared::new(texture));
        name
    });
    Surface { name: "colours".into(), texture, ..Surface::default() }
}

/// The colour of each face, given one for each position: the mean of its corners.
pub(crate) fn of_faces(lists: &Lists, of_vertices: &[Rgb]) -> Vec<Rgb> {
    let mut corners = lists.corners.iter();
    lists.sizes.iter().map(|&size| mean(corners.by_ref().take(size as usize), of_vertices)).collect()
}

/// The mean colour of a face's corners.
fn mean<'c>(corners: impl Iterator<Item = &'c Corner>, colors: &[Rgb]) -> Rgb {
    let (mut sums, mut count) = ([0_u64; 3], 0);
    for corner in corners {
        let Rgb { r, g, b } = colors[corner.position as usize];
        sums.iter_mut().zip([r, g, b]).for_each(|(sum, channel)| *sum += u64::from(channel));
        count += 1;
    }
    // At most 255.
    let [r, g, b] = sums.map(|sum| ((sum + count / 2) / count.max(1)) as u8);
    Rgb::new(r, g, b)
}
