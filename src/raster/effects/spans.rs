//! Spans of faces with effects: the list of spans that plain triangles have, and what the stages need beside it.
//!
//! A span is up to 64 pixels of a row. It begins where its shades begin anew, so that every value is exact at its first pixel,
//! a multiple of 64 pixels from the row's first covered pixel inside the frame; a clip rectangle may hide its first pixels,
//! and changes no byte of the others.
//!
//! A value's start is worked out by the stage that asks for it, from the planes of eight faces that set-up leaves. So a span
//! has two numbers beyond those of a plain one: its [`Mark`].

use core::ops::Range;

use super::pipeline::{PixelPipeline, ShadeSource};
use super::{Buffers, Target, run_stages, write};
use crate::fixed::{ROUND_MAGIC, U8F8};
use crate::lanes::three;
use crate::mapping::Mapping;
use crate::raster::columns::{EffectColumns, Picks, Triangles, Value};
use crate::raster::cover::{Row, SortedTriangle};
use crate::raster::depth::{Cell, DepthPlane};
use crate::raster::interpolation::Interpolation;
use crate::raster::paint::RowShader;
use crate::raster::pick::{LANES, Pick, SizeClass};
use crate::raster::rows::{Lane, Parts, RowEnds, Shades8, advance, value_of};
use crate::raster::setup::{Basis, Corners8, Ints, TriangleSetup8, ValuePlanes8};
use crate::raster::setup_texture::{AffinePlanes8, PerspectivePlanes8, texture_of_corners};
use crate::raster::shade::{RESEED, ShadePlane};
use crate::simd::{Lanes8, at_best_level};
use crate::span::Kernel;
use crate::span::dither::{ThresholdRow, Thresholds, fill_dithered};
use crate::span::list::{DepthSteps, SpanColumns, SpanList, SpanNumbers, Spans8};

/// Pixels of a span, at most.
pub(super) const LONGEST: usize = RESEED as usize;

/// Pixels that pass through the stages together, at most, and room for what is written eight at a time.
pub(super) const PIXELS: usize = 4_096;
pub(super) const ROOM: usize = PIXELS + LANES;

/// Batches of eight faces whose planes are kept until their spans are drawn.
const BATCHES: usize = 8;

/// Where a span lies in its face, in two numbers of 32 bits.
///
/// | bits | the first | the second |
/// |---|---|---|
/// | 0 to 5, 0 to 15 | the face, among those whose planes are kept | the column, from that of the planes |
/// | 6 to 11, 16 to 31 | pixels hidden by the clip rectangle at its beginning | the row, likewise |
/// | 12 to 18 | the number of the span in its row | |
/// | 19 to 31 | the row's last pixel inside the frame, from the first one of the span | |
#[derive(Clone, Copy)]
struct Mark([u32; 2]);

impl Mark {
    fn new(face: u32, [skipped, number, last]: [i32; 3], [column, row]: [i32; 2]) -> Self {
        // Below 64, 128 and 8,192; below 65,536.
        let place = column.cast_unsigned() | row.cast_unsigned() << 16;
        Self([face | (skipped << 6 | number << 12 | last << 19).cast_unsigned(), place])
    }

    #[inline(always)]
    const fn face(self) -> usize {
        (self.0[0] & 63) as usize
    }

    #[inline(always)]
    const fn skipped(self) -> u32 {
        self.0[0] >> 6 & 63
    }

    /// Pixels of the row before the span.
    #[inline(always)]
    const fn before(self) -> i32 {
        (self.0[0] >> 12 & 127).cast_signed() * RESEED
    }

    #[inline(always)]
    const fn last(self) -> i32 {
        (self.0[0] >> 19).cast_signed()
    }

    /// Column and row.
    #[inline(always)]
    const fn place(self) -> [i32; 2] {
        [(self.0[1] & 0xFFFF).cast_signed(), (self.0[1] >> 16).cast_signed()]
    }
}

/// Numbers of a span: its mark, and the first of each value with its step above it.
const NUMBERS: usize = 2 + Value::MAX_COUNT;

/// Numbers of eight spans.
#[derive(Clone, Copy)]
pub(crate) struct Marks8<S: Lanes8> {
    /// The mark's two, and those of the slots that are taken.
    numbers: [S::I32; NUMBERS],
    count: usize,
}

impl<S: Lanes8> SpanColumns<S> for Marks8<S> {
    #[inline(always)]
    fn zip(self, s: S, other: Self) -> [Self; 2] {
        let (mut low, mut high) = (self, other);
        for i in 0..self.count.min(NUMBERS) {
            [low.numbers[i], high.numbers[i]] = s.interleave_i32(self.numbers[i], other.numbers[i]);
        }
        [low, high]
    }
}

