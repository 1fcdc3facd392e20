//! The codes and structs of the interface, and the functions that need nothing else.

use core::ffi::{c_char, c_int, c_void};

/// The call succeeded.
pub const OK: c_int = 0;

/// Defines the codes and the text of each.
macro_rules! codes {
    ($($name:ident = $code:literal, $text:literal;)*) => {
        /// The reason why a call was refused.
        #[derive(Clone, Copy, PartialEq, Eq, Debug)]
        #[repr(i32)]
        pub enum Refusal { $(#[doc = $text] $name = $code,)* }

        /// The text of a code, which ends with a zero.
        fn words(code: c_int) -> &'static core::ffi::CStr {
            match code {
                OK => c"no error",
                $($code => const {
                    match core::ffi::CStr::from_bytes_with_nul(concat!($text, "\0").as_bytes()) {
                        Ok(words) => words,
                        Err(_) => panic!(),
                    }
                },)*
                _ => c"not an error code of mode13h",
            }
        }

        /// All codes, by name and number, for comparison with the header.
        pub const CODES: &[(&str, c_int)] = &[$((stringify!($name), $code),)*];
    };
}

codes! {
    Null = -1, "a pointer is null, but must not be";
    StructSize = -2, "the size of a struct is not set: call its m13_..._init";
    Side = -3, "each side of a frame must be 1 to 4,096 pixels";
    Pitch = -4, "the pitch is less than the width";
    Band = -5, "the band has no rows, or reaches beyond the frame";
    Short = -6, "there are fewer bytes than the rows need, or more than memory can hold";
    Depth = -7, "a depth buffer must have 16 or 32 bits, and a value for each pixel";
    Alignment = -8, "a depth buffer, a picture or memory is not aligned";
    Overlap = -9, "an input overlaps memory that is written";
    Index = -10, "an index refers to a vertex that does not exist";
    Count = -11, "triangles need a multiple of three vertices or indices";
    Layout = -12, "an attribute is missing, or does not fit into the stride";
    Value = -13, "a number is not one of the allowed values";
    Vertex = -14, "a vertex is not finite or out of range; other triangles were drawn";
    Context = -15, "this needs a context made by m13_init";
    Name = -16, "there is no palette of this name";
    Unsupported = -17, "this library was built without effects";
}

/// The result type used inside the library.
pub(crate) type Outcome<T = ()> = Result<T, Refusal>;

/// The code of an outcome.
pub(crate) fn code(outcome: Outcome) -> c_int {
    match outcome {
        Ok(()) => OK,
        Err(refusal) => refusal as c_int,
    }
}

/// The offset of an attribute that vertices lack.
pub const ABSENT: u32 = u32::MAX;

/// A frame to draw into.
#[derive(Clone, Copy, Debug)]
#[repr(C)]
#[allow(missing_docs, reason = "the header has them")]
pub struct Target {
    pub size: u32,
    pub width: u32,
    pub height: u32,
    pub first_row: u32,
    pub rows: u32,
    pub clip_x0: u32,
    pub clip_y0: u32,
    pub clip_x1: u32,
    pub clip_y1: u32,
    pub depth_bits: u32,
    pub pixels: *mut u8,
    pub pixel_bytes: usize,
    pub pitch: usize,
    pub depth: *mut c_void,
    pub depth_bytes: usize,
}

/// Vertices and indices, in the caller's memory.
#[derive(Clone, Copy, Debug)]
#[repr(C)]
#[allow(missing_docs, reason = "the header has them")]
pub struct Mesh {
    pub size: u32,
    pub vertex_count: u32,
    pub stride: u32,
    pub position: u32,
    pub depth: u32,
    pub shade: u32,
    pub texture: u32,
    pub fog: u32,
    pub slope: u32,
    pub homogeneous: u32,
    pub index_bits: u32,
    pub index_count: u32,
    pub near_w: f32,
    pub near_w_x: i32,
    pub vertices: *const c_void,
    pub indices: *const c_void,
}

/// How triangles are drawn.
#[derive(Clone, Copy, Debug)]
#[repr(C)]
#[allow(missing_docs, reason = "the header has them")]
pub struct Material {
    pub size: u32,
    pub shading: u32,
    pub color: u32,
    pub cull: u32,
    pub mapping: u32,
    pub dither: u32,
    pub keep_depth: u32,
    pub u_bits: u32,
    pub v_bits: u32,
    pub reserved: u32,
    pub texels: *const u8,
    pub shade_table: *const u8,
    pub slope_table: *const u8,
    pub fog_table: *const u8,
    pub blend_table: *const u8,
}

/// A corner in floats.
#[derive(Clone, Copy, Debug)]
#[repr(C)]
#[allow(missing_docs, reason = "the header has them")]
pub struct Vertex {
    pub x: f32,
    pub y: f32,
    pub depth: f32,
    pub shade: f32,
}

/// A corner in 16.16.
#[derive(Clone, Copy, Debug)]
#[repr(C)]
#[allow(missing_docs, reason = "the header has them")]
pub struct VertexX {
    pub x: i32,
    pub y: i32,
    pub depth: u32,
    pub shade: i32,
}

/// Counts of what was drawn.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
#[repr(C)]
#[allow(missing_docs, reason = "the header has them")]
pub struct Stats {
    pub size: u32,
    pub triangles: u32,
    pub refused: u32,
    pub spans: u32,
    pub covered: u32,
    pub pixels: u32,
}

/// A struct of the interface: plain numbers and pointers, which may all be zero, with its size first.
///
/// # Safety
/// The type is such a struct.
pub(crate) unsafe trait Sized32: Copy {
    /// The size that the first version of the struct had.
    const FIRST: usize = size_of::<Self>();
}

// SAFETY: only numbers and pointers, with the size first.
unsafe impl Sized32 for Target {}
// SAFETY: as above.
unsafe impl Sized32 for Mesh {}
// SAFETY: as above.
unsafe impl Sized32 for Material {}
// SAFETY: as above.
unsafe impl Sized32 for Stats {}

/// Reads a struct. A struct of a later version may be longer; the rest is then ignored.
///
/// # Safety
/// `from` is null or holds as many bytes as its size says.
pub(crate) unsafe fn read<T: Sized32>(from: *const T) -> Outcome<T> {
    if from.is_null() {
        return Err(Refusal::Null);
    }
    // SAFETY: the size is the first field.
    let size = unsafe { from.cast::<u32>().read_unaligned() } as usize;
    // A size above a page means that the field was never set.
    if size < T::FIRST || size > 4_096 {
        return Err(Refusal::StructSize);
    }
    // SAFETY: at least as long as the first version, which is this one.
    Ok(unsafe { from.read_unaligned() })
}

/// The library's version: major, minor and patch, eight bits each.
pub const VERSION: u32 = 0x00_01_00;

/// The version of the library.
#[unsafe(no_mangle)]
pub extern "C" fn m13_version() -> u32 {
    VERSION
}

/// The text of a code.
#[unsafe(no_mangle)]
pub extern "C" fn m13_message(code: c_int) -> *const c_char {
    words(code).as_ptr()
}

/// The name of the kernel that draws spans.
#[unsafe(no_mangle)]
pub extern "C" fn m13_kernel() -> *const c_char {
    let name = mode13h::span::Kernel::default().level();
    // Rust's names do not end with a zero, so they are listed here again as C strings.
    for known in [c"portable", c"x86-64", c"i686", c"arrays", c"sse2", c"neon", c"wasm", c"avx2", c"avx512"] {
        if known.to_bytes() == name.as_bytes() {
            return known.as_ptr();
        }
    }
    c"unknown".as_ptr()
}
