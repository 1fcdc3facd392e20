//! Skins: the joints that vertices are bound to.

use std::collections::HashMap;

use ::gltf::{Primitive, Semantic, Skin};

use super::accessor::Buffers;
use crate::model_file::rig::place::Placement;
use crate::model_file::rig::{Influences, Matrix, Skeleton};

/// The transforms of each skin, made when first asked for.
#[derive(Default)]
pub(super) struct Skins {
    /// The first index and the number of each skin's transforms in the skeleton.
    known: HashMap<usize, (u32, usize)>,
}

impl Skins {
    /// The first transform of a skin, and the number of its joints. Adds them to the skeleton if they are new.
    pub(super) fn of(
        &mut self,
        skin: &Skin<'_>,
        skeleton: &mut Skeleton,
        buffers: &Buffers,
    ) -> Result<(u32, usize), String> {
        if let Some(known) = self.known.get(&skin.index()) {
            return Ok(*known);
        }
        let part = format!("skins[{}]", skin.index());
        let before = skin.inverse_bind_matrices().map(|accessor| buffers.rows::<16>(&accessor)).transpose();
        let before = before.map_err(|what| format!("{part}: {what}"))?;
        let count = skin.joints().count();
        if let Some(rows) = before.as_ref().filter(|rows| rows.len() < count) {
            return Err(format!("{part}: {} inverse bind matrices for {count} joints", rows.len()));
        }
        let mut first = None;
        let mut stands = vec![false; skeleton.nodes.len()];
        skeleton.order.iter().for_each(|&node| stands[node] = true);
        for (i, joint) in skin.joints().enumerate() {
            let node = joint.index();
            if !stands[node] {
                return Err(format!("{part}: nodes[{node}] is in a cycle"));
            }
            let before = before.as_ref().map(|rows| {
                let columns: [[f64; 4]; 4] =
                    core::array::from_fn(|column| core::array::from_fn(|row| rows[i][4 * column + row]));
                Placement::of_columns(columns)
            });
            let place = skeleton.add(Matrix { node, before });
            first.get_or_insert(place);
        }
        let joints = (first.unwrap_or_default(), count);
        self.known.insert(skin.index(), joints);
        Ok(joints)
    }
}

/// The maximum number of lists of four joints per vertex.
const SETS: u32 = 8;

/// The joints of the vertices of a skinned primitive, and their weights, which add up to 1. `None` if it names none.
///
/// The primitive has `count` vertices, and those in `used` are read.
pub(super) fn influences(
    primitive: &Primitive<'_>,
    count: usize,
    used: &[u32],
    (first, joints): (u32, usize),
    buffers: &Buffers,
) -> Result<Option<Influences>, String> {
    let mut sets = Vec::new();
    for set in 0..SETS {
        // A list that is too short for the vertices is left out.
        let list = |semantic: Semantic| primitive.get(&semantic).filter(|accessor| accessor.count() >= count);
        let (Some(names), Some(weights)) = (list(Semantic::Joints(set)), list(Semantic::Weights(set))) else { break };
        sets.push((buffers.rows_at::<4>(&names, used)?, buffers.rows_at::<4>(&weights, used)?));
    }
    if sets.is_empty() || joints == 0 {
        return Ok(None);
    }
    let mut influences = Influences::default();
    let mut own = Vec::new();
    for vertex in 0..used.len() {
        own.clear();
        for (names, weights) in &sets {
            for (joint, weight) in names[vertex].into_iter().zip(weights[vertex]) {
                if !(weight > 0.0 && weight.is_finite()) {
                    continue;
                }
                let name = joint as usize;
                if name >= joints {
                    return Err(format!("there is no joint {name}, only {joints}"));
                }
                // Below the number of all transforms, which fits.
                own.push((first + name as u32, weight));
            }
        }
        let sum: f64 = own.iter().map(|(_, weight)| weight).sum();
        own.iter_mut().for_each(|(_, weight)| *weight /= sum);
        if own.is_empty() {
            own.push((first, 1.0));
        }
        influences.push(own.iter().copied());
    }
    Ok(Some(influences))
}
