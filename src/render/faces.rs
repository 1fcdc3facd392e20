//! Input for the faces of an object, and the light of flat-shaded faces.

use alloc::vec::Vec;

use glam::Vec3;

use super::columns::VertexColumns;
use super::geometry::Geometry;
use super::paint::SurfaceMaterial;
use super::vertex::light_eight;
use crate::fixed::U8F8;
use crate::lanes::{LANES, each, three};
use crate::light::{Lights, both_sides};
use crate::mesh::normals::face_normal;
use crate::raster::columns::Triangles;
use crate::raster::pick::Pick;
use crate::settings::Shading;
use crate::simd::{F32Lanes8, compiled_for_each_level};
use crate::span::Kernel;
use crate::view::ObjectView;

/// A face of the geometry being drawn.
#[derive(Clone, Copy, Debug)]
pub(super) struct Face {
    /// Its index in the mesh, or in the mesh that splitting made of it.
    pub(super) index: u32,
    /// Its vertices.
    pub(super) indices: [u32; 3],
    pub(super) surface: u16,
    pub(super) back_facing: bool,
}

/// The point at which a flat-shaded face is lit: its middle, and its normal there.
#[derive(Clone, Copy, Debug)]
pub(super) struct FacePoint {
    normal: Vec3,
    centre: Vec3,
}

/// One object in one frame: what its faces are drawn from.
pub(super) struct Faces<'a> {
    pub(super) shading: Shading,
    pub(super) geometry: Geometry<'a>,
    pub(super) view: &'a ObjectView,
    pub(super) lights: Lights<'a>,
    /// One for each surface of the mesh.
    pub(super) paints: &'a [SurfaceMaterial],
    pub(super) columns: &'a VertexColumns,
    /// Where each face is lit, if faces are lit.
    pub(super) face_points: &'a [FacePoint],
    /// True if back faces are culled.
    pub(super) culls: bool,
    /// A bit for each triangle that lies back to back with another, 64 in a word; empty if there are none. As a back
    /// face it is culled even where others show their backs: the other one has the same depth, and faces the eye.
    pub(super) twins: &'a [u64],
    /// True if its shades vary; otherwise each surface has a single one.
    pub(super) runs: bool,
    /// True if there are lamps or highlights.
    pub(super) full: bool,
    /// True if faces rather than vertices are lit, each on one channel or on three.
    pub(super) lit_by_face: bool,
    pub(super) channels: bool,
    /// True if texture coordinates are linear on the screen.
    pub(super) affine: bool,
    /// True if pixels may be lit individually.
    pub(super) lights_pixels: bool,
    /// Kernel for the light that decides on a face.
    pub(super) kernel: Kernel,
}

