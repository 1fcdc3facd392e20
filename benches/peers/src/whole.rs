//! Whole frames: transform, light, culling, hidden surfaces and drawing, compared with Mesa's software OpenGL.

use std::error::Error;
use std::ffi::{CStr, c_char, c_int};

use mode13h::Angle;
use mode13h::glam::{Mat3, Vec3};
use mode13h::mesh::Mesh;
use mode13h::palette::Rgb;
use mode13h::plan::Effect;
use mode13h::render::{Renderer, Screen};
use mode13h::scene::{Camera, Fog, Scene};
use mode13h::settings::{HiddenSurfaces, Mapping};
use mode13h::span::Kernel;
use mode13h::texture::Texture;
use mode13h::vga::Vga;

use crate::drawing::{Material, SIDE_BITS};
use crate::interleaved::times_by;
use crate::thread_time::seconds;
use crate::timing::Times;
use crate::{HEIGHT, WIDTH};

unsafe extern "C" {
    fn peers_mesa_start(
        width: c_int,
        height: c_int,
        projection: *const f32,
        light: *const f32,
        side: c_int,
        texels: *const u8,
    ) -> c_int;
    fn peers_mesa_renderer() -> *const c_char;
    fn peers_mesa_mesh(
        positions: *const f32,
        normals: *const f32,
        texcoords: *const f32,
        indices: *const u32,
        count: c_int,
    );
    fn peers_mesa_stages(both: c_int, textured: c_int, start: f32, end: f32, grey: f32);
    fn peers_mesa_frame(modelviews: *const f32, objects: c_int);
    fn peers_mesa_read(of_pixels: c_int, bytes: *mut u8);
}

/// Direction toward the light in `Scene::showing`.
const LIGHT: [f32; 4] = [0.4, 0.6, 1.0, 0.0];
const ASPECT: f32 = 4.0 / 3.0;
/// The fog's grey level, of 255.
const FOG: u8 = 128;

/// Starts Mesa and returns the name of its renderer, which must be llvmpipe.
pub fn start_mesa(material: &Material) -> Result<String, Box<dyn Error>> {
    let scene = Scene::default();
    let (near, far) = (scene.camera.near, 100.0 * scene.camera.near.max(1.0));
    let f = 1.0 / (scene.camera.field_of_view.to_radians() as f32 / 2.0).tan();
    #[rustfmt::skip]
    let projection = [
        f / ASPECT, 0.0, 0.0, 0.0,
        0.0, f, 0.0, 0.0,
        0.0, 0.0, (far + near) / (near - far), -1.0,
        0.0, 0.0, 2.0 * far * near / (near - far), 0.0,
    ];
    let side = 1 << SIDE_BITS;
    // SAFETY: a matrix of 16, a vector of 4 and as many texels; called once.
    let name = unsafe {
        let (projection, texels) = (projection.as_ptr(), material.texels.as_ptr());
        if peers_mesa_start(WIDTH as c_int, HEIGHT as c_int, projection, LIGHT.as_ptr(), side, texels) != 0 {
            return Err("Mesa does not start".into());
        }
        CStr::from_ptr(peers_mesa_renderer())
    };
    let name = name.to_string_lossy().into_owned();
    // Mesa has other software renderers, which are slower.
    if name.contains("llvmpipe") { Ok(name) } else { Err(format!("Mesa renders by {name}, not by llvmpipe").into()) }
}

/// How a lit mesh's pixels are drawn.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct Stages {
    pub textured: bool,
    pub fogged: bool,
}

impl Stages {
    pub const ALL: [Self; 4] = [
        Self { textured: false, fogged: false },
        Self { textured: true, fogged: false },
        Self { textured: false, fogged: true },
        Self { textured: true, fogged: true },
    ];

    pub fn name(self) -> &'static str {
        match (self.textured, self.fogged) {
            (false, false) => "lit",
            (true, false) => "lit, textured",
            (false, true) => "lit, fogged",
            (true, true) => "lit, textured, fogged",
        }
    }
}

/// The contents of a frame.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Shown {
    /// One mesh, which fills the frame.
    One,
    /// 500 copies of it, side by side, stacked and behind one another, to show the cost per object, however small.
    Crowd,
}

