//! The rows of triangles as a list in arrays, eight rows at a time, and the list to pixels.
//!
//! `rows::list` goes row by row, this by eight rows of a triangle at once. Empty lanes are removed by compression, so
//! the only branch on the number of rows is the loop over groups of eight. The loop over the list draws sixteen pixels
//! a turn and reads nothing but the list.

mod draw;
mod few;

use core::arch::asm;
use core::mem::{MaybeUninit, offset_of};

use self::few::Order;
use super::super::depths::Planes;
use super::super::rows::{Edges, Group, LANES, MAGIC, MAX_ACROSS, Place};
use crate::raster::frame::Rect;
use crate::raster::shade::RESEED;

/// Spans at most.
const CAPACITY: usize = 128;
const SIXTEEN: usize = 2 * LANES;
/// Most rows of a group for which the rows enter the list together.
pub(in super::super) const FEW_ROWS: i32 = 4;

/// Input and output of the assembly.
#[repr(C, align(64))]
pub(in super::super) struct Spans {
    // One entry for each span. Up to sixteen are written at a time; those that are no spans are written over.
    at: MaybeUninit<[u32; CAPACITY + SIXTEEN]>,
    cell: MaybeUninit<[u32; CAPACITY + SIXTEEN]>,
    length: MaybeUninit<[u32; CAPACITY + SIXTEEN]>,
    /// Shade, and above it the step.
    paint: MaybeUninit<[u32; CAPACITY + SIXTEEN]>,
    /// Depths, the integer parts in the upper halves.
    z: MaybeUninit<[i64; CAPACITY + SIXTEEN]>,
    dz: MaybeUninit<[i64; CAPACITY + SIXTEEN]>,
    /// The first pixels of the rows of eight triangles, up to four rows each.
    /// Below: pixels, paint, and the column of the box.
    row_at: MaybeUninit<[u32; LANES * FEW_ROWS as usize]>,
    row_length: MaybeUninit<[u32; LANES * FEW_ROWS as usize]>,
    row_paint: MaybeUninit<[u32; LANES * FEW_ROWS as usize]>,
    row_column: MaybeUninit<[u32; LANES * FEW_ROWS as usize]>,
    /// The cells of eight boxes' first pixels.
    first_cell: [u32; SIXTEEN],
    /// Pixels of all spans there have been, in sixteen parts.
    covered: [u32; SIXTEEN],
    count: usize,
    /// Spans that have been drawn.
    drawn: u32,
    /// Pixels that were nearer.
    nearer: u32,
    /// Number of pixels and cells.
    pixels: u32,
    cells: u32,
    pitch: u32,
    width: u32,
    /// Pixels to the left of those in the list, in each row, ...
    skipped: f64,
    /// ... and the most that a span has.
    longest: f64,
    /// The frame's left side, from the box's first pixel on, as a sum with `MAGIC`: there starts what begins left of it.
    origin: f64,
    /// The clip rectangle's left and right sides, from the box's first pixel on, as sums with `MAGIC`, ...
    left: f64,
    right: f64,
    /// ... and top and bottom, from the box's first row on.
    top: i32,
    bottom: i32,
    /// Not 0 if it counts.
    clips: u32,
    first_row: u32,
}

#[repr(C, align(64))]
struct Constants {
    /// 0: the number of each even pixel of 64.
    even: [u16; 32],
    /// 64: numbers.
    numbers: [u64; LANES],
    /// 128: the numbers of the upper halves of sixteen lanes of two vectors.
    upper: [u32; 16],
    /// 192
    rows: [u32; LANES],
    /// 224
    magic: f64,
    /// 232: the odd bytes of two lanes.
    odd_bytes: u32,
    /// 236: a shade's bits.
    shade: u32,
    unused: [u32; 4],
    /// 256: 1, and above it the pixel's number.
    numbered: [u32; LANES],
}

static CONSTANTS: Constants = Constants {
    even: {
        let mut even = [0; 32];
        let mut j = 0;
        while j < 32 {
            even[j as usize] = 2 * j;
            j += 1;
        }
        even
    },
    numbers: [0, 1, 2, 3, 4, 5, 6, 7],
    upper: [1, 3, 5, 7, 9, 11, 13, 15, 17, 19, 21, 23, 25, 27, 29, 31],
    rows: [0, 1, 2, 3, 4, 5, 6, 7],
    magic: MAGIC,
    odd_bytes: 0xFF00_FF00,
    shade: 0xFFFF,
    unused: [0; 4],
    numbered: [1, 0x1_0001, 0x2_0001, 0x3_0001, 0x4_0001, 0x5_0001, 0x6_0001, 0x7_0001],
};

