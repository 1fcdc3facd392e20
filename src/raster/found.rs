//! Rows of small triangles for stages that paint more than a linear shade: set-up and row ends are those of plain triangles.

use super::columns::{Picks, Triangles, Value};
use super::cover::Row;
use super::pick::{LANES, MAX_ROWS, Pick};
use super::rows::find_row;
use super::setup::{Corners8, Floats, FrameLayout, Ints, TriangleSetup8, ValuePlanes8};
use super::setup_texture::{AffinePlanes8, PerspectivePlanes8, texture_of_corners};
use crate::fixed::HAS_F64;
use crate::mapping::Mapping;
use crate::simd::{Lanes8, compiled_for_each_level};

/// Rows of eight small triangles.
#[derive(Clone, Debug)]
pub(super) struct FoundRows {
    setup: TriangleSetup8,
    affine: AffinePlanes8,
    perspective: PerspectivePlanes8,
    /// First column that is covered, the one behind the last, and the first shade with the step above it: of each row, of
    /// all triangles.
    rows: [[Ints; 3]; MAX_ROWS as usize],
    /// Other values, each with its step above it.
    values: [ValuePlanes8; Value::MAX_COUNT],
    value_starts: [[Ints; Value::MAX_COUNT]; MAX_ROWS as usize],
    /// Their texture coordinates, ...
    affine_starts: [[Ints; 2]; MAX_ROWS as usize],
    /// ... or the sums that these are quotients of.
    perspective_starts: [[Floats; 3]; MAX_ROWS as usize],
}

impl FoundRows {
    pub(super) const NONE: Self = Self {
        setup: TriangleSetup8::NONE,
        affine: AffinePlanes8::NONE,
        perspective: PerspectivePlanes8::NONE,
        rows: [[[0; LANES]; 3]; MAX_ROWS as usize],
        values: [ValuePlanes8::NONE; Value::MAX_COUNT],
        value_starts: [[[0; LANES]; Value::MAX_COUNT]; MAX_ROWS as usize],
        affine_starts: [[[0; LANES]; 2]; MAX_ROWS as usize],
        perspective_starts: [[[0.0; LANES]; 3]; MAX_ROWS as usize],
    };

    /// Number of rows of triangle `lane`. Some have no pixel.
    #[inline(always)]
    pub(super) fn count(&self, lane: usize) -> usize {
        self.setup.rows[lane % LANES].clamp(0, MAX_ROWS) as usize
    }

    /// Row `j`, the first shade, and above it the step.
    #[inline(always)]
    pub(super) fn row(&self, lane: usize, j: usize) -> (Row, u32) {
        let lane = lane % LANES;
        let [x0, x1, paint] = &self.rows[j % MAX_ROWS as usize];
        let (x0, x1) = (x0[lane], x1[lane]);
        // At most 15 more.
        let y = self.setup.row[lane] + j as i32;
        (Row { y, origin: x0, x0, x1, last: x1 - 1 }, paint[lane].cast_unsigned())
    }

    /// Values at the first pixel of row `j`, as they were wanted, each with its step above it.
    #[inline(always)]
    pub(super) fn values(&self, lane: usize, j: usize) -> [u32; Value::MAX_COUNT] {
        let (lane, starts) = (lane % LANES, &self.value_starts[j % MAX_ROWS as usize]);
        let mut values = [0; Value::MAX_COUNT];
        for (value, of) in values.iter_mut().zip(starts) {
            *value = of[lane].cast_unsigned();
        }
        values
    }

    /// Change of the affine texture coordinates from a pixel to the next one. `None` if those of the corners lie too far from
    /// each other.
    #[inline(always)]
    pub(super) fn affine_step(&self, lane: usize) -> Option<[u32; 2]> {
        let [u, v] = &self.affine.step;
        let lane = lane % LANES;
        (self.affine.fits >> lane & 1 != 0).then_some([u[lane].cast_unsigned(), v[lane].cast_unsigned()])
    }

    /// The affine texture coordinates at the first pixel of row `j`.
    #[inline(always)]
    pub(super) fn affine_start(&self, lane: usize, j: usize) -> [u32; 2] {
        let [u, v] = &self.affine_starts[j % MAX_ROWS as usize];
        [u[lane % LANES].cast_unsigned(), v[lane % LANES].cast_unsigned()]
    }

    /// Change of the numerators of the perspective texture coordinates, and of their divisor, from a pixel to the next one.
    #[inline(always)]
    pub(super) fn perspective_step(&self, lane: usize) -> [f64; 3] {
        let [u, v, d] = &self.perspective.step;
        [u[lane % LANES], v[lane % LANES], d[lane % LANES]]
    }

    /// The numerators and the divisor at the first pixel of row `j`.
    #[inline(always)]
    pub(super) fn perspective_start(&self, lane: usize, j: usize) -> [f64; 3] {
        let [u, v, d] = &self.perspective_starts[j % MAX_ROWS as usize];
        [u[lane % LANES], v[lane % LANES], d[lane % LANES]]
    }

