//! The promise "exact, and the same bytes on every processor" as code and data.
//!
//! | module | what it holds |
//! |---|---|
//! | [`frames`] | whole frames by name, each with its hash: every shading, effect, mapping, hidden-surface method, error budget and frame shape |
//! | [`loops`] | every pixel loop against its definition, at random lengths and alignments |
//! | [`oracle`] | which pixels a triangle covers and with which bytes, in 128-bit integers |
//! | [`random`] | the random generator of all tests |
//! | [`hash`] | FNV-1a |
//!
//! Used by the tests, `mode13h verify`, the programs in `machines/`, the web page, the fuzz targets and the benchmarks.
//! It needs an allocator but no operating system.
#![cfg_attr(not(feature = "std"), no_std)]
#![forbid(unsafe_code)]

extern crate alloc;

#[cfg(feature = "frames")]
pub mod frames;
pub mod hash;
pub mod loops;
pub mod oracle;
pub mod random;

pub use random::Random;
