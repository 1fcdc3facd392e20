//! What several test files share.
#![expect(dead_code, unreachable_pub, reason = "each test program uses its part")]

pub mod display;
#[cfg(feature = "png")]
pub mod golden;
#[cfg(feature = "alloc")]
pub mod judged;
#[cfg(feature = "alloc")]
pub mod odd_views;
#[cfg(feature = "png")]
pub mod picture;
pub mod property;
#[cfg(feature = "alloc")]
pub mod scenes;
pub mod shipped;
pub mod triangles;
pub mod tried;
#[cfg(feature = "alloc")]
pub mod vector;
pub mod workspace;
