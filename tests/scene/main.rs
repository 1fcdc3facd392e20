//! Meshes, models, textures, palettes, scene files and exported pictures.

#[path = "../support/mod.rs"]
mod support;

#[cfg(feature = "alloc")]
mod errors;
#[cfg(feature = "png")]
mod export;
mod gif;
mod gltf_files;
mod gltf_motion;
#[cfg(feature = "alloc")]
mod mesh_normals;
#[cfg(feature = "alloc")]
mod mesh_parts;
#[cfg(feature = "alloc")]
mod mesh_shapes;
mod model_files;
mod models;
mod obj_files;
#[cfg(feature = "alloc")]
mod palette_auto;
mod palette_files;
#[cfg(feature = "alloc")]
mod palette_scenes;
#[cfg(feature = "alloc")]
mod palette_tables;
mod scene_files;
mod shipped_scenes;
mod studio;
#[cfg(feature = "alloc")]
mod texture;
