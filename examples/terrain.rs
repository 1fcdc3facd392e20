//! A loader of your own: heights in an ASCII PGM picture become a mesh with four surfaces, rendered to `terrain.png`.
//!
//!     cargo run --release --example terrain -- [HEIGHTS.pgm]

use mode13h::export;
use mode13h::glam::Vec3;
use mode13h::light::{Light, RampChoice};
use mode13h::mesh::{Mesh, MeshError, Surface};
use mode13h::palette::{Palette, Rgb};
use mode13h::render::Renderer;
use mode13h::scene::{Camera, Object, Scene};
use mode13h::vga::Vga;

/// Water, sand, grass and snow: each a quarter of the palette, from dark to this colour.
const COLORS: [[u8; 3]; 4] = [[40, 90, 200], [210, 190, 120], [90, 160, 60], [250, 250, 255]];
/// The heights up to which the first three reach.
const BOUNDS: [f32; 3] = [0.3, 0.4, 0.75];

/// The number of columns, and all heights from 0 to 1, row by row; `None` if the text is not such a picture.
fn heights(text: &str) -> Option<(usize, Vec<f32>)> {
    let words: Vec<&str> = text.lines().filter(|line| !line.starts_with('#')).flat_map(str::split_whitespace).collect();
    let ["P2", columns, rows, most, heights @ ..] = &words[..] else { return None };
    let (columns, rows, most): (usize, usize, f32) = (columns.parse().ok()?, rows.parse().ok()?, most.parse().ok()?);
    let heights: Vec<f32> = heights.iter().filter_map(|word| Some(word.parse::<f32>().ok()? / most)).collect();
    (columns.checked_mul(rows)? == heights.len() && columns >= 2 && rows >= 2).then_some((columns, heights))
}

fn terrain(columns: usize, heights: &[f32]) -> Result<Mesh, MeshError> {
    let side = columns as f32 - 1.0;
    let position = |(i, height): (usize, &f32)| {
        Vec3::new((i % columns) as f32 / side - 0.5, height.max(BOUNDS[0]) * 0.3, (i / columns) as f32 / side - 0.5)
    };
    let (mut triangles, mut surfaces) = (Vec::new(), Vec::new());
    for i in (0..heights.len() - columns).filter(|i| i % columns + 1 < columns) {
        let corners = [i, i + 1, i + columns, i + columns + 1];
        let highest = corners.into_iter().map(|corner| heights[corner]).fold(0.0, f32::max);
        surfaces.extend([BOUNDS.iter().filter(|bound| highest > **bound).count() as u16; 2]);
        let [a, b, c, d] = corners.map(|corner| corner as u32);
        triangles.extend([[a, c, b], [b, c, d]]);
    }
    let mesh = Mesh::new(heights.iter().enumerate().map(position).collect(), triangles)?;
    mesh.with_surfaces(vec![Surface::default(); COLORS.len()], surfaces)
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let (columns, heights) = match std::env::args().nth(1) {
        Some(path) => {
            heights(&std::fs::read_to_string(path)?).ok_or("not an ASCII PGM of two rows and columns or more")?
        }
        None => {
            let wave = |i: u16| (f32::from(i % 64) / 9.0).sin() * (f32::from(i / 64) / 13.0).cos() * 0.5 + 0.45;
            (64, (0..4096).map(wave).collect())
        }
    };
    let mut scene = Scene::new();
    let mut land = Object::new(terrain(columns, &heights)?);
    for (material, ramp) in land.materials.iter_mut().zip(0..) {
        material.ramp = RampChoice::Number(ramp);
    }
    scene.add(land);
    scene.add_light(Light::sun([0.5, 0.6, 0.3]));
    scene.camera = Camera { eye: Vec3::new(0.1, 0.42, 0.75), target: Vec3::new(0.0, 0.05, 0.0), ..Camera::default() };
    let color = |i: usize| {
        let [r, g, b] = COLORS[i / 64].map(|channel| (usize::from(channel) * (i % 64 + 1) / 64) as u8);
        Rgb::new(r, g, b)
    };
    scene.palette = Palette::from_colors(std::array::from_fn(color)).with_ramps(4);
    let mut vga = Vga::new();
    println!("terrain.png: {}", Renderer::new().draw(&scene, &mut vga)?);
    Ok(export::png(&vga, "terrain.png")?)
}
