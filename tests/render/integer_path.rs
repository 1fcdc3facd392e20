//! The integer vertex path against naive oracles, and against the f32 path.

use crate::support::tried::Tried;
use crate::support::vector::{cross, dot, length, sub, unit};
use mode13h::Angle;
use mode13h::fixed::I16F16;
use mode13h::glam::Vec3;
use mode13h::integer::{
    BinaryAngle, Camera, FixedMesh, IntegerError, Lens, Material, Object, Placement, Sun, Vector, VertexStage, View,
    average_normals, face_normal, turn, unit_vector,
};
use mode13h::mesh::{Mesh, shapes};
use mode13h::palette::Ramp;
use mode13h::raster::{Frame, Interpolation, Raster, Vertex};
use mode13h::scene;
use mode13h::settings::Shading;
use mode13h_conformance::Random;
use num_bigint::BigInt;
use num_rational::BigRational;
use std::f64::consts::TAU;

fn bits(v: [i32; 3]) -> Vector {
    v.map(I16F16::from_bits)
}

fn real(v: Vector) -> [f64; 3] {
    v.map(|c| f64::from(c.to_bits()) / 65_536.0)
}

fn any(random: &mut Random, most: i32) -> i32 {
    random.within(-i64::from(most), i64::from(most)) as i32
}

// ------------------------------------------------------------------ numbers

#[test]
fn every_angles_sine_is_the_nearest() {
    let mut tried = Tried::new("every_angles_sine_is_the_nearest", 65_536);
    for steps in 0..=u16::MAX {
        let angle = BinaryAngle::from(steps);
        let exact = f64::sin(f64::from(steps) * TAU / 65_536.0) * 65_536.0;
        // f64's own error is below 2⁻³⁴ of a unit here.
        assert!((f64::from(angle.sin().to_bits()) - exact).abs() <= 0.5 + 1e-9, "{steps}");
        let quarter = BinaryAngle::from(steps.wrapping_add(0x4000));
        assert_eq!(angle.cos(), quarter.sin());
        let half = angle + BinaryAngle::HALF;
        assert_eq!(half.sin().to_bits(), -angle.sin().to_bits());
        tried.add(1);
    }
    for degrees in -1000..1000_i32 {
        let exact = f64::from(degrees.rem_euclid(360)) / 360.0 * 65_536.0;
        assert_eq!(u32::from(u16::from(BinaryAngle::from_degrees(degrees))), (exact + 0.5).floor() as u32 % 65_536);
    }
}

#[test]
fn n6_unit_vectors_have_length_1() {
    let mut tried = Tried::new("n6_unit_vectors_have_length_1", 200_000);
    let mut random = Random::named("n6 unit");
    while tried.more() {
        let mut component = || any(&mut random, i32::MAX) >> (any(&mut random, 15).unsigned_abs() * 2);
        let v = [component(), component(), component()];
        check_unit(v);
    }
    for odd in [[i32::MIN; 3], [i32::MAX; 3], [1, 0, 0], [1, 1, 1], [i32::MIN, 1, 0], [0, -1, i32::MAX], [3, -4, 0]] {
        check_unit(odd);
    }
    assert_eq!(unit_vector(bits([0; 3])), None);
}

fn check_unit(v: [i32; 3]) {
    let Some(unit) = unit_vector(bits(v)) else { return assert_eq!(v, [0; 3]) };
    let unit = unit.map(I16F16::to_bits);
    // 2⁻¹⁴ of 65,536 is 4 units; `vector::unit` promises one.
    let square: i64 = unit.iter().map(|&c| i64::from(c) * i64::from(c)).sum();
    assert!((65_535 * 65_535..=65_537 * 65_537).contains(&square), "{v:?}: {unit:?}");
    let length = v.iter().map(|&c| f64::from(c) * f64::from(c)).sum::<f64>().sqrt();
    for (c, exact) in unit.iter().zip(v) {
        // Half a unit, and 2⁻²⁸ for the truncation.
        assert!((f64::from(*c) - f64::from(exact) / length * 65_536.0).abs() < 0.501, "{v:?}: {unit:?}");
    }
    if v.iter().all(|&c| c != i32::MIN) {
        let turned = unit_vector(bits(v.map(|c| -c))).expect("not zero").map(I16F16::to_bits);
        assert_eq!(turned, unit.map(|c| -c), "opposite directions cancel");
    }
}

/// A mesh of the crate in 16.16, with coincident vertices merged.
fn welded(mesh: &Mesh) -> (Vec<Vector>, Vec<[u16; 3]>) {
    let fix = |p: &Vec3| p.to_array().map(|c| I16F16::round_from_f64(c.into()).expect("in the unit sphere"));
    let mut positions: Vec<Vector> = Vec::new();
    let mut place = |p: Vector| {
        positions.iter().position(|q| *q == p).unwrap_or_else(|| {
            positions.push(p);
            positions.len() - 1
        }) as u16
    };
    let triangles = mesh.triangles().iter().map(|t| t.map(|i| place(fix(&mesh.positions()[i as usize])))).collect();
    (positions, triangles)
}

