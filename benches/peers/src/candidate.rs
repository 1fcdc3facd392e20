//! Who draws: each with triangles in its own format, made before the clock starts.

use std::ffi::c_int;

use mode13h::fixed::U8F8;
use mode13h::raster::{Batch, Frame, Raster, Interpolation, Vertex};
use mode13h::span::Kernel;
use retrofire_core::geom::vertex;
use retrofire_core::math::point::pt3;
use retrofire_core::render::raster::{ScreenPt, tri_fill};

use crate::{HEIGHT, WIDTH};

/// Draws what it was given into its own frame.
pub trait Candidate {
    fn name(&self) -> String;
    /// Whether it is ours.
    fn is_ours(&self) -> bool {
        false
    }
    fn clear(&mut self, index: u8);
    fn draw(&mut self);
    fn read(&mut self, bytes: &mut [u8]);
}

/// Gouraud's shades, or one a triangle: its first vertex's.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Shade {
    Linear,
    Flat,
}

/// Everybody, with these triangles; ours with this kernel and the portable one.
pub fn all(triangles: &[[Vertex; 3]], shade: Shade, kernel: Kernel) -> Vec<Box<dyn Candidate>> {
    let mut all: Vec<Box<dyn Candidate>> = vec![
        Box::new(Allegro::<Float>::new(triangles, shade)),
        Box::new(Allegro::<Fixed>::new(triangles, shade)),
        Box::new(Retrofire::new(triangles, shade)),
    ];
    for kernel in [Kernel::PORTABLE, kernel] {
        all.push(Box::new(Ours::new(triangles, shade, kernel)));
        all.push(Box::new(Batches::new(triangles, shade, kernel)));
    }
    all
}

/// x, y in pixels and the shade, as f32, which holds them exactly.
fn floats(v: &Vertex) -> [f32; 3] {
    [v.x().to_bits() as f32 / 256.0, v.y().to_bits() as f32 / 256.0, f32::from(v.shade().to_bits()) / 256.0]
}

fn is_inside(triangles: &[[Vertex; 3]]) -> bool {
    let within = |u: i32, most: usize| (0..=256 * most as i32).contains(&u);
    triangles.iter().flatten().all(|v| within(v.x().to_bits(), WIDTH) && within(v.y().to_bits(), HEIGHT))
}

fn interpolation(vertices: &[Vertex; 3], shade: Shade) -> Interpolation {
    match shade {
        Shade::Linear => Interpolation::GouraudReseeded,
        Shade::Flat => Interpolation::Flat(vertices[0].shade().nearest()),
    }
}

/// The raster, a triangle a call.
struct Ours {
    triangles: Vec<([Vertex; 3], Interpolation)>,
    kernel: Kernel,
    bytes: Vec<u8>,
}

impl Ours {
    fn new(triangles: &[[Vertex; 3]], shade: Shade, kernel: Kernel) -> Self {
        let triangles = triangles.iter().map(|vertices| (*vertices, interpolation(vertices, shade))).collect();
        Self { triangles, kernel, bytes: vec![0; WIDTH * HEIGHT] }
    }
}

impl Candidate for Ours {
    fn name(&self) -> String {
        format!("one by one, {}", self.kernel)
    }

    fn is_ours(&self) -> bool {
        true
    }

    fn clear(&mut self, index: u8) {
        self.bytes.fill(index);
    }

    fn draw(&mut self) {
        let frame = Frame::new(&mut self.bytes, WIDTH as u32, HEIGHT as u32, WIDTH).expect("a legal frame");
        let mut raster = Raster::new(frame).with_kernel(self.kernel);
        for (vertices, interpolation) in &self.triangles {
            raster.triangle(vertices, *interpolation);
        }
    }

    fn read(&mut self, bytes: &mut [u8]) {
        bytes.copy_from_slice(&self.bytes);
    }
}

/// The raster, a batch a call.
struct Batches {
    batches: Vec<Batch>,
    kernel: Kernel,
    bytes: Vec<u8>,
}

impl Batches {
    fn new(triangles: &[[Vertex; 3]], shade: Shade, kernel: Kernel) -> Self {
        let mut batches = Vec::new();
        for triangles in triangles.chunks(Batch::CAPACITY) {
            let mut batch = Batch::new();
            for vertices in triangles {
                assert!(batch.push(vertices, interpolation(vertices, shade)), "there is room");
            }
            batches.push(batch);
        }
        Self { batches, kernel, bytes: vec![0; WIDTH * HEIGHT] }
    }
}

impl Candidate for Batches {
    fn name(&self) -> String {
        format!("batches, {}", self.kernel)
    }

    fn is_ours(&self) -> bool {
        true
    }

    fn clear(&mut self, index: u8) {
        self.bytes.fill(index);
    }

    fn draw(&mut self) {
        let frame = Frame::new(&mut self.bytes, WIDTH as u32, HEIGHT as u32, WIDTH).expect("a legal frame");
        let mut raster = Raster::new(frame).with_kernel(self.kernel);
        for batch in &self.batches {
            raster.batch(batch);
        }
    }

    fn read(&mut self, bytes: &mut [u8]) {
        bytes.copy_from_slice(&self.bytes);
    }
}

type Corner = retrofire_core::geom::Vertex<ScreenPt, f32>;

/// The scan conversion of `retrofire-core`, with a byte written where it writes colours, and without its
/// division by z at every pixel.
struct Retrofire {
    triangles: Vec<[Corner; 3]>,
    shade: Shade,
    bytes: Vec<u8>,
}