/// Triangles as the stages read them: those that were picked, by their index among these.
#[derive(Clone, Copy)]
pub(super) struct Faces<'a> {
    pub(super) triangles: &'a Triangles<'a>,
    pub(super) picks: Picks<'a>,
}

impl Faces<'_> {
    /// Face `k` in the order of its heights, and where its corners' values are.
    #[inline]
    fn sorted(&self, k: usize) -> SortedFace {
        let pick = self.picks.get(k);
        let (triangle, order) = SortedTriangle::with_order(&self.triangles.vertices(&self.picks, k));
        let of = self.triangles.corners(pick);
        let flat = self.picks.flat.get(k).copied();
        SortedFace { triangle, corners: three(order, |corner| of[corner]), side: pick.side(), flat }
    }
}

/// A face in the order of its heights.
#[derive(Clone, Copy, Debug)]
struct SortedFace {
    triangle: SortedTriangle,
    /// Indices of its vertices.
    corners: [usize; 3],
    side: usize,
    /// The channels that all corners have.
    flat: Option<[U8F8; 3]>,
}

/// A face, and the values of its corners from top to bottom.
pub(super) struct FaceCorners<'a> {
    pub(super) triangle: SortedTriangle,
    face: SortedFace,
    columns: &'a EffectColumns<'a>,
}

impl FaceCorners<'_> {
    /// Texture coordinates: `i` is 0 for u, 1 for v.
    #[inline]
    pub(super) fn texture(&self, i: usize) -> [i32; 3] {
        three(self.face.corners, |vertex| self.columns.texture[vertex][i])
    }

    /// A linear value.
    #[inline]
    pub(super) fn value(&self, value: Value) -> [i64; 3] {
        if let (Value::Channel(i), Some(flat)) = (value, self.face.flat) {
            return [i64::from(flat[i].to_bits()); 3];
        }
        three(self.face.corners, |vertex| i64::from(self.columns.value(value, vertex, self.face.side)))
    }

    /// Input of light, or the shades of a curve.
    #[inline]
    pub(super) fn lit(&self) -> [[f32; 6]; 3] {
        three(self.face.corners, |vertex| self.columns.lit.get(vertex, self.face.side))
    }
}

/// Planes of eight faces.
#[derive(Clone, Debug)]
struct FacePlanes8 {
    /// The box's first pixel.
    column: Ints,
    row: Ints,
    /// The depth there, with 32 fraction bits, and its change from a column and from a row to the next.
    z: [[i64; 3]; LANES],
    values: [ValuePlanes8; Value::MAX_COUNT],
    affine: AffinePlanes8,
    perspective: PerspectivePlanes8,
}

impl FacePlanes8 {
    const NONE: Self = Self {
        column: [0; LANES],
        row: [0; LANES],
        z: [[0; 3]; LANES],
        values: [ValuePlanes8::NONE; Value::MAX_COUNT],
        affine: AffinePlanes8::NONE,
        perspective: PerspectivePlanes8::NONE,
    };
}

/// What the stages know of spans beyond the list: memory that is used again.
#[derive(Clone, Debug)]
pub(super) struct Columns {
    planes: [FacePlanes8; BATCHES],
    numbers: SpanNumbers<NUMBERS>,
}

impl Columns {
    pub(super) const NONE: Self = Self { planes: [FacePlanes8::NONE; BATCHES], numbers: SpanNumbers::NONE };
}

/// What is set up of each face beside its shade.
#[derive(Clone, Copy)]
struct Wanted {
    /// Texture coordinates that are linear on the screen, or on the face.
    texture: Option<Mapping>,
    /// Linear values, each in its slot.
    values: [Option<Value>; Value::MAX_COUNT],
    /// Slots up to the last that is taken.
    slots: usize,
    /// Shades and channels begin anew with each span.
    reseeds: bool,
}

impl Wanted {
    fn by(pipeline: &PixelPipeline<'_>) -> Self {
        let texture = match pipeline.texture() {
            // Otherwise a stage sets up each face by itself.
            Some(stage) if pipeline.levels().is_none() && stage.mapping != Mapping::Every16 => Some(stage.mapping),
            _ => None,
        };
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
        let reseeds = !matches!(pipeline.source, ShadeSource::Shaded(Interpolation::Gouraud));
        let slots = values.iter().rposition(Option::is_some).map_or(0, |last| last + 1);
        Self { texture, values, slots, reseeds }
    }
}

/// A face whose edges are walked down, for it is too large for set-up in f64, or there is none.
struct WalkedFace {
    face: SortedFace,
    shade: ShadePlane,
    depth: DepthPlane,
    values: [Option<ShadePlane>; Value::MAX_COUNT],
}

