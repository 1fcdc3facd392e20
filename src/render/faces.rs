//! The input from which an object's faces are drawn, and the light of flat-shaded faces.

use alloc::vec::Vec;

use glam::Vec3;

use super::geometry::Geometry;
use super::surface_material::SurfaceMaterial;
use super::vertex::{light_eight, shade_of_intensities};
use super::vertex_columns::VertexColumns;
use crate::fixed::U8F8;
use crate::lanes::{LANES, Points, three};
use crate::light::{Lights, both_sides};
use crate::mesh::normals::face_normal;
use crate::plan::stages::{Lighting, Stages};
use crate::raster::columns::Triangles;
use crate::raster::pick::{CHUNK, Pick};
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

/// The points at which flat-shaded faces are lit: their centres, and their normals there.
#[derive(Clone, Debug, Default)]
pub(super) struct FacePoints {
    /// In a separate list, since suns alone need nothing else.
    normals: Vec<Vec3>,
    centres: Vec<Vec3>,
}

/// The data of one object in one frame from which its faces are drawn.
#[derive(Clone, Copy)]
pub(super) struct Faces<'a> {
    pub(super) shading: Shading,
    pub(super) stages: &'a Stages,
    pub(super) geometry: Geometry<'a>,
    pub(super) view: &'a ObjectView,
    pub(super) lights: Lights<'a>,
    /// One for each surface of the mesh.
    pub(super) materials: &'a [SurfaceMaterial],
    pub(super) columns: &'a VertexColumns,
    /// Where each face is lit, if faces are lit.
    pub(super) points: &'a FacePoints,
    pub(super) kernel: Kernel,
}

impl<'a> Faces<'a> {
    /// The triangles of the geometry.
    pub(super) fn triangles(&self) -> Triangles<'a> {
        self.columns.triangles(&self.geometry)
    }

    /// The single shade of a face, or its three channels, lit at its centre with its own normal.
    pub(super) fn flat(&self, face: Face) -> [U8F8; 3] {
        let FacePoints { normals, centres } = self.points;
        let (normal, centre) = (normals[face.index as usize], centres[face.index as usize]);
        let material = &self.materials[usize::from(face.surface)];
        if self.stages.has_channels() {
            let (front, back) = self.lights.three_channels(&material.reflectance, centre, normal);
            return three(if face.back_facing { back } else { front }, |channel| {
                material.respond(material.shade(channel))
            });
        }
        let (front, back) = if self.stages.lighting == Lighting::All {
            self.lights.one_channel(&material.reflectance, centre, normal)
        } else {
            both_sides(material.reflectance.ambient, material.reflectance.diffuse, self.lights.suns, normal)
        };
        [material.respond(material.shade(if face.back_facing { back } else { front })); 3]
    }

    /// The face that a pick refers to.
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

    /// The surface of up to eight picked faces, if they share one.
    #[inline(always)]
    fn surface_of_all(&self, picks: &[u32]) -> Option<u16> {
        if self.materials.len() == 1 {
            return Some(0);
        }
        let surfaces = self.geometry.triangle_surfaces;
        let first = surfaces[Pick(picks[0]).index()];
        picks.iter().all(|&pick| surfaces[Pick(pick).index()] == first).then_some(first)
    }

    /// The single shade of each picked face, or its three channels.
    pub(super) fn shade_faces(&self, picks: &[u32], flat: &mut [[U8F8; 3]]) {
        let level = self.kernel.simd_level();
        if self.stages.has_channels() {
            self.shade_each(picks, flat);
        } else if self.stages.lighting == Lighting::All {
            light_faces_fully(level, self, picks, flat);
        } else if self.stages.culls() {
            light_faces::<false>(level, self, picks, flat);
        } else {
            light_faces::<true>(level, self, picks, flat);
        }
    }

    /// Lights faces one by one.
    #[cold]
    #[inline(never)]
    fn shade_each(&self, picks: &[u32], flat: &mut [[U8F8; 3]]) {
        for (flat, &pick) in flat.iter_mut().zip(picks) {
            *flat = self.flat(self.face(Pick(pick)));
        }
    }

    /// Stores the shades of up to eight faces of one surface.
    #[inline(always)]
    fn put(material: &SurfaceMaterial, shades: [u16; LANES], flat: &mut [[U8F8; 3]]) {
        for (flat, shade) in flat.iter_mut().zip(shades) {
            *flat = [material.respond(U8F8::from_bits(shade)); 3];
        }
    }
}

