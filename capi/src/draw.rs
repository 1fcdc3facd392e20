//! Triangles, one at a time and in lists.

use core::ffi::{c_int, c_void};

use mode13h::raster::{Interpolation, Raster};

use crate::abi::{ABSENT, Material, Mesh, Outcome, Refusal, Sized32, Stats, Target, Vertex, VertexX, code, read};
use crate::clip::{Progress, clip, doubled_area};
use crate::corner::{Door, Fixed, Floats, Ready, Source};
use crate::target::{Bytes, Checked, Depth, check};

#[cfg(feature = "effects")]
use crate::effects::{Context, Effects};
/// Without effects there is none.
#[cfg(not(feature = "effects"))]
enum Context {}

/// Triangles that are drawn together.
const TOGETHER: usize = 128;

/// The shading of a material: its interpolation.
fn interpolation(material: &Material) -> Outcome<Interpolation> {
    Ok(match material.shading {
        0 => Interpolation::Flat(u8::try_from(material.color).map_err(|_| Refusal::Value)?),
        1 => Interpolation::GouraudReseeded,
        2 => Interpolation::Gouraud,
        3 => Interpolation::Gouraud1616,
        4 => Interpolation::GouraudHyperbolic,
        _ => return Err(Refusal::Value),
    })
}

/// What triangles are handed to when there are enough.
pub(crate) type Flush<'f> = dyn FnMut(&[[Ready; 3]]) -> [u32; 3] + 'f;

/// Reads, clips and culls the triangles of a list, and hands them on.
///
/// # Safety
/// The mesh holds what it says, and its indices have been checked.
unsafe fn gather<D: Door>(
    source: &Source,
    near: Option<D::Wide>,
    progress: Progress,
    cull: u32,
    flush: &mut Flush<'_>,
) -> [u32; 5] {
    let mut waiting = [[Ready::default(); 3]; TOGETHER];
    let (mut count, mut triangles, mut refused, mut drawn) = (0, 0_u32, 0, [0_u32; 3]);
    let mut hand_on = |part: [Ready; 3]| {
        let area = if cull == 0 { 0 } else { doubled_area(&part) };
        if (cull == 1 && area <= 0) || (cull == 2 && area >= 0) {
            return;
        }
        triangles = triangles.wrapping_add(1);
        waiting[count % TOGETHER] = part;
        count += 1;
        if count == TOGETHER {
            add(&mut drawn, flush(&waiting));
            count = 0;
        }
    };
    for i in 0..source.triangles() {
        // SAFETY: below the number of indices, and each below that of the vertices.
        let corners = [0, 1, 2].map(|k| unsafe { source.corner::<D>(source.index(3 * i + k), near) });
        let [Some(a), Some(b), Some(c)] = corners else {
            refused += 1;
            continue;
        };
        match [a.ready, b.ready, c.ready] {
            [Some(a), Some(b), Some(c)] => hand_on([a, b, c]),
            _ => clip::<D>([a, b, c], near, progress, &mut hand_on),
        }
    }
    add(&mut drawn, flush(&waiting[..count % TOGETHER]));
    let [spans, covered, pixels] = drawn;
    [triangles, refused, spans, covered, pixels]
}

/// Counts wrap at 2³².
fn add(sum: &mut [u32; 3], more: [u32; 3]) {
    for (sum, more) in sum.iter_mut().zip(more) {
        *sum = sum.wrapping_add(more);
    }
}

/// Calls `$with` with a raster over a checked target, whatever its depth buffer.
macro_rules! with_raster {
    ($checked:expr, |$raster:ident| $with:expr) => {{
        let Checked { frame, depth, clip, .. } = $checked;
        let plain = Raster::new(frame).with_clip(clip);
        match depth {
            Depth::None => {
                let mut $raster = plain;
                $with
            }
            Depth::U16(depth) => {
                let mut $raster = plain.with_depth(depth);
                $with
            }
            Depth::U32(depth) => {
                let mut $raster = plain.with_depth(depth);
                $with
            }
        }
    }};
}

