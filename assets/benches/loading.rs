//! Times loading from a model's file to the first frame, against `tobj`, which only reads the file.
//!
//! ```text
//! cargo bench --bench loading
//! cargo bench --bench loading -- model.obj another.obj
//! ```
//!
//! Without arguments two models of 10⁶ faces are generated: a bumpy sphere, like a scan, and the same with a normal for
//! each vertex. Every round loads each model with every loader in turn. Figures are medians of wall-clock times over
//! the rounds, and ratios are medians of the ratios within each round. `tobj` reads in two ways: with the options used
//! for drawing (triangles, one index per vertex), and with those that are fastest.

#[path = "../../benches/interleaved/mod.rs"]
mod interleaved;

use std::fmt::Write as _;
use std::fs;
use std::hint::black_box;
use std::path::{Path, PathBuf};

use mode13h::mesh::shapes;
use mode13h::render::Renderer;
use mode13h::scene::Scene;
use mode13h::vga::Vga;
use mode13h_assets::model_file;
use mode13h_conformance::Random;

/// A loader and its name.
type Loader = (&'static str, fn(&Path));

const LOADERS: [Loader; 4] = [
    ("tobj, as it is fastest", |path| by_tobj(path, &tobj::LoadOptions::default())),
    ("tobj, for drawing", |path| by_tobj(path, &tobj::GPU_LOAD_OPTIONS)),
    ("model_file::load", |path| drop(black_box(load(path)))),
    ("model_file::load and the first frame", |path| {
        let scene = Scene::showing(load(path));
        let mut vga = Vga::new();
        Renderer::new().draw(&scene, &mut vga).expect("a legal scene");
        black_box(vga.pixels());
    }),
];

fn by_tobj(path: &Path, options: &tobj::LoadOptions) {
    black_box(tobj::load_obj(path, options).expect("it is read").0);
}

fn load(path: &Path) -> mode13h::mesh::Mesh {
    model_file::load(path).expect("it is read").mesh
}

fn main() {
    let words: Vec<String> = std::env::args().skip(1).collect();
    let (rounds, stacks) = if interleaved::is_bench() { (11, 500) } else { (1, 10) };
    let mut paths: Vec<PathBuf> = words.iter().filter(|word| !word.starts_with('-')).map(PathBuf::from).collect();
    if paths.is_empty() {
        paths = [("scan", false), ("with-normals", true)].map(|(name, normals)| made(name, stacks, normals)).into();
    }
    for path in &paths {
        let bytes = fs::metadata(path).expect("it is there").len();
        println!("{}: {} faces, {bytes} bytes", path.display(), load(path).triangles().len());
        let times = interleaved::times(LOADERS.len(), rounds, |which| LOADERS[which].1(path));
        println!("{:>32} {:>8} {:>22} {:>22}", "", "ms", LOADERS[0].0, LOADERS[1].0);
        for ((name, _), own) in LOADERS.iter().zip(&times) {
            let ratio =
                |other: &[f64]| interleaved::median(own.iter().zip(other).map(|(own, other)| own / other).collect());
            println!(
                "{name:>32} {:>8.0} {:>20.2} x {:>20.2} x",
                interleaved::median(own.clone()) * 1e3,
                ratio(&times[0]),
                ratio(&times[1])
            );
        }
    }
}

/// A sphere of 4·stacks² faces whose vertices are slightly displaced in or out, written as OBJ.
fn made(name: &str, stacks: u32, normals: bool) -> PathBuf {
    let mesh = shapes::sphere(2 * stacks, stacks + 1);
    let mut text = String::new();
    let mut random = Random::again(1);
    for position in mesh.positions() {
        // Within half an edge.
        let [x, y, z] = (*position * (1.0 + random.unit() as f32 / stacks as f32)).to_array();
        writeln!(text, "v {x:.6} {y:.6} {z:.6}").expect("written");
    }
    if normals {
        for [x, y, z] in mesh.normals().iter().map(|normal| normal.to_array()) {
            writeln!(text, "vn {x:.4} {y:.4} {z:.4}").expect("written");
        }
    }
    for corners in mesh.triangles() {
        let [a, b, c] = corners.map(|vertex| vertex + 1);
        match normals {
            true => writeln!(text, "f {a}//{a} {b}//{b} {c}//{c}").expect("written"),
            false => writeln!(text, "f {a} {b} {c}").expect("written"),
        }
    }
    let path = Path::new(env!("CARGO_TARGET_TMPDIR")).join(format!("{name}-{}.obj", mesh.triangles().len()));
    fs::write(&path, text).expect("written");
    path
}
