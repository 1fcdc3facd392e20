//! Plan, counts and the explanation of a pixel as JSON.

use mode13h::internals::ShadeTrace;
use mode13h::palette::Ramp;
use mode13h::plan::Row;
use mode13h::raster::{Interpolation, Vertex};
use mode13h::render::{Renderer, Screen, Stats};
use mode13h::scene::Scene;
use mode13h_lab::explain::{self, FaceHere, Pixel, Registers, Seen, ShadedBy};
use serde_json::{Value, json};

/// The counts of a frame.
pub(crate) fn counts(stats: &Stats) -> Value {
    let shares: Vec<Value> = stats.shares.into_iter().map(|(shading, faces)| json!([shading.name(), faces])).collect();
    json!({
        "shading": stats.shading.name(), "maxError": stats.max_error, "hidden": stats.hidden_surfaces.name(),
        "kernel": stats.kernel, "redrawn": stats.redrawn, "faces": stats.faces, "drawn": stats.drawn,
        "pixels": stats.raster.pixels, "lit": stats.raster.lit, "vertices": stats.vertices, "shares": shares,
    })
}

/// The plan's decisions, each with its reason.
pub(crate) fn plan(rows: &[Row]) -> Value {
    let row = |row: &Row| {
        json!({
            "place": row.index, "object": row.object, "effect": row.effect.name(), "on": row.on, "choice": row.choice,
            "reason": row.reason,
        })
    };
    rows.iter().map(row).collect()
}

/// The explanation of a pixel: the text of `mode13h explain`, and the values that the page highlights.
pub(crate) fn pixel(renderer: &mut Renderer, scene: &Scene, x: u32, y: u32) -> Result<Value, String> {
    let pixel = explain::pixel(renderer, scene, Screen::MODE_13H, x, y).map_err(|error| error.to_string())?;
    let mut account = json!({
        "x": x, "y": y, "byte": pixel.byte, "color": format!("#{:06x}", pixel.color), "text": pixel.to_string(),
        "shading": pixel.shading.name(),
    });
    if let Some(seen) = pixel.seen.last() {
        let against = seen.against.iter();
        account["against"] = against.map(|of| json!([of.standard.name(), of.shades, of.error])).collect();
        if let Some(exact) = shade_trace(seen).and_then(|trace| trace.exact) {
            account["exact"] = (exact.to_f64() / 256.0).into();
            account["isRamp"] = (seen.ramp != Ramp::WHOLE).into();
        }
        if let Some(face) = pixel.faces.get(seen.face) {
            account["object"] = json!(pixel.objects.get(face.object));
            account["triangle"] = json!(face.triangle);
            account["corners"] = face.corners.iter().map(corner).collect();
            let is_wide = face.interpolation == Interpolation::Gouraud1616;
            account["registers"] = registers(&pixel, face, seen).map_or(
                Value::Null,
                |of| json!({ "edi": of.edi, "eax": of.eax, "ebx": of.ebx, "cx": of.cx, "isWide": is_wide }),
            );
        }
    }
    Ok(account)
}

/// A corner: x and y in pixels, and its shade.
fn corner(vertex: &Vertex) -> Value {
    let in_pixels = |bits: i32| f64::from(bits) / 256.0;
    json!([
        in_pixels(vertex.x().to_bits()),
        in_pixels(vertex.y().to_bits()),
        f64::from(vertex.shade().to_bits()) / 256.0
    ])
}

/// The way of the one shade from the corners to the pixel; `None` for channels, and for light computed at pixels or looked
/// up in a table.
fn shade_trace(seen: &Seen) -> Option<&ShadeTrace> {
    match seen.accounts.as_slice() {
        [trace] if seen.shaded_by == ShadedBy::Corners => Some(trace),
        _ => None,
    }
}

/// The registers of the loop of 1994 at the pixel, for shadings whose loop keeps a sum.
fn registers(pixel: &Pixel, face: &FaceHere, seen: &Seen) -> Option<Registers> {
    shade_trace(seen)?;
    let width = Screen::MODE_13H.width;
    Registers::at(pixel.x, pixel.y, &face.corners, (face.interpolation, seen.exact_cover), width)
}
