//! Turns faces with effects into spans: the same list as for plain triangles, with a record for each span.
//!
//! A span is up to 64 pixels of a row. It begins where its shades are reseeded, a multiple of 64 pixels from the row's
//! first covered pixel inside the frame, so every value is exact at its first pixel. A clip rectangle may hide its
//! first pixels, but changes no byte of the others.
//!
//! Its record has the texture coordinates, the start and step of each linear value, and a [`Mark`]. Other shadings add
//! theirs ([`ShadedValues`]). Light at every pixel is computed by its stage, from the mark and the planes that set-up
//! leaves for eight faces.

use alloc::boxed::Box;
use alloc::vec;
use alloc::vec::Vec;

use super::direct::Direct;
use super::pipeline::{PixelPipeline, ShadeSource};
use super::{Buffers, draw_listed};
use crate::fixed::{IS_COMPACT, ROUND_MAGIC, U8F8};
use crate::lanes::{self, LANES, each, three};
use crate::mapping::Mapping;
use crate::raster::columns::{EffectColumns, PickedTriangles, Value};
use crate::raster::interpolation::Interpolation;
use crate::raster::pick::{Pick, SizeClass};
use crate::raster::reference::cover::{Row, SortedTriangle};
use crate::raster::reference::depth::DepthPlane;
use crate::raster::reference::level::{self, LevelPlane};
use crate::raster::reference::quotient::Divisor;
use crate::raster::reference::shade::{RESEED, ShadePlane};
use crate::raster::reference::texture::{AffineLevel, AffinePlane, PerspectiveTexture, depth};
use crate::raster::row_shader::{pieces, start_at};
use crate::raster::rows::{Batches, Lane, Parts, RowEnds, Shades8, advance, value_of};
use crate::raster::setup::{Basis, Corners8, Floats, FrameLayout, Ints, TriangleSetup8, ValuePlanes8};
use crate::raster::setup_texture::{AffinePlanes8, PerspectivePlanes8, texture_of_corners};
use crate::raster::shaded::{Kind, ShadedValues};
use crate::simd::Lanes8;
use crate::span::list::SpanList;
use crate::span::records::{RecordColumns, Records};
use crate::span::target::Target;
use crate::span::texture::Levels;

/// Position of a span in its face, packed into two u32.
///
/// | bits | the first | the second |
/// |---|---|---|
/// | 0 to 5, 0 to 15 | the face, among those whose planes are stored | the column, from the planes' first pixel |
/// | 6 to 12, 16 to 31 | the index of the span in its row | the row, from the planes' first pixel |
/// | 13 to 31 | the row's last pixel inside the frame, from the first one of the span | |
#[derive(Clone, Copy)]
pub(super) struct Mark(pub(super) [u32; 2]);

impl Mark {
    #[inline(always)]
    pub(super) const fn face(self) -> usize {
        (self.0[0] & 63) as usize
    }

    /// Pixels of the row before the span.
    #[inline(always)]
    pub(super) const fn before(self) -> i32 {
        (self.0[0] >> 6 & 127).cast_signed() * RESEED
    }

    #[inline(always)]
    pub(super) const fn last(self) -> i32 {
        (self.0[0] >> 13).cast_signed()
    }

    /// Column and row.
    #[inline(always)]
    pub(super) const fn position(self) -> [i32; 2] {
        [(self.0[1] & 0xFFFF).cast_signed(), (self.0[1] >> 16).cast_signed()]
    }
}

/// Numbers per span: its mark, and the shade and each value at its first pixel, with the step in the upper half.
const NUMBERS: usize = 3 + Value::MAX_COUNT;

/// Numbers per span for texture coordinates linear on the screen: u and v at its first pixel, and their steps.
const COORDINATES: usize = 4;

/// Sums at a span's first pixel for texture coordinates linear on the face: two numerators, and the divisor.
const SUMS: usize = 3;

/// Sums that are kept in f32, too: none in a build for size, which lacks the loops that look them up.
const SINGLE_SUMS: usize = if IS_COMPACT { 0 } else { SUMS };

