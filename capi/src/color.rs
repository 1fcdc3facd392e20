//! Palettes of 768 bytes, tables of 64 KiB, and conversion for the screen.

use core::ffi::{CStr, c_char, c_int};

use mode13h::palette::{Palette, Rgb, builtin, gradient};

use crate::abi::{Outcome, Refusal, Target, code};
use crate::target::{Bytes, check};

/// The bytes of a palette: red, green and blue of 256 entries.
const PALETTE: usize = 768;
const TABLE: usize = 65_536;

/// Reads a palette of 8 bits per channel.
///
/// # Safety
/// `from` is null or holds 768 bytes.
unsafe fn palette(from: *const u8) -> Outcome<Palette> {
    Ok(Palette::from_colors(
        // SAFETY: by the caller.
        unsafe { colors(from) }?,
    ))
}

/// Reads the colours of a palette.
///
/// # Safety
/// `from` is null or holds 768 bytes.
unsafe fn colors(from: *const u8) -> Outcome<[Rgb; 256]> {
    Bytes::new(from, PALETTE)?;
    let mut colors = [Rgb::BLACK; 256];
    for (i, color) in colors.iter_mut().enumerate() {
        // SAFETY: below 768.
        let [r, g, b] = [0, 1, 2].map(|channel| unsafe { from.add(3 * i + channel).read() });
        *color = Rgb::new(r, g, b);
    }
    Ok(colors)
}

/// Writes the colours of a palette.
///
/// # Safety
/// `to` is null or has 768 bytes.
unsafe fn write(to: *mut u8, colors: &[Rgb; 256], of: impl Fn(Rgb) -> [u8; 3]) -> Outcome {
    Bytes::new(to, PALETTE)?;
    for (i, color) in colors.iter().enumerate() {
        for (channel, byte) in of(*color).into_iter().enumerate() {
            // SAFETY: below 768.
            unsafe { to.add(3 * i + channel).write(byte) };
        }
    }
    Ok(())
}

/// The colour `0xRRGGBB`. Shifts are used because compilers turn the engine's own method, big-endian bytes, into an
/// instruction that a 386 lacks.
fn color(rgb: u32) -> Rgb {
    Rgb::new((rgb >> 16) as u8, (rgb >> 8) as u8, rgb as u8)
}

fn bytes(Rgb { r, g, b }: Rgb) -> [u8; 3] {
    [r, g, b]
}

/// Names of the compiled-in palettes, as C strings.
const NAMES: [&CStr; 9] = [
    c"grey",
    c"silver",
    c"copper",
    c"phosphor",
    c"materials-4x64",
    c"materials-8x32",
    c"materials-16x16",
    c"cube",
    c"bios",
];

/// Names a compiled-in palette.
#[unsafe(no_mangle)]
pub extern "C" fn m13_palette_name(index: u32) -> *const c_char {
    NAMES.get(index as usize).map_or(core::ptr::null(), |name| name.as_ptr())
}

/// Copies a compiled-in palette.
///
/// # Safety
/// See the header.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn m13_palette_named(name: *const c_char, to: *mut u8) -> c_int {
    if name.is_null() || to.is_null() {
        return Refusal::Null as c_int;
    }
    // It stops at the first byte that differs, so it does not read beyond the zero.
    let is = |known: &&&CStr| {
        let mut bytes = known.to_bytes_with_nul().iter().enumerate();
        // SAFETY: bytes up to the first zero, by the caller.
        bytes.all(|(i, byte)| unsafe { name.cast::<u8>().add(i).read() } == *byte)
    };
    let found = NAMES.iter().find(is).and_then(|name| name.to_str().ok()).and_then(builtin::by_name);
    code(match found {
        // SAFETY: by the caller.
        Some(found) => unsafe { write(to, found.palette.colors(), bytes) },
        None => Err(Refusal::Name),
    })
}

/// Fills entries of a palette with a gradient from one colour to another.
///
/// # Safety
/// See the header.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn m13_palette_ramp(to: *mut u8, first: u32, entries: u32, from_rgb: u32, to_rgb: u32) -> c_int {
    let ramp =
        u8::try_from(first).ok().zip(u16::try_from(entries).ok()).and_then(|(f, n)| mode13h::palette::Ramp::new(f, n));
    // SAFETY: by the caller.
    code(unsafe { colors(to) }.and_then(|mut all| {
        let keys = [gradient::Stop { at: 0, color: color(from_rgb) }, gradient::Stop { at: 255, color: color(to_rgb) }];
        gradient::fill(&mut all, ramp.ok_or(Refusal::Value)?, &keys);
        // SAFETY: by the caller.
        unsafe { write(to, &all, bytes) }
    }))
}

/// The entry nearest to a colour, or a code below 0.
///
/// # Safety
/// See the header.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn m13_palette_nearest(from: *const u8, rgb: u32) -> c_int {
    // SAFETY: by the caller.
    match unsafe { palette(from) } {
        Ok(palette) => palette.nearest(color(rgb)).into(),
        Err(refusal) => refusal as c_int,
    }
}

