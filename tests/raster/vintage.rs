//! Triangles as the sources print them: against a naive walk over edges and rows, without panics on any valid input.

use crate::support::triangles::{contains, draw, rect, triangle, vertex};
use crate::support::tried::Tried;
use mode13h::fixed::U8F8;
use mode13h::internals::span::depth::Cell;
use mode13h::raster::{DepthBuffer, DrawStats, Frame, Interpolation, Raster, Rect, Vertex};
use mode13h::span::Kernel;
use mode13h_conformance::Random;
use mode13h_conformance::oracle;

const VINTAGE: Interpolation = Interpolation::GouraudVintage;

/// One row at a time, by hand.
#[test]
fn rows_are_those_of_the_sources() {
    let mut tried = Tried::new("rows_are_those_of_the_sources", 2);
    // In whole pixels, from fractions that are rounded away.
    let corner = |x: i64, y: i64, shade: i64| vertex(x * 256 - 60, y * 256 + 90, shade * 256, 5);
    let bytes = draw(&[corner(0, 0, 16), corner(7, 0, 85), corner(0, 2, 16)], VINTAGE, 7, 2, None, 9);
    // (85 − 16) / 7 in 1/256: 2,523.4, cut to 2,523.
    assert_eq!(bytes[..7], [16, 25, 35, 45, 55, 65, 75]);
    tried.add(1);
    // The right edge goes left by 3½, its shade from 85 to 16 in two rows: 50½ at 3½, cut to 3. (50½ − 16) / 3 is 11½.
    assert_eq!(bytes[7..], [16, 27, 39, 9, 9, 9, 9]);
    tried.add(1);
}

/// The Russian textbook's slips 2 and 3: the count Dx − Cx + 1 and the gradient (Bs − As) / (Bx − Ax) of a row without
/// a pixel.
#[test]
fn rows_without_a_pixel_are_not_drawn() {
    let mut tried = Tried::new("rows_without_a_pixel_are_not_drawn", 4_000);
    let mut random = Random::named("period, no pixel");
    while tried.more() {
        // Left and right are on the same whole pixel, or top and bottom are.
        let (x, y) = (random.within(-40, 200) * 256, random.within(-20, 40) * 256);
        let upright = random.within(0, 1) == 0;
        let mut corner = || {
            let (narrow, long) = (random.within(-128, 127), random.within(-20_000, 20_000));
            let (dx, dy) = if upright { (narrow, long) } else { (long, narrow) };
            vertex(x + dx, y + dy, random.within(0, 0xFF00), 1)
        };
        let corners = [corner(), corner(), corner()];
        let mut bytes = vec![3; 96 * 24];
        let drawn = Raster::new(Frame::new(&mut bytes, 96, 24, 96).expect("legal")).triangle(&corners, VINTAGE);
        assert_eq!(drawn, DrawStats::default(), "{corners:?}");
        assert!(bytes.iter().all(|byte| *byte == 3), "{corners:?}");
    }
}

/// Corners anywhere in the guard band and on its edge, slivers, all shades and depths; any clip rectangle, bands, with
/// and without a depth buffer: no panic, and the result of the naive walk.
#[test]
fn r7_period_is_quiet() {
    let mut tried = Tried::new("r7_period_is_quiet", 3_000);
    let mut random = Random::named("r7 period");
    let kernels: Vec<Kernel> = Kernel::available().collect();
    let mut covered = 0;
    while tried.more() {
        let (width, height) = random.one_of(&[(96, 24), (320, 7), (17, 60), (1, 9), (70, 1)]);
        let corners = any_corners(&mut random, width, height);
        let part = rect(&mut random, width, height);
        let clip = random.one_of(&[part, Rect { x0: 0, y0: 0, x1: width, y1: height }]);
        let case = Case {
            corners,
            size: (width, height),
            clip,
            rows_each: random.within(1, height.into()) as u32,
            kernel: random.one_of(&kernels),
        };
        covered += case.without_depth();
        let held: Vec<u32> = (0..width * height).map(|_| random.log_uniform(32) as u32).collect();
        case.with_depth(held.clone());
        case.with_depth(held.into_iter().map(u16::of_depth).collect());
    }
    assert!(covered > 20 * tried.stated(), "{covered} pixels");
}