/// A face, and the values of its corners from top to bottom.
#[derive(Clone, Copy)]
pub(super) struct FaceCorners<'a> {
    pub(super) triangle: SortedTriangle,
    /// Indices of its vertices.
    corners: [usize; 3],
    side: usize,
    /// The channels, if all corners share them.
    flat: Option<[U8F8; 3]>,
    columns: &'a EffectColumns<'a>,
}

impl<'a> FaceCorners<'a> {
    /// Face `k` of these.
    fn new(of: &PickedTriangles<'a>, k: usize) -> Self {
        let pick = of.picks.get(k);
        let (triangle, order) = SortedTriangle::with_order(&of.vertices(k));
        let indices = of.triangles.corners(pick);
        let (corners, flat) = (three(order, |corner| indices[corner]), of.picks.flat.get(k).copied());
        Self { triangle, corners, side: pick.side(), flat, columns: &of.triangles.columns.effects }
    }

    /// Texture coordinates: `i` is 0 for u, 1 for v.
    #[inline]
    pub(super) fn texture(&self, i: usize) -> [i32; 3] {
        three(self.corners, |vertex| self.columns.texture[vertex][i])
    }

    /// Texture coordinates linear on the screen, and the level of the face if the image has levels up to this one.
    pub(super) fn affine_texture(&self, last: Option<u32>) -> ([AffinePlane; 2], AffineLevel) {
        let area = Divisor::new(self.triangle.area());
        let planes = [0, 1].map(|i| AffinePlane::new(&self.triangle, area, self.texture(i)));
        let level = last.map(|last| level::of_face(&planes, area.get(), last));
        (planes, level.unwrap_or_default())
    }

    /// Texture coordinates linear on the face. A coordinate that all corners share is moved to the middle of its texel,
    /// as in the eight-lane set-up.
    pub(super) fn perspective_texture(&self) -> PerspectiveTexture {
        let coordinates = [self.texture(0), self.texture(1)].map(|[a, b, c]| match a == b && b == c {
            true => [a & !0xFFFF | 0x8000; 3],
            false => [a, b, c],
        });
        PerspectiveTexture::new(&self.triangle, coordinates)
    }

    /// The levels of texture coordinates linear on the face.
    pub(super) fn levels(&self) -> LevelPlane {
        let depths = |corner: usize| i128::from(depth(&self.triangle, corner));
        LevelPlane::new(&self.triangle, [self.texture(0), self.texture(1)], [depths(0), depths(1), depths(2)])
    }

    /// A linear value.
    #[inline]
    pub(super) fn value(&self, value: Value) -> [i64; 3] {
        if let (Value::Channel(i), Some(flat)) = (value, self.flat) {
            return [i64::from(flat[i].to_bits()); 3];
        }
        three(self.corners, |vertex| i64::from(self.columns.value(value, vertex, self.side)))
    }

    /// The input of light, or the shades of a curve.
    #[inline]
    pub(super) fn lit(&self) -> [[f32; 6]; 3] {
        three(self.corners, |vertex| self.columns.lit.get(vertex, self.side))
    }
}

/// Planes of eight faces.
#[derive(Clone, Debug, Default)]
pub(super) struct FacePlanes8 {
    /// The first pixel of the box.
    pub(super) column: Ints,
    pub(super) row: Ints,
    values: [ValuePlanes8; Value::MAX_COUNT],
    pub(super) affine: AffinePlanes8,
    pub(super) perspective: PerspectivePlanes8,
}

/// The data of listed spans and of their faces: reused memory.
#[derive(Clone, Debug)]
pub(super) struct SpanData {
    pub(super) numbers: RecordColumns<i32, NUMBERS>,
    pub(super) coordinates: RecordColumns<i32, COORDINATES>,
    sums: RecordColumns<i64, SUMS>,
    /// The sums rounded to f32; unused for a face that is walked.
    single_sums: RecordColumns<f32, SINGLE_SUMS>,
    /// The shade, or three channels, if they are not linear in 8.8.
    shaded: Vec<ShadedValues>,
    /// Made on the heap, since stacks may be small.
    planes: Box<[FacePlanes8; Batches::COUNT]>,
}

