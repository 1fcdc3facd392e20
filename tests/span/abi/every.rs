//! Every function that uses vectors or assembly, under the rules of the machine: lists of spans, batches, and whole
//! frames, whose vertices, culling, light and budgets cover the rest.
//!
//! Each runs through the trampoline, with all arrays allocated meanwhile, the caller's and the engine's own, at one end
//! of their pages and nothing readable or writable beside them. A fault ends the test program.
//! end of their pages, with nothing readable or writable beside them. A fault ends the test program.

use mode13h::glam::Vec3;
use mode13h::internals::span::channels;
use mode13h::internals::span::curve::curve;
use mode13h::internals::span::depth::Cell;
use mode13h::internals::span::dither::{DitherPattern, fill_dithered, fill_dithered_portable};
use mode13h::internals::span::listed::{self, ListedDepths, ListedSpan};
use mode13h::mesh::Mesh;
use mode13h::raster::{DepthBuffer, DrawStats, Frame, Interpolation, Raster, Rect, Vertex};
use mode13h::render::Renderer;
use mode13h::scene::{Object, Scene};
use mode13h::settings::{Accuracy, HiddenSurfaces, Shading};
use mode13h::span::Kernel;

use super::guarded::{Side, arrays, guarded};
use super::ran;
use crate::support::scenes;
use crate::support::triangles::{triangle, vertex};
use crate::support::tried::Tried;
use mode13h_conformance::Random;

const SIDES: [Side; 2] = [Side::Behind, Side::Before];

/// Checks that `draw` gives the same with each kernel, through the trampoline and with guarded arrays, as with the
/// first.
fn try_kernels<T: PartialEq>(what: &str, random: &mut Random, tried: &mut Tried, draw: impl Fn(Kernel) -> T) {
    let expected = draw(Kernel::PORTABLE);
    for kernel in Kernel::available() {
        for side in SIDES {
            let rubbish = random.one_of(&[u64::MAX, 0, 0x5A96_3CC3_F00F_8118]);
            let mut drawn = None;
            let kept = ran(|| drawn = Some(guarded(side, || draw(kernel))), rubbish);
            if let Err(fault) = kept {
                panic!("{what}, {kernel}: {fault}");
            }
            assert!(drawn.as_ref() == Some(&expected), "{what}, {kernel}, guarded {side:?}: another picture");
            tried.add(1);
        }
    }
}

/// Copies the numbers to a separate array, guarded if others are.
fn own<T: Clone>(numbers: &[T]) -> Box<[T]> {
    numbers.to_vec().into_boxed_slice()
}

/// Spans within this many pixels, including the first and last pixels; in half of the lists each has the offset of its
/// cells.
fn spans(random: &mut Random, pixels: i64) -> (Vec<ListedSpan>, Vec<ListedDepths>) {
    let (count, is_shared) = (random.within(1, 40), random.below(2) == 0);
    (0..count)
        .map(|_| {
            let most = random.one_of(&[4, 8, 20, 150]);
            let length = random.within(0, most).min(pixels);
            let any = random.within(0, pixels - length);
            let at = random.one_of(&[0, any, pixels - length]) as u32;
            let bits = random.next_u64();
            let span = ListedSpan { at, length: length as u32, shade: bits as u16, step: (bits >> 16) as u16 };
            let z = random.within(0, i64::from(u32::MAX)) << 24;
            let dz = random.within(-(1 << 30), 1 << 30);
            (span, ListedDepths { z, dz, at: if is_shared { at } else { any as u32 } })
        })
        .unzip()
}

#[test]
fn s7_lists_keep_the_rules() {
    let mut tried = Tried::new("s7_lists_keep_the_rules", 150 * 3 * 4);
    let mut random = Random::named("s7 lists");
    fn nearer<D: Cell>(
        kernel: Kernel,
        pixels: usize,
        (spans, depths): &(Vec<ListedSpan>, Vec<ListedDepths>),
    ) -> (Box<[u8]>, Vec<D>) {
        let (spans, depths) = (own(spans), own(depths));
        let (mut bytes, mut cells) = (own(&vec![3; pixels]), vec![D::of_depth(1 << 30); pixels]);
        let written = listed::fill_where_nearer(kernel, &mut bytes, &mut cells, &spans, &depths);
        assert!(written as usize <= spans.iter().map(|span| span.length as usize).sum());
        (bytes, cells)
    }
    for _ in 0..150 {
        let pixels = random.log_uniform(10) as i64;
        let list = spans(&mut random, pixels);
        let pixels = pixels as usize;
        try_kernels("a list", &mut random, &mut tried, |kernel| {
            let (mut bytes, spans) = (own(&vec![3; pixels]), own(&list.0));
            listed::fill(kernel, &mut bytes, &spans);
            bytes
        });
        try_kernels("a list with depths", &mut random, &mut tried, |kernel| nearer::<u32>(kernel, pixels, &list));
        try_kernels("with narrow ones", &mut random, &mut tried, |kernel| nearer::<u16>(kernel, pixels, &list));
    }
}

