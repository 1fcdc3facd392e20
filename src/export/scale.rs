//! Enlargement for programs that only show square pixels.

use std::fmt;
use std::ops::Range;
use std::str::FromStr;

use super::picture::source;
use super::{MAX_SIDE, Picture, PictureError, PixelShape};

/// The enlargement of an exported picture. Each pixel of the result is one pixel of the frame, never a mixture, so an
/// indexed picture stays indexed.
#[derive(Clone, Copy, Hash, Debug, Default, PartialEq, Eq)]
#[non_exhaustive]
pub enum Scale {
    /// No enlargement: a 320 × 200 frame stays 320 × 200.
    #[default]
    One,
    /// Every pixel 2 × 2, as the VGA scans every row twice: 640 × 400.
    Double,
    /// Every pixel 5 wide and 6 high: 1600 × 1200, exactly 4:3 in square pixels.
    FiveBySix,
    /// Stretched to this size; each pixel is the frame's pixel that contains its centre.
    To {
        /// The number of pixels in a row, 1 to [`MAX_SIDE`].
        width: u16,
        /// The number of rows, 1 to [`MAX_SIDE`].
        height: u16,
    },
}

impl Scale {
    /// The exported size of a picture of `width` × `height` pixels.
    pub fn size(self, width: usize, height: usize) -> (usize, usize) {
        match self {
            Scale::One => (width, height),
            Scale::Double => (width.saturating_mul(2), height.saturating_mul(2)),
            Scale::FiveBySix => (width.saturating_mul(5), height.saturating_mul(6)),
            Scale::To { width, height } => (width.into(), height.into()),
        }
    }
}

/// Parses `1`, `2`, `5x6`, or a width and a height such as `640x480`. A size of 5 by 6 always means
/// [`Scale::FiveBySix`].
impl FromStr for Scale {
    type Err = PictureError;

    fn from_str(words: &str) -> Result<Scale, PictureError> {
        match words {
            "1" => Ok(Scale::One),
            "2" => Ok(Scale::Double),
            _ => {
                let side = |digits: &str| match digits.parse::<u16>() {
                    Ok(side) if (1..=MAX_SIDE).contains(&side) && !digits.starts_with('+') => Ok(side),
                    _ => Err(PictureError::Scale),
                };
                let (width, height) = words.split_once('x').ok_or(PictureError::Scale)?;
                // Also with leading zeros.
                match (side(width)?, side(height)?) {
                    (5, 6) => Ok(Scale::FiveBySix),
                    (width, height) => Ok(Scale::To { width, height }),
                }
            }
        }
    }
}

impl fmt::Display for Scale {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Scale::One => f.write_str("1"),
            Scale::Double => f.write_str("2"),
            Scale::FiveBySix => f.write_str("5x6"),
            Scale::To { width, height } => write!(f, "{width}x{height}"),
        }
    }
}

/// A picture and its exported size, with the source of each pixel of the result.
pub struct Scaled<'a> {
    picture: Picture<'a>,
    /// The width of the result, in pixels.
    pub width: u32,
    /// The height of the result, in pixels.
    pub height: u32,
    /// The frame's column for each column of the result.
    columns: Vec<usize>,
    /// The frame's row for each row of the result.
    rows: Vec<usize>,
}

impl<'a> Scaled<'a> {
    /// Enlarges a picture.
    ///
    /// # Errors
    /// A picture that is not valid; a side of more than [`MAX_SIDE`] pixels.
    pub fn new(picture: &Picture<'a>, scale: Scale) -> Result<Scaled<'a>, PictureError> {
        picture.check()?;
        let (width, height) = scale.size(picture.width, picture.height);
        let too_large = PictureError::Size { width, height };
        let limit = 1..=u32::from(MAX_SIDE);
        match (u32::try_from(width), u32::try_from(height)) {
            (Ok(w), Ok(h)) if limit.contains(&w) && limit.contains(&h) => {
                let columns = (0..width).map(|x| source(x, width, picture.width)).collect();
                let rows = (0..height).map(|y| source(y, height, picture.height)).collect();
                Ok(Scaled { picture: *picture, width: w, height: h, columns, rows })
            }
            _ => Err(too_large),
        }
    }

    /// The palette indices of each row of the result, from the top.
    pub fn rows(&self) -> impl Iterator<Item = Vec<u8>> + '_ {
        self.rows.iter().map(|&y| {
            let row = self.picture.row(y);
            self.columns.iter().map(|&x| row[x]).collect()
        })
    }

    /// The palette indices of a part of the result, row by row.
    ///
    /// # Errors
    /// A part that is not within the result; not enough memory.
    pub fn part(&self, columns: Range<usize>, rows: Range<usize>) -> Result<Vec<u8>, PictureError> {
        let (Some(columns), Some(rows)) = (self.columns.get(columns), self.rows.get(rows)) else {
            return Err(PictureError::Part { width: self.width as usize, height: self.height as usize });
        };
        let bytes = columns.len() * rows.len();
        let mut part = Vec::new();
        part.try_reserve_exact(bytes).map_err(|_| PictureError::Memory { bytes })?;
        for &y in rows {
            let row = self.picture.row(y);
            part.extend(columns.iter().map(|&x| row[x]));
        }
        Ok(part)
    }

    /// The picture itself, and the source column and row of each column and row of the result.
    pub fn sources(&self) -> (&Picture<'a>, &[usize], &[usize]) {
        (&self.picture, &self.columns, &self.rows)
    }

    /// Pixels per unit of length, across and down, in lowest terms, for `pHYs`. The picture keeps its aspect ratio at
    /// any size: for 320 × 200 pixels of shape 5:6 the density is 6 across to 5 down, and the pixels of 1600 × 1200 are
    /// square.
    pub fn density(&self) -> (u32, u32) {
        let PixelShape { width: across, height: down } = self.picture.shape;
        let x = u64::from(self.width) * u64::from(down) * self.picture.height as u64;
        let y = u64::from(self.height) * u64::from(across) * self.picture.width as u64;
        let common = greatest_common_divisor(x, y).max(1);
        let (mut x, mut y) = (x / common, y / common);
        // PNG integers end at 2^31 − 1. Unusual shapes and sizes may need more; the ratio is then
        // rounded.
        const END: u64 = (1 << 31) - 1;
        while x > END || y > END {
            (x, y) = (x.div_ceil(2), y.div_ceil(2));
        }
        // Both fit: the loop has ended.
        (x as u32, y as u32)
    }
}

fn greatest_common_divisor(mut a: u64, mut b: u64) -> u64 {
    while b != 0 {
        (a, b) = (b, a % b);
    }
    a
}
