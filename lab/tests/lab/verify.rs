//! The self-checks: that they pass, that they are quick, what the program says of them; and the one hash
//! over the frames.

use crate::support::tried::Tried;
use mode13h::span::Kernel;
use mode13h_conformance::random::seed;
use mode13h_lab::verify::{self, Frames, Group};

/// Every machine draws these frames. A change of the engine's bytes belongs into CHANGELOG.md; it is
/// written here and in `lab/src/verify/frames.rs`.
const HASH: u64 = 0x6F06_1FAC_3D2B_F1DD;

#[test]
fn the_frames_are_those_of_every_machine() {
    let mut tried = Tried::new("the_frames_are_those_of_every_machine", 880);
    for kernel in Kernel::available() {
        let frames = verify::frames(kernel);
        assert_eq!(frames.hash, HASH, "{kernel}: {:#018x}", frames.hash);
        assert!(frames.passed());
        tried.add(frames.count);
    }
    assert_eq!(Frames::EXPECTED.hash, HASH);
}

#[test]
fn every_group_passes() {
    // What each tries at least, in their order.
    let stated = [190_000 / 8, 80_000, 8_000, 3_700, 40_000, 2_000, 14_000, 150, 900];
    for (group, stated) in verify::GROUPS.into_iter().zip(stated) {
        let Group { name, cases, failures, record, .. } = group(seed());
        assert!(failures.is_empty() && record.is_none(), "{name}: {failures:#?}");
        Tried::new(format!("verify_{name}"), stated).add(cases);
    }
}

#[test]
fn the_same_seed_tries_the_same_cases() {
    let mut tried = Tried::new("the_same_seed_tries_the_same_cases", 2);
    for group in [verify::triangles, verify::files] {
        assert_eq!(group(5), group(5));
        tried.add(1);
    }
}
