//! Triangles, one at a time and in lists.

use core::ffi::{c_int, c_void};

use mode13h::raster::{DrawStats, Interpolation, Raster, Vertex as Projected, VertexTable};

use crate::abi::{ABSENT, Material, Mesh, Outcome, Refusal, Sized32, Stats, Target, Vertex, VertexX, code, read};
use crate::clip::{Progress, clip, doubled_area};
#[cfg(feature = "effects")]
use crate::corner::Ready;
use crate::corner::{Door, Fixed, Floats, Kept, Needs, Source};
use crate::target::{Bytes, Checked, Depth, check};

#[cfg(feature = "effects")]
use crate::effects::{Context, Effects, memory_of};
/// Without effects there is no context.
#[cfg(not(feature = "effects"))]
enum Context {}

/// True where doubles are fast, and the rasterizer sets up eight triangles at a time. Elsewhere it walks down each
/// triangle, however it is called, and the code for lists is left out.
const IS_BATCHED: bool = cfg!(any(
    target_arch = "x86_64",
    target_arch = "aarch64",
    target_arch = "wasm32",
    all(target_arch = "x86", target_feature = "sse2")
));

/// A list of fewer triangles is drawn one by one, because clearing the memory for many would take longer.
const FEW: u32 = 12;

/// The numbers of triangles drawn together and of vertices cached, for long lists and for short ones. A slow machine
/// also has little room on its stack.
const MANY_TOGETHER: usize = 128;
const MANY_REMEMBERED: usize = 512;
const FEW_TOGETHER: usize = 4;
const FEW_REMEMBERED: usize = 16;

/// The shading of a material: its interpolation.
fn interpolation(material: &Material) -> Outcome<Interpolation> {
    Ok(match material.shading {
        0 => Interpolation::Flat(u8::try_from(material.color).map_err(|_| Refusal::Value)?),
        1 => Interpolation::Gouraud88Reseeded,
        2 => Interpolation::Gouraud88,
        3 => Interpolation::Gouraud1616,
        4 => Interpolation::GouraudHyperbolic,
        _ => return Err(Refusal::Value),
    })
}

/// A corner of a list without effects. A build for size uses one type for both kinds of list.
#[cfg(all(feature = "effects", mode13h_small))]
type Plain = Ready;
#[cfg(not(all(feature = "effects", mode13h_small)))]
type Plain = Projected;

/// A rasterizer, whatever the width of its depth cells.
trait Draws {
    /// Draws triangles of vertices in slots.
    fn indexed(&mut self, vertices: &Slots, triangles: &[[u32; 3]], by: Interpolation) -> DrawStats;
    /// Draws one triangle.
    fn one(&mut self, corners: &[Projected; 3], by: Interpolation) -> DrawStats;
}

type Slots = VertexTable<MANY_REMEMBERED>;

macro_rules! draws {
    ($($cell:ty)*) => {$(
        impl Draws for Raster<'_, $cell> {
            fn indexed(&mut self, vertices: &Slots, triangles: &[[u32; 3]], by: Interpolation) -> DrawStats {
                Raster::indexed(self, vertices, triangles, by)
            }

            fn one(&mut self, corners: &[Projected; 3], by: Interpolation) -> DrawStats {
                self.triangle(corners, by)
            }
        }
    )*};
}

draws! { u16 u32 }

/// A batch of pending triangles, whose vertices are cached in slots by their index modulo the number of slots.
struct Indexed<'r> {
    raster: &'r mut dyn Draws,
    interpolation: Interpolation,
    cull: u32,
    vertices: Slots,
    /// The index of each slot's vertex, or `u32::MAX`, which no index reaches, since all are below a 32-bit count.
    names: [u32; MANY_REMEMBERED],
    /// The last batch that used each slot. A vertex stays until its batch is drawn.
    used: [u32; MANY_REMEMBERED],
    turn: u32,
    triangles: [[u32; 3]; MANY_TOGETHER],
    count: usize,
    handed_on: u32,
    drawn: DrawStats,
}

