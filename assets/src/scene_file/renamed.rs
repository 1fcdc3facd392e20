//! Keys and values that had other names before. An old name is an error that says the new one.

/// Old keys, with those they lay in, and the present name of each.
const KEYS: [(&str, &str); 2] = [("wishes", "render"), ("render.rung", "shading")];

/// Old values, and the present name of each.
const VALUES: [(&str, &str); 1] = [("gouraud-period", "gouraud-vintage")];

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
