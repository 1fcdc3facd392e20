//! Decisions of a budget on triangles.

use alloc::vec::Vec;

use crate::lanes::LANES;
use crate::plan::{FaceCounts, FaceShading};
use crate::raster::effects::SampleSpacing;
use crate::render::cull;
use crate::scene::Shading;

/// Decision on a triangle.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Default)]
pub(in crate::render) enum Choice {
    /// Nobody has asked yet.
    #[default]
    Unknown,
    Linear,
    Float,
    /// Quadratic on the screen, through light at six points.
    Curved,
    /// Light at pixels of a row that lie apart, linear between.
    PhongEvery(SampleSpacing),
    Phong,
}

impl Choice {
    /// Choices that draw something, from cheap to exact.
    const ALL: [Self; 7] = [
        Self::Linear,
        Self::Float,
        Self::Curved,
        Self::PhongEvery(SampleSpacing::Sixteen),
        Self::PhongEvery(SampleSpacing::Eight),
        Self::PhongEvery(SampleSpacing::Four),
        Self::Phong,
    ];

    pub(in crate::render) const fn shading(self) -> FaceShading {
        match self {
            Self::Float => FaceShading::By(Shading::Float),
            Self::Curved => FaceShading::Quadratic,
            Self::PhongEvery(spacing) => FaceShading::PhongEvery(spacing),
            Self::Phong => FaceShading::By(Shading::Phong),
            Self::Linear | Self::Unknown => FaceShading::By(Shading::Gouraud88Reseeded),
        }
    }

    /// Returns whether its pixels need light beyond that of the corners.
    pub(in crate::render) fn needs_light(self) -> bool {
        matches!(self, Self::Phong | Self::PhongEvery(_) | Self::Curved)
    }
}

/// Decisions on an object's triangles. Forgotten ones are overwritten when they are asked for: most chunks are linear
/// at once, and nobody asks.
#[derive(Clone, Debug, Default)]
pub(in crate::render) struct Decided {
    triangles: usize,
    /// One for as many triangles as are culled at a time.
    chunks: Vec<Chunk>,
    choices: Vec<Choice>,
    /// For each level of the tree, and eight siblings of it, which of them are linear: fronts, and backs.
    nodes: Vec<Vec<[Option<u8>; 2]>>,
}

#[derive(Clone, Copy, Debug, Default)]
struct Chunk {
    /// A bit for each triangle that is known to be linear.
    linear: u64,
    /// True if its choices were made since, and are not from before.
    has_choices: bool,
}

impl Decided {
    /// Forgets all, for so many triangles.
    pub(in crate::render) fn forget(&mut self, triangles: usize) {
        self.triangles = triangles;
        self.chunks.clear();
        self.chunks.resize(triangles.div_ceil(cull::CHUNK), Chunk::default());
        self.choices.resize(triangles, Choice::Unknown);
        let mut groups = triangles;
        for level in 0.. {
            groups = groups.div_ceil(if level == 0 { LANES * LANES } else { LANES });
            if self.nodes.len() == level {
                self.nodes.push(Vec::new());
            }
            self.nodes[level].clear();
            self.nodes[level].resize(groups, [None; 2]);
            if groups <= 1 {
                return;
            }
        }
    }

    pub(in crate::render) fn clear(&mut self) {
        self.forget(0);
    }

    /// Linear ones among eight sibling nodes of a level, if that is known.
    #[inline]
    pub(super) fn nodes(&mut self, (level, group): (usize, usize), back: bool) -> &mut Option<u8> {
        &mut self.nodes[level][group][usize::from(back)]
    }

    /// Faces of a chunk that are known to be linear, a bit for each.
    #[inline]
    pub(in crate::render) fn linear(&mut self, chunk: usize) -> &mut u64 {
        &mut self.chunks[chunk].linear
    }

    /// The choices of a chunk's triangles that are not among these; nothing if none has been made.
    #[inline]
    pub(in crate::render) fn chosen(&self, chunk: usize) -> Option<&[Choice]> {
        let first = chunk * cull::CHUNK;
        self.chunks[chunk].has_choices.then(|| &self.choices[first..self.triangles.min(first + cull::CHUNK)])
    }

    /// A chunk's choices of triangles that are not known to be linear, to be added to.
    #[inline]
    pub(in crate::render) fn of_chunk(&mut self, chunk: usize) -> &mut [Choice] {
        let first = chunk * cull::CHUNK;
        let choices = &mut self.choices[first..self.triangles.min(first + cull::CHUNK)];
        let chunk = &mut self.chunks[chunk];
        if !chunk.has_choices {
            chunk.has_choices = true;
            choices.fill(Choice::Unknown);
        }
        choices
    }

    /// Counts the triangles that have been drawn by this choice.
    fn count(&self, choice: Choice) -> usize {
        let of_chunk = |chunk: usize| {
            let linear = self.chunks[chunk].linear;
            let others = self.chosen(chunk).unwrap_or_default().iter().enumerate();
            let others = others.filter(|(at, of)| linear >> at & 1 == 0 && **of == choice).count();
            others + if choice == Choice::Linear { linear.count_ones() as usize } else { 0 }
        };
        (0..self.chunks.len()).map(of_chunk).sum()
    }

    /// Counts the triangles by the way in which they were shaded.
    pub(in crate::render) fn counts(&self) -> FaceCounts {
        let drawn = Choice::ALL.map(|choice| (choice.shading(), self.count(choice)));
        let drawn: Vec<(FaceShading, usize)> = drawn.into_iter().filter(|(_, count)| *count > 0).collect();
        let not_drawn = self.triangles - drawn.iter().map(|(_, count)| count).sum::<usize>();
        FaceCounts { drawn, not_drawn }
    }

    /// Bytes that it holds.
    pub(in crate::render) fn bytes(&self) -> usize {
        self.chunks.capacity() * size_of::<Chunk>()
            + self.choices.capacity() * size_of::<Choice>()
            + self.nodes.iter().map(|level| level.capacity() * size_of::<[Option<u8>; 2]>()).sum::<usize>()
    }
}
