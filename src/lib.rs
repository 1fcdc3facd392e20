//! A software 3-D engine that draws the way a 386 with a VGA card did in 1994: a frame of 320 × 200 bytes, a palette of
//! 256 colours, fixed-point arithmetic, and one inner loop, `mov [edi],ah` / `inc edi` / `add ax,bx` / `dec cx` /
//! `jnz`.
//!
//! The modules, lowest layer first: each uses only those listed before it, except that a few small types are re-exported
//! from a later module.
//!
//! | module | holds | needs |
//! |---|---|---|
//! | [`fixed`] | the number types: 8.8 shades, 24.8 screen coordinates, 16.16; every rounding by name | – |
//! | [`palette`] | 256 colours, ramps of shades, nearest entries | – |
//! | [`vga`] | the machine: video memory, DAC, ports, timing, scan-out | – |
//! | [`span`] | the loop, and its assembly and vector versions, which draw the same bytes | – |
//! | [`texture`] | 8-bit texels with colours of their own: from pictures, or built in | `alloc` |
//! | [`raster`] | triangles: exact coverage, shades in range, depth, clip rectangles, bands; textures and other effects | –, effects `alloc` |
//! | [`settings`] | how to draw: shadings, error budgets, hidden-surface methods | `Shading` –, the rest `alloc` |
//! | [`integer`] | the vertex path in 16.16: transform, light and clipping without a float | – |
//! | [`mesh`] | vertices, faces, normals; shapes | `alloc` |
//! | [`light`] | suns and lamps, materials, the intensity at a point | `alloc` |
//! | [`scene`] | objects, camera, lights, fog, motion, preferences | `alloc` |
//! | [`plan`] | decides which effects a scene calls for, and why | `alloc` |
//! | [`render`] | draws a scene: vertices, clipping, faces, the raster; counts of the work | `alloc` |
//! | [`export`] | indexed PNG, RGB pictures; files that are never half-written | `std` |
#![cfg_attr(feature = "window", doc = "| [`window`] | the frame loop of a game: [`window::run`] | `window` |")]
#![cfg_attr(not(feature = "window"), doc = "| `window` | the frame loop of a game: `window::run` | `window` |")]
//!
#![cfg_attr(feature = "png", doc = "```no_run")]
#![cfg_attr(not(feature = "png"), doc = "```ignore")]
//! # fn main() -> Result<(), Box<dyn std::error::Error>> {
//! use mode13h::Angle;
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
//! scene[ship].rotate_y(Angle::from_degrees(1.0));
//! renderer.draw(&scene, &mut vga)?;
//! export::png(&vga, "torus.png")?;
//! # Ok(())
//! # }
//! ```
//!
//! # Angles, positions and colours
//!
//! Each of these has one type. An angle is an `Angle` everywhere except on the 16.16 path, where it
//! is an [`integer::BinaryAngle`]. A position or a direction is a `glam::Vec3`, and most functions
//! take anything that converts to one, such as `[0.0, 1.0, 0.0]`. A colour in a palette, a picture or
//! fog is an [`Rgb`](palette::Rgb) of three bytes. The colour of a light or a surface is
//! `[f32; 3]`: red, green and blue, usually 0 to 1. An `Rgb` converts to one with `into`.
//!
//! # Features
//!
//! The default features are `std`, `asm` and `simd` (fast spans; without either, the crate forbids `unsafe` code), and
//! `png`. `window` and `embedded-graphics` (text and shapes on a frame) are optional. The crate `mode13h-assets` reads
//! files. Without any feature, `fixed`, `palette`, `vga`, `span`, `raster`, `integer` and the list of shadings remain,
//! which need neither `std` nor an allocator; `alloc` adds the engine. The feature `internals` opens the engine's
//! internals to the lab, the conformance crate, tests and benchmarks; they may change in any version.
#![cfg_attr(not(feature = "std"), no_std)]
#![cfg_attr(docsrs, feature(doc_cfg))]
#![cfg_attr(not(any(feature = "asm", feature = "simd")), forbid(unsafe_code))]
#![cfg_attr(any(feature = "asm", feature = "simd"), deny(unsafe_code))]
// Some items are only used by `internals`.
#![cfg_attr(not(feature = "internals"), allow(dead_code, unused_imports, unreachable_pub))]

#[cfg(feature = "alloc")]
extern crate alloc;

#[cfg(feature = "embedded-graphics")]
pub use embedded_graphics;
#[cfg(feature = "alloc")]
pub use glam;

/// Makes a function public with `internals`, and otherwise private to the crate.
macro_rules! internal {
    ($(#[$meta:meta])* fn $($rest:tt)*) => {
        #[cfg(feature = "internals")]
        $(#[$meta])*
        pub fn $($rest)*
        #[cfg(not(feature = "internals"))]
        $(#[$meta])*
        pub(crate) fn $($rest)*
    };
    ($(#[$meta:meta])* const fn $($rest:tt)*) => {
        #[cfg(feature = "internals")]
        $(#[$meta])*
        pub const fn $($rest)*
        #[cfg(not(feature = "internals"))]
        $(#[$meta])*
        pub(crate) const fn $($rest)*
    };
}

pub mod fixed;
pub mod integer;
mod lanes;
pub mod palette;
pub mod raster;
mod simd;
pub mod span;
pub mod vga;

#[cfg(feature = "alloc")]
mod angle;
mod errors;
#[cfg(feature = "alloc")]
mod mapping;
mod names;

#[cfg(feature = "alloc")]
pub use angle::Angle;
pub use names::UnknownName;

#[cfg(feature = "internals")]
pub mod internals;
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
pub mod settings;
#[cfg(feature = "alloc")]
mod shared;
#[cfg(feature = "alloc")]
pub mod texture;
#[cfg(feature = "alloc")]
mod view;

#[cfg(feature = "std")]
pub mod export;
#[cfg(feature = "window")]
pub mod window;

// The random number generator of all tests, included as a file: linking its crate into unit tests
// would link the assembly twice.
#[path = "../conformance/src/hash.rs"]
#[cfg(test)]
#[expect(unreachable_pub, reason = "public in a crate of its own")]
mod hash;
#[path = "../conformance/src/random.rs"]
#[cfg(test)]
#[expect(dead_code, unreachable_pub, reason = "public in a crate of its own, of which unit tests use a part")]
mod random;
