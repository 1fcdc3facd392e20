//! One loop of a projected scene in 16.16, without floats or std. The program for DOS includes this file, and the tests
//! here compare its frames with the renderer's.
//!
//! The file is little-endian. Numbers are `u32` unless noted; slices of 16 bits are padded to four bytes.
//!
//! ```text
//! MAGIC, index of the shading, meshes, frames
//! 768 bytes: the DAC, 256 entries of three times 6 bits
//! a mesh: vertices, triangles, closed, words of twins, surfaces given (0 or 1)
//!     positions, normals (16.16); indices (u16), less those of the triangle before; twins (u64);
//!     if surfaces are given: of each vertex, of each triangle (u16)
//! a frame: bytes that follow, background, depth-tested
//!     eye, target, up, near, focal lengths (16.16)
//!     suns; each: direction, intensity (16.16)
//!     objects; each: mesh, exponent, position, pivot, scale (16.16), angles x, y, z
//!         materials; each: ambient, diffuse (16.16), first entry of its ramp, entries
//! ```

use alloc::vec::Vec;
use core::array::from_fn;
use mode13h::fixed::I16F16;
use mode13h::integer::{
    BinaryAngle, Camera, FixedMesh, Lens, LitVertex, Material, Object, ObjectSun, Placement, Sun, Vector, VertexStage,
    View,
};
use mode13h::palette::Ramp;
use mode13h::raster::{DepthBuffer, Frame, Raster};
use mode13h::settings::Shading;
use mode13h::span::Kernel;

/// First bytes of a film: its version is the last of them.
pub(crate) const MAGIC: u32 = u32::from_le_bytes(*b"M13\x02");

/// Pixels of a frame.
pub(crate) const PIXELS: usize = 320 * 200;

/// Bytes that are read from the front.
#[derive(Clone, Copy)]
struct Input<'a>(&'a [u8]);

impl<'a> Input<'a> {
    fn bytes(&mut self, count: usize) -> Option<&'a [u8]> {
        let (bytes, rest) = self.0.split_at_checked(count)?;
        self.0 = rest;
        Some(bytes)
    }

    fn word(&mut self) -> Option<u32> {
        let (bytes, rest) = self.0.split_first_chunk()?;
        self.0 = rest;
        Some(u32::from_le_bytes(*bytes))
    }

    fn count(&mut self) -> Option<usize> {
        usize::try_from(self.word()?).ok()
    }

    fn fixed(&mut self) -> Option<I16F16> {
        Some(I16F16::from_bits(self.word()?.cast_signed()))
    }

    fn vector(&mut self) -> Option<Vector> {
        Some([self.fixed()?, self.fixed()?, self.fixed()?])
    }

    fn vectors(&mut self, count: usize) -> Option<Vec<Vector>> {
        // The bytes are known to be there before memory is allocated, and no more is allocated than they need.
        let mut bytes = Input(self.bytes(count.checked_mul(12)?)?);
        let mut vectors = Vec::with_capacity(count);
        for _ in 0..count {
            vectors.push(bytes.vector()?);
        }
        Some(vectors)
    }

    fn shorts(&mut self, count: usize) -> Option<Vec<u16>> {
        let bytes = self.bytes(count.checked_mul(2)?.checked_next_multiple_of(4)?)?;
        Some(bytes.as_chunks().0.iter().take(count).map(|short| u16::from_le_bytes(*short)).collect())
    }
}

/// The numbers of a mesh.
struct Numbers {
    positions: Vec<Vector>,
    normals: Vec<Vector>,
    triangles: Vec<[u16; 3]>,
    closed: bool,
    twins: Vec<u64>,
    surfaces: Option<(Vec<u16>, Vec<u16>)>,
}

impl Numbers {
    fn read(input: &mut Input<'_>) -> Option<Self> {
        let [vertices, triangles, closed, twins, surfaces] = [(); 5].map(|()| input.count());
        let (vertices, triangles) = (vertices?, triangles?);
        Some(Self {
            positions: input.vectors(vertices)?,
            normals: input.vectors(vertices)?,
            triangles: {
                let steps = input.shorts(triangles.checked_mul(3)?)?;
                let mut indices = [0_u16; 3];
                let triangle = |step: &[u16; 3]| {
                    indices = from_fn(|i| indices[i].wrapping_add(step[i]));
                    indices
                };
                steps.as_chunks().0.iter().map(triangle).collect()
            },
            closed: closed? != 0,
            twins: {
                let bytes = input.bytes(twins?.checked_mul(8)?)?;
                bytes.as_chunks().0.iter().map(|word| u64::from_le_bytes(*word)).collect()
            },
            surfaces: match surfaces? {
                0 => None,
                _ => Some((input.shorts(vertices)?, input.shorts(triangles)?)),
            },
        })
    }

    fn mesh(&self) -> Option<FixedMesh<'_>> {
        let mesh = FixedMesh::new(&self.positions, &self.normals, &self.triangles, self.closed).ok()?;
        let mesh = mesh.with_twins(&self.twins);
        match &self.surfaces {
            Some((vertices, triangles)) => mesh.with_surfaces(vertices, triangles).ok(),
            None => Some(mesh),
        }
    }
}