fn any_corners(random: &mut Random, width: u32, height: u32) -> [Vertex; 3] {
    const BAND: i64 = Vertex::GUARD_BAND as i64;
    if random.within(0, 2) > 0 {
        return triangle(random, width.into(), height.into());
    }
    [(); 3].map(|()| {
        let mut coordinate = || match random.within(0, 5) {
            0 => -BAND,
            1 => BAND,
            2 => random.within(-BAND, BAND),
            3 => random.within(-2, 2) * 128 + random.within(-1, 1),
            _ => random.within(-BAND, BAND) / 256 * 256 / random.one_of(&[1, 16, 64]),
        };
        let (x, y) = (coordinate(), coordinate());
        let shade = random.one_of(&[0, 1, 0xFF, 0x100, 0xFEFF, 0xFF00]);
        vertex(x, y, shade, random.one_of(&[0, 1, 1 << 30, u32::MAX.into()]))
    })
}

/// A triangle in a frame surrounded by bytes that must not change.
struct Case {
    corners: [Vertex; 3],
    size: (u32, u32),
    clip: Rect,
    rows_each: u32,
    kernel: Kernel,
}

const GUARD: u8 = 0xA5;
const EMPTY: u8 = 3;
const MARGIN: usize = 9;

impl Case {
    /// Draws it with `paint`, band by band, and returns the frame without its margins.
    fn draw(&self, mut paint: impl FnMut(Raster<'_>, u32)) -> Vec<u8> {
        let (width, height) = self.size;
        let pitch = width as usize + MARGIN;
        let mut bytes = vec![GUARD; MARGIN + pitch * height as usize];
        let mut frame = Frame::new(&mut bytes[MARGIN..], width, height, pitch).expect("legal");
        frame.clear(EMPTY);
        for band in frame.bands(self.rows_each) {
            let first = band.rows().start;
            paint(Raster::new(band).with_clip(self.clip).with_kernel(self.kernel), first);
        }
        assert!(bytes[..MARGIN].iter().all(|byte| *byte == GUARD), "{:?}", self.corners);
        let rows = bytes[MARGIN..].chunks(pitch).map(|row| row.split_at(width as usize));
        rows.flat_map(|(row, beside)| {
            assert!(beside.iter().all(|byte| *byte == GUARD), "{:?}", self.corners);
            row.to_vec()
        })
        .collect()
    }

    /// The naive walk's pixels inside the clip rectangle, with their offsets in the frame.
    fn pixels(&self) -> Vec<(oracle::Pixel, usize)> {
        let (width, height) = self.size;
        let inside = |pixel: &oracle::Pixel| contains(self.clip, pixel.x as u32, pixel.y as u32);
        let pixels = oracle::pixels(&self.corners, VINTAGE, width as i32, height as i32);
        pixels.into_iter().filter(inside).map(|p| (p, p.y as usize * width as usize + p.x as usize)).collect()
    }

    fn without_depth(&self) -> u64 {
        let (width, height) = self.size;
        let mut drawn = DrawStats::default();
        let bytes = self.draw(|mut raster, _| drawn += raster.triangle(&self.corners, VINTAGE));
        let mut expected = vec![EMPTY; (width * height) as usize];
        let shades = self.corners.map(|v| v.shade().to_bits() >> 8);
        let range = shades.into_iter().min().expect("three")..=shades.into_iter().max().expect("three");
        let pixels = self.pixels();
        for (pixel, place) in &pixels {
            assert!(range.contains(&pixel.byte.into()), "cut, but between the vertices': {:?}", self.corners);
            expected[*place] = pixel.byte;
        }
        assert_eq!(bytes, expected, "{:?}", self.corners);
        assert_eq!((drawn.covered as usize, drawn.pixels as usize), (pixels.len(), pixels.len()));
        pixels.len() as u64
    }

    /// With a depth buffer that holds these depths.
    fn with_depth<D: Cell + std::fmt::Debug>(&self, held: Vec<D>) {
        let (width, height) = self.size;
        let (mut nearest, mut expected) = (held.clone(), vec![EMPTY; (width * height) as usize]);
        let mut depths = held;
        let bytes = self.draw(|mut raster, first| {
            let from = (first * width) as usize;
            let depth = DepthBuffer::new(&mut depths[from..], &raster.frame()).expect("long enough");
            raster.with_depth(depth).triangle(&self.corners, VINTAGE);
        });
        for (pixel, place) in self.pixels() {
            let depth = D::of_depth(oracle::depth_beyond(&self.corners, pixel.x, pixel.y));
            if depth > nearest[place] {
                (nearest[place], expected[place]) = (depth, pixel.byte);
            }
        }
        assert_eq!(bytes, expected, "{:?}", self.corners);
        assert_eq!(depths, nearest, "{:?}", self.corners);
    }
}

/// The scan-line method gives it exact cover; each pixel gets the nearest shade in the sources' rows.
#[cfg(feature = "alloc")]
#[test]
fn by_scan_line_its_shades_are_on_exact_cover() {
    use mode13h::internals::raster::scan_line::Lists;

    let mut tried = Tried::new("by_scan_line_its_shades_are_on_exact_cover", 2_000);
    let mut random = Random::named("period, scan-line");
    let (width, height) = (96, 24);
    let (mut lists, mut pixels) = (Lists::default(), 0);
    while tried.more() {
        let corners = triangle(&mut random, width.into(), height.into());
        let mut bytes = vec![EMPTY; (width * height) as usize];
        let mut raster = Raster::new(Frame::new(&mut bytes, width, height, width as usize).expect("legal"));
        raster.scan_line(&[(corners, VINTAGE)], &mut lists);
        let mut expected = vec![EMPTY; (width * height) as usize];
        let shades = oracle::Shades::of_vertices(&corners, VINTAGE);
        for covered in oracle::pixels(&corners, Interpolation::Flat(0), width as i32, height as i32) {
            let place = (covered.y as u32 * width + covered.x as u32) as usize;
            expected[place] = shades.byte((0, 0), covered.x, covered.y, None);
            pixels += 1;
        }
        assert_eq!(bytes, expected, "{corners:?}");
        // Where the sources have the pixel too, the byte is the same.
        let own = draw(&corners, VINTAGE, width, height, None, EMPTY);
        let other = draw(&corners, VINTAGE, width, height, None, EMPTY + 1);
        for place in 0..own.len() {
            let both = own[place] == other[place] && expected[place] != EMPTY;
            assert!(!both || own[place] == expected[place] || own[place] == EMPTY, "{corners:?}");
        }
    }
    assert!(pixels > 20 * tried.stated(), "{pixels} pixels");
}

/// Neighbours walk their common edge the same way, so they draw no pixel twice.
#[test]
fn neighbours_share_no_pixel() {
    let mut tried = Tried::new("neighbours_share_no_pixel", 1_000);
    let mut random = Random::named("period, edges");
    while tried.more() {
        let mut at = || vertex(random.within(0, 60) * 256, random.within(0, 20) * 256, 0, 1);
        let (a, b, c, d) = (at(), at(), at(), at());
        let point = oracle::point;
        let (one, other) = (
            oracle::edge(point(&a), point(&b), point(&c)).signum(),
            oracle::edge(point(&a), point(&b), point(&d)).signum(),
        );
        if one * other >= 0 {
            continue;
        }
        let shade = U8F8::from(200);
        let count = |third: Vertex| draw(&[a, b, third].map(|v| v.with_shade(shade)), VINTAGE, 64, 24, None, 0);
        let (first, second) = (count(c), count(d));
        for place in 0..first.len() {
            assert!(first[place] == 0 || second[place] == 0, "{place} of {a:?} {b:?} {c:?} {d:?}");
        }
    }
}
