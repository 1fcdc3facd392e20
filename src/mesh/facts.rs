//! Derived properties of a mesh, computed once when it is made and shared by all objects that use it.

use alloc::vec;
use alloc::vec::Vec;

use super::Mesh;
use super::normals::face_normal;
use super::wide::{dot, sub, widen};

/// The derived properties of a mesh.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Facts {
    /// The index of each vertex's surface.
    vertex_surfaces: Vec<u16>,
    /// The longest edge, in the mesh's own units, and the longest in texture coordinates.
    pub(crate) longest_edges: (f32, f32),
    /// For each surface, the greatest change of its texture coordinates over one unit of the mesh.
    pub(crate) steepest_texcoords: Vec<f64>,
    /// Whether every face has its own normal at all its vertices, so that a distant light is constant over each face.
    pub(crate) is_faceted: bool,
}

impl Mesh {
    /// The mesh with its facts up to date.
    pub(super) fn with_facts(mut self) -> Self {
        self.find_facts();
        self
    }

    /// Recomputes the facts. Every change to a mesh must end with this.
    pub(super) fn find_facts(&mut self) {
        self.facts = Facts {
            vertex_surfaces: vertex_surfaces(self),
            longest_edges: longest_edges(self),
            steepest_texcoords: steepest_texcoords(self),
            is_faceted: is_faceted(self),
        };
    }

    /// The index of each vertex's surface; 0 if no triangle uses the vertex. In a mesh without [one surface per
    /// vertex](Self::has_one_surface_a_vertex), the last triangle that uses the vertex decides.
    #[must_use]
    pub(crate) fn vertex_surfaces(&self) -> &[u16] {
        &self.facts.vertex_surfaces
    }
}

/// For each vertex, the index of its surface.
fn vertex_surfaces(mesh: &Mesh) -> Vec<u16> {
    let mut surface_of = vec![0; mesh.positions.len()];
    if mesh.surfaces.len() == 1 {
        return surface_of;
    }
    for (triangle, &surface) in mesh.triangles.iter().zip(&mesh.triangle_surfaces) {
        for &i in triangle {
            surface_of[i as usize] = surface;
        }
    }
    surface_of
}

/// The longest edge in space and in texture coordinates. Rounded; infinite beyond f32.
fn longest_edges(mesh: &Mesh) -> (f32, f32) {
    let (mut edge, mut texture_edge) = (0.0_f64, 0.0_f64);
    for &[a, b, c] in &mesh.triangles {
        for (from, to) in [(a, b), (b, c), (c, a)] {
            // In range, as in every mesh.
            let (from, to) = (from as usize, to as usize);
            let along = sub(widen(mesh.positions[from]), widen(mesh.positions[to]));
            edge = edge.max(dot(along, along));
            if let Some(texcoords) = &mesh.texcoords {
                let [from, to] = [from, to].map(|i| texcoords[i].to_array().map(f64::from));
                let along = [from[0] - to[0], from[1] - to[1], 0.0];
                texture_edge = texture_edge.max(dot(along, along));
            }
        }
    }
    // The root is monotonic, so only the greatest squares need one.
    (libm::sqrt(edge) as f32, libm::sqrt(texture_edge) as f32)
}

/// For each surface, the largest change of texture coordinates over one unit of its faces. Faces
/// without area are ignored.
///
/// On a face with edges e and f, let a coordinate change by g along e and by h along f, and another by g' and h'. Then
/// ∇·∇' = (gg'·f·f − (gh' + g'h)·e·f + hh'·e·e) / (e·e f·f − (e·f)²). One unit changes both coordinates together by at
/// most the root of the greater eigenvalue of the matrix of these products.
fn steepest_texcoords(mesh: &Mesh) -> Vec<f64> {
    let mut steepest = vec![0.0_f64; mesh.surfaces.len()];
    let Some(texcoords) = &mesh.texcoords else { return steepest };
    for (&corners, &surface) in mesh.triangles.iter().zip(&mesh.triangle_surfaces) {
        // In range, as in every mesh.
        let [p, q, r] = corners.map(|i| mesh.positions[i as usize].to_array().map(f64::from));
        let [s, t, w] = corners.map(|i| texcoords[i as usize].to_array().map(f64::from));
        let (e, f) = ([0, 1, 2].map(|i| q[i] - p[i]), [0, 1, 2].map(|i| r[i] - p[i]));
        let (ee, ef, ff) = (dot(e, e), dot(e, f), dot(f, f));
        let area = ee * ff - ef * ef;
        if area <= 0.0 {
            continue;
        }
        let (g, h) = ([t[0] - s[0], t[1] - s[1]], [w[0] - s[0], w[1] - s[1]]);
        let product =
            |i: usize, j: usize| (g[i] * g[j] * ff - (g[i] * h[j] + g[j] * h[i]) * ef + h[i] * h[j] * ee) / area;
        let (uu, uv, vv) = (product(0, 0), product(0, 1), product(1, 1));
        let greater = (uu + vv + libm::hypot(uu - vv, 2.0 * uv)) / 2.0;
        let most = &mut steepest[usize::from(surface)];
        *most = most.max(libm::sqrt(greater));
    }
    steepest
}

