//! Batches of eight values, in which light, vertices and pixels are computed.

/// The number of pixels or vertices in a batch: enough for one or more of the processor's vectors, but no more pixels
/// than a short span has.
pub const LANES: usize = 8;

/// The index of each lane.
pub(crate) const NUMBERS: Lanes<i32> = [0, 1, 2, 3, 4, 5, 6, 7];

/// One value for each of eight consecutive pixels or vertices.
pub type Lanes<T> = [T; LANES];

/// Normals and positions (x, y and z of each) of eight consecutive pixels or vertices.
pub type Points = [Lanes<f32>; 6];

/// `each!(lane => value)`: one value for each lane.
///
/// This is an index loop, because a closure, or a library function that takes one, is compiled for
/// the baseline target rather than the caller's target features unless the optimiser inlines it.
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

/// The blocks of eight bytes that hold the first `n` bytes; a last block that would not fit is left out.
#[inline(always)]
pub(crate) fn blocks(bytes: &mut [u8], n: usize) -> impl Iterator<Item = &mut Lanes<u8>> {
    bytes.as_chunks_mut().0.iter_mut().take(n.div_ceil(LANES))
}

/// Like `array::map` for three values, usually one for each corner of a face, but always inlined.
#[inline(always)]
pub(crate) fn three<T, U>([a, b, c]: [T; 3], mut of: impl FnMut(T) -> U) -> [U; 3] {
    [of(a), of(b), of(c)]
}