static OF_TWO: [Order; 1] = [Order::of(2, 0)];
static OF_FOUR: [Order; 2] = [Order::of(4, 0), Order::of(4, 4)];

impl Spans {
    #[inline(always)]
    pub(in super::super) fn new(place: Place) -> Self {
        Self {
            at: MaybeUninit::uninit(),
            cell: MaybeUninit::uninit(),
            length: MaybeUninit::uninit(),
            paint: MaybeUninit::uninit(),
            z: MaybeUninit::uninit(),
            dz: MaybeUninit::uninit(),
            row_at: MaybeUninit::uninit(),
            row_length: MaybeUninit::uninit(),
            row_paint: MaybeUninit::uninit(),
            row_column: MaybeUninit::uninit(),
            first_cell: [0; SIXTEEN],
            covered: [0; SIXTEEN],
            count: 0,
            drawn: 0,
            nearer: 0,
            pixels: 0,
            cells: 0,
            pitch: place.pitch,
            width: place.depth_width.unwrap_or(0),
            skipped: 0.0,
            longest: 0.0,
            origin: 0.0,
            left: 0.0,
            right: 0.0,
            top: 0,
            bottom: 0,
            clips: 0,
            first_row: place.first_row,
        }
    }

    /// Spans, pixels that they cover, and those that were nearer, of all that was drawn.
    pub(in super::super) fn counts(&self) -> (u32, u32, u32) {
        (self.drawn, self.covered.iter().sum(), self.nearer)
    }

    /// Lists all rows of triangle `i` of a group, and draws whenever there is no room left. Where a row may have more than
    /// one of the pieces that start anew, a span is one of these. Parts outside `clip`, if there is one, are left out.
    /// `pixels` and `cells` are always the same. Without `planes` there is no depth test.
    ///
    /// # Safety
    /// Only for a processor for which `span::simd::avx512::found` is true.
    #[inline(always)]
    pub(in super::super) unsafe fn add(
        &mut self,
        group: &Group,
        i: usize,
        (pieces, clip): (usize, Option<Rect>),
        planes: Option<&Planes>,
        (pixels, cells): (&mut [u8], &mut [u32]),
    ) {
        self.of(pixels, cells);
        // A column and a row are below 4,096.
        let cell = (group.row[i] - self.first_row as i32) * self.width as i32 + group.column[i];
        self.longest = if pieces > 1 { RESEED.into() } else { f64::from(MAX_ACROSS / 256) };
        let (mut first, mut end) = (0, group.rows[i]);
        self.origin = MAGIC - f64::from(group.column[i]);
        self.clips = clip.is_some().into();
        if let Some(clip) = clip {
            // All inside a frame, at most 4,096.
            let from_box = |side: u32, of_box: i32| side as i32 - of_box;
            self.left = MAGIC + f64::from(from_box(clip.x0, group.column[i]));
            self.right = MAGIC + f64::from(from_box(clip.x1, group.column[i]));
            (self.top, self.bottom) = (from_box(clip.y0, group.row[i]), from_box(clip.y1, group.row[i]));
            (first, end) = (self.top.max(0), end.min(self.bottom));
        }
        while first < end {
            for piece in 0..pieces {
                if self.count + LANES > CAPACITY {
                    // SAFETY: by the caller's promise.
                    unsafe { self.draw(planes.is_some(), pixels, cells) };
                }
                // At most 16 pieces.
                self.skipped = f64::from(piece as u32 * RESEED as u32);
                // SAFETY: by the caller's promise; there is room for eight.
                unsafe { self.list(group, i, first, cell, planes) };
            }
            first += LANES as i32;
        }
    }

    fn of(&mut self, pixels: &[u8], cells: &[u32]) {
        // Offsets beyond are never those of a frame.
        let most = |length: usize| length.min(1 << 31) as u32;
        (self.pixels, self.cells) = (most(pixels.len()), most(cells.len()));
    }

