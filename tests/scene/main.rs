//! Meshes, textures, palettes and exported pictures.

#[path = "../support/mod.rs"]
mod support;

#[cfg(feature = "png")]
mod export;
#[cfg(feature = "alloc")]
mod mesh_normals;
#[cfg(feature = "alloc")]
mod mesh_parts;
#[cfg(feature = "alloc")]
mod mesh_shapes;
#[cfg(feature = "alloc")]
mod palette_tables;
#[cfg(feature = "alloc")]
mod texture;
