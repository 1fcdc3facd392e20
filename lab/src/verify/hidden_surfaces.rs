//! Group D: depth buffer, scan-line and the definition agree.

use super::drawing::{self, Configuration, Draw};
use super::random::Random;
use super::triangles::{any_clip, any_shading, any_triangle, vertex};
use super::{Group, oracle, replay};
use crate::record::Record;
use mode13h::Angle;
use mode13h::mesh::shapes;
use mode13h::raster::{Interpolation, Vertex};
use mode13h::render::{HiddenSurfaces, Renderer, Screen};
use mode13h::span::Kernel;

/// Random triangles through each other, in circles, with the same vertices, of one depth (hard cases
/// D1 to D3): the depth buffer's and the scan-line's frames must be the oracle's, to the byte. And
/// convex shapes by all four methods (D4), which must agree wherever the oracle covers a pixel once.
///
/// ```
/// let group = mode13h_lab::verify::hidden_surfaces(13);
/// assert!(group.passed(), "{:?}", group.failures);
/// ```
#[must_use]
pub fn hidden_surfaces(seed: u64) -> Group {
    check(seed, 1_000, &drawing::draw)
}

fn check(seed: u64, cases: u32, draw: Draw<'_>) -> Group {
    let mut group = Group::new("hidden-surfaces");
    let mut random = Random::new(seed, "hidden-surfaces");
    let kernels: Vec<Kernel> = Kernel::available().collect();
    for _ in 0..cases {
        let (width, height) = (1 + random.below(64), 1 + random.below(24));
        let Ok(record) = Record::new(width, height) else { continue };
        let clip = (random.below(4) == 0).then(|| any_clip(&mut random, width, height));
        let mut record = record.with_clip(clip);
        record.background = random.below(256) as u8;
        for _ in 0..=random.below(12) {
            let triangle = face(&mut random, &record);
            record.triangles.push(triangle);
        }
        let kernel = random.one_of(&kernels);
        let rows_each = if random.below(4) == 0 { 1 + random.below(height) } else { 0 };
        for hidden_surfaces in [HiddenSurfaces::DepthBuffer, HiddenSurfaces::ScanLine] {
            let way = Configuration { hidden_surfaces, kernel, rows_each };
            group.check_record("d1", &record, &|record| replay::against_oracle(record, way, draw));
        }
    }
    convex(&mut group, &mut random, draw);
    group
}

/// A face for a frame, with depths that meet those of the others.
fn face(random: &mut Random, record: &Record) -> ([Vertex; 3], Interpolation) {
    let vertices = any_triangle(random, record.width(), record.height());
    let (kind, one) = (random.below(6), random.within(0, 3));
    let deep = |v: Vertex, depth: i64| {
        vertex(v.x().to_bits().into(), v.y().to_bits().into(), v.shade().to_bits().into(), depth)
    };
    let vertices = match (kind, record.triangles.last()) {
        // D3: the same three vertices as the one before, in another order.
        (0, Some((before, _))) => [before[1], before[2], before[0]],
        // D3: of one depth, which others have too; 0 is behind everything.
        (1, _) => vertices.map(|v| deep(v, one)),
        // D2: near each other, so that faces pass through each other.
        (2 | 3, _) => vertices.map(|v| deep(v, random.within(900, 1100))),
        // Steep: as far apart as depths can be.
        (4, _) => vertices.map(|v| deep(v, random.one_of(&[0, 1, 1 << 30, u32::MAX.into()]))),
        _ => vertices,
    };
    let interpolation = any_shading(random);
    // The scan-line method gives exact cover to all.
    (vertices, if interpolation.has_exact_cover() { interpolation } else { Interpolation::default() })
}

/// D4: convex shapes from all sides.
fn convex(group: &mut Group, random: &mut Random, draw: Draw<'_>) {
    for name in ["cube", "sphere", "cone", "cylinder"] {
        let Some(mesh) = shapes::by_name(name) else { continue };
        let mut scene = super::framed(mesh);
        for _ in 0..3 {
            scene.objects_mut()[0].angles = [0; 3].map(|_| random.around_zero(3.2)).map(Angle::from_radians);
            let Ok(record) = Record::of_scene(&mut Renderer::new(), &scene, Screen::MODE_13H) else { continue };
            let once = |place: usize, covered: &[u32]| covered[place] < 2;
            group.check_record("d4", &record, &|record| {
                let by_definition = oracle::frame(record, oracle::NEAREST);
                HiddenSurfaces::ALL.into_iter().find_map(|hidden_surfaces| {
                    let way = Configuration::new(hidden_surfaces, Kernel::default());
                    let mut drawn = match draw(record, way) {
                        Ok(drawn) => drawn,
                        Err(stray) => return Some(format!("{way}: {stray}")),
                    };
                    for (place, pixel) in drawn.iter_mut().enumerate() {
                        if !once(place, &by_definition.covered) {
                            *pixel = by_definition.pixels[place];
                        }
                    }
                    replay::difference(record, &drawn, &by_definition.pixels).map(|difference| {
                        format!("{name}, {way}: {difference}, by the definition {:#04x}", difference.should)
                    })
                })
            });
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_methods_agree() {
        let group = check(1, 100, &drawing::draw);
        assert_eq!(group.failures, [""; 0]);
        assert!(group.cases > 200);
    }

    /// The last of equal depths wins. Two faces, of which the second is wrong, are enough to find a fault in that.
    #[test]
    fn a_tie_decided_wrongly_is_told_by_two_triangles() {
        let last = |record: &Record, way: Configuration| {
            let mut turned = record.clone();
            turned.triangles.reverse();
            drawing::draw(&turned, way)
        };
        let group = check(1, 100, &last);
        assert!(group.failures[0].starts_with("d1 depth-buffer, ") || group.failures[0].starts_with("d1 scan-line, "));
        assert!(group.failures[0].contains(" of triangle 0"), "{:?}", group.failures);
        assert_eq!(group.record.map(|record| record.triangles.len()), Some(2));
    }

    #[test]
    fn painters_order_is_found_out() {
        let painted = |record: &Record, way: Configuration| {
            drawing::draw(record, Configuration { hidden_surfaces: HiddenSurfaces::PainterOrder, ..way })
        };
        let group = check(1, 100, &painted);
        assert!(!group.passed() && group.record.is_some());
    }
}