/// Draws a list.
///
/// # Safety
/// Each pointer is null or what the header says.
unsafe fn draw<D: Door>(
    target: *const Target,
    mesh: *const Mesh,
    material: *const Material,
    context: *mut Context,
    stats: *mut Stats,
) -> Outcome {
    // SAFETY: by the caller, as all that follows.
    let (checked, mesh, material) = unsafe { (check(target)?, read(mesh)?, read(material)?) };
    if !stats.is_null() {
        // SAFETY: not null.
        unsafe { read(stats) }?;
    }
    let interpolation = interpolation(&material)?;
    if material.cull > 2 || material.mapping > 2 || material.dither > 2 || material.keep_depth > 1 {
        return Err(Refusal::Value);
    }
    let pointers = [material.texels, material.slope_table, material.fog_table, material.blend_table];
    let wants_effects =
        pointers.iter().any(|table| !table.is_null()) || material.dither > 0 || material.keep_depth == 0;
    let has_shade = !matches!(interpolation, Interpolation::Flat(_)) && material.slope_table.is_null();
    let (source, parts) = Source::new(mesh, has_shade, wants_effects)?;
    for (pointer, length) in [(mesh.vertices, parts.vertices), (mesh.indices, parts.indices)] {
        if length > 0 {
            checked.apart_from(Bytes::new(pointer, length)?)?;
        }
    }
    let near = if mesh.homogeneous == 1 { Some(D::near(&mesh)?) } else { None };
    // SAFETY: the bytes of the indices are there.
    unsafe { source.check_indices() }?;
    let progress = Progress { shades_on_face: material.shading == 4, texture_on_face: material.mapping != 0 };
    let drawn = if wants_effects {
        #[cfg(not(feature = "effects"))]
        return Err(Refusal::Unsupported);
        #[cfg(feature = "effects")]
        {
            // SAFETY: by the caller.
            let mut effects = unsafe { Effects::new(context, &checked, &mesh, &material, interpolation) }?;
            with_raster!(checked, |raster| {
                // SAFETY: the bytes of vertices and indices are there, and indices have been checked.
                unsafe {
                    gather::<D>(&source, near, progress, material.cull, &mut |all| effects.draw(&mut raster, all))
                }
            })
        }
    } else {
        with_raster!(checked, |raster| {
            let mut flush = |all: &[[Ready; 3]]| {
                let mut corners = [[mode13h::raster::Vertex::default(); 3]; TOGETHER];
                for (to, from) in corners.iter_mut().zip(all) {
                    *to = from.each_ref().map(|corner| corner.vertex);
                }
                let drawn = raster.triangles(corners[..all.len()].iter().map(|corners| (corners, interpolation)));
                [drawn.spans, drawn.covered, drawn.pixels]
            };
            // SAFETY: as above.
            unsafe { gather::<D>(&source, near, progress, material.cull, &mut flush) }
        })
    };
    let _ = context;
    let [triangles, refused, spans, covered, pixels] = drawn;
    if !stats.is_null() {
        let size = Stats::FIRST as u32;
        // SAFETY: not null, and as long as its size says.
        unsafe {
            let size = stats.cast::<u32>().read_unaligned().max(size);
            stats.write_unaligned(Stats { size, triangles, refused, spans, covered, pixels });
        }
    }
    if refused == 0 { Ok(()) } else { Err(Refusal::Vertex) }
}

/// Draws the triangles of a mesh whose numbers are floats.
///
/// # Safety
/// See the header.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn m13_draw(
    target: *const Target,
    mesh: *const Mesh,
    material: *const Material,
    context: *mut c_void,
    stats: *mut Stats,
) -> c_int {
    // SAFETY: by the caller.
    code(unsafe { draw::<Floats>(target, mesh, material, context.cast(), stats) })
}

/// Draws the triangles of a mesh whose numbers are 16.16. It works without a float.
///
/// # Safety
/// See the header.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn m13_draw_x(
    target: *const Target,
    mesh: *const Mesh,
    material: *const Material,
    context: *mut c_void,
    stats: *mut Stats,
) -> c_int {
    // SAFETY: by the caller.
    code(unsafe { draw::<Fixed>(target, mesh, material, context.cast(), stats) })
}

/// Draws one triangle.
///
/// # Safety
/// `vertices` is null or three of what the door reads; `target` is as in the header.
unsafe fn triangle<D: Door>(target: *const Target, vertices: *const c_void, shading: u32, color: u32) -> c_int {
    // Position, depth and shade stand in both structs alike.
    const { assert!(size_of::<Vertex>() == 16 && size_of::<VertexX>() == 16) };
    let (mut mesh, mut material) = (Mesh::NONE, Material::NONE);
    (mesh.vertices, mesh.vertex_count, mesh.stride) = (vertices, 3, 16);
    (mesh.depth, mesh.shade) = (8, 12);
    (material.shading, material.color) = (shading, color);
    let null = core::ptr::null_mut();
    // SAFETY: by the caller.
    code(unsafe { draw::<D>(target, &raw const mesh, &raw const material, null, core::ptr::null_mut()) })
}

