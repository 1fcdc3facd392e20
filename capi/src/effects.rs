//! Textures, light by a table, fog and translucency, in the caller's memory.

use core::ffi::c_void;

use mode13h::fixed::U8F8;
use mode13h::internals::HAS_F64;
use mode13h::internals::raster::effects::{Attributes, EffectBatch, PixelPipeline, ShadeSource, TextureStage};
use mode13h::internals::span::texture::{Texels, fill_affine};
use mode13h::raster::{Frame, Interpolation, Raster};
use mode13h::settings::{DitherPattern, Mapping};

use crate::abi::{Material, Outcome, Refusal};
use crate::corner::Ready;
use crate::target::{Bytes, Checked};

/// The memory that the stages allocate when they first draw; later they allocate nothing.
const HEAP: usize = if HAS_F64 { 0x2_4000 } else { 0x1_D000 };

/// The size of a context in bytes, if its memory is aligned to 16.
pub(crate) const BYTES: usize = size_of::<Context>() + HEAP;

const MAGIC: u64 = 0x6D31_3363_6F6E_7478;
const TABLE: usize = 65_536;

/// The contents of a context's memory.
#[repr(C, align(16))]
pub(crate) struct Context {
    magic: u64,
    batch: EffectBatch,
    /// A table that leaves each texel as it is in every shade, for textures without light.
    unlit: [u8; TABLE],
}

/// Makes a context, and has the stages allocate their memory.
///
/// # Safety
/// `memory` has this many bytes, and `context` room for a pointer.
pub(crate) unsafe fn init(memory: *mut c_void, bytes: usize, context: *mut *mut c_void) -> Outcome {
    Bytes::new(memory, bytes)?;
    if !memory.addr().is_multiple_of(16) {
        return Err(Refusal::Alignment);
    }
    if bytes < BYTES {
        return Err(Refusal::Short);
    }
    let made = memory.cast::<Context>();
    // SAFETY: aligned, and long enough. The table is filled in place, because stacks may be small.
    unsafe {
        for i in 0..TABLE {
            (&raw mut (*made).unlit).cast::<u8>().add(i).write(i as u8);
        }
        (&raw mut (*made).batch).write(EffectBatch::new());
        let warm = || warm(&mut (*made).batch);
        #[cfg(feature = "library")]
        crate::memory::within(memory.cast::<u8>().add(size_of::<Context>()), HEAP, warm);
        #[cfg(not(feature = "library"))]
        warm();
        (&raw mut (*made).magic).write(MAGIC);
        context.write_unaligned(memory);
    }
    Ok(())
}

/// Draws a first triangle, so that the stages allocate all they need.
fn warm(batch: &mut EffectBatch) {
    let mut pixels = [0];
    let Ok(frame) = Frame::new(&mut pixels, 1, 1, 1) else { return };
    let at = |x, y| mode13h::raster::Vertex::new(x, y, U8F8::default(), 0).unwrap_or_default();
    let [far, near] = [4, 0].map(|pixels: i16| mode13h::fixed::I24F8::from(pixels));
    batch.push(&[at(near, near), at(far, near), at(near, far)], &[Attributes::default(); 3]);
    Raster::new(frame).batch_with_effects(batch, &PixelPipeline::PLAIN);
}

/// A table of 64 KiB; `None` where there is none.
///
/// # Safety
/// `from` is null or holds 64 KiB.
unsafe fn table<'a>(from: *const u8, target: &Checked<'_>) -> Outcome<Option<&'a [u8; TABLE]>> {
    if from.is_null() {
        return Ok(None);
    }
    target.apart_from(Bytes::new(from, TABLE)?)?;
    // SAFETY: by the caller, and nothing is drawn into it.
    Ok(Some(unsafe { &*from.cast::<[u8; TABLE]>() }))
}

/// Texels at an address, and the bytes that they take.
///
/// # Safety
/// `from` is null or holds all texels.
unsafe fn texels<'a>(from: *const u8, u_bits: u32, v_bits: u32) -> Outcome<(Texels<'a>, Bytes)> {
    if u_bits > Texels::MAX_BITS || v_bits > Texels::MAX_BITS {
        return Err(Refusal::Value);
    }
    let length = 1 << (u_bits + v_bits);
    let bytes = Bytes::new(from, length)?;
    // SAFETY: by the caller.
    let slice = unsafe { core::slice::from_raw_parts(from, length) };
    Ok((Texels::new(slice, u_bits, v_bits).map_err(|_| Refusal::Value)?, bytes))
}

