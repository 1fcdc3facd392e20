//! Meshes, models, textures, palettes, scene files and exported pictures.

#[path = "../support/mod.rs"]
mod support;

#[cfg(feature = "alloc")]
mod errors;
#[cfg(feature = "png")]
mod export;
#[cfg(feature = "gif")]
mod gif;
#[cfg(feature = "alloc")]
mod mesh_normals;
#[cfg(feature = "alloc")]
mod mesh_shapes;
#[cfg(all(feature = "obj", feature = "png"))]
mod models;
#[cfg(feature = "obj")]
mod obj_files;
#[cfg(feature = "alloc")]
mod palette_auto;
mod palette_files;
#[cfg(feature = "alloc")]
mod palette_scenes;
#[cfg(feature = "alloc")]
mod palette_tables;
#[cfg(feature = "scene-files")]
mod scene_files;
#[cfg(all(feature = "scene-files", feature = "png"))]
mod shipped_scenes;
#[cfg(all(feature = "obj", feature = "png"))]
mod studio;
#[cfg(feature = "alloc")]
mod texture;
