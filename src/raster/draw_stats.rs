//! Counts of what was drawn.

/// Drawing statistics, of one triangle or summed.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug, Default)]
#[non_exhaustive]
pub struct DrawStats {
    /// Spans handed to a pixel loop; reseeded pieces of a row count separately.
    pub spans: u32,
    /// Pixels covered inside the clip rectangle.
    pub covered: u32,
    /// Pixels written: the covered ones, minus those hidden by the depth buffer.
    pub pixels: u32,
    /// Pixels whose depth was compared with the depth buffer's.
    pub tested: u32,
    /// Pixels that got a texel.
    pub textured: u32,
    /// Pixels whose mipmap level was chosen, including those that got level 0.
    pub mipmapped: u32,
    /// Pixels that got a threshold of the dither pattern.
    pub dithered: u32,
    /// Pixels looked up in a fog table.
    pub fogged: u32,
    /// Pixels blended with the frame through a table.
    pub blended: u32,
    /// Pixels mixed from three channels.
    pub mixed: u32,
    /// Pixels that were lit individually.
    pub lit: u32,
}

impl DrawStats {
    /// The counts of spans that have been drawn: how many, the pixels covered, and those that were nearer.
    pub(super) fn of_spans((spans, covered, nearer): (u32, u32, u32), has_depths: bool) -> Self {
        let (pixels, tested) = if has_depths { (nearer, covered) } else { (covered, 0) };
        Self { spans, covered, pixels, tested, ..Self::default() }
    }
}

impl core::ops::AddAssign for DrawStats {
    /// Counts wrap at 2³²; a frame of 4,096 × 4,096 would have to be filled 256 times over.
    fn add_assign(&mut self, other: Self) {
        let add = |count: &mut u32, more: u32| *count = count.wrapping_add(more);
        add(&mut self.spans, other.spans);
        add(&mut self.covered, other.covered);
        add(&mut self.pixels, other.pixels);
        add(&mut self.tested, other.tested);
        add(&mut self.textured, other.textured);
        add(&mut self.mipmapped, other.mipmapped);
        add(&mut self.dithered, other.dithered);
        add(&mut self.fogged, other.fogged);
        add(&mut self.blended, other.blended);
        add(&mut self.mixed, other.mixed);
        add(&mut self.lit, other.lit);
    }
}
