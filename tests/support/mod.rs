//! What several test files share.
#![expect(dead_code, unreachable_pub, reason = "each test file is a program of its own and uses its part")]

pub mod display;
#[cfg(feature = "gif")]
pub mod film;
#[cfg(feature = "png")]
pub mod golden;
#[cfg(feature = "alloc")]
pub mod judged;
pub mod naive_span;
#[cfg(feature = "alloc")]
pub mod near_plane;
#[cfg(feature = "alloc")]
pub mod odd_views;
pub mod oracle;
pub mod property;
pub mod random;
#[cfg(feature = "alloc")]
pub mod scenes;
pub mod triangles;
pub mod tried;