#[test]
fn n6_averaged_normals_have_length_1() {
    let mut tried = Tried::new("n6_averaged_normals_have_length_1", 3000);
    for name in shapes::NAMES {
        let (positions, triangles) = welded(&shapes::by_name(name).expect("listed"));
        let mut normals = vec![Vector::default(); positions.len()];
        average_normals(&positions, &triangles, &mut normals).expect("sound");
        for (vertex, normal) in normals.iter().enumerate() {
            let square: i64 = normal.iter().map(|c| i64::from(c.to_bits()).pow(2)).sum();
            assert!((65_535 * 65_535..=65_537 * 65_537).contains(&square), "{name}, {vertex}: {normal:?}");
            // The sum in f64 of the unit normals of the faces that have an area.
            let mut sum = [0.0; 3];
            let mut faces = 0;
            for t in triangles.iter().filter(|t| t.contains(&(vertex as u16))) {
                let [a, b, c] = t.map(|i| real(positions[usize::from(i)]));
                if let Some(normal) = unit(cross(sub(b, a), sub(c, a))) {
                    faces += 1;
                    sum = [0, 1, 2].map(|i| sum[i] + normal[i]);
                }
            }
            let length = sum.iter().map(|c| c * c).sum::<f64>().sqrt();
            for (c, exact) in real(*normal).iter().zip(sum) {
                // Each face's normal is off by half a unit, the sum by all of those, and then by its own rounding.
                let bound = (1.0 + 0.51 * f64::from(faces) * 3.0_f64.sqrt() / length) / 65_536.0;
                assert!((c - exact / length).abs() < bound, "{name}, {vertex}: {c} {}", exact / length);
            }
            tried.add(1);
        }
    }
}

#[test]
fn n2_normals_that_cancel() {
    let mut tried = Tried::new("n2_normals_that_cancel", 4);
    let positions = [[0, 0, 0], [70_000, 13, 0], [5, 80_000, 999], [7, 7, 7]].map(bits);
    // A folded sheet: two faces back to back. Vertex 3 belongs only to a face without area.
    let triangles = [[0_u16, 1, 2], [0, 2, 1], [3, 3, 3]];
    let mut normals = [Vector::default(); 4];
    average_normals(&positions, &triangles, &mut normals).expect("sound");
    let own = face_normal(positions[0], positions[1], positions[2]).expect("it has an area");
    assert_eq!(normals, [own, own, own, bits([0, 0, 65_536])]);
    tried.add(4);
    let needed = IntegerError::Count { what: "normals", given: 3, needed: 4 };
    assert_eq!(average_normals(&positions, &triangles, &mut normals[..3]), Err(needed));
}

#[test]
fn t1_the_turn_stays_orthonormal() {
    let mut tried = Tried::new("t1_the_turn_stays_orthonormal", 1_000_000);
    let mut random = Random::named("t1 integer");
    let check = |tried: &mut Tried, angles: [u16; 3]| {
        let rows = turn(angles.map(BinaryAngle::from)).map(|row| row.map(|c| i64::from(c.to_bits())));
        for i in 0..3 {
            for j in i..3 {
                let product: i64 = (0..3).map(|k| rows[i][k] * rows[j][k]).sum();
                let off = (product - if i == j { 1 << 32 } else { 0 }).abs();
                tried.worst("from orthonormal", off as f64 / 4_294_967_296.0);
                // 2⁻¹³ is required; rounding nine entries gives less than 2⁻¹⁵.
                assert!(off < 1 << (32 - 15), "{angles:?}: rows {i} and {j}");
            }
        }
    };
    // Frame by frame, three axes each at its own speed, then arbitrary angles.
    for frame in 0..500_000_u32 {
        check(&mut tried, [frame, frame.wrapping_mul(3), frame / 7].map(|a| a as u16));
        tried.add(1);
    }
    while tried.more() {
        check(&mut tried, [0; 3].map(|_| random.next_u64() as u16));
    }
}

#[test]
fn the_turn_is_the_f64_turn() {
    let mut tried = Tried::new("the_turn_is_the_f64_turn", 20_000);
    let mut random = Random::named("turn");
    let mut object = scene::Object::new(shapes::cube());
    while tried.more() {
        let steps = [0; 3].map(|_| random.next_u64() as u16);
        let rows = turn(steps.map(BinaryAngle::from)).map(real);
        object.angles = steps.map(|a| f64::from(a) * TAU / 65_536.0).map(Angle::from_radians);
        let exact = object.rotation().transpose().to_cols_array_2d();
        for (row, exact) in rows.iter().flatten().zip(exact.as_flattened()) {
            // 0.501 units, and half of the last bit of the f32 that it is compared with.
            assert!((row - f64::from(*exact)).abs() < 0.51 / 65_536.0, "{steps:?}");
        }
    }
}

