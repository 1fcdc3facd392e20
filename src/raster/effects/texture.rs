//! Texels: texture coordinates over a triangle, the level of a mipmap, and the bytes of the image along a row.
//!
//! Eight texel offsets are computed at a time, and their texels go straight to their destination: into the frame, or
//! into the stages' buffer. Mispredicting the length of a row costs as much as several pixels, so the last few pixels
//! of a span are written with a mask.

use super::destination::{Destination, DrawnPixels, InBuffer, Pair};
use super::listing::FaceCorners;
use super::pipeline::{Image, LEVELS, TextureStage};
use super::spans::Spans;
use crate::fixed::{HAS_F64, IS_COMPACT};
use crate::lanes::{LANES, NUMBERS};
use crate::mapping::Mapping;
use crate::raster::reference::level::LevelPlane;
use crate::raster::reference::texture::{AffineLevel, PerspectiveTexture};
use crate::simd::{BASELINE, F32Lanes8, Lanes8, Level, compiled_for_each_level};
use crate::span::Kernel;
use crate::span::texture::{
    AffineAlong, LevelTexels, OffsetLanes, OffsetsAlong, PairValues, PerspectiveSums, StoredAlong, StoredOffsets,
    Texels, Tint, affine_pair, fill_affine, perspective_along, show_pair, singles_along, singles_pair,
};

/// Pixels between two exact texture coordinates of [`Mapping::Every16`], and between two choices of a level.
const EVERY: i32 = 16;