/// What the stages know of the spans in a list: their marks, and the planes of their faces.
struct Listed<'a> {
    faces: Faces<'a>,
    wanted: Wanted,
    planes: &'a mut [FacePlanes8; BATCHES],
    /// The batch that is set up, and the index of the first face of batch 0.
    batch: usize,
    first: usize,
    numbers: &'a mut SpanNumbers<NUMBERS>,
    /// The only face, if its edges are walked down.
    walked: Option<WalkedFace>,
    /// The first row of the frame.
    first_row: u32,
}

impl Listed<'_> {
    /// The mark of span `k` of the list.
    #[inline(always)]
    fn mark(&self, k: usize) -> Mark {
        Mark([self.numbers.of(k, 0), self.numbers.of(k, 1)])
    }

    /// The batch and the lane of a face.
    #[inline(always)]
    fn planes(&self, face: usize) -> (&FacePlanes8, usize) {
        (&self.planes[face / LANES % BATCHES], face % LANES)
    }
}

/// Spans with effects: set-up of their faces, and the stages that they pass.
pub(in crate::raster) struct EffectSpans<'a> {
    listed: Listed<'a>,
    pipeline: &'a PixelPipeline<'a>,
    buffers: &'a mut Buffers,
}

impl<'a> EffectSpans<'a> {
    /// None yet, of these faces.
    pub(super) fn new(
        faces: Faces<'a>,
        pipeline: &'a PixelPipeline<'a>,
        Columns { planes, numbers }: &'a mut Columns,
        buffers: &'a mut Buffers,
        first_row: u32,
    ) -> Self {
        let wanted = Wanted::by(pipeline);
        let listed = Listed { faces, wanted, planes, batch: 0, first: 0, numbers, walked: None, first_row };
        Self { listed, pipeline, buffers }
    }

    /// Begins face `k`, whose rows are added one by one.
    pub(super) fn walk(&mut self, k: usize) -> SortedTriangle {
        let face = self.listed.faces.sorted(k);
        let triangle = face.triangle;
        let columns = &self.listed.faces.triangles.columns.effects;
        let corners = FaceCorners { triangle, face, columns };
        self.listed.walked = Some(WalkedFace {
            face,
            shade: ShadePlane::of_values(&triangle, triangle.shades()),
            depth: DepthPlane::new(&triangle),
            values: self.listed.wanted.values.map(|value| {
                let value = value?;
                Some(ShadePlane::of_values(&triangle, corners.value(value)))
            }),
        });
        // Columns and rows are those of the frame.
        (self.listed.first, self.listed.batch) = (k, 0);
        (self.listed.planes[0].column, self.listed.planes[0].row) = ([0; LANES], [0; LANES]);
        triangle
    }

    /// Adds the drawn part of a row of the face that is walked down, whose pixels and cells the target's are.
    pub(super) fn add_row<D: Cell>(&mut self, row: &Row, list: &mut SpanList, target: &mut Target<'_, D>) {
        let mut number = (row.x0 - row.origin) / RESEED;
        let mut x = row.x0;
        while x < row.x1 {
            let seed = row.origin + number * RESEED;
            let end = row.x1.min(seed + RESEED);
            if !list.has_room(1) {
                self.draw_spans(list, target);
            }
            let Some(WalkedFace { shade, values, .. }) = &self.listed.walked else { return };
            let reseeds = self.listed.wanted.reseeds;
            let value = |plane: &ShadePlane, reseeds: bool| {
                let start = match reseeds {
                    true => plane.start(seed, row.y),
                    // Columns are below 4,096; the sum is meant modulo 2¹⁶.
                    false => {
                        let steps = (seed - row.origin) as u16;
                        plane.start(row.origin, row.y).wrapping_add(plane.step().wrapping_mul(steps))
                    }
                };
                u32::from(start) | u32::from(plane.step()) << 16
            };
            let paint = value(shade, reseeds);
            let mut of_slots = [0; Value::MAX_COUNT];
            for (slot, plane) in values.iter().enumerate() {
                let reseeds = reseeds || slot == Value::Fog.slot();
                of_slots[slot] = plane.as_ref().map_or(0, |plane| value(plane, reseeds));
            }
            // A column of a frame.
            if let Some(k) = list.push((x as usize, (end - x) as usize), paint) {
                let mark = Mark::new(0, [x - seed, number, row.last - seed], [seed, row.y]);
                let ([a, b], [v0, v1, v2, v3]) = (mark.0, of_slots);
                self.listed.numbers.set(k, [a, b, v0, v1, v2, v3]);
            }
            number += 1;
            x = end;
        }
    }

