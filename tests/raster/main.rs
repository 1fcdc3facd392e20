//! The machine and the raster: exact cover, shades, depth, batches, effects.

#[path = "../support/mod.rs"]
mod support;

#[cfg(feature = "alloc")]
mod batch;
mod chip_frame;
#[cfg(feature = "alloc")]
mod effects;
#[cfg(feature = "alloc")]
mod hidden_surfaces;
mod machine;
mod patterns;
#[cfg(feature = "alloc")]
mod shared_edges;
mod triangles;
mod vertex_rounding;
mod vintage;
