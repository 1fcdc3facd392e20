//! Whole frames by name, each with its hash: what every processor and every kernel must draw.
//!
//! | names | what |
//! |---|---|
//! | `shape/…` | every shape with every shading, in floating point; some of them in 16.16 |
//! | `effect/…` | every effect with every shading, with alternating hidden-surface methods |
//! | `mapping/…` | a floor with every mapping, seen from farther and farther away: every mipmap level |
//! | `glass/…`, `fog/…`, `light/…`, `palette/…` | glass behind glass, fog of both signs, coloured lamps, dither, palettes without ramps |
//! | `budget/…` | five error budgets on six scenes |
//! | `near/…` | two interpenetrating tori, through the near plane and beyond the guard band |
//! | `object/…` | parents, hidden objects, sizes, upward axes, materials that respond in their own way |
//! | `canvas/…` | a pitch wider than the frame, wide and tall frames, bands |
//! | `shipped/…` | the shipped scenes, as [values](shipped) |
//!
//! The hashes are in `expected.txt`, which is generated: `MODE13H_UPDATE=1 cargo test -p mode13h-conformance`. If a hash
//! changes, what the engine draws has changed.

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
    /// The VGA: 320 × 200, with its DAC.
    Vga,
    /// A frame of any size with square pixels and any pitch, drawn in bands.
    Canvas {
        /// Number of columns.
        width: u32,
        /// Number of rows.
        height: u32,
        /// Bytes from one row to the next.
        pitch: usize,
        /// Rows per band; `height` for the whole frame at once.
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

/// One frame of the list. Its scene is built when it is drawn.
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

/// A drawn frame.
#[derive(Clone, PartialEq, Debug)]
pub struct Drawn {
    /// Number of columns.
    pub width: u32,
    /// Number of rows.
    pub height: u32,
    /// The pixels, row after row, `width` bytes each.
    pub pixels: Vec<u8>,
    /// The colours that the DAC shows.
    pub palette: Palette,
    /// Hash of the pixels, the padding between rows, and the colours: 64-bit FNV-1a, its halves combined by exclusive
    /// or.
    pub hash: u32,
}

/// A pixel at which two drawings of a frame differ.
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
    /// Number of pixels that differ in total.
    pub pixels: u32,
}

impl fmt::Display for Difference {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { x, y, is, should, pixels } = self;
        write!(f, "pixel ({x}, {y}) is {is:#04x}, not {should:#04x}; {pixels} differ")
    }
}

/// Value of a frame's bytes before it is drawn. Padding between rows must keep it.
const BEFORE: u8 = 0xA5;

impl Frame {
    fn new(name: String, make: impl Fn() -> Picture + 'static) -> Self {
        Self { name, make: Box::new(make) }
    }

    /// The scene and how it is drawn.
    #[must_use]
    pub fn picture(&self) -> Picture {
        (self.make)()
    }

    /// The [hash](Drawn::hash) on every machine; `None` for a new frame that has none yet.
    #[must_use]
    pub fn expected(&self) -> Option<u32> {
        let mut lines = include_str!("expected.txt").lines();
        let hash = lines.find_map(|line| line.strip_prefix(&*self.name)?.strip_prefix(" 0x"))?;
        u32::from_str_radix(hash, 16).ok()
    }

    /// Draws the frame with a new renderer.
    ///
    /// # Errors
    /// See [`Renderer::draw`]; these scenes cause none, unless the engine is broken.
    pub fn draw(&self, kernel: Kernel) -> Result<Drawn, RenderError> {
        self.draw_by(&mut Renderer::new(), kernel)
    }

    /// Draws the frame with a renderer that may have drawn others, which affects nothing but the time.
    ///
    /// # Errors
    /// See [`draw`](Self::draw).
    pub fn draw_by(&self, renderer: &mut Renderer, kernel: Kernel) -> Result<Drawn, RenderError> {
        self.picture().draw_by(renderer, kernel)
    }
}

impl Picture {
    /// Draws the picture with a renderer that may have drawn others, which affects nothing but the time.
    ///
    /// # Errors
    /// See [`Renderer::draw`]; the scenes of [`all`] cause none, unless the engine is broken.
    pub fn draw_by(&self, renderer: &mut Renderer, kernel: Kernel) -> Result<Drawn, RenderError> {
        let Self { scene, settings, shape } = self;
        renderer.settings = *settings;
        renderer.kernel = kernel;
        let (width, height, pitch, bytes, palette) = match *shape {
            Shape::Vga => {
                let mut vga = Box::<Vga>::default();
                renderer.draw(scene, &mut vga)?;
                (320, 200, 320, vga.pixels().to_vec(), vga.palette())
            }
            Shape::Canvas { width, height, pitch, band } => {
                let mut bytes = vec![BEFORE; pitch * height as usize];
                if let Ok(mut whole) = Canvas::new(&mut bytes, width, height, pitch) {
                    for part in whole.bands(band) {
                        renderer.draw_frame(scene, part, (1, 1))?;
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
    /// The first pixel, row by row, that differs from `right`; `None` if all are equal, or the sizes differ.
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

/// Combines the hashes of frames, in order, with the hash of the frames before them; start with [`START`].
#[must_use]
pub fn combined(before: u64, drawn: &Drawn) -> u64 {
    combined_hash(before, drawn.hash)
}

/// Combines a single frame's [hash](Drawn::hash), as [`combined`] does.
#[must_use]
pub fn combined_hash(before: u64, hash: u32) -> u64 {
    fnv_1a(before, &hash.to_le_bytes())
}