impl Indexed<'_> {
    /// Returns whether a triangle with these corners is culled.
    #[inline(always)]
    fn is_culled(&self, corners: &[Projected; 3]) -> bool {
        let area = doubled_area(corners);
        (self.cull == 1 && area <= 0) || (self.cull == 2 && area >= 0)
    }

    /// Appends the triangle of three slots, unless it is culled.
    #[inline(always)]
    fn take(&mut self, slots: [usize; 3]) {
        let [a, b, c] = slots;
        if self.cull > 0 {
            let at = |slot| self.vertices.get(slot).unwrap_or_default();
            if self.is_culled(&[at(a), at(b), at(c)]) {
                return;
            }
        }
        self.handed_on = self.handed_on.wrapping_add(1);
        (self.used[a], self.used[b], self.used[c]) = (self.turn, self.turn, self.turn);
        // Slots are below 512, the count below 128.
        self.triangles[self.count % MANY_TOGETHER] = [a as u32, b as u32, c as u32];
        self.count += 1;
        if self.count == MANY_TOGETHER {
            self.flush();
        }
    }

    #[inline(never)]
    fn flush(&mut self) {
        let waiting = &self.triangles[..self.count.min(MANY_TOGETHER)];
        self.drawn += self.raster.indexed(&self.vertices, waiting, self.interpolation);
        (self.count, self.turn) = (0, self.turn.wrapping_add(1));
    }

    /// Draws the pending triangles, and then this one.
    fn draw(&mut self, corners: &[Projected; 3]) {
        if self.cull > 0 && self.is_culled(corners) {
            return;
        }
        self.handed_on = self.handed_on.wrapping_add(1);
        self.flush();
        self.drawn += self.raster.one(corners, self.interpolation);
    }

    /// Puts the vertices `named` into their slots. Returns false if one must be clipped or is not a number, or if two
    /// share a slot.
    ///
    /// # Safety
    /// Indices have been checked.
    #[inline(never)]
    unsafe fn make<D: Door>(&mut self, source: &Source, named: [u32; 3], near: Option<D::Wide>) -> bool {
        let slots = named.map(|index| index as usize % MANY_REMEMBERED);
        for (index, slot) in named.into_iter().zip(slots) {
            if self.names[slot] == index {
                continue;
            }
            if self.used[slot] == self.turn {
                self.flush();
            }
            // SAFETY: by the caller.
            let Some(vertex) = (unsafe { source.vertex::<D>(index, near) }) else { return false };
            self.vertices.set(slot, &vertex);
            self.names[slot] = index;
        }
        named.iter().zip(slots).all(|(index, slot)| self.names[slot] == *index)
    }
}

/// Draws a list of triangles that need no effects.
///
/// # Safety
/// The mesh holds what it says, and its indices have been checked.
unsafe fn draw_indexed<D: Door>(
    source: &Source,
    progress: Progress,
    cull: u32,
    raster: &mut dyn Draws,
    interpolation: Interpolation,
) -> [u32; 5] {
    let near = source.near::<D>();
    let mut list = Indexed {
        raster,
        interpolation,
        cull,
        vertices: VertexTable::new(),
        names: [u32::MAX; MANY_REMEMBERED],
        used: [0; MANY_REMEMBERED],
        turn: 1,
        triangles: [[0; 3]; MANY_TOGETHER],
        count: 0,
        handed_on: 0,
        drawn: DrawStats::default(),
    };
    let mut refused = 0;
    for i in 0..source.triangles() {
        // SAFETY: below the number of triangles.
        let named = unsafe { source.indices(i) };
        let [a, b, c] = named;
        let slots = [a as usize % MANY_REMEMBERED, b as usize % MANY_REMEMBERED, c as usize % MANY_REMEMBERED];
        let are_there = (list.names[slots[0]] == a) & (list.names[slots[1]] == b) & (list.names[slots[2]] == c);
        // SAFETY: indices have been checked.
        if are_there || unsafe { list.make::<D>(source, named, near) } {
            list.take(slots);
            continue;
        }
        // SAFETY: as above.
        let alone = named.map(|index| unsafe { source.vertex::<D>(index, near) });
        if let [Some(a), Some(b), Some(c)] = alone {
            // Two of them share a slot.
            list.draw(&[a, b, c]);
            continue;
        }
        // SAFETY: as above.
        let is_drawn = unsafe { clipped::<D, Projected>(source, i, near, progress, &mut |part| list.draw(&part)) };
        refused += u32::from(!is_drawn);
    }
    list.flush();
    let DrawStats { spans, covered, pixels, .. } = list.drawn;
    [list.handed_on, refused, spans, covered, pixels]
}

