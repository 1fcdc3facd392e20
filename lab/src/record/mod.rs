//! A frame's triangles in a file, exactly as the raster gets them: a bug report is then one file.
//!
//! The renderer's floats have done their work by then, so that what is drawn from a record is the
//! same on every machine, or the raster is wrong; [`replay`](crate::replay::replay) looks.
//!
//! # The file
//!
//! Lines of text, ended by LF or CR LF, in this order. Blanks before and after a line don't count,
//! nor do empty lines and those that begin with `#`. All numbers are integers.
//!
//! ```text
//! mode13h record 1                          what it is, and the version of the format
//! frame 320 200                             columns, rows: 1 to 4,096 each
//! clip 10 20 300 180                        x0 y0 x1 y1, inside the frame; may be missing
//! background 0                              the index that the frame is cleared to
//! hidden-surfaces depth-buffer              how the renderer left out hidden surfaces
//! palette 4                                 how many equal ramps; may be missing, with its colours
//! 000000 040404 080808 0c0c0c …             32 lines of 8 colours, rrggbb
//! triangles                                 in the order in which they are handed to the raster
//! flat 12  1024 512 0 900  …                shading and its byte, then three times: x, y, shade, depth
//! gouraud  1024 512 65280 900  …            the others have no byte
//! end
//! ```
//!
//! The shadings are those of [`Interpolation`], by [`name`](Interpolation::name): `flat`, `gouraud-vintage`, `gouraud`,
//! `gouraud-reseeded`, `gouraud-16.16`, `gouraud-hyperbolic`, `float`.
//!
//! x and y are in 1/256 pixel, to the right and down; a shade is 8.8; a depth is a u32, greater is
//! nearer: what [`Vertex::new`] takes, with its limits. A file without `end` is broken off, and
//! refused.

mod error;
mod read;
mod run;
mod write;

use std::fs::File;
use std::io::{self, BufReader};
use std::path::Path;

pub use error::{RecordError, RecordErrorKind};
pub use run::Run;

use mode13h::export::{ExportError, write_atomically};
use mode13h::palette::Palette;
use mode13h::plan::Effect;
use mode13h::raster::{Frame, Interpolation, RasterError, Rect, Vertex};
use mode13h::render::{RenderError, Renderer, Screen};
use mode13h::scene::Scene;
use mode13h::settings::HiddenSurfaces;

/// The version of the format.
pub const VERSION: u32 = 1;

/// Everything that the raster needs to draw a frame.
///
/// ```
/// use mode13h::mesh::shapes;
/// use mode13h_lab::record::Record;
/// use mode13h::render::{Renderer, Screen};
/// use mode13h::scene::Scene;
///
/// let scene = Scene::showing(shapes::cube());
/// let record = Record::of_scene(&mut Renderer::new(), &scene, Screen::MODE_13H)?;
/// let mut file = Vec::new();
/// record.write(&mut file)?;
/// assert!(file.starts_with(b"mode13h record 1\n"));
/// assert_eq!(Record::read(&file[..])?, record);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct Record {
    width: u32,
    height: u32,
    clip: Option<Rect>,
    /// The index that the frame is cleared to.
    pub background: u8,
    /// Method of the renderer for hidden surfaces.
    pub hidden_surfaces: HiddenSurfaces,
    /// Palette of the DAC, if it was set.
    pub palette: Option<Palette>,
    /// The triangles, in the order in which they are handed to the raster.
    pub triangles: Vec<([Vertex; 3], Interpolation)>,
}

impl Record {
    /// A frame of `width × height` pixels without triangles, clip rectangle or palette.
    ///
    /// # Errors
    /// A side of 0 or above 4,096.
    pub fn new(width: u32, height: u32) -> Result<Self, RasterError> {
        let side = 1..=Frame::MAX_SIDE;
        if !side.contains(&width) || !side.contains(&height) {
            return Err(RasterError::Size { width, height });
        }
        Ok(Self {
            width,
            height,
            clip: None,
            background: 0,
            hidden_surfaces: HiddenSurfaces::DepthBuffer,
            palette: None,
            triangles: Vec::new(),
        })
    }

