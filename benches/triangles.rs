//! The raster alone: a cleared 320 × 200 frame, then all front faces, back to front, without a depth
//! buffer. Transform, light and sorting are done before the clock starts.
//!
//! ```text
//! cargo bench --bench triangles
//! MODE13H_TRI=a.tri:b.tri MODE13H_MODEL=model.obj cargo bench --bench triangles
//! ```
//!
//! A `.tri` file holds prepared triangles, so that rasterizers that are no Rust crates can be timed
//! on the same ones: a little-endian u32 count, then for each triangle three times f32 x, y and
//! shade (pixels, pixels, 0 to 255), back to front.

use std::hint::black_box;
use std::path::Path;

use criterion::{Criterion, Throughput, criterion_group, criterion_main};
use mode13h::Angle;
use mode13h::fixed::{I24F8, U8F8};
use mode13h::glam::Vec3;
use mode13h::mesh::{Mesh, shapes};
use mode13h::raster::{DrawStats, Frame, Interpolation, Raster, Vertex};
use mode13h::render::{Renderer, Screen};
use mode13h::scene::{Camera, Scene};
use mode13h::settings::Shading;
use mode13h::vga::Vga;

type Triangles = Vec<([Vertex; 3], Interpolation)>;

/// The triangles of a mesh as the raster gets them, back to front.
fn of_mesh(mesh: Mesh, shading: Shading) -> Triangles {
    let mut scene = Scene::showing(mesh);
    scene.camera = Camera::framing(Vec3::ZERO, scene.objects()[0].mesh().bounds().radius);
    scene.objects_mut()[0].angles = [0.4, 0.6, 0.0].map(Angle::from_radians);
    let mut renderer = Renderer::new();
    renderer.settings.accuracy = Some(shading.into());
    let mut triangles = Triangles::new();
    renderer
        .for_each_triangle(&scene, Screen::MODE_13H, |vertices, interpolation| {
            triangles.push((*vertices, interpolation))
        })
        .expect("a legal scene");
    triangles.sort_by_key(|(vertices, _)| vertices.iter().map(|v| u64::from(v.depth())).sum::<u64>());
    triangles
}

fn of_tri(path: &Path) -> Result<Triangles, Box<dyn std::error::Error>> {
    let bytes = std::fs::read(path)?;
    let (count, rest) = bytes.split_first_chunk::<4>().ok_or("too short for a count")?;
    let count = u32::from_le_bytes(*count) as usize;
    let mut numbers = rest.chunks_exact(4).map(|four| f32::from_le_bytes([four[0], four[1], four[2], four[3]]));
    let mut vertex = || -> Result<Vertex, Box<dyn std::error::Error>> {
        let mut next = || numbers.next().ok_or("fewer numbers than its count says");
        let (x, y, shade) = (next()?, next()?, next()?);
        let coordinate = |pixels| I24F8::round_from_f32(pixels).ok_or("a coordinate out of range");
        let shade = U8F8::from_intensity(shade / 255.0, 0, 256);
        Ok(Vertex::new(coordinate(x)?, coordinate(y)?, shade, 0)?)
    };
    (0..count).map(|_| Ok(([vertex()?, vertex()?, vertex()?], Interpolation::GouraudReseeded))).collect()
}

fn draw(triangles: &Triangles, bytes: &mut [u8]) -> DrawStats {
    bytes.fill(0);
    let frame = Frame::new(bytes, Vga::WIDTH as u32, Vga::HEIGHT as u32, Vga::PITCH).expect("a legal frame");
    let mut raster = Raster::new(frame);
    let mut drawn = DrawStats::default();
    for (vertices, interpolation) in triangles {
        drawn += raster.triangle(vertices, *interpolation);
    }
    drawn
}

fn triangles(criterion: &mut Criterion) {
    let mut workloads = Vec::new();
    for name in ["cube", "torus", "teapot"] {
        let mesh = || shapes::by_name(name).expect("listed");
        for shading in Shading::ALL {
            workloads.push((format!("{name}/{shading}"), of_mesh(mesh(), shading)));
        }
    }
    if let Ok(path) = std::env::var("MODE13H_MODEL") {
        let mesh = mode13h_assets::model_file::load(&path).expect("MODE13H_MODEL names a model").mesh;
        workloads.push((format!("{path}/{}", Shading::default()), of_mesh(mesh, Shading::default())));
    }
    if let Some(paths) = std::env::var_os("MODE13H_TRI") {
        for path in std::env::split_paths(&paths) {
            let triangles = of_tri(&path).unwrap_or_else(|error| panic!("{}: {error}", path.display()));
            workloads.push((path.display().to_string(), triangles));
        }
    }

    let mut bytes = vec![0; Vga::WIDTH * Vga::HEIGHT];
    let mut group = criterion.benchmark_group("triangles");
    for (name, triangles) in &workloads {
        let drawn = draw(triangles, &mut bytes);
        println!(
            "{name}: {} triangles, {:.2} pixels each, {} spans",
            triangles.len(),
            f64::from(drawn.pixels) / triangles.len() as f64,
            drawn.spans
        );
        group.throughput(Throughput::Elements(triangles.len() as u64));
        group.bench_function(name, |bencher| bencher.iter(|| draw(black_box(triangles), black_box(&mut bytes))));
    }
}

criterion_group!(benches, triangles);
criterion_main!(benches);