/// Dither, channels, and shades on a parabola.
#[test]
fn s7_rows_keep_the_rules() {
    let mut tried = Tried::new("s7_rows_keep_the_rules", 2 * 200);
    let mut random = Random::named("s7 rows");
    for length in 0..200_usize {
        let bits = random.next_u64();
        let (shade, step, x) = (bits as u16, (bits >> 16) as u16, (bits >> 32) as usize % 64);
        let channel = [0; 3].map(|_| (0..length).map(|_| random.next_u64() as u8).collect::<Vec<u8>>());
        let thresholds = *random.one_of(&DitherPattern::ALL).thresholds().row(random.below(64));
        let parabola = [0.0, -3.0, 0.5].map(|most: f64| (most * random.unit() + random.unit()) as f32);
        try_kernels("a row", &mut random, &mut tried, |kernel| {
            let is_portable = kernel.name() == Kernel::PORTABLE.name();
            let [mut dithered, mut mixed] = [0; 2].map(|_| own(&vec![0; length]));
            let [r, g, b] = channel.each_ref().map(|channel| own(channel));
            let mut shades = own(&vec![0_u16; length]);
            if is_portable {
                fill_dithered_portable(&mut dithered, shade, step, &thresholds, x);
                channels::mix_cube_portable(&mut mixed, &r, &g, &b, &thresholds, x);
            } else {
                fill_dithered(&mut dithered, shade, step, &thresholds, x);
                channels::mix_cube(&mut mixed, &r, &g, &b, &thresholds, x);
            }
            curve(kernel, &mut shades, parabola, 0, 0xFF00);
            (dithered, mixed, shades)
        });
    }
}

/// Triangles of a batch: some in or near a frame, of one size or many, plus those of `support`.
fn triangles(random: &mut Random, (width, height): (i64, i64)) -> Vec<([Vertex; 3], Interpolation)> {
    let some = random.within(1, 128);
    let reach = random.one_of(&[None, Some(200), Some(500), Some(1_500), Some(8_000)]);
    (0..some)
        .map(|_| {
            let interpolation =
                random.one_of(&[Interpolation::Flat(7), Interpolation::Gouraud88, Interpolation::Gouraud88Reseeded]);
            let Some(reach) = reach else { return (triangle(random, width, height), interpolation) };
            // The frame's corners more often than elsewhere.
            let end = random.one_of(&[0, 1]);
            let any = (random.within(0, width * 256), random.within(0, height * 256));
            let (x, y) = random.one_of(&[any, any, (end * width * 256, end * height * 256)]);
            let corner = |_| {
                let (dx, dy) = (random.within(-reach, reach), random.within(-reach, reach));
                vertex(x + dx, y + dy, random.within(0, 0xFF00), random.log_uniform(30) as i64)
            };
            ([0; 3].map(corner), interpolation)
        })
        .collect()
}

fn together<D: Cell>(mut raster: Raster<'_, D>, triangles: &[([Vertex; 3], Interpolation)]) -> DrawStats {
    raster.triangles(triangles.iter().map(|(vertices, interpolation)| (vertices, *interpolation)))
}

fn deep<'a, D: Cell>(
    raster: Raster<'a>,
    triangles: &[([Vertex; 3], Interpolation)],
    (cells, like): (&'a mut [D], &Frame<'_>),
) -> DrawStats {
    together(raster.with_depth(DepthBuffer::new(cells, like).expect("long enough")), triangles)
}