/// The values set up for each face besides its shade.
#[derive(Clone, Copy)]
struct Wanted {
    /// Texture coordinates that are linear on the screen, or on the face.
    texture: Option<Mapping>,
    /// The last level of the image, if it has any.
    last_level: Option<u32>,
    /// True if a stage reads the shade at the first pixel of a span.
    shade: bool,
    /// Linear values, each in its slot.
    values: [Option<Value>; Value::MAX_COUNT],
    /// Slots up to the last one in use.
    slots: usize,
    /// True if shades and channels are reseeded with each span.
    reseeds: bool,
    /// How the shade or the channels are interpolated, if not linearly in 8.8.
    kind: Option<Kind>,
    /// True if that applies to the channels, not to the shade.
    has_channels: bool,
}

impl Wanted {
    fn by(pipeline: &PixelPipeline<'_>) -> Self {
        // For `Every16`, a stage sets up each face on its own.
        let texture = pipeline.texture().map(|stage| stage.mapping).filter(|mapping| *mapping != Mapping::Every16);
        let last_level = pipeline.levels().map(Levels::last);
        let mut values = [None; Value::MAX_COUNT];
        let mut want =
            |value: Value, is_wanted: bool| values[value.slot()] = is_wanted.then_some(value).or(values[value.slot()]);
        want(Value::Fog, pipeline.fog().is_some());
        let channels = pipeline.channels().is_some();
        let by_table = matches!(pipeline.source, ShadeSource::NormalTable(_));
        for i in 0..3 {
            want(Value::Channel(i), channels && (by_table || matches!(pipeline.source, ShadeSource::Shaded(_))));
            want(Value::Slope(i), by_table && !channels && i < 2);
        }
        let reseeds = !matches!(pipeline.source, ShadeSource::Shaded(Interpolation::Gouraud88));
        let kind = match pipeline.source {
            ShadeSource::Shaded(interpolation) => Kind::of(interpolation),
            _ => None,
        };
        let shade = !reseeds
            || matches!(pipeline.source, ShadeSource::Shaded(Interpolation::Gouraud88Reseeded))
            || kind == Some(Kind::Fixed16) && !channels;
        let slots = values.iter().rposition(Option::is_some).map_or(0, |last| last + 1);
        Self { texture, last_level, shade, values, slots, reseeds, kind, has_channels: channels }
    }
}

/// A face whose edges are walked row by row, because it is too large for set-up in f64, or there is no f64.
pub(super) struct WalkedFace<'a> {
    face: FaceCorners<'a>,
    shade: ShadePlane,
    depth: DepthPlane,
    values: [Option<ShadePlane>; Value::MAX_COUNT],
    texture: Option<WalkedTexture>,
    /// The levels of coordinates linear on the face, if the image has any.
    levels: Option<LevelPlane>,
}

/// Texture coordinates of a walked face.
enum WalkedTexture {
    Affine([AffinePlane; 2]),
    OnFace(PerspectiveTexture),
}

/// The spans of a list as the stages see them: their marks, and the planes of their faces.
pub(super) struct ListedFaces<'a> {
    pub(super) faces: PickedTriangles<'a>,
    wanted: Wanted,
    pub(super) data: &'a mut SpanData,
    pub(super) batches: Batches,
    /// The only face, if its edges are walked.
    pub(super) walked: Option<WalkedFace<'a>>,
    /// How one loop per span draws the pixels, where possible.
    pub(super) direct: Option<Direct<'a>>,
}

/// Never called, since there are as many planes. Inlined, it would put them on its caller's stack.
#[cold]
#[inline(never)]
fn no_planes<T: Default>() -> T {
    T::default()
}