/// A film that was read from unpacked bytes.
pub(crate) struct Film<'a> {
    shading: Shading,
    /// The DAC: 256 entries of red, green and blue, 6 bits each.
    pub(crate) dac: &'a [u8],
    meshes: Vec<Numbers>,
    frames: Vec<Input<'a>>,
}

impl<'a> Film<'a> {
    /// Reads a film; `None` if it is not one, or is truncated.
    pub(crate) fn read(bytes: &'a [u8]) -> Option<Self> {
        let mut input = Input(bytes);
        if input.word()? != MAGIC {
            return None;
        }
        let shading = *Shading::ALL.get(input.count()?)?;
        let (meshes, frames) = (input.count()?, input.count()?);
        let dac = input.bytes(768)?;
        let meshes = (0..meshes).map(|_| Numbers::read(&mut input)).collect::<Option<_>>()?;
        let mut frame = || {
            let length = input.count()?;
            input.bytes(length).map(Input)
        };
        let frames = (0..frames).map(|_| frame()).collect::<Option<Vec<_>>>()?;
        (!frames.is_empty()).then_some(Self { shading, dac, meshes, frames })
    }

    /// Number of frames, at least 1.
    pub(crate) fn frames(&self) -> usize {
        self.frames.len()
    }
}

/// Draws the frames of a film.
pub(crate) struct Player<'a> {
    film: &'a Film<'a>,
    kernel: Kernel,
    meshes: Vec<FixedMesh<'a>>,
    lit: Vec<LitVertex>,
    beams: Vec<ObjectSun>,
    suns: Vec<Sun>,
    materials: Vec<Material>,
    depths: Vec<u32>,
}

impl<'a> Player<'a> {
    /// Allocates everything that any frame needs; `None` if a mesh is invalid.
    pub(crate) fn new(film: &'a Film<'a>, kernel: Kernel) -> Option<Self> {
        let meshes = film.meshes.iter().map(Numbers::mesh).collect::<Option<Vec<_>>>()?;
        let vertices = meshes.iter().map(|mesh| mesh.parts().positions.len()).max().unwrap_or(0);
        let (lit, depths) = (alloc::vec![LitVertex::default(); vertices], alloc::vec![0; PIXELS]);
        let (suns, materials) = (Vec::with_capacity(16), Vec::with_capacity(64));
        Some(Self { film, kernel, meshes, lit, beams: Vec::with_capacity(16), suns, materials, depths })
    }

    /// Draws a frame, counted from 0 and wrapping around, into 320 × 200 bytes; `None` if it is invalid.
    pub(crate) fn draw(&mut self, number: usize, pixels: &mut [u8]) -> Option<()> {
        let mut input = self.film.frames[number % self.film.frames.len()];
        let background = input.word()?.to_le_bytes()[0];
        let is_depth_tested = input.word()? != 0;
        let (eye, target, up) = (input.vector()?, input.vector()?, input.vector()?);
        let camera = Camera { eye, target, up, near: input.fixed()? };
        let lens = Lens::with_focal_lengths(320, 200, [input.fixed()?, input.fixed()?]).ok()?;
        let view = View::new(&camera, lens).ok()?;
        let suns = input.count()?;
        self.suns.clear();
        for _ in 0..suns {
            self.suns.push(Sun { direction: input.vector()?, intensity: input.fixed()? });
        }
        self.beams.resize(suns, ObjectSun::default());

        let mut frame = Frame::new(pixels, 320, 200, 320).ok()?;
        frame.clear(background);
        let mut tested = None;
        let mut plain = None;
        if is_depth_tested {
            let mut depth = DepthBuffer::new(&mut self.depths, &frame).ok()?;
            depth.clear();
            tested = Some(Raster::new(frame).with_kernel(self.kernel).with_depth(depth));
        } else {
            plain = Some(Raster::new(frame).with_kernel(self.kernel));
        }
        for _ in 0..input.count()? {
            let mesh = self.meshes.get(input.count()?)?;
            let exponent = i8::try_from(input.word()?.cast_signed()).ok()?;
            let placement = Placement {
                position: input.vector()?,
                pivot: input.vector()?,
                scale: input.fixed()?,
                angles: [angle(&mut input)?, angle(&mut input)?, angle(&mut input)?],
            };
            self.materials.clear();
            for _ in 0..input.count()? {
                let (ambient, diffuse) = (input.fixed()?, input.fixed()?);
                let first = input.word()?.to_le_bytes()[0];
                let ramp = Ramp::new(first, u16::try_from(input.word()?).ok()?)?;
                self.materials.push(Material { ambient, diffuse, ramp });
            }
            let object = Object { mesh: mesh.with_exponent(exponent), placement, materials: &self.materials };
            let (shading, lit, beams) = (self.film.shading, &mut self.lit, &mut self.beams);
            let stage = VertexStage::new(&view, object, &self.suns, shading, lit, beams).ok()?;
            if let Some(raster) = &mut tested {
                stage.faces(|vertices, interpolation| {
                    raster.triangle(vertices, interpolation);
                });
            } else if let Some(raster) = &mut plain {
                stage.faces(|vertices, interpolation| {
                    raster.triangle(vertices, interpolation);
                });
            }
        }
        Some(())
    }
}

fn angle(input: &mut Input<'_>) -> Option<BinaryAngle> {
    u16::try_from(input.word()?).ok().map(BinaryAngle::from)
}
