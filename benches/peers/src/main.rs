//! mode13h side by side with Allegro 4, retrofire and Mesa's llvmpipe, on the same triangles.
//!
//! ```text
//! cargo run --release -- [--rabbit MODEL.obj] [--json FILE] [--no-frames] [--only TEXT] [--kernel NAME] [MODEL.obj | TRIANGLES.tri] ...
//! ```
//!
//! Triangles: a cleared frame of 320 × 200, then all front faces, back to front, without a depth buffer;
//! nothing but the rasterizer is timed. Every round each contender draws once, or as often as it takes to
//! fill a millisecond. Whole frames: transform, light, culling, hidden surfaces and drawing.

mod contender;
mod refine;
mod timing;
mod truth;
mod whole;
mod workload;

use std::error::Error;
use std::path::PathBuf;
use std::time::Instant;

use contender::{Candidate, Shade};
use mode13h::span::Kernel;
use serde_json::{Value, json};
use timing::{ROUNDS, Times};
use workload::Workload;

pub const WIDTH: usize = 320;
pub const HEIGHT: usize = 200;

/// Triangles of each workload that are compared with the truth.
const COMPARED: usize = 1_000;

struct Options {
    rabbit: Option<PathBuf>,
    json: Option<PathBuf>,
    frames: bool,
    only: String,
    /// Ours besides the portable one.
    kernel: Kernel,
    files: Vec<String>,
}

fn options() -> Result<Options, String> {
    let mut options = Options {
        rabbit: None,
        json: None,
        frames: true,
        only: String::new(),
        kernel: Kernel::fastest(),
        files: Vec::new(),
    };
    let mut words = std::env::args().skip(1);
    while let Some(word) = words.next() {
        let mut next = || words.next().ok_or(format!("{word} is followed by nothing"));
        match word.as_str() {
            "--rabbit" => options.rabbit = Some(next()?.into()),
            "--json" => options.json = Some(next()?.into()),
            "--only" => options.only = next()?,
            "--kernel" => options.kernel = Kernel::by_name(&next()?).map_err(|error| error.to_string())?,
            "--no-frames" => options.frames = false,
            _ if word.starts_with('-') => return Err(format!("no such option: {word}")),
            _ => options.files.push(word),
        }
    }
    Ok(options)
}

fn main() {
    let result = options().map_err(Into::into).and_then(run);
    if let Err(error) = result {
        eprintln!("mode13h-peers: {error}");
        std::process::exit(1);
    }
}

fn run(options: Options) -> Result<(), Box<dyn Error>> {
    contender::start_allegro()?;
    let mesa = whole::start_mesa()?;
    let workloads: Vec<Workload> = Workload::all(options.rabbit.as_deref(), &options.files)?
        .into_iter()
        .filter(|workload| workload.name.contains(&options.only))
        .collect();
    println!("{}; best and median of {ROUNDS} rounds", processor());
    let mut tables = Vec::new();
    for shade in [Shade::Linear, Shade::Flat] {
        let mut rows = Vec::new();
        println!("\nTriangles, {shade:?}: ns a triangle; holes, extra pixels and largest shade error of {COMPARED}");
        for workload in &workloads {
            rows.push(triangles(workload, shade, options.kernel));
        }
        tables.push(json!({ "shade": format!("{shade:?}"), "workloads": rows }));
    }
    let mut frames = Vec::new();
    if options.frames {
        println!("\nWhole frames, ns a face of the mesh; the peer is {mesa}, one thread");
        println!(
            "{:<24}{:>9}{:>12}{:>12}{:>12}{:>12}{:>16}",
            "mesh", "faces", "depth", "as planned", "Mesa", "Mesa÷depth", "pixels (Mesa's)"
        );
        for workload in &workloads {
            if let Some(mesh) = &workload.mesh {
                frames.push(frame(&workload.name, mesh, options.kernel)?);
            }
        }
    }
    if let Some(path) = &options.json {
        let report = json!({
            "schema": 1,
            "processor": processor(),
            "rounds": ROUNDS,
            "mesa": mesa,
            "triangles": tables,
            "frames": frames,
        });
        std::fs::write(path, serde_json::to_string_pretty(&report)?)
            .map_err(|error| format!("{}: {error}", path.display()))?;
    }
    Ok(())
}

