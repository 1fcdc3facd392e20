//! An object on its way to the raster: its vertices, each lit, projected and rounded once, then its faces.

use super::IntegerError;
use super::clip::{Corner, clip};
use super::light::{Material, ObjectSun, Sun};
use super::mesh::{FixedMesh, VertexIndex, face_normal};
use super::view::{Homogeneous, ObjectView, Placement, View};
use crate::fixed::U8F8;
use crate::raster::clip::doubled_area;
use crate::raster::{Interpolation, Vertex};
use crate::settings::Shading;

/// A mesh with its placement, and one material for each of its surfaces.
#[derive(Clone, Copy, Debug)]
pub struct Object<'a, I: VertexIndex = u16> {
    /// The mesh.
    pub mesh: FixedMesh<'a, I>,
    /// Its position, rotation and scale in the scene.
    pub placement: Placement,
    /// The materials, one for each surface.
    pub materials: &'a [Material],
}

/// Storage for a lit and projected vertex.
#[derive(Clone, Copy, Debug, Default)]
pub struct LitVertex {
    /// The vertex. Its shade is that of the front: the side that the normal points out of. If the
    /// vertex needs clipping, only the shade is valid.
    vertex: Vertex,
    back: U8F8,
    needs_clipping: bool,
}

/// Counts of an object's faces by what happened to them.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Default)]
#[non_exhaustive]
pub struct Faces {
    /// Faces lit, with flat shading.
    pub lit: u64,
    /// Faces clipped by the near plane or the guard band, or wholly beyond them.
    pub clipped: u64,
    /// Faces that face away, or have no area once clipped and rounded.
    pub culled: u64,
    /// Triangles passed on: faces, and the parts of clipped ones.
    pub drawn: u64,
}

/// An object whose vertices are ready: its faces can be drawn, once for each band.
#[derive(Clone, Copy, Debug)]
pub struct VertexStage<'a, I: VertexIndex = u16> {
    /// A shading that needs nothing but the vertices.
    shading: Shading,
    object: Object<'a, I>,
    view: ObjectView,
    beams: &'a [ObjectSun],
    lit: &'a [LitVertex],
}

impl<'a, I: VertexIndex> VertexStage<'a, I> {
    /// Lights and projects every vertex of the mesh. `lit` must hold at least as many vertices as the mesh has, and
    /// `beams` at least as many beams as there are suns. Shadings that this path lacks (those that light pixels, split
    /// faces or need floats) are replaced by the default.
    ///
    /// # Errors
    /// Too little storage; a surface without a material; a scale below 0; an object that may reach farther than 65,535
    /// units away; more than 4,096 suns, or one without direction.
    pub fn new(
        view: &View,
        object: Object<'a, I>,
        suns: &[Sun],
        shading: Shading,
        lit: &'a mut [LitVertex],
        beams: &'a mut [ObjectSun],
    ) -> Result<Self, IntegerError> {
        let Object { mesh, placement, materials } = &object;
        if suns.len() > Sun::MAX_COUNT {
            return Err(IntegerError::Light);
        }
        if materials.len() < mesh.surfaces {
            return Err(IntegerError::Materials { needed: mesh.surfaces });
        }
        let lit = lit.get_mut(..mesh.vertices()).ok_or(IntegerError::Room { needed: mesh.vertices() })?;
        let beams = beams.get_mut(..suns.len()).ok_or(IntegerError::Room { needed: suns.len() })?;
        let view = ObjectView::new(view, placement, mesh)?;
        for (beam, sun) in beams.iter_mut().zip(suns) {
            *beam = sun.beam(&view)?;
        }
        for (i, (place, (&position, &normal))) in
            lit.iter_mut().zip(mesh.parts.positions.iter().zip(mesh.parts.normals)).enumerate()
        {
            let vertex = view.project(view.homogeneous(position));
            let (front, back) = match shading {
                Shading::Flat => (U8F8::default(), U8F8::default()),
                _ => materials[mesh.vertex_surface(i)].shades(beams, normal),
            };
            *place = LitVertex {
                vertex: vertex.unwrap_or_default().with_shade(front),
                back,
                needs_clipping: vertex.is_none(),
            };
        }
        Ok(Self { shading: shading.in_integers(), object, view, beams, lit })
    }

