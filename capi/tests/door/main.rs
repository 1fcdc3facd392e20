//! The functions for C, called from Rust: they draw the same bytes as the engine's own functions.
#![cfg(feature = "effects")]

mod colors;
mod frames;
mod header;
mod lists;
mod memory;

use mode13h_capi::abi::{Material, Mesh, OK, Target};
use mode13h_capi::draw::{m13_init, m13_material_init, m13_mesh_init, m13_size};
use mode13h_capi::target::m13_target_init;

/// A target over bytes.
fn target(pixels: &mut [u8], width: u32, height: u32, pitch: usize) -> Target {
    let mut made = core::mem::MaybeUninit::uninit();
    // SAFETY: there is room for a target, and the pixels have the stated length.
    let code =
        unsafe { m13_target_init(made.as_mut_ptr(), pixels.as_mut_ptr().cast(), pixels.len(), width, height, pitch) };
    assert_eq!(code, OK);
    // SAFETY: the call succeeded, so the target has been written.
    unsafe { made.assume_init() }
}

/// A mesh over vertices.
fn mesh<T>(vertices: &[T]) -> Mesh {
    let mut made = Mesh::NONE;
    // SAFETY: room for a mesh.
    let code =
        unsafe { m13_mesh_init(&raw mut made, vertices.as_ptr().cast(), vertices.len() as u32, size_of::<T>() as u32) };
    assert_eq!(code, OK);
    made
}

fn material(shading: u32) -> Material {
    let mut made = Material::NONE;
    // SAFETY: room for a material.
    assert_eq!(unsafe { m13_material_init(&raw mut made, shading) }, OK);
    made
}

/// Memory with a context in it.
struct Memory {
    _bytes: Vec<u128>,
    context: *mut core::ffi::c_void,
}

impl Memory {
    fn new() -> Self {
        let mut bytes = vec![0_u128; m13_size().div_ceil(16)];
        let mut context = core::ptr::null_mut();
        // SAFETY: the memory has the stated length.
        let code = unsafe { m13_init(bytes.as_mut_ptr().cast(), 16 * bytes.len(), &raw mut context) };
        assert_eq!(code, OK);
        Self { _bytes: bytes, context }
    }
}
