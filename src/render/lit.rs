//! An object's vertices, lit and projected, in arrays: the back faces, most of a fine model, need
//! places alone.

use alloc::vec::Vec;

use crate::fixed::{I24F8, U8F8};
use crate::raster::Vertex;
pub(super) use crate::raster::batch::indexed::ScreenPos;

/// A face of the geometry that is drawn.
#[derive(Clone, Copy, Debug)]
pub(super) struct Face {
    /// Its index in the mesh, or in what splitting made of it.
    pub(super) index: u32,
    /// Its vertices.
    pub(super) indices: [u32; 3],
    pub(super) surface: u16,
    pub(super) back_facing: bool,
}

/// A vertex of the object at hand, lit and projected.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Default)]
pub(super) struct LitVertex {
    /// Its shade is that of the front: the side that the normal points away from. In a vertex that
    /// needs clipping only the shade counts.
    pub(super) vertex: Vertex,
    pub(super) back: U8F8,
    pub(super) needs_clipping: bool,
}

/// All vertices of an object.
#[derive(Debug, Default)]
pub(super) struct ShadedVertices {
    pub(super) places: Vec<ScreenPos>,
    /// 0 of those that need clipping.
    pub(super) depths: Vec<u32>,
    /// Front and back.
    pub(super) shades: Vec<[U8F8; 2]>,
}

impl ShadedVertices {
    /// Makes room for `count` vertices of which nothing is known yet. They are to be put on the screen, and lit or left
    /// without light.
    pub(super) fn begin(&mut self, count: usize) {
        self.places.resize(count, ScreenPos::NEEDS_CLIPPING);
        self.depths.resize(count, 0);
        self.shades.resize(count, [U8F8::default(); 2]);
    }

    /// Leaves vertices without shades: faces or pixels are lit.
    pub(super) fn leave_without_light(&mut self) {
        self.shades.fill([U8F8::default(); 2]);
    }

    /// Puts a vertex on the screen, or says that it needs clipping.
    #[inline]
    pub(super) fn put(&mut self, i: usize, vertex: Option<Vertex>) {
        (self.places[i], self.depths[i]) = match vertex {
            Some(v) => (ScreenPos::new(v.x().to_bits(), v.y().to_bits()), v.depth()),
            None => (ScreenPos::NEEDS_CLIPPING, 0),
        };
    }

    /// Vertex number `i`, which there is.
    #[inline]
    pub(super) fn get(&self, i: usize) -> LitVertex {
        let [front, back] = self.shades[i];
        let place = self.places[i];
        let needs_clipping = place.needs_clipping();
        let place = if needs_clipping { ScreenPos::new(0, 0) } else { place };
        LitVertex { vertex: vertex(place, front, self.depths[i]), back, needs_clipping }
    }

    /// Vertex number `i`, which there is and needs no clipping, with the shade of the front or the back.
    #[inline]
    pub(super) fn vertex(&self, i: usize, turned: bool) -> Vertex {
        vertex(self.places[i], self.shades[i][usize::from(turned)], self.depths[i])
    }

    /// Bytes that they hold.
    pub(super) fn bytes(&self) -> usize {
        self.places.capacity() * size_of::<ScreenPos>()
            + self.depths.capacity() * size_of::<u32>()
            + self.shades.capacity() * size_of::<[U8F8; 2]>()
    }
}

#[inline]
fn vertex(place: ScreenPos, shade: U8F8, depth: u32) -> Vertex {
    Vertex::of_projected(I24F8::from_bits(place.x()), I24F8::from_bits(place.y()), shade, depth)
}
