//! Eight values at a time: the form in which light, vertices and pixels are computed.

/// The number of pixels or vertices in a batch: two to eight vectors of a processor, and no more than short spans have.
pub const LANES: usize = 8;

/// The index of each lane.
pub(crate) const NUMBERS: Lanes<i32> = [0, 1, 2, 3, 4, 5, 6, 7];

/// One value for each of eight consecutive pixels or vertices.
pub type Lanes<T> = [T; LANES];

/// Normals and positions, x, y and z each, of eight consecutive pixels or vertices.
pub type Points = [Lanes<f32>; 6];

/// `each!(lane => value)`: one value for each lane.
///
/// An index loop, because a closure, or a library function that takes one, is compiled for the baseline instead of the
/// caller's level unless the optimiser inlines it.
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

/// `array::map` for three values, usually those of a face's corners, but always inlined, unlike that.
#[inline(always)]
pub(crate) fn three<T, U>([a, b, c]: [T; 3], mut of: impl FnMut(T) -> U) -> [U; 3] {
    [of(a), of(b), of(c)]
}
