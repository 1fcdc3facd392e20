//! mode13h side by side with Allegro 4, retrofire and Mesa's llvmpipe, on the same triangles.
//!
//! ```text
//! cargo run --release -- [--rabbit MODEL.obj] [--json FILE] [--table] [--rounds N] [--faces N] [--only TEXT]
//!     [--no-frames | --no-triangles] [MODEL.obj] ...
//! ```
//!
//! Triangles: a cleared frame of 320 × 200, then all front faces, back to front. Only the rasterizer is timed,
//! including clearing its depth buffer, if it has one, and packing our batches. In every round each candidate draws
//! once, or as often as it takes to fill a millisecond, in an order reshuffled every round. Times are thread CPU times:
//! medians, with the interval that contains the median in 95 of 100 runs in brackets. Ratios are taken round by round.
//!
//! Whole frames: transform, light, culling, hidden surfaces and drawing.
//!
//! Every candidate's picture is compared with ours; one that draws too many or too few pixels, or different ones, ends
//! the run with an error.

mod allegro;
mod candidate;
mod drawing;
mod field;
#[expect(dead_code, reason = "other benchmarks use the rest")]
#[path = "../../interleaved/mod.rs"]
mod interleaved;
mod ours;
mod refine;
mod retrofire;
#[path = "../../interleaved/thread_time.rs"]
mod thread_time;
mod timing;
mod truth;
mod whole;
mod workload;

use std::error::Error;
use std::path::PathBuf;

use candidate::{Candidate, Triangle};
use drawing::{Drawing, Material};
use mode13h::span::Kernel;
use serde_json::{Value, json};
use thread_time::seconds;
use timing::{Median, Times};
use whole::{Shown, Stages};
use workload::Workload;

pub const WIDTH: usize = 320;
pub const HEIGHT: usize = 200;

/// Triangles per workload that are compared with the truth.
const COMPARED: usize = 1_000;

struct Options {
    rabbit: Option<PathBuf>,
    json: Option<PathBuf>,
    rounds: usize,
    /// Meshes with more faces are skipped.
    faces: usize,
    triangles: bool,
    frames: bool,
    only: String,
    table: bool,
    files: Vec<String>,
}

