//! The cases to be timed.

use std::rc::Rc;

use allocation_counter::measure;
use mode13h::Angle;
use mode13h::fixed::{I24F8, U8F8};
use mode13h::glam::Vec3;
use mode13h::light::Light;
use mode13h::mesh::{Mesh, shapes};
use mode13h::raster::{Frame, Interpolation, Raster, Vertex};
use mode13h::render::Renderer;
use mode13h::scene::{Camera, Object, Scene, Shared};
use mode13h::settings::HiddenSurfaces;
use mode13h::vga::Vga;
use mode13h_conformance::Random;

/// One kind of frame, drawn again and again.
pub(crate) struct Case {
    /// The quantity that it grows with.
    pub(crate) x: f64,
    /// Number of faces or triangles in a frame.
    pub(crate) units: f64,
    /// Number of frames timed together.
    pub(crate) repeats: u32,
    /// Nanoseconds per frame, one figure for each round.
    pub(crate) times: Vec<f64>,
    frame: Box<dyn FnMut() -> u64>,
    /// Number of pixels written in the previous frame.
    pub(crate) pixels: u64,
}

impl Case {
    fn new(x: f64, units: f64, frame: impl FnMut() -> u64 + 'static) -> Self {
        Self { x, units, repeats: 1, times: Vec::new(), frame: Box::new(frame), pixels: 0 }
    }

    /// Draws a frame.
    pub(crate) fn draw(&mut self) -> u64 {
        self.pixels = (self.frame)();
        self.pixels
    }
}

/// A sphere, and the memory that it takes.
pub(crate) struct Sphere {
    pub(crate) faces: u64,
    mesh: Shared<Mesh>,
    /// Bytes of the mesh, the peak while it was built, bytes of an object with it, and of a renderer that has drawn it.
    bytes: [u64; 4],
}

impl Sphere {
    fn new(faces: f64) -> Self {
        // 2·slices·(stacks − 1) faces, twice as many slices as stacks.
        let stacks = (faces / 4.0).sqrt().round() as u32;
        let mut mesh = None;
        let of_mesh = measure(|| mesh = Some(Shared::new(shapes::sphere(2 * stacks, stacks + 1))));
        let mesh = mesh.expect("it was made");
        let mut scene = None;
        let of_object = measure(|| scene = Some(showing(&mesh)));
        let (mut scene, mut vga) = (scene.expect("it was made"), Vga::new());
        let mut renderer = renderer();
        let of_renderer = measure(|| {
            for _ in 0..2 {
                draw(&mut renderer, &mut scene, &mut vga);
            }
        });
        let kept = |bytes: i64| bytes.max(0) as u64;
        let bytes = [
            kept(of_mesh.bytes_current),
            of_mesh.bytes_max,
            kept(of_object.bytes_current),
            kept(of_renderer.bytes_current),
        ];
        Self { faces: mesh.triangles().len() as u64, mesh, bytes }
    }

    /// Bytes per face: of the mesh, while it was built, of an object with it, and of a renderer that has drawn it.
    pub(crate) fn bytes_a_face(&self) -> [f64; 4] {
        self.bytes.map(|bytes| bytes as f64 / self.faces as f64)
    }
}

/// Spheres of 10³ to `most` faces, two for each power of ten.
pub(crate) fn spheres(most: u64) -> Vec<Sphere> {
    // 10^(7/2) faces and the like, but whole powers as they are; a thousandth for the rounding of stacks.
    let steps = (0..=8).map(|half| 10_f64.powf(3.0 + f64::from(half) / 2.0));
    steps.take_while(|faces| *faces <= most as f64 * 1.001).map(Sphere::new).collect()
}

fn showing(mesh: &Shared<Mesh>) -> Scene {
    let mut scene = Scene::new();
    scene.camera = Camera::framing(Vec3::ZERO, mesh.bounds().radius);
    scene.add(Object::new(Shared::clone(mesh)).centred());
    scene.add_light(Light::sun([0.4, 0.6, 1.0]));
    scene
}

/// A renderer that uses a depth buffer, as most models need, even though a sphere is convex.
fn renderer() -> Renderer {
    let mut renderer = Renderer::new();
    renderer.settings.hidden_surfaces = Some(HiddenSurfaces::DepthBuffer);
    renderer
}

/// Turns the object a little, so that nothing can be reused from the previous frame, and draws it.
fn draw(renderer: &mut Renderer, scene: &mut Scene, vga: &mut Vga) -> u64 {
    turn(scene);
    renderer.draw(scene, vga).expect("a legal scene").raster.pixels.into()
}

fn turn(scene: &mut Scene) {
    let [x, y, z] = scene.objects()[0].angles;
    scene.objects_mut()[0].angles = [x, y + Angle::from_radians(0.01), z];
}

