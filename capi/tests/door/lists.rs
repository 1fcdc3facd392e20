//! Random triangles through the C interface, compared with the engine's own functions.

use std::ffi::c_void;
use std::sync::atomic::{AtomicBool, AtomicU8, Ordering};

use mode13h::raster::{DepthBuffer, Frame, Interpolation, Raster, Rect, Vertex};
use mode13h_capi::abi::{Material, Mesh, OK, Stats, Target};
use mode13h_capi::draw::{m13_draw, m13_draw_x, m13_triangle, m13_triangle_x};
use mode13h_capi::target::{m13_clear, m13_clear_depth, m13_target_clip};
use mode13h_conformance::random::Random;

use crate::{Memory, material, mesh, target};

const SHADINGS: [Interpolation; 5] = [
    Interpolation::Flat(77),
    Interpolation::Gouraud88Reseeded,
    Interpolation::Gouraud88,
    Interpolation::Gouraud1616,
    Interpolation::GouraudHyperbolic,
];

/// A frame and its depths, which are checked to their last byte.
#[derive(Clone, PartialEq)]
struct Canvas {
    pixels: Vec<u8>,
    wide: Vec<u32>,
    narrow: Vec<u16>,
}

/// A vertex of this program, with other fields before, between and after those that are read.
#[derive(Clone, Copy)]
#[repr(C)]
struct Own {
    name: u8,
    shade: f32,
    x: f32,
    y: f32,
    w: f32,
    depth: f32,
    more: u16,
}

#[derive(Clone, Copy)]
#[repr(C)]
struct OwnX {
    depth: u32,
    more: [u8; 3],
    x: i32,
    y: i32,
    shade: i32,
}

/// Draws with the engine.
fn by_engine(
    canvas: &mut Canvas,
    [width, height, pitch]: [u32; 3],
    bits: u32,
    clip: Rect,
    triangles: &[[Vertex; 3]],
    shading: usize,
) {
    let frame = Frame::new(&mut canvas.pixels, width, height, pitch as usize).expect("a frame");
    let list = triangles.iter().map(|corners| (corners, SHADINGS[shading]));
    match bits {
        0 => Raster::new(frame).with_clip(clip).triangles(list),
        16 => {
            let depth = DepthBuffer::new(&mut canvas.narrow, &frame).expect("depths");
            Raster::new(frame).with_depth(depth).with_clip(clip).triangles(list)
        }
        _ => {
            let depth = DepthBuffer::new(&mut canvas.wide, &frame).expect("depths");
            Raster::new(frame).with_depth(depth).with_clip(clip).triangles(list)
        }
    };
}

fn canvas_target(canvas: &mut Canvas, [width, height, pitch]: [u32; 3], bits: u32, clip: Rect) -> Target {
    let mut made = target(&mut canvas.pixels, width, height, pitch as usize);
    made.depth_bits = bits;
    (made.depth, made.depth_bytes) = match bits {
        16 => (canvas.narrow.as_mut_ptr().cast(), 2 * canvas.narrow.len()),
        _ => (canvas.wide.as_mut_ptr().cast(), 4 * canvas.wide.len()),
    };
    let [x0, y0, x1, y1] = [clip.x0, clip.y0, clip.x1, clip.y1].map(|edge| edge as i32);
    // SAFETY: a target.
    assert_eq!(unsafe { m13_target_clip(&raw mut made, x0, y0, x1, y1) }, OK);
    made
}

