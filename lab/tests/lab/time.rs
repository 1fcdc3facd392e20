//! T1, T2: rotation from absolute angles, and E1 (`time/kept.rs`): no frame leaves traces in the next.

mod changes;
mod kept;

use std::f64::consts::TAU;

use crate::support::tried::Tried;
use mode13h::Angle;
use mode13h::glam::Mat3;
use mode13h::integer::{self, BinaryAngle};
use mode13h::mesh::shapes;
use mode13h::raster::Frame;
use mode13h::render::Renderer;
use mode13h::scene::{Object, Scene, Shared};
use mode13h::settings::VertexPath;

/// The steps per frame about x and y, in radians. f64 adds them without rounding, a million times and more, so after n
/// frames the angles are exactly n times the steps.
const STEPS: [f64; 2] = [5.0 / 1024.0, 7.0 / 512.0];

/// Largest difference between an entry of M·Mᵀ and the identity matrix.
fn from_orthonormal(matrix: Mat3) -> f32 {
    let product = (matrix * matrix.transpose()).to_cols_array();
    product
        .into_iter()
        .zip(Mat3::IDENTITY.to_cols_array())
        .fold(0.0, |most, (is, should)| (is - should).abs().max(most))
}

/// The matrix of the integer path, whose angles are rounded to 65,536ths of a turn. A 16.16 number up to 1 fits an f32.
fn turn_in_16_16(angles: [f64; 3]) -> Mat3 {
    let steps = angles.map(|angle| BinaryAngle::from(((angle / TAU).rem_euclid(1.0) * 65_536.0).round() as u32 as u16));
    Mat3::from_cols_array_2d(&integer::turn(steps).map(|row| row.map(|c| c.to_bits() as f32 / 65_536.0)))
}

/// Frames of a mesh rotated step by step, drawn in sequence by one renderer; and each of them drawn directly, with a
/// renderer, a scene and bytes that have seen no other frame.
fn rotation(tried: &mut Tried, path: VertexPath) {
    const WIDTH: u32 = 64;
    const HEIGHT: u32 = 40;
    fn draw(renderer: &mut Renderer, scene: &Scene, bytes: &mut [u8]) {
        let frame = Frame::new(bytes, WIDTH, HEIGHT, WIDTH as usize).expect("a legal frame");
        renderer.draw_frame(scene, frame, (5, 6)).expect("a legal scene");
    }
    let fresh = || crate::support::scenes::by_path(path);
    let mesh = Shared::new(shapes::torus(8, 6));
    let (mut renderer, mut scene) = (fresh(), crate::support::scenes::framed(mesh.clone()));
    let mut bytes = [0; (WIDTH * HEIGHT) as usize];
    // An ordinary step, whose sums are rounded.
    let step = 0.013_7;
    let mut drifting = Object::new(shapes::cube());
    let (mut n, mut moved) = (0_u32, 0_u32);
    while tried.more() {
        n += 1;
        scene.objects_mut()[0].rotate_x(Angle::from_radians(STEPS[0]));
        scene.objects_mut()[0].rotate_y(Angle::from_radians(STEPS[1]));
        let before = bytes;
        draw(&mut renderer, &scene, &mut bytes);
        moved += u32::from(bytes != before);

        let mut at_once = crate::support::scenes::framed(mesh.clone());
        at_once.objects_mut()[0].angles =
            [f64::from(n) * STEPS[0], f64::from(n) * STEPS[1], 0.0].map(Angle::from_radians);
        let mut expected = [n as u8; (WIDTH * HEIGHT) as usize];
        draw(&mut fresh(), &at_once, &mut expected);
        let differ = bytes.iter().zip(&expected).filter(|(is, should)| is != should).count();
        tried.worst("bytes that differ", differ as f64);
        assert_eq!(differ, 0, "bytes of frame {n} that differ, {path}");

        let (off, limit) = match path {
            VertexPath::Float => (from_orthonormal(scene.objects()[0].rotation()), 1e-6),
            _ => {
                (from_orthonormal(turn_in_16_16(scene.objects()[0].angles.map(Angle::to_radians))), f32::powi(2.0, -13))
            }
        };
        tried.worst("from orthonormal", f64::from(off));
        assert!(off <= limit, "frame {n}, {path}: {off:e} from orthonormal");

        // Each of n additions is rounded to half a unit in the last place of a number below 2¹⁴: 2⁻⁴⁰.
        drifting.rotate_y(Angle::from_radians(step));
        let drift = (drifting.angles[1].to_radians() - f64::from(n) * step).abs();
        tried.worst("radians of drift", drift);
        assert!(drift <= f64::from(n) * f64::powi(2.0, -40), "frame {n}: {drift:e} radians");
    }
    assert!(moved > n / 10 * 9, "{moved} of {n} frames are unlike those before them");
}

#[test]
fn t1_many_steps_are_one_angle() {
    rotation(&mut Tried::new("t1_many_steps_are_one_angle", 2000), VertexPath::Float);
}

#[test]
fn t1_many_steps_on_the_integer_path() {
    rotation(&mut Tried::new("t1_many_steps_on_the_integer_path", 2000), VertexPath::Integer);
}

#[test]
#[ignore = "the long run: a million frames"]
fn t1_long_a_million_frames() {
    rotation(&mut Tried::new("t1_long_a_million_frames", 1_000_000), VertexPath::Float);
}

#[test]
#[ignore = "the long run: a million frames"]
fn t1_long_a_million_frames_on_the_integer_path() {
    rotation(&mut Tried::new("t1_long_a_million_frames_on_the_integer_path", 1_000_000), VertexPath::Integer);
}

/// A step of any size rotates by what remains after whole turns, and the same step backwards rotates back.
#[test]
fn t2_any_step_is_defined() {
    // At 90° per second: 900 whole turns.
    let hour = 3600.0 * std::f64::consts::FRAC_PI_2;
    let sizes = [0.0, f64::MIN_POSITIVE, 1e-300, 0.3, 1.0, 7.0, 3600.0, hour, 1e9, 1e15, 1e300, f64::MAX];
    let mut tried = Tried::new("t2_any_step_is_defined", 2 * sizes.len() as u64);
    let turned = |steps: &[f64]| {
        let mut scene = crate::support::scenes::framed(shapes::cube());
        scene.objects_mut()[0].rotate_x(Angle::from_radians(0.4));
        steps.iter().for_each(|step| scene.objects_mut()[0].rotate_y(Angle::from_radians(*step)));
        crate::support::scenes::frame(&scene)
    };
    let first = turned(&[]);
    for step in sizes.into_iter().flat_map(|size| [size, -size]) {
        let there = turned(&[step]);
        // Sine and cosine discard whole turns, exact to the last bit of an angle of any size.
        let left = step.sin().atan2(step.cos());
        assert!(there == turned(&[left]), "{step:e} is {left}");
        assert_eq!(there == first, left.abs() < 1e-9, "{step:e} is seen");
        assert!(turned(&[step, -step]) == first, "{step:e}, there and back");
        tried.add(1);
    }
}
