//! An object's vertices, lit and projected, in arrays: the faces that are turned away, most of a fine model, need
//! places alone.

use alloc::vec::Vec;

use crate::fixed::{I24F8, U8F8};
use crate::raster::Vertex;

/// A vertex of the object at hand, lit and projected.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Default)]
pub(super) struct LitVertex {
    /// Its shade is that of the front: the side that the normal points away from. Of a vertex that
    /// needs clipping only the shade counts.
    pub(super) vertex: Vertex,
    pub(super) back: U8F8,
    pub(super) needs_clipping: bool,
    /// Where a budget asks: a bit for each of the first eight suns, whether it sees it.
    pub(super) suns_seen: u8,
}

/// Where a vertex is on the screen: x and y in 1/256 pixel, in the guard band; or that it needs clipping.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
#[repr(C)]
pub(super) struct Place {
    pub(super) x: i32,
    pub(super) y: i32,
}

impl Place {
    /// Far outside of the guard band.
    pub(super) const NEEDS_CLIPPING: Self = Self { x: i32::MIN, y: 0 };

    #[inline]
    pub(super) fn needs_clipping(self) -> bool {
        self.x == i32::MIN
    }
}

/// All vertices of an object.
#[derive(Debug, Default)]
pub(super) struct LitVertices {
    pub(super) places: Vec<Place>,
    /// 0 of those that need clipping.
    pub(super) depths: Vec<u32>,
    /// Front and back.
    pub(super) shades: Vec<[U8F8; 2]>,
    /// None, or as many.
    pub(super) suns_seen: Vec<u8>,
}

impl LitVertices {
    /// As many vertices, of which nothing is known yet: they are to be put, and lit or left without light.
    pub(super) fn begin(&mut self, count: usize) {
        self.places.resize(count, Place::NEEDS_CLIPPING);
        self.depths.resize(count, 0);
        self.shades.resize(count, [U8F8::default(); 2]);
        self.suns_seen.clear();
    }

    /// Where faces or pixels are lit: no vertex has a shade.
    pub(super) fn leave_without_light(&mut self) {
        self.shades.fill([U8F8::default(); 2]);
    }

    /// Puts a vertex on the screen, or says that it needs clipping.
    #[inline]
    pub(super) fn put(&mut self, i: usize, vertex: Option<Vertex>) {
        (self.places[i], self.depths[i]) = match vertex {
            Some(v) => (Place { x: v.x().to_bits(), y: v.y().to_bits() }, v.depth()),
            None => (Place::NEEDS_CLIPPING, 0),
        };
    }

    /// Vertex number `i`, which there is.
    #[inline]
    pub(super) fn get(&self, i: usize) -> LitVertex {
        let [front, back] = self.shades[i];
        let place = self.places[i];
        let needs_clipping = place.needs_clipping();
        let Place { x, y } = if needs_clipping { Place { x: 0, y: 0 } } else { place };
        LitVertex {
            vertex: Vertex::of_projected(I24F8::from_bits(x), I24F8::from_bits(y), front, self.depths[i]),
            back,
            needs_clipping,
            suns_seen: self.suns_seen.get(i).copied().unwrap_or(0),
        }
    }

    /// Vertex number `i`, which there is and needs no clipping, with the shade of the front or the back.
    #[inline]
    pub(super) fn vertex(&self, i: usize, turned: bool) -> Vertex {
        let Place { x, y } = self.places[i];
        let shade = self.shades[i][usize::from(turned)];
        Vertex::of_projected(I24F8::from_bits(x), I24F8::from_bits(y), shade, self.depths[i])
    }

    /// Bytes that they hold.
    pub(super) fn bytes(&self) -> usize {
        self.places.capacity() * size_of::<Place>()
            + self.depths.capacity() * size_of::<u32>()
            + self.shades.capacity() * size_of::<[U8F8; 2]>()
            + self.suns_seen.capacity()
    }
}