/// A palette part of the way from one to another.
///
/// # Safety
/// See the header.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn m13_palette_fade(from: *const u8, other: *const u8, part: u32, to: *mut u8) -> c_int {
    // SAFETY: by the caller, as below.
    code(unsafe { colors(from).and_then(|from| Ok((from, colors(other)?))) }.and_then(|(mut all, other)| {
        let t = part.min(256);
        // At most 255·256, so the shifted sum is a byte.
        let mix = |a: u8, b: u8| ((u32::from(a) * (256 - t) + u32::from(b) * t) >> 8) as u8;
        for (a, b) in all.iter_mut().zip(other) {
            *a = Rgb::new(mix(a.r, b.r), mix(a.g, b.g), mix(a.b, b.b));
        }
        // SAFETY: as above.
        unsafe { write(to, &all, bytes) }
    }))
}

/// Rotates entries of a palette.
///
/// # Safety
/// See the header.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn m13_palette_cycle(to: *mut u8, first: u32, entries: u32, steps: i32) -> c_int {
    // SAFETY: by the caller, as below.
    code(unsafe { colors(to) }.and_then(|mut all| {
        let end = first.checked_add(entries).ok_or(Refusal::Value)?;
        let part = all.get_mut(first as usize..end as usize).ok_or(Refusal::Value)?;
        if !part.is_empty() {
            // At most 256.
            part.rotate_right(steps.rem_euclid(part.len() as i32) as usize);
        }
        // SAFETY: as above.
        unsafe { write(to, &all, bytes) }
    }))
}

/// Converts 8 bits per channel to the 6 of the DAC.
///
/// # Safety
/// See the header.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn m13_palette_to_dac(from: *const u8, to: *mut u8) -> c_int {
    // SAFETY: by the caller.
    code(unsafe { colors(from).and_then(|all| write(to, &all, Rgb::to_dac)) })
}

/// Converts the 6 bits of the DAC to 8.
///
/// # Safety
/// See the header.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn m13_palette_from_dac(from: *const u8, to: *mut u8) -> c_int {
    // SAFETY: by the caller.
    code(unsafe { colors(from).and_then(|all| write(to, &all, |six| bytes(Rgb::from_dac(bytes(six))))) })
}

/// A search for the nearest of 256 colours: it goes up and down from the one with the nearest green, until no other can
/// be nearer.
struct Search {
    colors: [Rgb; 256],
    /// Entries by green, then by index, and the first entry of each green.
    order: [u8; 256],
    first: [u16; 257],
}

impl Search {
    fn new(colors: [Rgb; 256]) -> Self {
        let (mut order, mut first) = ([0; 256], [0; 257]);
        let mut at = 0_u16;
        for green in 0..=255 {
            first[usize::from(green)] = at;
            for index in 0..=255_u8 {
                if colors[usize::from(index)].g == green {
                    // Below 256: each entry has one green.
                    order[usize::from(at & 255)] = index;
                    at += 1;
                }
            }
        }
        first[256] = at;
        Self { colors, order, first }
    }

    /// The nearest entry, like `Palette::nearest`: the first if several are equally near.
    fn nearest(&self, color: Rgb) -> u8 {
        let mut best = u32::MAX;
        // Returns whether entries farther in this direction can be as near.
        let mut look = |at: u16| {
            let index = self.order[usize::from(at & 255)];
            let other = self.colors[usize::from(index)];
            let green = u32::from(other.g.abs_diff(color.g)).pow(2);
            best = best.min(other.distance_squared(color) << 8 | u32::from(index));
            green <= best >> 8
        };
        let middle = self.first[usize::from(color.g)];
        (middle..256).all(&mut look);
        (0..middle).rev().all(look);
        (best & 255) as u8
    }
}

/// Fills a table with the byte that `byte` returns for each row and column.
///
/// # Safety
/// `table` is null or has 64 KiB.
unsafe fn fill(table: *mut u8, mut byte: impl FnMut(u8, u8) -> u8) -> Outcome {
    Bytes::new(table, TABLE)?;
    for row in 0..=255 {
        for column in 0..=255 {
            // SAFETY: below 65,536.
            unsafe { table.add(usize::from(row) << 8 | usize::from(column)).write(byte(row, column)) };
        }
    }
    Ok(())
}

/// A palette as given, the palette as the card shows it, and a search in the latter.
///
/// # Safety
/// `from` is null or holds 768 bytes.
unsafe fn searched(from: *const u8) -> Outcome<(Palette, Palette, Search)> {
    // SAFETY: by the caller.
    let palette = unsafe { palette(from) }?;
    let shown = palette.on_dac();
    let search = Search::new(*shown.colors());
    Ok((palette, shown, search))
}

