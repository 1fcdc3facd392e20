//! Writing a record.

use std::io::{self, Write};

use super::{Record, VERSION};
use mode13h::raster::Interpolation;

pub(super) fn write(record: &Record, out: &mut dyn Write) -> io::Result<()> {
    writeln!(out, "mode13h record {VERSION}")?;
    writeln!(out, "frame {} {}", record.width, record.height)?;
    if let Some(clip) = record.clip {
        writeln!(out, "clip {} {} {} {}", clip.x0, clip.y0, clip.x1, clip.y1)?;
    }
    writeln!(out, "background {}", record.background)?;
    writeln!(out, "hidden-surfaces {}", record.hidden_surfaces.name())?;
    if let Some(palette) = &record.palette {
        writeln!(out, "palette {}", palette.ramps())?;
        for eight in palette.colors().chunks(8) {
            let colors: Vec<String> = eight.iter().map(|color| format!("{:06x}", color)).collect();
            writeln!(out, "{}", colors.join(" "))?;
        }
    }
    writeln!(out, "triangles")?;
    writeln!(out, "# x y in 1/256 pixel, shade in 1/256, depth (greater is nearer), of each vertex")?;
    for (vertices, interpolation) in &record.triangles {
        match interpolation {
            Interpolation::Flat(index) => write!(out, "{} {index}", interpolation.name())?,
            _ => write!(out, "{}", interpolation.name())?,
        }
        for v in vertices {
            write!(out, "  {} {} {} {}", v.x().to_bits(), v.y().to_bits(), v.shade().to_bits(), v.depth())?;
        }
        writeln!(out)?;
    }
    writeln!(out, "end")
}
