//! Group T: rotation from absolute time.

use super::Group;
use super::random::Random;
use mode13h::Angle;
use mode13h::fixed::I16F16;
use mode13h::hooks;
use mode13h::integer::{self, BinaryAngle};
use mode13h::mesh::shapes;
use mode13h::render::{Renderer, VertexPath};
use mode13h::scene::Scene;
use mode13h::vga::Vga;

/// A matrix from any angles is a rotation, on the 16.16 path too (T1, T2); frame n, drawn after the
/// frames before it, is frame n drawn at once (T1); and after a full turn the 16.16 path's picture is
/// what it was (T3).
///
/// ```
/// let group = mode13h_lab::verify::time(13);
/// assert!(group.passed(), "{:?}", group.failures);
/// ```
#[must_use]
pub fn time(seed: u64) -> Group {
    check(seed, &turned, &|scene, angles| scene.objects_mut()[0].angles = angles.map(Angle::from_radians))
}

/// The matrix of three angles.
type Turn<'a> = &'a dyn Fn([f64; 3]) -> [[f64; 3]; 3];
/// Turns the scene's first object from wherever it is to these angles.
type Pose<'a> = &'a dyn Fn(&mut Scene, [f64; 3]);

fn check(seed: u64, turn: Turn<'_>, pose: Pose<'_>) -> Group {
    let mut group = Group::new("time");
    let mut random = Random::new(seed, "time");
    // From no turn at all to that of a million frames of an hour each, either way round.
    for angle in [0.0, -0.0, 1e-300, 0.025, -0.025, 1e6 * 3600.0, -1e6 * 3600.0] {
        orthonormal(&mut group, turn, [angle, -angle, angle / 3.0], 1e-6);
    }
    for _ in 0..20_000 {
        let most = random.log_uniform(32) as f64;
        orthonormal(&mut group, turn, [0; 3].map(|_| random.around_zero(most)), 1e-6);
        // Whole numbers below 2¹⁶, so that they come through as they are.
        let steps = [0; 3].map(|_| f64::from(random.below(65_536)));
        orthonormal(&mut group, &integer_turn, steps, 1.0 / 8192.0);
    }
    full_turns(&mut group, &mut random);
    frame_at_once(&mut group, &mut random, pose);
    group
}

/// The matrix of the float path; the angles are in radians.
fn turned(angles: [f64; 3]) -> [[f64; 3]; 3] {
    hooks::turn(angles.map(Angle::from_radians))
}

/// The matrix of the 16.16 path; the angles are in 65,536ths of a turn.
fn integer_turn(steps: [f64; 3]) -> [[f64; 3]; 3] {
    let rows = integer::turn(steps.map(|steps| BinaryAngle::from(steps as u16)));
    rows.map(|row| row.map(|c: I16F16| f64::from(c.to_bits()) / 65_536.0))
}

/// T3: any angle, and as many turns more.
fn full_turns(group: &mut Group, random: &mut Random) {
    let mut renderer = Renderer::new();
    renderer.settings.vertex_path = VertexPath::Integer;
    let mut scene = super::framed(shapes::torus(16, 8));
    let mut draw = |steps: [i64; 3]| {
        scene.objects_mut()[0].angles =
            steps.map(|steps| steps as f64 / 65_536.0 * core::f64::consts::TAU).map(Angle::from_radians);
        let mut vga = Vga::new();
        renderer.draw(&scene, &mut vga).map(|_| vga)
    };
    for _ in 0..10 {
        let steps = [0; 3].map(|_| random.within(0, 65_535));
        let turns = [0; 3].map(|_| random.within(-1000, 1000));
        let more = [0, 1, 2].map(|axis| steps[axis] + turns[axis] * 65_536);
        let same = match (draw(steps), draw(more)) {
            (Ok(one), Ok(other)) => one.pixels() == other.pixels(),
            _ => false,
        };
        group.check(same, || format!("t3 angles {steps:?}/65,536: after {turns:?} turns another picture"));
    }
}

/// R·Rᵀ is 1 within the limit, and no axis is reversed.
fn orthonormal(group: &mut Group, turn: Turn<'_>, angles: [f64; 3], limit: f64) {
    let [a, b, c] = turn(angles);
    let dot = |a: [f64; 3], b: [f64; 3]| a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
    let cross = [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
    let ones = [dot(a, a), dot(b, b), dot(c, c), dot(cross, c)];
    let zeros = [dot(a, b), dot(b, c), dot(c, a)];
    let off = ones.map(|x| x - 1.0).into_iter().chain(zeros).map(f64::abs).fold(0.0, |most: f64, off| {
        // NaN is as wrong as can be.
        if off <= most { most } else { off }
    });
    group.check(off <= limit, || format!("t1 angles {angles:?}: no rotation, by {off:e}"));
}

/// 140 frames, four seconds, by one renderer; then some of them by a fresh one.
fn frame_at_once(group: &mut Group, random: &mut Random, pose: Pose<'_>) {
    const FRAMES: u32 = 140;
    let angles = |frame: u32| [0.3, f64::from(frame) * core::f64::consts::TAU / f64::from(FRAMES), 0.1];
    let mut scene = super::framed(shapes::torus(16, 8));
    let (mut renderer, mut vga) = (Renderer::new(), Vga::new());
    let alone = random.below(20);
    for frame in 0..FRAMES {
        pose(&mut scene, angles(frame));
        let drawn = renderer.draw(&scene, &mut vga).is_ok();
        if frame % 20 != alone {
            continue;
        }
        let mut at_once = super::framed(shapes::torus(16, 8));
        at_once.objects_mut()[0].angles = angles(frame).map(Angle::from_radians);
        let mut fresh = Vga::new();
        let drawn = drawn && Renderer::new().draw(&at_once, &mut fresh).is_ok();
        let differ = vga.pixels().iter().zip(fresh.pixels()).filter(|(a, b)| a != b).count();
        group.check(drawn && differ == 0, || {
            format!("t1 frame {frame}: {differ} pixels are not those of it drawn at once")
        });
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rotations_are_rotations() {
        let group = time(1);
        assert_eq!(group.failures, [""; 0]);
        assert!(group.cases > 20_000);
    }

    #[test]
    fn a_matrix_that_grew_is_told() {
        let grown = |angles: [f64; 3]| turned(angles).map(|row| row.map(|c| c * 1.000_001));
        let group = check(1, &grown, &|scene, angles| scene.objects_mut()[0].angles = angles.map(Angle::from_radians));
        assert!(group.failures[0].starts_with("t1 angles [0.0, -0.0, 0.0]: no rotation, by 3"), "{:?}", group.failures);
        let group = check(1, &|_| [[f64::NAN; 3]; 3], &|_, _| {});
        assert!(group.failures[0].ends_with("by NaN"), "{:?}", group.failures);
    }

    /// A product of small steps, each a little short.
    #[test]
    fn a_turn_that_drifts_is_told() {
        let step = |scene: &mut Scene, angles: [f64; 3]| {
            let [x, y, z] = scene.objects()[0].angles.map(Angle::to_radians);
            let next = if x == 0.0 { angles } else { [x, y + core::f64::consts::TAU / 140.0 * 0.999, z] };
            scene.objects_mut()[0].angles = next.map(Angle::from_radians);
        };
        let group = check(1, &turned, &step);
        assert!(group.failures[0].contains("pixels are not those of it drawn at once"), "{:?}", group.failures);
    }
}