impl SpanData {
    pub(super) fn new() -> Self {
        let (numbers, coordinates) = (RecordColumns::new(), RecordColumns::new());
        let (sums, single_sums) = (RecordColumns::new(), RecordColumns::new());
        let planes = Box::try_from(vec![FacePlanes8::default(); Batches::COUNT]).unwrap_or_else(|_| no_planes());
        Self { numbers, coordinates, sums, single_sums, shaded: Vec::new(), planes }
    }

    /// Makes room for the shade or channels, apart from the rest, since stacks may be small.
    #[inline(never)]
    pub(super) fn add_shaded(&mut self) {
        self.shaded.reserve_exact(3);
        for _ in 0..3 {
            self.shaded.push(ShadedValues::default());
        }
    }

    /// The sums at the first pixel of a span, where the texture is linear on the face.
    #[inline(always)]
    pub(super) fn sums(&self, record: usize) -> [f64; SUMS] {
        let of = |i: usize| f64::from_bits(self.sums.of(record, i).cast_unsigned());
        [of(0), of(1), of(2)]
    }

    /// The [`sums`](Self::sums) rounded to f32, of a face that is not walked.
    #[inline(always)]
    pub(super) fn single_sums(&self, record: usize) -> [f32; SUMS] {
        [0, 1, 2].map(|i| self.single_sums.of(record, i))
    }

    /// The planes of a face's batch, and the face's lane.
    #[inline(always)]
    pub(super) fn planes(&self, face: usize) -> (&FacePlanes8, usize) {
        let (batch, lane) = Batches::of_face(face);
        (&self.planes[batch], lane)
    }
}