/// Draws the texels of every span, linear on the face if the mapping is in perspective, otherwise
/// on the screen. The image has no levels, or this is a build for size.
#[inline(always)]
pub(super) fn show_texture<T: Tint, D: Destination>(
    spans: &Spans<'_>,
    (image, mapping): (Image<'_>, Mapping),
    tint: T,
    to: &mut D,
    kernel: Kernel,
) {
    let level = kernel.simd_level();
    match mapping {
        _ if IS_COMPACT => show_mipmaps(spans, (image, mapping), tint, to, kernel),
        Mapping::Affine => show_affine::<T, D>(level, spans, image.texels, tint, to),
        _ => show_exact::<T, D>(level, spans, image.texels, tint, (to, level)),
    }
}

/// Draws an image with levels, like [`show_texture`].
#[inline(always)]
pub(super) fn show_mipmaps<T: Tint, D: Destination>(
    spans: &Spans<'_>,
    (image, mapping): (Image<'_>, Mapping),
    tint: T,
    to: &mut D,
    kernel: Kernel,
) {
    let level = kernel.simd_level();
    match mapping {
        Mapping::Affine => show_affine_levels::<T, D>(level, spans, image, tint, to),
        _ => show_levels::<T, D>(level, spans, image, tint, (to, level)),
    }
}

impl Spans<'_> {
    /// Stores the texels of every span.
    pub(super) fn texels(&self, stage: &TextureStage<'_>, out: &mut [u8], kernel: Kernel) {
        let image = Image::new(stage);
        match stage.mapping {
            Mapping::Every16 => self.every_16(image, out),
            mapping if image.levels.is_some() => show_mipmaps(self, (image, mapping), (), &mut InBuffer(out), kernel),
            mapping => show_texture(self, (image, mapping), (), &mut InBuffer(out), kernel),
        }
    }

    /// Texels whose coordinates are exact at every 16th pixel and at the row's last inside the frame, whatever the clip
    /// rectangle, and linear between.
    #[inline(never)]
    fn every_16(&self, image: Image<'_>, out: &mut [u8]) {
        let (all, last_level) = (image.all(), image.last());
        let planes = |face: &FaceCorners<'_>| (face.perspective_texture(), (last_level > 0).then(|| face.levels()));
        self.each(out, planes, |(plane, levels), span, pixels| {
            let (y, last) = (span.y, span.x + span.last());
            for (x, part) in (span.x..).step_by(EVERY as usize).zip(pixels.chunks_mut(EVERY as usize)) {
                let level = levels.as_ref().map_or(0, |of| level_at(plane, of, middle(x, last), y, last_level));
                // Beyond the triangle there may be no coordinates at all.
                let next = (x + EVERY).min(last).max(x);
                let [from, to] = [x, next].map(|x| plane.at(x, y).map(|coordinate| coordinate >> level));
                // Wrapping is intended, since texels repeat. The division is never −2³¹ by −1.
                let step = |i: usize| (to[i].wrapping_sub(from[i]) / (next - x).max(1)) as u32;
                let [u, v] = from.map(i32::cast_unsigned);
                fill_affine(part, all[level as usize % LEVELS], u, v, step(0), step(1));
            }
        });
    }
}

/// The pixel that decides the level of the 16 from `x` on: the middle one, or the row's last inside the frame, whatever
/// the clip rectangle.
#[inline(always)]
fn middle(x: i32, last: i32) -> i32 {
    (x + EVERY / 2).min(last).max(x)
}

fn level_at(plane: &PerspectiveTexture, levels: &LevelPlane, x: i32, y: i32, last: u32) -> u32 {
    levels.at(levels.across(y), x, plane.denominator(x, y), last)
}

compiled_for_each_level! {
    /// Draws the texels of every span, linear on the screen.
    #[inline(never)]
    fn show_affine[T: Tint, D: Destination][T, D](spans: &Spans<'_>, image: Texels<'_>, tint: T, to: &mut D)
        = show_affine_by, up to AVX2;
}

compiled_for_each_level! {
    /// Draws the texels of every span, linear on the screen, each face from one level of the image.
    #[inline(never)]
    fn show_affine_levels[T: Tint, D: Destination][T, D](spans: &Spans<'_>, image: Image<'_>, tint: T, to: &mut D)
        = show_affine_levels_by, up to AVX2;
}

compiled_for_each_level! {
    /// Draws the texels of every span, linear on the face.
    #[inline(never)]
    fn show_exact[T: Tint, D: Destination][T, D](spans: &Spans<'_>, image: Texels<'_>, tint: T, to: (&mut D, Level))
        = show_exact_by;
}

compiled_for_each_level! {
    /// Draws the texels of every span, linear on the face, from a mipmap level chosen every 16
    /// pixels.
    #[inline(never)]
    fn show_levels[T: Tint, D: Destination][T, D](spans: &Spans<'_>, image: Image<'_>, tint: T, to: (&mut D, Level))
        = show_levels_by, up to AVX2;
}

#[inline(always)]
fn show_affine_by<S: Lanes8, T: Tint, D: Destination>(s: S, spans: &Spans<'_>, image: Texels<'_>, tint: T, to: &mut D) {
    let offsets = OffsetLanes::of_level(s, (image, 0));
    let mut i = 0;
    while i < spans.count() {
        if let Some(pair) = Pair::of::<T, D>(to, spans, i) {
            show_two(
                s,
                (spans, i, &pair),
                (image, tint),
                to,
                #[inline(always)]
                || affine_pair(s, image, [spans.affine_start(i), spans.affine_start(i + 1)]),
            );
            i += 2;
        } else {
            show_line(
                (spans, i),
                #[inline(always)]
                || spans.affine_start(i),
                (image, offsets),
                tint,
                to,
            );
            i += 1;
        }
    }
}

/// Draws the texels of spans `i` and `i + 1`. `offsets` returns where they are in the image, four for each.
#[inline(always)]
fn show_two<S: Lanes8, T: Tint, D: Destination>(
    s: S,
    (spans, i, pair): (&Spans<'_>, usize, &Pair),
    (image, tint): (Texels<'_>, T),
    to: &mut D,
    offsets: impl FnOnce() -> S::I32,
) {
    let values = PairValues([spans.values::<T>(i, 0), spans.values::<T>(i + 1, 0)]);
    show_pair(s, (to.all(), pair.at, pair.stays()), image, (tint, values), offsets());
}

#[inline(always)]
fn show_affine_levels_by<S: Lanes8, T: Tint, D: Destination>(
    s: S,
    spans: &Spans<'_>,
    image: Image<'_>,
    tint: T,
    to: &mut D,
) {
    let (has_levels, all) = (image.levels.is_some(), image.all());
    // The level of the previous face, whose set-up is kept.
    let (mut texels, mut shown) = (all[0], 0);
    let mut offsets = OffsetLanes::of_level(s, (texels, 0));
    for i in 0..spans.count() {
        let level = if has_levels { spans.affine_level(i) } else { AffineLevel::default() };
        let [start, step] = spans.affine_start(i);
        if level.level != shown {
            (texels, shown) = (all[level.level as usize % LEVELS], level.level);
            offsets = OffsetLanes::of_level(s, (texels, 0));
        }
        show_line(
            (spans, i),
            #[inline(always)]
            || [level.of(start), level.of(step)],
            (texels, offsets),
            tint,
            to,
        );
    }
}

/// Draws the texels of span `i`. `line` returns their coordinates at its first pixel and the change per pixel; it is
/// called once pixels are known to be drawn, so that numbers are broadcast from memory.
#[inline(always)]
fn show_line<S: Lanes8, T: Tint, D: Destination>(
    (spans, i): (&Spans<'_>, usize),
    line: impl FnOnce() -> [[u32; 2]; 2],
    (image, offsets): (Texels<'_>, OffsetLanes<S>),
    tint: T,
    to: &mut D,
) {
    let s = offsets.s;
    let Some(pixels) = to.begin(s, spans, i) else { return };
    let along = &mut tint.begin(s, spans.values::<T>(i, pixels.skipped));
    to.show(s, (spans, i, 0), pixels, (image, tint, along), AffineAlong::new(offsets, image, line(), pixels.skipped));
}

#[inline(always)]
fn show_exact_by<S: F32Lanes8, T: Tint, D: Destination>(
    s: S,
    spans: &Spans<'_>,
    image: Texels<'_>,
    tint: T,
    (to, level): (&mut D, Level),
) {
    let offsets = OffsetLanes::of_level(s, (image, 0));
    let mut i = 0;
    while i < spans.count() {
        if let Some(pair) = Pair::of::<T, D>(to, spans, i)
            && let Some(first) = spans.singles(i)
            && let Some(second) = spans.singles(i + 1)
        {
            show_two(
                s,
                (spans, i, &pair),
                (image, tint),
                to,
                #[inline(always)]
                || {
                    let (offsets, is_unsure) = singles_pair(s, image, [first, second]);
                    if is_unsure { s.load_i32(&exact_pair((spans, i), image)) } else { offsets }
                },
            );
            i += 2;
            continue;
        }
        // Testing depths first is no faster here, and slower with SSE2.
        let pixels = to.untested(spans, i);
        // At most 64.
        show_part((spans, i, 0), pixels, pixels.skipped as usize, ((image, 0), offsets), tint, (to, level));
        i += 1;
    }
}

/// The offsets of the first four texels of spans `i` and `i + 1`, where quotients cannot decide.
#[cold]
#[inline(never)]
fn exact_pair((spans, i): (&Spans<'_>, usize), image: Texels<'_>) -> [i32; LANES] {
    let (mut low, mut high) = ([0; LANES], [0; LANES]);
    exact_eight((spans, i), &mut None, (image, 0), 0, &mut low);
    exact_eight((spans, i + 1), &mut None, (image, 0), 0, &mut high);
    low[4..].copy_from_slice(&high[..4]);
    low
}

#[inline(always)]
fn show_levels_by<S: F32Lanes8, T: Tint, D: Destination>(
    s: S,
    spans: &Spans<'_>,
    image: Image<'_>,
    tint: T,
    (to, level): (&mut D, Level),
) {
    let (all, last_level) = (&image.all(), image.last());
    // The level of the previous face, whose set-up is kept.
    let mut image = (all[0], 0);
    let mut offsets = OffsetLanes::of_level(s, image);
    for i in 0..spans.count() {
        let Some(pixels) = to.begin(s, spans, i) else { continue };
        let single = if last_level == 0 { Some(0) } else { spans.single_level(i) };
        // Only the loop with quotients in f32 is inlined, since each loop takes long to compile.
        if !IS_COMPACT
            && let Some(level) = single
            && let Some(sums) = spans.singles(i)
        {
            if level != image.1 {
                image = (all[level as usize % LEVELS], level);
                offsets = OffsetLanes::of_level(s, image);
            }
            // At most 64.
            show_in_singles((spans, i, 0), pixels, pixels.skipped as usize, (image, offsets, sums), tint, to);
            continue;
        }
        let to = (&mut *to, level);
        // A closure that moves: see `show_part`.
        s.apart(
            #[inline(always)]
            move || show_parts(s, (spans, i), pixels, (all, last_level, single), tint, to),
        );
    }
}

/// Draws the texels of span `i`, from levels chosen every 16 pixels unless there is a single one.
#[inline(always)]
fn show_parts<S: F32Lanes8, T: Tint, D: Destination>(
    s: S,
    (spans, i): (&Spans<'_>, usize),
    pixels: DrawnPixels,
    (all, last_level, single): (&[Texels<'_>; LEVELS], u32, Option<u32>),
    tint: T,
    (to, lanes): (&mut D, Level),
) {
    const EVERY: usize = self::EVERY as usize;
    // At most 64, all of them.
    let skipped = pixels.skipped as usize;
    let (mut first, end, last) = (skipped, skipped + pixels.length, spans.last(i));
    let mut levels = [-1; LANES];
    if HAS_F64 && single.is_none() {
        // Each 16 pixels have the level of the one in their middle: see `middle`.
        let begin = s.shl_i32(s.load_i32(&NUMBERS), 4);
        let k = s.min_i32(s.add_i32(begin, s.splat_i32(self::EVERY / 2)), s.splat_i32(last));
        s.store_i32(spans.levels(s, i, s.max_i32(k, begin), last_level), &mut levels);
    }
    // A span has at most 64 pixels.
    let [a, b, c, d, ..] = levels;
    let level_of_16 = |begin: usize| match u32::try_from([a, b, c, d][begin / EVERY % 4]) {
        Ok(level) => level,
        Err(_) => exact_level(spans, i, middle(begin as i32, last), last_level),
    };
    // Where the next level is chosen.
    let mut next = if single.is_some() { end } else { first / EVERY * EVERY };
    let mut level = single.unwrap_or_else(|| level_of_16(next));
    while first < end {
        let (shown, before) = (level, first - skipped);
        while level == shown && next < end {
            next += EVERY;
            if next < end {
                level = level_of_16(next);
            }
        }
        let (part, n) = ((spans, i, before as u32), next.min(end) - first);
        let image = (all[shown as usize % LEVELS], shown);
        let image = (image, OffsetLanes::of_level(s, image));
        show_part(part, pixels.part(before, n), first, image, tint, (&mut *to, lanes));
        first += n;
    }
}

/// Draws texels in a span, linear on the face, from its pixel `first` on, which follows `before` drawn pixels.
#[inline(always)]
fn show_part<S: F32Lanes8, T: Tint, D: Destination>(
    (spans, i, before): (&Spans<'_>, usize, u32),
    pixels: DrawnPixels,
    first: usize,
    (image, offsets): (LevelTexels<'_>, OffsetLanes<S>),
    tint: T,
    (to, level): (&mut D, Level),
) {
    if !IS_COMPACT && let Some(sums) = spans.singles(i) {
        show_in_singles((spans, i, before), pixels, first, (image, offsets, sums), tint, to);
    } else {
        // A `move` closure, so that nothing that the other loops use has to be in memory.
        offsets.s.apart(
            #[inline(always)]
            move || {
                // At most 64.
                let along = &mut tint.begin(offsets.s, spans.values::<T>(i, first as u32));
                let all = StoredAlong::new(
                    offsets.s,
                    #[inline(always)]
                    |offsets| offsets_in_doubles(level, (spans, i), image, (first, first + pixels.length), offsets),
                );
                to.show(offsets.s, (spans, i, before), pixels, (image.0, tint, along), all);
            },
        );
    }
}

/// [`show_part`] by quotients in f32, which must be allowed.
#[inline(always)]
fn show_in_singles<S: F32Lanes8, T: Tint, D: Destination>(
    (spans, i, before): (&Spans<'_>, usize, u32),
    pixels: DrawnPixels,
    first: usize,
    (image, offsets, sums): (LevelTexels<'_>, OffsetLanes<S>, PerspectiveSums<f32>),
    tint: T,
    to: &mut D,
) {
    // Set up for the first eight that need it.
    let mut plane = None;
    let exact = |first: usize, eight: &mut [i32; LANES]| exact_eight((spans, i), &mut plane, image, first, eight);
    // At most 64.
    let along = &mut tint.begin(offsets.s, spans.values::<T>(i, first as u32));
    let all = singles_along(offsets, sums, first, exact);
    to.show(offsets.s, (spans, i, before), pixels, (image.0, tint, along), all);
}

compiled_for_each_level! {
    /// Stores the offsets of the texels of span `i` in this range of its pixels, by quotients in f64.
    #[inline(never)]
    fn offsets_in_doubles[][](
        of: (&Spans<'_>, usize),
        image: LevelTexels<'_>,
        range: (usize, usize),
        offsets: &mut StoredOffsets,
    ) = offsets_in_doubles_by, up to AVX2;
}

#[inline(always)]
fn offsets_in_doubles_by<S: Lanes8>(
    s: S,
    (spans, i): (&Spans<'_>, usize),
    image: LevelTexels<'_>,
    range: (usize, usize),
    offsets: &mut StoredOffsets,
) {
    let mut plane = None;
    let exact = |first: usize, eight: &mut [i32; LANES]| exact_eight((spans, i), &mut plane, image, first, eight);
    let mut along = perspective_along(OffsetLanes::of_level(s, image), spans.sums(i), range, exact);
    for eight in offsets.iter_mut().take((range.1 - range.0).div_ceil(LANES)) {
        s.store_i32(along.next(), eight);
    }
}

/// The level of an image at pixel `k` of span `i`, by its definition.
#[cold]
#[inline(never)]
pub(super) fn exact_level(spans: &Spans<'_>, i: usize, k: i32, last: u32) -> u32 {
    let (span, (plane, levels)) = (spans.span(i), spans.exact_texture(i));
    // Below 64.
    levels.map_or(0, |levels| level_at(&plane, &levels, span.x + k, span.y, last))
}

/// The offsets of eight texels of span `i`, from its pixel `first` on, where its quotients cannot decide.
#[cold]
#[inline(never)]
fn exact_eight(
    (spans, i): (&Spans<'_>, usize),
    plane: &mut Option<PerspectiveTexture>,
    (texels, level): LevelTexels<'_>,
    first: usize,
    eight: &mut [i32; LANES],
) {
    let span = spans.span(i);
    // Quotients in f64, where those in f32 could not.
    if HAS_F64 && !IS_COMPACT {
        let (range, mut is_sure) = ((first, span.len.min(first + LANES)), true);
        let lanes = OffsetLanes::of_level(BASELINE, (texels, level));
        let eight_in_f64 = perspective_along(lanes, spans.sums(i), range, |_, _| is_sure = false).next();
        if is_sure {
            BASELINE.store_i32(eight_in_f64, eight);
            return;
        }
    }
    let plane = plane.get_or_insert_with(|| spans.exact_texture(i).0);
    for (offset, k) in eight.iter_mut().zip(first..span.len) {
        // Below 64.
        let [u, v] = plane.at(span.x + k as i32, span.y).map(|coordinate| (coordinate >> level).cast_unsigned());
        // Below 65,536.
        *offset = texels.offset(u, v) as i32;
    }
}

#[cfg(all(test, feature = "std"))]
mod tests {
    use alloc::vec::Vec;

    use proptest::prelude::*;

    use super::*;

    use crate::fixed::{I24F8, U8F8};
    use crate::raster::columns::{Columns, EffectColumns, PickedTriangles, Picks, ScreenPos, Triangles};
    use crate::raster::cull::{PickList, cull, pick};
    use crate::raster::effects::listing::{self, EffectSpans};
    use crate::raster::effects::recorded::record;
    use crate::raster::effects::{Buffers, PixelPipeline, ShadeSource};
    use crate::raster::frame::Rect;
    use crate::raster::interpolation::Interpolation;
    use crate::raster::pick::Pick;
    use crate::raster::reference::cover::SortedTriangle;
    use crate::raster::reference::depth::DepthPlane;
    use crate::raster::reference::quotient::Divisor;
    use crate::raster::reference::texture::{AffinePlane, depth};
    use crate::raster::reference::weights::{Weights, exact};
    use crate::raster::vertex::Vertex;
    use crate::span::list::SpanList;
    use crate::span::target::Target;
    use crate::span::texture::Levels;
    use crate::span::texture::PerspectiveSums;

    /// Stands for an offset that quotients cannot decide. No decided one, shifted right by 16 bits or more, equals it.
    const UNDECIDED: i32 = i32::MIN;

    /// The definition in big integers: Σ λᵢ·uᵢ / (A·2ⁿ), rounded up where coordinates fall, down where they rise.
    fn defined(triangle: &SortedTriangle, coordinates: [i32; 3], level: u32, (x, y): (i32, i32)) -> u32 {
        let weights = Weights::new(triangle);
        let values = coordinates.map(i64::from);
        let (n, d) = (exact(weights.at(x, y), values), i128::from(triangle.area()) << level);
        let falls = exact(weights.per_column, values) < 0;
        (if falls { -(-n).div_euclid(d) } else { n.div_euclid(d) }) as u32
    }

    fn corner(side: i32) -> impl Strategy<Value = (i32, i32)> {
        (0..side, 0..side)
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(20_000))]
        /// Starts and steps equal the definition, for triangles from one pixel to a whole frame, and for coordinates
        /// from constant to those whose numerators exceed 64 bits.
        #[test]
        fn affine_coordinates_are_the_definition(
            (corners, (left, top)) in prop::sample::select(&[300, 5_000, 80_000, 1 << 20][..]).prop_flat_map(|side| {
                let pixel = (-side / 2..80_000, -side / 2..50_000);
                ([corner(side), corner(side), corner(side)], pixel)
            }),
            (bits, coordinates) in (0_u32..32, any::<[i32; 3]>()),
            level in 0_u32..9,
        ) {
            let vertex = |(x, y): (i32, i32)| {
                let at = |n: i32| I24F8::from_bits(n.clamp(-Vertex::GUARD_BAND, Vertex::GUARD_BAND));
                Vertex::new(at(left + x), at(top + y), U8F8::default(), 1).expect("inside the guard band")
            };
            let triangle = SortedTriangle::new(&corners.map(vertex));
            prop_assume!(triangle.doubled_area != 0);
            let coordinates = coordinates.map(|coordinate| coordinate >> bits);
            let plane = AffinePlane::new(&triangle, Divisor::new(triangle.area()), coordinates);
            let [gx, _] = plane.gradient;
            let in_level = AffineLevel { level, falls: [gx < 0; 2] };
            // Modulo 2²⁴, all that a texel's index depends on.
            let of_level = |x: u32| in_level.of([x; 2])[1] & 0xFF_FFFF;
            let mut rows = std::vec::Vec::new();
            triangle.rows(4_096, Rect { x0: 0, y0: 0, x1: 4_096, y1: 4_096 }, |row| rows.push(row));
            let (gx, _) = triangle.gradient(coordinates.map(i64::from));
            let step = 256 * i128::from(gx) / (i128::from(triangle.area()) << level);
            for row in rows.iter().step_by(1 + rows.len() / 8) {
                for x in [row.x0, i32::midpoint(row.x0, row.last), row.last] {
                    let start = plane.start(x, row.y);
                    prop_assert_eq!(start, defined(&triangle, coordinates, 0, (x, row.y)));
                    prop_assert_eq!(of_level(start), defined(&triangle, coordinates, level, (x, row.y)) & 0xFF_FFFF);
                }
                if row.x0 < row.last {
                    prop_assert_eq!(of_level(plane.step as u32), step as u32 & 0xFF_FFFF);
                }
            }
        }
    }

    /// Eight triangles: (x, y, depth), then u and v.
    type Given = [([(i32, i32, u32); 3], [[i32; 2]; 3]); 8];

    fn given() -> impl Strategy<Value = Given> {
        let side = |n: i32| prop::sample::select(&[200, 700, 4_000, 16_384][..]).prop_map(move |side: i32| side.min(n));
        // Up to 64 × 16 pixels, and some larger.
        let small = (side(16_384), side(4_096));
        let sides = prop_oneof![4 => small, 1 => (0..120_000, 0..120_000)];
        let triangle = sides.prop_flat_map(|(width, height)| {
            // Sums are greatest at the ends of the box.
            let at = |end: i32| prop_oneof![4 => 0..=end, 1 => Just(0), 1 => Just(end)];
            let depth = prop_oneof![3 => any::<u32>(), 1 => Just(0), 1 => Just(1), 1 => Just(u32::MAX)];
            let corner = (at(width), at(height), depth);
            // Within 2²² of each other, at that bound, one beyond it, or far from it.
            let apart = prop_oneof![
                4 => -(1 << 21)..1_i32 << 21,
                2 => (0_u32..32, any::<i32>()).prop_map(|(bits, n)| n >> bits),
                1 => prop::sample::select(&[0, 1, (1 << 22) - 1, 1 << 22, i32::MIN, i32::MAX][..]),
            ];
            let texture =
                (any::<[i32; 2]>(), prop::array::uniform3([apart.clone(), apart])).prop_map(|(origin, corners)| {
                    corners.map(|uv: [i32; 2]| [0, 1].map(|i| uv[i].wrapping_add(origin[i])))
                });
            // A whole number at every pixel: a numerator smaller by one gives another quotient.
            let whole = prop::option::of(prop::array::uniform2([-100..=100, -100..=100]));
            (prop::array::uniform3(corner), (0..60_000, 0..40_000), texture, whole)
        });
        let triangle = triangle.prop_map(|(corners, (left, top), texture, whole)| {
            let texture = whole.map_or(texture, |whole: [[i32; 2]; 2]| {
                corners.map(|(x, y, _)| [0, 1].map(|i| texture[0][i].wrapping_add(whole[i][0] * x + whole[i][1] * y)))
            });
            (corners.map(|(x, y, depth)| (left + x, top + y, depth)), texture)
        });
        // Boxed: eight value trees do not fit on the stack.
        prop::array::uniform8(triangle.boxed())
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(3_000))]
        /// Every level sets up eight triangles as it would each one alone: affine coordinates and
        /// depths to the bit, the sums of perspective ones as accurate as their planes are.
        #[test]
        fn eight_triangles_are_each_its_own(given in given()) {
            let (mut at, mut depth, mut shade) = (Vec::new(), Vec::new(), Vec::new());
            let (mut coordinates, mut indices, mut triangles) = (Vec::new(), Vec::new(), Vec::new());
            for (points, texture) in &given {
                let vertices = points.map(|(x, y, depth)| {
                    Vertex::new(I24F8::from_bits(x), I24F8::from_bits(y), U8F8::default(), depth).expect("inside")
                });
                let first = at.len() as u32;
                indices.push([first, first + 1, first + 2]);
                for (vertex, texture) in vertices.iter().zip(texture) {
                    at.push(ScreenPos::of(vertex));
                    depth.push(vertex.depth());
                    shade.push([vertex.shade(); 2]);
                    coordinates.push(*texture);
                }
                let (triangle, order) = SortedTriangle::with_order(&vertices);
                triangles.push((triangle, order.map(|corner| texture[corner])));
            }
            let effects = EffectColumns { texture: &coordinates, ..EffectColumns::default() };
            let columns = Columns { at: &at, depth: &depth, shade: &shade, effects };
            let all = Triangles { columns, indices: &indices, by_corner: None };
            let clip = Rect { x0: 0, y0: 0, x1: 4_096, y1: 4_096 };
            for (kernel, which) in
                Kernel::available().flat_map(|k| [(k, Mapping::Affine), (k, Mapping::Perspective)])
            {
                let texels = Texels::new(&[0], 0, 0).expect("an image");
                let stage = TextureStage { texels, levels: None, mapping: which, tables: [&[0; 65_536]; 3] };
                let pipeline = PixelPipeline { texture: Some(stage), ..PixelPipeline::PLAIN };
                let masks = cull(kernel.simd_level(), &at, &indices, clip, false);
                let mut list = PickList::<16>::new();
                pick(kernel.simd_level(), &mut list, 0, &masks, masks.covers);
                let picks = list.as_slice();
                for found in record(kernel, PickedTriangles { triangles: &all, picks: Picks { picks, flat: &[] } }, &pipeline) {
                    let pick = Pick(picks[found.pick]);
                    let (triangle, texture) = &triangles[pick.index()];
                    let (x, y) = (found.span.x, found.span.y);
                    let depths = DepthPlane::new(triangle);
                    let right = [depths.fixed_at(x, y), depths.step()];
                    prop_assert_eq!(found.depth.map(|z| z << 8), right.map(|z| z << 8));
                    let is_row = found.span.len > 1;
                    match which {
                        Mapping::Affine => {
                            let [start, step] = found.affine;
                            affine_is_right(triangle, texture, step, is_row, start, (x, y))?;
                        }
                        _ => {
                            sums_are_right(triangle, texture, &found.perspective, (x, y))?;
                        }
                    }
                }
            }
        }
    }

    /// Eight triangles with textures, some of them slivers, some with levels that differ only slightly.
    fn leveled() -> impl Strategy<Value = Given> {
        let depth = prop_oneof![4 => 16.0..30.0_f64, 1 => 0.0..16.0_f64];
        let sliver = prop::option::of((0.0..1.0_f64, 0..3_i32));
        let length = || (1..30_000_i32, 0..8).prop_map(|(length, bits)| 1.max(length >> bits));
        let triangle = (length(), length(), depth, 0.0..1.5_f64, 12.0..30.0_f64, sliver).prop_flat_map(
            |(width, height, depth, ratio, reach, sliver)| {
                let corner = (0..=width, 0..=height, 0.0..=ratio)
                    .prop_map(move |(x, y, ratio)| (x, y, (depth + ratio).min(31.0).exp2() as u32));
                let reach = reach.exp2() as i32;
                let texture = prop::array::uniform3([0..=reach, 0..=reach]);
                // The same scale for all, in powers of √2: levels that only just differ.
                let even = prop::option::of((0..8_i32, any::<bool>()));
                (prop::array::uniform3(corner), texture, any::<[i16; 2]>(), even, Just(sliver))
            },
        );
        let triangle = triangle.prop_map(|(corners, texture, origin, even, sliver)| {
            let mut corners = corners;
            if let Some((along, off)) = sliver {
                let [a, b, c] = &mut corners;
                let between = |a: i32, b: i32| a + (f64::from(b - a) * along) as i32;
                (c.0, c.1) = (between(a.0, b.0) + off, between(a.1, b.1));
            }
            let texture = match even {
                None => texture.map(|uv| [0, 1].map(|i| uv[i] + i32::from(origin[i] / 4) * 65_536)),
                Some((scale, is_odd)) => {
                    let texels = f64::from(1 << scale) * if is_odd { 181.0 / 128.0 } else { 1.0 };
                    let depth = corners[0].2;
                    corners = corners.map(|(x, y, _)| (x, y, depth));
                    corners.map(|(x, y, _)| [x, y].map(|at| (f64::from(at) * texels) as i32 * 256))
                }
            };
            (corners, texture)
        });
        prop::array::uniform8(triangle.boxed())
    }

    /// Levels found for eight triangles at a time match the definition. In perspective, an estimate decides most of
    /// them, and some faces are known to have a single one.
    #[test]
    fn levels_are_the_definition() {
        for mapping in [Mapping::Affine, Mapping::Perspective] {
            levels_of(mapping);
        }
    }

    fn levels_of(mapping: Mapping) {
        let [decided, single, all] = [0, 0, 0].map(core::cell::Cell::new);
        let mut runner = proptest::test_runner::TestRunner::new(ProptestConfig::with_cases(3_000));
        let found = runner.run(&leveled(), |given| {
            let (mut at, mut depth, mut coordinates, mut indices) = (Vec::new(), Vec::new(), Vec::new(), Vec::new());
            for (corners, texture) in &given {
                let first = at.len() as u32;
                indices.push([first, first + 1, first + 2]);
                for (&(x, y, z), texture) in corners.iter().zip(texture) {
                    at.push(ScreenPos::new(x, y));
                    depth.push(z);
                    coordinates.push(*texture);
                }
            }
            let shade = std::vec![[U8F8::default(); 2]; at.len()];
            let effects = EffectColumns { texture: &coordinates, ..EffectColumns::default() };
            let columns = Columns { at: &at, depth: &depth, shade: &shade, effects };
            let all_triangles = Triangles { columns, indices: &indices, by_corner: None };
            let clip = Rect { x0: 0, y0: 0, x1: 4_096, y1: 4_096 };
            let (texels, levels) = (std::vec![0; 65_536], std::vec![0; Levels::length(8, 8)]);
            let stage = TextureStage {
                texels: Texels::new(&texels, 8, 8).expect("an image"),
                levels: Some(Levels::new(&levels, 8, 8).expect("its levels")),
                mapping,
                tables: [&[0; 65_536]; 3],
            };
            let pipeline = PixelPipeline { texture: Some(stage), ..PixelPipeline::PLAIN };
            for kernel in Kernel::available() {
                let masks = cull(kernel.simd_level(), &at, &indices, clip, false);
                let mut list = PickList::<16>::new();
                pick(kernel.simd_level(), &mut list, 0, &masks, masks.covers);
                let picks = Picks { picks: list.as_slice(), flat: &[] };
                let picked = PickedTriangles { triangles: &all_triangles, picks };
                for recorded in record(kernel, picked, &pipeline) {
                    for (estimated, exact) in recorded.levels {
                        all.set(all.get() + 1);
                        decided.set(decided.get() + i32::from(estimated.is_some()));
                        prop_assert!(estimated.is_none_or(|level| level == exact), "{estimated:?}, not {exact:?}");
                        single.set(single.get() + i32::from(recorded.single_level.is_some()));
                        prop_assert!(recorded.single_level.is_none_or(|level| level == exact.level), "{exact:?}");
                    }
                }
            }
            Ok(())
        });
        found.expect("each level that is decided");
        let (decided, single, all) = (decided.get(), single.get(), all.get());
        assert!(all > 100_000 && decided > all / 2, "{mapping}: {decided} of {all}");
        // A face in perspective with one level is often found to have only one.
        assert!(mapping == Mapping::Affine || single > all / 10, "{single} of {all}");
    }

    /// Levels estimated for a face that is walked row by row match the definition, and most are decided.
    #[test]
    fn levels_of_a_walked_face_are_the_definition() {
        let (decided, all) = (core::cell::Cell::new(0), core::cell::Cell::new(0));
        let mut runner = proptest::test_runner::TestRunner::new(ProptestConfig::with_cases(4_000));
        let coordinate = || prop_oneof![3 => -(1 << 20)..=1 << 20, 1 => -20_000..100_000_i32];
        let depth = prop_oneof![8 => 17.0..30.0_f64, 1 => 0.0..32.0_f64].prop_map(|bits| bits.exp2() as u32);
        let corner = (coordinate(), coordinate(), depth);
        let coordinate = (0_u32..32, any::<i32>()).prop_map(|(bits, n)| n >> bits);
        // Some are slivers, whose weights change fast.
        let sliver = prop::option::of((0.0..1.0_f64, -40..40_i32));
        let texture = prop::array::uniform3([coordinate.clone(), coordinate]);
        let found = runner.run(&(prop::array::uniform3(corner), texture, sliver), |(mut corners, texture, sliver)| {
            if let Some((along, off)) = sliver {
                let [a, b, c] = &mut corners;
                let between = |a: i32, b: i32| a + (f64::from(b - a) * along) as i32;
                (c.0, c.1) = (between(a.0, b.0), (between(a.1, b.1) + off).clamp(-1 << 20, 1 << 20));
            }
            let at = corners.map(|(x, y, _)| ScreenPos::new(x, y));
            let (depth, shade) = (corners.map(|(.., depth)| depth), [[U8F8::default(); 2]; 3]);
            let effects = EffectColumns { texture: &texture, ..EffectColumns::default() };
            let columns = Columns { at: &at, depth: &depth, shade: &shade, effects };
            let triangles = Triangles { columns, indices: &[[0, 1, 2]], by_corner: None };
            let (texels, levels) = (std::vec![0; 65_536], std::vec![0; Levels::length(8, 8)]);
            let stage = TextureStage {
                texels: Texels::new(&texels, 8, 8).expect("an image"),
                levels: Some(Levels::new(&levels, 8, 8).expect("its levels")),
                mapping: Mapping::Perspective,
                tables: [&[0; 65_536]; 3],
            };
            let pipeline = PixelPipeline { texture: Some(stage), ..PixelPipeline::PLAIN };
            let last = stage.levels.expect("it has some").last();
            let (mut memory, mut buffers) = (listing::SpanData::new(), Buffers::default());
            let faces = PickedTriangles { triangles: &triangles, picks: Picks { picks: &[0], flat: &[] } };
            // No face without area is picked.
            prop_assume!(SortedTriangle::new(&faces.vertices(0)).area() != 0);
            let mut of_face = EffectSpans::new(faces, &pipeline, &mut memory, &mut buffers);
            let (mut rows, clip) = (Vec::new(), Rect { x0: 0, y0: 0, x1: 320, y1: 200 });
            of_face.walk(0, 0).rows(320, clip, |row| rows.push(row));
            let (mut pixels, mut list) = ([0; 320], SpanList::NONE);
            for row in rows.iter().step_by(7) {
                let mut target = Target { pixels: &mut pixels, cells: None, kernel: Kernel::PORTABLE };
                list.begin(&target, [0; 2]);
                of_face.add_row(row, &mut list, &mut target);
                let spans = Spans::all(&of_face.listed, &list);
                for (i, k) in
                    (0..spans.count()).flat_map(|i| (0..=spans.last(i).min(63)).step_by(9).map(move |k| (i, k)))
                {
                    let (estimated, exact) = (spans.level(i, k, last), exact_level(&spans, i, k, last));
                    all.set(all.get() + 1);
                    decided.set(decided.get() + i32::from(estimated.is_some()));
                    prop_assert!(estimated.is_none_or(|level| level == exact), "{estimated:?}, not {exact}");
                }
            }
            Ok(())
        });
        found.expect("each level that is decided");
        assert!(all.get() > 100_000 && decided.get() > all.get() / 2, "{} of {}", decided.get(), all.get());
    }

    /// Two far corners, whose edge goes through pixel centres, and a near one beside it: on the edge the planes' terms
    /// are up to 2³² times as large as the divisor. There u lies on the border of a texel, and v changes slowly.
    /// Quotients and levels that are decided are right.
    #[test]
    fn far_edges_are_decided_right() {
        let decided = core::cell::Cell::new([0; 3]);
        let mut runner = proptest::test_runner::TestRunner::new(ProptestConfig::with_cases(6_000));
        // To either side: the box's first pixel is at a far corner, or away from both.
        let edge = ((-7..8_i32, 1..8_i32), 1..16_i32, 0.0..1.0_f64, (0..13_u32, any::<i32>()));
        let depths = (prop_oneof![0.0..4.0_f64, 15.9..18.0_f64, 24.0..30.0_f64], 18.0..32.0_f64);
        let reach = || (8..27_u32, 0.8..1.25_f64).prop_map(|(bits, of)| (f64::from(1_u32 << bits) * of) as i32);
        let given = (edge, depths, (-300..300_i32, reach(), reach()));
        let found = runner.run(&given, |(((dx, dy), steps, along, (bits, beside)), depths, (texel, across, down))| {
            let (x, y) = (1_000 * 256 + 128, 900 * 256 + 128);
            let (dx, dy) = (256 * dx * steps, 256 * dy * steps);
            let beside = 1 + (beside & ((1 << bits) - 1));
            let at = |part: f64, more: i32| {
                ScreenPos::new(x + (f64::from(dx) * part) as i32 + more, y + (f64::from(dy) * part) as i32)
            };
            let at = [at(0.0, 0), at(1.0, 0), at(along, beside)];
            let depth = [depths.0, depths.0, depths.1].map(|bits| bits.exp2() as u32);
            let (u, v) = (texel << 16, (texel >> 3) << 16);
            let texture = [[u, v], [u, v + down], [u + across, v + (f64::from(down) * along) as i32]];
            let shade = [[U8F8::default(); 2]; 3];
            let effects = EffectColumns { texture: &texture, ..EffectColumns::default() };
            let columns = Columns { at: &at, depth: &depth, shade: &shade, effects };
            let all = Triangles { columns, indices: &[[0, 1, 2]], by_corner: None };
            let (texels, levels) = (std::vec![0; 65_536], std::vec![0; Levels::length(8, 8)]);
            let texels = Texels::new(&texels, 8, 8).expect("an image");
            let levels = Some(Levels::new(&levels, 8, 8).expect("its levels"));
            let stage = TextureStage { texels, levels, mapping: Mapping::Perspective, tables: [&[0; 65_536]; 3] };
            let pipeline = PixelPipeline { texture: Some(stage), ..PixelPipeline::PLAIN };
            let clip = Rect { x0: 0, y0: 0, x1: 4_096, y1: 4_096 };
            let vertices = [0, 1, 2].map(|k| {
                let (x, y) = (I24F8::from_bits(at[k].x()), I24F8::from_bits(at[k].y()));
                Vertex::new(x, y, U8F8::default(), depth[k]).expect("inside the guard band")
            });
            let (triangle, order) = SortedTriangle::with_order(&vertices);
            let texture = order.map(|corner| texture[corner]);
            let plane = PerspectiveTexture::new(&triangle, [0, 1].map(|i| texture.map(|corner| corner[i])));
            for kernel in Kernel::available() {
                let masks = cull(kernel.simd_level(), &at, &[[0, 1, 2]], clip, false);
                let mut list = PickList::<16>::new();
                pick(kernel.simd_level(), &mut list, 0, &masks, masks.covers);
                for found in record(
                    kernel,
                    PickedTriangles { triangles: &all, picks: Picks { picks: list.as_slice(), flat: &[] } },
                    &pipeline,
                ) {
                    let unsure = |_: usize, eight: &mut [i32; LANES]| *eight = [UNDECIDED; LANES];
                    let image = OffsetLanes::of_level(BASELINE, (texels, 0));
                    let end = found.span.len.min(LANES);
                    let mut offsets = [[UNDECIDED; LANES]; 2];
                    BASELINE.store_i32(
                        perspective_along(image, found.perspective, (0, end), unsure).next(),
                        &mut offsets[0],
                    );
                    if let Some(singles) = found.singles {
                        BASELINE.store_i32(singles_along(image, singles, 0, unsure).next(), &mut offsets[1]);
                    }
                    let mut count = decided.get();
                    for (count, offsets) in count.iter_mut().zip(offsets).filter(|(_, offsets)| offsets[0] != UNDECIDED)
                    {
                        for (k, offset) in offsets.into_iter().enumerate().take(end) {
                            let [u, v] = plane.at(found.span.x + k as i32, found.span.y).map(i32::cast_unsigned);
                            prop_assert_eq!(offset & 0xFFFF, texels.offset(u, v) as i32);
                            *count += 1;
                        }
                    }
                    for (level, exact) in found.levels {
                        prop_assert!(level.is_none_or(|level| level == exact), "{level:?}, not {exact:?}");
                        count[2] += i32::from(level.is_some());
                    }
                    decided.set(count);
                }
            }
            Ok(())
        });
        found.expect("right where decided");
        let [in_f64, in_f32, levels] = decided.get();
        assert!(in_f64 > 10_000 && in_f32 > 1_000 && levels > 10_000, "{in_f64}, {in_f32} and {levels}");
    }

    /// Where all corners share a coordinate, quotients decide every pixel, even if it lies on the border of a texel.
    /// (It took a textured torus without coordinates four times as long when they did not.)
    #[test]
    fn shared_coordinates_are_decided() {
        let mut runner = proptest::test_runner::TestRunner::new(ProptestConfig::with_cases(2_000));
        let (decided, in_f32) = (core::cell::Cell::new(0), core::cell::Cell::new(0));
        let corner = || (0..16_000_i32, 0..4_000_i32, 20_000_000..1_u32 << 30);
        // One point of the image, or one line across it; on the border of a texel, or not.
        let line = prop_oneof![2 => Just([0; 3]), 1 => prop::array::uniform3(0..400_000_i32)];
        let fraction = prop_oneof![3 => Just(0), 1 => 0..65_536_i32];
        let given = (prop::array::uniform3(corner()), line, (-300..300_i32, fraction), any::<bool>());
        let found = runner.run(&given, |(corners, line, (texel, fraction), is_u)| {
            let shared = (texel << 16) + fraction;
            let texture = line.map(|other| if is_u { [shared, other] } else { [other, shared] });
            let at = corners.map(|(x, y, _)| ScreenPos::new(x, y));
            let (depth, shade) = (corners.map(|(.., depth)| depth), [[U8F8::default(); 2]; 3]);
            let effects = EffectColumns { texture: &texture, ..EffectColumns::default() };
            let columns = Columns { at: &at, depth: &depth, shade: &shade, effects };
            let all = Triangles { columns, indices: &[[0, 1, 2]], by_corner: None };
            let texels: Vec<u8> = (0..=255).cycle().take(65_536).collect();
            let texels = Texels::new(&texels, 8, 8).expect("an image");
            let stage = TextureStage { texels, levels: None, mapping: Mapping::Perspective, tables: [&[0; 65_536]; 3] };
            let pipeline = PixelPipeline { texture: Some(stage), ..PixelPipeline::PLAIN };
            let clip = Rect { x0: 0, y0: 0, x1: 4_096, y1: 4_096 };
            for kernel in Kernel::available() {
                let masks = cull(kernel.simd_level(), &at, &[[0, 1, 2]], clip, false);
                let mut list = PickList::<16>::new();
                pick(kernel.simd_level(), &mut list, 0, &masks, masks.covers);
                for found in record(
                    kernel,
                    PickedTriangles { triangles: &all, picks: Picks { picks: list.as_slice(), flat: &[] } },
                    &pipeline,
                ) {
                    let (mut offsets, end) = ([0; LANES], found.span.len.min(LANES));
                    // Only the other coordinate may be undecided.
                    let unsure = |_: usize, eight: &mut [i32; LANES]| *eight = [UNDECIDED; LANES];
                    let image = (texels, 0);
                    let in_f64 =
                        perspective_along(OffsetLanes::of_level(BASELINE, image), found.perspective, (0, end), unsure)
                            .next();
                    BASELINE.store_i32(in_f64, &mut offsets);
                    let mut all_of_them = std::vec![offsets];
                    if let Some(singles) = found.singles {
                        BASELINE.store_i32(
                            singles_along(OffsetLanes::of_level(BASELINE, image), singles, 0, unsure).next(),
                            &mut offsets,
                        );
                        all_of_them.push(offsets);
                        in_f32.set(in_f32.get() + 1);
                    }
                    for offsets in all_of_them {
                        prop_assert!(line != [0; 3] || offsets[0] != UNDECIDED);
                        if offsets[0] == UNDECIDED {
                            continue;
                        }
                        decided.set(decided.get() + 1);
                        let shift = if is_u { 0 } else { 8 };
                        for offset in &offsets[..end] {
                            prop_assert_eq!(offset >> shift & 255, texel & 255);
                        }
                    }
                }
            }
            Ok(())
        });
        found.expect("decided, and the right texel");
        assert!(decided.get() > 50_000 && in_f32.get() > 20_000, "{} and {}", decided.get(), in_f32.get());
    }

    /// A face whose estimates are inconclusive at every pixel, since u is a whole number everywhere: stages that read
    /// the pixels' contents (shades lit before, or the frame behind glass) read them once.
    #[test]
    fn pixels_are_read_before_they_are_written() {
        use crate::raster::effects::{Attributes, EffectBatch};
        use crate::raster::{Frame, Raster};
        const SIDE: usize = 48;
        let at = |x: i32, y: i32, shade: u8| {
            Vertex::new(I24F8::from_bits(x), I24F8::from_bits(y), U8F8::from(shade), 4_000).expect("inside")
        };
        // Beyond the right and the lower edge, so that it covers the frame's last pixels.
        let vertices = [at(300, 400, 10), at(13_000, 700, 240), at(12_500, 13_000, 90)];
        // In column x, u is x.
        let u = |vertex: &Vertex| (vertex.x().to_bits() - 128) << 8;
        let texture = |i: usize, v: i32| Attributes { texture: [u(&vertices[i]), v << 16], ..Attributes::default() };
        let attributes = [texture(0, 0), texture(1, 90), texture(2, 40)];
        let texels: Vec<u8> = (0..=255).flat_map(|y: u8| (0..=255_u8).map(move |x| x.wrapping_mul(31) ^ y)).collect();
        let table: Vec<u8> = (0..65_536_u32).map(|i| (i.wrapping_mul(40_503) >> 8) as u8).collect();
        let table = table.first_chunk::<65_536>().expect("as many");
        let before: Vec<u8> = (0..SIDE * SIDE).map(|i| (i * 7) as u8).collect();
        let draw = |kernel: Kernel, pipeline: &PixelPipeline<'_>, there: &[u8]| {
            let mut bytes = there.to_vec();
            let frame = Frame::new(&mut bytes, SIDE as u32, SIDE as u32, SIDE).expect("a frame");
            let mut batch = EffectBatch::new();
            batch.push(&vertices, &attributes);
            Raster::new(frame).with_kernel(kernel).batch_with_effects(&mut batch, pipeline);
            bytes
        };
        for kernel in Kernel::available() {
            // Only the shade, and an image with it; each over a frame of 0 and one of 255, which shows what is covered.
            let sources = [Interpolation::Flat(77), Interpolation::Gouraud88, Interpolation::GouraudHyperbolic];
            let mappings = [Mapping::Affine, Mapping::Perspective];
            for (source, mapping) in sources.into_iter().flat_map(|source| mappings.map(|mapping| (source, mapping))) {
                let shaded = PixelPipeline { source: ShadeSource::Shaded(source), ..PixelPipeline::PLAIN };
                let stage = TextureStage {
                    texels: Texels::new(&texels, 8, 8).expect("as many texels"),
                    levels: None,
                    mapping,
                    tables: [table; 3],
                };
                let textured = PixelPipeline { texture: Some(stage), ..shaded };
                let glass = PixelPipeline { blend: Some(table), ..textured };
                let [black, white] = [0, 255].map(|index| draw(kernel, &textured, &[index; SIDE * SIDE]));
                let [shades, blended] = [&shaded, &glass].map(|pipeline| draw(kernel, pipeline, &before));
                let mut covered = 0;
                for i in 0..SIDE * SIDE {
                    let own = black[i];
                    if own != white[i] {
                        assert_eq!(blended[i], before[i]);
                        continue;
                    }
                    covered += 1;
                    let (row, u) = (usize::from(shades[i]) << 8, (i % SIDE) as u8);
                    assert!((0..=255_u8).any(|y| table[row | usize::from((u.wrapping_mul(31)) ^ y)] == own));
                    assert_eq!(
                        blended[i],
                        table[usize::from(own) << 8 | usize::from(before[i])],
                        "{kernel} {source:?} {mapping} {i}"
                    );
                }
                assert!(covered > 800 && black[SIDE * SIDE - 1] == white[SIDE * SIDE - 1], "{covered}");
            }
        }
    }

    fn affine_is_right(
        triangle: &SortedTriangle,
        texture: &[[i32; 2]; 3],
        step: [u32; 2],
        is_row: bool,
        start: [u32; 2],
        pixel: (i32, i32),
    ) -> Result<(), TestCaseError> {
        for i in 0..2 {
            let values = texture.map(|corner| corner[i]);
            prop_assert_eq!(start[i], defined(triangle, values, 0, pixel));
            if is_row {
                let (gx, _) = triangle.gradient(values.map(i64::from));
                prop_assert_eq!(step[i], (256 * i128::from(gx) / i128::from(triangle.area())) as u32);
            }
        }
        Ok(())
    }

    fn sums_are_right(
        triangle: &SortedTriangle,
        texture: &[[i32; 2]; 3],
        &PerspectiveSums { numerators: [u, v], divisors, base, .. }: &PerspectiveSums<f64>,
        (x, y): (i32, i32),
    ) -> Result<(), TestCaseError> {
        prop_assert!(base.iter().all(|base| base % 65_536 == 0));
        if divisors == [-1.0, 0.0] {
            // A triangle whose quotients decide nothing.
            return Ok(());
        }
        let depths = [depth(triangle, 0), depth(triangle, 1), depth(triangle, 2)];
        let (weights, corners) = (Weights::new(triangle), &triangle.vertices);
        let side = |of: fn(&Vertex) -> i32| {
            let [a, b, c] = [0, 1, 2].map(|k| i128::from(of(&corners[k])));
            a.max(b).max(c) - a.min(b).min(c)
        };
        let sides = [side(|vertex| vertex.x().to_bits()), side(|vertex| vertex.y().to_bits())];
        for i in 0..3 {
            let shared = |i: usize| texture.iter().all(|corner| corner[i] == texture[0][i]);
            let value = |k: usize, base: i32| {
                let coordinate = if shared(i) { base + 0x8000 } else { texture[k][i] };
                i128::from(i64::from(coordinate) - i64::from(base)) * i128::from(depths[k])
            };
            let values = [0, 1, 2].map(|k| base.get(i).map_or(depths[k].into(), |&base| value(k, base)));
            let most = values.iter().fold(0, |most, value| value.abs().max(most));
            let [start, step] = [u, v, divisors][i];
            // A step is 256 units wide.
            for (weights, sum, parts, side) in
                [(weights.at(x, y), start, 101, sides[0]), (weights.per_column, step, 14, 256)]
            {
                let off = sum as i128 - [0, 1, 2].map(|k| i128::from(weights[k]) * values[k]).iter().sum::<i128>();
                // Parts in 2⁵³, and less than one for the fraction that `as` drops.
                let bound = parts * most * side * sides[1];
                prop_assert!((off.abs() - 1) << 53 <= bound, "{} off of {}", off, bound);
            }
        }
        Ok(())
    }
}
