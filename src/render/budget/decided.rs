//! Decisions of a budget on triangles.

use alloc::vec::Vec;

use crate::plan::{FaceCounts, FaceShading};
use crate::raster::effects::SampleSpacing;
use crate::render::sift;
use crate::scene::Shading;

/// Decision on a triangle.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Default)]
pub(in crate::render) enum Choice {
    /// Nobody has asked yet.
    #[default]
    Unknown,
    Flat,
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
    const ALL: [Self; 8] = [
        Self::Flat,
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
            Self::Flat => FaceShading::By(Shading::Flat),
            Self::Float => FaceShading::By(Shading::Float),
            Self::Curved => FaceShading::Quadratic,
            Self::PhongEvery(spacing) => FaceShading::PhongEvery(spacing),
            Self::Phong => FaceShading::By(Shading::Phong),
            Self::Linear | Self::Unknown => FaceShading::By(Shading::Gouraud88Reseeded),
        }
    }
}

impl Choice {
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
    bodies: Vec<Bodies>,
}

/// Distances of linear shades from the model, highlights aside, for the two sides of a triangle; not a number where it
/// is not known. They stay as long as the object and its lights are what they are, wherever the eye is.
pub(in crate::render) type Bodies = [f32; 2];

#[derive(Clone, Copy, Debug, Default)]
struct Chunk {
    /// A bit for each triangle that is known to be linear.
    linear: u64,
    /// True if its choices, and its bodies, were found since, and are not from before.
    has_choices: bool,
    has_bodies: bool,
}

impl Decided {
    /// Forgets all, for so many triangles.
    pub(in crate::render) fn nothing_of(&mut self, triangles: usize) {
        self.triangles = triangles;
        self.chunks.clear();
        self.chunks.resize(triangles.div_ceil(sift::MOST), Chunk::default());
        self.choices.resize(triangles, Choice::Unknown);
        self.bodies.resize(triangles, [f32::NAN; 2]);
    }

    /// Forgets what was chosen, but not what bodies are off by.
    pub(in crate::render) fn no_choices(&mut self) {
        for chunk in &mut self.chunks {
            (chunk.linear, chunk.has_choices) = (0, false);
        }
    }

    pub(in crate::render) fn clear(&mut self) {
        self.nothing_of(0);
    }

    /// The number of triangles.
    pub(in crate::render) fn triangles(&self) -> usize {
        self.triangles
    }

    /// Faces of a chunk that are known to be linear, a bit for each.
    #[inline]
    pub(in crate::render) fn linear(&mut self, chunk: usize) -> &mut u64 {
        &mut self.chunks[chunk].linear
    }

    /// The choices of a chunk's triangles that are not among these; nothing if none has been made.
    #[inline]
    pub(in crate::render) fn chosen(&self, chunk: usize) -> Option<&[Choice]> {
        let first = chunk * sift::MOST;
        self.chunks[chunk].has_choices.then(|| &self.choices[first..self.triangles.min(first + sift::MOST)])
    }

    /// A chunk's choices of triangles that are not known to be linear, to be added to, and what bodies are off by.
    #[inline]
    pub(in crate::render) fn of_chunk(&mut self, chunk: usize) -> (&mut [Choice], &mut [Bodies]) {
        let first = chunk * sift::MOST;
        let all = first..self.triangles.min(first + sift::MOST);
        let (choices, bodies) = (&mut self.choices[all.clone()], &mut self.bodies[all]);
        let chunk = &mut self.chunks[chunk];
        if !chunk.has_choices {
            chunk.has_choices = true;
            choices.fill(Choice::Unknown);
        }
        if !chunk.has_bodies {
            chunk.has_bodies = true;
            bodies.fill([f32::NAN; 2]);
        }
        (choices, bodies)
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
            + self.bodies.capacity() * size_of::<Bodies>()
    }
}