// ------------------------------------------------------------------ transform and projection

const MATERIAL: Material = Material { ambient: I16F16::from_bits(0), diffuse: I16F16::ONE, ramp: Ramp::WHOLE };

/// The triangles of a mesh as passed to the raster.
fn triangles(
    view: &View,
    object: Object<'_, u16>,
    suns: &[Sun],
) -> Result<Vec<([Vertex; 3], Interpolation)>, IntegerError> {
    let (mut lit, mut beams) =
        (vec![Default::default(); object.mesh.parts().positions.len()], vec![Default::default(); suns.len()]);
    let stage = VertexStage::new(view, object, suns, Shading::default(), &mut lit, &mut beams)?;
    let mut triangles = Vec::new();
    let faces = stage.faces(|vertices, interpolation| triangles.push((*vertices, interpolation)));
    assert_eq!(faces.drawn, triangles.len() as u64);
    Ok(triangles)
}

/// An eye at the origin that looks along −z: X is x, Y is −y, W is −z, without any rounding.
fn straight_view(width: u32, height: u32, focal: [i32; 2], near: i32) -> View {
    let lens = Lens::with_focal_lengths(width, height, focal.map(I16F16::from_bits)).expect("legal");
    let camera = Camera {
        eye: bits([0; 3]),
        target: bits([0, 0, -65_536]),
        up: bits([0, 65_536, 0]),
        near: I16F16::from_bits(near),
    };
    View::new(&camera, lens).expect("legal")
}

/// No face across the middle of the picture is lost, however near the near plane is: there rounding moves corners that
/// are cut at the guard band by some pixels.
#[test]
fn faces_are_clipped_at_the_least_near_distances() {
    let mut tried = Tried::new("faces_are_clipped_at_the_least_near_distances", 16_000);
    let mut random = Random::named("least near distances");
    let normals = [bits([0, 0, 65_536]); 3];
    while tried.more() {
        let near = random.within(1, 16) as i32;
        let focal = random.one_of(&[270 << 16, 1 << 30, 65_536]);
        let view = straight_view(320, 200, [focal; 2], near);
        let at = [0; 3].map(|_| [any(&mut random, 1_500), any(&mut random, 1_500), any(&mut random, 1_500)]);
        // The view's axis meets the plane at z, and the three areas seen along it have the same sign.
        let [a, b, c] = at.map(|p| p.map(i64::from));
        let area = |p: [i64; 3], q: [i64; 3]| p[0] * q[1] - p[1] * q[0];
        let areas = [area(b, c), area(c, a), area(a, b)];
        let whole: i64 = areas.iter().sum();
        let is_inside = areas.iter().all(|area| area.signum() == whole.signum() && *area != 0);
        let z = |k: usize| areas[k] * [a, b, c][k][2];
        if !is_inside || (z(0) + z(1) + z(2)) / whole > -i64::from(near) - 8 {
            continue;
        }
        let positions = at.map(bits);
        let mesh = FixedMesh::new(&positions, &normals, &[[0_u16, 1, 2]], false).expect("legal");
        let object = Object { mesh, placement: Placement::default(), materials: &[MATERIAL] };
        let drawn = triangles(&view, object, &[]).expect("legal");
        assert!(!drawn.is_empty(), "near {near}, focal {focal}: {at:?}");
        tried.add(1);
    }
}