#[test]
fn lists_have_the_bytes_of_the_engine() {
    let mut random = Random::named("lists of C");
    let mut drawn = 0_u64;
    for round in 0..600 {
        let size = [1 + random.below(330) as u32, 1 + random.below(210) as u32];
        let shape = [size[0], size[1], size[0] + random.below(9) as u32];
        let (bits, shading) = (random.one_of(&[0, 16, 32]), random.below(5));
        let cells = (shape[0] * shape[1]) as usize;
        let pixels = (shape[2] * (shape[1] - 1) + shape[0]) as usize;
        let mut canvas = Canvas { pixels: vec![3; pixels], wide: vec![0; cells], narrow: vec![0; cells] };
        for cell in 0..cells {
            canvas.wide[cell] = random.below(1 << 29) as u32;
            canvas.narrow[cell] = random.below(1 << 15) as u16;
        }
        let clip = if random.below(3) == 0 {
            let x0 = random.below(size[0] as usize + 1) as u32;
            Rect {
                x0,
                y0: random.below(9) as u32,
                x1: size[0] - random.below(4).min(size[0] as usize) as u32,
                y1: size[1],
            }
        } else {
            Rect { x0: 0, y0: 0, x1: size[0], y1: size[1] }
        };
        // Some have more vertices than the library keeps at a time.
        let count = random.log_uniform(if round % 8 == 1 { 12 } else { 9 }) + 3;
        // Most triangles are small.
        let spread = random.one_of(&[6.0, 40.0, 300.0]);
        let (mut own, mut own_x) = (Vec::new(), Vec::new());
        let mut centre = [0.0; 2];
        for i in 0..count {
            if i % 3 == 0 {
                centre = [random.unit() * f64::from(size[0]), random.unit() * f64::from(size[1])];
            }
            let [x, y] = centre.map(|c| (c + random.around_zero(spread)) as f32);
            // Some numbers with few bits, so that vertices lie on centres and corners of pixels.
            let [x, y] = if random.below(2) == 0 { [x, y] } else { [(x * 2.0).round() / 2.0, (y * 2.0).round() / 2.0] };
            let (depth, shade) = (random.unit() as f32, (random.unit() * 300.0 - 20.0) as f32);
            own.push(Own { name: 9, shade, x, y, w: f32::NAN, depth, more: 7 });
            let [x, y, shade] = [x, y, shade].map(|c| (f64::from(c) * 65_536.0) as i32);
            own_x.push(OwnX { depth: random.next_u64() as u32, more: [1; 3], x, y, shade });
        }
        let vertices: Vec<Vertex> = own
            .iter()
            .map(|v| Vertex::at(v.x, v.y, v.shade).with_depth((f64::from(v.depth) * f64::from(1 << 30) + 0.5) as u32))
            .collect();
        let vertices_x: Vec<Vertex> = own_x
            .iter()
            .map(|v| {
                // Rounded to the nearest 1/256, halves upward, in another way than the C interface does it.
                let nearest = |c: i32| ((f64::from(c) / 256.0 + 0.5).floor()) as i32;
                let shade = (f64::from(v.shade) / 256.0 + 0.5).floor().clamp(0.0, 65_280.0) as u16;
                let at = mode13h::fixed::I24F8::from_bits;
                let shade = mode13h::fixed::U8F8::from_bits(shade);
                Vertex::new(at(nearest(v.x)), at(nearest(v.y)), shade, v.depth).expect("near the frame")
            })
            .collect();
        let indices: Vec<u32> = (0..3 * (count / 2)).map(|_| random.below(count) as u32).collect();
        let narrow: Vec<u16> = indices.iter().map(|i| *i as u16).collect();
        let is_indexed = round % 3 > 0;
        let triangles = |vertices: &[Vertex]| -> Vec<[Vertex; 3]> {
            if is_indexed {
                indices.as_chunks::<3>().0.iter().map(|corners| corners.map(|i| vertices[i as usize])).collect()
            } else {
                vertices.as_chunks::<3>().0.to_vec()
            }
        };
        for is_fixed in [false, true] {
            let (mut should, mut is) = (canvas.clone(), canvas.clone());
            let list = triangles(if is_fixed { &vertices_x } else { &vertices });
            by_engine(&mut should, shape, bits, clip, &list, shading);
            let mut made = if is_fixed {
                let mut made = mesh(&own_x);
                (made.depth, made.position, made.shade) = (0, core::mem::offset_of!(OwnX, x) as u32, 16);
                made
            } else {
                let mut made = mesh(&own);
                (made.shade, made.position, made.depth) = (4, 8, 20);
                made
            };
            if is_indexed {
                (made.index_bits, made.index_count) = (if round % 2 == 0 { 16 } else { 32 }, indices.len() as u32);
                made.indices = if round % 2 == 0 { narrow.as_ptr().cast() } else { indices.as_ptr().cast() };
            } else {
                made.vertex_count -= made.vertex_count % 3;
            }
            let mut of = material(shading as u32);
            of.color = 77;
            let made_target = canvas_target(&mut is, shape, bits, clip);
            let mut stats = Stats { size: 24, triangles: 0, refused: 0, spans: 0, covered: 0, pixels: 0 };
            let draw = if is_fixed { m13_draw_x } else { m13_draw };
            // SAFETY: the structs are valid, and so is the memory they name.
            let code = unsafe { draw(&made_target, &made, &of, core::ptr::null_mut(), &mut stats) };
            assert_eq!((code, stats.refused), (OK, 0));
            assert_eq!(stats.triangles as usize, list.len());
            drawn += u64::from(stats.pixels);
            assert!(is == should, "round {round}, {shape:?}, {bits} bits, {:?}", SHADINGS[shading]);
        }
    }
    println!("{drawn} pixels");
    assert!(drawn > 1_000_000);
}

