//! Lists of Gouraud triangles: through the C interface, and by `Raster::triangles` from the same vertices and indices.
//!
//!     cargo bench -p mode13h-capi --bench lists

use std::hint::black_box;
use std::time::Instant;

use mode13h::raster::{DepthBuffer, Frame, Interpolation, Raster, Vertex};
use mode13h_capi::abi::{Material, Mesh, Vertex as Corner, VertexX as CornerX};
use mode13h_capi::draw::{m13_draw, m13_draw_x};
use mode13h_capi::target::{m13_target_depth, m13_target_init};

/// A wavy sheet of `columns` × `rows` quads, over the whole frame.
fn sheet(columns: u16, rows: u16) -> (Vec<Corner>, Vec<u16>) {
    let mut corners = Vec::new();
    for j in 0..=rows {
        for i in 0..=columns {
            let (u, v) = (f32::from(i) / f32::from(columns), f32::from(j) / f32::from(rows));
            let x = 320.0 * u + 3.0 * (v * 9.0).sin();
            let y = 200.0 * v + 3.0 * (u * 7.0).cos();
            corners.push(Corner { x, y, depth: 0.3 + 0.2 * u, shade: 128.0 + 120.0 * (u * 5.0 + v * 3.0).sin() });
        }
    }
    let mut indices = Vec::new();
    for j in 0..rows {
        for i in 0..columns {
            let at = |i: u16, j: u16| j * (columns + 1) + i;
            let (a, b, c, d) = (at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1));
            indices.extend([a, b, c, a, c, d]);
        }
    }
    (corners, indices)
}

fn depth(corner: &Corner) -> u32 {
    (f64::from(corner.depth) * 1_073_741_824.0 + 0.5) as u32
}

/// Keeps the shortest time of one call.
fn time(best: &mut f64, call: impl FnOnce()) {
    let then = Instant::now();
    call();
    *best = best.min(then.elapsed().as_secs_f64());
}

fn main() {
    println!("ns a triangle, the least of 400 rounds in turn");
    println!("{:>9} {:>5} {:>9} {:>9} {:>9} {:>9}", "triangles", "depth", "Rust", "prepared", "C", "C, 16.16");
    for (columns, rows) in [(8, 5), (32, 20), (80, 50), (160, 100)] {
        let (corners, indices) = sheet(columns, rows);
        let corners_x: Vec<CornerX> = corners
            .iter()
            .map(|c| {
                let fixed = |x: f32| (f64::from(x) * 65_536.0) as i32;
                CornerX { x: fixed(c.x), y: fixed(c.y), depth: depth(c), shade: fixed(c.shade) }
            })
            .collect();
        let vertex = |c: &Corner| Vertex::at(c.x, c.y, c.shade).with_depth(depth(c));
        let prepared: Vec<[Vertex; 3]> =
            indices.as_chunks::<3>().0.iter().map(|t| t.map(|i| vertex(&corners[usize::from(i)]))).collect();
        for has_depth in [false, true] {
            let (mut pixels, mut depths) = (vec![0_u8; 320 * 200], vec![0_u32; 320 * 200]);
            let mut best = [f64::MAX; 4];
            let mut target = std::mem::MaybeUninit::uninit();
            for _ in 0..400 {
                // By Rust, from the same vertices: each is converted once, then the triangles are built from them.
                depths.fill(0);
                time(&mut best[0], || {
                    let vertices: Vec<Vertex> = corners.iter().map(vertex).collect();
                    let triangles: Vec<[Vertex; 3]> =
                        indices.as_chunks::<3>().0.iter().map(|t| t.map(|i| vertices[usize::from(i)])).collect();
                    draw(&mut pixels, &mut depths, has_depth, &triangles);
                });
                depths.fill(0);
                time(&mut best[1], || draw(&mut pixels, &mut depths, has_depth, &prepared));
                for is_fixed in [false, true] {
                    depths.fill(0);
                    let vertices =
                        if is_fixed { corners_x.as_ptr().cast::<core::ffi::c_void>() } else { corners.as_ptr().cast() };
                    let mesh = Mesh {
                        vertices,
                        vertex_count: corners.len() as u32,
                        stride: 16,
                        depth: 8,
                        shade: 12,
                        indices: indices.as_ptr().cast(),
                        index_count: indices.len() as u32,
                        ..Mesh::NONE
                    };
                    let material = Material { shading: 1, ..Material::NONE };
                    // SAFETY: the structs are valid, and so is the memory they name.
                    unsafe {
                        m13_target_init(target.as_mut_ptr(), pixels.as_mut_ptr().cast(), 64_000, 320, 200, 320);
                        if has_depth {
                            m13_target_depth(target.as_mut_ptr(), depths.as_mut_ptr().cast(), 256_000, 32);
                        }
                    }
                    let draw = if is_fixed { m13_draw_x } else { m13_draw };
                    time(&mut best[2 + usize::from(is_fixed)], || {
                        let null = core::ptr::null_mut();
                        // SAFETY: as above.
                        black_box(unsafe { draw(target.as_ptr(), &mesh, &material, null, core::ptr::null_mut()) });
                    });
                }
            }
            let [rust, prepared, c, fixed] = best.map(|best| best * 1e9 / f64::from(indices.len() as u32 / 3));
            let depth = if has_depth { "u32" } else { "none" };
            println!("{:>9} {depth:>5} {rust:>9.1} {prepared:>9.1} {c:>9.1} {fixed:>9.1}", indices.len() / 3);
        }
    }
}

fn draw(pixels: &mut [u8], depths: &mut [u32], has_depth: bool, triangles: &[[Vertex; 3]]) {
    let frame = Frame::new(pixels, 320, 200, 320).expect("a frame");
    let list = triangles.iter().map(|corners| (corners, Interpolation::Gouraud88Reseeded));
    if has_depth {
        let depth = DepthBuffer::new(depths, &frame).expect("depths");
        black_box(Raster::new(frame).with_depth(depth).triangles(list));
    } else {
        black_box(Raster::new(frame).triangles(list));
    }
}
