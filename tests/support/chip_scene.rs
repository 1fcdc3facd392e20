//! A scene for a chip: a cube over a floor that extends under the eye, drawn in bands of rows through the integer
//! vertex path. The same file draws it on the host, so that the two can be compared.

use mode13h::fixed::I16F16;
use mode13h::integer::{
    BinaryAngle, Camera, FixedMesh, Lens, LitVertex, Material, Object, ObjectSun, Placement, Sun, Vector, VertexStage,
    View, average_normals,
};
use mode13h::palette::Ramp;
use mode13h::raster::{DepthBuffer, Frame, Raster};
use mode13h::settings::Shading;

pub(crate) const WIDTH: usize = 320;
pub(crate) const HEIGHT: usize = 200;
/// Rows in memory at a time: 1,280 bytes, and four times that of depths.
const BAND: usize = 4;

const fn at(x: i16, y: i16, z: i16) -> Vector {
    [I16F16::from_int(x), I16F16::from_int(y), I16F16::from_int(z)]
}

static CUBE: [Vector; 8] = [
    at(-1, -1, -1),
    at(1, -1, -1),
    at(-1, 1, -1),
    at(1, 1, -1),
    at(-1, -1, 1),
    at(1, -1, 1),
    at(-1, 1, 1),
    at(1, 1, 1),
];
static CUBE_FACES: [[u16; 3]; 12] = [
    [0, 2, 3],
    [0, 3, 1],
    [4, 5, 7],
    [4, 7, 6],
    [0, 1, 5],
    [0, 5, 4],
    [2, 6, 7],
    [2, 7, 3],
    [0, 4, 6],
    [0, 6, 2],
    [1, 3, 7],
    [1, 7, 5],
];
static FLOOR: [Vector; 4] = [at(-90, -2, 90), at(90, -2, 90), at(-90, -2, -90), at(90, -2, -90)];
static FLOOR_NORMALS: [Vector; 4] = [at(0, 1, 0); 4];
static FLOOR_FACES: [[u16; 3]; 2] = [[0, 1, 3], [0, 3, 2]];

/// The hash of the frame's 64,000 bytes (FNV-1a, 64 bits) on every machine, at turn 11°.
pub(crate) const HASH: u64 = 0x07C6_6D61_D123_C5EE;

/// Draws the frame, band by band, and gives each to `band` with its first row.
pub(crate) fn draw(degrees: i32, mut band: impl FnMut(usize, &[u8])) -> Option<()> {
    let mut normals = [Vector::default(); 8];
    average_normals(&CUBE, &CUBE_FACES, &mut normals).ok()?;
    let cube = FixedMesh::new(&CUBE, &normals, &CUBE_FACES, true).ok()?;
    let floor = FixedMesh::new(&FLOOR, &FLOOR_NORMALS, &FLOOR_FACES, false).ok()?;

    let lens = Lens::new(WIDTH as u32, HEIGHT as u32, (5, 6), BinaryAngle::from_degrees(40)).ok()?;
    let camera = Camera { eye: at(0, 2, 7), target: at(0, 0, 0), up: at(0, 1, 0), near: I16F16::ONE };
    let view = View::new(&camera, lens).ok()?;
    let suns = [Sun { direction: at(4, 6, 10), intensity: I16F16::ONE }];
    let material = |first| {
        Ramp::new(first, 128).map(|ramp| Material {
            ambient: I16F16::from_bits(65_536 * 15 / 100),
            diffuse: I16F16::from_bits(65_536 * 85 / 100),
            ramp,
        })
    };
    let (red, blue) = ([material(0)?], [material(128)?]);

    let turned = Placement {
        angles: [BinaryAngle::from_degrees(degrees), BinaryAngle::from_degrees(3 * degrees), BinaryAngle::default()],
        ..Placement::default()
    };
    let cube = Object { mesh: cube, placement: turned, materials: &red };
    let floor = Object { mesh: floor, placement: Placement::default(), materials: &blue };
    let (mut lit, mut beams) = ([LitVertex::default(); 8], [ObjectSun::default(); 1]);
    let cube = VertexStage::new(&view, cube, &suns, Shading::Gouraud88Reseeded, &mut lit, &mut beams).ok()?;
    let (mut lit, mut beams) = ([LitVertex::default(); 4], [ObjectSun::default(); 1]);
    let floor = VertexStage::new(&view, floor, &suns, Shading::Flat, &mut lit, &mut beams).ok()?;

    let (mut pixels, mut depths) = ([0; WIDTH * BAND], [0_u32; WIDTH * BAND]);
    for first in (0..HEIGHT).step_by(BAND) {
        pixels.fill(0);
        let rows = first as u32..(first + BAND) as u32;
        let frame = Frame::band(&mut pixels, WIDTH as u32, HEIGHT as u32, WIDTH, rows).ok()?;
        let mut depth = DepthBuffer::new(&mut depths, &frame).ok()?;
        depth.clear();
        let mut raster = Raster::new(frame).with_depth(depth);
        for stage in [&cube, &floor] {
            stage.faces(|vertices, interpolation| {
                raster.triangle(vertices, interpolation);
            });
        }
        band(first, &pixels);
    }
    Some(())
}