#[test]
fn a_triangle_is_a_list_of_one() {
    let mut random = Random::named("triangles of C");
    for _ in 0..400 {
        let mut canvas = Canvas { pixels: vec![3; 64 * 40], wide: vec![0; 64 * 40], narrow: Vec::new() };
        let everything = Rect { x0: 0, y0: 0, x1: 64, y1: 40 };
        let (shape, shading) = ([64, 40, 64], random.below(5));
        // Numbers of 16.16, which have 24 bits: f32 holds them, too.
        let mut number =
            |from: f64, to: f64| ((from + random.unit() * (to - from)) * 65_536.0).round() as f32 / 65_536.0;
        let corners: [mode13h_capi::abi::Vertex; 3] = core::array::from_fn(|_| mode13h_capi::abi::Vertex {
            x: number(-8.0, 72.0),
            y: number(-8.0, 52.0),
            depth: number(0.0, 1.0),
            shade: number(0.0, 255.0),
        });
        let corners_x = corners.map(|c| mode13h_capi::abi::VertexX {
            x: (c.x * 65_536.0) as i32,
            y: (c.y * 65_536.0) as i32,
            depth: (f64::from(c.depth) * f64::from(1 << 30) + 0.5) as u32,
            shade: (c.shade * 65_536.0) as i32,
        });
        let vertices = corners
            .map(|c| Vertex::at(c.x, c.y, c.shade).with_depth((f64::from(c.depth) * f64::from(1 << 30) + 0.5) as u32));
        let mut should = canvas.clone();
        by_engine(&mut should, shape, 32, everything, &[vertices], shading);
        let made = canvas_target(&mut canvas, shape, 32, everything);
        // SAFETY: three corners.
        assert_eq!(unsafe { m13_triangle(&made, corners.as_ptr(), shading as u32, 77) }, OK);
        assert!(canvas == should);
        // Cleared and drawn again in 16.16.
        let made = canvas_target(&mut canvas, shape, 32, everything);
        // SAFETY: as above.
        unsafe {
            assert_eq!(m13_clear(&made, 3), OK);
            assert_eq!(m13_clear_depth(&made), OK);
            assert_eq!(m13_triangle_x(&made, corners_x.as_ptr(), shading as u32, 77), OK);
        }
        assert!(canvas == should);
    }
}

