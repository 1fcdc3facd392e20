//! FNV-1a, 64 bits (Fowler, Noll, Vo; draft-eastlake-fnv): one number for many bytes.

/// The hash of no bytes.
pub const START: u64 = 0xCBF2_9CE4_8422_2325;

/// Continues `hash` with `bytes`. Start with [`START`].
///
/// ```
/// use mode13h_conformance::hash::{START, fnv_1a};
/// assert_eq!(fnv_1a(START, b"foobar"), 0x8594_4171_F739_67E8);
/// assert_eq!(fnv_1a(fnv_1a(START, b"foo"), b"bar"), fnv_1a(START, b"foobar"));
/// ```
#[must_use]
pub fn fnv_1a(hash: u64, bytes: &[u8]) -> u64 {
    bytes.iter().fold(hash, |hash, byte| (hash ^ u64::from(*byte)).wrapping_mul(0x0000_0100_0000_01B3))
}