impl ListedFaces<'_> {
    #[inline(always)]
    fn set_up_planes<S: Lanes8>(&mut self, s: S, basis: &Basis<S>, corners: &Corners8, setup: &TriangleSetup8) {
        let Self { faces, wanted, data, batches, .. } = self;
        let faces = *faces;
        let first = batches.first_pick();
        let eight = &faces.range(first, faces.picks.picks.len().min(first + LANES));
        let planes = &mut data.planes[batches.current()];
        (planes.column, planes.row) = (setup.column, setup.row);
        if let Some(mapping) = wanted.texture {
            let of_corners = texture_of_corners(eight);
            match mapping {
                Mapping::Affine => {
                    let fits = planes.affine.set_up(s, basis, &of_corners, wanted.last_level);
                    // Usually all are small and fit.
                    let all_fit = fits & 0xFF == 0xFF && Pick::are_small(eight.picks.picks);
                    let lanes = if all_fit { 0 } else { LANES };
                    for (lane, &pick) in eight.picks.picks.iter().take(lanes).enumerate() {
                        if Pick(pick).class() != SizeClass::Small || fits >> lane & 1 == 0 {
                            let face = FaceCorners::new(&faces, first + lane);
                            let pixel = [setup.column[lane], setup.row[lane]];
                            let coordinates = [face.texture(0), face.texture(1)];
                            planes.affine.split(lane, &face.triangle, coordinates, pixel, wanted.last_level);
                        }
                    }
                }
                _ => planes.perspective.set_up(s, basis, corners, &of_corners, wanted.last_level),
            }
        }
        for (planes, value) in planes.values.iter_mut().zip(wanted.values) {
            if let Some(value) = value {
                planes.set_up(s, basis, &value_of_corners(eight, value));
            }
        }
    }

    /// Sets up shades or channels that are not linear in 8.8, given the linear planes of eight faces.
    #[inline(always)]
    fn set_up_shaded<S: Lanes8>(&mut self, s: S, corners: &Corners8, (setup, layout): (&TriangleSetup8, FrameLayout)) {
        let Wanted { kind: Some(kind), has_channels, .. } = self.wanted else { return };
        let mut unused = TriangleSetup8::NONE;
        let basis = &unused.set_up(s, corners, (layout, false), false);
        let (first, batch) = (self.batches.first_pick(), self.batches.current());
        let eight = &self.faces.range(first, self.faces.picks.picks.len().min(first + LANES));
        let SpanData { shaded, planes, .. } = &mut *self.data;
        for (i, shaded) in shaded.iter_mut().enumerate().take(if has_channels { 3 } else { 1 }) {
            let (values, linear) = match has_channels {
                true => {
                    let channel = Value::Channel(i);
                    (value_of_corners(eight, channel), &planes[batch].values[channel.slot()])
                }
                false => (corners.shade, &setup.shade),
            };
            shaded.set_up(s, (kind, batch), basis, (corners, &values), linear);
        }
    }

    /// Stores the starts of shades or channels that are not linear in 8.8, given the marks of eight spans.
    #[inline(always)]
    fn begin_shaded<S: Lanes8>(&mut self, s: S, lane: impl Lane<S>, setup: &TriangleSetup8, record: usize) {
        let Wanted { kind: Some(kind), has_channels, .. } = self.wanted else { return };
        let SpanData { numbers, shaded, planes, .. } = &mut *self.data;
        let (batch, planes) = (self.batches.current(), &planes[self.batches.current()]);
        let [mark, position] = [0, 1].map(|i| s.load_i32(numbers.eight(record, i)));
        let magic = s.splat_f64(ROUND_MAGIC);
        let sum = |whole: S::I32| s.add(s.to_f64(whole), magic);
        let before = s.and_i32(mark, s.splat_i32(127 << 6));
        let (seed, j) = (s.and_i32(position, s.splat_i32(0xFFFF)), s.to_f64(s.shr_i32(position, 16)));
        let end = s.add_i32(s.add_i32(seed, s.shr_i32(mark, 13)), s.splat_i32(1));
        let parts = Parts { row: sum(s.sub_i32(seed, before)), end: sum(end), seed: sum(seed), start: sum(seed) };
        for (i, shaded) in shaded.iter_mut().enumerate().take(if has_channels { 3 } else { 1 }) {
            let linear = if has_channels { &planes.values[Value::Channel(i).slot()] } else { &setup.shade };
            shaded.begin_spans(s, lane, (kind, batch, record), (linear, &setup.inverse), (j, &parts, parts.seed));
        }
    }

    /// Completes the set-up in f32 of triangle `i` of the eight.
    fn set_up_large(&mut self, i: usize) {
        let face = self.batches.current() * LANES + i;
        let corners = FaceCorners::new(&self.faces, self.batches.first + face);
        let channels = self.wanted.has_channels;
        for (i, shaded) in self.data.shaded.iter_mut().enumerate().take(if channels { 3 } else { 1 }) {
            let values = if channels { corners.value(Value::Channel(i)) } else { corners.triangle.shades() };
            shaded.set_up_large(face, &corners.triangle, values);
        }
    }

    /// The shade or channel that is set up for eight faces, if it is not linear in 8.8.
    pub(super) fn shaded(&self, value: Option<Value>) -> Option<(Kind, &ShadedValues)> {
        let i = match value {
            None => 0,
            Some(Value::Channel(i)) => i,
            _ => return None,
        };
        let kind = self.wanted.kind.filter(|_| self.walked.is_none())?;
        Some((kind, self.data.shaded.get(i)?))
    }

    /// The mapping and the last level of an image with levels.
    #[cfg(test)]
    pub(super) fn levels(&self) -> Option<(Option<Mapping>, u32)> {
        Some((self.wanted.texture, self.wanted.last_level?))
    }

    /// A face, and its corners' values.
    #[inline]
    pub(super) fn corners(&self, face: usize) -> FaceCorners<'_> {
        match &self.walked {
            Some(WalkedFace { face, .. }) => *face,
            None => FaceCorners::new(&self.faces, self.batches.first + face),
        }
    }

    /// The texture coordinates of a face, linear on it, and their levels, by their definitions.
    pub(super) fn exact_texture(&self, face: usize) -> (PerspectiveTexture, Option<LevelPlane>) {
        if let Some(WalkedFace { texture: Some(WalkedTexture::OnFace(coordinates)), levels, .. }) = self.walked {
            return (coordinates, levels);
        }
        let corners = self.corners(face);
        (corners.perspective_texture(), self.wanted.last_level.map(|_| corners.levels()))
    }
}

