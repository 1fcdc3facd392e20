//! The frame to draw into: a struct of the caller's, which is checked at each call.

use core::ffi::{c_int, c_void};

use mode13h::raster::{DepthBuffer, Frame, RasterError, Rect};

use crate::abi::{OK, Outcome, Refusal, Target, code, read};

/// A range of bytes in memory.
#[derive(Clone, Copy)]
pub(crate) struct Bytes {
    start: usize,
    length: usize,
}

impl Bytes {
    /// The range that starts at a pointer. The pointer must not be null, and the range must not reach beyond the end of
    /// memory.
    pub(crate) fn new<T>(pointer: *const T, length: usize) -> Outcome<Self> {
        if pointer.is_null() {
            return Err(Refusal::Null);
        }
        let start = pointer.addr();
        // No slice is longer than half the address space.
        if length > isize::MAX as usize || start.checked_add(length).is_none() {
            return Err(Refusal::Short);
        }
        Ok(Self { start, length })
    }

    /// Rejects ranges that overlap.
    pub(crate) fn apart_from(self, other: Self) -> Outcome {
        let apart = self.start + self.length <= other.start || other.start + other.length <= self.start;
        if apart || self.length == 0 || other.length == 0 { Ok(()) } else { Err(Refusal::Overlap) }
    }
}

/// A depth buffer, as described by the target.
pub(crate) enum Depth<'a> {
    None,
    U16(DepthBuffer<'a, u16>),
    U32(DepthBuffer<'a, u32>),
}

/// A target that has been checked.
pub(crate) struct Checked<'a> {
    pub(crate) frame: Frame<'a>,
    pub(crate) depth: Depth<'a>,
    pub(crate) clip: Rect,
    pixels: Bytes,
    depths: Option<Bytes>,
    /// The context's memory, if it is used.
    context: Option<Bytes>,
}

impl Checked<'_> {
    /// Rejects a range that overlaps memory that is written.
    pub(crate) fn apart_from(&self, read: Bytes) -> Outcome {
        read.apart_from(self.pixels)?;
        [self.depths, self.context].into_iter().flatten().try_for_each(|written| read.apart_from(written))
    }

    /// Adds the memory of a context to what is written.
    #[cfg(feature = "effects")]
    pub(crate) fn add_context(&mut self, context: Bytes) -> Outcome {
        self.apart_from(context)?;
        self.context = Some(context);
        Ok(())
    }

    /// The part of the clip rectangle that is in the frame.
    fn clip(&self) -> Rect {
        self.clip.intersection(self.frame.bounds())
    }
}

fn refusal(error: RasterError) -> Refusal {
    match error {
        RasterError::Size { .. } => Refusal::Side,
        RasterError::Pitch { .. } => Refusal::Pitch,
        RasterError::Band { .. } => Refusal::Band,
        RasterError::Depths { .. } => Refusal::Depth,
        _ => Refusal::Short,
    }
}

/// Lays a depth buffer of some type over the bytes that a target names.
macro_rules! depth_of {
    ($value:ty, $target:expr, $frame:expr) => {{
        if !$target.depth.addr().is_multiple_of(align_of::<$value>()) {
            return Err(Refusal::Alignment);
        }
        let count = $target.depth_bytes / size_of::<$value>();
        // SAFETY: not null, aligned, no longer than the bytes available, and apart from the pixels; by the caller
        // nobody else uses them.
        let values = unsafe { core::slice::from_raw_parts_mut($target.depth.cast::<$value>(), count) };
        DepthBuffer::new(values, &$frame).map_err(refusal)?
    }};
}

/// Checks a target, and borrows what it names.
///
/// # Safety
/// `target` is null or a target, and what it names is the caller's; nobody else reads or writes it during the call.
pub(crate) unsafe fn check<'a>(target: *const Target) -> Outcome<Checked<'a>> {
    // SAFETY: by the caller.
    let target = unsafe { read(target) }?;
    let pixels = Bytes::new(target.pixels, target.pixel_bytes)?;
    let rows = target.first_row..target.first_row.saturating_add(target.rows);
    // Only up to the last pixel: loops rewrite bytes behind a row, and those behind the band may be another thread's.
    let before_last = target.pitch.saturating_mul(target.rows.saturating_sub(1) as usize);
    let length = target.pixel_bytes.min(before_last.saturating_add(target.width as usize));
    // SAFETY: not null, and no longer than a slice may be.
    let slice = unsafe { core::slice::from_raw_parts_mut(target.pixels, length) };
    let frame = Frame::band(slice, target.width, target.height, target.pitch, rows).map_err(refusal)?;
    let mut depths = None;
    let depth = match target.depth_bits {
        0 => Depth::None,
        bits @ (16 | 32) => {
            let bytes = Bytes::new(target.depth, target.depth_bytes)?;
            bytes.apart_from(pixels)?;
            depths = Some(bytes);
            if bits == 16 {
                Depth::U16(depth_of!(u16, target, frame))
            } else {
                Depth::U32(depth_of!(u32, target, frame))
            }
        }
        _ => return Err(Refusal::Depth),
    };
    let clip = Rect { x0: target.clip_x0, y0: target.clip_y0, x1: target.clip_x1, y1: target.clip_y1 };
    Ok(Checked { frame, depth, clip, pixels, depths, context: None })
}

/// Writes a struct through a pointer.
///
/// # Safety
/// It is null, or there is room.
unsafe fn put(to: *mut Target, target: Target) -> Outcome {
    if to.is_null() {
        return Err(Refusal::Null);
    }
    // SAFETY: by the caller.
    unsafe { to.write_unaligned(target) };
    Ok(())
}

