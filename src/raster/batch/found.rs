//! Rows of a batch's triangles for stages that paint more than a linear shade: culling, set-up and row ends are those of
//! plain triangles.

use super::class::{ClassedIndex, SizeClass};
use super::cull::{Survivors, cull};
use super::rows::find_eight_rows;
use super::setup::{Corners8, TriangleSetup8};
use super::triangles::{Batch, FrameLayout, LANES, MAX_ROWS};
use crate::fixed::HAS_F64;
use crate::raster::cover::Row;
use crate::raster::frame::Rect;
use crate::simd::{Lanes8, Level, compiled_for_each_level};

/// Rows of eight small triangles.
pub(in crate::raster) struct FoundRows {
    setup: TriangleSetup8,
    /// First column that is covered of each triangle's rows, the one behind the last, and the first shade with the step above
    /// it.
    rows: [[[i32; MAX_ROWS as usize]; 3]; LANES],
}

impl FoundRows {
    /// The rows of triangle `lane`, from the top down; of each the first shade, and above it the step. Some have no pixel.
    #[inline(always)]
    pub(in crate::raster) fn of(&self, lane: usize) -> impl Iterator<Item = (Row, u32)> {
        let lane = lane % LANES;
        let count = self.setup.rows[lane].clamp(0, MAX_ROWS) as usize;
        let (first, [left, right, paint]) = (self.setup.row[lane], &self.rows[lane]);
        (0..count).map(move |j| {
            let (x0, x1) = (left[j], right[j]);
            // At most 15 more.
            (Row { y: first + j as i32, origin: x0, x0, x1, last: x1 - 1 }, paint[j].cast_unsigned())
        })
    }
}

/// Triangles of a batch that may cover a pixel, in their order, and the rows of small ones.
pub(in crate::raster) struct Finder<'a> {
    level: Level,
    batch: &'a Batch,
    kept: Survivors,
    /// How many of those that are kept have been asked for.
    done: usize,
    rows: FoundRows,
}

/// Triangles that come next.
pub(in crate::raster) enum Found<'a> {
    /// Triangles whose rows are found: lane i has those of the i-th.
    Small(&'a [u32], &'a FoundRows),
    /// One that is large, or crosses an edge of the clip rectangle.
    Another(usize),
}

/// The index in its batch of a triangle of [`Found::Small`].
#[inline(always)]
pub(in crate::raster) fn index(triangle: u32) -> usize {
    ClassedIndex(triangle).index()
}

impl<'a> Finder<'a> {
    /// Culls the triangles of a batch.
    pub(in crate::raster) fn new(level: Level, batch: &'a Batch, clip: Rect) -> Self {
        let mut kept = Survivors::new();
        cull(level, batch, clip, &mut kept);
        let rows = FoundRows { setup: TriangleSetup8::NONE, rows: [[[0; MAX_ROWS as usize]; 3]; LANES] };
        Self { level, batch, kept, done: 0, rows }
    }

    /// The next triangles; `None` when there is none left.
    pub(in crate::raster) fn next(&mut self) -> Option<Found<'_>> {
        let left = &self.kept.as_slice()[self.done..];
        let first = left.first()?;
        let is_small = |triangle: &&u32| HAS_F64 && ClassedIndex(**triangle).class() == SizeClass::Small;
        let small = left.iter().take(LANES).take_while(is_small).count();
        if small == 0 {
            self.done += 1;
            return Some(Found::Another(index(*first)));
        }
        self.done += small;
        find_rows(self.level, self.batch, &left[..small], &mut self.rows);
        Some(Found::Small(&left[..small], &self.rows))
    }
}

compiled_for_each_level! {
    fn find_rows[][](batch: &Batch, triangles: &[u32], found: &mut FoundRows) = find_rows_by;
}

#[inline(always)]
fn find_rows_by<S: Lanes8>(s: S, batch: &Batch, triangles: &[u32], found: &mut FoundRows) {
    // Nobody comes here then, and a chip's program must not hold what follows.
    if !HAS_F64 {
        return;
    }
    let mut corners = Corners8::NONE;
    corners.gather::<false>(batch, triangles);
    // Offsets are not asked for.
    found.setup.set_up::<S, false>(s, &corners, FrameLayout { first_row: 0, pitch: 0, width: 0 });
    for i in 0..triangles.len().min(LANES) {
        for first in (0..found.setup.rows[i].min(MAX_ROWS)).step_by(LANES) {
            let of_eight = find_eight_rows(s, &found.setup, (i, first));
            for (numbers, of_eight) in found.rows[i].iter_mut().zip(of_eight) {
                if let Some(eight) = numbers[first as usize..].first_chunk_mut() {
                    s.put_i32s(of_eight, eight);
                }
            }
        }
    }
}
