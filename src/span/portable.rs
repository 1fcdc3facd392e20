//! The loop of 1994, and the specification: its output is right by definition.

/// `mov [edi],ah` / `inc edi` / `add ax,bx` / `dec cx` / `jnz`, with `row` for EDI and CX.
#[inline]
pub(super) fn fill(row: &mut [u8], shade: u16, step: u16) {
    let mut ax = shade;
    for pixel in row {
        let [ah, _al] = ax.to_be_bytes();
        *pixel = ah;
        ax = ax.wrapping_add(step);
    }
}
