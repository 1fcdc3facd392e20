//! One half of a picture: a small frame, what was drawn into it, and which of its pixels are wrong.

/// Mark for the fault of a pixel.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug)]
#[non_exhaustive]
pub enum Mark {
    /// The pixel belongs to a face but was not drawn.
    LeftOut,
    /// More faces drew the pixel than own it.
    Twice,
    /// The pixel belongs to no face but was drawn.
    Outside,
    /// The pixel has the wrong byte.
    Shade,
    /// The pixel shows a face other than the one in front.
    Face,
}

impl Mark {
    /// All of them, in the order of a legend.
    pub const ALL: [Self; 5] = [Self::LeftOut, Self::Twice, Self::Outside, Self::Shade, Self::Face];

    /// Name in words.
    #[must_use]
    pub const fn words(self) -> &'static str {
        match self {
            Self::LeftOut => "left out",
            Self::Twice => "drawn twice",
            Self::Outside => "drawn outside",
            Self::Shade => "wrong shade",
            Self::Face => "wrong face",
        }
    }
}

/// A frame of at most a few dozen pixels a side, row-major, with the number of writes to each pixel.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct Panel {
    width: usize,
    height: usize,
    pixels: Vec<u8>,
    writes: Vec<u8>,
    marks: Vec<Option<Mark>>,
    /// Whether faces were drawn one by one, so that `writes` counts all that drew a pixel.
    pub(super) is_counted: bool,
}

/// How to compare a panel with what it should be.
#[derive(Clone, Copy)]
pub(super) struct Measure {
    /// Bytes may be this many shades off before they are marked.
    pub(super) shades: u8,
    /// True to count how many faces drew a pixel, which means nothing where faces hide each other.
    pub(super) counts_writes: bool,
    /// Mark for a byte that is further off.
    pub(super) other_byte: Mark,
}

impl Panel {
    pub(super) fn new((width, height): (usize, usize)) -> Self {
        let all = width * height;
        Self { width, height, pixels: vec![0; all], writes: vec![0; all], marks: vec![None; all], is_counted: false }
    }

    /// Number of columns.
    #[must_use]
    pub fn width(&self) -> usize {
        self.width
    }

    /// Number of rows.
    #[must_use]
    pub fn height(&self) -> usize {
        self.height
    }

    /// The bytes, row by row; 0 where nothing was drawn.
    #[must_use]
    pub fn pixels(&self) -> &[u8] {
        &self.pixels
    }

    /// Number of times each pixel was drawn.
    #[must_use]
    pub fn writes(&self) -> &[u8] {
        &self.writes
    }

    /// The fault of each pixel, if any.
    #[must_use]
    pub fn marks(&self) -> &[Option<Mark>] {
        &self.marks
    }

    /// Counts the pixels with this mark.
    #[must_use]
    pub fn count(&self, mark: Mark) -> usize {
        self.marks.iter().filter(|there| **there == Some(mark)).count()
    }

    /// The byte at a pixel; `None` where nothing was drawn.
    pub(super) fn get(&self, x: usize, y: usize) -> Option<u8> {
        let at = y * self.width + x;
        self.writes.get(at).filter(|writes| x < self.width && **writes > 0).map(|_| self.pixels[at])
    }

    /// Draws a pixel; does nothing outside the frame.
    pub(super) fn write(&mut self, x: i32, y: i32, byte: u8) {
        let (Ok(x), Ok(y)) = (usize::try_from(x), usize::try_from(y)) else { return };
        if x < self.width && y < self.height {
            let at = y * self.width + x;
            self.pixels[at] = byte;
            self.writes[at] = self.writes[at].saturating_add(1);
        }
    }

    /// Marks what differs from `reference`, which has the same size.
    pub(super) fn mark_against(&mut self, reference: &Self, measure: Measure) {
        for (at, mark) in self.marks.iter_mut().enumerate() {
            let (writes, due) = (self.writes[at], reference.writes[at]);
            let off = self.pixels[at].abs_diff(reference.pixels[at]);
            *mark = match (writes, due) {
                (0, 0) => None,
                (0, _) => Some(Mark::LeftOut),
                (_, 0) => Some(Mark::Outside),
                _ if measure.counts_writes && writes > due => Some(Mark::Twice),
                _ if off > measure.shades => Some(measure.other_byte),
                _ => None,
            };
        }
    }
}
