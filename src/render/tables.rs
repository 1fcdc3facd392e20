//! The tables that effects look things up in. Each is made when something first needs it, and anew when
//! the palette, or what else it was made from, has changed; a table that nothing needs is not there.

use alloc::vec::Vec;

use crate::light::Blend;
use crate::palette::cube::CUBE;
use crate::palette::{Nearest, Palette, Rgb, Table};
use crate::raster::effects::Mix;
use crate::scene::Shared;
use crate::texture::Texture;

/// The tables of a palette.
#[derive(Debug, Default)]
pub(super) struct Tables {
    palette: Option<Palette>,
    fog: Option<(Rgb, Table)>,
    nearest: Option<Nearest>,
    shades: Vec<(Shared<Texture>, Table)>,
    channels: Vec<(Shared<Texture>, [Table; 3])>,
    blends: Vec<(Blend, Table)>,
    /// The row itself: an image that changes no shade.
    neutral_shades: Option<Table>,
    /// The column itself: fog that hides nothing.
    neutral_fog: Option<Table>,
    /// The channel that is shown instead of what the three are mixed to.
    pub(super) only_channel: Option<usize>,
}

impl Tables {
    /// Tables are from now on for this palette. Says whether it is another one than before.
    pub(super) fn use_palette(&mut self, palette: &Palette) -> bool {
        if self.palette.as_ref() == Some(palette) {
            return false;
        }
        *self = Self { palette: Some(palette.clone()), only_channel: self.only_channel, ..Self::default() };
        true
    }

    fn palette(&self) -> &Palette {
        self.palette.as_ref().unwrap_or(&crate::palette::BIOS)
    }

    /// Sees to it that there is a table of fog in this colour; of none, one that changes nothing.
    pub(super) fn need_fog(&mut self, color: Option<Rgb>) {
        match color {
            None if self.neutral_fog.is_none() => self.neutral_fog = Some(Table::from_fn(|_, index| index)),
            Some(color) if self.fog.as_ref().is_none_or(|(of, _)| *of != color) => {
                self.fog = Some((color, Table::fog(self.palette(), color)));
            }
            _ => {}
        }
    }

    pub(super) fn fog(&self, color: Option<Rgb>) -> Option<&[u8; 65_536]> {
        match color {
            None => self.neutral_fog.as_ref().map(Table::as_array),
            Some(_) => self.fog.as_ref().map(|(_, table)| table.as_array()),
        }
    }

    pub(super) fn need_mix(&mut self) {
        if self.nearest.is_none() && self.palette() != &CUBE {
            self.nearest = Some(Nearest::new(self.palette()));
        }
    }

    /// The cube needs no table.
    pub(super) fn mix(&self, dither: bool) -> Mix<'_> {
        match (self.only_channel, &self.nearest) {
            (Some(channel), _) => Mix::Only(channel),
            (None, Some(nearest)) => {
                Mix::Nearest { map: nearest.as_array(), spread: if dither { nearest.spread() } else { 0 } }
            }
            (None, None) => Mix::Cube,
        }
    }

    pub(super) fn need_shades(&mut self, texture: Option<&Shared<Texture>>) {
        match texture {
            None if self.neutral_shades.is_none() => self.neutral_shades = Some(Table::from_fn(|shade, _| shade)),
            Some(texture) if find(&self.shades, texture).is_none() => {
                let table = Table::shades(self.palette(), texture.colors());
                self.shades.push((Shared::clone(texture), table));
            }
            _ => {}
        }
    }

    pub(super) fn shades(&self, texture: Option<&Shared<Texture>>) -> Option<[&[u8; 65_536]; 3]> {
        let table = match texture {
            None => self.neutral_shades.as_ref(),
            Some(texture) => find(&self.shades, texture),
        };
        table.map(|table| [table.as_array(); 3])
    }

    /// Of channels: row a channel's shade, column a texel, entry the channel of the lit texel.
    pub(super) fn need_channels(&mut self, texture: &Shared<Texture>) {
        if find(&self.channels, texture).is_none() {
            let lit = |channel: fn(Rgb) -> u8| {
                Table::from_fn(|shade, texel| {
                    let full = u32::from(channel(texture.colors()[usize::from(texel)]));
                    // At most 255.
                    ((full * u32::from(shade) + 127) / 255) as u8
                })
            };
            self.channels.push((Shared::clone(texture), [lit(|c| c.r), lit(|c| c.g), lit(|c| c.b)]));
        }
    }

    pub(super) fn channels(&self, texture: &Shared<Texture>) -> Option<[&[u8; 65_536]; 3]> {
        find(&self.channels, texture).map(|tables| tables.each_ref().map(Table::as_array))
    }

    pub(super) fn need_blend(&mut self, blend: Blend) {
        if self.blend(blend).is_none() {
            let table = match blend {
                // The new byte itself.
                Blend::Opaque => Table::from_fn(|new, _| new),
                Blend::Mix(opacity) => Table::blend(self.palette(), opacity),
                Blend::Add => Table::add(self.palette()),
            };
            self.blends.push((blend, table));
        }
    }

    pub(super) fn blend(&self, blend: Blend) -> Option<&[u8; 65_536]> {
        self.blends.iter().find(|(of, _)| *of == blend).map(|(_, table)| table.as_array())
    }

    /// Bytes of all tables.
    pub(super) fn bytes(&self) -> usize {
        let tables = usize::from(self.fog.is_some())
            + self.shades.len()
            + 3 * self.channels.len()
            + self.blends.len()
            + usize::from(self.neutral_shades.is_some())
            + usize::from(self.neutral_fog.is_some());
        tables * Table::BYTES + if self.nearest.is_some() { Nearest::BYTES } else { 0 }
    }
}

/// What was made for a texture: for the very same one, not for one that looks alike.
fn find<'a, T>(made: &'a [(Shared<Texture>, T)], texture: &Shared<Texture>) -> Option<&'a T> {
    made.iter().find(|(of, _)| Shared::ptr_eq(of, texture)).map(|(_, table)| table)
}
