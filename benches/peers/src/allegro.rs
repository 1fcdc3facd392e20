//! Allegro 4: its two vertex formats, drawn on one shared bitmap.

use std::ffi::c_int;

use crate::candidate::{Candidate, Corner, Triangle, floats, is_inside};
use crate::drawing::{Drawing, Material, SIDE_BITS};
use crate::{HEIGHT, WIDTH};

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
    fn peers_allegro_start(width: c_int, height: c_int, side: c_int) -> c_int;
    fn peers_allegro_clip(on: c_int);
    fn peers_allegro_clear(index: c_int);
    fn peers_allegro_read(bytes: *mut u8);
    fn peers_allegro_material(texels: *const u8, table: *const u8);
    fn peers_allegro_float(drawing: c_int, vertices: *mut Float, triangles: c_int);
    fn peers_allegro_fixed(drawing: c_int, vertices: *mut Fixed, triangles: c_int);
}

/// Creates Allegro's bitmaps. Call it once.
pub fn start() -> Result<(), &'static str> {
    // SAFETY: called once, before anything else of Allegro's.
    match unsafe { peers_allegro_start(WIDTH as c_int, HEIGHT as c_int, 1 << SIDE_BITS) } {
        0 => Ok(()),
        _ => Err("Allegro does not start"),
    }
}

/// An Allegro vertex: its shades are whole numbers, and so are the coordinates of pixel centres.
pub trait AllegroVertex: Sized {
    const NAME: &'static str;
    fn of(corner: &Corner) -> Self;
    fn draw(drawing: Drawing, vertices: &mut [Self]);
}

fn shade(corner: &Corner) -> c_int {
    c_int::from(corner.vertex.shade().nearest())
}

impl AllegroVertex for Float {
    const NAME: &'static str = "Allegro, float";

    fn of(corner: &Corner) -> Self {
        let [x, y, _] = floats(&corner.vertex);
        Self { at: [x - 0.5, y - 0.5, corner.w], texel: corner.texel, shade: shade(corner) }
    }

    fn draw(drawing: Drawing, vertices: &mut [Self]) {
        // SAFETY: three vertices per triangle, in the layout of `V3D_f`; the bitmaps exist.
        unsafe { peers_allegro_float(drawing as c_int, vertices.as_mut_ptr(), (vertices.len() / 3) as c_int) }
    }
}

impl AllegroVertex for Fixed {
    const NAME: &'static str = "Allegro, fixed";

    fn of(corner: &Corner) -> Self {
        let vertex = &corner.vertex;
        let fixed = |number: f32| (number * 65_536.0) as i32;
        let at = [(vertex.x().to_bits() - 128) << 8, (vertex.y().to_bits() - 128) << 8, fixed(corner.w)];
        Self { at, texel: corner.texel.map(fixed), shade: shade(corner) }
    }

    fn draw(drawing: Drawing, vertices: &mut [Self]) {
        // SAFETY: three vertices per triangle, in the layout of `V3D`; the bitmaps exist.
        unsafe { peers_allegro_fixed(drawing as c_int, vertices.as_mut_ptr(), (vertices.len() / 3) as c_int) }
    }
}

pub struct Allegro<'a, V> {
    vertices: Vec<V>,
    drawing: Drawing,
    material: &'a Material,
    inside: bool,
}

impl<'a, V: AllegroVertex> Allegro<'a, V> {
    pub fn new(triangles: &[Triangle], drawing: Drawing, material: &'a Material) -> Self {
        let vertices = triangles.iter().flatten().map(V::of).collect();
        Self { vertices, drawing, material, inside: is_inside(triangles) }
    }
}

impl<V: AllegroVertex> Candidate for Allegro<'_, V> {
    fn name(&self) -> String {
        V::NAME.to_owned()
    }

    fn clear(&mut self, index: u8) {
        let material = self.material;
        let table = if self.drawing == Drawing::Translucent { &material.mixed } else { &material.lit };
        // SAFETY: the bitmaps exist; the texels fill one of them, and the table has 65,536 entries.
        unsafe {
            peers_allegro_clear(c_int::from(index));
            peers_allegro_clip(c_int::from(!self.inside));
            peers_allegro_material(material.texels.as_ptr(), table.as_ptr());
        }
    }

    fn draw(&mut self) {
        V::draw(self.drawing, &mut self.vertices);
    }

    fn read(&mut self, bytes: &mut [u8]) {
        assert_eq!(bytes.len(), WIDTH * HEIGHT);
        // SAFETY: there are as many bytes as the bitmap has pixels.
        unsafe { peers_allegro_read(bytes.as_mut_ptr()) }
    }
}
