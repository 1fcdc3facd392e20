//! Frames of the conformance crate: the renderer passes on their triangles, and the C interface draws them as lists.

use mode13h::internals::each_triangle;
use mode13h::internals::raster::effects::{EffectBatch, PixelPipeline, ShadeSource};
use mode13h::internals::span::texture::Texels;
use mode13h::raster::{DepthBuffer, Frame, Interpolation, Raster, Vertex};
use mode13h::render::{Renderer, Screen};
use mode13h::settings::{DitherPattern, HiddenSurfaces, Mapping};
use mode13h::span::Kernel;
use mode13h_capi::abi::{Material, OK};
use mode13h_capi::draw::m13_draw_x;
use mode13h_conformance::frames::{self, Shape};

use crate::{Memory, material, mesh, target};

/// A corner in 16.16.
#[derive(Clone, Copy)]
#[repr(C)]
struct Corner {
    x: i32,
    y: i32,
    depth: u32,
    shade: i32,
    texture: [i32; 2],
    fog: i32,
    slope: [i32; 2],
}

/// Triangles that are drawn by one material, with the memory of their texels.
struct Run {
    material: Material,
    texels: Vec<u8>,
    corners: Vec<Corner>,
}

fn shading(interpolation: Interpolation) -> Option<(u32, u32)> {
    Some(match interpolation {
        Interpolation::Flat(index) => (0, index.into()),
        Interpolation::Gouraud88Reseeded => (1, 0),
        Interpolation::Gouraud88 => (2, 0),
        Interpolation::Gouraud1616 => (3, 0),
        Interpolation::GouraudHyperbolic => (4, 0),
        _ => return None,
    })
}

/// All texels of a picture.
fn all_texels(texels: Texels<'_>) -> Vec<u8> {
    let rows = 0..texels.height() as u32;
    rows.flat_map(|v| (0..texels.width() as u32).map(move |u| texels.at(u << 16, v << 16))).collect()
}

/// A pipeline as a material, and its texels; `None` if it uses a feature that the C interface does not offer.
fn material_of(pipeline: &PixelPipeline<'_>) -> Option<(Material, Vec<u8>)> {
    let mut made = match pipeline.source {
        ShadeSource::Shaded(interpolation) => {
            let (shading, color) = shading(interpolation)?;
            Material { color, ..material(shading) }
        }
        ShadeSource::NormalTable(table) => Material { slope_table: table.as_ptr(), ..material(1) },
        _ => return None,
    };
    if pipeline.channels.is_some() {
        return None;
    }
    if let Some(dither) = pipeline.dither {
        let is = |pattern: &DitherPattern| core::ptr::eq(pattern.thresholds().row(0), dither.row(0));
        made.dither = 1 + DitherPattern::ALL.iter().position(is)? as u32;
    }
    let mut texels = Vec::new();
    if let Some(stage) = pipeline.texture {
        if stage.levels.is_some() {
            return None;
        }
        texels = all_texels(stage.texels);
        (made.u_bits, made.v_bits) = (stage.texels.width().ilog2(), stage.texels.height().ilog2());
        made.mapping = match stage.mapping {
            Mapping::Affine => 0,
            Mapping::Every16 => 1,
            _ => 2,
        };
        made.shade_table = stage.tables[0].as_ptr();
    }
    made.fog_table = pipeline.fog.map_or(core::ptr::null(), |table| table.as_ptr());
    made.blend_table = pipeline.blend.map_or(core::ptr::null(), |table| table.as_ptr());
    made.keep_depth = pipeline.keeps_depth.into();
    Some((made, texels))
}

/// Returns whether two materials draw the same. Texels are compared by the object they belong to.
fn is_alike(a: &Material, b: &Material) -> bool {
    let numbers = |m: &Material| [m.shading, m.color, m.cull, m.mapping, m.dither, m.keep_depth, m.u_bits, m.v_bits];
    let tables = |m: &Material| [m.shade_table, m.slope_table, m.fog_table, m.blend_table];
    numbers(a) == numbers(b) && tables(a) == tables(b)
}

