//! The statistics of a frame as JSON, for other programs.

use mode13h::render::Stats;
use serde_json::{Map, Value, json};

/// The figures of a frame.
pub(crate) fn json(number: u32, stats: &Stats) -> Value {
    let shares: Map<String, Value> =
        stats.shares.into_iter().map(|(shading, triangles)| (shading.name().to_string(), triangles.into())).collect();
    let raster = &stats.raster;
    json!({
        "frame": number,
        "shading": stats.shading.name(),
        "max_error": stats.max_error,
        "arithmetic": stats.vertex_path.name(),
        "kernel": stats.kernel,
        "hidden_surfaces": stats.hidden_surfaces.name(),
        "redrawn": stats.redrawn,
        "kept_objects": stats.kept,
        "decided_objects": stats.decided,
        "vertices": stats.vertices,
        "lit": stats.lit,
        "faces": stats.faces,
        "clipped": stats.clipped,
        "culled": stats.culled,
        "triangles": stats.drawn,
        "triangles_by_shading": shares,
        "raster": {
            "spans": raster.spans,
            "covered": raster.covered,
            "pixels": raster.pixels,
            "tested": raster.tested,
            "textured": raster.textured,
            "mipmapped": raster.mipmapped,
            "dithered": raster.dithered,
            "fogged": raster.fogged,
            "blended": raster.blended,
            "mixed": raster.mixed,
            "lit": raster.lit,
        },
    })
}