/// Makes a table of shaded texels.
///
/// # Safety
/// See the header.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn m13_table_shades(from: *const u8, texels: *const u8, table: *mut u8) -> c_int {
    // SAFETY: by the caller, as below.
    code(unsafe { searched(from) }.and_then(|(palette, _, search)| {
        // SAFETY: as above.
        let colors = if texels.is_null() { *palette.colors() } else { unsafe { colors(texels) }? };
        let byte = |shade: u8, texel: u8| match colors[usize::from(texel)] {
            color if shade == 255 && color == palette[texel] => texel,
            color => search.nearest(Rgb::BLACK.mix(color, shade)),
        };
        // SAFETY: as above.
        unsafe { fill(table, byte) }
    }))
}

/// Makes a fog table.
///
/// # Safety
/// See the header.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn m13_table_fog(from: *const u8, rgb: u32, table: *mut u8) -> c_int {
    // SAFETY: by the caller, as below.
    code(unsafe { searched(from) }.and_then(|(_, shown, search)| {
        let byte = |level: u8, byte: u8| match level {
            0 => byte,
            _ => search.nearest(shown[byte].mix(color(rgb), level)),
        };
        // SAFETY: as above.
        unsafe { fill(table, byte) }
    }))
}

/// Makes a table for glass.
///
/// # Safety
/// See the header.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn m13_table_blend(from: *const u8, opacity: u8, table: *mut u8) -> c_int {
    // SAFETY: by the caller, as below.
    code(unsafe { searched(from) }.and_then(|(_, shown, search)| {
        let byte = |new: u8, old: u8| match opacity {
            255 => new,
            0 => old,
            _ if new == old => new,
            _ => search.nearest(shown[old].mix(shown[new], opacity)),
        };
        // SAFETY: as above.
        unsafe { fill(table, byte) }
    }))
}

/// Makes a table of sums.
///
/// # Safety
/// See the header.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn m13_table_add(from: *const u8, table: *mut u8) -> c_int {
    // SAFETY: by the caller, as below.
    code(unsafe { searched(from) }.and_then(|(_, shown, search)| {
        let byte = |new: u8, old: u8| match (shown[new], shown[old]) {
            (Rgb::BLACK, _) => old,
            (_, Rgb::BLACK) => new,
            (new, old) => search.nearest(new.saturating_add(old)),
        };
        // SAFETY: as above.
        unsafe { fill(table, byte) }
    }))
}

/// Writes pixels in the colours that the card shows, each as a `PIXEL`.
///
/// # Safety
/// Pointers are null or as in the header.
unsafe fn show<PIXEL: Copy + Default>(
    target: *const Target,
    from: *const u8,
    out: *mut PIXEL,
    bytes: usize,
    pitch: usize,
    pixel: impl Fn(Rgb) -> PIXEL,
) -> Outcome {
    // SAFETY: by the caller, as below.
    let (checked, palette) = unsafe { (check(target)?, palette(from)?.on_dac()) };
    let whole = Bytes::new(out, bytes)?;
    checked.apart_from(whole)?;
    let (width, rows) = (checked.frame.width() as usize, checked.frame.rows());
    if pitch / size_of::<PIXEL>() < width {
        return Err(Refusal::Pitch);
    }
    let needed = pitch.saturating_mul((rows.end - rows.start - 1) as usize).saturating_add(width * size_of::<PIXEL>());
    if bytes < needed {
        return Err(Refusal::Short);
    }
    let mut pixels = [PIXEL::default(); 256];
    for (pixel_of, color) in pixels.iter_mut().zip(palette.colors()) {
        *pixel_of = pixel(*color);
    }
    for (i, y) in rows.enumerate() {
        for (x, index) in checked.frame.row(y).unwrap_or_default().iter().enumerate() {
            // SAFETY: the offset is below the number of bytes that are needed. Rows may begin anywhere.
            unsafe {
                out.cast::<u8>().add(i * pitch).cast::<PIXEL>().add(x).write_unaligned(pixels[usize::from(*index)]);
            }
        }
    }
    Ok(())
}

/// Shows a frame as `0x00RRGGBB`.
///
/// # Safety
/// See the header.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn m13_show_32(
    target: *const Target,
    from: *const u8,
    out: *mut u32,
    bytes: usize,
    pitch: usize,
) -> c_int {
    // SAFETY: by the caller.
    code(unsafe {
        show(target, from, out, bytes, pitch, |Rgb { r, g, b }| u32::from(r) << 16 | u32::from(g) << 8 | u32::from(b))
    })
}

/// Shows a frame as 5, 6 and 5 bits.
///
/// # Safety
/// See the header.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn m13_show_16(
    target: *const Target,
    from: *const u8,
    out: *mut u16,
    bytes: usize,
    pitch: usize,
) -> c_int {
    // SAFETY: by the caller.
    code(unsafe { show(target, from, out, bytes, pitch, Rgb::to_rgb565) })
}