    /// Draws the spans of a list, which is then empty.
    #[inline(never)]
    pub(super) fn draw_spans<D: Cell>(&mut self, list: &mut SpanList, target: &mut Target<'_, D>) {
        let Self { listed, pipeline, buffers, .. } = self;
        let (mut first, mut nearer) = (0, 0);
        while first < list.count() {
            let spans = Spans::of(listed, list, first);
            run_stages(&spans, pipeline, buffers, target.kernel);
            nearer += write(&spans, pipeline, &mut buffers.bytes, target);
            first += spans.count;
        }
        list.clear(nearer);
    }
}

impl Shades8 for EffectSpans<'_> {
    const IS_LINEAR: bool = false;
    type Columns<S: Lanes8> = Marks8<S>;

    #[inline(always)]
    fn is_full(&self) -> bool {
        self.listed.batch + 1 >= BATCHES
    }

    #[inline(always)]
    fn begin(&mut self, first: usize) {
        let starts_anew = first == 0 || self.is_full();
        (self.listed.batch, self.listed.first) =
            if starts_anew { (0, first) } else { (self.listed.batch + 1, self.listed.first) };
    }

    #[inline(always)]
    fn set_up<S: Lanes8>(&mut self, s: S, basis: &Basis<S>, corners: &Corners8, setup: &TriangleSetup8) {
        let Listed { faces: Faces { triangles, picks }, wanted, planes, batch, first, .. } = &mut self.listed;
        let first = *first + *batch * LANES;
        let picks = &picks.range(first, picks.picks.len().min(first + LANES));
        let planes = &mut planes[*batch % BATCHES];
        (planes.column, planes.row) = (setup.column, setup.row);
        for (i, z) in planes.z.iter_mut().enumerate() {
            *z = [setup.z[i], setup.z_per_column[i], setup.z_per_row[i]];
        }
        if let Some(mapping) = wanted.texture {
            let of_corners = texture_of_corners(triangles, picks);
            match mapping {
                Mapping::Affine => {
                    planes.affine.set_up(s, basis, &of_corners);
                    // Sums of large ones do not fit in f64.
                    for (lane, &pick) in picks.picks.iter().enumerate() {
                        planes.affine.fits &= !(u32::from(Pick(pick).class() != SizeClass::Small) << lane);
                    }
                }
                _ => planes.perspective.set_up(s, basis, corners, &of_corners),
            }
        }
        for (planes, value) in planes.values.iter_mut().zip(wanted.values) {
            if let Some(value) = value {
                planes.set_up(s, basis, &value_of_corners(triangles, picks, value));
            }
        }
    }

    #[inline(always)]
    fn fill_of<S: Lanes8>(
        &self,
        s: S,
        lane: impl Lane<S>,
        setup: &TriangleSetup8,
        (ends, j): (&RowEnds<S>, S::F64),
        parts: &Parts<S>,
    ) -> (S::I32, Marks8<S>) {
        let (row, seed) = (s.low_bits(parts.row), s.low_bits(parts.seed));
        let before = s.sub_i32(seed, row);
        let Wanted { values: wanted, slots, reseeds, .. } = &self.listed.wanted;
        let begin = if *reseeds { parts.seed } else { parts.row };
        let mut paint = ends.paint(s, lane, setup, begin);
        if !reseeds {
            paint = advance(s, paint, before);
        }
        let planes = &self.listed.planes[self.listed.batch % BATCHES];
        let mut values = [s.splat_i32(0); Value::MAX_COUNT];
        for slot in 0..(*slots).min(Value::MAX_COUNT) {
            let Some(value) = wanted[slot] else { continue };
            let reseeds = *reseeds || !matches!(value, Value::Channel(_));
            let begin = if reseeds { parts.seed } else { parts.row };
            values[slot] = value_of(s, lane, (&planes.values[slot], &setup.inverse), j, begin);
            if !reseeds {
                values[slot] = advance(s, values[slot], before);
            }
        }
        let face = s.add_i32(s.splat_i32((self.listed.batch % BATCHES * LANES) as i32), lane.numbers(s));
        let skipped = s.sub_i32(s.low_bits(parts.start), seed);
        let last = s.sub_i32(s.sub_i32(s.low_bits(parts.end), s.splat_i32(1)), seed);
        // Those of a span that there is are in their ranges: see `Mark`.
        let mark = s.or_i32(face, s.shl_i32(skipped, 6));
        let mark = s.or_i32(mark, s.shl_i32(s.shr_i32(before, 6), 12));
        let mark = s.or_i32(mark, s.shl_i32(last, 19));
        let number = s.low_bits(s.add(j, s.splat_f64(ROUND_MAGIC)));
        let [v0, v1, v2, v3] = values;
        let numbers = [mark, s.or_i32(seed, s.shl_i32(number, 16)), v0, v1, v2, v3];
        (paint, Marks8 { numbers, count: 2 + *slots })
    }

    #[inline(always)]
    fn append<S: Lanes8, const DEPTHS: bool>(
        &mut self,
        s: S,
        list: &mut SpanList,
        spans: &Spans8<S, Marks8<S>>,
        dz: DepthSteps<S>,
    ) {
        let places = list.append::<S, _, DEPTHS>(s, spans, dz);
        self.listed.numbers.put(s, places, spans.columns.numbers, 2 + self.listed.wanted.slots);
    }

    #[inline(always)]
    fn set_up_large(&mut self, i: usize, setup: &TriangleSetup8) {
        let (planes, i) = (&mut self.listed.planes[self.listed.batch % BATCHES], i % LANES);
        planes.z[i] = [setup.z[i], setup.z_per_column[i], setup.z_per_row[i]];
    }

    #[inline(always)]
    fn draw<S: Lanes8, D: Cell, const DEPTHS: bool>(
        &mut self,
        _: S,
        list: &mut SpanList,
        kernel: Kernel,
        pixels: &mut [u8],
        cells: &mut [D],
    ) {
        // Without a depth buffer there are none.
        let cells = if cells.is_empty() { None } else { Some(cells) };
        self.draw_spans(list, &mut Target { pixels, cells, kernel });
    }
}

