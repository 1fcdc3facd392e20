//! One edge, walked from row to row with quotient and remainder: there is no slope, so no rounding that could
//! accumulate.
//!
//! The pixels of a row that lie right of an edge, or on it, begin at
//!
//! ```text
//! ceil((x_edge(yc) − 128) / 256),   x_edge(yc) = xa + (xb − xa)·(yc − ya) / (yb − ya)
//! ```
//!
//! with `yc = 256·row + 128` the row's centre, all in 1/256 pixel. Over the common denominator
//! `256·(yb − ya)` that is the ceiling of one fraction, and from one row to the next the numerator
//! grows by `256·(xb − xa)`. A left edge includes its pixel and a right edge excludes it; both use
//! this same number, as the first pixel of the row and as the one after the last, which is why two
//! triangles that share the edge share no pixel and leave none out.

use super::quotient::Divisor;

/// An edge at one row.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Edge {
    /// The first pixel whose centre is on the edge or right of it.
    pub x: i32,
    rest: i32,
    step: i32,
    step_rest: i32,
    denominator: i32,
}

impl Edge {
    /// The edge from `a` down to `b`, each (x, y) in 1/256 pixel within the guard band, at the row
    /// whose centre lies in `[a.y, b.y)`; `b.y` is greater than `a.y`.
    #[must_use]
    #[inline]
    pub(crate) fn at_row(a: (i32, i32), b: (i32, i32), row: i32) -> Self {
        let (dx, dy) = (b.0 - a.0, b.1 - a.1);
        debug_assert!(dy > 0);
        let below = row * 256 + 128 - a.1;
        debug_assert!((0..dy).contains(&below));
        // At most 2²¹ · 2⁸.
        let denominator = Divisor::new(i64::from(dy) * 256);
        // At most 2²¹ · 2²¹ + 2²¹ · 2²¹ + 2²⁹; the ceiling is the floor of n + d − 1.
        let numerator = i64::from(a.0 - 128) * i64::from(dy) + i64::from(dx) * i64::from(below);
        let (x, rest) = denominator.div_rem_floor(numerator + denominator.get() - 1);
        let (step, step_rest) = denominator.div_rem_floor(i64::from(dx) * 256);
        // x within ±4,097, step within ±2²¹, the remainders below the denominator, at most 2²⁹.
        let of = |n: i64| n as i32;
        Self { x: of(x), rest: of(rest), step: of(step), step_rest: of(step_rest), denominator: of(denominator.get()) }
    }

    /// Steps to the next row.
    #[inline]
    pub(crate) fn down(&mut self) {
        // Both remainders are below 2²⁹.
        self.rest += self.step_rest;
        let carry = i32::from(self.rest >= self.denominator);
        self.rest -= self.denominator * carry;
        self.x += self.step + carry;
    }
}
