//! Names of numbered series of files.

use std::path::{Path, PathBuf};

use crate::failure::Failure;

/// The names of a series of files.
pub(crate) struct Names {
    /// Text before and after the number, and its minimum number of digits; `None` if the name has no number.
    numbered: Option<(String, usize, String)>,
    out: PathBuf,
}

impl Names {
    pub(crate) fn new(out: &Path, frames: u32) -> Result<Names, Failure> {
        let numbered = out.file_name().and_then(|name| number_in(name.to_str()?));
        if numbered.as_ref().is_some_and(|(_, _, behind)| number_in(behind).is_some()) {
            return Err(Failure::words(format!(
                "{}: a name can hold one number, but this has two places for it",
                out.display()
            )));
        }
        if frames > 1 && numbered.is_none() {
            let reason = "a series of pictures needs a place for the number in its name, such as %04d";
            return Err(Failure::words(format!("{}: {reason}", out.display())));
        }
        Ok(Names { numbered, out: out.to_path_buf() })
    }

    pub(crate) fn of(&self, number: u32) -> PathBuf {
        match &self.numbered {
            Some((before, digits, behind)) => self.out.with_file_name(format!("{before}{number:0digits$}{behind}")),
            None => self.out.clone(),
        }
    }
}

/// Splits a name at `%d` or `%04d` (any digit): the text before it, the minimum number of digits, the text after it.
pub(crate) fn number_in(name: &str) -> Option<(String, usize, String)> {
    name.match_indices('%').find_map(|(at, _)| {
        let behind = &name[at + 1..];
        let (digits, behind) = match behind.strip_prefix('0') {
            Some(padded) => (padded.chars().next()?.to_digit(10)?, padded.get(1..)?),
            None => (1, behind),
        };
        let behind = behind.strip_prefix('d')?;
        // At most 9.
        Some((name[..at].to_string(), digits as usize, behind.to_string()))
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_name_holds_a_number_where_it_says_so() {
        for (out, name) in [
            ("a/b%04d.png", "a/b0007.png"),
            ("%d.png", "7.png"),
            ("%01d.png", "7.png"),
            ("50%-%09d-x.PNG", "50%-000000007-x.PNG"),
            ("100%%d.png", "100%7.png"),
            ("%x%4d%d.png", "%x%4d7.png"),
        ] {
            let names = Names::new(Path::new(out), 8).expect("a number");
            assert_eq!(names.of(7), Path::new(name));
        }
        for out in ["%d%d.png", "100%d-%04d.png"] {
            for frames in [1, 8] {
                assert!(Names::new(Path::new(out), frames).is_err(), "{out}");
            }
        }
        for out in ["a.png", "%.png", "%4d.png", "%0d.png", "%0xd.png", "%04x.png", "%04d/a.png", "%0"] {
            assert!(Names::new(Path::new(out), 8).is_err(), "{out}");
        }
        let one = Names::new(Path::new("a.png"), 1).expect("one picture");
        assert_eq!(one.of(0), Path::new("a.png"));
    }
}
