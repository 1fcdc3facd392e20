//! Words that are nearly right, and the nearest name.

use std::ffi::OsStr;
use std::path::Path;

use mode13h::mesh::shapes;
use mode13h_assets::shipped;

/// The names of the commands.
pub(crate) const COMMANDS: [&str; 12] =
    ["demo", "render", "list", "scenes", "plan", "explain", "cost", "palette", "cases", "dos", "verify", "generate"];

/// The nearest of some names, if one is near: at most a third of the letters are wrong, missing, too many or swapped.
pub(crate) fn nearest<'a>(word: &str, names: impl IntoIterator<Item = &'a str>) -> Option<&'a str> {
    let far = |name: &str| strsim::damerau_levenshtein(word, name);
    let near = names.into_iter().filter(|name| far(name) * 3 <= name.chars().count().max(word.chars().count()));
    near.min_by_key(|name| far(name))
}

/// The nearest command, if `word` is neither a command nor an INPUT, and no scene or shape is nearer.
pub(crate) fn mistyped_command(word: &OsStr) -> Option<&'static str> {
    let path = Path::new(word);
    let word = word.to_str().filter(|word| !word.starts_with('-'))?;
    if path.symlink_metadata().is_ok() || path.extension().is_some() {
        return None;
    }
    let nearest = nearest(word, COMMANDS.into_iter().chain(inputs())).filter(|nearest| *nearest != word)?;
    COMMANDS.into_iter().find(|name| *name == nearest)
}

/// Says what INPUT should be if it is neither a file nor a name, with the nearest name if one is near.
pub(crate) fn no_input(word: &str) -> String {
    let near = match nearest(word, inputs().chain(COMMANDS)) {
        Some(name) if COMMANDS.contains(&name) => format!("; did you mean the command {name}?"),
        Some(name) => format!("; did you mean {name}?"),
        None => String::new(),
    };
    format!("no such file, scene or shape{near} (mode13h list scenes shows the names)")
}

/// The names of scenes and shapes.
fn inputs() -> impl Iterator<Item = &'static str> {
    shipped::ALL.iter().map(|scene| scene.name).chain(shapes::NAMES)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_nearest_name_is_near() {
        let names = ["render", "scenes", "list", "cost", "plan"];
        for (word, name) in [
            ("rendr", Some("render")),
            ("redner", Some("render")), // typo
            ("scnees", Some("scenes")),
            ("csot", Some("cost")),
            ("plann", Some("plan")),
            ("lsit", Some("list")), // typo
            ("render", Some("render")),
            ("house", None),
            ("x", None),
            ("", None),
        ] {
            assert_eq!(nearest(word, names), name, "{word}");
        }
    }

    #[test]
    fn a_name_that_there_is_was_not_mistyped() {
        for name in inputs().chain(COMMANDS) {
            assert_eq!(mistyped_command(OsStr::new(name)), None, "{name}");
        }
        assert_eq!(mistyped_command(OsStr::new("rendr")), Some("render"));
        assert_eq!(mistyped_command(OsStr::new("rendr.toml")), None);
        assert_eq!(mistyped_command(OsStr::new("--rendr")), None);
    }
}
