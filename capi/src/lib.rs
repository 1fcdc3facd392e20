//! The rasterizer of `mode13h` for C. `include/mode13h.h` is the documentation: it says what each function here takes,
//! does and returns. `capi/build` makes the libraries, `capi/check` tests them.
//!
//! | module | holds |
//! |---|---|
//! | `abi` | codes, structs, and how a struct of another version is read |
//! | `target` | the frame, its band, clip rectangle and depth buffer, checked at each call |
//! | `corner` | from the caller's vertices to the rasterizer's, in floats and in 16.16 |
//! | `clip` | the near plane and the guard band |
//! | `draw` | triangles and lists of them |
//! | `effects` | textures, light by a table, fog and translucency |
//! | `color` | palettes, tables of 64 KiB, conversion for the screen |
//! | `memory` | an allocator in the caller's memory, and the panic handler |
//!
//! Arguments are checked before anything is written. Structs, vertices and indices are read by value, unaligned, and may
//! overlap anything except the memory that is written; tables and texels are read through references. Any that overlap
//! the pixels, the depths or the context are rejected.
#![no_std]

#[cfg(feature = "std")]
extern crate std;

pub mod abi;
mod clip;
pub mod color;
mod corner;
pub mod draw;
#[cfg(feature = "effects")]
mod effects;
#[cfg(feature = "library")]
mod memory;
pub mod target;