    /// Change of the depth from a pixel to the next one, as [`DepthPlane::step`](crate::raster::depth::DepthPlane::step).
    #[inline(always)]
    pub(super) fn depth_step(&self, lane: usize) -> i64 {
        self.setup.z_per_column[lane % LANES] >> 8
    }

    /// The depth at pixel `x` of row `j`, as [`DepthPlane::fixed_at`](crate::raster::depth::DepthPlane::fixed_at) modulo 2⁵⁶.
    #[inline(always)]
    pub(super) fn depth(&self, lane: usize, j: usize, x: i32) -> i64 {
        let (setup, lane) = (&self.setup, lane % LANES);
        let columns = i64::from(x.wrapping_sub(setup.column[lane]));
        // At most 15.
        let down = setup.z_per_row[lane].wrapping_mul(j as i64);
        setup.z[lane].wrapping_add(down).wrapping_add(setup.z_per_column[lane].wrapping_mul(columns)) >> 8
    }
}

/// Values that are found of each row beside its ends and its shades.
#[derive(Clone, Copy)]
pub(super) struct Wanted {
    /// Depths.
    pub(super) depths: bool,
    /// Texture coordinates that are linear on the screen, or on the face.
    pub(super) texture: Option<Mapping>,
    /// Other values, each in its slot.
    pub(super) values: [Option<Value>; Value::MAX_COUNT],
    /// Slots up to the last that is taken.
    pub(super) slots: usize,
}

/// A value of the corners of up to eight triangles. Lanes without a triangle have 0.
#[inline(always)]
fn value_of_corners(triangles: &Triangles<'_>, picks: &Picks<'_>, value: Value) -> [Ints; 3] {
    let mut gathered = [[0; LANES]; 3];
    let columns = &triangles.columns.effects;
    for (lane, &pick) in picks.picks.iter().take(LANES).enumerate() {
        let pick = Pick(pick);
        // The channels of a face that is lit as one.
        if let (Value::Channel(i), Some(flat)) = (value, picks.flat.get(lane)) {
            for corner in &mut gathered {
                corner[lane] = i32::from(flat[i].to_bits());
            }
            continue;
        }
        let indices = triangles.indices[pick.index()];
        for (corner, vertex) in indices.into_iter().enumerate() {
            gathered[corner][lane] = i32::from(columns.value(value, vertex as usize, pick.side()));
        }
    }
    gathered
}

compiled_for_each_level! {
    /// Finds the rows of up to eight small triangles.
    pub(super) fn find_rows[][](triangles: &Triangles<'_>, picks: &Picks<'_>, wanted: Wanted, found: &mut FoundRows)
        = find_rows_by;
}

#[inline(always)]
fn find_rows_by<S: Lanes8>(s: S, triangles: &Triangles<'_>, picks: &Picks<'_>, wanted: Wanted, found: &mut FoundRows) {
    // Nobody comes here then, and a chip's program must not hold what follows.
    if !HAS_F64 {
        return;
    }
    let FoundRows { setup, affine, perspective, rows, values, value_starts, affine_starts, perspective_starts } = found;
    let mut corners = Corners8::NONE;
    corners.gather::<true>(triangles, picks);
    // Offsets are not asked for.
    let layout = FrameLayout { first_row: 0, pitch: 0, width: 0 };
    let basis = if wanted.depths {
        setup.set_up::<S, true>(s, &corners, layout)
    } else {
        setup.set_up::<S, false>(s, &corners, layout)
    };
    if let Some(coordinates) = wanted.texture {
        let of_corners = texture_of_corners(triangles, picks);
        match coordinates {
            Mapping::Affine => affine.set_up(s, &basis, &of_corners),
            _ => perspective.set_up(s, &basis, &corners, &of_corners),
        }
    }
    for (planes, value) in values.iter_mut().zip(wanted.values) {
        if let Some(value) = value {
            planes.set_up(s, &basis, &value_of_corners(triangles, picks, value));
        }
    }
    let mut count = 0;
    for &rows in setup.rows.iter().take(picks.picks.len()) {
        count = if rows > count { rows } else { count };
    }
    let count = count.min(MAX_ROWS);
    for number in 0..count {
        let j = s.splat_f64(f64::from(number));
        let (ends, row) = find_row(s, setup, number);
        let number = number as usize;
        for (i, to) in rows[number].iter_mut().enumerate() {
            s.store_i32(row[i], to);
        }
        for (slot, planes) in values[..wanted.slots].iter().enumerate() {
            if wanted.values[slot].is_some() {
                s.store_i32(ends.value(s, (planes, &setup.inverse), j), &mut value_starts[number][slot]);
            }
        }
        match wanted.texture {
            None => {}
            Some(Mapping::Affine) => {
                let [u, v] = affine.start(s, j, &ends);
                s.store_i32(u, &mut affine_starts[number][0]);
                s.store_i32(v, &mut affine_starts[number][1]);
            }
            Some(_) => {
                let [u, v, d] = perspective.start(s, j, &ends);
                s.store_f64(u, &mut perspective_starts[number][0]);
                s.store_f64(v, &mut perspective_starts[number][1]);
                s.store_f64(d, &mut perspective_starts[number][2]);
            }
        }
    }
}
