//! Our raster: one triangle per call, in batches, and in batches with effects.

use mode13h::internals::raster::effects::{
    Attributes, EffectBatch, EffectFace, PixelPipeline, ShadeSource, TextureStage,
};
use mode13h::internals::span::texture::Texels;
use mode13h::raster::{DepthMemory, Frame, Interpolation, Raster, Vertex};
use mode13h::settings::Mapping;
use mode13h::span::Kernel;

use crate::candidate::{Candidate, Triangle};
use crate::drawing::{Drawing, Material, SIDE_BITS};
use crate::{HEIGHT, WIDTH};

fn interpolation(vertices: &[Vertex; 3], drawing: Drawing) -> Interpolation {
    match drawing {
        Drawing::Flat => Interpolation::Flat(vertices[0].shade().nearest()),
        _ => Interpolation::Gouraud88Reseeded,
    }
}

/// A frame and, if the drawing has one, its depth buffer.
struct Target {
    bytes: Vec<u8>,
    depths: Option<DepthMemory>,
    kernel: Kernel,
}

impl Target {
    fn new(drawing: Drawing, kernel: Kernel) -> Self {
        let depths = drawing.has_depth().then(DepthMemory::new);
        Self { bytes: vec![0; WIDTH * HEIGHT], depths, kernel }
    }

    /// The raster, with its depths as if cleared.
    fn raster(&mut self) -> Raster<'_> {
        let frame = Frame::new(&mut self.bytes, WIDTH as u32, HEIGHT as u32, WIDTH).expect("a legal frame");
        let raster = Raster::new(frame).with_kernel(self.kernel);
        match &mut self.depths {
            Some(depths) => raster.with_depth_memory(depths),
            None => raster,
        }
    }

    fn read(&self, bytes: &mut [u8]) {
        bytes.copy_from_slice(&self.bytes);
    }
}

/// Triangles in the format of `Raster`.
fn shaded(triangles: &[Triangle], drawing: Drawing) -> Vec<([Vertex; 3], Interpolation)> {
    let of = |triangle: &Triangle| {
        let vertices = triangle.map(|corner| corner.vertex);
        (vertices, interpolation(&vertices, drawing))
    };
    triangles.iter().map(of).collect()
}

/// The raster: one triangle per call, or one list per call. Packing the batches of a list is timed, too.
pub struct Plain {
    triangles: Vec<([Vertex; 3], Interpolation)>,
    target: Target,
    is_list: bool,
}

impl Plain {
    pub fn one_by_one(triangles: &[Triangle], drawing: Drawing, kernel: Kernel) -> Self {
        Self { triangles: shaded(triangles, drawing), target: Target::new(drawing, kernel), is_list: false }
    }

    pub fn batches(triangles: &[Triangle], drawing: Drawing, kernel: Kernel) -> Self {
        Self { is_list: true, ..Self::one_by_one(triangles, drawing, kernel) }
    }
}

impl Candidate for Plain {
    fn name(&self) -> String {
        format!("{}, {}", if self.is_list { "batches" } else { "one by one" }, self.target.kernel)
    }

    fn is_ours(&self) -> bool {
        true
    }

    fn clear(&mut self, index: u8) {
        self.target.bytes.fill(index);
    }

    fn draw(&mut self) {
        let mut raster = self.target.raster();
        let triangles = self.triangles.iter().map(|(vertices, interpolation)| (vertices, *interpolation));
        if self.is_list {
            raster.triangles(triangles);
        } else {
            for (vertices, interpolation) in triangles {
                raster.triangle(vertices, interpolation);
            }
        }
    }

    fn read(&mut self, bytes: &mut [u8]) {
        self.target.read(bytes);
    }
}

/// The pixel stages, many faces at a time. Packing the batches is timed, too.
pub struct Effects<'a> {
    faces: Vec<EffectFace>,
    drawing: Drawing,
    mapping: Mapping,
    material: &'a Material,
    target: Target,
    batch: EffectBatch,
}

impl<'a> Effects<'a> {
    pub fn new(triangles: &[Triangle], drawing: Drawing, material: &'a Material, kernel: Kernel) -> Self {
        let attributes = |[u, v]: [f32; 2]| Attributes {
            // Below 2³¹, and a whole number.
            texture: [u, v].map(|texels| (texels * 65_536.0) as i32),
            ..Attributes::default()
        };
        let face = |triangle: &Triangle| (triangle.map(|corner| corner.vertex), triangle.map(|c| attributes(c.texel)));
        Self {
            faces: triangles.iter().map(face).collect(),
            drawing,
            mapping: if drawing.is_perspective() { Mapping::Perspective } else { Mapping::Affine },
            material,
            target: Target::new(drawing, kernel),
            batch: EffectBatch::new(),
        }
    }
}

impl Effects<'_> {
    /// Uses texture coordinates that are exact at every sixteenth pixel, which the renderer's plan chooses where the
    /// difference is invisible. Allegro also falls back to affine where distances are similar.
    pub fn every_16(self) -> Self {
        Self { mapping: Mapping::Every16, ..self }
    }
}

impl Candidate for Effects<'_> {
    fn name(&self) -> String {
        let every = if self.mapping == Mapping::Every16 { "every 16th, " } else { "" };
        format!("batches, {every}{}", self.target.kernel)
    }

    fn is_ours(&self) -> bool {
        true
    }

    fn clear(&mut self, index: u8) {
        self.target.bytes.fill(index);
    }

    fn draw(&mut self) {
        let (drawing, material) = (self.drawing, self.material);
        let interpolation = if drawing.is_lit() { Interpolation::Gouraud88Reseeded } else { Interpolation::Flat(255) };
        let pipeline = PixelPipeline {
            source: ShadeSource::Shaded(interpolation),
            texture: Some(TextureStage {
                texels: Texels::new(&material.texels, SIDE_BITS, SIDE_BITS).expect("as many texels"),
                levels: None,
                mapping: self.mapping,
                tables: [material.table(drawing); 3],
            }),
            blend: (drawing == Drawing::Translucent).then_some(&*material.mixed),
            ..PixelPipeline::PLAIN
        };
        let mut raster = self.target.raster();
        raster.faces_with_effects(&self.faces, &pipeline, &mut self.batch);
    }

    fn read(&mut self, bytes: &mut [u8]) {
        self.target.read(bytes);
    }
}
