//! The lookup tables of effects. Each is computed when first needed, and again when the palette or another of its
//! inputs has changed. Tables of an image that is no longer in use are dropped when another image needs a table.

use alloc::vec;
use alloc::vec::Vec;
use core::mem;

use crate::light::Blend;
use crate::palette::cube::CUBE;
use crate::palette::{InverseColormap, Lut64K, Palette, Rgb};
use crate::raster::effects::Mix;
use crate::shared::{Shared, WeakShared};
use crate::span::texture::Levels;
use crate::texture::{Mipmap, Texture};

/// A texture as it is drawn.
#[derive(Clone, Copy)]
pub(super) struct Image<'a> {
    pub(super) texture: &'a Shared<Texture>,
    /// True if it has smaller copies, and so more colours.
    pub(super) has_levels: bool,
}

/// A table, or a mipmap, that was computed for an image.
#[derive(Debug)]
struct Made<T> {
    texture: WeakShared<Texture>,
    has_levels: bool,
    made: T,
}

/// The tables of a palette.
#[derive(Debug, Default)]
pub(super) struct Tables {
    palette: Option<Palette>,
    fog: Option<(Option<Rgb>, Lut64K)>,
    nearest: Option<InverseColormap>,
    /// Valid for every palette.
    mipmaps: Vec<Made<Mipmap>>,
    /// The row is a shade, the column a texel, the entry the lit texel's index; then the same for each of three
    /// channels, where the entry is the lit texel's channel.
    shades: [Vec<Made<Vec<Lut64K>>>; 2],
    blends: Vec<(Blend, Lut64K)>,
    /// Each entry is its row: an image that changes no shade.
    neutral_shades: Option<Lut64K>,
    /// The channel that is shown instead of the mix of the three.
    pub(super) only_channel: Option<usize>,
}

impl Tables {
    /// Switches the tables to this palette.
    pub(super) fn use_palette(&mut self, palette: &Palette) {
        if self.palette.as_ref() != Some(palette) {
            let mipmaps = mem::take(&mut self.mipmaps);
            *self =
                Self { palette: Some(palette.clone()), mipmaps, only_channel: self.only_channel, ..Self::default() };
        }
    }

    fn palette(&self) -> &Palette {
        self.palette.as_ref().unwrap_or(&crate::palette::BIOS)
    }

    /// Creates a table of fog in this colour, if there is none; for `None`, one that hides nothing.
    pub(super) fn ensure_fog(&mut self, color: Option<Rgb>) {
        if self.fog.as_ref().is_none_or(|(of, _)| *of != color) {
            let table = match color {
                None => Lut64K::from_fn(|_, index| index),
                Some(color) => Lut64K::fog(self.palette(), color),
            };
            self.fog = Some((color, table));
        }
    }

    pub(super) fn fog(&self) -> Option<&[u8; 65_536]> {
        self.fog.as_ref().map(|(_, table)| table.as_array())
    }

    pub(super) fn ensure_mix(&mut self) {
        if self.nearest.is_none() && self.palette() != &CUBE {
            self.nearest = Some(InverseColormap::new(self.palette()));
        }
    }

    /// How channels are mixed; the cube needs no table.
    pub(super) fn mix(&self, dither: bool) -> Mix<'_> {
        match (self.only_channel, &self.nearest) {
            (Some(channel), _) => Mix::Only(channel),
            (None, Some(nearest)) => {
                Mix::Nearest { map: nearest.as_array(), spread: if dither { nearest.spread() } else { 0 } }
            }
            (None, None) => Mix::Cube,
        }
    }

    /// The smaller copies of an image that has some.
    pub(super) fn levels(&self, image: Image<'_>) -> Option<Levels<'_>> {
        find(&self.mipmaps, image).map(Mipmap::levels)
    }

    /// Computes the tables of an image, and its smaller copies if it has them; for `None`, a table that changes
    /// nothing.
    pub(super) fn ensure_shades(&mut self, image: Option<Image<'_>>, in_channels: bool) {
        let Some(image) = image else {
            self.neutral_shades.get_or_insert_with(|| Lut64K::from_fn(|shade, _| shade));
            return;
        };
        if find(&self.shades[usize::from(in_channels)], image).is_some() {
            return;
        }
        if image.has_levels && find(&self.mipmaps, image).is_none() {
            add(&mut self.mipmaps, image, Mipmap::new(image.texture));
        }
        // Including those of the smaller copies.
        let colors = find(&self.mipmaps, image).map_or(image.texture.colors(), Mipmap::colors);
        let lit = |channel: fn(Rgb) -> u8| {
            Lut64K::from_fn(|shade, texel| {
                let full = u32::from(channel(colors[usize::from(texel)]));
                // At most 255.
                ((full * u32::from(shade) + 127) / 255) as u8
            })
        };
        let tables = match in_channels {
            true => vec![lit(|c| c.r), lit(|c| c.g), lit(|c| c.b)],
            false => vec![Lut64K::shades(self.palette(), colors)],
        };
        add(&mut self.shades[usize::from(in_channels)], image, tables);
    }

    /// The table of an image for each channel; all are the same without channels.
    pub(super) fn shades(&self, image: Option<Image<'_>>, in_channels: bool) -> Option<[&[u8; 65_536]; 3]> {
        let tables = match image {
            None => self.neutral_shades.as_slice(),
            Some(image) => find(&self.shades[usize::from(in_channels)], image)?,
        };
        match tables {
            [one] => Some([one.as_array(); 3]),
            [red, green, blue] => Some([red, green, blue].map(Lut64K::as_array)),
            _ => None,
        }
    }

    pub(super) fn ensure_blend(&mut self, blend: Blend) {
        if self.blend(blend).is_none() {
            let table = match blend {
                // The new byte itself.
                Blend::Opaque => Lut64K::from_fn(|new, _| new),
                Blend::Mix(opacity) => Lut64K::blend(self.palette(), opacity),
                Blend::Add => Lut64K::add(self.palette()),
            };
            self.blends.push((blend, table));
        }
    }

    pub(super) fn blend(&self, blend: Blend) -> Option<&[u8; 65_536]> {
        self.blends.iter().find(|(of, _)| *of == blend).map(|(_, table)| table.as_array())
    }
}

/// Adds what was computed for an image, and drops what belongs to textures that are gone.
fn add<T>(all: &mut Vec<Made<T>>, image: Image<'_>, made: T) {
    all.retain(|made| made.texture.strong_count() > 0);
    all.push(Made { texture: Shared::downgrade(image.texture), has_levels: image.has_levels, made });
}

/// Finds the table of an image, by the identity of its texture: an equal texture does not match.
fn find<'a, T>(all: &'a [Made<T>], image: Image<'_>) -> Option<&'a T> {
    // No other texture gets the address of one that is gone as long as a weak reference to it exists.
    let is_of =
        |made: &&Made<T>| made.texture.as_ptr() == Shared::as_ptr(image.texture) && made.has_levels == image.has_levels;
    all.iter().find(is_of).map(|made| &made.made)
}