    /// Lists all small triangles of a group of short ones, eight at a time, like [`add`](Self::add).
    /// There are `triangles` of them, of at most [`FEW_ROWS`] rows. They are put into their order afterwards.
    ///
    /// # Safety
    /// See `add`.
    #[inline(always)]
    pub(in super::super) unsafe fn add_all(
        &mut self,
        group: &Group,
        triangles: usize,
        most_rows: i32,
        planes: Option<&Planes>,
        (pixels, cells): (&mut [u8], &mut [u32]),
    ) {
        self.of(pixels, cells);
        let (rows, orders) = if most_rows <= 2 { (2, &OF_TWO[..]) } else { (4, &OF_FOUR[..]) };
        if self.count + SIXTEEN * orders.len() > CAPACITY {
            // SAFETY: by the caller's promise.
            unsafe { self.draw(planes.is_some(), pixels, cells) };
        }
        self.put_first_cells(group);
        for row in 0..rows {
            // SAFETY: by the caller's promise; there is room for four rows.
            unsafe { self.row(group, triangles, row) };
        }
        for order in orders {
            // SAFETY: by the caller's promise; the rows are there that it names, and there is room for sixteen.
            unsafe { self.list_sixteen(order, planes) };
        }
    }

    /// Lists all small triangles of a group, one after the other, like [`add`](Self::add).
    /// There are `triangles` of them.
    ///
    /// # Safety
    /// See `add`.
    #[inline(always)]
    pub(in super::super) unsafe fn add_each(
        &mut self,
        group: &Group,
        triangles: usize,
        most_rows: i32,
        planes: &Planes,
        (pixels, cells): (&mut [u8], &mut [u32]),
    ) {
        self.of(pixels, cells);
        if self.count + LANES * LANES > CAPACITY {
            // SAFETY: by the caller's promise.
            unsafe { self.draw(true, pixels, cells) };
        }
        self.put_first_cells(group);
        let triangles = triangles.min(LANES);
        if most_rows <= LANES as i32 {
            // SAFETY: by the caller's promise; there is room for eight times eight.
            return unsafe { self.list_each(group, (0, triangles), 0, planes) };
        }
        for i in 0..triangles {
            for first in (0..group.rows[i]).step_by(LANES) {
                if self.count + LANES > CAPACITY {
                    // SAFETY: by the caller's promise.
                    unsafe { self.draw(true, pixels, cells) };
                }
                // SAFETY: by the caller's promise; there is room for eight.
                unsafe { self.list_each(group, (i, i + 1), first, planes) };
            }
        }
    }

    /// The cells of the boxes' first pixels. A lane without a triangle may get any value.
    #[inline(always)]
    fn put_first_cells(&mut self, group: &Group) {
        for i in 0..LANES {
            // As in `add`.
            let row = group.row[i].wrapping_sub(self.first_row as i32);
            self.first_cell[i] = row.wrapping_mul(self.width as i32).wrapping_add(group.column[i]) as u32;
        }
    }