/// Every frame that the C interface can draw has the bytes and depths of the engine's raster, through lists of 16.16.
#[test]
fn frames_have_the_bytes_of_the_raster() {
    let (memory, mut batch) = (Memory::new(), EffectBatch::new());
    let (mut drawn, mut as_expected, mut left_out, mut with_effects) = (0, 0, 0, 0);
    let step = std::env::var("MODE13H_STEP").ok().and_then(|step| step.parse().ok()).unwrap_or(7);
    for frame in frames::all().iter().step_by(step) {
        let picture = frame.picture();
        let Shape::Vga = picture.shape else { continue };
        let mut renderer = Renderer::new();
        renderer.settings = picture.settings;
        renderer.settings.hidden_surfaces = Some(HiddenSurfaces::DepthBuffer);
        let usual = frame.draw(Kernel::default()).expect("drawn");
        let background = picture.scene.background;
        let (mut should, mut should_depths) = (vec![background; 320 * 200], vec![0_u32; 320 * 200]);
        let mut runs: Vec<Run> = Vec::new();
        let mut is_offered = true;
        let mut last = None;
        each_triangle(&mut renderer, &picture.scene, Screen::MODE_13H, &mut |triangle| {
            let of = match triangle.effects {
                Some(effects) => material_of(effects.pipeline),
                None => shading(triangle.interpolation)
                    .map(|(shading, color)| (Material { color, ..material(shading) }, Vec::new())),
            };
            let Some((material, texels)) = of else {
                is_offered = false;
                return;
            };
            // The engine draws the triangles directly.
            let canvas = Frame::new(&mut should, 320, 200, 320).expect("a frame");
            let depth = DepthBuffer::new(&mut should_depths, &canvas).expect("depths");
            let mut raster = Raster::new(canvas).with_depth(depth);
            match triangle.effects {
                None => drop(raster.triangle(triangle.vertices, triangle.interpolation)),
                Some(effects) => {
                    batch.push(triangle.vertices, effects.attributes);
                    raster.batch_with_effects(&mut batch, effects.pipeline);
                }
            }
            let attributes = triangle.effects.map_or_else(Default::default, |effects| *effects.attributes);
            let same = last == Some(triangle.object)
                && runs.last().is_some_and(|run| is_alike(&run.material, &material) && run.texels == texels);
            if !same {
                runs.push(Run { material, texels, corners: Vec::new() });
            }
            last = Some(triangle.object);
            let Some(run) = runs.last_mut() else { return };
            let corner = |(vertex, attributes): (&Vertex, &mode13h::internals::raster::effects::Attributes)| Corner {
                x: vertex.x().to_bits() << 8,
                y: vertex.y().to_bits() << 8,
                depth: vertex.depth(),
                shade: i32::from(vertex.shade().to_bits()) << 8,
                texture: attributes.texture,
                fog: i32::from(attributes.fog.to_bits()) << 8,
                slope: attributes.slope.map(|slope| i32::from(slope.to_bits()) << 8),
            };
            run.corners.extend(triangle.vertices.iter().zip(&attributes).map(corner));
        })
        .expect("a scene that can be drawn");
        if !is_offered {
            left_out += 1;
            continue;
        }
        let (mut pixels, mut depths) = (vec![background; 320 * 200], vec![0_u32; 320 * 200]);
        let mut canvas = target(&mut pixels, 320, 200, 320);
        (canvas.depth, canvas.depth_bytes, canvas.depth_bits) = (depths.as_mut_ptr().cast(), 4 * 64_000, 32);
        for run in &runs {
            let mut mesh = mesh(&run.corners);
            (mesh.depth, mesh.shade, mesh.texture, mesh.fog, mesh.slope) = (8, 12, 16, 24, 28);
            let texels = if run.texels.is_empty() { core::ptr::null() } else { run.texels.as_ptr() };
            let material = Material { texels, ..run.material };
            // SAFETY: the structs are valid, and so is the memory they name.
            let code = unsafe { m13_draw_x(&canvas, &mesh, &material, memory.context, core::ptr::null_mut()) };
            assert_eq!(code, OK, "{}", frame.name);
        }
        assert!(depths == should_depths, "{}: depths differ", frame.name);
        let differing = pixels.iter().zip(&should).filter(|(is, should)| is != should).count();
        assert_eq!(differing, 0, "{}: pixels differ", frame.name);
        drawn += 1;
        with_effects += usize::from(runs.iter().any(|run| !run.texels.is_empty() || !run.material.fog_table.is_null()));
        // Most frames depend neither on the hidden-surface method nor on the order of glass, so they have the hash of
        // the frame list.
        as_expected += usize::from(usual.pixels == pixels && Some(usual.hash) == frame.expected());
    }
    println!("{drawn} frames, {with_effects} with textures or fog; {as_expected} have their hash; {left_out} left out");
    assert!(drawn > 30 && with_effects > 5 && as_expected > drawn / 2);
}