impl Shown {
    /// Number of objects in a crowd across, up and back.
    const CROWD: [usize; 3] = [10, 10, 5];

    /// Positions and sizes of the objects, in radii of what the frame shows.
    fn places(self) -> Vec<(Vec3, f32)> {
        match self {
            Self::One => vec![(Vec3::ZERO, 1.0)],
            Self::Crowd => {
                let [across, up, back] = Self::CROWD;
                let along = |i: usize, n: usize| (2.0 * i as f32 + 1.0) / n as f32 - 1.0;
                let all = (0..back).flat_map(|z| (0..up).flat_map(move |y| (0..across).map(move |x| (x, y, z))));
                all.map(|(x, y, z)| (0.7 * Vec3::new(along(x, across), along(y, up), along(z, back)), 0.05)).collect()
            }
        }
    }
}

/// Frames of one turning mesh, or of many.
pub struct Whole {
    /// Names of ours: the depth buffer with each kernel, and as planned with the two fastest.
    pub names: Vec<String>,
    /// Seconds per frame, ours and then Mesa's.
    pub times: Vec<Times>,
    /// Number of pixels drawn: ours with the depth buffer, and Mesa's.
    pub pixels: [usize; 2],
    /// Mean difference of the pixels that both draw, of 255.
    pub difference: f64,
}