    /// Lists up to eight rows from number `first` on, of each up to `longest` pixels after the first `skipped`.
    ///
    /// # Safety
    /// Only for a processor for which `span::simd::avx512::found` is true; `i` is below 8, and there is room for eight.
    #[inline(always)]
    unsafe fn list(&mut self, group: &Group, i: usize, first: i32, cell: i32, planes: Option<&Planes>) {
        // Null for a pointer that is not read.
        let planes = planes.map_or(core::ptr::null(), |planes| (&raw const *planes).cast::<u8>());
        // SAFETY: the caller has AVX-512 F, DQ and VL and POPCNT found. Read are `group`, `planes` and `CONSTANTS` at the
        // offsets of their fields, of those that hold eight numbers number `i`, which is below 8. Written are eight numbers
        // from number `count` on, and so below `CAPACITY + LANES`. Without `planes` nothing is read of them. The stack is not
        // used; flags and all registers written are given up.
        unsafe {
            asm!(
                "vpbroadcastd ymm26, {first:e}",
                "vpaddd     ymm26, ymm26, [{c} + 192]",                     // rows
                "vbroadcastsd zmm31, qword ptr [{c} + 224]",                // magic
                "vcvtdq2pd  zmm16, ymm26",                                  // j
                "vbroadcastsd zmm17, qword ptr [{g8} + {LONG} + {PER_ROW}]",
                "vbroadcastsd zmm18, qword ptr [{g8} + {UPPER} + {PER_ROW}]",
                "vbroadcastsd zmm19, qword ptr [{g8} + {LOWER} + {PER_ROW}]",
                "vbroadcastsd zmm20, qword ptr [{g8} + {SHADE_PER_ROW}]",
                "vpcmpd     k1, ymm26, dword ptr [{g4} + {SPLIT}]{{1to8}}, 5", // not less
                "vfmadd213pd zmm17, zmm16, qword ptr [{g8} + {LONG} + {N}]{{1to8}}",
                "vfmadd213pd zmm18, zmm16, qword ptr [{g8} + {UPPER} + {N}]{{1to8}}",
                "vfmadd213pd zmm19, zmm16, qword ptr [{g8} + {LOWER} + {N}]{{1to8}}",
                "vfmadd213pd zmm20, zmm16, qword ptr [{g8} + {SHADE_N}]{{1to8}}",
                "vpcmpd     k2, ymm26, dword ptr [{g4} + {ROWS}]{{1to8}}, 1", // less
                "vfmadd132pd zmm17, zmm31, qword ptr [{g8} + {LONG} + {INVERSE}]{{1to8}}",
                "vfmadd132pd zmm18, zmm31, qword ptr [{g8} + {UPPER} + {INVERSE}]{{1to8}}",
                "vfmadd132pd zmm19, zmm31, qword ptr [{g8} + {LOWER} + {INVERSE}]{{1to8}}",
                "vpmulld    ymm22, ymm26, dword ptr [{l} + {PITCH}]{{1to8}}",
                "vmovapd    zmm18{{k1}}, zmm19",                            // short
                "vminpd     zmm19, zmm17, zmm18",                           // left
                "vmaxpd     zmm17, zmm17, zmm18",                           // right
                "vmaxpd     zmm19, zmm19, qword ptr [{l} + {ORIGIN}]{{1to8}}",
                "vaddpd     zmm19, zmm19, qword ptr [{l} + {SKIPPED}]{{1to8}}",
                "vpaddd     ymm22, ymm22, dword ptr [{g4} + {AT}]{{1to8}}",
                "vaddpd     zmm21, zmm19, qword ptr [{l} + {LONGEST}]{{1to8}}",
                "vsubpd     zmm18, zmm19, zmm31",                           // column
                "vminpd     zmm17, zmm17, zmm21",
                "vfmadd132pd zmm18, zmm20, qword ptr [{g8} + {PER_COLUMN}]{{1to8}}",
                "vfmadd132pd zmm18, zmm31, qword ptr [{g8} + {SHADE_INVERSE}]{{1to8}}",
                "vpmovqw    xmm18, zmm18",
                "vpmovzxwd  ymm18, xmm18",
                "vpord      ymm18, ymm18, dword ptr [{g4} + {STEP}]{{1to8}}",
                "cmp        dword ptr [{l} + {CLIPS}], 0",
                "je         3f",
                // A row that begins left of the rectangle goes on from its start.
                "vmaxpd     zmm21, zmm19, qword ptr [{l} + {LEFT}]{{1to8}}",
                "vminpd     zmm17, zmm17, qword ptr [{l} + {RIGHT}]{{1to8}}",
                "vpsubq     zmm19, zmm21, zmm19",
                "vpmovqd    ymm19, zmm19",
                "vpsrld     ymm23, ymm18, 16",
                "vpmullw    ymm19, ymm19, ymm23",
                "vpaddw     ymm18, ymm18, ymm19",
                "vmovapd    zmm19, zmm21",
                "vpcmpd     k2{{k2}}, ymm26, dword ptr [{l} + {TOP}]{{1to8}}, 5", // not less
                "vpcmpd     k2{{k2}}, ymm26, dword ptr [{l} + {BOTTOM}]{{1to8}}, 1", // less
                "3:",
                "vpsubq     zmm17, zmm17, zmm19",
                "vpsubq     zmm21, zmm19, zmm31",                           // the column as a whole number
                "vpmovqd    ymm17, zmm17",                                  // length
                "vpmovqd    ymm19, zmm21",
                "vpxord     ymm23, ymm23, ymm23",
                "vpaddd     ymm22, ymm22, ymm19",                           // at
                "vpcmpd     k2{{k2}}, ymm17, ymm23, 6",                     // greater
                "vpbroadcastd ymm23, dword ptr [{l} + {PIXELS}]",
                "vpcmpud    k2{{k2}}, ymm17, ymm23, 2",                     // not greater
                "vpsubd     ymm23, ymm23, ymm17",
                "vpcmpud    k2{{k2}}, ymm22, ymm23, 2",
                "test       {p8}, {p8}",
                "jz         2f",
                // Depths.
                "vpmulld    ymm24, ymm26, dword ptr [{l} + {WIDTH}]{{1to8}}",
                "vpbroadcastd ymm25, {cell:e}",
                "vpaddd     ymm19, ymm19, ymm25",
                "vpaddd     ymm24, ymm24, ymm19",                           // cell
                "vpbroadcastd ymm23, dword ptr [{l} + {CELLS}]",
                "vpcmpud    k2{{k2}}, ymm17, ymm23, 2",
                "vpsubd     ymm23, ymm23, ymm17",
                "vpcmpud    k2{{k2}}, ymm24, ymm23, 2",
                "vpmovsxdq  zmm26, ymm26",
                "vpbroadcastq zmm25, qword ptr [{p8} + {DEPTH_PER_COLUMN}]",
                "vpmullq    zmm26, zmm26, qword ptr [{p8} + {DEPTH_PER_ROW}]{{1to8}}",
                "vpmullq    zmm21, zmm21, zmm25",
                "vpaddq     zmm26, zmm26, qword ptr [{p8} + {DEPTH}]{{1to8}}",
                "vpaddq     zmm21, zmm21, zmm26",
                "vpsllq     zmm25, zmm25, 8",
                "vpsllq     zmm21, zmm21, 8",
                "vpcompressd ymm24{{k2}}{{z}}, ymm24",
                "vpcompressq zmm21{{k2}}{{z}}, zmm21",
                "vmovdqu32  [{l} + 4*{count} + {CELL}], ymm24",
                "vmovdqu64  [{l} + 8*{count} + {Z}], zmm21",
                "vmovdqu64  [{l} + 8*{count} + {DZ}], zmm25",
                "2:",
                "vpcompressd ymm22{{k2}}{{z}}, ymm22",
                "vpcompressd ymm17{{k2}}{{z}}, ymm17",
                "vpcompressd ymm18{{k2}}{{z}}, ymm18",
                "vmovdqu32  [{l} + 4*{count} + {LIST_AT}], ymm22",
                "vmovdqu32  [{l} + 4*{count} + {LENGTH}], ymm17",
                "vmovdqu32  [{l} + 4*{count} + {PAINT}], ymm18",
                "vpaddd     ymm17, ymm17, [{l} + {COVERED}]",
                "vmovdqu32  [{l} + {COVERED}], ymm17",
                "kmovb      {cell:e}, k2",
                "popcnt     {cell:e}, {cell:e}",
                "add        {count}, {cell}",
                g8 = in(reg) (&raw const *group).cast::<u8>().wrapping_add(8 * i),
                g4 = in(reg) (&raw const *group).cast::<u8>().wrapping_add(4 * i),
                p8 = in(reg) if planes.is_null() { planes } else { planes.wrapping_add(8 * i) },
                l = in(reg) &raw mut *self,
                c = in(reg) &raw const CONSTANTS,
                first = in(reg) first,
                cell = inout(reg) i64::from(cell) => _,
                count = inout(reg) self.count,
                LONG = const offset_of!(Group, long),
                UPPER = const offset_of!(Group, upper),
                LOWER = const offset_of!(Group, lower),
                N = const offset_of!(Edges, n),
                PER_ROW = const offset_of!(Edges, per_row),
                INVERSE = const offset_of!(Edges, inverse),
                SHADE_N = const offset_of!(Group, n),
                SHADE_PER_ROW = const offset_of!(Group, per_row),
                SHADE_INVERSE = const offset_of!(Group, inverse),
                PER_COLUMN = const offset_of!(Group, per_column),
                SPLIT = const offset_of!(Group, split),
                ROWS = const offset_of!(Group, rows),
                AT = const offset_of!(Group, at),
                STEP = const offset_of!(Group, step),
                DEPTH = const offset_of!(Planes, at),
                DEPTH_PER_COLUMN = const offset_of!(Planes, per_column),
                DEPTH_PER_ROW = const offset_of!(Planes, per_row),
                LIST_AT = const offset_of!(Self, at),
                CELL = const offset_of!(Self, cell),
                LENGTH = const offset_of!(Self, length),
                PAINT = const offset_of!(Self, paint),
                Z = const offset_of!(Self, z),
                DZ = const offset_of!(Self, dz),
                COVERED = const offset_of!(Self, covered),
                PIXELS = const offset_of!(Self, pixels),
                CELLS = const offset_of!(Self, cells),
                PITCH = const offset_of!(Self, pitch),
                WIDTH = const offset_of!(Self, width),
                SKIPPED = const offset_of!(Self, skipped),
                LONGEST = const offset_of!(Self, longest),
                ORIGIN = const offset_of!(Self, origin),
                LEFT = const offset_of!(Self, left),
                RIGHT = const offset_of!(Self, right),
                TOP = const offset_of!(Self, top),
                BOTTOM = const offset_of!(Self, bottom),
                CLIPS = const offset_of!(Self, clips),
                out("zmm16") _, out("zmm17") _, out("zmm18") _, out("zmm19") _, out("zmm20") _, out("zmm21") _,
                out("zmm22") _, out("zmm23") _, out("zmm24") _, out("zmm25") _, out("zmm26") _, out("zmm31") _,
                out("k1") _, out("k2") _,
                options(nostack),
            );
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::super::rows::{Gathered, MAX_PIECES};
    use super::super::set_up;
    use super::*;
    use crate::span::Kernel;

    /// Spans that do not lie wholly inside the pixels, and the cells, are left out, whatever the triangles.
    #[test]
    fn nothing_outside_the_pixels_and_cells_is_written() {
        if Kernel::by_name("simd-avx512").is_err() {
            return;
        }
        let mut state = 1_u64;
        let mut random = |most: u64| {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (state >> 33) % (most + 1)
        };
        let (mut written, mut left_out) = (0, 0);
        for round in 0..20_000 {
            let few = round % 2 == 0;
            let (width, height) = if few { (16_384, 900) } else { (65_536, 40_000) };
            let mut corners = |most| [0; 3].map(|_| [0; LANES].map(|_: i32| random(most) as i32));
            let (x, y, shade) = (corners(width), corners(height), corners(0xFF00));
            let depth = [0; 3].map(|_| [0; LANES].map(|_: i32| random(1 << 30) as u32));
            let gathered = Gathered { x, y, shade, depth };
            let (first_row, pitch, cells_across) = (random(20) as u32, random(300) as u32, random(300) as u32);
            let place = Place { first_row, pitch, depth_width: Some(cells_across) };
            let (before, length) = (random(300) as usize, random(20_000) as usize);
            let mut bytes = vec![7_u8; before + length + 300];
            let mut cells = vec![1_u32; before + length + 300];
            let (mut group, mut planes, mut spans) = (Group::NONE, Planes::NONE, Spans::new(place));
            let end = before + length;
            let with_depths = random(2) > 0;
            let each = few && round % 4 > 0;
            let clip = (random(1) == 0).then_some(Rect { x0: random(99) as u32, y0: 0, x1: 200, y1: 90 });
            let pieces = random(MAX_PIECES as u64) as usize;
            // SAFETY: the kernel above is there.
            unsafe {
                set_up(&gathered, place, &mut group);
                planes.renew(&gathered, &group);
                let planes = with_depths.then_some(&planes);
                let to = (&mut bytes[before..end], &mut cells[before..end]);
                if few && !each {
                    spans.add_all(&group, LANES, FEW_ROWS, planes, to);
                } else if each {
                    spans.add_each(&group, LANES, 16 - 8 * (round % 2), planes.unwrap_or(&Planes::NONE), to);
                } else {
                    spans.add(&group, 3, (pieces, clip), planes, to);
                }
                spans.draw(with_depths || each, &mut bytes[before..end], &mut cells[before..end]);
            }
            assert!(bytes[..before].iter().chain(&bytes[end..]).all(|&byte| byte == 7));
            assert!(cells[..before].iter().chain(&cells[end..]).all(|&cell| cell == 1));
            let inside = bytes.iter().filter(|&&byte| byte != 7).count();
            written += inside;
            left_out += usize::from(inside == 0);
        }
        assert!(written > 1_000_000 && left_out > 100, "{written}, {left_out}");
    }
}
