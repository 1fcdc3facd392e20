//! A software 3-D engine that draws the way a 386 with a VGA card did.
#![cfg_attr(not(feature = "std"), no_std)]
#![cfg_attr(docsrs, feature(doc_cfg))]
#![cfg_attr(not(any(feature = "asm", feature = "simd")), forbid(unsafe_code))]
#![cfg_attr(any(feature = "asm", feature = "simd"), deny(unsafe_code))]

#[cfg(feature = "alloc")]
extern crate alloc;

#[cfg(feature = "alloc")]
pub use glam;

pub mod fixed;
pub mod integer;
pub mod palette;
pub mod raster;
pub mod span;
pub mod vga;

#[cfg(feature = "alloc")]
pub mod light;
#[cfg(feature = "alloc")]
pub mod mesh;
#[cfg(feature = "alloc")]
pub mod render;
#[cfg(feature = "alloc")]
pub mod scene;

#[cfg(feature = "std")]
pub mod export;
#[cfg(feature = "std")]
pub mod verify;
#[cfg(feature = "window")]
pub mod window;
