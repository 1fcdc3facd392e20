//! The first stages of a piece: shades from their source, with an image, or mixed of three channels.

use super::curve::CurvePlane;
use super::pieces::{Bytes, Face, Piece, Pieces};
use super::pipeline::{Attributes, Mix, PixelPipeline, ShadeSource};
use super::{Buffers, HALVES, PIECE};
use crate::fixed::U8F8;
use crate::raster::cover::SortedTriangle;
use crate::raster::interpolation::Interpolation;
use crate::raster::paint::{RowShader, to_bytes};
use crate::raster::shade::ShadePlane;
use crate::span::channels::{mix_cube, mix_nearest};
use crate::span::{Kernel, lookup};

/// A value of the three corners, as planes take them.
fn values(corners: [&Attributes; 3], value: impl Fn(&Attributes) -> U8F8) -> [i64; 3] {
    corners.map(|corner| i64::from(value(corner).to_bits()))
}

impl Pieces {
    /// The bytes of all pieces before fog and blending.
    pub(super) fn shade(&self, faces: &[Face], buffers: &mut Buffers, pipeline: &PixelPipeline<'_>, kernel: Kernel) {
        let n = self.len();
        if let Some(mix) = pipeline.channels() {
            self.shade_channels(faces, buffers, pipeline, kernel);
            if let Some(stage) = pipeline.texture() {
                let Buffers { other, channels, .. } = &mut *buffers;
                self.texels((), faces, (stage, pipeline.levels()), &mut other[..n], kernel);
                for (channel, table) in channels.iter_mut().zip(stage.tables) {
                    for ((piece, texels), channel) in self.pieces().iter().zip(&*other).zip(channel) {
                        let mut shown = *texels;
                        lookup(&mut shown[..piece.len()], &channel[..piece.len()], table);
                        *channel = shown;
                    }
                }
            }
            return self.mix(buffers, mix, pipeline.dither().unwrap_or(&HALVES));
        }
        if let (Some(stage), ShadeSource::Shaded(Interpolation::Flat(shade))) = (pipeline.texture(), pipeline.source) {
            // The table's row.
            if let Some(row) = stage.tables[0].as_chunks::<256>().0.get(usize::from(shade)) {
                return self.texels(row, faces, (stage, pipeline.levels()), &mut buffers.bytes[..n], kernel);
            }
        }
        self.shade_bytes(faces, buffers, pipeline, kernel);
        if let Some(stage) = pipeline.texture() {
            self.texels(stage.tables[0], faces, (stage, pipeline.levels()), &mut buffers.bytes[..n], kernel);
        }
    }

    /// The bytes of shades, of which there is one at a pixel.
    #[inline(never)]
    fn shade_bytes(&self, faces: &[Face], buffers: &mut Buffers, pipeline: &PixelPipeline<'_>, kernel: Kernel) {
        let n = self.len();
        let Buffers { bytes, shades: [shades, ..], .. } = buffers;
        let (bytes, shades) = (&mut bytes[..n], &mut shades[..n]);
        let pattern = pipeline.dither().unwrap_or(&HALVES);
        match pipeline.source {
            ShadeSource::Shaded(interpolation) => {
                let plane = |triangle: &SortedTriangle, _: [&Attributes; 3]| RowShader::new(triangle, interpolation);
                match (interpolation, pipeline.dither()) {
                    (Interpolation::GouraudReseeded, None) => self.fill_linear(bytes, kernel),
                    (_, None) => self.each(faces, bytes, plane, |shader, piece, bytes| {
                        shader.piece(&piece.row, piece.seed, &mut bytes[..piece.len()], None, kernel);
                    }),
                    (_, Some(pattern)) => self.each(faces, bytes, plane, |shader, piece, bytes| {
                        let thresholds = Some(piece.thresholds(pattern));
                        shader.piece(&piece.row, piece.seed, &mut bytes[..piece.len()], thresholds, kernel);
                    }),
                }
            }
            ShadeSource::NormalTable(table) => {
                let plane = |triangle: &SortedTriangle, corners| {
                    let slope = |i: usize| ShadePlane::of_values(triangle, values(corners, |corner| corner.slope[i]));
                    [slope(0), slope(1)]
                };
                self.each(faces, bytes, plane, |[across, down], piece, bytes| {
                    let mut rows: Bytes = [0; PIECE];
                    let (rows, bytes) = (&mut rows[..piece.len()], &mut bytes[..piece.len()]);
                    kernel.fill(bytes, across.start(piece.seed, piece.row.y), across.step());
                    kernel.fill(rows, down.start(piece.seed, piece.row.y), down.step());
                    lookup(bytes, rows, table);
                });
            }
            ShadeSource::Lit(light) => {
                self.light_each::<1>(faces, kernel, &light, [shades]);
                self.round(shades, pattern, bytes);
            }
            ShadeSource::LitEvery(spacing, light) => {
                self.light_some::<1>(faces, kernel, (spacing, &light), pattern, [bytes]);
            }
            ShadeSource::Curved(limits) => {
                let plane = |triangle: &SortedTriangle, corners| CurvePlane::new(triangle, corners, limits, 1);
                self.each(faces, shades, plane, |plane, piece, shades| {
                    plane.fill(piece.start(), 0, &mut shades[..piece.len()], kernel);
                });
                self.round(shades, pattern, bytes);
            }
        }
    }