    /// Calls `triangle` for each face to be drawn, clipped where necessary. Back faces are culled in a closed mesh and
    /// in back-to-back pairs; elsewhere they are drawn.
    pub fn faces(&self, mut triangle: impl FnMut(&[Vertex; 3], Interpolation)) -> Faces {
        let mut counts = Faces::default();
        let mesh = &self.object.mesh;
        for (face, indices) in mesh.parts.triangles.iter().enumerate() {
            // In range, which the mesh guarantees, and every vertex is lit.
            let indices = indices.map(VertexIndex::place);
            let corners = indices.map(|i| self.lit[i]);
            if corners.iter().any(|corner| corner.needs_clipping) {
                counts.clipped += 1;
                self.clipped(face, indices, &corners, &mut counts, &mut triangle);
                continue;
            }
            let vertices = corners.map(|corner| corner.vertex);
            let area = doubled_area(&vertices);
            if self.is_culled(face, area) {
                counts.culled += 1;
                continue;
            }
            counts.drawn += 1;
            let interpolation = self.interpolation(face, indices, area > 0, &mut counts);
            if area > 0 {
                triangle(&corners.map(|corner| corner.vertex.with_shade(corner.back)), interpolation);
            } else {
                triangle(&vertices, interpolation);
            }
        }
        counts
    }

    /// Clips a face that reaches beyond the near plane or the guard band. A separate function because it is rarely
    /// called.
    #[cold]
    fn clipped(
        &self,
        face: usize,
        indices: [usize; 3],
        corners: &[LitVertex; 3],
        counts: &mut Faces,
        triangle: &mut impl FnMut(&[Vertex; 3], Interpolation),
    ) {
        let at = indices.map(|i| self.view.homogeneous(self.object.mesh.parts.positions[i]));
        let turned = !self.object.mesh.hides_back(face) && is_turned_away(&at);
        let corner = |i: usize| {
            let LitVertex { vertex, back, needs_clipping } = corners[i];
            let shade = if turned { back } else { vertex.shade() };
            Corner::new(at[i], shade, (!needs_clipping).then(|| vertex.with_shade(shade)))
        };
        let on_face = self.shading == Shading::GouraudHyperbolic;
        let Some(clipped) = clip(&self.view, on_face, [corner(0), corner(1), corner(2)]) else { return };
        if self.is_culled(face, clipped.doubled_area()) {
            counts.culled += 1;
            return;
        }
        let interpolation = self.interpolation(face, indices, turned, counts);
        for part in clipped.parts() {
            counts.drawn += 1;
            triangle(&part, interpolation);
        }
    }

    /// The interpolation of a face's shades. With flat shading, the shade is computed here.
    #[inline]
    fn interpolation(&self, face: usize, indices: [usize; 3], turned: bool, counts: &mut Faces) -> Interpolation {
        match self.shading {
            Shading::Flat => {
                counts.lit += 1;
                let mesh = &self.object.mesh;
                let [a, b, c] = indices.map(|i| mesh.parts.positions[i]);
                // A face without area has no normal; rounded, it may still cover a pixel.
                let normal = face_normal(a, b, c).unwrap_or(mesh.parts.normals[indices[0]]);
                let material = &self.object.materials[mesh.triangle_surface(face)];
                let (front, back) = material.shades(self.beams, normal);
                Interpolation::Flat(if turned { back } else { front }.nearest())
            }
            shading => shading.interpolation(),
        }
    }

    #[inline]
    fn is_culled(&self, face: usize, doubled_area: i64) -> bool {
        doubled_area == 0 || (doubled_area > 0 && self.object.mesh.hides_back(face))
    }
}

/// Returns whether the eye is behind the face, wherever its corners are, from the sign of the
/// volume between the eye and the three corners.
fn is_turned_away(at: &[Homogeneous; 3]) -> bool {
    let [[ax, ay, aw], [bx, by, bw], [cx, cy, cw]] = at.map(|corner| corner.map(i128::from));
    // Coordinates are at most 2³²: below 6 · 2⁹⁶.
    aw * (bx * cy - cx * by) + bw * (cx * ay - ax * cy) + cw * (ax * by - bx * ay) > 0
}