/// A tessellated sheet through the near plane and far beyond the frame: each pixel is drawn once, which a blend that
/// counts shows, and however the sheet is cut up, no pixel is left out that the whole covers.
#[test]
fn clipped_neighbours_leave_no_hole() {
    let memory = crate::Memory::new();
    // Each pixel drawn over another increases it by one.
    let counts: Vec<u8> = (0..65_536).map(|i| ((i & 255) as u8).saturating_add(1)).collect();
    let mut random = Random::named("clipped in C");
    let (mut drawn, mut clipped) = (0, 0);
    for round in 0..600 {
        // A grid on a plane in space: X, Y and w linear in both directions, so some of it is behind the eye.
        let of = |most: f64, random: &mut Random| [0; 3].map(|_| random.around_zero(most));
        let (x, y, w) = (of(3_000.0, &mut random), of(2_000.0, &mut random), of(12.0, &mut random));
        let n = 1 + random.below(14);
        // Sixteenths, so that the sheet is flat, and the float and the 16.16 functions see the same values.
        let part = |c: f64| (c * 16.0).round() / 16.0;
        let linear = |[a, b, c]: [f64; 3], i: usize, j: usize| {
            let [across, down] = [b, c].map(|c| part(2.0 * c / n as f64));
            (part(a - b - c) + across * i as f64 + down * j as f64) as f32
        };
        let mut grid = Vec::new();
        for j in 0..=n {
            for i in 0..=n {
                grid.push([linear(x, i, j), linear(y, i, j), linear([w[0] + 4.0, w[1], w[2]], i, j)]);
            }
        }
        let mut indices: Vec<u16> = Vec::new();
        for j in 0..n {
            for i in 0..n {
                let [a, b, c, d] =
                    [[i, j], [i + 1, j], [i + 1, j + 1], [i, j + 1]].map(|[i, j]| (j * (n + 1) + i) as u16);
                indices.extend([a, b, c, a, c, d]);
            }
        }
        let grid_x: Vec<[i32; 3]> = grid.iter().map(|at| at.map(|c| (f64::from(c) * 65_536.0) as i32)).collect();
        let near = [0.5, 0.1, 0.01, 0.3, 3.0, 7.0][round % 6];
        for is_fixed in [false, true] {
            let mut pixels = vec![0_u8; 320 * 200];
            let canvas = target(&mut pixels, 320, 200, 320);
            let mut made = if is_fixed { mesh(&grid_x) } else { mesh(&grid) };
            (made.homogeneous, made.near_w, made.near_w_x) = (1, near, (near * 65_536.0) as i32);
            (made.indices, made.index_count) = (indices.as_ptr().cast(), indices.len() as u32);
            let mut of = material(0);
            of.blend_table = counts.as_ptr();
            let mut stats = Stats { size: 24, triangles: 0, refused: 0, spans: 0, covered: 0, pixels: 0 };
            let draw = if is_fixed { m13_draw_x } else { m13_draw };
            // SAFETY: the structs are valid, and so is the memory they name.
            assert_eq!(unsafe { draw(&canvas, &made, &of, memory.context, &mut stats) }, OK);
            drawn += stats.pixels;
            clipped += usize::from(stats.triangles as usize != indices.len() / 3);
            let is_double = pixels.iter().filter(|count| **count > 1).count();
            assert_eq!(is_double, 0, "{is_fixed}: pixels drawn twice");
            // Between any two drawn pixels of a row, all are drawn: the part in front of the near plane is convex.
            for row in pixels.chunks(320) {
                let first = row.iter().position(|count| *count > 0).unwrap_or(0);
                let last = row.iter().rposition(|count| *count > 0).unwrap_or(0);
                let holes = row[first..last.max(first)].iter().filter(|count| **count == 0).count();
                assert_eq!(holes, 0, "{is_fixed}: holes");
            }
        }
    }
    println!("{drawn} pixels, {clipped} sheets clipped");
    assert!(drawn > 100_000 && clipped > 20);
}

