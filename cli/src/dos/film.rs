//! Writes films of projected scenes, which [`player`](super::player) reads.

use mode13h::fixed::I16F16;
use mode13h::integer::{FixedMeshParts, Object, Vector};
use mode13h::internals::IntegerFrame;
use mode13h::palette::Palette;
use mode13h::settings::Shading;

use super::player::MAGIC;

/// A film to which frames are added one at a time.
pub(super) struct Writer {
    shading: Option<Shading>,
    meshes: Vec<Vec<u8>>,
    frames: Vec<Vec<u8>>,
    /// The largest number of vertices in a mesh.
    pub(super) vertices: usize,
}

impl Writer {
    pub(super) fn new() -> Writer {
        Writer { shading: None, meshes: Vec::new(), frames: Vec::new(), vertices: 0 }
    }

    /// Adds a frame. The error says what is too much for a film.
    pub(super) fn push(&mut self, frame: &IntegerFrame<'_>) -> Result<(), String> {
        self.shading = Some(frame.shading);
        let mut out = Bytes::default();
        out.word(frame.background.into());
        out.word(frame.is_depth_tested.into());
        let camera = &frame.camera;
        out.vectors(&[camera.eye, camera.target, camera.up]);
        out.fixed(camera.near);
        frame.focal.iter().for_each(|&focal| out.fixed(focal));
        out.count(frame.suns.len())?;
        for sun in frame.suns {
            out.vectors(&[sun.direction]);
            out.fixed(sun.intensity);
        }
        out.count(frame.objects.len())?;
        for (_, object) in &frame.objects {
            self.object(object, &mut out)?;
        }
        self.frames.push(out.0);
        Ok(())
    }

    fn object(&mut self, object: &Object<'_, u32>, out: &mut Bytes) -> Result<(), String> {
        let Object { mesh, placement, materials } = object;
        let parts = mesh.parts();
        let written = mesh_bytes(&parts)?;
        let index = self.meshes.iter().position(|mesh| *mesh == written).unwrap_or_else(|| {
            self.meshes.push(written);
            self.vertices = self.vertices.max(parts.positions.len());
            self.meshes.len() - 1
        });
        out.count(index)?;
        let exponent = i8::try_from(parts.exponent).map_err(|_| "an object's scale is too far from the scene's")?;
        out.word(i32::from(exponent).cast_unsigned());
        out.vectors(&[placement.position, placement.pivot]);
        out.fixed(placement.scale);
        placement.angles.iter().for_each(|angle| out.word(u16::from(*angle).into()));
        out.count(materials.len())?;
        for material in *materials {
            out.fixed(material.ambient);
            out.fixed(material.diffuse);
            out.word(material.ramp.first().into());
            out.word(material.ramp.entries().into());
        }
        Ok(())
    }

    /// The film's bytes, with the colours of the DAC.
    pub(super) fn finish(self, palette: &Palette) -> Result<Vec<u8>, String> {
        let shading = Shading::ALL.iter().position(|&shading| Some(shading) == self.shading).unwrap_or_default();
        let mut out = Bytes::default();
        out.word(MAGIC);
        out.count(shading)?;
        out.count(self.meshes.len())?;
        out.count(self.frames.len())?;
        out.0.extend(palette.colors().iter().flat_map(|color| color.to_dac()));
        out.0.extend(self.meshes.into_iter().flatten());
        for frame in self.frames {
            out.count(frame.len())?;
            out.0.extend(frame);
        }
        Ok(out.0)
    }
}

fn mesh_bytes(parts: &FixedMeshParts<'_, u32>) -> Result<Vec<u8>, String> {
    let mut out = Bytes::default();
    out.count(parts.positions.len())?;
    out.count(parts.triangles.len())?;
    out.word(parts.closed.into());
    out.count(parts.twins.len())?;
    let has_surfaces = !parts.vertex_surfaces.is_empty();
    out.word(has_surfaces.into());
    out.vectors(parts.positions);
    out.vectors(parts.normals);
    let mut before = [0; 3];
    let mut steps = Vec::with_capacity(3 * parts.triangles.len());
    for triangle in parts.triangles {
        for (&index, before) in triangle.iter().zip(&mut before) {
            let index = u16::try_from(index).map_err(|_| "a mesh has more than 65,536 vertices")?;
            steps.push(index.wrapping_sub(*before));
            *before = index;
        }
    }
    out.shorts(&steps);
    out.0.extend(parts.twins.iter().flat_map(|word| word.to_le_bytes()));
    if has_surfaces {
        out.shorts(parts.vertex_surfaces);
        out.shorts(parts.triangle_surfaces);
    }
    Ok(out.0)
}

#[derive(Default)]
struct Bytes(Vec<u8>);

impl Bytes {
    fn word(&mut self, word: u32) {
        self.0.extend(word.to_le_bytes());
    }

    fn count(&mut self, count: usize) -> Result<(), String> {
        self.word(u32::try_from(count).map_err(|_| "the scene is too large")?);
        Ok(())
    }

    fn fixed(&mut self, value: I16F16) {
        self.word(value.to_bits().cast_unsigned());
    }

    fn vectors(&mut self, vectors: &[Vector]) {
        vectors.iter().flatten().for_each(|&value| self.fixed(value));
    }

    fn shorts(&mut self, shorts: &[u16]) {
        self.0.extend(shorts.iter().flat_map(|short| short.to_le_bytes()));
        self.0.resize(self.0.len().next_multiple_of(4), 0);
    }
}