#[test]
fn r13_the_integer_paths_rounding_against_big_rationals() {
    let mut tried = Tried::new("r13_the_integer_paths_rounding_against_big_rationals", 30_000);
    let mut random = Random::named("r13 integer");
    let normals = [bits([0, 0, 65_536]); 3];
    let mut compared = 0;
    while tried.more() {
        let (width, height) = (random.within(1, 4096) as u32, random.within(1, 4096) as u32);
        let focal = [0; 2].map(|_| (random.log_uniform(31) as i32).min(1 << 30));
        let near = random.log_uniform(20) as i32;
        let view = straight_view(width, height, focal, near);
        let corner = |random: &mut Random| {
            let z = -(random.log_uniform(31) as i32).clamp(near, 0x7FFF_0000);
            // Usually within the surroundings of the picture, and on exact halves of 1/256 pixel, where 512·f·x = odd ·
            // 65,536 · w.
            let most = (i64::from(z) * -4095 * 65_536 / i64::from(focal[0].max(focal[1]))).clamp(1, 0x7FFF_0000) as i32;
            [any(random, most), any(random, most), z].map(|c| c.clamp(-0x7FFF_0000, 0x7FFF_0000))
        };
        let mut corners = [corner(&mut random), corner(&mut random), corner(&mut random)];
        if random.within(0, 1) == 0 {
            // Halves: a power of two for focal length and depth.
            let shift = random.within(10, 24) as u32;
            for corner in &mut corners {
                corner[2] = -(1 << shift);
            }
        }
        let positions = corners.map(bits);
        let mesh = FixedMesh::new(&positions, &normals, &[[0_u16, 1, 2]], false).expect("legal");
        // A mesh in finer units: X, Y and W are each rounded to the nearest 1/65,536, halves upward.
        let finer = random.one_of(&[0, 0, 1, 2, 5]);
        let object =
            Object { mesh: mesh.with_exponent(-finer), placement: Placement::default(), materials: &[MATERIAL] };
        let drawn = triangles(&view, object, &[]).expect("legal");
        let units = |c: i32| ((i64::from(c) << 16) + (1 << (15 + finer))).div_euclid(1 << (16 + finer)) as i32;
        let expected = corners.map(|[x, y, z]| {
            // The axes are right, down and forward.
            let [x, y, z] = [units(x), -units(-y), -units(-z)];
            if -z < near {
                return None;
            }
            let round = |size: u32, focal: i32, c: i32| {
                // x = size/2 + focal · c / (65,536 · −z), floor(256 · x + 1/2).
                let projected = BigRational::new(BigInt::from(focal) * c, BigInt::from(65_536) * -i64::from(z))
                    + BigRational::new(size.into(), 2.into());
                let half = BigRational::new(1.into(), 2.into());
                (projected * BigRational::from_integer(256.into()) + half).floor().to_integer()
            };
            let depth = BigRational::new(BigInt::from(near) << 30, (-i64::from(z)).into());
            Some((round(width, focal[0], x), round(height, focal[1], -y), depth.round().to_integer()))
        });
        let limit = BigInt::from(4096 * 256);
        let [Some(a), Some(b), Some(c)] = expected else { continue };
        let expected = [a, b, c];
        let inside =
            expected.iter().all(|(x, y, _)| x.magnitude() <= limit.magnitude() && y.magnitude() <= limit.magnitude());
        let [(vertices, _)] = &drawn[..] else {
            // Clipped into parts, or without an area.
            continue;
        };
        if inside {
            for (vertex, (x, y, depth)) in vertices.iter().zip(expected) {
                assert_eq!(BigInt::from(vertex.x().to_bits()), x, "{corners:?}");
                assert_eq!(BigInt::from(vertex.y().to_bits()), y, "{corners:?}");
                assert_eq!(BigInt::from(vertex.depth()), depth, "{corners:?}");
            }
            compared += 1;
        }
    }
    assert!(compared > 10_000, "{compared} triangles were compared");
}

