//! Models, textures, palettes, scenes and animations: what is read from files and written to them.

mod support;

mod broken_models;
mod errors;
mod gif;
mod gltf_files;
mod gltf_motion;
mod model_files;
mod models;
mod obj_files;
mod palette_auto;
mod palette_files;
mod palette_scenes;
mod scene_files;
mod shipped_scenes;
mod studio;
mod texture_files;
