//! The chip's scene on this machine: the same bytes that `.ci/chip` gets from a Cortex-M0.

#[path = "../support/chip_scene.rs"]
mod scene;

use crate::support::tried::Tried;
use mode13h_conformance::hash::{START, fnv_1a};

#[test]
fn the_chips_frame_has_the_same_bytes_here() {
    let mut tried = Tried::new("the_chips_frame_has_the_same_bytes_here", 64_000);
    let (mut hash, mut pixels) = (START, Vec::new());
    scene::draw(11, |first, band| {
        assert_eq!(first * scene::WIDTH, pixels.len());
        pixels.extend_from_slice(band);
        hash = fnv_1a(hash, band);
    })
    .expect("a legal scene");
    tried.add(pixels.len() as u64);
    let cube = pixels.iter().filter(|p| (1..128).contains(*p)).count();
    let floor = pixels.iter().filter(|p| **p >= 128).count();
    assert!(cube > 5000 && floor > 20_000, "{cube} pixels of the cube, {floor} of the floor");
    assert_eq!(hash, scene::HASH, "{hash:#018x}");
}
