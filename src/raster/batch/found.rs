//! Rows of a batch's triangles for stages that paint more than a linear shade: culling, set-up and row ends are those of
//! plain triangles.

use super::class::{ClassedIndex, SizeClass};
use super::cull::{Survivors, cull};
use super::rows::find_row;
use super::setup::{Corners8, Floats, Ints, TriangleSetup8};
use super::texture::{AffinePlanes8, PerspectivePlanes8, TextureCorners};
use super::triangles::{Batch, FrameLayout, LANES, MAX_ROWS};
use crate::fixed::HAS_F64;
use crate::raster::cover::Row;
use crate::raster::frame::Rect;
use crate::simd::{Lanes8, Level, compiled_for_each_level};

/// Triangles that are found together, at most.
pub(in crate::raster) const MAX_FOUND: usize = 64;

/// Interpolation of texture coordinates.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(in crate::raster) enum Coordinates {
    /// Linear on the screen.
    Affine,
    /// Linear on the face.
    Perspective,
}

/// Rows of eight small triangles.
#[derive(Clone, Debug)]
pub(in crate::raster) struct FoundRows {
    setup: TriangleSetup8,
    affine: AffinePlanes8,
    perspective: PerspectivePlanes8,
    /// First column that is covered, the one behind the last, and the first shade with the step above it: of each row, of
    /// all triangles.
    rows: [[Ints; 3]; MAX_ROWS as usize],
    /// Their texture coordinates, ...
    affine_starts: [[Ints; 2]; MAX_ROWS as usize],
    /// ... or the sums that these are quotients of.
    perspective_starts: [[Floats; 3]; MAX_ROWS as usize],
}

impl FoundRows {
    pub(in crate::raster) const NONE: Self = Self {
        setup: TriangleSetup8::NONE,
        affine: AffinePlanes8::NONE,
        perspective: PerspectivePlanes8::NONE,
        rows: [[[0; LANES]; 3]; MAX_ROWS as usize],
        affine_starts: [[[0; LANES]; 2]; MAX_ROWS as usize],
        perspective_starts: [[[0.0; LANES]; 3]; MAX_ROWS as usize],
    };

    /// Number of rows of triangle `lane`. Some have no pixel.
    #[inline(always)]
    pub(in crate::raster) fn count(&self, lane: usize) -> usize {
        self.setup.rows[lane % LANES].clamp(0, MAX_ROWS) as usize
    }

    /// Row `j`, the first shade, and above it the step.
    #[inline(always)]
    pub(in crate::raster) fn row(&self, lane: usize, j: usize) -> (Row, u32) {
        let lane = lane % LANES;
        let [x0, x1, paint] = &self.rows[j % MAX_ROWS as usize];
        let (x0, x1) = (x0[lane], x1[lane]);
        // At most 15 more.
        let y = self.setup.row[lane] + j as i32;
        (Row { y, origin: x0, x0, x1, last: x1 - 1 }, paint[lane].cast_unsigned())
    }

    /// Change of the affine texture coordinates from a pixel to the next one. `None` if those of the corners lie too far from
    /// each other.
    #[inline(always)]
    pub(in crate::raster) fn affine_step(&self, lane: usize) -> Option<[u32; 2]> {
        let [u, v] = &self.affine.step;
        let lane = lane % LANES;
        (self.affine.fits >> lane & 1 != 0).then_some([u[lane].cast_unsigned(), v[lane].cast_unsigned()])
    }

    /// The affine texture coordinates at the first pixel of row `j`.
    #[inline(always)]
    pub(in crate::raster) fn affine_start(&self, lane: usize, j: usize) -> [u32; 2] {
        let [u, v] = &self.affine_starts[j % MAX_ROWS as usize];
        [u[lane % LANES].cast_unsigned(), v[lane % LANES].cast_unsigned()]
    }

    /// Change of the numerators of the perspective texture coordinates, and of their divisor, from a pixel to the next one.
    #[inline(always)]
    pub(in crate::raster) fn perspective_step(&self, lane: usize) -> [f64; 3] {
        let [u, v, d] = &self.perspective.step;
        [u[lane % LANES], v[lane % LANES], d[lane % LANES]]
    }

    /// The numerators and the divisor at the first pixel of row `j`.
    #[inline(always)]
    pub(in crate::raster) fn perspective_start(&self, lane: usize, j: usize) -> [f64; 3] {
        let [u, v, d] = &self.perspective_starts[j % MAX_ROWS as usize];
        [u[lane % LANES], v[lane % LANES], d[lane % LANES]]
    }