/// Arbitrary camera, placement and mesh: every vertex is where f64 says, to within the rounding of the matrix to 16.16
/// and of the transformed vertex to 1/65,536.
#[test]
fn vertices_are_where_f64_has_them() {
    let mut tried = Tried::new("vertices_are_where_f64_has_them", 20_000);
    let mut random = Random::named("integer transform");
    let normals = [bits([0, 0, 65_536]); 3];
    let (mut compared, mut worst) = (0, 0.0_f64);
    while tried.more() {
        let units = |random: &mut Random, most: i32| [0; 3].map(|_| any(random, most * 65_536));
        let (eye, target) = (units(&mut random, 2000), units(&mut random, 2000));
        let up = units(&mut random, 100);
        let steps = [0; 3].map(|_| random.next_u64() as u16);
        let exponent = random.within(-6, 6) as i8;
        // The scene's 1,000 units are this many of the mesh's.
        let most = ((1000 * 64) >> (exponent + 6)).min(32_767);
        let (pivot, scale) = (units(&mut random, most), random.within(1, 2 * 65_536) as i32);
        let corners = [0; 3].map(|_| units(&mut random, most));
        // Near what the eye looks at, so that it is sometimes in the picture.
        let position = [0, 1, 2].map(|i| target[i] + any(&mut random, 300 * 65_536));

        let [e, t, u] = [eye, target, up].map(|v| real(bits(v)));
        let forward = unit(sub(t, e)).expect("two places");
        let right = cross(forward, unit(u).expect("a direction"));
        if dot(right, right) < 0.01 {
            // If up points along the view, little more than rounding is left of it.
            continue;
        }
        let right = unit(right).expect("not along the view");
        let down = cross(forward, right);
        let focal = [330.0, 275.0];
        let lens = Lens::with_focal_lengths(320, 200, focal.map(|f| I16F16::from_int(f as i16))).expect("legal");
        let near = I16F16::ONE;
        let camera = Camera { eye: bits(eye), target: bits(target), up: bits(up), near };
        let Ok(view) = View::new(&camera, lens) else { panic!("{camera:?}") };
        let positions = corners.map(bits);
        let mesh = FixedMesh::new(&positions, &normals, &[[0_u16, 1, 2]], false).expect("legal");
        let placement = Placement {
            position: bits(position),
            pivot: bits(pivot),
            angles: steps.map(BinaryAngle::from),
            scale: I16F16::from_bits(scale),
        };
        let object = Object { mesh: mesh.with_exponent(exponent), placement, materials: &[MATERIAL] };
        let drawn = triangles(&view, object, &[]).expect("within reach");
        let [(vertices, _)] = &drawn[..] else { continue };

        let size = f64::from(scale) / 65_536.0 * f64::from(exponent).exp2();
        let rows = f64_turn(steps);
        let seen = corners.map(|corner| {
            let p = [0, 1, 2].map(|i| (f64::from(corner[i]) - f64::from(pivot[i])) / 65_536.0 * size);
            let far = [0, 1, 2].map(|i| f64::from(position[i] - eye[i]) / 65_536.0);
            let c = [0, 1, 2].map(|i| dot(rows[i], p) + far[i]);
            // The matrix: half a unit of each entry, and a hair, times at most what the scale's mantissa
            // makes of 1. The vertex and the position: half a unit each. The axes and the turn: 2⁻²⁷.
            let sum = p.iter().map(|c| c.abs()).sum::<f64>();
            let off = (0.51 * sum + 1.0) / 65_536.0 + (length(p) + length(far)) / 134_217_728.0;
            ([right, down, forward].map(|axis| dot(axis, c)), off)
        });
        let on_screen = |([x, y, w], off): ([f64; 3], f64)| {
            w - off > 1.0 && (focal[0] * x / w).abs() < 3900.0 && (focal[1] * y / w).abs() < 3900.0
        };
        if !seen.into_iter().all(on_screen) {
            continue;
        }
        for (vertex, ([x, y, w], off)) in vertices.iter().zip(seen) {
            for (got, c, f, middle) in [(vertex.x(), x, focal[0], 160.0), (vertex.y(), y, focal[1], 100.0)] {
                let exact = (middle + f * c / w) * 256.0;
                let bound = 256.0 * f * (off + (c / w).abs() * off) / (w - off) + 0.501;
                let error = (f64::from(got.to_bits()) - exact).abs();
                assert!(error <= bound, "{error} of {bound}: {camera:?} {object:?}");
                worst = worst.max(error / bound);
                compared += 1;
            }
        }
    }
    println!("{compared} coordinates compared, the worst {worst:.3} of its bound");
    assert!(compared > 5000, "{compared} coordinates were compared");
    assert!(worst > 0.3, "the bound is not idle: {worst}");
}

fn f64_turn(steps: [u16; 3]) -> [[f64; 3]; 3] {
    let [(sx, cx), (sy, cy), (sz, cz)] = steps.map(|a| (f64::from(a) * TAU / 65_536.0).sin_cos());
    [
        [cy * cz, -cy * sz, sy],
        [cx * sz + sx * sy * cz, cx * cz - sx * sy * sz, -sx * cy],
        [sx * sz - cx * sy * cz, sx * cz + cx * sy * sz, cx * cy],
    ]
}

/// One vertex, one sun: the shade in exact rationals.
#[test]
fn n4_shades_against_big_rationals() {
    let mut tried = Tried::new("n4_shades_against_big_rationals", 20_000);
    let mut random = Random::named("integer shades");
    let view = straight_view(320, 200, [300 << 16; 2], 65_536);
    let positions = [[0, 0, -1 << 20], [1 << 16, 0, -1 << 20], [0, 1 << 16, -1 << 20]].map(bits);
    while tried.more() {
        // Along the axes, so that directions need no rounding; the face is turned to the eye.
        let axis = random.one_of(&[[0, 0, 1], [0, 0, -1], [0, 1, 0]]);
        let normals = [bits(axis.map(|c| c * 65_536)); 3];
        let mesh = FixedMesh::new(&positions, &normals, &[[0_u16, 1, 2]], false).expect("legal");
        let number = |random: &mut Random| match random.within(0, 4) {
            0 => random.one_of(&[0, 1, -1, 65_536, 32_768, i32::MAX, i32::MIN]),
            1 => any(random, i32::MAX),
            _ => any(random, 1 << 16),
        };
        let (ambient, diffuse) = (number(&mut random), number(&mut random));
        let suns: Vec<(i32, i32)> =
            (0..random.log_uniform(5)).map(|_| (random.one_of(&[1, -1]), number(&mut random))).collect();
        let entries = random.within(1, 256) as u16;
        let first = random.within(0, 256 - i64::from(entries)).min(255) as u8;
        let ramp = Ramp::new(first, entries).expect("within the palette");
        let material = Material { ambient: I16F16::from_bits(ambient), diffuse: I16F16::from_bits(diffuse), ramp };
        let lights: Vec<Sun> = suns
            .iter()
            .map(|&(side, intensity)| Sun {
                direction: bits([0, 0, side * 77_777]),
                intensity: I16F16::from_bits(intensity),
            })
            .collect();
        let object = Object { mesh, placement: Placement::default(), materials: &[material] };
        let drawn = triangles(&view, object, &lights).expect("legal");
        // I = ambient + diffuse · Σ intensity · max(0, cosine), clamped once.
        let mut sum = BigInt::from(0);
        for (side, intensity) in suns {
            sum += i64::from(intensity) * i64::from((side * axis[2]).max(0));
        }
        let one = BigRational::from_integer(BigInt::from(1) << 32);
        let zero = BigRational::from_integer(0.into());
        let whole = BigRational::from_integer(1.into());
        let i = BigRational::from_integer(sum * diffuse + (BigInt::from(ambient) << 16)) / one;
        let i = i.clamp(zero, whole);
        let half = BigRational::new(1.into(), 2.into());
        let above = (i * BigRational::from_integer((i64::from(entries - 1) * 256).into()) + half).floor().to_integer();
        let expected = above + i64::from(first) * 256;
        assert_eq!(BigInt::from(drawn[0].0[0].shade().to_bits()), expected, "{material:?} {lights:?}");
    }
}

