//! Looks: the palette, dither, mapping and vertices of an old machine, under one name.
//!
//! A look is just a set of settings that can also be chosen one by one:
//!
//! | look | colours | dither | [`channels`](Settings::channels) |
//! |---|---|---|---|
//! | `ps1` | made for the scene, with 5 bits per channel | the `PlayStation`'s matrix | yes |
//! | `vga` | the scene's own | the scene's own | the scene's own |
//! | `gameboy` | four greens | ordered | yes |
//! | `cga` | black, cyan, magenta and white | ordered | yes |
//! | `pico8` | the 16 of PICO-8 | ordered | yes |
//!
//! All have affine textures without mipmaps, and vertices on whole pixels.

use core::fmt;
use core::str::FromStr;

use mode13h::UnknownName;
use mode13h::palette::{Palette, Rgb};
use mode13h::scene::Scene;
use mode13h::settings::{DitherPattern, Mapping, Settings};

/// The look of an old machine.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug)]
#[non_exhaustive]
pub enum Look {
    /// Sony's `PlayStation`: 256 dithered colours of 15 bits.
    Ps1,
    /// A game for the VGA: colours of its own, not dithered.
    Vga,
    /// Nintendo's Game Boy.
    GameBoy,
    /// IBM's CGA in its four-colour mode, at high intensity.
    Cga,
    /// Lexaloffle's PICO-8.
    Pico8,
}

/// The colours of a look.
#[derive(Clone, PartialEq, Debug)]
#[non_exhaustive]
pub enum LookColors {
    /// The scene's own.
    Own,
    /// An [automatic palette](crate::auto_palette), [rounded](Look::rounded).
    Made,
    /// A palette without ramps.
    Palette(Box<Palette>),
}

/// The shades of the first Game Boy's screen, from dark to light.
const GAME_BOY: [u32; 4] = [0x0f380f, 0x306230, 0x8bac0f, 0x9bbc0f];

/// Palette 1 of CGA's mode 4, in high intensity.
const CGA: [u32; 4] = [0x000000, 0xff55ff, 0x55ffff, 0xffffff];

/// PICO-8's 16 colours, from dark to light.
const PICO_8: [u32; 16] = [
    0x000000, 0x1d2b53, 0x7e2553, 0xff004d, 0x008751, 0x5f574f, 0xab5236, 0x83769c, 0x00e436, 0x29adff, 0xff77a8,
    0xffa300, 0xc2c3c7, 0xffccaa, 0xffec27, 0xfff1e8,
];

impl Look {
    /// All looks.
    pub const ALL: [Look; 5] = [Look::Ps1, Look::Vga, Look::GameBoy, Look::Cga, Look::Pico8];

