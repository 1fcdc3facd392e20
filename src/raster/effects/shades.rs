//! The first stages of a span: shades from their source, with an image, or mixed from three channels.

use alloc::vec::Vec;

use super::Buffers;
use super::curve::CurvePlane;
use super::listing::FaceCorners;
use super::lit::light_each;
use super::pipeline::{Mix, PixelPipeline, ShadeSource};
use super::spans::{Shaded, Spans};
use crate::lanes::LANES;
use crate::raster::columns::Value;
use crate::raster::interpolation::Interpolation;
use crate::raster::row_shader::{to_bytes, to_nearest_bytes};
use crate::simd::{Lanes8, compiled_for_each_level};
use crate::span::channels::{mix_cube, mix_nearest_eight};
use crate::span::dither::Thresholds;
use crate::span::{Kernel, lookup, lookup_row};

impl Spans<'_> {
    /// The bytes of all spans before fog and blending.
    pub(super) fn shade(&self, buffers: &mut Buffers, pipeline: &PixelPipeline<'_>, kernel: Kernel) {
        let (n, mix) = (self.pixels(), pipeline.channels());
        let Buffers { bytes, other, channels, shades } = &mut *buffers;
        match mix {
            None => {
                let [shades, ..] = shades;
                self.shade_each((&mut [bytes], &mut [shades], other), pipeline, kernel);
            }
            Some(_) => {
                let (mut channels, mut shades) = (channels.each_mut(), shades.each_mut());
                self.shade_each((&mut channels, &mut shades, other), pipeline, kernel);
            }
        }
        if let Some(stage) = pipeline.texture() {
            self.texels(stage, other, kernel);
            if mix.is_none() {
                return lookup_row(&mut bytes[..n], other, stage.tables[0]);
            }
            for (channel, table) in channels.iter_mut().zip(stage.tables) {
                lookup_row(&mut channel[..n], other, table);
            }
        }
        if let Some(mix) = mix {
            self.mix(buffers, mix, pipeline.dither(), kernel);
        }
    }

    /// The bytes of one shade, or of three channels, which are dithered when they are mixed.
    #[inline(never)]
    fn shade_each<const N: usize>(
        &self,
        (bytes, shades, other): (&mut [&mut Vec<u8>; N], &mut [&mut Vec<u16>; N], &mut [u8]),
        pipeline: &PixelPipeline<'_>,
        kernel: Kernel,
    ) {
        let has_channels = N > 1;
        let dither = pipeline.dither().filter(|_| !has_channels);
        let channel = |i: usize| has_channels.then_some(Value::Channel(i));
        match pipeline.source() {
            ShadeSource::NormalTable(table) if !has_channels => {
                self.fill(Shaded::linear(Value::Slope(0)), bytes[0], kernel);
                self.fill(Shaded::linear(Value::Slope(1)), other, kernel);
                return lookup(&mut bytes[0][..self.pixels()], other, table);
            }
            // The table gives one shade; there is none for channels.
            source @ (ShadeSource::Shaded(_) | ShadeSource::NormalTable(_)) => {
                let interpolation = match source {
                    ShadeSource::Shaded(interpolation) => interpolation,
                    _ => Interpolation::default(),
                };
                for (i, bytes) in bytes.iter_mut().enumerate() {
                    self.fill(Shaded { value: channel(i), interpolation, dither }, bytes, kernel);
                }
                return;
            }
            ShadeSource::LitEvery(spacing, light) => {
                let bytes = bytes.each_mut().map(|of| &mut of[..]);
                return self.light_some(kernel, (spacing, light), dither.unwrap_or(Thresholds::HALVES), bytes);
            }
            ShadeSource::Lit(light) => light_each(kernel, self, light, shades.each_mut().map(|of| &mut of[..])),
            ShadeSource::Curved(limits) => {
                for (i, shades) in shades.iter_mut().enumerate() {
                    let plane = |face: &FaceCorners<'_>| CurvePlane::new(face, limits, N);
                    self.each(shades, plane, |plane, span, shades| plane.fill((span.x, span.y), i, shades, kernel));
                }
            }
        }
        for (shades, bytes) in shades.iter().zip(bytes) {
            self.round(shades, dither, bytes);
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
    fn mix(&self, buffers: &mut Buffers, mix: Mix<'_>, dither: Option<Thresholds>, kernel: Kernel) {
        let dither = dither.unwrap_or(Thresholds::HALVES);
        let Buffers { bytes, channels, .. } = buffers;
        match mix {
            Mix::Only(channel) => bytes.copy_from_slice(&channels[channel.min(2)]),
            Mix::Nearest { map, spread } => {
                mix_nearest_at(kernel.simd_level(), self, (channels, bytes), dither, (map, spread));
            }
            Mix::Cube => {
                let [red, green, blue] = &*channels;
                for span in self.iter() {
                    let pixels = span.pixels();
                    let (red, green, blue) = (&red[pixels.clone()], &green[pixels.clone()], &blue[pixels.clone()]);
                    mix_cube(&mut bytes[pixels], red, green, blue, span.thresholds(dither), span.column());
                }
            }
        }
    }
}

compiled_for_each_level! {
    /// Mixes three channels by a table of the nearest entries.
    #[inline(never)]
    fn mix_nearest_at[][](
        spans: &Spans<'_>,
        from_to: (&[Vec<u8>; 3], &mut [u8]),
        dither: Thresholds,
        table: (&[u8; 32_768], u8),
    ) = mix_nearest_by;
}

#[inline(always)]
fn mix_nearest_by<S: Lanes8>(
    s: S,
    spans: &Spans<'_>,
    ([red, green, blue], to): (&[Vec<u8>; 3], &mut [u8]),
    dither: Thresholds,
    (map, spread): (&[u8; 32_768], u8),
) {
    for span in spans.iter() {
        let (thresholds, column) = (span.thresholds(dither), span.column());
        // Whole blocks: the next span overwrites the bytes after this one, and there is room after the last.
        let pixels = span.first..span.first + span.len.next_multiple_of(LANES);
        let (reds, greens, blues) = (&red[pixels.clone()], &green[pixels.clone()], &blue[pixels.clone()]);
        let eights = to[pixels].as_chunks_mut::<LANES>().0;
        let (reds, greens, blues) = (reds.as_chunks().0, greens.as_chunks().0, blues.as_chunks().0);
        for i in 0..eights.len().min(reds.len()).min(greens.len()).min(blues.len()) {
            let thresholds = thresholds.next(column + i * LANES);
            eights[i] = mix_nearest_eight(s, [&reds[i], &greens[i], &blues[i]], &thresholds, spread, map);
        }
    }
}
