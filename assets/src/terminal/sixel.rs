//! DEC sixel: bands of six rows, and in each a pass for every colour.
//!
//! ```text
//! ESC P 7 ; 0 ; 0 q        pixels are as wide as high; all are drawn, so what is not is background
//! " 1 ; 1 ; w ; h          the same, and the size
//! # n ; 2 ; r ; g ; b      colour n: red, green and blue in percent
//! # n                      the pass of colour n begins
//! c                        a column: 63 + the sum of 2ⁱ over the rows i that have the colour
//! ! k c                    k times that column
//! $                        back to the left edge; the next pass
//! -                        the next band
//! ESC \                    the end
//! ```
//!
//! Colour n is entry n of the palette, and only those that the picture uses are defined. Percentages are rounded to the
//! nearest, so channels are off by at most half of 2.55, and the DAC's 64 levels stay distinct.
//!
//! Source: *VT330/VT340 Programmer Reference Manual, Volume 2: Graphics Programming* (DEC, 1988), chapter 14.

use std::fmt::{self, Write};

use mode13h::export::{Picture, PictureError, Scale, Scaled};

/// Rows of a band.
const BAND: usize = 6;

/// Number of repeated columns from which a count is shorter.
const WORTH_COUNTING: usize = 4;

/// A picture at the cursor.
pub(super) fn picture(picture: &Picture<'_>, scale: Scale) -> Result<String, PictureError> {
    let scaled = Scaled::new(picture, scale)?;
    let width = scaled.width as usize;
    let mut text = String::new();
    // Writing to a string cannot fail.
    let _ = write(&mut text, picture, &scaled, width);
    Ok(text)
}

fn write(text: &mut String, picture: &Picture<'_>, scaled: &Scaled<'_>, width: usize) -> fmt::Result {
    write!(text, "\x1bP7;0;0q\"1;1;{};{}", scaled.width, scaled.height)?;
    // Scaling adds no colours, and may drop some when it shrinks the picture: these are then defined but not used.
    let mut used = [false; 256];
    for y in 0..picture.height {
        picture.row(y).iter().for_each(|&index| used[usize::from(index)] = true);
    }
    for (index, color) in picture.palette.iter().enumerate().filter(|(index, _)| used[*index]) {
        let [r, g, b] = [color.r, color.g, color.b].map(percent);
        write!(text, "#{index};2;{r};{g};{b}")?;
    }
    let mut band = Band::new(width);
    for (y, row) in scaled.rows().enumerate() {
        if y > 0 && y.is_multiple_of(BAND) {
            band.write(text)?;
            // None after the last, so that the cursor stays in the picture's last line.
            text.push('-');
            band.clear();
        }
        band.add(y % BAND, &row);
    }
    band.write(text)?;
    text.push_str("\x1b\\");
    Ok(())
}

/// A channel in percent, rounded to the nearest.
fn percent(channel: u8) -> u16 {
    (200 * u16::from(channel) + 255) / 510
}

/// Six rows, colour by colour.
struct Band {
    width: usize,
    /// The columns of each colour, one bit a row: those of colour n from `n * width` on.
    columns: Vec<u8>,
    /// The first and the last column that each colour is in, if it is in the band.
    reach: [Option<(usize, usize)>; 256],
}

impl Band {
    fn new(width: usize) -> Band {
        Band { width, columns: vec![0; 256 * width], reach: [None; 256] }
    }

    fn clear(&mut self) {
        for (reach, columns) in self.reach.iter_mut().zip(self.columns.chunks_exact_mut(self.width)) {
            if let Some((first, last)) = reach.take() {
                columns[first..=last].fill(0);
            }
        }
    }

    /// Adds row `i` of the six.
    fn add(&mut self, i: usize, row: &[u8]) {
        for (x, &index) in row.iter().enumerate() {
            let index = usize::from(index);
            self.columns[index * self.width + x] |= 1 << i;
            let (first, last) = self.reach[index].get_or_insert((x, x));
            (*first, *last) = (x.min(*first), x.max(*last));
        }
    }

    /// Writes the passes. Colours whose columns do not overlap share one.
    fn write(&self, text: &mut String) -> fmt::Result {
        let mut left: Vec<(usize, usize, usize)> = self
            .reach
            .iter()
            .enumerate()
            .filter_map(|(n, reach)| reach.map(|(first, last)| (first, last, n)))
            .collect();
        left.sort_unstable();
        let mut is_first = true;
        while !left.is_empty() {
            if !is_first {
                text.push('$');
            }
            is_first = false;
            // The column at which the pass is.
            let mut at = 0;
            let mut result = Ok(());
            left.retain(|&(first, last, index)| {
                let follows = first >= at && result.is_ok();
                if follows {
                    result = self.write_color(text, index, at, (first, last));
                    at = last + 1;
                }
                !follows
            });
            result?;
        }
        Ok(())
    }

    /// Writes the columns of a colour from the position of the pass to its last one.
    fn write_color(&self, text: &mut String, index: usize, at: usize, (first, last): (usize, usize)) -> fmt::Result {
        write!(text, "#{index}")?;
        repeat(text, 0, first - at)?;
        let columns = &self.columns[index * self.width..][first..=last];
        columns.chunk_by(|a, b| a == b).try_for_each(|same| repeat(text, same[0], same.len()))
    }
}

/// Writes the same column several times.
fn repeat(text: &mut String, column: u8, times: usize) -> fmt::Result {
    // 63 + at most 63.
    let letter = char::from(b'?' + column);
    if times >= WORTH_COUNTING {
        return write!(text, "!{times}{letter}");
    }
    text.extend(std::iter::repeat_n(letter, times));
    Ok(())
}