impl Retrofire {
    fn new(triangles: &[[Vertex; 3]], shade: Shade) -> Self {
        let corner = |v: &Vertex| {
            let [x, y, shade] = floats(v);
            // Half a shade, so that cutting off gives the nearest.
            vertex(pt3(x, y, 1.0), shade + 0.5)
        };
        let triangles = triangles.iter().map(|vertices| vertices.each_ref().map(corner)).collect();
        Self { triangles, shade, bytes: vec![0; WIDTH * HEIGHT] }
    }
}

impl Candidate for Retrofire {
    fn name(&self) -> String {
        "retrofire".to_owned()
    }

    fn clear(&mut self, index: u8) {
        self.bytes.fill(index);
    }

    fn draw(&mut self) {
        let (bytes, linear) = (&mut self.bytes, self.shade == Shade::Linear);
        for corners in &self.triangles {
            // At most 255.5.
            let index = corners[0].attrib as u8;
            tri_fill(corners.clone(), |line| {
                let (from, to) = (line.xs.start.min(WIDTH), line.xs.end.min(WIDTH));
                let Some(row) = bytes.get_mut(line.y * WIDTH + from..line.y * WIDTH + to.max(from)) else { return };
                if linear {
                    for (pixel, (_, shade)) in row.iter_mut().zip(line.vs) {
                        *pixel = shade as u8;
                    }
                } else {
                    row.fill(index);
                }
            });
        }
    }

    fn read(&mut self, bytes: &mut [u8]) {
        bytes.copy_from_slice(&self.bytes);
    }
}

/// `V3D_f`.
#[repr(C)]
pub struct Float {
    at: [f32; 3],
    texel: [f32; 2],
    shade: c_int,
}

/// `V3D`: 16.16.
#[repr(C)]
pub struct Fixed {
    at: [i32; 3],
    texel: [i32; 2],
    shade: c_int,
}

unsafe extern "C" {
    fn peers_allegro_start(width: c_int, height: c_int) -> c_int;
    fn peers_allegro_clip(on: c_int);
    fn peers_allegro_clear(index: c_int);
    fn peers_allegro_read(bytes: *mut u8);
    fn peers_allegro_float(kind: c_int, vertices: *mut Float, triangles: c_int);
    fn peers_allegro_fixed(kind: c_int, vertices: *mut Fixed, triangles: c_int);
}

/// Makes Allegro's bitmap. Once.
pub fn start_allegro() -> Result<(), &'static str> {
    // SAFETY: called once, before anything else of Allegro's.
    match unsafe { peers_allegro_start(WIDTH as c_int, HEIGHT as c_int) } {
        0 => Ok(()),
        _ => Err("Allegro does not start"),
    }
}

/// A vertex of Allegro's: shades are whole numbers there, and so are the coordinates of pixel centres.
pub trait AllegroVertex: Sized {
    const NAME: &'static str;
    fn of(vertex: &Vertex) -> Self;
    fn draw(kind: c_int, vertices: &mut [Self]);
}

fn whole(shade: U8F8) -> c_int {
    c_int::from(shade.nearest())
}

impl AllegroVertex for Float {
    const NAME: &'static str = "Allegro, float";

    fn of(vertex: &Vertex) -> Self {
        let [x, y, _] = floats(vertex);
        Self { at: [x - 0.5, y - 0.5, 0.0], texel: [0.0; 2], shade: whole(vertex.shade()) }
    }

    fn draw(kind: c_int, vertices: &mut [Self]) {
        // SAFETY: three vertices a triangle, in the layout of `V3D_f`; the bitmap is there.
        unsafe { peers_allegro_float(kind, vertices.as_mut_ptr(), (vertices.len() / 3) as c_int) }
    }
}

impl AllegroVertex for Fixed {
    const NAME: &'static str = "Allegro, fixed";

    fn of(vertex: &Vertex) -> Self {
        let at = [(vertex.x().to_bits() - 128) << 8, (vertex.y().to_bits() - 128) << 8, 0];
        Self { at, texel: [0; 2], shade: whole(vertex.shade()) }
    }

    fn draw(kind: c_int, vertices: &mut [Self]) {
        // SAFETY: three vertices a triangle, in the layout of `V3D`; the bitmap is there.
        unsafe { peers_allegro_fixed(kind, vertices.as_mut_ptr(), (vertices.len() / 3) as c_int) }
    }
}

/// One of Allegro's two kinds of triangles. All share one bitmap.
struct Allegro<V> {
    vertices: Vec<V>,
    kind: c_int,
    inside: bool,
}

impl<V: AllegroVertex> Allegro<V> {
    fn new(triangles: &[[Vertex; 3]], shade: Shade) -> Self {
        // POLYTYPE_FLAT, POLYTYPE_GCOL
        let kind = if shade == Shade::Flat { 0 } else { 1 };
        Self { vertices: triangles.iter().flatten().map(V::of).collect(), kind, inside: is_inside(triangles) }
    }
}

impl<V: AllegroVertex> Candidate for Allegro<V> {
    fn name(&self) -> String {
        V::NAME.to_owned()
    }

    fn clear(&mut self, index: u8) {
        // SAFETY: the bitmap is there.
        unsafe {
            peers_allegro_clear(c_int::from(index));
            peers_allegro_clip(c_int::from(!self.inside));
        }
    }

    fn draw(&mut self) {
        V::draw(self.kind, &mut self.vertices);
    }

    fn read(&mut self, bytes: &mut [u8]) {
        assert_eq!(bytes.len(), WIDTH * HEIGHT);
        // SAFETY: as many bytes as the bitmap has pixels.
        unsafe { peers_allegro_read(bytes.as_mut_ptr()) }
    }
}
