//! The oracle for spans: the definition, one pixel at a time, in numbers that cannot overflow.

/// `row[k] = ((shade + k·step) mod 65,536) >> 8`
pub(crate) fn naive_span(length: usize, shade: u16, step: u16) -> Vec<u8> {
    let mut row = Vec::with_capacity(length);
    for k in 0..length as i64 {
        let sum = i64::from(shade) + k * i64::from(step);
        let wrapped = sum % 65_536;
        row.push((wrapped / 256) as u8);
    }
    row
}