    /// The bytes of three channels.
    #[inline(never)]
    fn shade_channels(&self, faces: &[Face], buffers: &mut Buffers, pipeline: &PixelPipeline<'_>, kernel: Kernel) {
        let n = self.len();
        let Buffers { channels, shades, .. } = buffers;
        let mut bytes = channels.each_mut().map(|channel| &mut channel[..n]);
        let mut shades = shades.each_mut().map(|shades| &mut shades[..n]);
        match pipeline.source {
            // What is shaded by a table of normals has no table for each channel.
            ShadeSource::Shaded(_) | ShadeSource::NormalTable(_) => {
                let interpolation = match pipeline.source {
                    ShadeSource::Shaded(interpolation) => interpolation,
                    _ => Interpolation::default(),
                };
                for (i, bytes) in bytes.iter_mut().enumerate() {
                    let plane = |triangle: &SortedTriangle, corners| {
                        RowShader::of_values(triangle, values(corners, |corner| corner.channels[i]), interpolation)
                    };
                    self.each(faces, bytes, plane, |shader, piece, bytes| {
                        shader.piece(&piece.row, piece.seed, &mut bytes[..piece.len()], None, kernel);
                    });
                }
                return;
            }
            ShadeSource::LitEvery(spacing, light) => {
                return self.light_some::<3>(faces, kernel, (spacing, &light), &HALVES, bytes);
            }
            ShadeSource::Lit(light) => {
                self.light_each::<3>(faces, kernel, &light, shades.each_mut().map(|of| &mut **of))
            }
            ShadeSource::Curved(limits) => {
                for (i, shades) in shades.iter_mut().enumerate() {
                    let plane = |triangle: &SortedTriangle, corners| CurvePlane::new(triangle, corners, limits, 3);
                    self.each(faces, shades, plane, |plane, piece, shades| {
                        plane.fill(piece.start(), i, &mut shades[..piece.len()], kernel);
                    });
                }
            }
        }
        for (shades, bytes) in shades.iter().zip(bytes) {
            self.round(shades, &HALVES, bytes);
        }
    }

    /// Shades to bytes, by thresholds.
    fn round(&self, shades: &[[u16; PIECE]], pattern: &[[u8; 8]; 8], bytes: &mut [Bytes]) {
        for ((piece, shades), bytes) in self.pieces().iter().zip(shades).zip(bytes) {
            let n = piece.len();
            to_bytes(&shades[..n], piece.thresholds(pattern), piece.column(), &mut bytes[..n]);
        }
    }

    /// Three channels to one index.
    fn mix(&self, buffers: &mut Buffers, mix: Mix<'_>, pattern: &[[u8; 8]; 8]) {
        match mix {
            Mix::Cube => self.each_mixed(buffers, |piece, bytes, [red, green, blue]| {
                mix_cube(bytes, red, green, blue, piece.thresholds(pattern), piece.column());
            }),
            Mix::Nearest { map, spread } => self.each_mixed(buffers, |piece, bytes, [red, green, blue]| {
                mix_nearest(bytes, red, green, blue, piece.thresholds(pattern), piece.column(), spread, map);
            }),
            Mix::Only(channel) => {
                self.each_mixed(buffers, |_, bytes, channels| bytes.copy_from_slice(channels[channel.min(2)]));
            }
        }
    }

    fn each_mixed(&self, buffers: &mut Buffers, mix: impl Fn(&Piece, &mut [u8], [&[u8]; 3])) {
        let Buffers { bytes, channels: [red, green, blue], .. } = buffers;
        let channels = red.iter().zip(&*green).zip(&*blue);
        for ((piece, bytes), ((red, green), blue)) in self.pieces().iter().zip(bytes).zip(channels) {
            let n = piece.len();
            mix(piece, &mut bytes[..n], [&red[..n], &green[..n], &blue[..n]]);
        }
    }
}
