//! A software 3-D engine that draws the way a 386 with a VGA card did in 1994: a frame of
//! 320 × 200 bytes, a palette of 256 colours, fixed-point arithmetic, and one inner loop,
//! `mov [edi],ah` / `inc edi` / `add ax,bx` / `dec cx` / `jnz`.
//!
//! The stages, from the bottom up. A module uses those above it in this list, never those below.
//!
//! | module | holds | needs |
//! |---|---|---|
//! | [`fixed`] | the number types: 8.8 shades, 24.8 screen coordinates, 16.16; every rounding by name | – |
//! | [`lanes`] | eight numbers at a time | – |
//! | `simd` | what the processor has, as values | – |
//! | [`palette`] | 256 colours, ramps of shades, file formats | – |
//! | [`vga`] | the machine: video memory, DAC, ports, timing, scan-out | – |
//! | [`span`] | the loop, and its twins in assembly and vectors that give the same bytes | – |
//! | [`texture`] | 8-bit texels with colours of their own: from pictures, from files, compiled in | `alloc` |
//! | [`raster`] | triangles: exact cover, shades in range, depth, clip rectangles, bands | – |
//! | [`integer`] | the vertex path in 16.16: transform, light and clipping without a float | – |
//! | [`mesh`] | vertices, faces, normals; shapes; OBJ models | `alloc` |
//! | [`light`] | suns and lamps, materials, the intensity at a point | `alloc` |
//! | [`scene`] | objects, camera, lights, fog, motion, what is asked for | `alloc` |
//! | [`plan`] | from a scene to the effects it calls for, each with its reason | `alloc` |
//! | [`render`] | a scene to a frame: vertices, clipping, faces, the raster; counts of the work | `alloc` |
//! | [`auto_palette`] | a palette for a scene, from what is seen of it over a round | `alloc` |
//! | [`export`] | indexed PNG, RGB pictures, GIF films; files that are never half-written | `std` |
//! | `model` | a model file as a scene: mesh, textures, palette, framing | `obj`, `png` |
//! | [`window`] | a whole game's frame: [`window::run`] | `window` |
//!
#![cfg_attr(feature = "png", doc = "```no_run")]
#![cfg_attr(not(feature = "png"), doc = "```ignore")]
//! # fn main() -> Result<(), Box<dyn std::error::Error>> {
//! use mode13h::export;
//! use mode13h::light::Light;
//! use mode13h::mesh::shapes;
//! use mode13h::render::Renderer;
//! use mode13h::scene::{Object, Scene};
//! use mode13h::vga::Vga;
//!
//! let mut scene = Scene::new();
//! let ship = scene.add(Object::new(shapes::torus(48, 24)));
//! scene.add_light(Light::sun([0.4, 0.6, 1.0]));
//! let mut renderer = Renderer::new();
//! let mut vga = Vga::new();
//! scene[ship].rotate_y(0.02);
//! renderer.draw(&scene, &mut vga)?;
//! export::png(&vga, "torus.png")?;
//! # Ok(())
//! # }
//! ```
//!
//! # Features
//!
//! The default features are what a game needs: `std`, `asm` and `simd` (fast spans; without both the crate forbids
//! `unsafe` code), `png` and `obj`. `window`, `gif`, `scene-files` and `embedded-graphics` (text and shapes on a frame)
//! are added by name. With no feature at all `fixed`, `palette`, `vga`, `span`, `raster` and `integer` remain, which need
//! neither `std` nor an allocator; `alloc` adds the engine.
#![cfg_attr(not(feature = "std"), no_std)]
#![cfg_attr(docsrs, feature(doc_cfg))]
#![cfg_attr(not(any(feature = "asm", feature = "simd")), forbid(unsafe_code))]
#![cfg_attr(any(feature = "asm", feature = "simd"), deny(unsafe_code))]

#[cfg(feature = "alloc")]
extern crate alloc;

#[cfg(feature = "alloc")]
pub use glam;

pub mod fixed;
pub mod integer;
pub mod lanes;
pub mod palette;
pub mod raster;
mod simd;
pub mod span;
pub mod vga;

#[cfg(feature = "alloc")]
pub mod auto_palette;
#[cfg(feature = "alloc")]
pub mod hooks;
#[cfg(feature = "alloc")]
pub mod light;
#[cfg(feature = "alloc")]
pub mod mesh;
#[cfg(feature = "alloc")]
pub mod plan;
#[cfg(feature = "alloc")]
pub mod render;
#[cfg(feature = "alloc")]
pub mod scene;
#[cfg(feature = "alloc")]
mod shared;
#[cfg(feature = "alloc")]
pub mod texture;
#[cfg(feature = "alloc")]
mod view;

#[cfg(feature = "std")]
pub mod export;
#[cfg(all(feature = "obj", feature = "png"))]
pub mod model;
#[cfg(feature = "window")]
pub mod window;
