//! An object on its way to the raster: its vertices, each lit, projected and rounded once, then its
//! faces.

use alloc::vec::Vec;

use glam::Vec3;

use super::clip::{Corner, clip};
use crate::view::{Homogeneous, ObjectView};
use super::{Rung, Stats};
use crate::fixed::U8F8;
use crate::light::{Beam, Light, Material, both_sides};
use crate::mesh::normals::face_normal;
use crate::palette::Ramp;
use crate::raster::clip::doubled_area;
use crate::raster::{Shading, Vertex};
use crate::scene::{Object, Scene};

/// A material in its scene: what its shades are made with.
#[derive(Clone, Copy, Debug)]
pub(super) struct Paint {
    ambient: f64,
    diffuse: f64,
    ramp: Ramp,
}

impl Paint {
    pub(super) fn new(material: &Material, scene: &Scene) -> Self {
        Self {
            ambient: f64::from(material.ambient) * f64::from(scene.ambient),
            diffuse: f64::from(material.diffuse),
            ramp: material.ramp.in_palette(scene.palette.as_ref()),
        }
    }

    /// The shades of the side that `normal` points away from, and of the other.
    #[inline]
    fn shades(&self, beams: &[Beam], normal: Vec3) -> (U8F8, U8F8) {
        let (front, back) = both_sides(self.ambient, self.diffuse, beams, normal);
        // The one clamp is in `from_intensity`; beyond f32 an intensity becomes infinite, which is
        // more than 1 too.
        let shade = |intensity: f64| U8F8::from_intensity(intensity as f32, self.ramp.first(), self.ramp.entries());
        (shade(front), shade(back))
    }
}

/// A sun as the object of `view` sees it.
pub(super) fn beam(light: &Light, view: &ObjectView) -> Option<Beam> {
    let Light::Sun { direction, intensity, color } = *light else { return None };
    let towards = view.direction_in_object(direction)?;
    let channels = color.map(|c| c * intensity);
    Some(Beam { towards, intensity: light.brightness(), channels })
}

/// A vertex of the object at hand, lit and projected.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct LitVertex {
    /// Its shade is that of the front: the side that the normal points away from. Of a vertex that
    /// needs clipping only the shade counts.
    vertex: Vertex,
    back: U8F8,
    needs_clipping: bool,
}

/// One object in one frame.
pub(super) struct Stage<'a> {
    pub(super) rung: Rung,
    pub(super) object: &'a Object,
    pub(super) view: &'a ObjectView,
    pub(super) beams: &'a [Beam],
    /// One for each surface of the mesh.
    pub(super) paints: &'a [Paint],
}