/// A value of the corners of up to eight triangles. Lanes without a triangle have 0.
#[inline(always)]
fn value_of_corners(triangles: &Triangles<'_>, picks: &Picks<'_>, value: Value) -> [Ints; 3] {
    let mut gathered = [[0; LANES]; 3];
    let columns = &triangles.columns.effects;
    for (lane, &pick) in picks.picks.iter().take(LANES).enumerate() {
        let pick = Pick(pick);
        // The channels of a face that is lit as one.
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

/// Spans that pass through the stages together; their pixels lie one behind the other.
pub(super) struct Spans<'a> {
    listed: &'a Listed<'a>,
    list: &'a SpanList,
    /// Index of the first in the list.
    first: usize,
    count: usize,
    /// Where the pixels of each begin, and at the end how many there are.
    pixels: [u32; SpanList::CAPACITY + 1],
}

/// A span that passes through the stages.
#[derive(Clone, Copy)]
pub(super) struct Span {
    mark: Mark,
    /// The column and the row of its first pixel, which the clip rectangle may hide.
    pub(super) x: i32,
    pub(super) y: i32,
    /// Where its pixels begin among those of all spans, ...
    pub(super) first: usize,
    /// ... and how many it has, hidden ones among them: 1 to 64.
    pub(super) len: usize,
}

impl Span {
    /// Its pixels among those of all spans.
    #[inline(always)]
    pub(super) fn pixels(&self) -> Range<usize> {
        self.first..self.first + self.len
    }

    /// The column of its first pixel.
    #[inline(always)]
    pub(super) fn column(&self) -> usize {
        // Not negative: it lies inside the frame.
        self.x as usize
    }

    /// The thresholds of its row.
    #[inline(always)]
    pub(super) fn thresholds(&self, of: Thresholds) -> &'static ThresholdRow {
        // Not negative: it lies inside the frame.
        of.row(self.y as usize)
    }

    /// The row's last pixel inside the frame, whatever the clip rectangle, from its own first one.
    #[inline(always)]
    pub(super) fn last(&self) -> i32 {
        self.mark.last()
    }

    /// Its row.
    pub(super) fn row(&self) -> Row {
        let origin = self.x - self.mark.before();
        // At most 64.
        let (x0, x1) = (self.x + self.mark.skipped() as i32, self.x + self.len as i32);
        Row { y: self.y, origin, x0, x1, last: self.x + self.last() }
    }
}

impl<'a> Spans<'a> {
    /// Those from index `first` on, as many as pass through the stages together.
    #[inline]
    fn of(listed: &'a Listed<'_>, list: &'a SpanList, first: usize) -> Self {
        let mut spans = Self { listed, list, first, count: 0, pixels: [0; SpanList::CAPACITY + 1] };
        let mut end = 0;
        for k in first..list.count() {
            // At most 64.
            end += list.fill_of(k).0 as u32 + listed.mark(k).skipped();
            if end as usize > PIXELS {
                break;
            }
            spans.count += 1;
            spans.pixels[spans.count] = end;
        }
        spans
    }

    #[inline(always)]
    pub(super) fn count(&self) -> usize {
        self.count
    }

    /// Number of pixels of all spans.
    #[inline(always)]
    pub(super) fn pixels(&self) -> usize {
        self.pixels[self.count] as usize
    }

    /// Span `i` of these.
    #[inline(always)]
    pub(super) fn span(&self, i: usize) -> Span {
        let mark = self.listed.mark(self.first + i);
        let (planes, lane) = self.listed.planes(mark.face());
        let [column, row] = mark.place();
        let (first, end) = (self.pixels[i] as usize, self.pixels[i + 1] as usize);
        Span { mark, x: planes.column[lane] + column, y: planes.row[lane] + row, first, len: end - first }
    }

