//! The scan conversion of `retrofire-core`, writing a byte where it writes colours.

use retrofire_core::geom::{Vertex, vertex};
use retrofire_core::math::point::pt3;
use retrofire_core::render::raster::{ScreenPt, tri_fill};
use retrofire_core::render::tex::{SamplerRepeatPot, TexCoord, Texture, uv};
use retrofire_core::util::{Buf2, Dims};

use crate::candidate::{Candidate, Triangle, floats};
use crate::drawing::{Drawing, Material, SIDE_BITS};
use crate::{HEIGHT, WIDTH};

pub struct Retrofire {
    shaded: Vec<[Vertex<ScreenPt, f32>; 3]>,
    textured: Vec<[Vertex<ScreenPt, TexCoord>; 3]>,
    drawing: Drawing,
    texture: Texture<Buf2<u8>>,
    bytes: Vec<u8>,
    /// Reciprocals of distances, so greater is nearer.
    depths: Vec<f32>,
}

impl Retrofire {
    pub fn new(triangles: &[Triangle], drawing: Drawing, material: &Material) -> Self {
        let mut new = Self {
            shaded: Vec::new(),
            textured: Vec::new(),
            drawing,
            texture: Buf2::new_from(Dims(1 << SIDE_BITS, 1 << SIDE_BITS), material.texels.iter().copied()).into(),
            bytes: vec![0; WIDTH * HEIGHT],
            depths: vec![0.0; WIDTH * HEIGHT],
        };
        if drawing.has_texture() {
            // Divided by the distance, as its own vertex stage leaves them.
            new.textured.extend(triangles.iter().map(|triangle| {
                triangle.map(|corner| {
                    let ([x, y, _], [u, v]) = (floats(&corner.vertex), corner.texel);
                    vertex(pt3(x, y, 1.0 / corner.w), uv(u / corner.w, v / corner.w))
                })
            }));
        } else {
            new.shaded.extend(triangles.iter().map(|triangle| {
                triangle.map(|corner| {
                    let [x, y, shade] = floats(&corner.vertex);
                    // Plus half a shade, so that truncating rounds to nearest.
                    vertex(pt3(x, y, 1.0 / corner.w), shade + 0.5)
                })
            }));
        }
        new
    }
}

/// The part of a row that lies inside the frame.
fn part(y: usize, xs: &std::ops::Range<usize>) -> Option<std::ops::Range<usize>> {
    let (from, to) = (xs.start.min(WIDTH), xs.end.min(WIDTH));
    (y < HEIGHT).then_some(y * WIDTH + from..y * WIDTH + to.max(from))
}

impl Candidate for Retrofire {
    fn name(&self) -> String {
        "retrofire".to_owned()
    }

    fn clear(&mut self, index: u8) {
        self.bytes.fill(index);
    }

    fn draw(&mut self) {
        let (bytes, depths) = (&mut self.bytes, &mut self.depths);
        if self.drawing.has_depth() {
            depths.fill(0.0);
        }
        for corners in &self.textured {
            let (texture, sampler) = (&self.texture, SamplerRepeatPot::new(&self.texture));
            tri_fill(*corners, |mut line| {
                let Some(part) = part(line.y, &line.xs) else { return };
                let cells = bytes[part.clone()].iter_mut().zip(&mut depths[part]);
                for ((pixel, depth), fragment) in cells.zip(line.fragments()) {
                    if fragment.pos.z() > *depth {
                        (*pixel, *depth) = (sampler.sample_abs(texture, fragment.var), fragment.pos.z());
                    }
                }
            });
        }
        for corners in &self.shaded {
            // At most 255.5.
            let index = corners[0].attrib as u8;
            tri_fill(*corners, |line| {
                let Some(part) = part(line.y, &line.xs) else { return };
                let row = &mut bytes[part.clone()];
                match self.drawing {
                    Drawing::Flat => row.fill(index),
                    // Without its division by the distance at every pixel, as these shades are linear on the screen.
                    Drawing::GouraudDepth => {
                        for ((pixel, depth), (at, shade)) in row.iter_mut().zip(&mut depths[part]).zip(line.vs) {
                            if at.z() > *depth {
                                (*pixel, *depth) = (shade as u8, at.z());
                            }
                        }
                    }
                    _ => {
                        for (pixel, (_, shade)) in row.iter_mut().zip(line.vs) {
                            *pixel = shade as u8;
                        }
                    }
                }
            });
        }
    }

    fn read(&mut self, bytes: &mut [u8]) {
        bytes.copy_from_slice(&self.bytes);
    }
}