/// Faces of the guard band's size, near the eye, where a unit of 1/65,536 is a large part of a vertex's depth: cuts lie
/// on the exact edges, with the shades that the unclipped face has there.
#[test]
fn c1_cuts_lie_on_the_edges_with_their_shades() {
    let mut tried = Tried::new("c1_cuts_lie_on_the_edges_with_their_shades", 10_000);
    let mut random = Random::named("integer cuts");
    let focal = 300.0;
    let view = straight_view(320, 200, [300 << 16; 2], 4096);
    let sun = Sun { direction: bits([0, 0, 1]), intensity: I16F16::ONE };
    let tilted =
        [[0, 0, 1], [1, 0, 0], [0, 3, 4], [5, 0, 12], [0, -1, 1]].map(|n| unit_vector(bits(n)).expect("a unit"));
    let mut cuts = 0;
    while tried.more() {
        let corners = [0; 3].map(|_| {
            let bits = random.within(13, 20);
            let w = random.within(4096, 1 << bits) as i32;
            let most = (f64::from(w) * 12_000.0 / focal) as i32;
            [any(&mut random, most), any(&mut random, most), -w]
        });
        let normals = [0; 3].map(|_| random.one_of(&tilted));
        let positions = corners.map(bits);
        let mesh = FixedMesh::new(&positions, &normals, &[[0_u16, 1, 2]], false).expect("legal");
        let object = Object { mesh, placement: Placement::default(), materials: &[MATERIAL] };
        let drawn = triangles(&view, object, &[sun]).expect("legal");

        let at = corners.map(|[x, y, z]| {
            let project = |c: i32| focal * f64::from(c) / f64::from(-z);
            (160.0 + project(x), 100.0 + project(-y))
        });
        let area = |a: (f64, f64), b: (f64, f64), c: (f64, f64)| (b.0 - a.0) * (c.1 - a.1) - (c.0 - a.0) * (b.1 - a.1);
        let whole = area(at[0], at[1], at[2]);
        if whole.abs() < 1e5 {
            // Little more than a line: rounding to 1/256 pixel decides its shades.
            continue;
        }
        // Seen from behind, the normal is flipped: no light.
        let lit = |n: Vector| if whole < 0.0 { f64::from(n[2].to_bits().max(0)) / 65_536.0 * 65_280.0 } else { 0.0 };
        let shades = normals.map(lit);
        let plane = |p: (f64, f64)| {
            (shades[0] * area(p, at[1], at[2]) + shades[1] * area(at[0], p, at[2]) + shades[2] * area(at[0], at[1], p))
                / whole
        };
        for vertex in drawn.iter().flat_map(|(vertices, _)| vertices) {
            let p = (f64::from(vertex.x().to_bits()) / 256.0, f64::from(vertex.y().to_bits()) / 256.0);
            let slope = (plane((1.0, 0.0)) - plane((0.0, 0.0))).abs() + (plane((0.0, 1.0)) - plane((0.0, 0.0))).abs();
            // Half a unit each way; 12 bits more than 1/65,536 of a depth of 4,096 leave 2⁻¹² pixel at
            // the guard band; shades are rounded twice.
            let off = 0.5 / 256.0 + 1.0 / 4096.0;
            let error = (f64::from(vertex.shade().to_bits()) - plane(p)).abs();
            assert!(error <= 1.01 + slope * off, "shade: {error} at {p:?} of {at:?}, {shades:?}");
            let beyond = 4095.75 - 1.0 / 128.0;
            if p.0.abs() > beyond && p.1.abs() > beyond {
                continue;
            }
            let from_edge = |a: (f64, f64), b: (f64, f64)| area(a, b, p).abs() / (a.0 - b.0).hypot(a.1 - b.1);
            let nearest =
                [(0, 1), (1, 2), (2, 0)].map(|(a, b)| from_edge(at[a], at[b])).into_iter().fold(f64::MAX, f64::min);
            assert!(nearest <= off * 2.0_f64.sqrt(), "{nearest} pixels from an edge: {p:?} of {at:?}");
            cuts += u64::from(p.0.abs() > beyond || p.1.abs() > beyond);
        }
    }
    assert!(cuts > 10_000, "{cuts} cuts");
}