/// The function that draws triangles once there are enough.
type Flush<'f, K> = dyn FnMut(&[[K; 3]]) -> [u32; 3] + 'f;

/// Pending triangles, drawn once there are enough, and the counts of those already drawn.
struct Waiting<'f, K, const TOGETHER: usize> {
    triangles: [[K; 3]; TOGETHER],
    count: usize,
    cull: u32,
    handed_on: u32,
    drawn: [u32; 3],
    flush: &'f mut Flush<'f, K>,
}

impl<K: Kept, const TOGETHER: usize> Waiting<'_, K, TOGETHER> {
    fn push(&mut self, corners: &[K; 3]) {
        self.triangles[self.count % TOGETHER] = *corners;
        self.take();
    }

    /// Adds the triangle that was written after the last one.
    #[inline(always)]
    fn take(&mut self) {
        if self.cull > 0 {
            let area = doubled_area(&self.triangles[self.count % TOGETHER]);
            if (self.cull == 1 && area <= 0) || (self.cull == 2 && area >= 0) {
                return;
            }
        }
        self.handed_on = self.handed_on.wrapping_add(1);
        self.count += 1;
        if self.count == TOGETHER {
            self.flush();
        }
    }

    #[inline(never)]
    fn flush(&mut self) {
        let drawn = (self.flush)(&self.triangles[..self.count.min(TOGETHER)]);
        for (sum, more) in self.drawn.iter_mut().zip(drawn) {
            *sum = sum.wrapping_add(more);
        }
        self.count = 0;
    }
}

/// Does the work of `gather`, with room for `TOGETHER` triangles and `REMEMBERED` vertices.
///
/// # Safety
/// That of `gather`.
unsafe fn gather_by<D: Door, K: Kept, const TOGETHER: usize, const REMEMBERED: usize>(
    source: &Source,
    progress: Progress,
    cull: u32,
    flush: &mut Flush<'_, K>,
) -> [u32; 5] {
    let near = source.near::<D>();
    let mut waiting =
        Waiting { triangles: [[K::default(); 3]; TOGETHER], count: 0, cull, handed_on: 0, drawn: [0; 3], flush };
    // Cached vertices, by their index. No index is the greatest u32, since all are below a 32-bit count.
    let (mut names, mut made) = ([u32::MAX; REMEMBERED], [K::default(); REMEMBERED]);
    let (is_indexed, mut refused) = (source.is_indexed(), 0);
    for i in 0..source.triangles() {
        // SAFETY: below the number of triangles.
        let [a, b, c] = unsafe { source.indices(i) };
        let mut put = |index: u32, corner: &mut K| {
            let slot = index as usize % REMEMBERED;
            if is_indexed && names[slot] == index {
                *corner = made[slot];
                return true;
            }
            // The slot is empty until the vertex is made.
            names[slot] = u32::MAX;
            // SAFETY: indices have been checked.
            let is_made = unsafe { source.corner::<D, K>(index, near, corner, &mut made[slot]) };
            if is_made {
                names[slot] = index;
            }
            is_made
        };
        // Written straight to its place in the list: no copy, and no load of data just stored in parts.
        let [to_a, to_b, to_c] = &mut waiting.triangles[waiting.count % TOGETHER];
        if put(a, to_a) && put(b, to_b) && put(c, to_c) {
            waiting.take();
        } else {
            // SAFETY: as above.
            let is_drawn = unsafe { clipped::<D, K>(source, i, near, progress, &mut |part| waiting.push(&part)) };
            refused += u32::from(!is_drawn);
        }
    }
    waiting.flush();
    let [spans, covered, pixels] = waiting.drawn;
    [waiting.handed_on, refused, spans, covered, pixels]
}