/// Spheres that fill the screen; the more faces they have, the smaller these are.
pub(crate) fn faces(spheres: &[Sphere]) -> Vec<Case> {
    let of = |sphere: &Sphere| {
        let (mut renderer, mut scene, mut vga) = (renderer(), showing(&sphere.mesh), Vga::new());
        let faces = sphere.faces as f64;
        Case::new(faces, faces, move || draw(&mut renderer, &mut scene, &mut vga))
    };
    spheres.iter().map(of).collect()
}

/// Cases on square frames whose size grows with the number of faces, so that each face drawn has four pixels.
pub(crate) fn faces_of_equal_size(spheres: &[Sphere]) -> Vec<Case> {
    const PIXELS: f64 = 4.0;
    let draw = |side: usize, bytes: &mut [u8], renderer: &mut Renderer, scene: &mut Scene| {
        turn(scene);
        let frame = Frame::new(bytes, side as u32, side as u32, side).expect("a legal frame");
        renderer.draw_frame(scene, frame, (1, 1)).expect("a legal scene")
    };
    let mut cases = Vec::new();
    for sphere in spheres {
        let (mut renderer, mut scene) = (renderer(), showing(&sphere.mesh));
        // The share of a frame that the sphere covers, measured on a small frame.
        let stats = draw(256, &mut vec![0; 256 * 256], &mut renderer, &mut scene);
        let share = f64::from(stats.raster.pixels) / (256.0 * 256.0);
        let side = (stats.drawn as f64 * PIXELS / share).sqrt().round() as usize;
        // The rasterizer takes no wider frames.
        if side > 4096 {
            break;
        }
        let mut bytes = vec![0; side * side];
        let faces = sphere.faces as f64;
        cases.push(Case::new(faces, faces, move || {
            draw(side, &mut bytes, &mut renderer, &mut scene).raster.pixels.into()
        }));
    }
    cases
}

/// Triangles, all of one size, scattered over the screen: the rasterizer alone.
pub(crate) fn pixels() -> Vec<Case> {
    let sizes = [0.1, 0.3, 1.0, 3.0, 10.0, 30.0, 100.0, 300.0, 1e3, 3e3, 1e4, 3e4, 6.4e4];
    let of = |pixels: f64| {
        // Right-angled, as wide to its height as twice the screen; the largest has the whole screen in it. In pixels.
        let (width, height) = (Vga::WIDTH as f64, Vga::HEIGHT as f64);
        let part = if pixels < 0.5 * width * height { (pixels / (2.0 * width * height)).sqrt() } else { 1.0 };
        let (w, h) = (2.0 * width * part, 2.0 * height * part);
        let count = (2e5 / pixels).clamp(20.0, 4_000.0) as usize;
        let mut random = Random::again(1);
        let mut scattered = |room: f64| room.max(0.0) * random.unit();
        let at = |x: f64, y: f64, shade: u8| {
            let pixels = |p: f64| I24F8::round_from_f32(p as f32).expect("a place on the screen");
            Vertex::new(pixels(x), pixels(y), U8F8::from_intensity(f32::from(shade) / 255.0, 0, 256), 1).expect("legal")
        };
        let triangles: Vec<[Vertex; 3]> = (0..count)
            .map(|_| {
                let (x, y) = (scattered(width - w), scattered(height - h));
                [at(x, y, 20), at(x, y + h, 120), at(x + w, y, 230)]
            })
            .collect();
        let mut bytes = vec![0; Vga::WIDTH * Vga::HEIGHT];
        let frame = move || {
            let frame = Frame::new(&mut bytes, Vga::WIDTH as u32, Vga::HEIGHT as u32, Vga::WIDTH).expect("legal");
            let all = triangles.iter().map(|triangle| (triangle, Interpolation::Gouraud88Reseeded));
            Raster::new(frame).triangles(all).pixels.into()
        };
        Case::new(pixels, count as f64, frame)
    };
    sizes.into_iter().map(of).collect()
}

/// Sun number `i`, from somewhere in front.
pub(crate) fn sun(i: u32) -> Light {
    let angle = f64::from(i) as f32;
    Light::sun([angle.cos(), angle.sin(), 1.0]).with_intensity(0.1)
}

/// Lamp number `i`, beside the object and reaching all of it.
pub(crate) fn lamp(i: u32) -> Light {
    let angle = f64::from(i) as f32;
    Light::lamp([2.0 * angle.cos(), 2.0 * angle.sin(), 2.0], 20.0).with_intensity(0.1)
}

/// A sphere of 10⁴ faces under more and more lights.
pub(crate) fn lights(light: fn(u32) -> Light) -> Vec<Case> {
    let sphere = Rc::new(Sphere::new(1e4));
    let of = |count: u32| {
        let (mut renderer, mut vga) = (renderer(), Vga::new());
        let mut scene = showing(&sphere.mesh);
        scene.clear_lights();
        for i in 0..count {
            scene.add_light(light(i));
        }
        Case::new(count.into(), 1.0, move || draw(&mut renderer, &mut scene, &mut vga))
    };
    [1, 2, 4, 8, 16, 32, 64].into_iter().map(of).collect()
}
