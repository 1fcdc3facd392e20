//! Files for the engine [`mode13h`]: what a game loads, and what a program writes.
//!
//! | module | holds |
//! |---|---|
//! | [`scene_file`] | scenes in TOML: camera, shapes, models, materials, lights, fog, motion |
//! | [`shipped`] | the built-in scenes |
//! | [`model_file`] | meshes from files in any supported format |
//! | [`model`] | a model file as a scene: mesh, textures, light, palette, framing |
//! | [`texture`] | textures from pictures: PNG, GIF, PCX, indexed Aseprite, and with the feature `images` JPEG, TGA, BMP and WebP |
//! | [`palette_file`] | palettes in JASC, GIMP, Adobe, Lospec and raw VGA files |
//! | [`auto_palette`] | a palette for a scene, from what is visible of it over one loop |
//! | [`look`] | the looks of old machines: palette, dither, mapping and vertices under one name |
//! | [`animation`] | animated GIF and PNG, and Y4M for other programs |
//! | [`terminal`] | pictures as sixels, and in kitty's graphics protocol |
//!
//! [`SceneExt`] adds methods that read files to [`Scene`](mode13h::scene::Scene).
//!
//! Without the default feature `std` there is only [`auto_palette`], which needs nothing but an allocator.
#![cfg_attr(not(feature = "std"), no_std)]
#![forbid(unsafe_code)]

extern crate alloc;

#[cfg(feature = "std")]
pub mod animation;
pub mod auto_palette;
#[cfg(feature = "std")]
mod errors;
#[cfg(feature = "std")]
pub mod look;
#[cfg(feature = "std")]
pub mod model;
#[cfg(feature = "std")]
pub mod model_file;
#[cfg(feature = "std")]
pub mod palette_file;
#[cfg(feature = "std")]
mod scene_ext;
#[cfg(feature = "std")]
pub mod scene_file;
#[cfg(feature = "std")]
pub mod shipped;
#[cfg(feature = "std")]
pub mod terminal;
#[cfg(feature = "std")]
pub mod texture;
#[cfg(feature = "std")]
mod wide;

#[cfg(feature = "std")]
pub use scene_ext::SceneExt;
