//! Whole frames: transform, light, culling, hidden surfaces, drawing; against Mesa's software OpenGL.

use std::error::Error;
use std::ffi::{CStr, c_char, c_int};
use std::time::Instant;

use mode13h::Angle;
use mode13h::glam::Vec3;
use mode13h::mesh::Mesh;
use mode13h::plan::Effect;
use mode13h::render::{Renderer, Screen};
use mode13h::scene::{Camera, HiddenSurfaces, Scene};
use mode13h::span::Kernel;
use mode13h::vga::Vga;

use crate::timing::{ROUNDS, Times};
use crate::{HEIGHT, WIDTH};

unsafe extern "C" {
    fn peers_mesa_start(width: c_int, height: c_int, projection: *const f32, light: *const f32) -> c_int;
    fn peers_mesa_renderer() -> *const c_char;
    fn peers_mesa_mesh(positions: *const f32, normals: *const f32, indices: *const u32, count: c_int);
    fn peers_mesa_sides(both: c_int);
    fn peers_mesa_frame(modelview: *const f32);
    fn peers_mesa_lit(of_pixels: c_int) -> c_int;
}

/// The towards-light direction of `Scene::showing`.
const LIGHT: [f32; 4] = [0.4, 0.6, 1.0, 0.0];
/// Radius of what is looked at, for all meshes: they are scaled to it by the model's matrix.
const ASPECT: f32 = 4.0 / 3.0;

/// Starts Mesa; gives the name of its renderer.
pub fn start_mesa() -> Result<String, Box<dyn Error>> {
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
    // SAFETY: a matrix of 16 and a vector of 4; called once.
    let name = unsafe {
        if peers_mesa_start(WIDTH as c_int, HEIGHT as c_int, projection.as_ptr(), LIGHT.as_ptr()) != 0 {
            return Err("Mesa does not start".into());
        }
        CStr::from_ptr(peers_mesa_renderer())
    };
    Ok(name.to_string_lossy().into_owned())
}

/// Frames of one mesh that turns.
pub struct Whole {
    /// Frames by us with the depth buffer, by us as planned, by Mesa: seconds each.
    pub times: [Times; 3],
    /// Pixels that are not black, ours and Mesa's.
    pub pixels: [usize; 2],
}

pub fn measure(mesh: &Mesh, kernel: Kernel) -> Result<Whole, Box<dyn Error>> {
    let positions: Vec<[f32; 3]> = mesh.positions().iter().map(|p| p.to_array()).collect();
    let normals: Vec<[f32; 3]> = mesh.normals().iter().map(|n| n.to_array()).collect();
    let indices: &[u32] = mesh.triangles().as_flattened();
    // SAFETY: the arrays outlive the frames drawn here; every index is below the number of positions.
    unsafe {
        peers_mesa_mesh(positions.as_ptr().cast(), normals.as_ptr().cast(), indices.as_ptr(), indices.len() as c_int);
    }
    let mut scene = Scene::showing(mesh.clone());
    scene.camera = Camera::framing(Vec3::ZERO, scene.objects()[0].mesh().bounds().radius);
    let bounds = scene.objects()[0].mesh().bounds();
    let eye = scene.camera.eye;
    // Ours sees the mesh as large as it is from where it fills the frame; Mesa sees it at the unit's size.
    let scale = Scene::default().camera.eye.z / eye.z;
    let mut renderers = [Renderer::new(), Renderer::new()];
    renderers.iter_mut().for_each(|renderer| renderer.settings.kernel = kernel);
    renderers[0].settings.hidden_surfaces = Some(HiddenSurfaces::DepthBuffer);
    // An open mesh shows its other side, too.
    let both = !renderers[0].make_plan(&scene, Screen::MODE_13H)?.is_on(0, Effect::BackFaceCulling);
    // SAFETY: Mesa has been started.
    unsafe { peers_mesa_sides(both.into()) };
    let mut machines = [Vga::new(), Vga::new()];
    let mut times = [const { Times::new() }; 3];
    let mut pixels = [0; 2];
    for round in 0..=ROUNDS {
        // Each renderer sees each pose once, so nothing is kept. The first round warms up.
        let angles = [0.4, 0.6 + 0.01 * round as f64, 0.0];
        scene.objects_mut()[0].angles = angles.map(Angle::from_radians);
        let turn = scene.objects()[0].rotation();
        let mut model = [0.0_f32; 16];
        let offset = turn * -bounds.centre * scale;
        for (column, axis) in [turn.x_axis, turn.y_axis, turn.z_axis].into_iter().enumerate() {
            model[4 * column..4 * column + 3].copy_from_slice(&(axis * scale).to_array());
        }
        model[12..15].copy_from_slice(&offset.to_array());
        model[14] -= Scene::default().camera.eye.z;
        model[15] = 1.0;
        for place in 0..3 {
            let which = (place + round) % 3;
            let started = Instant::now();
            match which {
                0 | 1 => {
                    renderers[which].draw(&scene, &mut machines[which])?;
                }
                // SAFETY: a matrix of 16.
                _ => unsafe { peers_mesa_frame(model.as_ptr()) },
            }
            if round > 0 {
                times[which].push(started.elapsed().as_secs_f64());
            }
        }
        pixels[0] = machines[0].pixels().iter().filter(|&&index| index != 0).count();
        // SAFETY: Mesa has as many pixels.
        pixels[1] = unsafe { peers_mesa_lit((WIDTH * HEIGHT) as c_int) } as usize;
    }
    Ok(Whole { times, pixels })
}
