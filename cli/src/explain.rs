//! `mode13h explain`: why a pixel has its byte; a row's intensity and its slope.

use std::ffi::OsString;
use std::path::PathBuf;

use clap::{ArgGroup, Args};
use mode13h::render::Screen;
use mode13h_lab::explain::{
    self, ExplainError, FaceHere, Fate, Pixel, PixelStage, Progression, Row, Seen, ShadeTrace, ShadedBy,
};
use mode13h_lab::truth::Standard;
use serde_json::{Value, json};

use crate::failure::Failure;
use crate::options::{Drawing, Moment, ShadingOptions};
use crate::turntable::Pose;
use crate::{chart, input, output, read_files};

#[derive(Args)]
#[command(group(ArgGroup::new("what").required(true).args(["pixel", "row"])))]
pub(crate) struct Options {
    #[arg(help = input::HELP, long_help = input::long_help())]
    input: OsString,
    /// Explain this pixel, counted from 0 at the upper left
    ///
    /// Says which triangle is visible and why, how its shade was computed, the exact value, the light at this very pixel, and
    /// the stages that made the byte.
    #[arg(long, value_name = "X,Y", value_parser = place, allow_hyphen_values = true)]
    pixel: Option<(u32, u32)>,
    /// Chart this row, counted from 0 at the top
    ///
    /// Charts intensity and slope, as drawn and as they should be. Where the slope jumps, the eye sees a line, a Mach band.
    #[arg(long, value_name = "Y")]
    row: Option<u32>,
    /// Write the chart of a row to FILE, which ends in .svg [default: print it]
    #[arg(short, long, value_name = "FILE", conflicts_with = "json")]
    out: Option<PathBuf>,
    /// Print the figures as JSON
    #[arg(long)]
    json: bool,
    #[command(flatten)]
    moment: Moment,
    #[command(flatten)]
    drawing: Drawing,
    #[command(flatten)]
    shading: ShadingOptions,
}

/// Two whole numbers with a comma between them.
fn place(words: &str) -> Result<(u32, u32), String> {
    let whole = |word: &str| word.trim().parse::<u32>().ok();
    let place = words.split_once(',').and_then(|(x, y)| Some((whole(x)?, whole(y)?)));
    place.ok_or_else(|| "not two whole numbers separated by a comma, such as 160,100".to_string())
}

pub(crate) fn run(options: &Options) -> Result<(), Failure> {
    let Options { input, pixel, row, out, json, moment, drawing, shading } = options;
    if out.is_some() && row.is_none() {
        return Err(Failure::words("--out is only for the chart of a --row"));
    }
    out.as_deref().map_or(Ok(()), |out| output::check_extension(out, "svg", "a chart"))?;
    let kernel = drawing.kernel()?;
    let screen = Screen::MODE_13H;
    // Before anything is loaded.
    outside(*pixel, *row, screen).map_or(Ok(()), |error| Err(Failure::words(error)))?;
    let input = drawing.input(input)?;
    let name = input.name().to_string();
    let mut stage = drawing.still(input, false)?;
    out.as_deref().map_or(Ok(()), read_files::spare)?;
    let at = moment.of_picture(&stage.scene);
    stage.show(at, Pose::FIRST);
    let mut renderer = shading.renderer(drawing, kernel);
    shading.settle(&mut renderer, &stage.scene)?;
    if let Some((x, y)) = *pixel {
        let pixel = explain::pixel(&mut renderer, &stage.scene, screen, x, y)?;
        return match json {
            true => output::print_json(&pixel_json(&name, at, &pixel)),
            false => output::print(&format!("{name} at {at} s, {pixel}")),
        };
    }
    let Some(y) = *row else { return Ok(()) };
    let accuracy = renderer.settings.or(&stage.scene.settings).drawn_accuracy();
    let row = explain::row(renderer, &stage.scene, screen, y)?;
    let title = format!("{name} at {at} s, row {y}, {accuracy}");
    match out {
        Some(out) => output::file(out, || chart::svg(&title, &row, out)),
        None if *json => output::print_json(&row_json(&name, at, &row)),
        None => output::print(&chart::text(&title, &row)),
    }
}

/// Finds a pixel or row that is outside the frame, if there is one.
fn outside(pixel: Option<(u32, u32)>, row: Option<u32>, screen: Screen) -> Option<ExplainError> {
    let Screen { width, height, .. } = screen;
    match (pixel, row) {
        (Some((x, y)), _) if x >= width || y >= height => Some(ExplainError::OutsidePixel { x, y, width, height }),
        (_, Some(y)) if y >= height => Some(ExplainError::OutsideRow { y, height }),
        _ => None,
    }
}

fn pixel_json(name: &str, at: f64, pixel: &Pixel) -> Value {
    let color = pixel.color;
    json!({
        "schema": output::SCHEMA,
        "input": name,
        "time": at,
        "pixel": [pixel.x, pixel.y],
        "byte": pixel.byte,
        "rgb": [color.r, color.g, color.b],
        "background": pixel.background,
        "shading": pixel.shading.name(),
        "shading_reason": pixel.shading_why,
        "max_error": pixel.max_error,
        "arithmetic": pixel.vertex_path.name(),
        "hidden_surfaces": pixel.hidden_surfaces.name(),
        "hidden_surfaces_reason": pixel.hidden_surfaces_why,
        "faces": pixel.faces.iter().map(|face| face_json(pixel, face)).collect::<Vec<_>>(),
        "seen": pixel.seen.iter().map(seen_json).collect::<Vec<_>>(),
    })
}