pub fn measure(
    (mesh, shown): (&Mesh, Shown),
    stages: Stages,
    material: &Material,
    kernels: &[Kernel],
    rounds: usize,
) -> Result<Whole, Box<dyn Error>> {
    let positions: Vec<[f32; 3]> = mesh.positions().iter().map(|p| p.to_array()).collect();
    let normals: Vec<[f32; 3]> = mesh.normals().iter().map(|n| n.to_array()).collect();
    let texcoords: Vec<[f32; 2]> = mesh.texcoords().unwrap_or_default().iter().map(|t| t.to_array()).collect();
    assert_eq!(texcoords.len(), positions.len(), "each vertex has texture coordinates");
    let indices: &[u32] = mesh.triangles().as_flattened();
    let mut scene = Scene::showing(mesh.clone());
    let bounds = scene.objects()[0].mesh().bounds();
    scene.camera = Camera::framing(Vec3::ZERO, bounds.radius);
    // Ours sees the mesh at its own size, from where it fills the frame; Mesa sees it scaled to unit size.
    let scale = Scene::default().camera.eye.z / scene.camera.eye.z;
    if stages.textured {
        let grey = |&byte: &u8| Rgb::new(byte, byte, byte);
        let image: Vec<Rgb> = material.texels.iter().map(grey).collect();
        // Rows of a picture run down, but those of the image run up, which is Mesa's order.
        let rows: Vec<Rgb> = image.chunks(1 << SIDE_BITS).rev().flatten().copied().collect();
        let texture = Texture::from_rgb(1 << SIDE_BITS, 1 << SIDE_BITS, &rows)?;
        scene.objects_mut()[0].materials[0].texture = Some(texture.into());
    }
    let places = shown.places();
    if shown == Shown::Crowd {
        let one = scene.objects()[0].clone();
        scene.remove(scene.object_ids()[0]);
        for (place, size) in &places {
            scene.add(one.clone().at(*place * bounds.radius).scaled(*size));
        }
    }
    let eye = scene.camera.eye.z;
    let (start, end) = (eye - bounds.radius, eye + 2.0 * bounds.radius);
    if stages.fogged {
        scene.fog = Some(Fog { color: Rgb::new(FOG, FOG, FOG), start, end });
    }

    // The two fastest kernels draw as planned, too.
    let planned = &kernels[kernels.len().saturating_sub(2)..];
    let of_ours = kernels.iter().map(|kernel| (*kernel, true)).chain(planned.iter().map(|kernel| (*kernel, false)));
    let (mut names, mut ours) = (Vec::new(), Vec::new());
    for (kernel, has_depth) in of_ours {
        let mut renderer = Renderer::new();
        renderer.kernel = kernel;
        renderer.settings.mipmaps = Some(false);
        if has_depth {
            renderer.settings.hidden_surfaces = Some(HiddenSurfaces::DepthBuffer);
            renderer.settings.mapping = Some(Mapping::Perspective);
        }
        names.push(format!("{}, {kernel}", if has_depth { "depth buffer" } else { "as planned" }));
        ours.push((renderer, Box::new(Vga::new())));
    }
    // An open mesh shows its back faces, too.
    let both = !ours[0].0.make_plan(&scene, Screen::MODE_13H)?.objects()[0].is_on(Effect::BackFaceCulling);
    let (start, end) = if stages.fogged { (start * scale, end * scale) } else { (0.0, 0.0) };
    // SAFETY: Mesa has been started; the arrays outlive the frames drawn here, and every index is in range.
    unsafe {
        peers_mesa_mesh(
            positions.as_ptr().cast(),
            normals.as_ptr().cast(),
            texcoords.as_ptr().cast(),
            indices.as_ptr(),
            indices.len() as c_int,
        );
        peers_mesa_stages(both.into(), stages.textured.into(), start, end, f32::from(FOG) / 255.0);
    }

    let (mut posed, mut models) = (None, Vec::new());
    let mut times = times_by(ours.len() + 1, rounds + 1, |round, which| {
        // Each renderer sees each pose once, so nothing is cached.
        if posed.replace(round) != Some(round) {
            let angles = [0.4, 0.6 + 0.01 * round as f64, 0.0].map(Angle::from_radians);
            scene.objects_mut().iter_mut().for_each(|object| object.angles = angles);
            let turn = scene.objects()[0].rotation();
            let of_place =
                |(place, size): &(Vec3, f32)| model(turn, bounds.centre, (*place * bounds.radius, *size), scale);
            models = places.iter().map(of_place).collect::<Vec<[f32; 16]>>();
        }
        seconds(|| match ours.get_mut(which) {
            Some((renderer, vga)) => _ = renderer.draw(&scene, vga).expect("a legal scene"),
            // SAFETY: `models` has this many matrices of 16.
            None => unsafe { peers_mesa_frame(models.as_flattened().as_ptr(), models.len() as c_int) },
        })
    });
    // The first round warms up.
    times.iter_mut().for_each(|times| _ = times.remove(0));
    let times = times.into_iter().map(Times).collect();
    let mut theirs = vec![0; WIDTH * HEIGHT];
    // SAFETY: Mesa has as many pixels.
    unsafe { peers_mesa_read(theirs.len() as c_int, theirs.as_mut_ptr()) };
    let (pixels, difference) = compared(ours[0].1.pixels(), &theirs);
    Ok(Whole { names, times, pixels, difference })
}

/// The column-major matrix that places and scales the mesh as Mesa sees it from the default camera.
fn model(turn: Mat3, centre: Vec3, (place, size): (Vec3, f32), scale: f32) -> [f32; 16] {
    let mut model = [0.0_f32; 16];
    for (column, axis) in [turn.x_axis, turn.y_axis, turn.z_axis].into_iter().enumerate() {
        model[4 * column..4 * column + 3].copy_from_slice(&(axis * size * scale).to_array());
    }
    model[12..15].copy_from_slice(&((place + turn * -centre * size) * scale).to_array());
    model[14] -= Scene::default().camera.eye.z;
    model[15] = 1.0;
    model
}

/// The number of pixels that each draws, and the mean difference of those that both draw. Mesa's lowest row comes
/// first.
fn compared(ours: &[u8], theirs: &[u8]) -> ([usize; 2], f64) {
    let flipped: Vec<u8> = theirs.chunks(WIDTH).rev().flatten().copied().collect();
    let drawn = |bytes: &[u8]| bytes.iter().filter(|byte| **byte != 0).count();
    let both: Vec<f64> =
        ours.iter().zip(&flipped).filter(|(a, b)| **a != 0 && **b != 0).map(|(a, b)| a.abs_diff(*b).into()).collect();
    ([drawn(ours), drawn(&flipped)], both.iter().sum::<f64>() / both.len().max(1) as f64)
}
