//! Statistics of a frame: counts of the work that drawing it took.

use core::iter::Flatten;
use core::ops::Index;
use core::{array, fmt};

use crate::plan::FaceShading;
use crate::raster::DrawStats;
use crate::settings::{Accuracy, HiddenSurfaces, Settings, Shading, VertexPath};
use crate::span::Kernel;

/// The work of one frame.
#[derive(Clone, Copy, PartialEq, Debug)]
#[non_exhaustive]
pub struct Stats {
    /// The shading; with an error budget, the default one.
    pub shading: Shading,
    /// The accepted error in shades, if there is an error budget.
    pub max_error: Option<f32>,
    /// The path from mesh to vertices.
    pub vertex_path: VertexPath,
    /// The name of the span kernel that drew.
    pub kernel: &'static str,
    /// The hidden-surface method.
    pub hidden_surfaces: HiddenSurfaces,
    /// True if anything was drawn: if nothing changed, the last frame is left as it is.
    pub redrawn: bool,
    /// Objects whose vertices were reused from the last frame.
    pub kept: u64,
    /// Objects drawn within an error budget, which decided how to draw each face.
    pub decided: u64,
    /// Vertices transformed.
    pub vertices: u64,
    /// Vertices lit; with flat shading, faces, except those already found to cover no pixel.
    pub lit: u64,
    /// Faces of all objects.
    pub faces: u64,
    /// Faces cut by the near plane or the guard band, or entirely beyond them.
    pub clipped: u64,
    /// Back faces, and faces without area after clipping and rounding.
    pub culled: u64,
    /// Triangles passed to the raster: faces, and the parts of clipped ones.
    pub drawn: u64,
    /// The number of triangles by shading.
    pub shares: Shares,
    /// Counts of the raster.
    pub raster: DrawStats,
}

/// Counts of triangles by their shading.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Default)]
pub struct Shares([u64; FaceShading::ALL.len()]);

impl Shares {
    /// Counts more triangles.
    pub(super) fn add(&mut self, shading: FaceShading, triangles: u64) {
        self.0[shading.index()] += triangles;
    }
}

/// The number of triangles with a shading.
impl<S: Into<FaceShading>> Index<S> for Shares {
    type Output = u64;

    fn index(&self, shading: S) -> &u64 {
        &self.0[shading.into().index()]
    }
}

/// Each shading that was used, from cheap to exact, with its number of triangles.
impl IntoIterator for Shares {
    type Item = (FaceShading, u64);
    type IntoIter = Flatten<array::IntoIter<Option<Self::Item>, { FaceShading::ALL.len() }>>;

    fn into_iter(self) -> Self::IntoIter {
        let counted = |shading: FaceShading| (shading, self[shading]);
        FaceShading::ALL
            .map(|shading| Some(counted(shading)).filter(|(_, triangles)| *triangles > 0))
            .into_iter()
            .flatten()
    }
}

impl Stats {
    pub(super) fn new(settings: &Settings, kernel: Kernel, hidden_surfaces: HiddenSurfaces) -> Self {
        let accuracy = settings.drawn_accuracy();
        Self {
            shading: accuracy.shading(),
            max_error: accuracy.max_error(),
            vertex_path: settings.vertex_path.unwrap_or_default(),
            kernel: kernel.name(),
            hidden_surfaces,
            redrawn: true,
            kept: 0,
            decided: 0,
            vertices: 0,
            lit: 0,
            faces: 0,
            clipped: 0,
            culled: 0,
            drawn: 0,
            shares: Shares::default(),
            raster: DrawStats::default(),
        }
    }
}

impl fmt::Display for Stats {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { shading, max_error, vertex_path, kernel, hidden_surfaces, redrawn, kept, .. } = self;
        let Self { vertices, lit, faces, clipped, culled, drawn, raster, .. } = self;
        let accuracy = max_error.map_or(Accuracy::Shading(*shading), Accuracy::WithinError);
        write!(f, "{accuracy}")?;
        if max_error.is_some() {
            for (i, (shading, triangles)) in self.shares.into_iter().enumerate() {
                write!(f, "{}{triangles} {shading}", if i == 0 { " (" } else { ", " })?;
            }
            f.write_str(if self.shares.into_iter().next().is_some() { ")" } else { "" })?;
        }
        write!(
            f,
            ", {vertex_path} vertices, kernel {kernel}, {hidden_surfaces}: {vertices} vertices, {lit} lit, {faces} faces, \
             {clipped} clipped, {culled} culled, {drawn} drawn, {} spans, {} pixels covered, {} written",
            raster.spans, raster.covered, raster.pixels
        )?;
        let counts = [
            (u64::from(raster.tested), "tested for depth"),
            (u64::from(raster.textured), "textured"),
            (u64::from(raster.mipmapped), "mipmapped"),
            (u64::from(raster.mixed), "mixed from channels"),
            (u64::from(raster.lit), "lit per pixel"),
            (u64::from(raster.fogged), "fogged"),
            (u64::from(raster.blended), "blended"),
            (u64::from(raster.dithered), "dithered"),
            (*kept, "objects kept"),
        ];
        for (count, what) in counts.into_iter().filter(|(count, _)| *count > 0) {
            write!(f, ", {count} {what}")?;
        }
        if *redrawn { Ok(()) } else { f.write_str(", not redrawn") }
    }
}
