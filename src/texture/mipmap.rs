//! Mipmaps: a texture with smaller copies, each half as wide and half as high as the one before (L. Williams,
//! *Pyramidal Parametrics*, SIGGRAPH 1983). A texel of level n is the mean of the 2ⁿ × 2ⁿ texels that it represents.

use alloc::vec::Vec;

use super::Texture;
use crate::palette::MedianCut;
use crate::palette::{NearestColors, Rgb};
use crate::span::texture::Levels;

/// The smaller copies of a texture, level 1 and up, and the colours shared by all levels.
///
/// Colours are averaged as DAC values without gamma, in integer sums rounded once; a side of one texel is not halved.
/// Means that are not a colour of the texture get the entries that none of its texels uses. If these are too few, the
/// means are reduced by median cut, and each texel then gets the nearest. The texture's own texels keep their entries
/// and colours, so one table of shades serves every level.
///
/// ```
/// use mode13h::palette::Rgb;
/// use mode13h::texture::{Mipmap, Texture};
/// let texture = Texture::from_rgb(2, 1, &[Rgb::new(250, 0, 0), Rgb::new(0, 100, 0)])?;
/// let mipmap = Mipmap::new(&texture);
/// let texel = mipmap.levels().get(1).expect("2 × 1 has a level 1").at(0, 0);
/// assert_eq!(mipmap.colors()[usize::from(texel)], Rgb::new(125, 50, 0));
/// # Ok::<(), mode13h::texture::TextureError>(())
/// ```
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct Mipmap {
    /// The texels, level by level, from level 1.
    texels: Vec<u8>,
    colors: [Rgb; 256],
    width_bits: u32,
    height_bits: u32,
}

impl Mipmap {
    /// Makes the smaller copies of a texture.
    #[must_use]
    pub fn new(texture: &Texture) -> Self {
        let (width_bits, height_bits) = (texture.width_bits(), texture.height_bits());
        let means = means(texture);
        let (mut colors, histogram) = (*texture.colors(), texture.histogram());
        let (mut entries, free): (Vec<u8>, Vec<u8>) = (0..=255).partition(|&entry| histogram[usize::from(entry)] > 0);
        let mut shown: Vec<Rgb> = entries.iter().map(|&entry| colors[usize::from(entry)]).collect();
        let mut own: Vec<u32> = shown.iter().map(|color| color.to_u32()).collect();
        own.sort_unstable();
        let missing = means.iter().map(|(mean, area)| (mean.to_u32(), *area));
        let mut missing: Vec<(u32, u32)> = missing.filter(|(mean, _)| own.binary_search(mean).is_err()).collect();
        missing.sort_unstable();
        let missing = missing.chunk_by(|(a, _), (b, _)| a == b);
        let sum = |same: &[(u32, u32)]| same.iter().map(|(_, area)| area).sum();
        let missing = missing.map(|same| (Rgb::from_u32(same[0].0), sum(same))).collect();
        if !free.is_empty() {
            let mut cut = MedianCut::new(missing);
            cut.cut_to(free.len());
            for (&entry, mean) in free.iter().zip(cut.means()) {
                colors[usize::from(entry)] = mean;
                entries.push(entry);
                shown.push(mean);
            }
        }
        let search = NearestColors::new(&shown);
        let texels = means.iter().map(|&(mean, _)| entries[usize::from(search.nearest(mean))]).collect();
        Self { texels, colors, width_bits, height_bits }
    }

    /// The colours of the texels of all levels, including level 0. Unused entries may be anything.
    #[must_use]
    pub fn colors(&self) -> &[Rgb; 256] {
        &self.colors
    }

    /// The levels from 1 up.
    #[must_use]
    pub fn levels(&self) -> Levels<'_> {
        match Levels::new(&self.texels, self.width_bits, self.height_bits) {
            Ok(levels) => levels,
            Err(_) => unreachable!("as many texels as levels have"),
        }
    }

    /// The colours of all levels with their weights: each level has half the total weight of the one before. `texture`
    /// is the one that the mipmap was made from.
    pub fn weights(&self, texture: &Texture) -> Vec<(Rgb, u32)> {
        // In 1/256 of a texel of level 0.
        let mut weights = texture.histogram().map(|count| count << 8);
        let mut rest = &self.texels[..];
        for level in 1..=Levels::deepest(self.width_bits, self.height_bits) {
            let (columns, rows) = (self.width_bits.saturating_sub(level), self.height_bits.saturating_sub(level));
            let of_level;
            (of_level, rest) = rest.split_at(1 << (columns + rows));
            let area = 1 << (level.min(self.width_bits) + level.min(self.height_bits));
            of_level.iter().for_each(|&texel| weights[usize::from(texel)] += (area << 8) >> level);
        }
        self.colors.into_iter().zip(weights).collect()
    }
}

/// The mean colour of every texel of the levels from 1 up, and the number of level-0 texels that it represents.
fn means(texture: &Texture) -> Vec<(Rgb, u32)> {
    let (width_bits, height_bits) = (texture.width_bits(), texture.height_bits());
    let mut means = Vec::with_capacity(Levels::length(width_bits, height_bits));
    // Sums of up to 65,536 bytes.
    let mut sums: Vec<[u32; 3]> = texture
        .texels()
        .iter()
        .map(|&texel| {
            let Rgb { r, g, b } = texture.colors()[usize::from(texel)];
            [r, g, b].map(u32::from)
        })
        .collect();
    for level in 1..=Levels::deepest(width_bits, height_bits) {
        let (width, height) = (1 << width_bits.saturating_sub(level), 1 << height_bits.saturating_sub(level));
        // One or two columns and rows of the level before.
        let (columns, rows) = (1 + usize::from(level <= width_bits), 1 + usize::from(level <= height_bits));
        let sum = |x: usize, y: usize| {
            let of = |channel: usize| {
                let rows = y * rows..(y + 1) * rows;
                rows.flat_map(|y| &sums[y * width * columns..][x * columns..][..columns]).map(|sum| sum[channel]).sum()
            };
            [of(0), of(1), of(2)]
        };
        let next: Vec<[u32; 3]> =
            (0..height).flat_map(|y| (0..width).map(move |x| (x, y))).map(|(x, y)| sum(x, y)).collect();
        let area = 1 << (level.min(width_bits) + level.min(height_bits));
        means.extend(next.iter().map(|sums| {
            // A mean of bytes is a byte.
            let [r, g, b] = sums.map(|sum| ((sum + area / 2) / area) as u8);
            (Rgb::new(r, g, b), area)
        }));
        sums = next;
    }
    means
}