compiled_for_each_level! {
    /// The shades of picked flat-shaded faces, each lit with its own normal: suns, no highlights, and one channel.
    fn light_faces[const BOTH: bool][BOTH](faces: &Faces<'_>, picks: &[u32], flat: &mut [[U8F8; 3]]) = light_faces_by;
}

#[inline(always)]
fn light_faces_by<S: F32Lanes8, const BOTH: bool>(s: S, faces: &Faces<'_>, picks: &[u32], flat: &mut [[U8F8; 3]]) {
    let mut normals = [[Vec3::ZERO; LANES]; CHUNK / LANES];
    for (picks, flat) in picks.chunks(CHUNK).zip(flat.chunks_mut(CHUNK)) {
        // All are gathered before the first is used: vector loads stall when their elements have just been stored one
        // by one.
        for (normal, &pick) in normals.as_flattened_mut().iter_mut().zip(picks) {
            *normal = faces.points.normals[Pick(pick).index()];
        }
        for (k, (eight, flat)) in picks.chunks(LANES).zip(flat.chunks_mut(LANES)).enumerate() {
            let Some(surface) = faces.surface_of_all(eight) else {
                faces.shade_each(eight, flat);
                continue;
            };
            let material = &faces.materials[usize::from(surface)];
            let shades = light_eight::<S, BOTH>(s, material, &faces.lights, &normals[k % (CHUNK / LANES)]);
            let mut fronts = s.low_words(shades);
            if BOTH {
                let backs = s.low_words(s.shr_i32(shades, 16));
                for (lane, &pick) in eight.iter().take(LANES).enumerate() {
                    fronts[lane] = if Pick(pick).side() == 0 { fronts[lane] } else { backs[lane] };
                }
            }
            Faces::put(material, fronts, flat);
        }
    }
}

compiled_for_each_level! {
    /// The shades of picked flat-shaded faces, each lit at its centre with its own normal: all light, on one channel.
    fn light_faces_fully[][](faces: &Faces<'_>, picks: &[u32], flat: &mut [[U8F8; 3]])
        = light_faces_fully_by, up to AVX2;
}

#[inline(always)]
fn light_faces_fully_by<S: F32Lanes8>(s: S, faces: &Faces<'_>, picks: &[u32], flat: &mut [[U8F8; 3]]) {
    let FacePoints { normals, centres } = faces.points;
    let mut points: [Points; CHUNK / LANES] = [[[0.0; LANES]; 6]; CHUNK / LANES];
    for (picks, flat) in picks.chunks(CHUNK).zip(flat.chunks_mut(CHUNK)) {
        // As in `light_faces_by`.
        for (k, &pick) in picks.iter().enumerate() {
            let (pick, points, lane) = (Pick(pick), &mut points[k / LANES % (CHUNK / LANES)], k % LANES);
            let (normal, centre) = (normals[pick.index()], centres[pick.index()]);
            // The sign of the visible side's normal.
            let side = if pick.side() == 0 { 1.0 } else { -1.0 };
            points[0][lane] = normal.x * side;
            points[1][lane] = normal.y * side;
            points[2][lane] = normal.z * side;
            points[3][lane] = centre.x;
            points[4][lane] = centre.y;
            points[5][lane] = centre.z;
        }
        for (k, (eight, flat)) in picks.chunks(LANES).zip(flat.chunks_mut(LANES)).enumerate() {
            let Some(surface) = faces.surface_of_all(eight) else {
                faces.shade_each(eight, flat);
                continue;
            };
            let material = &faces.materials[usize::from(surface)];
            let points = &points[k % (CHUNK / LANES)];
            let light = faces.lights.front_of_one_channel::<true>(&material.reflectance, points, faces.kernel);
            Faces::put(material, s.low_words(shade_of_intensities(s, material, s.load_f64(&light))), flat);
        }
    }
}

/// The points at which faces are lit. A face without area has no normal, but once rounded it may
/// still cover a pixel, so it gets the normal of its first corner.
pub(super) fn face_points(geometry: &Geometry<'_>, FacePoints { normals, centres }: &mut FacePoints) {
    let corners = |indices: &[u32; 3]| three(*indices, |i| geometry.positions[i as usize]);
    normals.clear();
    normals.extend(geometry.triangles.iter().map(|indices| {
        let [a, b, c] = corners(indices);
        face_normal(a, b, c).unwrap_or(geometry.normals[indices[0] as usize])
    }));
    centres.clear();
    centres.extend(geometry.triangles.iter().map(|indices| {
        let [a, b, c] = corners(indices);
        // Divided separately, since the sum of three might overflow.
        a / 3.0 + b / 3.0 + c / 3.0
    }));
}

#[cfg(test)]
mod tests {
    use alloc::vec;

    use proptest::prelude::*;

    use super::*;
    use crate::light::{Blend, LampBeam, Reflectance, SunBeam};
    use crate::mesh::shapes;
    use crate::palette::Ramp;
    use crate::plan::Effect;
    use crate::plan::stages::{LitAt, Switches};
    use crate::scene::{Camera, Object};
    use crate::view::{Screen, View};

    fn vector() -> impl Strategy<Value = Vec3> {
        prop::array::uniform3(-1.5_f32..1.5).prop_map(Vec3::from)
    }

    fn material() -> impl Strategy<Value = SurfaceMaterial> {
        let specular = prop_oneof![Just(0.0), 0.0..1.0];
        (0.0..0.5, 0.0..2.0, specular, 0_u8..200).prop_map(|(ambient, diffuse, specular, first)| SurfaceMaterial {
            reflectance: Reflectance {
                ambient,
                diffuse,
                specular,
                shininess: 9.0,
                color: [1.0; 3],
                highlight: [1.0; 3],
            },
            ramp: Ramp::new(first, 50).expect("a legal ramp"),
            texture_size: None,
            environment_size: None,
            blend: Blend::Opaque,
            has_effects: false,
            response: None,
        })
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(500))]
        /// Every picked face gets the shade that it gets alone, in suns or in all light, with one surface or several.
        #[test]
        fn picked_faces_are_lit_as_each_is_alone(
            points in prop::collection::vec((vector(), vector(), any::<bool>()), 1..40),
            picks in prop::collection::vec((any::<usize>(), any::<bool>()), 0..200),
            materials in prop::array::uniform2(material()),
            is_mixed: bool,
            suns in prop::collection::vec((vector(), -0.5_f32..2.0), 0..3),
            lamps in prop::collection::vec((vector(), 0.1_f32..2.0), 0..3),
        ) {
            let face_points = FacePoints {
                normals: points.iter().map(|(normal, ..)| normal.normalize_or(Vec3::X)).collect(),
                centres: points.iter().map(|(_, centre, _)| *centre).collect(),
            };
            let triangle_surfaces: Vec<u16> = points.iter().map(|&(.., second)| u16::from(is_mixed && second)).collect();
            let triangles = vec![[0; 3]; points.len()];
            let suns: Vec<SunBeam> =
                suns.into_iter().map(|(towards, intensity)| SunBeam { towards, intensity, channels: [0.0; 3] }).collect();
            let lamp = |(position, intensity): (Vec3, f32)| LampBeam {
                position: position.to_array().map(f64::from),
                cone: None,
                intensity,
                channels: [0.0; 3],
                inverse_square: 0.1,
            };
            let lamps: Vec<LampBeam> = lamps.into_iter().map(lamp).collect();
            let camera = Camera::default();
            let view = View::new(&camera, Screen::MODE_13H).expect("a legal camera");
            let view = ObjectView::new(&view, &Object::new(shapes::cube()));
            let columns = VertexColumns::default();
            for full in [false, true] {
                let lamps = if full { lamps.as_slice() } else { &[] };
                let mut stages = Stages { lit_at: LitAt::Faces, ..Stages::default() };
                stages.lighting = if full { Lighting::All } else { Lighting::Suns };
                let faces = Faces {
                    shading: Shading::Flat,
                    stages: &stages,
                    geometry: Geometry {
                        triangles: &triangles,
                        triangle_surfaces: &triangle_surfaces,
                        ..Geometry::default()
                    },
                    view: &view,
                    lights: Lights { suns: &suns, lamps, eye: [0.3, 0.2, 5.0] },
                    materials: if is_mixed { &materials } else { &materials[..1] },
                    columns: &columns,
                    points: &face_points,
                    kernel: Kernel::PORTABLE,
                };
                for culls in [false, true] {
                    let switches = Switches::of(|effect| culls && effect == Effect::BackFaceCulling);
                    let stages = Stages { switches, ..stages };
                    let faces = Faces { stages: &stages, ..faces };
                    let picks: Vec<u32> = picks
                        .iter()
                        .map(|&(i, back)| (i % points.len()) as u32 | u32::from(back && !culls) << 31)
                        .collect();
                    let alone: Vec<_> = picks.iter().map(|&pick| faces.flat(faces.face(Pick(pick)))).collect();
                    for kernel in Kernel::available() {
                        let mut flat = vec![[U8F8::default(); 3]; picks.len()];
                        Faces { kernel, ..faces }.shade_faces(&picks, &mut flat);
                        prop_assert_eq!(&flat, &alone);
                    }
                }
            }
        }
    }
}