    /// Its name, as users type it.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Look::Ps1 => "ps1",
            Look::Vga => "vga",
            Look::GameBoy => "gameboy",
            Look::Cga => "cga",
            Look::Pico8 => "pico8",
        }
    }

    /// The colours.
    #[must_use]
    pub fn colors(self) -> LookColors {
        match self {
            Look::Vga => LookColors::Own,
            Look::Ps1 => LookColors::Made,
            Look::GameBoy => LookColors::Palette(repeated(&GAME_BOY)),
            Look::Cga => LookColors::Palette(repeated(&CGA)),
            Look::Pico8 => LookColors::Palette(repeated(&PICO_8)),
        }
    }

    /// The settings; those that are `None` are left to the scene.
    #[must_use]
    pub fn settings(self) -> Settings {
        let dither = match self {
            Look::Vga => None,
            Look::Ps1 => Some(DitherPattern::Ps1),
            Look::GameBoy | Look::Cga | Look::Pico8 => Some(DitherPattern::Ordered),
        };
        Settings {
            mapping: Some(Mapping::Affine),
            mipmaps: Some(false),
            dither,
            vertex_bits: Some(0),
            channels: dither.map(|_| true),
            ..Settings::default()
        }
    }

    /// The colours of a palette in the look's number of bits: for `ps1` 5 per channel, each rounded to the nearest of
    /// 32 levels.
    #[must_use]
    pub fn rounded(self, palette: &Palette) -> Palette {
        if self != Look::Ps1 {
            return palette.clone();
        }
        let level = |channel: u8| {
            // 0 to 31; the cast keeps it.
            let five = ((u16::from(channel) * 31 + 127) / 255) as u8;
            five << 3 | five >> 2
        };
        let colors = palette.colors().map(|Rgb { r, g, b }| Rgb::new(level(r), level(g), level(b)));
        let rounded = Palette::from_colors(colors);
        // The number of ramps comes from a palette, so it is legal.
        rounded.clone().with_ramps(palette.ramps() as u16).unwrap_or(rounded)
    }

    /// Gives a scene the look, except where it has settings of its own. A palette that has yet to be made becomes its
    /// [preference](Scene::auto_palette).
    pub(crate) fn lend(self, scene: &mut Scene, has_palette: bool) {
        scene.settings = scene.settings.or(&self.settings());
        match self.colors() {
            _ if has_palette => {}
            LookColors::Own => {}
            LookColors::Made => scene.auto_palette = true,
            LookColors::Palette(palette) => scene.palette = Some(*palette),
        }
    }
}

/// A palette of few colours, from dark to light, with equal shares of the entries, and without ramps.
fn repeated(colors: &[u32]) -> Box<Palette> {
    let all = core::array::from_fn(|i| {
        // Below the number of colours.
        let [_, r, g, b] = colors[i * colors.len() / 256].to_be_bytes();
        Rgb::new(r, g, b)
    });
    let palette = Palette::from_colors(all);
    Box::new(palette.clone().with_ramps(0).unwrap_or(palette))
}

impl fmt::Display for Look {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(self.name())
    }
}

impl FromStr for Look {
    type Err = UnknownName;

    fn from_str(name: &str) -> Result<Self, Self::Err> {
        let unknown = UnknownName::of("look", &["ps1", "vga", "gameboy", "cga", "pico8"]);
        Self::ALL.into_iter().find(|look| look.name() == name).ok_or(unknown)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_playstations_colours_have_five_bits() {
        let greys = Palette::from_colors(core::array::from_fn(|i| Rgb::new(i as u8, i as u8, i as u8)));
        let rounded = Look::Ps1.rounded(&greys);
        let mut levels: Vec<u8> = rounded.colors().iter().map(|color| color.r).collect();
        levels.dedup();
        assert_eq!((levels.len(), levels[0], levels[31], rounded.ramps()), (32, 0, 255, 1));
        // No level is farther away than half of the widest step, 9.
        assert!((0..=255).all(|i: u8| rounded[i].r.abs_diff(i) <= 4));
        // On the DAC they stay distinct, which is all that is needed of its 6 bits.
        let mut shown: Vec<u8> = rounded.on_dac().colors().iter().map(|color| color.r).collect();
        shown.dedup();
        assert_eq!(shown.len(), 32);
        assert_eq!(Look::Vga.rounded(&greys), greys);
    }

    #[test]
    fn palettes_of_few_colours_have_each_as_often() {
        for (look, count) in [(Look::GameBoy, 4), (Look::Cga, 4), (Look::Pico8, 16)] {
            let LookColors::Palette(palette) = look.colors() else { panic!("{look}") };
            assert_eq!(palette.ramps(), 0);
            let mut colors = palette.colors().to_vec();
            assert!(colors.is_sorted_by_key(|color| color.brightness()), "{look}");
            colors.dedup();
            assert_eq!(colors.len(), count);
        }
    }

    #[test]
    fn names_are_read_again() {
        assert!(Look::ALL.into_iter().all(|look| look.name().parse() == Ok(look)));
        let error = "nes".parse::<Look>().expect_err("no look");
        assert_eq!(error.to_string(), "unknown look; there are ps1, vga, gameboy, cga, pico8");
    }
}