fn options() -> Result<Options, String> {
    let mut options = Options {
        rabbit: None,
        json: None,
        rounds: 31,
        faces: usize::MAX,
        triangles: true,
        frames: true,
        only: String::new(),
        table: false,
        files: Vec::new(),
    };
    let mut words = std::env::args().skip(1);
    while let Some(word) = words.next() {
        let mut next = || words.next().ok_or(format!("{word} is followed by nothing"));
        let number = |text: String| text.parse().ok().filter(|n| *n > 0).ok_or(format!("no number above 0: {text}"));
        match word.as_str() {
            "--rabbit" => options.rabbit = Some(next()?.into()),
            "--json" => options.json = Some(next()?.into()),
            "--rounds" => options.rounds = number(next()?)?,
            "--faces" => options.faces = number(next()?)?,
            "--only" => options.only = next()?,
            "--table" => options.table = true,
            "--no-triangles" => options.triangles = false,
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
    let material = Material::new();
    allegro::start()?;
    let mesa = whole::start_mesa(&material)?;
    let kernels = field::kernels();
    let workloads: Vec<Workload> = Workload::all(options.rabbit.as_deref(), options.faces, &options.files)?
        .into_iter()
        .filter(|workload| workload.name.contains(&options.only))
        .collect();
    println!("{}; medians of {} rounds", processor(), options.rounds);
    let mut tables = Vec::new();
    for drawing in Drawing::ALL.into_iter().filter(|_| options.triangles) {
        let mut rows = Vec::new();
        println!("\nTriangles, {}: ns a triangle", drawing.name());
        for workload in &workloads {
            rows.push(triangles(workload, drawing, &material, &kernels, options.rounds)?);
        }
        tables.push(json!({ "drawing": drawing.name(), "workloads": rows }));
    }
    let mut frames = Vec::new();
    for stages in Stages::ALL.into_iter().filter(|_| options.frames) {
        println!("\nWhole frames, {}: ns a face of the mesh; the peer is {mesa}, one thread", stages.name());
        for workload in &workloads {
            let mesh = &workload.mesh;
            let whole = whole::measure((mesh, Shown::One), stages, &material, &kernels, options.rounds)?;
            frames.push(frame(&workload.name, stages, mesh.triangles().len(), &whole)?);
            if workload.name == "cube" {
                let whole = whole::measure((mesh, Shown::Crowd), stages, &material, &kernels, options.rounds)?;
                frames.push(frame("500 cubes", stages, 500 * mesh.triangles().len(), &whole)?);
            }
        }
    }
    if options.table {
        for kernel in ["simd-avx2", "simd-avx512"] {
            print_table(kernel, &tables);
            print_frames("depth buffer", kernel, &frames);
            print_frames("as planned", kernel, &frames);
        }
    }
    if let Some(path) = &options.json {
        let report = json!({
            "schema": 2,
            "processor": processor(),
            "rounds": options.rounds,
            "mesa": mesa,
            "triangles": tables,
            "frames": frames,
        });
        std::fs::write(path, serde_json::to_string_pretty(&report)?)
            .map_err(|error| format!("{}: {error}", path.display()))?;
    }
    Ok(())
}

/// One workload, drawn by every candidate that supports the drawing.
fn triangles(
    workload: &Workload,
    drawing: Drawing,
    material: &Material,
    kernels: &[Kernel],
    rounds: usize,
) -> Result<Value, Box<dyn Error>> {
    let mut candidates = field::all(&workload.triangles, drawing, material, kernels);
    let count = workload.triangles.len();
    let pictures = pictures(workload, drawing, &mut candidates)?;
    let repeats: Vec<u32> = candidates.iter_mut().map(|candidate| repeats(candidate.as_mut())).collect();
    let times = interleaved::times_by(candidates.len(), rounds, |_, which| {
        let candidate = &mut candidates[which];
        candidate.clear(0);
        seconds(|| (0..repeats[which]).for_each(|_| candidate.draw())) / f64::from(repeats[which])
    });
    let times: Vec<Times> = times.into_iter().map(Times).collect();
    // The best is chosen by medians; the ratio is that of the two.
    let best = |ours: bool| {
        let of = (0..times.len()).filter(|i| candidates[*i].is_ours() == ours);
        of.min_by(|a, b| times[*a].median().median.total_cmp(&times[*b].median().median)).expect("there are some")
    };
    let (peer, ours) = (best(false), best(true));
    let ratio = times[peer].ratio(&times[ours]);
    let pixels = mean_pixels(&workload.triangles);
    println!("\n{}: {count} triangles, {pixels:.2} pixels each; best peer ÷ ours {}", workload.name, shown(ratio, 2));
    let has_truth = matches!(drawing, Drawing::Flat | Drawing::Gouraud);
    let step = count.div_ceil(COMPARED.min(rounds * 50));
    let compared: Vec<Triangle> = workload.triangles.iter().step_by(step).copied().collect();
    let mut rows = Vec::new();
    for (i, (candidate, times)) in candidates.iter().zip(&times).enumerate() {
        let each = times.median().times(1e9 / count as f64);
        let (share, difference) = pictures[i];
        print!("  {:<28}{:>30} ns{:>8.1} % of the pixels", candidate.name(), shown(each, 1), 100.0 * share);
        let errors = has_truth.then(|| truth::errors(&compared, drawing, material, kernels, i));
        match &errors {
            Some(errors) => {
                println!("{:>7} holes{:>7} extra{:>8.2} shades", errors.holes, errors.extra, errors.shade);
            }
            None => println!("{difference:>8.2} apart"),
        }
        rows.push(json!({
            "name": candidate.name(),
            "is_ours": candidate.is_ours(),
            "ns": each.json(),
            "pixels": share,
            "difference": difference,
            "holes": errors.map(|errors| errors.holes),
            "extra": errors.map(|errors| errors.extra),
            "shade_error": errors.map(|errors| errors.shade),
        }));
    }
    Ok(json!({
        "name": workload.name,
        "triangles": count,
        "pixels_each": pixels,
        "best_peer": candidates[peer].name(),
        "best_peer_by_ours": ratio.json(),
        "candidates": rows,
    }))
}

/// Prints how many times slower the best peer is than our batches with this kernel, by medians: one
/// row per drawing, one column per workload.
fn print_table(kernel: &str, tables: &[Value]) {
    let workloads = |table: &Value| table["workloads"].as_array().cloned().unwrap_or_default();
    let Some(first) = tables.first() else { return };
    let names: Vec<String> = workloads(first).iter().filter_map(|of| Some(of["name"].as_str()?.to_owned())).collect();
    println!("\n| best peer ÷ ours, {kernel} | {} |\n|---|{}", names.join(" | "), "---:|".repeat(names.len()));
    for table in tables {
        let ratio = |workload: &Value| {
            let times = |wanted: &dyn Fn(&Value) -> bool| {
                let candidates = workload["candidates"].as_array()?.iter().filter(|candidate| wanted(candidate));
                candidates.filter_map(|candidate| candidate["ns"]["median"].as_f64()).min_by(f64::total_cmp)
            };
            let ours = times(&|candidate| candidate["name"] == format!("batches, {kernel}"))?;
            Some(times(&|candidate| candidate["is_ours"] == false)? / ours)
        };
        let cell = |workload| ratio(&workload).map_or_else(|| "–".to_owned(), |ratio| format!("{ratio:.2}"));
        let cells: Vec<String> = workloads(table).into_iter().map(cell).collect();
        println!("| {} | {} |", table["drawing"].as_str().unwrap_or_default(), cells.join(" | "));
    }
}

/// Prints how many times slower Mesa is than ours, which is "depth buffer" or "as planned", with this
/// kernel: one row per drawing of whole frames, one column per scene.
fn print_frames(ours: &str, kernel: &str, frames: &[Value]) {
    let mut names: Vec<&str> = Vec::new();
    for name in frames.iter().filter_map(|frame| frame["name"].as_str()) {
        if !names.contains(&name) {
            names.push(name);
        }
    }
    println!("\n| Mesa ÷ ours, {ours}, {kernel} | {} |\n|---|{}", names.join(" | "), "---:|".repeat(names.len()));
    for stages in Stages::ALL {
        let cell = |name: &&str| {
            let frame = frames.iter().find(|frame| frame["name"] == **name && frame["stages"] == stages.name())?;
            let name = format!("{ours}, {kernel}");
            let ours = frame["ours"].as_array()?.iter().find(|ours| ours["name"] == name)?;
            ours["mesa_by_ours"]["median"].as_f64().map(|ratio| format!("{ratio:.2}"))
        };
        let cells: Vec<String> = names.iter().map(|name| cell(name).unwrap_or_else(|| "–".to_owned())).collect();
        println!("| {} | {} |", stages.name(), cells.join(" | "));
    }
}

/// A median and its interval.
fn shown(median: Median, digits: usize) -> String {
    let Median { low, median, high } = median;
    format!("{median:.digits$} ({low:.digits$} to {high:.digits$})")
}

/// For each candidate, the pixels that it draws as a share of our first's, and the mean difference of its bytes from
/// our first's over the pixels that both draw. It is an error if the pictures do not match.
fn pictures(
    workload: &Workload,
    drawing: Drawing,
    candidates: &mut [Box<dyn Candidate + '_>],
) -> Result<Vec<(f64, f64)>, String> {
    let mut drawn: Vec<Vec<u8>> = Vec::new();
    for candidate in candidates.iter_mut() {
        let mut bytes = vec![0; WIDTH * HEIGHT];
        candidate.clear(0);
        candidate.draw();
        candidate.read(&mut bytes);
        drawn.push(bytes);
    }
    let first = candidates.iter().position(|candidate| candidate.is_ours()).expect("we are there");
    let count = |bytes: &[u8]| bytes.iter().filter(|byte| **byte != 0).count() as f64;
    let ours = &drawn[first];
    let mut pictures = Vec::new();
    for (candidate, bytes) in candidates.iter().zip(&drawn) {
        let both = ours.iter().zip(bytes).filter(|(a, b)| **a != 0 && **b != 0);
        let difference =
            both.clone().map(|(a, b)| f64::from(a.abs_diff(*b))).fold(0.0, |a, b| a + b) / both.count().max(1) as f64;
        let share = count(bytes) / count(ours);
        // No candidate's edges are off by a pixel on average, and being off by a texel changes few pixels, by 24 to 168
        // shades.
        if !(0.95..1.05).contains(&share) || difference > 12.0 {
            return Err(format!(
                "{}, {}: {} draws {:.1} % of our pixels, {difference:.1} shades from ours on the mean",
                workload.name,
                drawing.name(),
                candidate.name(),
                100.0 * share
            ));
        }
        pictures.push((share, difference));
    }
    Ok(pictures)
}

/// Mean number of pixels that a triangle covers inside the frame, as the engine counts them.
fn mean_pixels(triangles: &[Triangle]) -> f64 {
    use mode13h::raster::{Frame, Interpolation, Raster};
    let mut bytes = vec![0; WIDTH * HEIGHT];
    let mut raster = Raster::new(Frame::new(&mut bytes, WIDTH as u32, HEIGHT as u32, WIDTH).expect("a legal frame"));
    let mut covered = |triangle: &Triangle| {
        u64::from(raster.triangle(&triangle.map(|corner| corner.vertex), Interpolation::Flat(1)).covered)
    };
    triangles.iter().map(&mut covered).sum::<u64>() as f64 / triangles.len() as f64
}

/// How many times a candidate draws in a millisecond; at least once.
fn repeats(candidate: &mut dyn Candidate) -> u32 {
    candidate.draw();
    (1e-3 / seconds(|| candidate.draw())).clamp(1.0, 10_000.0) as u32
}

/// One mesh, drawn by us in several ways and by Mesa.
fn frame(name: &str, stages: Stages, faces: usize, whole: &whole::Whole) -> Result<Value, Box<dyn Error>> {
    let (mesa, ours) = whole.times.split_last().ok_or("nobody drew")?;
    let each = |times: &Times| times.median().times(1e9 / faces as f64);
    let [of_ours, of_mesa] = whole.pixels;
    println!("\n{name}: {faces} faces; {of_ours} pixels, Mesa's {of_mesa}, {:.2} apart", whole.difference);
    // Covering an eighth of a pixel more or less at each edge shows in fine meshes, whose pictures are all edges.
    if !(0.9..1.1).contains(&(of_mesa as f64 / of_ours as f64)) || whole.difference > 12.0 {
        return Err(format!("{name}, {}: Mesa shows another picture", stages.name()).into());
    }
    println!("  {:<28}{:>30} ns", "llvmpipe", shown(each(mesa), 1));
    let mut rows = Vec::new();
    for (name, times) in whole.names.iter().zip(ours) {
        let ratio = mesa.ratio(times);
        println!("  {name:<28}{:>30} ns  Mesa ÷ ours {}", shown(each(times), 1), shown(ratio, 2));
        rows.push(json!({ "name": name, "ns": each(times).json(), "mesa_by_ours": ratio.json() }));
    }
    Ok(json!({
        "name": name,
        "stages": stages.name(),
        "faces": faces,
        "ns_mesa": each(mesa).json(),
        "ours": rows,
        "pixels": whole.pixels,
        "difference": whole.difference,
    }))
}

fn processor() -> String {
    let info = std::fs::read_to_string("/proc/cpuinfo").unwrap_or_default();
    let name = info.lines().find_map(|line| line.strip_prefix("model name")?.split_once(':'));
    name.map_or_else(|| std::env::consts::ARCH.to_owned(), |(_, name)| name.trim().to_owned())
}
