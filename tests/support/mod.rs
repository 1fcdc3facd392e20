//! What several test files share.
#![expect(dead_code, unreachable_pub, reason = "each test program uses its part")]

pub mod display;
#[cfg(feature = "gif")]
pub mod film;
#[cfg(feature = "png")]
pub mod golden;
#[cfg(feature = "alloc")]
pub mod judged;
#[cfg(feature = "alloc")]
pub mod near_plane;
#[cfg(feature = "alloc")]
pub mod odd_views;
pub mod property;
#[cfg(feature = "alloc")]
pub mod scenes;
#[cfg(feature = "scene-files")]
pub mod shipped;
#[cfg(all(feature = "alloc", not(feature = "scene-files")))]
pub mod shipped {
    pub fn scenes() -> impl Iterator<Item = (String, mode13h::scene::Scene)> {
        core::iter::empty()
    }
}
pub mod triangles;
pub mod tried;
pub mod workspace;
