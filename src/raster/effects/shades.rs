//! The first stages of a span: shades from their source, with an image, or mixed from three channels.

use super::Buffers;
use super::curve::CurvePlane;
use super::listing::FaceCorners;
use super::pipeline::{Mix, PixelPipeline, ShadeSource};
use super::spans::{Shaded, Spans};
use crate::raster::columns::Value;
use crate::raster::interpolation::Interpolation;
use crate::raster::paint::{to_bytes, to_nearest_bytes};
use crate::span::channels::{mix_cube, mix_nearest};
use crate::span::dither::Thresholds;
use crate::span::{Kernel, lookup, lookup_row};

impl Spans<'_> {
    /// The bytes of all spans before fog and blending.
    pub(super) fn shade(&self, buffers: &mut Buffers, pipeline: &PixelPipeline<'_>, kernel: Kernel) {
        let n = self.pixels();
        let Some(stage) = pipeline.texture() else {
            match pipeline.channels() {
                None => self.shade_bytes(buffers, pipeline, kernel),
                Some(mix) => {
                    self.shade_channels(buffers, pipeline, kernel);
                    self.mix(buffers, mix, pipeline.dither());
                }
            }
            return;
        };
        let mix = pipeline.channels();
        match mix {
            Some(_) => self.shade_channels(buffers, pipeline, kernel),
            None => self.shade_bytes(buffers, pipeline, kernel),
        }
        let Buffers { bytes, other, channels, .. } = &mut *buffers;
        self.texels(stage, other, kernel);
        let Some(mix) = mix else { return lookup_row(&mut bytes[..n], other, stage.tables[0]) };
        for (channel, table) in channels.iter_mut().zip(stage.tables) {
            lookup_row(&mut channel[..n], other, table);
        }
        self.mix(buffers, mix, pipeline.dither());
    }

    /// The bytes of pixels with a single shade.
    #[inline(never)]
    fn shade_bytes(&self, buffers: &mut Buffers, pipeline: &PixelPipeline<'_>, kernel: Kernel) {
        let Buffers { bytes, other, shades: [shades, ..], .. } = buffers;
        match pipeline.source() {
            ShadeSource::Shaded(interpolation) => {
                self.fill(Shaded { value: None, interpolation, dither: pipeline.dither() }, bytes, kernel);
            }
            ShadeSource::NormalTable(table) => {
                for (i, out) in [&mut *bytes, other].into_iter().enumerate() {
                    self.fill(Shaded::linear(Value::Slope(i)), out, kernel);
                }
                lookup(&mut bytes[..self.pixels()], other, table);
            }
            ShadeSource::Lit(light) => {
                self.light_each::<1>(kernel, &light, [shades]);
                self.round(shades, pipeline.dither(), bytes);
            }
            ShadeSource::LitEvery(spacing, light) => {
                let thresholds = pipeline.dither().unwrap_or(Thresholds::HALVES);
                self.light_some::<1>(kernel, (spacing, &light), thresholds, [bytes]);
            }
            ShadeSource::Curved(limits) => {
                let plane = |face: &FaceCorners<'_>| CurvePlane::new(face, limits, 1);
                self.each(shades, plane, |plane, span, shades| {
                    plane.fill((span.x, span.y), 0, shades, kernel);
                });
                self.round(shades, pipeline.dither(), bytes);
            }
        }
    }

    /// The bytes of pixels with three channels.
    #[inline(never)]
    fn shade_channels(&self, buffers: &mut Buffers, pipeline: &PixelPipeline<'_>, kernel: Kernel) {
        let Buffers { channels, shades, .. } = buffers;
        let mut bytes = channels.each_mut().map(|channel| &mut channel[..]);
        let mut shades = shades.each_mut().map(|shades| &mut shades[..]);
        match pipeline.source() {
            // A table of normals gives one shade; there is none for channels.
            ShadeSource::Shaded(_) | ShadeSource::NormalTable(_) => {
                let interpolation = match pipeline.source() {
                    ShadeSource::Shaded(interpolation) => interpolation,
                    _ => Interpolation::default(),
                };
                for (i, bytes) in bytes.iter_mut().enumerate() {
                    let value = Some(Value::Channel(i));
                    self.fill(Shaded { value, interpolation, dither: None }, bytes, kernel);
                }
                return;
            }
            ShadeSource::LitEvery(spacing, light) => {
                return self.light_some::<3>(kernel, (spacing, &light), Thresholds::HALVES, bytes);
            }
            ShadeSource::Lit(light) => self.light_each::<3>(kernel, &light, shades.each_mut().map(|of| &mut **of)),
            ShadeSource::Curved(limits) => {
                for (i, shades) in shades.iter_mut().enumerate() {
                    let plane = |face: &FaceCorners<'_>| CurvePlane::new(face, limits, 3);
                    self.each(shades, plane, |plane, span, shades| {
                        plane.fill((span.x, span.y), i, shades, kernel);
                    });
                }
            }
        }
        for (shades, bytes) in shades.iter().zip(bytes) {
            self.round(shades, None, bytes);
        }
    }

    /// Rounds shades to bytes by thresholds.
    fn round(&self, shades: &[u16], dither: Option<Thresholds>, bytes: &mut [u8]) {
        let Some(dither) = dither else {
            let n = self.pixels();
            return to_nearest_bytes(&shades[..n], &mut bytes[..n]);
        };
        for span in self.iter() {
            let pixels = span.pixels();
            to_bytes(&shades[pixels.clone()], span.thresholds(dither), span.column(), &mut bytes[pixels]);
        }
    }

    /// Mixes three channels to one index.
    fn mix(&self, buffers: &mut Buffers, mix: Mix<'_>, dither: Option<Thresholds>) {
        let dither = dither.unwrap_or(Thresholds::HALVES);
        let Buffers { bytes, channels, .. } = buffers;
        if let Mix::Only(channel) = mix {
            return bytes.copy_from_slice(&channels[channel.min(2)]);
        }
        for span in self.iter() {
            let bytes = &mut bytes[span.pixels()];
            let [red, green, blue] = &*channels;
            let pixels = span.pixels();
            let (red, green, blue) = (&red[pixels.clone()], &green[pixels.clone()], &blue[pixels]);
            let (thresholds, column) = (span.thresholds(dither), span.column());
            match mix {
                Mix::Nearest { map, spread } => {
                    mix_nearest(bytes, red, green, blue, thresholds, column, spread, map);
                }
                Mix::Cube | Mix::Only(_) => mix_cube(bytes, red, green, blue, thresholds, column),
            }
        }
    }
}
