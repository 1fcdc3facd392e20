//! The renderer: golden frames, clipping, hidden surfaces, the integer path, the plan.

#[path = "../support/mod.rs"]
mod support;

mod allocation;
#[cfg(feature = "alloc")]
mod clipping;
#[cfg(feature = "alloc")]
mod floor;
#[cfg(feature = "alloc")]
mod frames;
#[cfg(feature = "png")]
mod golden;
mod hard_cases;
#[cfg(feature = "alloc")]
mod hidden_scenes;
#[cfg(feature = "alloc")]
mod integer_frames;
#[cfg(feature = "alloc")]
mod integer_path;
#[cfg(feature = "alloc")]
mod near_plane;
#[cfg(feature = "alloc")]
mod objects;
mod on_screen;
#[cfg(feature = "alloc")]
mod plan;
#[cfg(feature = "alloc")]
mod tessellation;
#[cfg(feature = "alloc")]
mod vertex_bits;