/// Changes a target.
///
/// # Safety
/// It is null or a target.
unsafe fn change(to: *mut Target, change: impl FnOnce(&mut Target) -> Outcome) -> c_int {
    // SAFETY: by the caller.
    code(unsafe { read(to) }.and_then(|mut target| {
        change(&mut target)?;
        // SAFETY: as above.
        unsafe { put(to, target) }
    }))
}

/// Makes a target of a whole frame, without a depth buffer.
///
/// # Safety
/// See the header.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn m13_target_init(
    target: *mut Target,
    pixels: *mut c_void,
    bytes: usize,
    width: u32,
    height: u32,
    pitch: usize,
) -> c_int {
    // SAFETY: by the caller.
    unsafe { m13_target_init_band(target, pixels, bytes, width, height, pitch, 0, height) }
}

/// Makes a target of a band of a frame, without a depth buffer.
///
/// # Safety
/// See the header.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn m13_target_init_band(
    target: *mut Target,
    pixels: *mut c_void,
    bytes: usize,
    width: u32,
    height: u32,
    pitch: usize,
    first_row: u32,
    rows: u32,
) -> c_int {
    let made = Target {
        size: size_of::<Target>() as u32,
        width,
        height,
        first_row,
        rows,
        clip_x0: 0,
        clip_y0: 0,
        clip_x1: width,
        clip_y1: height,
        depth_bits: 0,
        pixels: pixels.cast(),
        pixel_bytes: bytes,
        pitch,
        depth: core::ptr::null_mut(),
        depth_bytes: 0,
    };
    // SAFETY: by the caller.
    code(unsafe { check(&raw const made).and_then(|_| put(target, made)) })
}

/// Gives a target a depth buffer, or removes it if `bits` is 0.
///
/// # Safety
/// See the header.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn m13_target_depth(target: *mut Target, depth: *mut c_void, bytes: usize, bits: u32) -> c_int {
    // SAFETY: by the caller.
    unsafe {
        change(target, |target| {
            let with = Target { depth, depth_bytes: bytes, depth_bits: bits, ..*target };
            check(&raw const with)?;
            *target = with;
            Ok(())
        })
    }
}

/// Restricts drawing to a rectangle from now on.
///
/// # Safety
/// See the header.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn m13_target_clip(target: *mut Target, x0: i32, y0: i32, x1: i32, y1: i32) -> c_int {
    // SAFETY: by the caller.
    unsafe {
        change(target, |target| {
            [target.clip_x0, target.clip_y0, target.clip_x1, target.clip_y1] =
                [x0, y0, x1, y1].map(|edge| edge.max(0).cast_unsigned());
            Ok(())
        })
    }
}

/// Declares that the pixels hold only some rows of the frame.
///
/// # Safety
/// See the header.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn m13_target_band(target: *mut Target, first_row: u32, rows: u32) -> c_int {
    // SAFETY: by the caller.
    unsafe {
        change(target, |target| {
            let with = Target { first_row, rows, ..*target };
            check(&raw const with)?;
            *target = with;
            Ok(())
        })
    }
}

/// Checks a target.
///
/// # Safety
/// See the header.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn m13_target_check(target: *const Target) -> c_int {
    // SAFETY: by the caller.
    code(unsafe { check(target) }.map(|_| ()))
}

/// Sets every pixel inside the clip rectangle.
///
/// # Safety
/// See the header.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn m13_clear(target: *const Target, index: u8) -> c_int {
    // SAFETY: by the caller.
    code(unsafe { check(target) }.map(|mut checked| {
        let clip = checked.clip();
        for y in clip.y0..clip.y1.max(clip.y0) {
            if let Some(row) = checked.frame.row_mut(y).and_then(|row| row.get_mut(clip.x0 as usize..clip.x1 as usize))
            {
                row.fill(index);
            }
        }
    }))
}

/// Makes everything inside the clip rectangle as far away as possible.
///
/// # Safety
/// See the header.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn m13_clear_depth(target: *const Target) -> c_int {
    // SAFETY: by the caller.
    code(unsafe { check(target) }.and_then(|mut checked| {
        let clip = checked.clip();
        let (columns, rows) = (clip.x0 as usize..clip.x1 as usize, clip.y0..clip.y1.max(clip.y0));
        match &mut checked.depth {
            Depth::None => return Err(Refusal::Depth),
            Depth::U16(depth) => rows.for_each(|y| {
                if let Some(row) = depth.row_mut(y).and_then(|row| row.get_mut(columns.clone())) {
                    row.fill(0);
                }
            }),
            Depth::U32(depth) => rows.for_each(|y| {
                if let Some(row) = depth.row_mut(y).and_then(|row| row.get_mut(columns.clone())) {
                    row.fill(0);
                }
            }),
        }
        Ok(())
    }))
}

/// A span: `count` pixels whose shade, in 8.8, changes by `step` from each to the next.
///
/// # Safety
/// See the header.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn m13_span(pixels: *mut u8, count: usize, shade: u16, step: u16) -> c_int {
    if count == 0 {
        return OK;
    }
    code(Bytes::new(pixels, count).map(|_| {
        // SAFETY: not null, and no longer than a slice may be; by the caller nobody else uses them.
        let row = unsafe { core::slice::from_raw_parts_mut(pixels, count) };
        mode13h::span::Kernel::default().fill(row, shade, step);
    }))
}
