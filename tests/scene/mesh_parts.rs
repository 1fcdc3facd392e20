//! Meshes from the contents of a model's file: what is left out, what is refused, what is repaired.

use mode13h::glam::{Vec2, Vec3};
use mode13h::mesh::{Mesh, MeshError, Parts, Surface, shapes};
use mode13h_conformance::Random;

fn square() -> Parts {
    let positions = vec![Vec3::ZERO, Vec3::X, Vec3::X + Vec3::Y, Vec3::Y];
    Parts { positions, triangles: vec![[0, 1, 2], [0, 2, 3]], ..Parts::default() }
}

#[test]
fn lists_that_are_empty_are_left_out() {
    let (mesh, repairs) = Mesh::from_parts(square()).expect("a mesh");
    assert_eq!(mesh, Mesh::new(square().positions, square().triangles).expect("a mesh"));
    assert_eq!((repairs.pairs, repairs.turned), (0, 0));
    assert_eq!((mesh.texcoords(), mesh.surfaces().len()), (None, 1));
}

#[test]
fn lists_of_other_lengths_are_refused() {
    type Change = fn(&mut Parts);
    let changes: [(&str, Change); 5] = [
        ("normals", |parts| parts.normals = vec![None; 3]),
        ("texture coordinates", |parts| parts.texcoords = vec![Vec2::ZERO; 5]),
        ("triangle surfaces", |parts| parts.triangle_surfaces = vec![0]),
        ("lines", |parts| parts.lines = vec![1; 3]),
        ("groups", |parts| parts.groups = vec![1]),
    ];
    for (name, change) in changes {
        let mut parts = square();
        change(&mut parts);
        let error = Mesh::from_parts(parts).expect_err("refused");
        assert!(matches!(error, MeshError::Count { what, .. } if what == name), "{name}: {error}");
    }
}

#[test]
fn what_is_not_finite_or_out_of_range_is_refused() {
    let with = |change: fn(&mut Parts)| {
        let mut parts = square();
        change(&mut parts);
        Mesh::from_parts(parts)
    };
    assert_eq!(with(|parts| parts.triangles.clear()), Err(MeshError::NoTriangles));
    assert_eq!(with(|parts| parts.positions[1].y = f32::NAN), Err(MeshError::PositionNotFinite { vertex: 1 }));
    assert_eq!(with(|parts| parts.triangles[1][2] = 4), Err(MeshError::IndexOutOfRange { triangle: 1 }));
    assert_eq!(
        with(|parts| parts.texcoords = vec![Vec2::new(0.0, f32::INFINITY); 4]),
        Err(MeshError::TexcoordNotFinite { vertex: 0 })
    );
    assert_eq!(with(|parts| parts.triangle_surfaces = vec![0, 1]), Err(MeshError::SurfaceOutOfRange { triangle: 1 }));
}

/// A normal without a direction is computed from the faces.
#[test]
fn normals_without_a_direction_count_as_missing() {
    let odd = [None, Some(Vec3::ZERO), Some(Vec3::splat(f32::NAN)), Some(Vec3::new(0.0, 3.0, 0.0))];
    let (mesh, _) = Mesh::from_parts(Parts { normals: odd.to_vec(), ..square() }).expect("a mesh");
    assert_eq!(mesh.normals(), [Vec3::Z, Vec3::Z, Vec3::Z, Vec3::Y]);
}

/// Bodies one inside the other are turned, too, but not thousands: a small file must not take minutes and gigabytes.
#[test]
fn thousands_of_nested_bodies_are_left_as_they_are() {
    let nested = |count: usize| {
        let corners = [[1.0, 1.0, 1.0], [-1.0, -1.0, 1.0], [-1.0, 1.0, -1.0], [1.0, -1.0, -1.0]];
        let size = |i: usize| (i + 1) as f32 / count as f32;
        let positions = (0..count).flat_map(|i| corners.map(|corner| Vec3::from_array(corner) * size(i))).collect();
        let faces = [[0, 1, 2], [0, 3, 1], [0, 2, 3], [1, 3, 2]];
        let triangles = (0..count as u32).flat_map(|i| faces.map(|face| face.map(|corner| 4 * i + corner))).collect();
        Mesh::from_parts(Parts { positions, triangles, ..Parts::default() }).expect("a mesh").1.turned
    };
    // Every second one is a hole.
    assert_eq!(nested(200), 100);
    assert_eq!(nested(8_000), 0);
}

