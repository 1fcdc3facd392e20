//! Meshes from what a model's file gives: what is left out, what is refused, what is mended.

use mode13h::glam::{Vec2, Vec3};
use mode13h::mesh::{Mesh, MeshError, Parts, Surface, shapes};

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

/// A normal that has no direction is given by the faces.
#[test]
fn normals_without_a_direction_count_as_missing() {
    let odd = [None, Some(Vec3::ZERO), Some(Vec3::splat(f32::NAN)), Some(Vec3::new(0.0, 3.0, 0.0))];
    let (mesh, _) = Mesh::from_parts(Parts { normals: odd.to_vec(), ..square() }).expect("a mesh");
    assert_eq!(mesh.normals(), [Vec3::Z, Vec3::Z, Vec3::Z, Vec3::Y]);
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