impl Stage<'_> {
    /// Lights and projects every vertex of the mesh.
    pub(super) fn vertices(&self, lit: &mut Vec<LitVertex>, stats: &mut Stats) {
        let mesh = self.object.mesh();
        let (positions, normals) = (mesh.positions(), mesh.normals());
        lit.clear();
        lit.extend(positions.iter().zip(normals).zip(self.object.vertex_surfaces()).map(
            |((&position, &normal), &surface)| {
                let vertex = self.view.project(position);
                let (front, back) = match self.rung {
                    Rung::Flat => (U8F8::default(), U8F8::default()),
                    _ => self.paint(surface).shades(self.beams, normal),
                };
                LitVertex {
                    vertex: vertex.unwrap_or_default().with_shade(front),
                    back,
                    needs_clipping: vertex.is_none(),
                }
            },
        ));
        stats.vertices += positions.len() as u64;
        if self.rung != Rung::Flat {
            stats.lit += positions.len() as u64;
        }
    }

    /// Hands the faces that are to be drawn to `triangle`, clipped where they must be. Those of a
    /// closed mesh that are turned away are left out; others show their back.
    pub(super) fn faces(&self, lit: &[LitVertex], stats: &mut Stats, triangle: &mut impl FnMut(&[Vertex; 3], Shading)) {
        let mesh = self.object.mesh();
        let two_sided = !mesh.is_closed();
        stats.faces += mesh.triangles().len() as u64;
        for (&indices, &surface) in mesh.triangles().iter().zip(mesh.triangle_surfaces()) {
            // In range: the mesh saw to it, and every vertex is lit.
            let corners = indices.map(|i| lit[i as usize]);
            if corners.iter().any(|corner| corner.needs_clipping) {
                stats.clipped += 1;
                self.clipped(indices, surface, &corners, two_sided, stats, triangle);
                continue;
            }
            let vertices = corners.map(|corner| corner.vertex);
            let area = doubled_area(&vertices);
            if is_culled(area, two_sided) {
                stats.culled += 1;
                continue;
            }
            stats.drawn += 1;
            let shading = self.shading(indices, surface, area > 0, stats);
            if area > 0 {
                triangle(&corners.map(|corner| corner.vertex.with_shade(corner.back)), shading);
            } else {
                triangle(&vertices, shading);
            }
        }
    }

    /// A face that reaches beyond the near plane or the guard band. Kept apart: it is rare.
    #[cold]
    fn clipped(
        &self,
        indices: [u32; 3],
        surface: u16,
        corners: &[LitVertex; 3],
        two_sided: bool,
        stats: &mut Stats,
        triangle: &mut impl FnMut(&[Vertex; 3], Shading),
    ) {
        let positions = self.object.mesh().positions();
        let at = indices.map(|i| self.view.homogeneous(positions[i as usize]));
        let turned = two_sided && is_turned_away(&at);
        let corner = |i: usize| {
            let LitVertex { vertex, back, needs_clipping } = corners[i];
            let shade = if turned { back } else { vertex.shade() };
            let projected = (!needs_clipping).then(|| vertex.with_shade(shade));
            Corner { at: at[i], shade: f64::from(shade.to_bits()), vertex: projected }
        };
        let Some(clipped) = clip(self.view, [corner(0), corner(1), corner(2)]) else { return };
        if is_culled(clipped.doubled_area(), two_sided) {
            stats.culled += 1;
            return;
        }
        let shading = self.shading(indices, surface, turned, stats);
        for part in clipped.parts() {
            stats.drawn += 1;
            triangle(&part, shading);
        }
    }

    /// How a face is shaded; its one shade, where it has but one, is worked out here.
    #[inline]
    fn shading(&self, indices: [u32; 3], surface: u16, turned: bool, stats: &mut Stats) -> Shading {
        match self.rung {
            Rung::Gouraud88 => Shading::Gouraud,
            Rung::GouraudHyperbolic => Shading::GouraudHyperbolic,
            Rung::Flat => {
                stats.lit += 1;
                let mesh = self.object.mesh();
                let [a, b, c] = indices.map(|i| mesh.positions()[i as usize]);
                // A face without area has no normal; rounded, it may still cover a pixel.
                let normal = face_normal(a, b, c).unwrap_or(mesh.normals()[indices[0] as usize]);
                let (front, back) = self.paint(surface).shades(self.beams, normal);
                Shading::Flat(if turned { back } else { front }.nearest())
            }
            _ => Shading::GouraudReseeded,
        }
    }

    #[inline]
    fn paint(&self, surface: u16) -> &Paint {
        // One for each surface, by the renderer's check of the object.
        &self.paints[usize::from(surface)]
    }
}

#[inline]
fn is_culled(doubled_area: i64, two_sided: bool) -> bool {
    doubled_area == 0 || (doubled_area > 0 && !two_sided)
}

/// Whether the eye is behind the face, wherever its corners are: the sign of the volume between
/// the eye and the three corners.
fn is_turned_away(at: &[Homogeneous; 3]) -> bool {
    let [a, b, c] = at;
    let volume = a.w * (b.x * c.y - c.x * b.y) + b.w * (c.x * a.y - a.x * c.y) + c.w * (a.x * b.y - b.x * a.y);
    volume > 0.0
}