#[test]
fn a_body_that_is_inside_out_is_turned_with_its_lists() {
    let cube = shapes::cube();
    let triangles: Vec<[u32; 3]> = cube.triangles().iter().map(|&[a, b, c]| [a, c, b]).collect();
    let lines = (1..=triangles.len() as u32).collect();
    let texcoords: Vec<Vec2> = (0..cube.positions().len()).map(|i| Vec2::splat(i as f32)).collect();
    let parts = Parts {
        positions: cube.positions().to_vec(),
        texcoords: texcoords.clone(),
        surfaces: vec![Surface::default(); 2],
        triangle_surfaces: (0..triangles.len()).map(|i| (i % 2) as u16).collect(),
        triangles,
        lines,
        ..Parts::default()
    };
    let (mesh, repairs) = Mesh::from_parts(parts).expect("a mesh");
    assert_eq!((repairs.turned, repairs.pairs), (1, 0));
    assert!(mesh.volume() > 0.0);
    assert_eq!((mesh.triangles(), mesh.texcoords()), (cube.triangles(), Some(&texcoords[..])));
    assert_eq!((mesh.line(3), mesh.triangle_surfaces()[3]), (Some(4), 1));
}

/// Faces over a few points, many of them back to back, inside out or without area: whatever is repaired, the lists stay
/// in step, and every face is one that was given.
#[test]
fn lists_stay_together_whatever_is_mended() {
    let mut random = Random::new(29);
    let (mut pairs, mut turned, mut refused) = (0, 0, 0);
    for _ in 0..20_000 {
        let points = 4 + random.below(5) as u32;
        let vertices = points + random.below(3) as u32;
        // Vertices beyond the points repeat their positions.
        let at = |i: u32| {
            // Corners of a cube, the first four of a tetrahedron.
            let corner = [0, 1, 2, 4, 3, 5, 6, 7][i as usize];
            Vec3::new((corner & 1) as f32, (corner >> 1 & 1) as f32, (corner >> 2) as f32)
        };
        let mut triangles: Vec<[u32; 3]> = Vec::new();
        if random.below(2) == 0 {
            triangles.extend([[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]]);
        }
        for _ in 0..random.below(8) {
            let [a, b, c] = [0; 3].map(|_: u32| random.below(vertices as usize) as u32);
            triangles.push([a, b, c]);
            if random.below(3) > 0 {
                triangles.push([a, c, b]);
            }
        }
        if random.below(2) == 0 {
            triangles.iter_mut().for_each(|triangle| triangle.swap(1, 2));
        }
        let n = triangles.len();
        let normal =
            |random: &mut Random| (random.below(2) == 0).then(|| at(random.below(8) as u32) - Vec3::splat(0.5));
        let parts = Parts {
            positions: (0..vertices).map(|i| at(i % points)).collect(),
            normals: (0..vertices).map(|_| normal(&mut random)).collect(),
            texcoords: (0..vertices).map(|i| Vec2::splat(i as f32)).collect(),
            surfaces: vec![Surface::default(); 2],
            triangle_surfaces: (0..n).map(|_| random.below(2) as u16).collect(),
            lines: (1..=n as u32).collect(),
            groups: (0..n).map(|_| [Parts::FLAT, 1, 2, Parts::NO_GROUP][random.below(4)]).collect(),
            triangles,
            ..Parts::default()
        };
        let given = parts.clone();
        let Ok((mesh, repairs)) = Mesh::from_parts(parts) else {
            assert!(given.triangles.is_empty());
            refused += 1;
            continue;
        };
        assert_eq!(mesh.triangles().len(), n - 2 * repairs.pairs);
        let texcoords = mesh.texcoords().expect("given");
        assert_eq!((texcoords.len(), mesh.normals().len()), (mesh.positions().len(), mesh.positions().len()));
        for (i, triangle) in mesh.triangles().iter().enumerate() {
            // A face's line identifies it, and its corners' coordinates identify the vertices.
            let line = mesh.line(i).expect("given") as usize - 1;
            assert_eq!(mesh.triangle_surfaces()[i], given.triangle_surfaces[line]);
            let mut before = given.triangles[line];
            let mut now = triangle.map(|vertex| texcoords[vertex as usize].x as u32);
            for vertex in triangle.map(|vertex| vertex as usize) {
                assert_eq!(mesh.positions()[vertex], given.positions[texcoords[vertex].x as usize]);
                assert!((mesh.normals()[vertex].length() - 1.0).abs() < 1e-5);
            }
            before.sort_unstable();
            now.sort_unstable();
            assert_eq!(now, before, "{given:?}");
        }
        pairs += repairs.pairs;
        turned += repairs.turned;
    }
    assert!(pairs > 100 && turned > 100 && refused > 100, "{pairs} {turned} {refused}");
}
