//! The nearest of several faces, along a piece of a row.
//!
//! Depths are linear along a row before they are truncated to whole units: z, with 24 fraction bits. The truncated
//! depth d = z >> 24 decides, and at equal depths the order of submission. So face i certainly leads face j at a pixel
//! where
//!
//! ```text
//! z_i − z_j ≥ 0       if i was submitted first: truncation keeps the order, or makes them equal
//! z_i − z_j ≥ 2²⁴     if j was: then d_i is greater by at least one
//! ```
//!
//! The difference is linear, so where this holds at both ends it holds everywhere between; where it
//! does not hold at the right end, it holds up to the pixel that one division gives, and from there
//! on the faces are compared again. Where i leads at the first pixel by less than that, only the
//! first pixel is decided. The background counts as a face of depth 0 submitted before all others.

use super::active::List;
use crate::raster::reference::depth::DepthPlane;

/// A unit of depth.
const UNIT: i64 = 1 << 24;
/// The greatest z that is truncated to depth 0.
const BACKGROUND: i64 = UNIT - 1;

/// Finds the face at pixel `x`, `None` for the background, and the pixel up to which it is the nearest. All of the
/// faces `open` cover row `y` from `x` to `end`, at least one pixel.
pub(super) fn lead(open: &[u64], list: &mut List<'_>, x: i32, end: i32, y: i32) -> (Option<usize>, i32) {
    if let [only] = open
        && list.pairs[*only as usize].hides_background
    {
        return (Some(*only as usize), end);
    }
    let mut leader: Option<Leader> = None;
    for slot in open {
        let slot = *slot as usize;
        let pair = &mut list.pairs[slot];
        let (order, plane) = (pair.order, *pair.depth());
        let z = plane.fixed_at(x, y);
        // Truncated as in `DepthPlane::at`; no depth is negative within its triangle.
        let before = match &leader {
            None => z >= UNIT,
            Some(leader) => z >> 24 > leader.z >> 24 || (z >> 24 == leader.z >> 24 && order < leader.order),
        };
        if before {
            leader = Some(Leader { slot, order, plane, z });
        }
    }
    let last = end - 1;
    if x == last {
        return (leader.map(|leader| leader.slot), end);
    }
    let mut until = end;
    let (z, z_last, step) = match &leader {
        Some(Leader { plane, z, .. }) => (*z, plane.fixed_at(last, y), plane.step()),
        None => (BACKGROUND, BACKGROUND, 0),
    };
    // `least` is the lead required. All z are below 2⁵⁶ here, and so is the step over two pixels or more, modulo 2⁶⁴.
    let mut against = |rival: i64, rival_last: i64, rival_step: i64, least: i64| {
        let (lead, lead_last) = (z - rival - least, z_last - rival_last - least);
        if lead < 0 {
            until = x + 1;
        } else if lead_last < 0 {
            // The lead shrinks by more than 0 per pixel, and is used up before `last`.
            let shrinks = rival_step.wrapping_sub(step);
            until = until.min(x + 1 + (lead / shrinks) as i32);
        }
    };
    if leader.is_some() {
        against(BACKGROUND, BACKGROUND, 0, 1);
    }
    for slot in open {
        let slot = *slot as usize;
        let pair = &mut list.pairs[slot];
        let least = match &leader {
            Some(leader) if leader.slot == slot => continue,
            Some(leader) if leader.order < pair.order => 0,
            Some(_) => UNIT,
            None => 0,
        };
        let plane = pair.depth();
        against(plane.fixed_at(x, y), plane.fixed_at(last, y), plane.step(), least);
    }
    (leader.map(|leader| leader.slot), until)
}

struct Leader {
    slot: usize,
    order: usize,
    plane: DepthPlane,
    z: i64,
}