/// Reads, clips and culls the triangles of a list with effects, and passes them on.
///
/// # Safety
/// The mesh holds what it says, and its indices have been checked.
#[cfg(feature = "effects")]
unsafe fn gather<D: Door, K: Kept>(
    source: &Source,
    progress: Progress,
    cull: u32,
    flush: &mut Flush<'_, K>,
) -> [u32; 5] {
    // SAFETY: by the caller.
    unsafe {
        if IS_BATCHED && source.triangles() >= FEW {
            gather_by::<D, K, MANY_TOGETHER, MANY_REMEMBERED>(source, progress, cull, flush)
        } else {
            gather_by::<D, K, FEW_TOGETHER, FEW_REMEMBERED>(source, progress, cull, flush)
        }
    }
}

/// Clips triangle `i`. Returns false if one of its numbers is invalid or out of range.
///
/// # Safety
/// Its indices have been checked.
#[cold]
#[inline(never)]
unsafe fn clipped<D: Door, K: Kept>(
    source: &Source,
    i: u32,
    near: Option<D::Wide>,
    progress: Progress,
    part: &mut dyn FnMut([K; 3]),
) -> bool {
    // SAFETY: by the caller.
    let corners = unsafe { source.indices(i).map(|index| source.wide::<D, K>(index, near)) };
    let [Some(a), Some(b), Some(c)] = corners else {
        return false;
    };
    clip::<D, K>([a, b, c], near, progress, part);
    true
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

/// Reads, clips and culls a list with few copies, straight into a table of vertices.
type DrawMany = unsafe fn(&Source, Progress, u32, &mut dyn Draws, Interpolation) -> [u32; 5];

/// A [`Door`]'s functions that read, clip and cull a list. They are pointers so that [`draw_by`] is compiled only once.
struct Readers {
    /// Checks that the near plane is a usable number.
    near: fn(&Mesh) -> Outcome,
    few: unsafe fn(&Source, Progress, u32, &mut Flush<'_, Plain>) -> [u32; 5],
    /// The function for long lists, in builds that draw them in batches.
    many: Option<DrawMany>,
    #[cfg(feature = "effects")]
    effects: unsafe fn(&Source, Progress, u32, &mut Flush<'_, Ready>) -> [u32; 5],
}

impl Readers {
    const fn of<D: Door>() -> Self {
        Self {
            near: |mesh| D::near(mesh).map(|_| ()),
            few: gather_by::<D, Plain, FEW_TOGETHER, FEW_REMEMBERED>,
            many: if IS_BATCHED { Some(draw_indexed::<D>) } else { None },
            #[cfg(feature = "effects")]
            effects: gather::<D, Ready>,
        }
    }
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
    // SAFETY: by the caller.
    unsafe { draw_by(&const { Readers::of::<D>() }, target, mesh, material, context, stats) }
}

/// Draws a list that a [`Door`]'s functions read.
///
/// # Safety
/// That of [`draw`].
unsafe fn draw_by(
    readers: &Readers,
    target: *const Target,
    mesh: *const Mesh,
    material: *const Material,
    context: *mut Context,
    stats: *mut Stats,
) -> Outcome {
    // SAFETY: by the caller, and so is all that follows.
    #[cfg_attr(not(feature = "effects"), expect(unused_mut, reason = "there is no context"))]
    let (mut checked, mesh, material) = unsafe { (check(target)?, read(mesh)?, read(material)?) };
    if !stats.is_null() {
        // SAFETY: not null.
        unsafe { read(stats) }?;
    }
    let interpolation = interpolation(&material)?;
    if material.cull > 2 || material.mapping > 2 || material.dither > 3 || material.keep_depth > 1 {
        return Err(Refusal::Value);
    }
    let pointers = [material.texels, material.slope_table, material.fog_table, material.blend_table];
    let wants_effects =
        pointers.iter().any(|table| !table.is_null()) || material.dither > 0 || material.keep_depth == 0;
    if wants_effects {
        #[cfg(not(feature = "effects"))]
        return Err(Refusal::Unsupported);
        // SAFETY: by the caller.
        #[cfg(feature = "effects")]
        checked.add_context(unsafe { memory_of(context) }?)?;
    }
    let [has_texels, has_slopes, has_fog] =
        [material.texels, material.slope_table, material.fog_table].map(|pointer| !pointer.is_null());
    let needs = Needs {
        shade: !matches!(interpolation, Interpolation::Flat(_)) && !has_slopes,
        depth: material.shading == 4 || !matches!(checked.depth, Depth::None) || has_texels && material.mapping != 0,
        texture: has_texels,
        fog: has_fog,
        slope: has_slopes,
    };
    let (source, parts) = Source::new(mesh, needs)?;
    for (pointer, length) in [(mesh.vertices, parts.vertices), (mesh.indices, parts.indices)] {
        if length > 0 {
            checked.apart_from(Bytes::new(pointer, length)?)?;
        }
    }
    if mesh.homogeneous == 1 {
        (readers.near)(&mesh)?;
    }
    // SAFETY: the bytes of the indices are there.
    unsafe { source.check_indices() }?;
    let progress = Progress { shades_on_face: material.shading == 4, texture_on_face: material.mapping != 0 };
    let drawn = if wants_effects {
        #[cfg(not(feature = "effects"))]
        return Err(Refusal::Unsupported);
        #[cfg(feature = "effects")]
        {
            // SAFETY: the context has been checked; the rest by the caller.
            let mut effects = unsafe { Effects::new(context, &checked, &material, interpolation) }?;
            with_raster!(checked, |raster| {
                // SAFETY: the bytes of vertices and indices are there, and indices have been checked.
                unsafe {
                    (readers.effects)(&source, progress, material.cull, &mut |all| effects.draw(&mut raster, all))
                }
            })
        }
    } else {
        with_raster!(checked, |raster| {
            // Tested again so that the compiler sees it.
            if IS_BATCHED
                && let Some(many) = readers.many
                && source.triangles() >= FEW
            {
                // SAFETY: as above.
                unsafe { many(&source, progress, material.cull, &mut raster, interpolation) }
            } else {
                let mut flush = |all: &[[Plain; 3]]| {
                    let mut drawn = DrawStats::default();
                    for corners in all {
                        drawn += raster.triangle(&corners.each_ref().map(|corner| *corner.vertex()), interpolation);
                    }
                    [drawn.spans, drawn.covered, drawn.pixels]
                };
                // SAFETY: as above.
                unsafe { (readers.few)(&source, progress, material.cull, &mut flush) }
            }
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

/// Draws the triangles of a mesh whose numbers are 16.16, without floats.
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
/// `vertices` is null or three of the [`Door`]'s vertices; `target` is as in the header.
unsafe fn triangle<D: Door>(target: *const Target, vertices: *const c_void, shading: u32, color: u32) -> c_int {
    // Position, depth and shade have the same offsets in both structs.
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

/// Draws a triangle of three corners in 16.16, without floats.
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
    /// A mesh without vertices. Vertices have only positions, at the start of each.
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
    /// A flat material of colour 0.
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

/// Makes a mesh from vertices of which only the stride is known.
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

/// Makes a material with a shading and nothing else.
///
/// # Safety
/// See the header.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn m13_material_init(material: *mut Material, shading: u32) -> c_int {
    if material.is_null() {
        return Refusal::Null as c_int;
    }
    let made = Material { shading, ..Material::NONE };
    code(interpolation(&made).map(|_| {
        // SAFETY: not null; by the caller there is room.
        unsafe { material.write_unaligned(made) };
    }))
}

/// The number of bytes that a context needs.
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
