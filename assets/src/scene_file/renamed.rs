//! Keys and values that have been renamed, and one short name. An old name is an error that gives the new one.

use mode13h::settings::Shading;

/// Old keys with their parents, and the new name of each.
const KEYS: [(&str, &str); 2] = [("wishes", "render"), ("render.rung", "shading")];

/// Old values, and the new name of each.
const VALUES: [(&str, &str); 2] = [("gouraud-period", "gouraud-vintage"), ("float", "gouraud-float")];

/// The short name of the default shading.
pub const GOURAUD: &str = "gouraud";

/// The full name for a short name; any other name unchanged.
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

/// The new name of a key.
pub(super) fn key(old: &str) -> Option<&'static str> {
    new_name(&KEYS, old)
}

/// The new name of a value.
pub(super) fn value(old: &str) -> Option<&'static str> {
    new_name(&VALUES, old)
}

fn new_name(names: &[(&str, &'static str)], old: &str) -> Option<&'static str> {
    names.iter().find_map(|(name, new)| (*name == old).then_some(*new))
}