/// Spans with effects: the set-up of their faces, and the stages they pass through.
pub(in crate::raster) struct EffectSpans<'a> {
    pub(super) listed: ListedFaces<'a>,
    pipeline: &'a PixelPipeline<'a>,
    buffers: &'a mut Buffers,
}

impl<'a> EffectSpans<'a> {
    /// Begins without spans; they will be of these faces.
    pub(super) fn new(
        faces: PickedTriangles<'a>,
        pipeline: &'a PixelPipeline<'a>,
        data: &'a mut SpanData,
        buffers: &'a mut Buffers,
    ) -> Self {
        let wanted = Wanted::by(pipeline);
        let direct = Direct::of(pipeline);
        if wanted.kind.is_some() {
            // Channels are dithered when they are mixed.
            let is_dithered = pipeline.dither().is_some() && !wanted.has_channels;
            for shaded in &mut data.shaded {
                shaded.is_truncated = is_dithered;
            }
        }
        let listed = ListedFaces { faces, wanted, data, batches: Batches::NONE, walked: None, direct };
        Self { listed, pipeline, buffers }
    }

    /// Draws the spans of a list, and empties it.
    pub(super) fn draw_spans(&mut self, list: &mut SpanList, target: &mut Target<'_>) {
        let nearer = draw_listed(&self.listed, list, self.pipeline, self.buffers, target);
        self.clear(list, nearer);
    }

    /// Empties a list whose spans have been drawn, `nearer` pixels of them.
    pub(super) fn clear(&mut self, list: &mut SpanList, nearer: u32) {
        list.clear(nearer);
        self.listed.batches.records = Records::NONE;
    }

    /// Begins face `k`, whose rows are added one by one.
    pub(super) fn walk(&mut self, k: usize, depth_base: u32) -> SortedTriangle {
        let corners = FaceCorners::new(&self.listed.faces, k);
        let triangle = corners.triangle;
        let Wanted { texture, last_level, values, .. } = self.listed.wanted;
        let planes = &mut self.listed.data.planes[0];
        // Columns and rows are counted from the frame's first.
        (planes.column, planes.row) = ([0; LANES], [0; LANES]);
        let mut levels = None;
        let texture = texture.map(|mapping| match mapping {
            Mapping::Affine => {
                let (coordinates, level) = corners.affine_texture(last_level);
                planes.affine.set_level(level);
                WalkedTexture::Affine(coordinates)
            }
            _ => {
                let coordinates = corners.perspective_texture();
                let of_corners = [corners.texture(0), corners.texture(1)];
                planes.perspective.set_up_alone(&triangle, &of_corners, &coordinates);
                levels = last_level.map(|_| corners.levels());
                WalkedTexture::OnFace(coordinates)
            }
        });
        self.listed.walked = Some(WalkedFace {
            face: corners,
            shade: ShadePlane::of_values(&triangle, triangle.shades()),
            depth: DepthPlane::new(&triangle).raised_by(depth_base),
            values: values.map(|value| Some(ShadePlane::of_values(&triangle, corners.value(value?)))),
            texture,
            levels,
        });
        self.listed.batches = Batches::from_pick(k);
        triangle
    }

