//! One number for many frames: FNV-1a, 64 bits.

/// The hash of nothing.
pub(in super::super) const START: u64 = 0xCBF2_9CE4_8422_2325;

/// The hash of what `hash` is the hash of, and then these bytes (Fowler, Noll, Vo; draft-eastlake-fnv).
pub(in super::super) fn fnv_1a(hash: u64, bytes: &[u8]) -> u64 {
    bytes.iter().fold(hash, |hash, byte| (hash ^ u64::from(*byte)).wrapping_mul(0x0000_0100_0000_01B3))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Tests the values of the draft's table.
    #[test]
    fn it_is_fnv_1a() {
        assert_eq!(fnv_1a(START, b""), 0xCBF2_9CE4_8422_2325);
        assert_eq!(fnv_1a(START, b"a"), 0xAF63_DC4C_8601_EC8C);
        assert_eq!(fnv_1a(START, b"foobar"), 0x8594_4171_F739_67E8);
    }
}