    /// Change of the depth from a pixel to the next one, as [`DepthPlane::step`](crate::raster::depth::DepthPlane::step).
    #[inline(always)]
    pub(in crate::raster) fn depth_step(&self, lane: usize) -> i64 {
        self.setup.z_per_column[lane % LANES] >> 8
    }

    /// The depth at pixel `x` of row `j`, as [`DepthPlane::fixed_at`](crate::raster::depth::DepthPlane::fixed_at) modulo 2⁵⁶.
    #[inline(always)]
    pub(in crate::raster) fn depth(&self, lane: usize, j: usize, x: i32) -> i64 {
        let (setup, lane) = (&self.setup, lane % LANES);
        let columns = i64::from(x.wrapping_sub(setup.column[lane]));
        // At most 15.
        let down = setup.z_per_row[lane].wrapping_mul(j as i64);
        setup.z[lane].wrapping_add(down).wrapping_add(setup.z_per_column[lane].wrapping_mul(columns)) >> 8
    }
}

/// Values that are found of each row beside its ends and its shades.
#[derive(Clone, Copy)]
pub(in crate::raster) struct Wanted<'a> {
    /// Depths.
    pub(in crate::raster) depths: bool,
    /// Texture coordinates, and those of the corners.
    pub(in crate::raster) texture: Option<(Coordinates, &'a TextureCorners<MAX_FOUND>)>,
}

/// Triangles of a batch that may cover a pixel, in their order, and the rows of small ones.
pub(in crate::raster) struct Finder<'a> {
    level: Level,
    batch: &'a Batch,
    wanted: Wanted<'a>,
    kept: Survivors,
    /// How many of those that are kept have been asked for.
    done: usize,
    rows: &'a mut FoundRows,
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
    pub(in crate::raster) fn new(
        level: Level,
        batch: &'a Batch,
        wanted: Wanted<'a>,
        clip: Rect,
        rows: &'a mut FoundRows,
    ) -> Self {
        let mut kept = Survivors::new();
        cull(level, batch, clip, &mut kept);
        Self { level, batch, wanted, kept, done: 0, rows }
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
        find_rows(self.level, self.batch, self.wanted, &left[..small], self.rows);
        Some(Found::Small(&left[..small], self.rows))
    }
}

compiled_for_each_level! {
    fn find_rows[][](batch: &Batch, wanted: Wanted<'_>, triangles: &[u32], found: &mut FoundRows) = find_rows_by;
}

#[inline(always)]
fn find_rows_by<S: Lanes8>(s: S, batch: &Batch, wanted: Wanted<'_>, triangles: &[u32], found: &mut FoundRows) {
    // Nobody comes here then, and a chip's program must not hold what follows.
    if !HAS_F64 {
        return;
    }
    let FoundRows { setup, affine, perspective, rows, affine_starts, perspective_starts } = found;
    let mut corners = Corners8::NONE;
    corners.gather::<true>(batch, triangles);
    // Offsets are not asked for.
    let layout = FrameLayout { first_row: 0, pitch: 0, width: 0 };
    let basis = if wanted.depths {
        setup.set_up::<S, true>(s, &corners, layout)
    } else {
        setup.set_up::<S, false>(s, &corners, layout)
    };
    if let Some((coordinates, of_corners)) = wanted.texture {
        let mut numbers = [0; LANES];
        for (lane, &triangle) in triangles.iter().take(LANES).enumerate() {
            numbers[lane] = index(triangle);
        }
        let of_corners = of_corners.gather(&numbers);
        match coordinates {
            Coordinates::Affine => affine.set_up(s, &basis, &of_corners),
            Coordinates::Perspective => perspective.set_up(s, &basis, &corners, &of_corners),
        }
    }
    let mut count = 0;
    for &rows in setup.rows.iter().take(triangles.len()) {
        count = if rows > count { rows } else { count };
    }
    let count = count.min(MAX_ROWS);
    for number in 0..count {
        let j = s.all_f64(f64::from(number));
        let (ends, row) = find_row(s, setup, number);
        let number = number as usize;
        for (i, to) in rows[number].iter_mut().enumerate() {
            s.put_i32s(row[i], to);
        }
        match wanted.texture {
            None => {}
            Some((Coordinates::Affine, _)) => {
                let [u, v] = affine.start(s, j, &ends);
                s.put_i32s(u, &mut affine_starts[number][0]);
                s.put_i32s(v, &mut affine_starts[number][1]);
            }
            Some((Coordinates::Perspective, _)) => {
                let [u, v, d] = perspective.start(s, j, &ends);
                s.put_f64s(u, &mut perspective_starts[number][0]);
                s.put_f64s(v, &mut perspective_starts[number][1]);
                s.put_f64s(d, &mut perspective_starts[number][2]);
            }
        }
    }
}
