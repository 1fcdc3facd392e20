//! A look-up by two bytes: the core of texel shading, fog, transparency and Phong's table.

/// Replaces each byte with its entry in a table of 256 × 256:
///
/// ```text
/// row[k] = table[high[k] << 8 | row[k]]
/// ```
///
/// for every `k` below the shorter length; pixels beyond it are left alone.
///
/// | table | `high` | `row` |
/// |---|---|---|
/// | shades | shade | texel |
/// | fog | level of fog | byte |
/// | transparency | byte of the face | byte of the frame |
/// | Phong's, of 1994 | the normal's y | the normal's x |
///
/// Vectors are not used: eight gathered loads per iteration (AVX2) take 20 ns at 64 pixels and 17 at 8, where this
/// takes 29 and 6, and gathers are said to be much slower on processors patched against gather data sampling.
#[inline(never)]
pub fn lookup(row: &mut [u8], high: &[u8], table: &[u8; 65_536]) {
    let n = row.len().min(high.len());
    let high = &high[..n];
    for (k, pixel) in row[..n].iter_mut().enumerate() {
        *pixel = table[usize::from(u16::from_be_bytes([high[k], *pixel]))];
    }
}

/// Looks up like [`lookup`], but replaces the bytes that choose the table's row: `rows[k] = table[rows[k] << 8 |
/// low[k]]`.
#[cfg(feature = "alloc")]
#[inline]
pub(crate) fn lookup_row(rows: &mut [u8], low: &[u8], table: &[u8; 65_536]) {
    for (row, low) in rows.iter_mut().zip(low) {
        *row = table[usize::from(u16::from_be_bytes([*row, *low]))];
    }
}
