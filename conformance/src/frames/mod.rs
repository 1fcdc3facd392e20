//! Whole frames by name, each with its hash: what every processor and every kernel must draw.
//!
//! | names | what |
//! |---|---|
//! | `shape/…` | every shape with every shading, by floating point; some of them in 16.16 |
//! | `effect/…` | every effect with every shading, by changing hidden-surface methods |
//! | `mapping/…` | a floor by every mapping, seen from farther and farther: every mipmap level |
//! | `glass/…`, `fog/…`, `light/…`, `palette/…` | glass behind glass, fog of both signs, coloured lamps, dither, palettes without ramps |
//! | `budget/…` | five error budgets on six scenes |
//! | `near/…` | two tori through each other, through the near plane and beyond the guard band |
//! | `object/…` | parents, hidden objects, sizes, upward axes, materials that respond in their own way |
//! | `canvas/…` | a pitch wider than the frame, wide and tall frames, bands |
//! | `shipped/…` | the scenes that are compiled in, as [values](shipped) |
//!
//! The hashes stand in `expected.rs`, which is generated: `MODE13H_UPDATE=1 cargo test -p mode13h-conformance`. A change of a
//! hash is a change of what the engine draws.

mod expected;
mod list;
pub mod shipped;

use alloc::boxed::Box;
use alloc::string::String;
use alloc::vec;
use alloc::vec::Vec;
use core::fmt;

use mode13h::palette::{BIOS, Palette};
use mode13h::raster::Frame as Canvas;
use mode13h::render::{RenderError, Renderer};
use mode13h::scene::Scene;
use mode13h::settings::Settings;
use mode13h::span::Kernel;
use mode13h::vga::Vga;

use crate::hash::{START, fnv_1a};

/// The target of a frame.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Shape {
    /// The machine: 320 × 200, with its DAC.
    Vga,
    /// A frame of any size with square pixels, with a pitch, drawn in bands.
    Canvas {
        /// Columns.
        width: u32,
        /// Rows.
        height: u32,
        /// Bytes from a row to the next.
        pitch: usize,
        /// Rows of a band; `height` for the whole frame at once.
        band: u32,
    },
}

/// A scene and how it is drawn.
#[derive(Clone, Debug)]
pub struct Picture {
    /// The scene.
    pub scene: Scene,
    /// The renderer's settings.
    pub settings: Settings,
    /// The target.
    pub shape: Shape,
}

/// One frame of the list. Its scene is made when it is drawn.
pub struct Frame {
    /// Its name, such as `effect/fog/phong/painter`.
    pub name: String,
    make: Box<dyn Fn() -> Picture>,
}

impl fmt::Debug for Frame {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Frame").field("name", &self.name).finish_non_exhaustive()
    }
}

/// A frame as drawn.
#[derive(Clone, PartialEq, Debug)]
pub struct Drawn {
    /// Columns.
    pub width: u32,
    /// Rows.
    pub height: u32,
    /// The pixels, row after row, `width` bytes each.
    pub pixels: Vec<u8>,
    /// The colours that the machine shows.
    pub palette: Palette,
    /// The hash of the pixels, the bytes between the rows, and the colours: FNV-1a of 64 bits, its halves combined by
    /// exclusive or.
    pub hash: u32,
}

/// A pixel in which two drawings of a frame differ.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct Difference {
    /// Its column.
    pub x: u32,
    /// Its row.
    pub y: u32,
    /// The byte there.
    pub is: u8,
    /// The byte that should be there.
    pub should: u8,
    /// How many pixels differ in all.
    pub pixels: u32,
}

impl fmt::Display for Difference {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { x, y, is, should, pixels } = self;
        write!(f, "pixel ({x}, {y}) is {is:#04x}, not {should:#04x}; {pixels} differ")
    }
}

/// The byte that a frame holds before it is drawn. Those between the rows must stay.
const BEFORE: u8 = 0xA5;

impl Frame {
    fn new(name: String, make: impl Fn() -> Picture + 'static) -> Self {
        Self { name, make: Box::new(make) }
    }

    /// The scene, and how it is drawn.
    #[must_use]
    pub fn picture(&self) -> Picture {
        (self.make)()
    }

    /// The [hash](Drawn::hash) on every machine; `None` for a frame that is new and has none yet.
    #[must_use]
    pub fn expected(&self) -> Option<u32> {
        expected::EXPECTED.iter().find(|(name, _)| *name == self.name).map(|(_, hash)| *hash)
    }

    /// Draws the frame by a new renderer.
    ///
    /// # Errors
    /// [`Renderer::draw`] lists them; these scenes have none, unless the engine is broken.
    pub fn draw(&self, kernel: Kernel) -> Result<Drawn, RenderError> {
        self.draw_by(&mut Renderer::new(), kernel)
    }

    /// Draws the frame by a renderer that may have drawn others, which changes nothing but the time it takes.
    ///
    /// # Errors
    /// See [`draw`](Self::draw).
    pub fn draw_by(&self, renderer: &mut Renderer, kernel: Kernel) -> Result<Drawn, RenderError> {
        let Picture { scene, settings, shape } = self.picture();
        renderer.settings = settings;
        renderer.kernel = kernel;
        let (width, height, pitch, bytes, palette) = match shape {
            Shape::Vga => {
                let mut vga = Box::<Vga>::default();
                renderer.draw(&scene, &mut vga)?;
                (320, 200, 320, vga.pixels().to_vec(), vga.palette())
            }
            Shape::Canvas { width, height, pitch, band } => {
                let mut bytes = vec![BEFORE; pitch * height as usize];
                if let Ok(mut whole) = Canvas::new(&mut bytes, width, height, pitch) {
                    for part in whole.bands(band) {
                        renderer.draw_frame(&scene, part, (1, 1))?;
                    }
                }
                (width, height, pitch, bytes, scene.palette.clone().unwrap_or(BIOS))
            }
        };
        let mut hash = fnv_1a(START, &bytes);
        for color in palette.colors() {
            hash = fnv_1a(hash, &[color.r, color.g, color.b]);
        }
        let pixels = bytes.chunks(pitch).flat_map(|row| &row[..width as usize]).copied().collect();
        Ok(Drawn { width, height, pixels, palette, hash: (hash ^ (hash >> 32)) as u32 })
    }
}

impl Drawn {
    /// The first pixel that is not as in `right`, row by row; `None` if all are equal, or the sizes differ.
    #[must_use]
    pub fn difference(&self, right: &Self) -> Option<Difference> {
        if (self.width, self.height) != (right.width, right.height) {
            return None;
        }
        let differ = |(is, should): &(&u8, &u8)| is != should;
        let at = self.pixels.iter().zip(&right.pixels).position(|pair| differ(&pair))?;
        let pixels = self.pixels.iter().zip(&right.pixels).filter(differ).count() as u32;
        let (x, y) = (at as u32 % self.width, at as u32 / self.width);
        Some(Difference { x, y, is: self.pixels[at], should: right.pixels[at], pixels })
    }
}

/// Every frame, in the order of the hashes.
#[must_use]
pub fn all() -> Vec<Frame> {
    list::all()
}

/// One hash for some frames in their order, from that of the frames before; begin with [`START`].
#[must_use]
pub fn combined(before: u64, drawn: &Drawn) -> u64 {
    combined_hash(before, drawn.hash)
}

/// [`combined`], of a frame's [hash](Drawn::hash).
#[must_use]
pub fn combined_hash(before: u64, hash: u32) -> u64 {
    fnv_1a(before, &hash.to_le_bytes())
}