impl<'a> Faces<'a> {
    /// The triangles of the geometry.
    pub(super) fn triangles(&self) -> Triangles<'a> {
        self.columns.triangles(&self.geometry)
    }

    /// The single shade of a face, or its three channels: at its middle, by its own normal.
    pub(super) fn flat(&self, face: Face) -> [U8F8; 3] {
        let FacePoint { normal, centre } = self.face_points[face.index as usize];
        let paint = &self.paints[usize::from(face.surface)];
        if self.channels {
            let (front, back) = self.lights.three_channels(&paint.answer, centre, normal);
            let channels = SurfaceMaterial::channels(if face.back_facing { back } else { front });
            return three(channels, |channel| paint.respond_on_channel(channel));
        }
        let (front, back) = if self.full {
            self.lights.one_channel(&paint.answer, centre, normal)
        } else {
            both_sides(paint.answer.ambient, paint.answer.diffuse, self.lights.suns, normal)
        };
        [paint.respond(paint.shade(if face.back_facing { back } else { front })); 3]
    }

    /// The face of a pick.
    pub(super) fn face(&self, pick: Pick) -> Face {
        let index = pick.index();
        Face {
            // Below `Pick::MAX_COUNT`.
            index: index as u32,
            indices: self.geometry.triangles[index],
            surface: self.geometry.triangle_surfaces[index],
            back_facing: pick.side() != 0,
        }
    }

    /// The surface of eight faces, if they share one.
    #[inline(always)]
    pub(super) fn surface_of_all(&self, faces: &[Pick; LANES]) -> Option<u16> {
        if self.paints.len() == 1 {
            return Some(0);
        }
        let surface = |face: &Pick| self.geometry.triangle_surfaces[face.index()];
        let first = surface(&faces[0]);
        faces.iter().all(|face| surface(face) == first).then_some(first)
    }

    /// The single shade of each picked face, or its three channels; with `CULLS` all of them show their fronts.
    pub(super) fn shade_faces<const CULLS: bool>(&self, kernel: Kernel, picks: &[u32], flat: &mut [[U8F8; 3]]) {
        if self.channels {
            for (flat, &pick) in flat.iter_mut().zip(picks) {
                *flat = self.flat(self.face(Pick(pick)));
            }
        } else if self.full {
            self.shade_in_full_light(kernel, picks, flat);
        } else if CULLS {
            light_faces::<false>(kernel.simd_level(), self, picks, flat);
        } else {
            light_faces::<true>(kernel.simd_level(), self, picks, flat);
        }
    }

    /// [`shade_faces`](Self::shade_faces) with lamps and highlights.
    fn shade_in_full_light(&self, kernel: Kernel, picks: &[u32], flat: &mut [[U8F8; 3]]) {
        for (eight, flat) in picks.chunks(LANES).zip(flat.chunks_mut(LANES)) {
            // Lanes without a face repeat the last one.
            let of: [Pick; LANES] = each!(lane => Pick(eight[if lane < eight.len() { lane } else { eight.len() - 1 }]));
            let Some(surface) = self.surface_of_all(&of) else {
                for (flat, &pick) in flat.iter_mut().zip(eight) {
                    *flat = self.flat(self.face(Pick(pick)));
                }
                continue;
            };
            let paint = &self.paints[usize::from(surface)];
            let mut points = [[0.0; LANES]; 6];
            for (lane, face) in of.iter().enumerate() {
                let FacePoint { normal, centre } = self.face_points[face.index()];
                // For the visible side.
                let n = normal * [1.0, -1.0][face.side()];
                for (axis, value) in [n.x, n.y, n.z, centre.x, centre.y, centre.z].into_iter().enumerate() {
                    points[axis][lane] = value;
                }
            }
            let shades = paint.shade_of_eight(&self.lights.unit_front_of_one_channel(&paint.answer, &points, kernel));
            for (flat, shade) in flat.iter_mut().zip(shades) {
                *flat = [paint.respond(shade); 3];
            }
        }
    }
}

compiled_for_each_level! {
    /// The shades of picked flat-shaded faces, each by its own normal: suns, no highlights, and one channel.
    fn light_faces[const BOTH: bool][BOTH](
        faces: &Faces<'_>,
        picks: &[u32],
        flat: &mut [[U8F8; 3]],
    ) = light_faces_by;
}

#[inline(always)]
fn light_faces_by<S: F32Lanes8, const BOTH: bool>(s: S, faces: &Faces<'_>, picks: &[u32], flat: &mut [[U8F8; 3]]) {
    for (eight, flat) in picks.chunks(LANES).zip(flat.chunks_mut(LANES)) {
        // Lanes without a face repeat the last one.
        let of: [Pick; LANES] = each!(lane => Pick(eight[if lane < eight.len() { lane } else { eight.len() - 1 }]));
        let Some(surface) = faces.surface_of_all(&of) else {
            for (flat, &pick) in flat.iter_mut().zip(eight) {
                *flat = faces.flat(faces.face(Pick(pick)));
            }
            continue;
        };
        let normals: [Vec3; LANES] = each!(lane => faces.face_points[of[lane].index()].normal);
        let (paint, mut shades) = (&faces.paints[usize::from(surface)], [0; LANES]);
        s.store_i32(light_eight::<S, BOTH>(s, paint, &faces.lights, &normals), &mut shades);
        for (lane, flat) in flat.iter_mut().enumerate() {
            // The front's shade is in the lower half.
            let shade = U8F8::from_bits((shades[lane] >> if BOTH { 16 * of[lane].side() } else { 0 }) as u16);
            *flat = [paint.respond(shade); 3];
        }
    }
}

/// The points at which faces are lit. A face without area has no normal, but rounded it may still cover a pixel: it
/// gets the normal of its first corner.
pub(super) fn face_points(geometry: &Geometry<'_>, points: &mut Vec<FacePoint>) {
    points.clear();
    points.extend(geometry.triangles.iter().map(|indices| {
        let [a, b, c] = three(*indices, |i| geometry.positions[i as usize]);
        let normal = face_normal(a, b, c).unwrap_or(geometry.normals[indices[0] as usize]);
        // Each third separately: the sum of three might overflow.
        FacePoint { normal, centre: a / 3.0 + b / 3.0 + c / 3.0 }
    }));
}
