//! How much memory a context takes, and when.

use mode13h::internals::HAS_F64;
use mode13h_capi::abi::Stats;
use mode13h_capi::draw::{m13_draw, m13_size};

use crate::{Memory, material, mesh, target};

/// The stages allocate no more than a context has for them, and nothing once it is made. (In the C library their
/// allocator hands out the context's own memory.)
#[test]
fn all_memory_is_taken_when_a_context_is_made() {
    let mut memory = None;
    let made = allocation_counter::measure(|| memory = Some(Memory::new()));
    let memory = memory.expect("made");
    // The context's own memory is allocated by this test.
    let taken = made.bytes_total as usize - m13_size().div_ceil(16) * 16;
    println!("{taken} bytes taken; a context has {}", m13_size());
    assert!(taken > 0 && taken <= if HAS_F64 { 0x2_4000 } else { 0x1_D000 }, "{taken}");

    let (tables, texels) = (vec![7_u8; 65_536], vec![1_u8; 256]);
    let (mut pixels, mut depths) = (vec![0_u8; 320 * 200], vec![0_u32; 320 * 200]);
    let vertices: Vec<[f32; 7]> = (0..90_u32)
        .map(|i| [(i * 97 % 400) as f32, (i * 89 % 300) as f32, (i % 11) as f32 / 11.0, 9.0, 3.0, 40.0, 200.0])
        .collect();
    let mut mesh = mesh(&vertices);
    (mesh.depth, mesh.shade, mesh.texture, mesh.fog, mesh.slope) = (8, 12, 16, 12, 20);
    for has_depth in [false, true] {
        let mut target = target(&mut pixels, 320, 200, 320);
        if has_depth {
            (target.depth, target.depth_bits) = (depths.as_mut_ptr().cast(), 32);
            target.depth_bytes = 4 * depths.len();
        }
        for bits in 0..192 {
            let mut material = material(1 + (bits & 3));
            (material.dither, material.keep_depth) = (bits >> 1 & 1, 1);
            (material.u_bits, material.v_bits) = (4, 4);
            material.texels = texels.as_ptr();
            material.mapping = (bits / 64) % 3;
            let when = |bit: u32| if bits & bit == 0 { core::ptr::null() } else { tables.as_ptr() };
            (material.fog_table, material.blend_table) = (when(4), when(8));
            (material.shade_table, material.slope_table) = (when(16), when(32));
            let mut stats = Stats { size: 24, triangles: 0, refused: 0, spans: 0, covered: 0, pixels: 0 };
            let drawn = allocation_counter::measure(|| {
                // SAFETY: the structs are valid, and so is the memory they name.
                let code = unsafe { m13_draw(&target, &mesh, &material, memory.context, &mut stats) };
                assert_eq!(code, 0);
            });
            assert_eq!(drawn.count_total, 0);
            assert!(stats.covered > 0);
        }
    }
}

/// A context is made on a stack as large as the header says: its contents are not made there first.
#[test]
fn a_context_is_made_on_a_small_stack() {
    let made = std::thread::Builder::new().stack_size(76 << 10).spawn(|| drop(Memory::new()));
    made.expect("started").join().expect("made");
}
