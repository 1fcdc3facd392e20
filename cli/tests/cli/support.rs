//! Helpers that several test files share.
#![expect(dead_code, unreachable_pub, reason = "each test program uses its part")]

#[path = "../../../tests/support/film.rs"]
pub mod film;
#[path = "../../../tests/support/picture.rs"]
pub mod picture;
#[path = "../../../tests/support/tried.rs"]
pub mod tried;
#[path = "../../../tests/support/workspace.rs"]
pub mod workspace;
