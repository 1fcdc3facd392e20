//! The short name of the default shading.

use mode13h::settings::Shading;

/// The short name of the default shading.
pub const GOURAUD: &str = "gouraud";

/// The name that a short name stands for; any other name as it is.
///
/// ```
/// use mode13h_assets::scene_file::in_full;
///
/// assert_eq!(in_full("gouraud"), "gouraud-8.8-reseeded");
/// assert_eq!(in_full("gouraud-16.16"), "gouraud-16.16");
/// ```
#[must_use]
pub fn in_full(name: &str) -> &str {
    if name == GOURAUD { Shading::default().name() } else { name }
}
