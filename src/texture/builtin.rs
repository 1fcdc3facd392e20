//! The built-in textures, computed in integers from a hash, so they are the same on every machine.
//! `checker` and `bricks` tile seamlessly; `crate` is one side of a box, and `sky` is looked up by
//! a normal.

use alloc::vec::Vec;
use core::str::FromStr;

use super::Texture;
use crate::UnknownName;
use crate::palette::gradient::{Stop, fill};
use crate::palette::{Ramp, Rgb};

/// The built-in texture with this name.
///
/// | name | texels | what |
/// |---|---|---|
/// | `crate` | 128 × 128 | the side of a wooden crate: planks, a frame, a brace across |
/// | `checker` | 64 × 64 | squares of 8 × 8, light and dark |
/// | `bricks` | 128 × 128 | a wall in running bond, eight courses |
/// | `sky` | 128 × 128 | what a mirror reflects outdoors, as a sphere map: a bright horizon, the sun, dark ground |
impl FromStr for Texture {
    type Err = UnknownName;

    fn from_str(name: &str) -> Result<Self, UnknownName> {
        match name {
            "crate" => Ok(wooden_crate()),
            "checker" => Ok(checker()),
            "bricks" => Ok(bricks()),
            "sky" => Ok(sky()),
            _ => Err(UnknownName::of("texture", &Self::NAMES)),
        }
    }
}