#[test]
fn s7_batches_keep_the_rules() {
    let mut tried = Tried::new("s7_batches_keep_the_rules", 150 * 3 * 4);
    let mut random = Random::named("s7 batches");
    let mut pixels = 0;
    for _ in 0..150 {
        let (width, height) = random.one_of(&[(1, 1), (7, 5), (17, 9), (64, 16), (130, 5), (320, 20)]);
        let pitch = width as usize + random.one_of(&[0, 0, 3]);
        let triangles = triangles(&mut random, (width, height));
        let (width, height) = (width as u32, height as u32);
        let whole = Rect { x0: 0, y0: 0, x1: width, y1: height };
        let clip = random.one_of(&[whole, whole, Rect { x0: width / 3, y0: height / 4, ..whole }]);
        let frame = || own(&vec![3; pitch * (height as usize - 1) + width as usize]);
        for cells in 0..3 {
            let what = ["a batch", "a batch with depths", "a batch with narrow ones"][cells];
            try_kernels(what, &mut random, &mut tried, |kernel| {
                let (mut bytes, mut like, triangles) = (frame(), frame(), triangles.clone());
                let frame = Frame::new(&mut bytes, width, height, pitch).expect("legal");
                let like = Frame::new(&mut like, width, height, pitch).expect("legal");
                let raster = Raster::new(frame).with_kernel(kernel).with_clip(clip);
                let mut wide = vec![0_u32; (width * height) as usize];
                let mut narrow = vec![0_u16; (width * height) as usize];
                let drawn = match cells {
                    0 => together(raster, &triangles),
                    1 => deep(raster, &triangles, (&mut wide, &like)),
                    _ => deep(raster, &triangles, (&mut narrow, &like)),
                };
                (bytes, wide, narrow, drawn)
            });
        }
        pixels += triangles.len();
    }
    assert!(pixels > 5_000, "{pixels} triangles");
}

/// A mesh with any number of vertices and faces, so that its arrays end anywhere in a vector.
fn soup(random: &mut Random) -> Mesh {
    let vertices = random.within(3, 70);
    let positions: Vec<Vec3> =
        (0..vertices).map(|_| Vec3::from([0; 3].map(|_| random.unit() as f32 * 2.0 - 1.0))).collect();
    let faces = random.within(1, 70);
    let corner = |random: &mut Random| random.within(0, vertices - 1) as u32;
    let triangles = (0..faces).map(|_| [corner(random), corner(random), corner(random)]).collect();
    Mesh::new(positions, triangles).expect("a mesh")
}

#[test]
fn s7_frames_keep_the_rules() {
    let mut tried = Tried::new("s7_frames_keep_the_rules", 60 * 4);
    let mut random = Random::named("s7 frames");
    let before = arrays();
    let others = scenes::all();
    for case in 0..60 {
        let (mut scene, is_budget) = match case % 3 {
            0 => (others[case / 3 % others.len()].1.clone(), false),
            _ => (scenes::random(&mut random), case % 2 == 0),
        };
        if case % 3 == 1 {
            for object in scene.objects_mut() {
                *object = Object::new(soup(&mut random));
            }
        }
        let shading = (case % 3 > 0).then(|| random.one_of(&Shading::ALL));
        let way = random.one_of(&[None, Some(HiddenSurfaces::DepthBuffer), Some(HiddenSurfaces::PainterOrder)]);
        let (width, height) = random.one_of(&[(64_u32, 40_u32), (33, 77), (100, 30)]);
        try_kernels(&format!("case {case}, {shading:?}"), &mut random, &mut tried, |kernel| {
            let mut renderer = Renderer::new();
            renderer.kernel = kernel;
            renderer.settings.hidden_surfaces = way;
            if is_budget {
                renderer.settings.accuracy = Some(Accuracy::WithinError(2.0));
            } else if let Some(shading) = shading {
                renderer.settings.accuracy = Some(shading.into());
            }
            // Its own copy, so that the mesh and everything that belongs to it is guarded as well.
            let scene = own_scene(&scene);
            let mut bytes = own(&vec![0; (width * height) as usize]);
            let frame = Frame::new(&mut bytes, width, height, width as usize).expect("legal");
            renderer.draw_frame(&scene, frame, (6, 5)).expect("a legal scene");
            bytes
        });
    }
    let arrays = arrays() - before;
    tried.worst("arrays guarded", arrays as f64);
    assert!(arrays > 10_000, "{arrays} arrays guarded");
}

/// Copies the scene, with its own copies of the meshes.
fn own_scene(scene: &Scene) -> Scene {
    let mut scene = scene.clone();
    for object in scene.objects_mut() {
        let mesh = object.mesh().clone();
        let mut own = Object::new(mesh);
        own.angles = object.angles;
        (own.pivot, own.position, own.scale, own.up_axis) =
            (object.pivot, object.position, object.scale, object.up_axis);
        own.materials.clone_from(&object.materials);
        *object = own;
    }
    scene
}
