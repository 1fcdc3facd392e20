//! The built-in palettes, by name.
//!
//! They are computed here in integers, at compile time, from key colours. The keys were tuned by a
//! few units, by trial, so that the DAC's channels step one after the other: copper has 156
//! distinct shades there instead of 141. The files in `palettes/` are written from these tables,
//! and a test ensures that both are equal. All are our own work except `bios`.

use super::gradient::{Stop, fill};
use super::{BIOS, Palette, Ramp, Rgb, cube};

/// A palette with its name and origin.
#[derive(Clone, PartialEq, Eq, Debug)]
#[non_exhaustive]
pub struct Builtin {
    /// The name, as used on the command line.
    pub name: &'static str,
    /// The colours.
    pub palette: &'static Palette,
    /// Its description and origin, in one line.
    pub provenance: &'static str,
}

/// All built-in palettes.
pub static ALL: [Builtin; 9] = [
    Builtin { name: "grey", palette: &GREY, provenance: "256 even greys; the DAC shows 64 of them. Made here." },
    Builtin {
        name: "silver",
        palette: &SILVER,
        provenance: "a grey whose channels step at different places: 178 shades on the DAC. Made here.",
    },
    Builtin {
        name: "copper",
        palette: &COPPER,
        provenance: "one ramp from near black by copper to near white. Made here.",
    },
    Builtin {
        name: "phosphor",
        palette: &PHOSPHOR,
        provenance: "the green of an old terminal, up to its glare. Made here.",
    },
    Builtin {
        name: "materials-4x64",
        palette: &MATERIALS_4X64,
        provenance: "four ramps: copper, steel, jade, lapis. Made here.",
    },
    Builtin {
        name: "materials-8x32",
        palette: &MATERIALS_8X32,
        provenance: "eight ramps: copper, gold, ruby, jade, turquoise, lapis, amethyst, chalk. Made here.",
    },
    Builtin {
        name: "materials-16x16",
        palette: &MATERIALS_16X16,
        provenance: "sixteen ramps: chalk, steel, and fourteen hues from brown to rose. Made here.",
    },
    Builtin {
        name: "cube",
        palette: &cube::CUBE,
        provenance: "6 × 6 × 6 mixtures and 40 greys, exact on the DAC. Made here.",
    },
    Builtin {
        name: "bios",
        palette: &BIOS,
        provenance: "the 256 colours of the VGA BIOS for mode 13h, after published tables.",
    },
];

/// Looks up a palette by name, spelled as in [`ALL`]. Returns `None` if there is none.
///
/// ```
/// use mode13h::palette::builtin;
/// assert_eq!(builtin::by_name("copper").map(|copper| copper.palette.ramps()), Some(1));
/// assert!(builtin::by_name("mauve").is_none());
/// ```
#[must_use]
pub fn by_name(name: &str) -> Option<&'static Builtin> {
    ALL.iter().find(|builtin| builtin.name == name)
}

/// One ramp: entry `i` is `i, i, i`. On the DAC four neighbouring entries look the same.
pub static GREY: Palette = of_ramps(&[&[Stop::new(0, 0x000000), Stop::new(255, 0xffffff)]]);

/// One ramp, grey to within two or three of 255. The channels differ just enough to step at different entries on the
/// DAC: 178 shades where [`GREY`] has 64.
pub static SILVER: Palette =
    of_ramps(&[&[Stop::new(0, 0x000204), Stop::new(97, 0x5f6062), Stop::new(195, 0xc1c2c4), Stop::new(255, 0xfcfeff)]]);

/// One ramp, copper.
pub static COPPER: Palette = of_ramps(&[COPPER_KEYS]);

const COPPER_KEYS: &[Stop] = &[
    Stop::new(0, 0x050102),
    Stop::new(65, 0x4c200b),
    Stop::new(122, 0xa35233),
    Stop::new(194, 0xec996b),
    Stop::new(255, 0xfff8ee),
];

/// One ramp, the green of a P1 phosphor.
pub static PHOSPHOR: Palette = of_ramps(&[&[
    Stop::new(0, 0x000300),
    Stop::new(126, 0x10881e),
    Stop::new(196, 0x4aef68),
    Stop::new(255, 0xe8ffe8),
]]);

/// Four ramps of 64: copper, steel, jade, lapis.
pub static MATERIALS_4X64: Palette =
    of_ramps(&[COPPER_KEYS, &material(0x7c8ea6), &material(0x2f9a62), &material(0x3158c4)]);

/// Eight ramps of 32: copper, gold, ruby, jade, turquoise, lapis, amethyst, chalk.
pub static MATERIALS_8X32: Palette = of_ramps(&[
    COPPER_KEYS,
    &material(0xc89a28),
    &material(0xb82038),
    &material(0x2f9a62),
    &material(0x20a0a8),
    &material(0x3158c4),
    &material(0x8448bc),
    &material(0xb4aea4),
]);

/// Sixteen ramps of 16: chalk, steel, brown, red, orange, gold, yellow, lime, green, jade, turquoise,
/// sky, blue, violet, magenta, rose.
pub static MATERIALS_16X16: Palette = of_ramps(&[
    &material(0xb4aea4),
    &material(0x7c8ea6),
    &material(0x80502c),
    &material(0xb82424),
    &material(0xd06c20),
    &material(0xc89a28),
    &material(0xccc030),
    &material(0x88b828),
    &material(0x30a030),
    &material(0x2f9a70),
    &material(0x20a0a8),
    &material(0x3c90d8),
    &material(0x3050cc),
    &material(0x6c40c0),
    &material(0xb038a8),
    &material(0xd0607c),
]);

/// The keys of a material's ramp: from a sixteenth of a colour, through the colour itself at three fifths of the way,
/// to a highlight nine tenths of the way from the colour to white. No channel ever decreases.
const fn material(rgb: u32) -> [Stop; 3] {
    let base = Rgb::from_u32(rgb);
    let dark = Rgb::new(base.r / 16, base.g / 16, base.b / 16);
    let light = Rgb::new(highlight(base.r), highlight(base.g), highlight(base.b));
    [Stop { at: 0, color: dark }, Stop { at: 153, color: base }, Stop { at: 255, color: light }]
}

const fn highlight(v: u8) -> u8 {
    // At most 255, since it is between v and 255.
    (v as u16 + (255 - v as u16) * 9 / 10) as u8
}

/// A palette of equal ramps, one for each list of keys: 1, 2, 4 … 256.
const fn of_ramps(ramps: &[&[Stop]]) -> Palette {
    assert!(ramps.len().is_power_of_two() && ramps.len() <= 256, "a const's author counts the ramps");
    let mut colors = [Rgb::BLACK; 256];
    let entries = 256 / ramps.len();
    let mut i = 0;
    while i < ramps.len() {
        // i·entries is below 256, entries at most 256.
        if let Some(ramp) = Ramp::new((i * entries) as u8, entries as u16) {
            fill(&mut colors, ramp, ramps[i]);
        }
        i += 1;
    }
    Palette::from_parts(colors, ramps.len() as u16)
}