impl Texture {
    /// The names of the built-in textures.
    pub const NAMES: [&'static str; 4] = ["crate", "checker", "bricks", "sky"];

    /// A square of 2^`bits` texels per side; `texel(x, y)` with y from the bottom up.
    fn square(bits: u32, colors: [Rgb; 256], texel: impl Fn(i32, i32) -> u8) -> Self {
        let side = 0..1 << bits;
        let texels: Vec<u8> =
            side.clone().flat_map(|y| side.clone().map(move |x| (x, y))).map(|(x, y)| texel(x, y)).collect();
        Self { texels, colors, width_bits: bits, height_bits: bits }
    }
}

/// Consecutive ramps, each with a number of entries and its keys.
fn ramps(of: &[(u16, &[Stop])]) -> [Rgb; 256] {
    let mut colors = [Rgb::BLACK; 256];
    let mut first = 0_u16;
    for &(entries, keys) in of {
        if let Some(ramp) = u8::try_from(first).ok().and_then(|first| Ramp::new(first, entries)) {
            fill(&mut colors, ramp, keys);
        }
        first += entries;
    }
    colors
}

/// An entry of a ramp: `first` plus `shade`, clamped to 0 to `entries` − 1.
fn entry(first: i32, entries: i32, shade: i32) -> u8 {
    // At most 255, since the ramps of each texture fit into 256 entries.
    (first + shade.clamp(0, entries - 1)) as u8
}

/// A pseudo-random hash, 0 to 255.
fn hash(x: i32, y: i32, seed: u32) -> i32 {
    // The mixing step of MurmurHash3, on two coordinates; the signs do not matter.
    let mut h =
        (x as u32).wrapping_mul(0x9E37_79B9) ^ (y as u32).wrapping_mul(0x85EB_CA6B) ^ seed.wrapping_mul(0xC2B2_AE35);
    h = (h ^ (h >> 16)).wrapping_mul(0x85EB_CA6B);
    h = (h ^ (h >> 13)).wrapping_mul(0xC2B2_AE35);
    ((h ^ (h >> 16)) & 255) as i32
}

/// Value noise, 0 to 255, on a lattice with cells of 2^`bits.0` × 2^`bits.1` texels, with a period of 128 texels in
/// both directions.
fn noise(x: i32, y: i32, bits: (u32, u32), seed: u32) -> i32 {
    let (columns, rows) = (128 >> bits.0, 128 >> bits.1);
    let (cx, cy) = (x >> bits.0, y >> bits.1);
    // The position in the cell, 0 to 255, eased: 3t² − 2t³.
    let ease = |v: i32, bits: u32| {
        let t = ((v & ((1 << bits) - 1)) << 8) >> bits;
        (t * t * (768 - 2 * t)) >> 16
    };
    let (tx, ty) = (ease(x, bits.0), ease(y, bits.1));
    let at = |dx: i32, dy: i32| hash((cx + dx) & (columns - 1), (cy + dy) & (rows - 1), seed);
    let mix = |a: i32, b: i32, t: i32| (a * (256 - t) + b * t) >> 8;
    mix(mix(at(0, 0), at(1, 0), tx), mix(at(0, 1), at(1, 1), tx), ty)
}

const WOOD: &[Stop] = &[
    Stop::new(0, 0x140a04),
    Stop::new(70, 0x4a2a12),
    Stop::new(150, 0x96622e),
    Stop::new(215, 0xcf9a56),
    Stop::new(255, 0xf0cc90),
];

/// The number of entries of the wood's ramp.
const WOODS: i32 = 96;

/// The shade of a board's wood at a point: `along` runs with the grain and `across` against it, and the point is `edge`
/// texels from the lit edge and `far` from the other.
fn board(along: i32, across: i32, edge: i32, far: i32, number: u32) -> i32 {
    let tone = 56 + hash(number as i32, 7, 11) % 13 - 6;
    let fibres = (noise(along, across, (4, 0), number) - 128) / 12;
    let rings = (noise(along, across * 2, (5, 3), number + 40) - 128) / 14;
    let bevel = match (edge, far) {
        (0, _) => 18,
        (1, _) => 8,
        (_, 0) => -34,
        (_, 1) => -14,
        _ => 0,
    };
    tone + fibres + rings + bevel
}

fn wooden_crate() -> Texture {
    const FRAME: i32 = 18;
    let colors = ramps(&[(96, WOOD), (8, &[Stop::new(0, 0x202428), Stop::new(255, 0xb0b8c0)])]);
    Texture::square(7, colors, |x, up| {
        // Down from the top, where the light comes from.
        let y = 127 - up;
        let (from_right, from_bottom) = (127 - x, 127 - y);
        // A nail at both ends of each board of the frame.
        let nail = |v: i32| (v - 9).abs().min((v - 118).abs());
        let (nx, ny) = (nail(x), nail(y));
        if nx * nx + ny * ny <= 5 {
            let lit = if nx == 0 && ny == 0 { 6 } else { 3 };
            return entry(WOODS, 8, lit - i32::from(y > 64 && from_bottom < 9 || y < 64 && y > 9) * 2);
        }
        // Horizontal boards at top and bottom, over the uprights.
        if y < FRAME {
            return entry(0, WOODS, board(x, y, y, FRAME - 1 - y, 1));
        }
        if from_bottom < FRAME {
            let across = FRAME - 1 - from_bottom;
            return entry(0, WOODS, board(x, y, across, from_bottom, 2));
        }
        if x < FRAME || from_right < FRAME {
            let (across, number) = if x < FRAME { (x, 3) } else { (FRAME - 1 - from_right, 4) };
            return entry(0, WOODS, board(y, x, across, FRAME - 1 - across, number) - shadow(y - FRAME));
        }
        // The brace from the lower left to the upper right corner; `across` is its width, measured along x + y.
        let across = x + y - 127;
        if across.abs() <= 12 {
            let under = shadow(y - FRAME).max(shadow(x - FRAME));
            return entry(0, WOODS, board((x - y) & 127, across, across + 12, 12 - across, 5) - under);
        }
        // Upright planks behind it: 92 texels make five and a bit.
        let (plank, place) = ((x - FRAME) / 18, (x - FRAME) % 18);
        let deep = shadow(y - FRAME).max(shadow(x - FRAME)).max(if across > 0 { shadow(across - 13) } else { 0 });
        // At most five planks.
        entry(0, WOODS, board(y, x, place, 17 - place, 6 + plank as u32) - 14 - deep)
    })
}

/// The darkening at this distance, in texels, from an edge that casts a shadow.
fn shadow(distance: i32) -> i32 {
    (26 - 6 * distance).max(0)
}

fn checker() -> Texture {
    let mut colors = [Rgb::BLACK; 256];
    colors[0] = Rgb::from_u32(0x283038);
    colors[1] = Rgb::from_u32(0xf4f0e4);
    Texture::square(6, colors, |x, y| ((x ^ y) >> 3 & 1) as u8)
}

fn bricks() -> Texture {
    const BRICKS: i32 = 40;
    let red = [Stop::new(0, 0x2a0c08), Stop::new(128, 0x8c3a26), Stop::new(255, 0xe08c68)];
    let brown = [Stop::new(0, 0x24100a), Stop::new(128, 0x7c4028), Stop::new(255, 0xcf9a70)];
    let mortar = [Stop::new(0, 0x302c28), Stop::new(255, 0xb4aca0)];
    let colors = ramps(&[(40, &red), (40, &brown), (24, &mortar)]);
    Texture::square(7, colors, |x, up| {
        let y = 127 - up;
        let course = y >> 4;
        let shifted = (x + (course & 1) * 16) & 127;
        let (column, across, down) = (shifted >> 5, shifted & 31, y & 15);
        let grain = (noise(x, y, (1, 1), 21) - 128) / 24 + (hash(x, y, 22) - 128) / 40;
        // Two texels of mortar above and to the left of each brick.
        if across < 2 || down < 2 {
            let shade = if down == 0 || across == 0 && down > 1 { 8 } else { 13 };
            return entry(2 * BRICKS, 24, shade + grain / 2);
        }
        let kind = hash(column, course, 23);
        let bevel = match (across, down) {
            (_, 2) => 6,
            (2, _) => 4,
            (_, 15) => -9,
            (31, _) => -7,
            _ => 0,
        };
        let blotches = (noise(x, y, (3, 2), 24) - 128) / 22;
        entry(if kind & 3 == 0 { BRICKS } else { 0 }, BRICKS, 17 + kind % 9 - 4 + bevel + blotches + grain)
    })
}

/// A sphere map. The texel at (u, v) is the reflection in a mirror whose normal, in eye space, is n = (2u − 1, 2v − 1,
/// nz). The view ray is reflected to r = (2·nz·nx, 2·nz·ny, 2·nz² − 1): straight up half way from the centre to the
/// top. The horizon runs across the middle and all around the rim, beyond which it continues.
fn sky() -> Texture {
    const SKIES: i32 = 96;
    const GROUNDS: i32 = 64;
    /// 1.0; twice its square fits in 32 bits.
    const ONE: i32 = 1 << 14;
    let sky = [
        Stop::new(0, 0xfffcf0),
        Stop::new(40, 0xd8ecff),
        Stop::new(120, 0x7cb4f4),
        Stop::new(200, 0x2c68cc),
        Stop::new(255, 0x103c94),
    ];
    let ground = [Stop::new(0, 0x2c2214), Stop::new(60, 0x4c3a22), Stop::new(255, 0xa88a58)];
    let colors = ramps(&[(96, &sky), (64, &ground)]);
    Texture::square(7, colors, |x, y| {
        // The centre of a texel, −127/128 to 127/128.
        let (nx, ny) = ((2 * x - 127) * (ONE / 128), (2 * y - 127) * (ONE / 128));
        let nz = (ONE * ONE - nx * nx - ny * ny).max(0).isqrt();
        let times = |a: i32, b: i32| a * b / ONE;
        let [rx, ry, rz] = [2 * times(nz, nx), 2 * times(nz, ny), 2 * times(nz, nz) - ONE];
        if ny < 0 {
            return entry(SKIES, GROUNDS, -ry * (GROUNDS - 1) / ONE);
        }
        // The sun is at (−0.43, 0.55, 0.72); this is 1 − cos of the angle from it to the ray. Its glow ends at 28°,
        // where that is 0.117.
        let from_sun = ONE - (times(-7045, rx) + times(9011, ry) + times(11796, rz));
        let glow = from_sun.max(0) * 8 - ONE / 12;
        entry(0, SKIES, times(ry.min(glow), SKIES - 1))
    })
}
