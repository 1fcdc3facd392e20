//! The span with a depth test: the same row of shades, written where the triangle is in front.
//!
//! ```text
//! for every k:  d = ((z + k·dz) mod 2⁶⁴) >> 24
//!               if d > depth[k] { depth[k] = d; row[k] = ((shade + k·step) mod 65,536) >> 8 }
//! ```
//!
//! At equal depths the first one drawn stays. A cell of the buffer may be narrower than a depth: then `d` is narrowed
//! first ([`Cell`]).

mod sealed {
    /// Cells of a depth buffer, of either width.
    #[derive(Debug)]
    pub enum Cells<'a> {
        U16(&'a mut [u16]),
        /// Cells of 32 bits, which have kernels of their own.
        U32(&'a mut [u32]),
    }

    pub trait Sealed: Sized {
        fn cells(cells: &mut [Self]) -> Cells<'_>;
    }
    impl Sealed for u32 {
        fn cells(cells: &mut [Self]) -> Cells<'_> {
            Cells::U32(cells)
        }
    }
    impl Sealed for u16 {
        fn cells(cells: &mut [Self]) -> Cells<'_> {
            Cells::U16(cells)
        }
    }
}

pub(crate) use sealed::Cells;

impl Cells<'_> {
    pub(crate) fn len(&self) -> usize {
        match self {
            Self::U16(cells) => cells.len(),
            Self::U32(cells) => cells.len(),
        }
    }
}

/// A cell of a depth buffer, one for each pixel: greater is nearer, 0 is empty.
///
/// | cell | holds | what is lost |
/// |---|---|---|
/// | `u32` | d | nothing |
/// | `u16` | min(⌈d / 2¹⁴⌉, 65,535) | which of two depths within 2¹⁴ of each other is nearer: the first drawn stays |
///
/// In the engine d is at most 2³⁰, so a u16 holds the upper 16 of its 30 bits. They are rounded up, so whatever is
/// drawn with u32 cells (d ≥ 1) hides the background here too, however far away it is. At a distance w two surfaces,
/// one in front of the other, are distinguished if they are w² / (2¹⁶·near) apart: at 100 times the near distance that
/// is 0.15 of the near distance. The two nearest values coincide, because one of them would be for d = 2³⁰ alone.
pub trait Cell: Copy + Ord + Default + sealed::Sealed + 'static {
    /// The cell's value for a depth.
    fn of_depth(depth: u32) -> Self;
}

impl Cell for u32 {
    #[inline]
    fn of_depth(depth: u32) -> Self {
        depth
    }
}

impl Cell for u16 {
    #[inline]
    fn of_depth(depth: u32) -> Self {
        // Saturates only where the result does too.
        (depth.saturating_add((1 << 14) - 1) >> 14).min(0xFFFF) as u16
    }
}

/// Fills `row` where the depth at a pixel is greater than in `depth`, and stores the greater depth.
///
/// `shade` and `step` are 8.8, `z` and `dz` depths with 24 fraction bits; both sums wrap. Returns the number of pixels
/// written. Pixels beyond the shorter of the two slices are left alone.
#[inline]
pub fn fill_nearer<D: Cell>(row: &mut [u8], depth: &mut [D], shade: u16, step: u16, z: i64, dz: i64) -> u32 {
    let mut ax = shade;
    fill_by(row, depth, z, dz, || {
        let byte = (ax >> 8) as u8;
        ax = ax.wrapping_add(step);
        byte
    })
}

/// [`fill_nearer`] for shades in 16.16.
#[inline]
pub(crate) fn fill_nearer_16_16<D: Cell>(
    row: &mut [u8],
    depth: &mut [D],
    [mut shade, step]: [u32; 2],
    z: i64,
    dz: i64,
) -> u32 {
    fill_by(row, depth, z, dz, || {
        let byte = (shade >> 16) as u8;
        shade = shade.wrapping_add(step);
        byte
    })
}

/// Fills `row` with what `next` returns for each pixel, where it is nearer.
#[inline(always)]
fn fill_by<D: Cell>(row: &mut [u8], depth: &mut [D], mut z: i64, dz: i64, mut next: impl FnMut() -> u8) -> u32 {
    let n = row.len().min(depth.len());
    let (row, depth, mut i, mut written) = (&mut row[..n], &mut depth[..n], 0, 0);
    while i < n {
        let byte = next();
        // Depths are u32: within a triangle no bits from 56 up are set.
        let d = D::of_depth((z >> 24) as u32);
        if d > depth[i] {
            depth[i] = d;
            row[i] = byte;
            written += 1;
        }
        z = z.wrapping_add(dz);
        i += 1;
    }
    written
}

/// Copies `bytes` to `row` where the depth at a pixel is greater than in `depth`, and stores the greater depth.
#[inline]
pub fn copy_nearer<D: Cell>(row: &mut [u8], depth: &mut [D], bytes: &[u8], z: i64, dz: i64) -> u32 {
    let n = row.len().min(depth.len()).min(bytes.len());
    let depth = &mut depth[..n];
    copy_where(&mut row[..n], &bytes[..n], z, dz, |i, d| {
        let nearer = d > depth[i];
        if nearer {
            depth[i] = d;
        }
        nearer
    })
}

/// Copies `bytes` to `row` where the depth at a pixel is greater than in `depth`, which does not change.
///
/// This is for transparent faces, many of which may overlap.
#[inline]
pub fn copy_nearer_keep_depth<D: Cell>(row: &mut [u8], depth: &[D], bytes: &[u8], z: i64, dz: i64) -> u32 {
    let n = row.len().min(depth.len()).min(bytes.len());
    let depth = &depth[..n];
    copy_where(&mut row[..n], &bytes[..n], z, dz, |i, d: D| d > depth[i])
}

/// Copies a byte to each pixel for which `nearer`, given its index and depth, returns true.
#[inline]
fn copy_where<D: Cell>(row: &mut [u8], bytes: &[u8], z: i64, dz: i64, mut nearer: impl FnMut(usize, D) -> bool) -> u32 {
    let (n, mut i, mut z, mut written) = (row.len().min(bytes.len()), 0, z, 0);
    while i < n {
        if nearer(i, D::of_depth((z >> 24) as u32)) {
            row[i] = bytes[i];
            written += 1;
        }
        z = z.wrapping_add(dz);
        i += 1;
    }
    written
}