/// Returns whether the three normals of every face equal that of its plane, to an angle of about 10⁻⁵: 1/400 of a
/// shade.
fn is_faceted(mesh: &Mesh) -> bool {
    mesh.triangles.iter().all(|corners| {
        let [a, b, c] = corners.map(|i| mesh.positions[i as usize]);
        // A face without area shows no shade.
        let Some(normal) = face_normal(a, b, c) else { return true };
        corners.iter().all(|&i| mesh.normals[i as usize].distance_squared(normal) < 1e-10)
    })
}

#[cfg(test)]
mod tests {
    use alloc::vec;

    use glam::{Vec2, Vec3};

    use super::super::{Mesh, Surface, Weight, shapes};
    use super::*;

    /// Checks that the stored facts of a mesh equal freshly computed ones, bit for bit.
    fn check(what: &str, mesh: &Mesh) {
        let anew = mesh.clone().with_facts().facts;
        let Facts { vertex_surfaces, longest_edges: (edge, of_texture), steepest_texcoords, is_faceted } = &mesh.facts;
        assert_eq!(*vertex_surfaces, anew.vertex_surfaces, "{what}");
        let bits = |numbers: &[f64]| numbers.iter().map(|number| number.to_bits()).collect::<Vec<_>>();
        assert_eq!([edge.to_bits(), of_texture.to_bits()], {
            let (edge, of_texture) = anew.longest_edges;
            [edge.to_bits(), of_texture.to_bits()]
        });
        assert_eq!(bits(steepest_texcoords), bits(&anew.steepest_texcoords), "{what}");
        assert_eq!(*is_faceted, anew.is_faceted, "{what}");
        assert_eq!(vertex_surfaces.len(), mesh.positions().len(), "{what}");
    }

    #[test]
    fn facts_are_those_of_the_mesh_however_it_is_made() {
        for (name, mesh) in [
            ("cube", shapes::cube()),
            ("wall", shapes::wall(3, 2)),
            ("torus", shapes::torus(8, 5)),
            ("sphere", shapes::sphere(8, 5)),
            ("cone", shapes::cone(8, 2)),
            ("cylinder", shapes::cylinder(8, 2)),
            ("teapot", shapes::teapot(2)),
        ] {
            check(name, &mesh);
            check(name, &mesh.stretched(Vec3::new(1.0, 2.0, 4.0)).expect("factors"));
            let surfaces = vec![Surface::default(); 2];
            let numbers = (0..mesh.triangles().len()).map(|i| (i % 2) as u16).collect();
            let mesh = mesh.with_surfaces(surfaces, numbers).expect("surfaces");
            check(name, &mesh);
            let mut mesh = mesh.with_one_surface_a_vertex();
            check(name, &mesh);
            assert!(mesh.vertex_surfaces().contains(&1), "{name}");
            mesh.smooth(Weight::Angle, Some(crate::Angle::from_radians(0.5)));
            check(name, &mesh);
            mesh.flat();
            check(name, &mesh);
            assert!(mesh.facts.is_faceted, "{name}");
            let texcoords = (0..mesh.positions().len()).map(|i| Vec2::new(i as f32, 1.0)).collect();
            let mesh = mesh.with_texcoords(texcoords).expect("pairs");
            check(name, &mesh);
            assert!(mesh.facts.longest_edges.1 >= 1.0, "{name}");
            let (positions, normals) = (mesh.positions().to_vec(), mesh.normals().to_vec());
            check(name, &Mesh::with_normals(positions.clone(), normals, mesh.triangles().to_vec()).expect("sound"));
            check(name, &Mesh::new(positions, mesh.triangles().to_vec()).expect("sound"));
        }
    }
}