    /// Where the pixels of span `i` begin among those of all, and how many it has.
    #[inline(always)]
    pub(super) fn range(&self, i: usize) -> (usize, usize) {
        let (first, end) = (self.pixels[i] as usize, self.pixels[i + 1] as usize);
        (first, end - first)
    }

    /// All of them.
    #[inline(always)]
    pub(super) fn iter(&self) -> impl Iterator<Item = Span> {
        (0..self.count).map(|i| self.span(i))
    }

    /// The index behind the last span of the face that span `i` belongs to.
    #[inline(always)]
    pub(super) fn end_of_face(&self, i: usize) -> usize {
        let face = |i: usize| self.listed.mark(self.first + i).face();
        let of = face(i);
        let mut end = i + 1;
        while end < self.count && face(end) == of {
            end += 1;
        }
        end
    }

    /// The face of a span, and its corners' values.
    #[inline(never)]
    pub(super) fn corners(&self, span: &Span) -> FaceCorners<'a> {
        let Listed { faces, first, walked, .. } = self.listed;
        let face = match walked {
            Some(walked) => walked.face,
            None => faces.sorted(first + span.mark.face()),
        };
        FaceCorners { triangle: face.triangle, face, columns: &faces.triangles.columns.effects }
    }

    /// The first shade of span `i`, and above it the step.
    #[inline(always)]
    pub(super) fn paint(&self, i: usize) -> u32 {
        self.list.fill_of(self.first + i).1
    }

    /// The first of a value of span `i`, and above it the step.
    #[inline(always)]
    pub(super) fn value(&self, value: Value, i: usize) -> u32 {
        self.listed.numbers.of(self.first + i, 2 + value.slot())
    }

    /// The planes of texture coordinates that are linear on the screen, and the lane, of the face of span `i`; `None` where
    /// set-up in f64 has none.
    #[inline(always)]
    pub(super) fn affine(&self, i: usize) -> Option<(&'a AffinePlanes8, usize)> {
        let (planes, lane) = self.planes(i)?;
        (planes.affine.fits >> lane & 1 != 0).then_some((&planes.affine, lane))
    }

    /// The planes of those that are linear on the face, likewise.
    #[inline(always)]
    pub(super) fn perspective(&self, i: usize) -> Option<(&'a PerspectivePlanes8, usize)> {
        self.planes(i).map(|(planes, lane)| (&planes.perspective, lane))
    }

    #[inline(always)]
    fn planes(&self, i: usize) -> Option<(&'a FacePlanes8, usize)> {
        let mark = self.listed.mark(self.first + i);
        if self.listed.walked.is_some() { None } else { Some(self.listed.planes(mark.face())) }
    }

    /// The column and the row of span `i` from those of its planes.
    #[inline(always)]
    pub(super) fn place(&self, i: usize) -> [i32; 2] {
        self.listed.mark(self.first + i).place()
    }

    /// One stage: for every face `plane` makes what its values are over it, from its corners top to bottom; for every
    /// span `fill` makes its part of `out` from that.
    #[inline(always)]
    pub(super) fn each<P, T>(
        &self,
        out: &mut [T],
        plane: impl Fn(&FaceCorners<'_>) -> P,
        mut fill: impl FnMut(&P, &Span, &mut [T]),
    ) {
        let mut i = 0;
        while i < self.count {
            let end = self.end_of_face(i);
            let plane = plane(&self.corners(&self.span(i)));
            while i < end {
                let span = self.span(i);
                fill(&plane, &span, &mut out[span.pixels()]);
                i += 1;
            }
        }
    }

    /// A stage of shades, or of another value.
    pub(super) fn fill(&self, shaded: Shaded, out: &mut [u8], kernel: Kernel) {
        match shaded.interpolation {
            Interpolation::Flat(index) => out[..self.pixels()].fill(index),
            Interpolation::Gouraud | Interpolation::GouraudReseeded => {
                fill_linear_at_best(kernel, kernel, self, shaded, out);
            }
            _ => self.fill_by_shader(shaded, out, kernel),
        }
    }

    /// Fills spans by a shader of their own.
    #[inline(never)]
    fn fill_by_shader(&self, Shaded { value, interpolation, dither }: Shaded, out: &mut [u8], kernel: Kernel) {
        let shader = |face: &FaceCorners<'_>| {
            let values = match value {
                None => face.triangle.shades(),
                Some(value) => face.value(value),
            };
            RowShader::of_values(&face.triangle, values, interpolation)
        };
        self.each(out, shader, |shader, span, out| {
            let thresholds = dither.map(|dither| span.thresholds(dither));
            shader.piece(&span.row(), span.x, out, thresholds, kernel);
        });
    }

    /// Where the drawn pixels of span `i` are among those of all, where they lie in the frame, and how many they are.
    #[inline(always)]
    pub(super) fn drawn(&self, i: usize) -> (usize, usize, usize) {
        let k = self.first + i;
        let (first, skipped) = (self.pixels[i] as usize, self.listed.mark(k).skipped() as usize);
        (first + skipped, self.list.offset(k) as usize, self.list.fill_of(k).0)
    }

    /// Where the first drawn pixel of span `i` lies in the depth buffer; its depth, and the change from one to the next, with
    /// 24 fraction bits.
    #[inline(always)]
    pub(super) fn depth(&self, i: usize) -> (usize, [i64; 2]) {
        let k = self.first + i;
        let mark = self.listed.mark(k);
        // At most 63.
        let ([column, row], skipped) = (mark.place(), mark.skipped() as i32);
        if let Some(walked) = &self.listed.walked {
            let z = walked.depth.fixed_at(column + skipped, row);
            return (self.list.offset(k) as usize, [z, walked.depth.step()]);
        }
        let (planes, lane) = self.listed.planes(mark.face());
        let [z, per_column, per_row] = planes.z[lane];
        let z = z.wrapping_add(per_column.wrapping_mul((column + skipped).into()));
        let z = z.wrapping_add(per_row.wrapping_mul(row.into()));
        let place = [planes.column[lane] + column + skipped, planes.row[lane] + row];
        (self.list.cell_at(k, place, self.listed.first_row), [z >> 8, per_column >> 8])
    }
}