fn face_json(pixel: &Pixel, face: &FaceHere) -> Value {
    let corners = face.corners.iter().map(|corner| {
        json!({
            "x_256": corner.x().to_bits(),
            "y_256": corner.y().to_bits(),
            "shade_256": corner.shade().to_bits(),
            "depth": corner.depth(),
        })
    });
    let edges = face.edges(pixel.x, pixel.y);
    let edges = edges
        .iter()
        .map(|edge| json!({ "kind": edge.kind.to_string(), "value": edge.value, "owns_ties": edge.kind.owns_ties() }));
    let fate = match face.fate {
        Fate::Seen => "seen",
        Fate::SeenThrough => "seen-through",
        Fate::Behind => "behind",
        Fate::PaintedOver => "painted-over",
        _ => "not-its-edge",
    };
    json!({
        "object": pixel.objects.get(face.object),
        "object_index": face.object,
        "triangle": face.triangle,
        "line": face.line,
        "material": face.material,
        "is_part": face.is_part,
        "interpolation": face.interpolation.name(),
        "corners": corners.collect::<Vec<_>>(),
        "edges": edges.collect::<Vec<_>>(),
        "depth": face.depth,
        "fate": fate,
    })
}

fn seen_json(seen: &Seen) -> Value {
    let (shaded_by, light) = match seen.shaded_by {
        ShadedBy::Corners => ("corners", Value::Null),
        ShadedBy::NormalTable => ("normal-table", Value::Null),
        ShadedBy::Light { normal, position, shades } => {
            ("light", json!({ "normal": normal, "position": position, "shades_256": shades }))
        }
        ShadedBy::BetweenLit { before, after, .. } => {
            ("between-lit", json!({ "before_256": before, "after_256": after }))
        }
        ShadedBy::BetweenSix(corners) => ("between-six", json!({ "corners_and_middles_256": corners })),
    };
    let against = seen.against.iter().map(
        |against| json!({ "standard": against.standard.name(), "shades": against.shades, "error": against.error }),
    );
    let effects = seen
        .effects
        .iter()
        .map(|row| json!({ "effect": row.effect.name(), "choice": row.choice, "reason": row.reason }));
    json!({
        "face": seen.face,
        "ramp": [seen.ramp.first(), seen.ramp.last()],
        "shaded_by": shaded_by,
        "exact_cover": seen.exact_cover,
        "light": light,
        "traces": seen.accounts.iter().map(account_json).collect::<Vec<_>>(),
        "stages": seen.stages.iter().map(stage_json).collect::<Vec<_>>(),
        "against": against.collect::<Vec<_>>(),
        "effects": effects.collect::<Vec<_>>(),
    })
}

fn account_json(shade_trace: &ShadeTrace) -> Value {
    let mut json = match shade_trace.way {
        Progression::Flat(_) => json!({ "progression": "flat" }),
        Progression::Accumulator(sums) => json!({
            "progression": "sums",
            "first": sums.first,
            "start_at": sums.start_at,
            "fraction_bits": sums.fraction_bits,
            "half": sums.half,
            "start": sums.start,
            "step": sums.step,
            "steps": sums.steps,
            "sums": (0..=sums.steps).map(|k| sums.after(k)).collect::<Vec<_>>(),
        }),
        Progression::Float { start, n, d, shade } => {
            json!({ "progression": "float", "start_at": start, "n": n, "d": d, "shade": shade })
        }
        _ => json!({ "progression": "quotient" }),
    };
    json["byte"] = shade_trace.byte.into();
    // Written as text, because many JSON readers lose digits of numbers beyond 2^53.
    let exact = shade_trace.exact.map(|exact| {
        json!({
            "numerator": exact.numerator.to_string(),
            "denominator": exact.denominator.to_string(),
            "shade": exact.to_f64() / 256.0,
        })
    });
    json["exact_256"] = exact.unwrap_or_default();
    json
}

fn stage_json(stage: &PixelStage) -> Value {
    let mut json = match *stage {
        PixelStage::Shade(_) => json!({ "stage": "shade" }),
        PixelStage::Channels(channels) => json!({ "stage": "channels", "channels": channels }),
        PixelStage::Dither { threshold, .. } => json!({ "stage": "dither", "threshold": threshold }),
        PixelStage::Texture { texel, level, .. } => {
            json!({ "stage": "texture", "texel": texel, "mipmap_level": level })
        }
        PixelStage::TextureChannels { texel, level, channels } => {
            json!({ "stage": "texture", "texel": texel, "mipmap_level": level, "channels": channels })
        }
        PixelStage::Mix { threshold, .. } => json!({ "stage": "mix", "threshold": threshold }),
        PixelStage::Fog { level, .. } => json!({ "stage": "fog", "level": level }),
        PixelStage::Blend { behind, .. } => json!({ "stage": "blend", "behind": behind }),
        _ => json!({ "stage": "other" }),
    };
    json["byte"] = json!(stage.byte());
    json
}

fn row_json(name: &str, at: f64, row: &Row) -> Value {
    let columns = row.columns.iter().map(|column| {
        json!({
            "face": column.face.map(|face| [face.object, face.triangle]),
            "drawn": column.drawn,
            Standard::Gouraud.name(): column.gouraud,
            Standard::Lit.name(): column.lit,
        })
    });
    json!({
        "schema": output::SCHEMA,
        "input": name,
        "time": at,
        "row": row.y,
        "columns": columns.collect::<Vec<_>>(),
        "slope": {
            "drawn": row.slope(|column| column.drawn),
            Standard::Gouraud.name(): row.slope(|column| column.gouraud),
            Standard::Lit.name(): row.slope(|column| column.lit),
        },
    })
}
