//! A frame as a chip would draw it: a lit pyramid in integers alone, four rows in memory at a time, as a PGM picture on
//! standard output. The parts of the engine used here need no `std`, no allocator and no floats.
//!
//!     cargo run --release --no-default-features --example chip > pyramid.pgm

use std::io::{self, Write};

use mode13h::fixed::I16F16;
use mode13h::integer::{
    BinaryAngle, Camera, FixedMesh, Lens, LitVertex, Material, Object, ObjectSun, Placement, Sun, Vector, VertexStage,
    View, average_normals,
};
use mode13h::palette::Ramp;
use mode13h::raster::{DepthBuffer, Frame, Raster};
use mode13h::settings::Shading;

const WIDTH: u32 = 320;
const HEIGHT: u32 = 200;
const BAND: u32 = 4;

const fn at(x: i16, y: i16, z: i16) -> Vector {
    [I16F16::from_int(x), I16F16::from_int(y), I16F16::from_int(z)]
}

static CORNERS: [Vector; 5] = [at(-1, -1, 1), at(1, -1, 1), at(1, -1, -1), at(-1, -1, -1), at(0, 1, 0)];
static FACES: [[u16; 3]; 6] = [[0, 1, 4], [1, 2, 4], [2, 3, 4], [3, 0, 4], [0, 2, 1], [0, 3, 2]];

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let mut normals = [Vector::default(); 5];
    average_normals(&CORNERS, &FACES, &mut normals)?;
    let mesh = FixedMesh::new(&CORNERS, &normals, &FACES, true)?;
    let lens = Lens::new(WIDTH, HEIGHT, (5, 6), BinaryAngle::from_degrees(40))?;
    let camera = Camera { eye: at(0, 1, 5), target: at(0, 0, 0), up: at(0, 1, 0), near: I16F16::ONE };
    let view = View::new(&camera, lens)?;
    let suns = [Sun { direction: at(4, 6, 10), intensity: I16F16::ONE }];
    let bits = |share: i32| I16F16::from_bits(65_536 * share / 100);
    let materials = [Material { ambient: bits(15), diffuse: bits(85), ramp: Ramp::WHOLE }];
    let angles = [BinaryAngle::default(), BinaryAngle::from_degrees(30), BinaryAngle::default()];
    let object = Object { mesh, placement: Placement { angles, ..Placement::default() }, materials: &materials };
    let (mut lit, mut beams) = ([LitVertex::default(); 5], [ObjectSun::default(); 1]);
    let stage = VertexStage::new(&view, object, &suns, Shading::Gouraud88Reseeded, &mut lit, &mut beams)?;

    let mut out = io::stdout().lock();
    writeln!(out, "P5 {WIDTH} {HEIGHT} 255")?;
    for first in (0..HEIGHT).step_by(BAND as usize) {
        let (mut bytes, mut depths) = ([0; (WIDTH * BAND) as usize], [0_u32; (WIDTH * BAND) as usize]);
        let rows = first..first + BAND;
        let frame = Frame::band(&mut bytes, WIDTH, HEIGHT, WIDTH as usize, rows)?;
        let depth = DepthBuffer::new(&mut depths, &frame)?;
        let mut raster = Raster::new(frame).with_depth(depth);
        stage.faces(|vertices, interpolation| {
            raster.triangle(vertices, interpolation);
        });
        out.write_all(&bytes)?;
    }
    Ok(())
}