/// A row of texels.
///
/// # Safety
/// Pointers are null or as long as stated.
pub(crate) unsafe fn span(
    pixels: *mut u8,
    count: usize,
    (from, u_bits, v_bits): (*const u8, u32, u32),
    [u, v, du, dv]: [u32; 4],
) -> Outcome {
    let row = Bytes::new(pixels, count)?;
    // SAFETY: by the caller.
    let (texels, bytes) = unsafe { texels(from, u_bits, v_bits) }?;
    bytes.apart_from(row)?;
    // SAFETY: not null, and no longer than a slice may be; by the caller nobody else uses them.
    fill_affine(unsafe { core::slice::from_raw_parts_mut(pixels, count) }, texels, u, v, du, dv);
    Ok(())
}

/// A context with what a material needs.
pub(crate) struct Effects<'a> {
    batch: &'a mut EffectBatch,
    pipeline: PixelPipeline<'a>,
}

/// Checks a context. Returns its memory.
///
/// # Safety
/// `context` is null or one that `init` has made.
pub(crate) unsafe fn memory_of(context: *const Context) -> Outcome<Bytes> {
    if context.is_null() || !context.addr().is_multiple_of(16) {
        return Err(Refusal::Context);
    }
    // SAFETY: not null.
    if unsafe { (&raw const (*context).magic).read() } != MAGIC {
        return Err(Refusal::Context);
    }
    Bytes::new(context, BYTES)
}

impl Effects<'_> {
    /// Checks the material.
    ///
    /// # Safety
    /// The context has been checked, and tables and pictures of the material are as long as stated.
    pub(crate) unsafe fn new(
        context: *mut Context,
        target: &Checked<'_>,
        material: &Material,
        interpolation: Interpolation,
    ) -> Outcome<Self> {
        // SAFETY: made by `init`, and nobody else uses it.
        let Context { batch, unlit, .. } = unsafe { &mut *context };
        // SAFETY: by the caller.
        let [shades, slopes, fog, blend] = unsafe {
            [
                table(material.shade_table, target)?,
                table(material.slope_table, target)?,
                table(material.fog_table, target)?,
                table(material.blend_table, target)?,
            ]
        };
        let texture = if material.texels.is_null() {
            None
        } else {
            // SAFETY: by the caller.
            let (texels, bytes) = unsafe { texels(material.texels, material.u_bits, material.v_bits) }?;
            target.apart_from(bytes)?;
            let mapping = match material.mapping {
                0 => Mapping::Affine,
                1 => Mapping::Every16,
                _ => Mapping::Perspective,
            };
            Some(TextureStage { texels, levels: None, mapping, tables: [shades.unwrap_or(unlit); 3] })
        };
        let source = match (slopes, texture.is_some() && shades.is_none()) {
            (Some(slopes), _) => ShadeSource::NormalTable(slopes),
            (None, true) => ShadeSource::Shaded(Interpolation::Flat(255)),
            (None, false) => ShadeSource::Shaded(interpolation),
        };
        let dither = match material.dither {
            0 => None,
            1 => Some(DitherPattern::Ordered.thresholds()),
            2 => Some(DitherPattern::BlueNoise.thresholds()),
            _ => Some(DitherPattern::Ps1.thresholds()),
        };
        let keeps_depth = material.keep_depth == 1;
        let pipeline = PixelPipeline { source, channels: None, dither, texture, fog, blend, keeps_depth };
        Ok(Self { batch, pipeline })
    }

    /// Draws triangles. Returns the counts of spans, and of pixels covered and written.
    pub(crate) fn draw<D: CellOf>(&mut self, raster: &mut D, all: &[[Ready; 3]]) -> [u32; 3] {
        let Self { batch, pipeline } = self;
        let mut sum = [0_u32; 3];
        for corners in all {
            let vertices = corners.each_ref().map(|corner| corner.vertex);
            let attributes = corners.each_ref().map(|corner| Attributes {
                texture: corner.attributes.texture,
                fog: U8F8::from_bits(corner.attributes.fog),
                slope: corner.attributes.slope.map(U8F8::from_bits),
                ..Attributes::default()
            });
            if batch.is_full() {
                raster.draw(batch, pipeline, &mut sum);
            }
            batch.push(&vertices, &attributes);
        }
        raster.draw(batch, pipeline, &mut sum);
        sum
    }
}

/// A rasterizer with cells of either width.
pub(crate) trait CellOf {
    /// Draws a batch, and adds to the counts.
    fn draw(&mut self, batch: &mut EffectBatch, pipeline: &PixelPipeline<'_>, sum: &mut [u32; 3]);
}

macro_rules! cell_of {
    ($($cell:ty)*) => {$(
        impl CellOf for Raster<'_, $cell> {
            fn draw(&mut self, batch: &mut EffectBatch, pipeline: &PixelPipeline<'_>, sum: &mut [u32; 3]) {
                let drawn = self.batch_with_effects(batch, pipeline);
                for (sum, more) in sum.iter_mut().zip([drawn.spans, drawn.covered, drawn.pixels]) {
                    *sum = sum.wrapping_add(more);
                }
            }
        }
    )*};
}

cell_of! { u16 u32 }
