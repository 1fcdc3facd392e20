//! Eight numbers at a time: the form in which light, vertices and pixels are computed.

/// The number of pixels or vertices in one batch: two to eight vectors of a processor, and no more than short spans
/// have.
pub const LANES: usize = 8;

/// The numbers of the lanes.
pub(crate) const NUMBERS: Lanes<i32> = [0, 1, 2, 3, 4, 5, 6, 7];

/// One number for each of so many pixels or vertices that follow each other.
pub type Lanes<T> = [T; LANES];

/// Normal and position, x, y and z each, of as many pixels or vertices.
pub type Points = [Lanes<f32>; 6];

/// `each!(lane => value)`: one value for each lane.
///
/// An index loop, because a closure, or a function of the standard library that takes one, would be compiled for the
/// baseline instead of the caller's level whenever the optimiser does not inline it.
macro_rules! each {
    ($lane:ident => $value:expr) => {{
        let mut lanes = [Default::default(); crate::lanes::LANES];
        let mut $lane = 0;
        while $lane < crate::lanes::LANES {
            lanes[$lane] = $value;
            $lane += 1;
        }
        lanes
    }};
}
pub(crate) use each;

/// `array::map` of three values, which are mostly those of a face's corners. Always inlined, as that is not.
#[inline(always)]
pub(crate) fn three<T, U>([a, b, c]: [T; 3], mut of: impl FnMut(T) -> U) -> [U; 3] {
    [of(a), of(b), of(c)]
}