/// A shade or another value of the corners, as bytes.
#[derive(Clone, Copy)]
pub(super) struct Shaded {
    /// `None` for the shade.
    pub(super) value: Option<Value>,
    pub(super) interpolation: Interpolation,
    pub(super) dither: Option<Thresholds>,
}

impl Shaded {
    /// A value that starts anew with every span.
    pub(super) fn linear(value: Value) -> Self {
        Self { value: Some(value), interpolation: Interpolation::GouraudReseeded, dither: None }
    }
}

at_best_level! {
    #[inline(never)]
    fn fill_linear_at_best[][](
        level: Kernel,
        kernel: Kernel,
        spans: &Spans<'_>,
        shaded: Shaded,
        out: &mut [u8],
    ) {
        fill_linear(kernel, spans, shaded, out)
    }
}

#[inline(always)]
fn fill_linear(kernel: Kernel, spans: &Spans<'_>, Shaded { value, dither, .. }: Shaded, out: &mut [u8]) {
    match (value, dither) {
        (None, None) => fill_plain(kernel, spans, |i| spans.paint(i), out),
        (Some(value), None) => fill_plain(kernel, spans, |i| spans.value(value, i), out),
        (_, Some(thresholds)) => {
            for i in 0..spans.count() {
                let paint = value.map_or_else(|| spans.paint(i), |value| spans.value(value, i));
                // The halves.
                let (start, step) = (paint as u16, (paint >> 16) as u16);
                let span = spans.span(i);
                let row = span.thresholds(thresholds);
                fill_dithered(&mut out[span.pixels()], start.wrapping_sub(128), step, row, span.column());
            }
        }
    }
}

#[inline(always)]
fn fill_plain(kernel: Kernel, spans: &Spans<'_>, paint: impl Fn(usize) -> u32, out: &mut [u8]) {
    for i in 0..spans.count() {
        let paint = paint(i);
        // The halves.
        let (start, step) = (paint as u16, (paint >> 16) as u16);
        let (first, len) = spans.range(i);
        if len > LONG {
            kernel.fill(&mut out[first..first + len], start, step);
        } else {
            fill_blocks(&mut out[first..], len, start, step);
        }
    }
}

/// Pixels from which on a span's shades are filled by the kernel.
const LONG: usize = 20;

/// Fills the first `n` bytes, and up to seven more, for which there is room, with linear shades.
#[inline(always)]
fn fill_blocks(bytes: &mut [u8], n: usize, start: u16, step: u16) {
    let mut shade = start;
    let blocks = n.div_ceil(LANES);
    let Some(bytes) = bytes.get_mut(..blocks * LANES) else { return };
    for block in bytes.as_chunks_mut::<LANES>().0 {
        for (byte, k) in block.iter_mut().zip(0_u16..) {
            *byte = (shade.wrapping_add(step.wrapping_mul(k)) >> 8) as u8;
        }
        shade = shade.wrapping_add(step.wrapping_mul(LANES as u16));
    }
}

/// What is known of each span, for tests.
#[cfg(all(test, feature = "std"))]
pub(super) mod recorded {
    use alloc::vec::Vec;