/// Draws a triangle of three corners in floats.
///
/// # Safety
/// See the header.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn m13_triangle(
    target: *const Target,
    corners: *const Vertex,
    shading: u32,
    color: u32,
) -> c_int {
    // SAFETY: by the caller.
    unsafe { triangle::<Floats>(target, corners.cast(), shading, color) }
}

/// Draws a triangle of three corners in 16.16. It works without a float.
///
/// # Safety
/// See the header.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn m13_triangle_x(
    target: *const Target,
    corners: *const VertexX,
    shading: u32,
    color: u32,
) -> c_int {
    // SAFETY: by the caller.
    unsafe { triangle::<Fixed>(target, corners.cast(), shading, color) }
}

impl Mesh {
    /// Without a vertex; only positions are there, at the beginning of each.
    pub const NONE: Self = Self {
        size: size_of::<Self>() as u32,
        vertex_count: 0,
        stride: 0,
        position: 0,
        depth: ABSENT,
        shade: ABSENT,
        texture: ABSENT,
        fog: ABSENT,
        slope: ABSENT,
        homogeneous: 0,
        index_bits: 16,
        index_count: 0,
        near_w: 1.0,
        near_w_x: 1 << 16,
        vertices: core::ptr::null(),
        indices: core::ptr::null(),
    };
}

impl Material {
    /// Flat, of colour 0.
    pub const NONE: Self = Self {
        size: size_of::<Self>() as u32,
        shading: 0,
        color: 0,
        cull: 0,
        mapping: 0,
        dither: 0,
        keep_depth: 1,
        u_bits: 0,
        v_bits: 0,
        reserved: 0,
        texels: core::ptr::null(),
        shade_table: core::ptr::null(),
        slope_table: core::ptr::null(),
        fog_table: core::ptr::null(),
        blend_table: core::ptr::null(),
    };
}

/// Makes a mesh of vertices of which nothing is known but their stride.
///
/// # Safety
/// See the header.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn m13_mesh_init(mesh: *mut Mesh, vertices: *const c_void, count: u32, stride: u32) -> c_int {
    if mesh.is_null() || (vertices.is_null() && count > 0) {
        return Refusal::Null as c_int;
    }
    // SAFETY: not null; by the caller there is room.
    unsafe { mesh.write_unaligned(Mesh { vertices, vertex_count: count, stride, ..Mesh::NONE }) };
    code(Ok(()))
}

/// Makes a material of a shading and nothing else.
///
/// # Safety
/// See the header.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn m13_material_init(material: *mut Material, shading: u32) -> c_int {
    if material.is_null() {
        return Refusal::Null as c_int;
    }
    let made = Material { shading, ..Material::NONE };
    // SAFETY: not null; by the caller there is room.
    unsafe { material.write_unaligned(made) };
    code(interpolation(&made).map(|_| ()))
}

/// The bytes that a context takes.
#[unsafe(no_mangle)]
pub extern "C" fn m13_size() -> usize {
    #[cfg(feature = "effects")]
    return crate::effects::BYTES;
    #[cfg(not(feature = "effects"))]
    return 0;
}

/// Makes a context in memory of the caller.
///
/// # Safety
/// See the header.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn m13_init(memory: *mut c_void, bytes: usize, context: *mut *mut c_void) -> c_int {
    if memory.is_null() || context.is_null() {
        return Refusal::Null as c_int;
    }
    #[cfg(feature = "effects")]
    // SAFETY: neither is null.
    return code(unsafe { crate::effects::init(memory, bytes, context) });
    #[cfg(not(feature = "effects"))]
    {
        let _ = bytes;
        Refusal::Unsupported as c_int
    }
}

/// Fills a row with texels.
///
/// # Safety
/// See the header.
#[unsafe(no_mangle)]
#[allow(clippy::too_many_arguments, reason = "the header's")]
pub unsafe extern "C" fn m13_span_texture(
    pixels: *mut u8,
    count: usize,
    texels: *const u8,
    u_bits: u32,
    v_bits: u32,
    u: u32,
    v: u32,
    du: u32,
    dv: u32,
) -> c_int {
    if count == 0 {
        return code(Ok(()));
    }
    #[cfg(feature = "effects")]
    // SAFETY: by the caller.
    return code(unsafe { crate::effects::span(pixels, count, (texels, u_bits, v_bits), [u, v, du, dv]) });
    #[cfg(not(feature = "effects"))]
    {
        let _ = (pixels, texels, u_bits, v_bits, u, v, du, dv);
        Refusal::Unsupported as c_int
    }
}
