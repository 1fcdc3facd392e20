//! A record drawn by the raster, in a frame with guard bytes on all sides.

use crate::record::Record;
use mode13h::internals::raster::Batch;
use mode13h::internals::raster::scan_line::Lists;
use mode13h::raster::{Frame, Interpolation, Raster, RasterError, Vertex};
use mode13h::settings::HiddenSurfaces;
use mode13h::span::Kernel;

/// Ways to draw a record.
#[derive(Clone, Copy, Debug)]
pub(super) struct Configuration {
    /// Back faces only: the triangles one after the other, each over what is there.
    pub(super) hidden_surfaces: HiddenSurfaces,
    pub(super) kernel: Kernel,
    /// Rows of a band; 0: the frame as a whole.
    pub(super) rows_each: u32,
}

impl Configuration {
    pub(super) fn new(hidden_surfaces: HiddenSurfaces, kernel: Kernel) -> Self {
        Self { hidden_surfaces, kernel, rows_each: 0 }
    }
}

/// Drawing of a record, row-major; an error if it wrote beside the frame. The checks are given it,
/// so that the tests can give them a wrong one.
pub(super) type Draw<'a> = &'a dyn Fn(&Record, Configuration) -> Result<Vec<u8>, Stray>;

/// A byte beside the frame was written, or the frame could not be drawn at all.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) enum Stray {
    Byte,
    Frame(RasterError),
}

impl std::fmt::Display for Stray {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Byte => f.write_str("a byte beside the frame was written"),
            Self::Frame(error) => write!(f, "{error}"),
        }
    }
}

const GUARD_BYTE: u8 = 0xA5;
/// Before the frame, behind it, and after each row.
const GUARD: usize = 7;

/// The raster itself.
pub(super) fn draw(record: &Record, way: Configuration) -> Result<Vec<u8>, Stray> {
    let (width, height) = (record.width() as usize, record.height());
    let pitch = width + GUARD;
    let mut bytes = vec![GUARD_BYTE; GUARD + pitch * height as usize];
    let mut frame = Frame::new(&mut bytes[GUARD..], record.width(), height, pitch).map_err(Stray::Frame)?;
    frame.clear(record.background);
    let bands = if way.rows_each == 0 { height } else { way.rows_each };
    for band in frame.bands(bands) {
        draw_band(record, way, band);
    }
    let rows = bytes[GUARD..].chunks(pitch).map(|row| row.split_at(width));
    let beside = bytes[..GUARD].iter().chain(rows.clone().flat_map(|(_, beside)| beside));
    if beside.into_iter().any(|&byte| byte != GUARD_BYTE) {
        return Err(Stray::Byte);
    }
    Ok(rows.flat_map(|(pixels, _)| pixels).copied().collect())
}

fn draw_band(record: &Record, way: Configuration, band: Frame<'_>) {
    let mut raster = Raster::new(band).with_kernel(way.kernel);
    if let Some(clip) = record.clip() {
        raster = raster.with_clip(clip);
    }
    match way.hidden_surfaces {
        HiddenSurfaces::PainterOrder => {
            for (vertices, interpolation) in far_to_near(&record.triangles) {
                raster.triangle(vertices, *interpolation);
            }
        }
        HiddenSurfaces::DepthBuffer => {
            let mut depths: Vec<u32> = Vec::new();
            in_batches(&mut raster.with_cleared_depth(&mut depths), &record.triangles);
        }
        HiddenSurfaces::ScanLine => {
            let mut lists = Lists::default();
            // There is room for all; a frame that is left empty would show.
            let _ = raster.scan_line(&record.triangles, lists.scratch(record.triangles.len()));
        }
        // `BackFaces`: nothing is compared.
        _ => in_batches(&mut raster, &record.triangles),
    }
}

/// Draws triangles in batches, as the renderer does.
fn in_batches(raster: &mut Raster<'_>, triangles: &[([Vertex; 3], Interpolation)]) {
    let mut batch = Batch::new();
    for (vertices, interpolation) in triangles {
        if batch.push(vertices, *interpolation) {
            continue;
        }
        raster.batch(&batch);
        batch.clear();
        if !batch.push(vertices, *interpolation) {
            raster.triangle(vertices, *interpolation);
        }
    }
    raster.batch(&batch);
}

/// Painter's order, by the mean depth of the three vertices.
fn far_to_near(triangles: &[([Vertex; 3], Interpolation)]) -> Vec<&([Vertex; 3], Interpolation)> {
    let mut order: Vec<_> = triangles.iter().collect();
    order.sort_by_key(|(vertices, _)| vertices.iter().map(|v| u64::from(v.depth())).sum::<u64>());
    order
}