/// One row of the table of triangles.
fn triangles(workload: &Workload, shade: Shade, kernel: Kernel) -> Value {
    let mut contenders = contender::all(&workload.triangles, shade, kernel);
    let count = workload.triangles.len();
    let turns = contenders.iter_mut().map(|c| turns(c.as_mut())).collect::<Vec<_>>();
    let mut times = vec![Times::new(); contenders.len()];
    for round in 0..ROUNDS {
        for place in 0..contenders.len() {
            let which = (place + round) % contenders.len();
            let contender = &mut contenders[which];
            contender.clear(0);
            let started = Instant::now();
            for _ in 0..turns[which] {
                contender.draw();
            }
            times[which].push(started.elapsed().as_secs_f64() / f64::from(turns[which]));
        }
    }
    let each = |seconds: f64| seconds * 1e9 / count as f64;
    let best = |ours: bool| {
        let of = contenders.iter().zip(&times).filter(|(c, _)| c.is_ours() == ours);
        of.map(|(_, times)| each(times.best())).fold(f64::INFINITY, f64::min)
    };
    let step = count.div_ceil(COMPARED);
    let compared: Vec<_> = workload.triangles.iter().step_by(step).copied().collect();
    let pixels = mean_pixels(workload);
    println!(
        "\n{}: {count} triangles, {pixels:.2} pixels each; best peer ÷ ours {:.2}",
        workload.name,
        best(false) / best(true)
    );
    let mut rows = Vec::new();
    for (i, (contender, times)) in contenders.iter().zip(&times).enumerate() {
        let errors = truth::errors(&compared, shade, kernel, i);
        println!(
            "  {:<24}{:>10.1} best{:>10.1} median{:>8.2} × best peer{:>7} holes{:>7} extra{:>8.2} shades",
            contender.name(),
            each(times.best()),
            each(times.median()),
            each(times.best()) / best(false),
            errors.holes,
            errors.extra,
            errors.shade,
        );
        rows.push(json!({
            "name": contender.name(),
            "ns_best": each(times.best()),
            "ns_median": each(times.median()),
            "holes": errors.holes,
            "extra": errors.extra,
            "shade_error": errors.shade,
        }));
    }
    json!({
        "name": workload.name,
        "triangles": count,
        "pixels_each": pixels,
        "compared": compared.len(),
        "best_peer_by_ours": best(false) / best(true),
        "contenders": rows,
    })
}

/// Pixels that a triangle covers inside the frame, by the engine's own count.
fn mean_pixels(workload: &Workload) -> f64 {
    use mode13h::raster::{Frame, Raster, Interpolation};
    let mut bytes = vec![0; WIDTH * HEIGHT];
    let mut raster = Raster::new(Frame::new(&mut bytes, WIDTH as u32, HEIGHT as u32, WIDTH).expect("a legal frame"));
    let covered: u64 = workload.triangles.iter().map(|t| u64::from(raster.triangle(t, Interpolation::Flat(1)).covered)).sum();
    covered as f64 / workload.triangles.len() as f64
}

/// How often it draws in a millisecond, at least once.
fn turns(contender: &mut dyn Candidate) -> u32 {
    contender.draw();
    let started = Instant::now();
    contender.draw();
    (1e-3 / started.elapsed().as_secs_f64()).clamp(1.0, 10_000.0) as u32
}

/// One row of the table of frames.
fn frame(name: &str, mesh: &mode13h::mesh::Mesh, kernel: Kernel) -> Result<Value, Box<dyn Error>> {
    let whole = whole::measure(mesh, kernel)?;
    let faces = mesh.triangles().len();
    let each = |times: &Times| times.best() * 1e9 / faces as f64;
    let [depth, planned, mesa] = whole.times.each_ref().map(each);
    println!(
        "{name:<24}{faces:>9}{depth:>12.1}{planned:>12.1}{mesa:>12.1}{:>12.2}{:>8}{:>8}",
        mesa / depth,
        whole.pixels[0],
        whole.pixels[1]
    );
    Ok(json!({
        "name": name,
        "faces": faces,
        "ns_depth_buffer": depth,
        "ns_as_planned": planned,
        "ns_mesa": mesa,
        "ns_median": whole.times.each_ref().map(|times| times.median() * 1e9 / faces as f64),
        "pixels": whole.pixels,
    }))
}

fn processor() -> String {
    let info = std::fs::read_to_string("/proc/cpuinfo").unwrap_or_default();
    let name = info.lines().find_map(|line| line.strip_prefix("model name")?.split_once(':'));
    name.map_or_else(|| std::env::consts::ARCH.to_owned(), |(_, name)| name.trim().to_owned())
}