    use super::*;
    use crate::raster::frame::Rect;
    use crate::raster::setup::FrameLayout;
    use crate::raster::spans::{Drawn, draw_triangles};
    use crate::simd::compiled_for_each_level;

    /// A span and the starts of its values.
    pub(in crate::raster::effects) struct Recorded {
        /// The index of its pick.
        pub(in crate::raster::effects) pick: usize,
        pub(in crate::raster::effects) span: Span,
        /// Start and step.
        pub(in crate::raster::effects) affine: Option<[[u32; 2]; 2]>,
        pub(in crate::raster::effects) perspective: Option<[[f64; 3]; 2]>,
        pub(in crate::raster::effects) depth: [i64; 2],
    }

    struct Recorder<'a> {
        spans: EffectSpans<'a>,
        recorded: Vec<Recorded>,
    }

    impl Shades8 for Recorder<'_> {
        const IS_LINEAR: bool = false;
        type Columns<S: Lanes8> = Marks8<S>;

        fn is_full(&self) -> bool {
            self.spans.is_full()
        }

        fn begin(&mut self, first: usize) {
            self.spans.begin(first);
        }

        #[inline(always)]
        fn set_up<S: Lanes8>(&mut self, s: S, basis: &Basis<S>, corners: &Corners8, setup: &TriangleSetup8) {
            self.spans.set_up(s, basis, corners, setup);
        }

        #[inline(always)]
        fn fill_of<S: Lanes8>(
            &self,
            s: S,
            lane: impl Lane<S>,
            setup: &TriangleSetup8,
            rows: (&RowEnds<S>, S::F64),
            parts: &Parts<S>,
        ) -> (S::I32, Marks8<S>) {
            self.spans.fill_of(s, lane, setup, rows, parts)
        }

        #[inline(always)]
        fn append<S: Lanes8, const DEPTHS: bool>(
            &mut self,
            s: S,
            list: &mut SpanList,
            spans: &Spans8<S, Marks8<S>>,
            dz: DepthSteps<S>,
        ) {
            self.spans.append::<S, DEPTHS>(s, list, spans, dz);
        }

        fn set_up_large(&mut self, i: usize, setup: &TriangleSetup8) {
            self.spans.set_up_large(i, setup);
        }

        fn draw<S: Lanes8, D: Cell, const DEPTHS: bool>(
            &mut self,
            _: S,
            list: &mut SpanList,
            _: Kernel,
            _: &mut [u8],
            _: &mut [D],
        ) {
            let (listed, mut first) = (&self.spans.listed, 0);
            while first < list.count() {
                let spans = Spans::of(listed, list, first);
                for i in 0..spans.count() {
                    let place = spans.place(i);
                    self.recorded.push(Recorded {
                        pick: listed.first + listed.mark(first + i).face(),
                        span: spans.span(i),
                        affine: spans.affine(i).map(|(planes, lane)| [planes.start(lane, place), planes.step(lane)]),
                        perspective: spans
                            .perspective(i)
                            .map(|(planes, lane)| [planes.start(lane, place), planes.step(lane)]),
                        depth: spans.depth(i).1,
                    });
                }
                first += spans.count();
            }
            list.clear(0);
        }
    }

    compiled_for_each_level! {
        fn record_at_level[][](of: Drawn<'_>, recorder: &mut Recorder<'_>, clip: Rect) -> u32 = record_by;
    }

    #[inline(always)]
    fn record_by<S: Lanes8>(s: S, of: Drawn<'_>, recorder: &mut Recorder<'_>, clip: Rect) -> u32 {
        // Every row has the same pixels.
        let layout = FrameLayout { first_row: 0, pitch: 0, width: 0 };
        let mut pixels = [0; 4_096];
        let (target, list) = ((layout, clip, Kernel::PORTABLE), &mut { SpanList::NONE });
        draw_triangles::<S, u32, _, true, false>(s, of, target, (&mut pixels, &mut []), recorder, list).spans
    }

    /// The spans of faces of which none is unbatched, in a frame of 4,096 x 4,096 pixels.
    pub(in crate::raster::effects) fn record(
        kernel: Kernel,
        triangles: &Triangles<'_>,
        picks: Picks<'_>,
        pipeline: &PixelPipeline<'_>,
    ) -> Vec<Recorded> {
        let (mut columns, mut buffers) = (Columns::NONE, Buffers::default());
        let spans = EffectSpans::new(Faces { triangles, picks }, pipeline, &mut columns, &mut buffers, 0);
        let mut recorder = Recorder { spans, recorded: Vec::new() };
        let clip = Rect { x0: 0, y0: 0, x1: 4_096, y1: 4_096 };
        record_at_level(kernel.simd_level(), Drawn { triangles, picks, in_pieces: true }, &mut recorder, clip);
        recorder.recorded
    }
}