    /// Adds the drawn part of a row of the face being walked; `target` has the pixels and cells.
    pub(super) fn add_row(&mut self, row: &Row, list: &mut SpanList, target: &mut Target<'_>) {
        pieces(row, |seed, x, end| {
            if !list.has_room(1) {
                self.draw_spans(list, target);
            }
            let Some(WalkedFace { shade, depth, values, texture, .. }) = &self.listed.walked else { return };
            let reseeds = self.listed.wanted.reseeds;
            let value = |plane: &ShadePlane, reseeds: bool| {
                u32::from(start_at(plane, row, seed, reseeds)) | u32::from(plane.step()) << 16
            };
            let shade = value(shade, reseeds);
            let mut of_slots = [0; Value::MAX_COUNT];
            for (slot, plane) in values.iter().enumerate() {
                let reseeds = reseeds || slot == Value::Fog.slot();
                of_slots[slot] = plane.as_ref().map_or(0, |plane| value(plane, reseeds));
            }
            // A column of a frame.
            let z = depth.fixed_at(x, row.y);
            let at = [x as usize; 2];
            // A record for each span of the list, at most 128; up to 63 pixels are skipped.
            let record = list.count();
            let fill = record as u32 | ((x - seed) as u32) << 8;
            if list.push(at, (end - x) as usize, fill, [z << 8, depth.step() << 8]) {
                let number = (seed - row.origin) / RESEED;
                // A `Mark` of the only face: the numbers are below 128 and 8,192, column and row below 65,536.
                let [a, b] = [number << 6 | (row.last - seed) << 13, seed | row.y << 16].map(i32::cast_unsigned);
                let (data, [v0, v1, v2, v3]) = (&mut *self.listed.data, of_slots);
                data.numbers.set(record, [a, b, shade, v0, v1, v2, v3].map(u32::cast_signed));
                match texture {
                    Some(WalkedTexture::Affine([u, v])) => {
                        let starts = [u, v].map(|plane| plane.start(seed, row.y));
                        // Modulo 2³²: texels repeat.
                        let steps = [u, v].map(|plane| plane.step as u32);
                        data.coordinates.set(record, [starts[0], starts[1], steps[0], steps[1]].map(u32::cast_signed));
                    }
                    Some(WalkedTexture::OnFace(coordinates)) => {
                        let sums = coordinates.sums(seed, row.y).map(|sum| sum.to_bits().cast_signed());
                        data.sums.set(record, sums);
                    }
                    None => {}
                }
            }
        });
    }
}