// ------------------------------------------------------------------ what is refused; odd input

#[test]
fn what_16_16_cannot_hold_is_refused() {
    let mut tried = Tried::new("what_16_16_cannot_hold_is_refused", 20);
    let far = bits([32_767 << 16; 3]);
    let corner = bits([0; 3]);
    let z = bits([0, 0, 65_536]);
    let mesh = |p: Vector, n: Vector, i: u16| FixedMesh::new(&[p], &[n], &[[i; 3]], false).map(|_| ());
    let mut check = |got: bool, what: &str| {
        assert!(got, "{what}");
        tried.add(1);
    };
    check(mesh(far, z, 0).is_ok(), "the farthest vertex");
    check(mesh(bits([0, (32_767 << 16) + 1, 0]), z, 0) == Err(IntegerError::Position { vertex: 0 }), "beyond");
    check(mesh(bits([i32::MIN, 0, 0]), z, 0) == Err(IntegerError::Position { vertex: 0 }), "beyond below");
    check(mesh(corner, bits([0, 0, 65_540]), 0).is_ok(), "a normal off by 2⁻¹⁴");
    for normal in [[0, 0, 65_541], [0, 0, 65_531], [0, 0, 0], [i32::MIN; 3]] {
        check(mesh(corner, bits(normal), 0) == Err(IntegerError::NormalNotUnit { vertex: 0 }), "a normal");
    }
    check(mesh(corner, z, 1) == Err(IntegerError::IndexOutOfRange { triangle: 0 }), "an index");

    let lens = |w, h, aspect, degrees| Lens::new(w, h, aspect, BinaryAngle::from_degrees(degrees)).map(|_| ());
    check(lens(320, 200, (5, 6), 40).is_ok(), "the usual picture");
    check(lens(320, 200, (5, 6), 1).is_ok() && lens(320, 200, (5, 6), 179).is_ok(), "1° and 179°");
    check(lens(0, 200, (5, 6), 40) == Err(IntegerError::Size), "no width");
    check(lens(320, 4097, (5, 6), 40) == Err(IntegerError::Size), "too high");
    for degrees in [0, 180, 181, -1] {
        check(lens(320, 200, (5, 6), degrees) == Err(IntegerError::FieldOfView), "the angle");
    }
    check(lens(4096, 4096, (1, 1), 1) == Err(IntegerError::FieldOfView), "a focal length of 234,000");
    check(lens(320, 200, (0, 6), 40) == Err(IntegerError::FieldOfView), "a pixel without width");
    check(lens(320, 200, (5, 0), 40) == Err(IntegerError::FieldOfView), "a pixel without height");

    let camera = Camera { eye: corner, target: z, up: z, near: I16F16::ONE };
    let lens = Lens::new(320, 200, (5, 6), BinaryAngle::from_degrees(40)).expect("legal");
    let view = |camera: Camera| View::new(&camera, lens).map(|_| ());
    check(view(camera).is_ok(), "up along the view");
    check(view(Camera { target: corner, ..camera }) == Err(IntegerError::Direction), "no direction");
    check(view(Camera { near: I16F16::from_bits(0), ..camera }) == Err(IntegerError::Near), "no near plane");
    check(view(Camera { near: I16F16::from_bits(-1), ..camera }) == Err(IntegerError::Near), "a near plane behind");

    let view = View::new(&camera, lens).expect("legal");
    let positions = [bits([1 << 16, 0, 0])];
    let normals = [z];
    let mesh = FixedMesh::new(&positions, &normals, &[[0_u16; 3]], false).expect("legal");
    let place = |position: Vector, scale: i32, exponent: i8| {
        let placement = Placement { position, scale: I16F16::from_bits(scale), ..Placement::default() };
        view.check(&placement, &mesh.with_exponent(exponent))
    };
    check(place(corner, -1, 0) == Err(IntegerError::Scale), "a negative scale");
    check(place(corner, 0, 127).is_err() && place(corner, 0, -128).is_ok(), "no size");
    check(place(far, 65_536, 0).is_ok(), "far away");
    check(place(far, 65_536, 15) == Err(IntegerError::TooFar), "far away and large");
    check(place(corner, 65_536, 15).is_ok(), "32,768 units of size");
    check(place(corner, 65_536, 16) == Err(IntegerError::TooFar), "65,536 units of size");
    check(place(corner, i32::MAX, 127) == Err(IntegerError::TooFar), "larger still");

    let object = Object { mesh, placement: Placement::default(), materials: &[MATERIAL] };
    let sun = Sun { direction: z, intensity: I16F16::ONE };
    let stage = |object, suns: &[Sun], lit, beams| {
        let (mut lit, mut beams) = (vec![Default::default(); lit], vec![Default::default(); beams]);
        VertexStage::new(&view, object, suns, Shading::Flat, &mut lit, &mut beams).map(|_| ())
    };
    check(stage(object, &[sun], 1, 1).is_ok(), "enough room");
    check(stage(object, &[sun], 0, 1) == Err(IntegerError::Room { needed: 1 }), "no room for vertices");
    check(stage(object, &[sun], 1, 0) == Err(IntegerError::Room { needed: 1 }), "no room for beams");
    check(
        stage(Object { materials: &[], ..object }, &[], 1, 0) == Err(IntegerError::Materials { needed: 1 }),
        "no material",
    );
    check(stage(object, &[sun; 4096], 1, 4096).is_ok(), "4,096 suns");
    check(stage(object, &[sun; 4097], 1, 4097) == Err(IntegerError::Light), "4,097 suns");
    check(stage(object, &[Sun { direction: corner, ..sun }], 1, 1) == Err(IntegerError::Light), "no direction");
}

