//! Where the project's files are.

use std::path::Path;

/// The folder of the workspace.
pub fn root() -> &'static Path {
    let package = Path::new(env!("CARGO_MANIFEST_DIR"));
    if package.join("lab").is_dir() { package } else { package.parent().expect("a package in the workspace") }
}