/// Huge triangles and those that reach behind the eye are not lost, whatever the near plane: in the middle of the frame
/// each covers what it covers in exact arithmetic.
#[test]
fn clipped_triangles_are_drawn() {
    let mut random = Random::named("huge triangles of C");
    let mut covered = 0;
    for round in 0..40_000 {
        let near = [0.1, 0.01, 0.3, 0.03, 0.7][round % 5];
        let corners: [[f32; 3]; 3] = core::array::from_fn(|_| {
            let [x, y, w] = [40_000.0, 30_000.0, 60.0].map(|most| random.around_zero(most) * near);
            // Whole numbers of 1/65,536 in both formats.
            [x, y, w].map(|c| ((c * 65_536.0).round() / 65_536.0) as f32)
        });
        let corners_x = corners.map(|at| at.map(|c| (f64::from(c) * 65_536.0) as i32));
        // The middle of a pixel is a sum of the corners. It is in front of the near plane, and eight pixels inside of all
        // edges: in 16.16 a point cut at the end of the guard band may be off by three.
        let middle = [160.5, 100.5, 1.0];
        let dot = |a: [f64; 3], b: [f64; 3]| a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
        let cross = |a: [f64; 3], b: [f64; 3]| {
            [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
        };
        let [a, b, c] = corners.map(|at| at.map(f64::from));
        let edges = [cross(a, b), cross(b, c), cross(c, a)];
        let whole = dot(a, edges[1]);
        let is_inside = edges.iter().all(|edge| dot(middle, *edge) * whole.signum() > 8.0 * edge[0].hypot(edge[1]));
        let w = whole / edges.iter().map(|edge| dot(middle, *edge)).sum::<f64>();
        if !is_inside || w < 1.01 * near {
            continue;
        }
        covered += 1;
        for is_fixed in [false, true] {
            let mut pixels = vec![0_u8; 320 * 200];
            let canvas = target(&mut pixels, 320, 200, 320);
            let mut made = if is_fixed { mesh(&corners_x) } else { mesh(&corners) };
            (made.homogeneous, made.near_w, made.near_w_x) = (1, near as f32, (near * 65_536.0) as i32);
            let mut of = material(0);
            of.color = 77;
            let draw = if is_fixed { m13_draw_x } else { m13_draw };
            // SAFETY: the structs are valid, and so is the memory they name.
            let code = unsafe { draw(&canvas, &made, &of, core::ptr::null_mut(), core::ptr::null_mut()) };
            assert_eq!((code, pixels[100 * 320 + 160]), (OK, 77), "{corners:?}, near {near}, {is_fixed}");
        }
    }
    println!("{covered} triangles");
    assert!(covered > 500);
}

/// The largest frames are filled to their last column and row.
#[test]
fn the_largest_frames_are_filled() {
    for (width, height) in [(4_096, 3), (3, 4_096)] {
        for is_fixed in [false, true] {
            let mut pixels = vec![0_u8; 4_096 * 3];
            let canvas = target(&mut pixels, width, height, width as usize);
            let corners = [[-100.0_f32, -100.0], [20_000.0, -100.0], [-100.0, 20_000.0]];
            let corners_x = corners.map(|at| at.map(|c| c as i32 * 65_536));
            let mut of = material(0);
            of.color = 77;
            let made = if is_fixed { mesh(&corners_x) } else { mesh(&corners) };
            let draw = if is_fixed { m13_draw_x } else { m13_draw };
            // SAFETY: the structs are valid, and so is the memory they name.
            assert_eq!(unsafe { draw(&canvas, &made, &of, core::ptr::null_mut(), core::ptr::null_mut()) }, OK);
            assert!(pixels.iter().all(|pixel| *pixel == 77), "{width} x {height}, {is_fixed}");
        }
    }
}

/// The order of the corners makes no difference, even if a triangle is clipped.
#[test]
fn the_order_of_the_corners_makes_no_difference() {
    let mut random = Random::named("corners in any order");
    for round in 0..2_000 {
        let corners: [_; 3] = core::array::from_fn(|_| mode13h_capi::abi::Vertex {
            x: random.around_zero(6_000.0) as f32,
            y: random.around_zero(6_000.0) as f32,
            depth: random.unit() as f32,
            shade: (random.unit() * 255.0) as f32,
        });
        let drawn = |order: [usize; 3], shading| {
            let mut pixels = vec![0_u8; 320 * 200];
            let canvas = target(&mut pixels, 320, 200, 320);
            let corners = order.map(|i| corners[i]);
            // SAFETY: three corners.
            assert_eq!(unsafe { m13_triangle(&canvas, corners.as_ptr(), shading, 77) }, OK);
            pixels
        };
        for shading in [1, 4] {
            let first = drawn([0, 1, 2], shading);
            for order in [[1, 2, 0], [2, 0, 1], [0, 2, 1], [1, 0, 2]] {
                assert!(drawn(order, shading) == first, "round {round}, {order:?}, shading {shading}");
            }
        }
    }
}

/// Flat triangles read no shades, so these may be anything.
#[test]
fn flat_triangles_need_no_shades() {
    let mut pixels = vec![0_u8; 64 * 40];
    let canvas = target(&mut pixels, 64, 40, 64);
    let corner = |x, y| mode13h_capi::abi::Vertex { x, y, depth: 1.0, shade: f32::NAN };
    let corners = [corner(0.0, 0.0), corner(60.0, 0.0), corner(0.0, 30.0)];
    // SAFETY: three corners.
    unsafe {
        assert_eq!(m13_triangle(&canvas, corners.as_ptr(), 0, 77), OK);
        assert_ne!(m13_triangle(&canvas, corners.as_ptr(), 1, 77), OK);
    }
    assert_eq!(pixels[64 * 10 + 10], 77);
}

/// A shade beyond its range counts as the end of the range, whether or not its corner is cut off.
#[test]
fn shades_are_clamped_before_triangles_are_cut() {
    let drawn = |shade: f32, is_fixed: bool| {
        let mut pixels = vec![0_u8; 320 * 200];
        let canvas = target(&mut pixels, 320, 200, 320);
        let corners = [[10.0_f32, 10.0, 1.0, 20.0], [300.0, 20.0, 1.0, 100.0], [-50.0, 90.0, -0.5, shade]];
        let corners_x = corners.map(|corner| corner.map(|c| (c * 65_536.0) as i32));
        let of = material(1);
        let mut made = if is_fixed { mesh(&corners_x) } else { mesh(&corners) };
        (made.homogeneous, made.near_w, made.near_w_x, made.shade) = (1, 0.5, 0x8000, 12);
        let draw = if is_fixed { m13_draw_x } else { m13_draw };
        // SAFETY: the structs are valid, and so is the memory they name.
        assert_eq!(unsafe { draw(&canvas, &made, &of, core::ptr::null_mut(), core::ptr::null_mut()) }, OK);
        assert!(pixels.iter().filter(|pixel| **pixel > 0).count() > 1_000);
        pixels
    };
    for is_fixed in [false, true] {
        assert!(drawn(255.0, is_fixed) == drawn(1_000.0, is_fixed));
        assert!(drawn(0.0, is_fixed) == drawn(-1_000.0, is_fixed));
    }
}

/// A target with more bytes than its rows need, as of a band of a frame, writes none of the others: they may be another
/// thread's.
#[test]
fn bytes_behind_a_band_are_not_touched() {
    const PITCH: usize = 320;
    let mut pixels = vec![0_u8; 2 * PITCH];
    let whole = target(&mut pixels, 320, 2, PITCH);
    // Two pixels at the end of the first row, in a list and through the stages of effects.
    let corners: Vec<[f32; 3]> =
        (0..20).flat_map(|_| [[318.0, 0.0, 9.0], [324.0, 0.0, 9.0], [318.0, 2.0, 9.0]]).collect();
    let mut list = mesh(&corners);
    list.shade = 8;
    let materials = [material(1), Material { dither: 1, ..material(1) }];
    let memory = Memory::new();
    let upper = Band(Target { rows: 1, clip_y1: 1, ..whole }, list, materials, memory.context);
    let (done, behind) = (AtomicBool::new(false), whole.pixels.expose_provenance() + PITCH);
    std::thread::scope(|scope| {
        scope.spawn(|| {
            let Band(upper, list, materials, context) = &{ upper };
            for i in 0..40_000 {
                // SAFETY: the target names a row that nobody else uses.
                let code = unsafe { m13_draw(upper, list, &materials[i % 2], *context, std::ptr::null_mut()) };
                assert_eq!(code, OK);
            }
            done.store(true, Ordering::Release);
        });
        // SAFETY: the second row, which the other thread must not touch.
        let first = unsafe { &*std::ptr::with_exposed_provenance::<AtomicU8>(behind) };
        let mut value = 0_u8;
        while !done.load(Ordering::Acquire) {
            value = value.wrapping_add(1);
            first.store(value, Ordering::Relaxed);
            for _ in 0..50 {
                assert_eq!(first.load(Ordering::Relaxed), value, "changed by the other thread");
            }
        }
    });
    assert_eq!(pixels[318..320], [9, 9]);
}

/// A band of a frame, and all that another thread needs to draw into it.
struct Band(Target, Mesh, [Material; 2], *mut c_void);

// SAFETY: what it names is used by one thread.
unsafe impl Send for Band {}