/// Everything at its extremes: no overflow, which the test profile checks for, and whatever is drawn is valid, since
/// any vertex that exists is.
#[test]
fn r7_any_legal_input_is_quiet() {
    let mut tried = Tried::new("r7_any_legal_input_is_quiet", 100_000);
    let mut random = Random::named("integer quiet");
    let (mut drawn, mut refused) = (0_u64, 0_u64);
    let number = |random: &mut Random, most: i64| -> i32 {
        let bits = random.within(0, 31) as u32;
        let n = (random.next_u64() & ((2_u64 << bits) - 1)) as i64;
        (if random.within(0, 5) == 0 { most } else { n.min(most) } * random.one_of(&[1, -1])) as i32
    };
    let mut pixels = vec![0; 64 * 40];
    while tried.more() {
        let vector = |random: &mut Random, most| [0; 3].map(|_| I16F16::from_bits(number(random, most)));
        let reach = 0x7FFF_0000;
        let positions = [0; 3].map(|_| vector(&mut random, reach));
        let Some(normal) = unit_vector(vector(&mut random, i64::from(i32::MAX))) else { continue };
        let normals = [normal; 3];
        let closed = random.within(0, 1) == 0;
        let mesh = FixedMesh::new(&positions, &normals, &[[0_u16, 1, 2]], closed).expect("legal");
        let focal = [0; 2].map(|_| I16F16::from_bits(number(&mut random, 1 << 30).unsigned_abs().max(1) as i32));
        let lens = Lens::with_focal_lengths(64, 40, focal).expect("legal");
        let most = i64::from(i32::MAX);
        let camera = Camera {
            eye: vector(&mut random, most),
            target: vector(&mut random, most),
            up: vector(&mut random, most),
            near: I16F16::from_bits(number(&mut random, most).unsigned_abs().max(1) as i32),
        };
        let Ok(view) = View::new(&camera, lens) else { continue };
        let placement = Placement {
            position: vector(&mut random, most),
            pivot: vector(&mut random, most),
            angles: [0; 3].map(|_| BinaryAngle::from(random.next_u64() as u16)),
            scale: I16F16::from_bits((number(&mut random, most).unsigned_abs() >> random.within(0, 31)) as i32),
        };
        let material = Material {
            ambient: I16F16::from_bits(number(&mut random, most)),
            diffuse: I16F16::from_bits(number(&mut random, most)),
            ramp: Ramp::WHOLE,
        };
        let sun = Sun {
            direction: vector(&mut random, most),
            intensity: I16F16::from_bits(random.one_of(&[i32::MIN, i32::MAX, 65_536])),
        };
        let suns = vec![sun; if random.within(0, 999) == 0 { 4096 } else { 2 }];
        let shading = random.one_of(&[Shading::Flat, Shading::Gouraud88Reseeded]);
        let mesh = mesh.with_exponent(random.within(-40, 3) as i8);
        let object = Object { mesh, placement, materials: &[material] };
        let (mut lit, mut beams) = ([Default::default(); 3], vec![Default::default(); suns.len()]);
        match VertexStage::new(&view, object, &suns, shading, &mut lit, &mut beams) {
            Ok(stage) => {
                let mut raster = Raster::new(Frame::new(&mut pixels, 64, 40, 64).expect("a frame"));
                drawn += stage
                    .faces(|vertices, interpolation| {
                        raster.triangle(vertices, interpolation);
                    })
                    .drawn;
            }
            Err(_) => refused += 1,
        }
    }
    println!("{drawn} triangles drawn, {refused} objects refused");
    assert!(drawn > 1000 && refused > 1000);
}