    /// The frame that `renderer` makes of `scene`.
    ///
    /// # Errors
    /// As [`Renderer::draw`]. A record holds positions, shades and depths: a scene whose pixels pass through
    /// more (textures, fog, light at every pixel) is refused, by the first object that calls for it. A screen whose sides are no frame's counts as the camera's error.
    pub fn of_scene(renderer: &mut Renderer, scene: &Scene, screen: Screen) -> Result<Self, RenderError> {
        let mut record = Self::new(screen.width, screen.height)
            .map_err(|_| RenderError::Camera("the frame's sides must be 1 to 4,096"))?;
        let stats = renderer.for_each_triangle(scene, screen, |vertices, interpolation| {
            record.triangles.push((*vertices, interpolation))
        })?;
        let effects = [
            Effect::Fog,
            Effect::Phong,
            Effect::RgbChannels,
            Effect::Texture,
            Effect::EnvironmentMap,
            Effect::Transparency,
            Effect::Dither,
        ];
        for effect in effects {
            if let Some(index) = renderer.plan().objects().iter().position(|plan| plan.is_on(effect)) {
                let what = "a record holds no textures, fog, channels, dither, transparency or light at every pixel";
                return Err(RenderError::of_object(scene, index, what));
            }
        }
        record.background = scene.background;
        record.hidden_surfaces = stats.hidden_surfaces;
        record.palette.clone_from(&scene.palette);
        Ok(record)
    }

    /// Columns, 1 to 4,096.
    #[must_use]
    pub fn width(&self) -> u32 {
        self.width
    }

    /// Rows, 1 to 4,096.
    #[must_use]
    pub fn height(&self) -> u32 {
        self.height
    }

    /// The clip rectangle, if there is one; it lies inside the frame.
    #[must_use]
    pub fn clip(&self) -> Option<Rect> {
        self.clip
    }

    /// Sets the clip rectangle: the frame is drawn only inside `clip`, as far as that lies in the frame.
    #[must_use]
    pub fn with_clip(mut self, clip: Option<Rect>) -> Self {
        self.clip = clip.map(|clip| clip.intersection(Rect { x0: 0, y0: 0, x1: self.width, y1: self.height }));
        self
    }

    /// The record in a file that was opened for reading.
    ///
    /// # Errors
    /// A fault of the file, with its line. Nothing of a broken file is used.
    pub fn read(reader: impl io::BufRead) -> Result<Self, RecordError> {
        read::read(reader)
    }

    /// The record in the file of that name.
    ///
    /// # Errors
    /// As [`read`](Self::read); a file that cannot be opened is an error of line 0.
    pub fn load(path: impl AsRef<Path>) -> Result<Self, RecordError> {
        let file = File::open(path).map_err(|error| RecordError { line: 0, kind: RecordErrorKind::Read(error) })?;
        Self::read(BufReader::new(file))
    }

    /// Writes the record.
    ///
    /// # Errors
    /// Those of `out`.
    pub fn write(&self, out: &mut dyn io::Write) -> io::Result<()> {
        write::write(self, out)
    }

    /// Writes the record to a file, whole or not at all.
    ///
    /// # Errors
    /// [`ExportError`] if the file cannot be written; what stood there before is then whole.
    pub fn save(&self, path: impl AsRef<Path>) -> Result<(), ExportError> {
        write_atomically(path, |out| self.write(out))
    }
}

/// The record as it stands in a file.
impl std::fmt::Display for Record {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let mut text = Vec::new();
        self.write(&mut text).map_err(|_| std::fmt::Error)?;
        f.write_str(&String::from_utf8_lossy(&text))
    }
}
