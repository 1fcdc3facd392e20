//! Faults of depth: which face a pixel shows.

use super::{Sample, samples};
use crate::hard_cases::face::Face;
use crate::hard_cases::panel::Panel;

/// Painter's order: polygons drawn over one another, starting with the one whose middle is farthest.
pub(in crate::hard_cases) fn painters_order(panel: &mut Panel, polygons: &[&[Face]]) {
    let middle = |faces: &[Face]| faces.iter().flat_map(|face| face.corners).map(|corner| corner.depth).sum::<f64>();
    let mut order = polygons.to_vec();
    order.sort_by(|a, b| middle(a).total_cmp(&middle(b)));
    for faces in order {
        super::paint(panel, faces);
    }
}

/// A 16-bit depth buffer: near / w in steps of 1/65,536. Far away two faces share a step, and the one drawn first wins
/// even if the other is nearer.
pub(in crate::hard_cases) fn buffer_of_16_bits(panel: &mut Panel, faces: &[Face]) {
    buffered(panel, faces, |face, sample| (sample.of(face.corners.map(|c| c.depth)) * 65_536.0).floor());
}

/// Depth summed in f32 from the face's first corner, which rounds differently if the corners come in another order: two
/// coincident faces each win here and there.
pub(in crate::hard_cases) fn rounded_from_the_first_corner(panel: &mut Panel, faces: &[Face]) {
    buffered(panel, faces, |face, sample| {
        let [a, b, c] = face.corners.map(|corner| corner.depth as f32);
        let [_, along_b, along_c] = sample.weights.map(|weight| weight as f32);
        f64::from(a + along_b * (b - a) + along_c * (c - a))
    });
}

fn buffered(panel: &mut Panel, faces: &[Face], depth: impl Fn(&Face, &Sample) -> f64) {
    let size = (panel.width(), panel.height());
    let mut depths = vec![0.0; size.0 * size.1];
    for face in faces {
        for sample in samples(size, &face.corners) {
            let held = &mut depths[sample.y as usize * size.0 + sample.x as usize];
            let depth = depth(face, &sample);
            if depth > *held {
                *held = depth;
                panel.write(sample.x, sample.y, sample.byte(face));
            }
        }
    }
}