impl Shades8 for EffectSpans<'_> {
    const IS_LINEAR: bool = false;

    #[inline(always)]
    fn batches(&mut self) -> Option<&mut Batches> {
        Some(&mut self.listed.batches)
    }

    #[inline(always)]
    fn set_up<S: Lanes8>(&mut self, s: S, corners: &Corners8, setup: &mut TriangleSetup8, of: (FrameLayout, bool)) {
        let listed = &mut self.listed;
        // Out of line, so that the loop over faces stays small.
        s.apart(
            #[inline(always)]
            || {
                let basis = setup.set_up(s, corners, of, listed.wanted.shade);
                listed.set_up_planes(s, &basis, corners, setup);
            },
        );
        if listed.wanted.kind.is_some() {
            let (setup, layout) = (&*setup, of.0);
            s.apart(
                #[inline(always)]
                move || listed.set_up_shaded(s, corners, (setup, layout)),
            );
        }
    }

    #[inline(always)]
    fn fill_of<S: Lanes8>(
        &mut self,
        s: S,
        lane: impl Lane<S>,
        setup: &TriangleSetup8,
        ends: &RowEnds<S>,
        parts: &Parts<S>,
    ) -> S::I32 {
        let ListedFaces { wanted, data, batches, .. } = &mut self.listed;
        let SpanData { numbers, coordinates, sums, single_sums, planes, .. } = &mut **data;
        let (planes, record) = (&planes[batches.current()], batches.records.begin());
        let (j, row, seed) = (ends.j, s.low_bits(parts.row), s.low_bits(parts.seed));
        let Wanted { shade, values, slots, reseeds, texture, kind, .. } = *wanted;
        let inverse = &setup.inverse;
        if shade {
            s.store_i32(value_in(s, lane, (&setup.shade, inverse), j, parts, reseeds), numbers.eight(record, 2));
        }
        for (slot, value) in values.iter().enumerate().take(slots) {
            if let Some(value) = value {
                let reseeds = reseeds || !matches!(value, Value::Channel(_));
                s.store_i32(
                    value_in(s, lane, (&planes.values[slot], inverse), j, parts, reseeds),
                    numbers.eight(record, 3 + slot),
                );
            }
        }
        let skipped = s.sub_i32(s.low_bits(parts.start), seed);
        let last = s.sub_i32(s.sub_i32(s.low_bits(parts.end), s.splat_i32(1)), seed);
        // For spans that exist the fields are in range: see `Mark`.
        // Whole pieces of 64 pixels are before the span.
        let mark = s.or_i32(batches.faces(s, lane), s.sub_i32(seed, row));
        let mark = s.or_i32(mark, s.shl_i32(last, 13));
        let number = s.low_bits(s.add(j, s.splat_f64(ROUND_MAGIC)));
        s.store_i32(mark, numbers.eight(record, 0));
        s.store_i32(s.or_i32(seed, s.shl_i32(number, 16)), numbers.eight(record, 1));
        match texture {
            Some(Mapping::Affine) => {
                let [u, v] = planes.affine.starts(s, lane, (j, parts.seed), [seed, number]);
                let [du, dv] = planes.affine.steps(s, lane);
                for (i, coordinate) in [u, v, du, dv].into_iter().enumerate() {
                    s.store_i32(coordinate, coordinates.eight(record, i));
                }
            }
            Some(_) => {
                for (i, sum) in planes.perspective.starts(s, lane, j, parts.seed).into_iter().enumerate() {
                    s.store_i64(s.bits(sum), sums.eight(record, i));
                    if !IS_COMPACT {
                        let mut doubles = [0.0; LANES];
                        s.store_f64(sum, &mut doubles);
                        *single_sums.eight(record, i) = each!(lane => doubles[lane] as f32);
                    }
                }
            }
            None => {}
        }
        if kind.is_some() {
            let listed = &mut self.listed;
            // Everything is in memory, so the call spills nothing.
            s.apart(
                #[inline(always)]
                move || listed.begin_shaded(s, lane, setup, record),
            );
        }
        // Below 256.
        let records = s.add_i32(s.splat_i32(record as i32), s.load_i32(&lanes::NUMBERS));
        s.or_i32(records, s.shl_i32(skipped, 8))
    }

    #[inline(never)]
    fn set_up_large(&mut self, i: usize) {
        if self.listed.wanted.kind == Some(Kind::Float) {
            self.listed.set_up_large(i);
        }
    }

    #[inline(always)]
    fn draw<const DEPTHS: bool>(&mut self, list: &mut SpanList, target: &mut Target<'_>) {
        self.draw_spans(list, target);
    }
}

/// A value at the first pixels of parts of rows `j`, with the step in the upper half. If it is not reseeded there, it is
/// exact at the first pixel of its row.
#[inline(always)]
fn value_in<S: Lanes8>(
    s: S,
    lane: impl Lane<S>,
    planes: (&ValuePlanes8, &Floats),
    j: S::F64,
    parts: &Parts<S>,
    reseeds: bool,
) -> S::I32 {
    if reseeds {
        return value_of(s, lane, planes, j, parts.seed);
    }
    advance(s, value_of(s, lane, planes, j, parts.row), s.sub_i32(s.low_bits(parts.seed), s.low_bits(parts.row)))
}

/// A value of the corners of up to eight triangles; 0 in lanes without a triangle.
#[inline(always)]
fn value_of_corners(PickedTriangles { triangles, picks }: &PickedTriangles<'_>, value: Value) -> [Ints; 3] {
    let mut gathered = [[0; LANES]; 3];
    let columns = &triangles.columns.effects;
    for (lane, &pick) in picks.picks.iter().take(LANES).enumerate() {
        let pick = Pick(pick);
        // The channels of a flat-shaded face.
        if let (Value::Channel(i), Some(flat)) = (value, picks.flat.get(lane)) {
            for corner in &mut gathered {
                corner[lane] = i32::from(flat[i].to_bits());
            }
            continue;
        }
        let indices = triangles.indices[pick.index()];
        for (corner, vertex) in indices.into_iter().enumerate() {
            gathered[corner][lane] = i32::from(columns.value(value, vertex as usize, pick.side()));
        }
    }
    gathered
}
