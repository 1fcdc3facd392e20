//! The errors that the frames of a run were drawn within, in a file: what a time has chosen once is drawn again without
//! a clock, with equal bytes on every machine.
//!
//! Lines of text as in a record: `mode13h run 1`, then for each frame its error in shades, then `end`.

use std::fs::File;
use std::io::{self, BufRead, BufReader};
use std::path::Path;

use super::read::{Lines, excerpt};
use super::{RecordError, RecordErrorKind, VERSION};
use mode13h::export::{ExportError, write_atomically};

/// Errors in shades, one for each frame.
///
/// ```
/// use mode13h_lab::record::Run;
///
/// let run = Run { errors: vec![16.0, 0.5] };
/// let mut file = Vec::new();
/// run.write(&mut file)?;
/// assert_eq!(file, b"mode13h run 1\n16\n0.5\nend\n");
/// assert_eq!(Run::read(&file[..])?, run);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, PartialEq, Debug, Default)]
pub struct Run {
    /// The errors, frame by frame.
    pub errors: Vec<f32>,
}

impl Run {
    /// Reads a run.
    ///
    /// # Errors
    /// A fault of the file, with its line. Nothing of a broken file is used.
    pub fn read(reader: impl BufRead) -> Result<Self, RecordError> {
        let mut lines = Lines::new(reader);
        let result = read(&mut lines);
        result.map_err(|kind| RecordError { line: lines.number(), kind })
    }

    /// The run in the file of that name.
    ///
    /// # Errors
    /// As [`read`](Self::read); a file that cannot be opened is an error of line 0.
    pub fn load(path: impl AsRef<Path>) -> Result<Self, RecordError> {
        let file = File::open(path).map_err(|error| RecordError { line: 0, kind: RecordErrorKind::Read(error) })?;
        Self::read(BufReader::new(file))
    }

    /// Writes the run.
    ///
    /// # Errors
    /// Those of `out`.
    pub fn write(&self, out: &mut dyn io::Write) -> io::Result<()> {
        writeln!(out, "mode13h run {VERSION}")?;
        self.errors.iter().try_for_each(|error| writeln!(out, "{error}"))?;
        writeln!(out, "end")
    }

    /// Writes the run to a file, whole or not at all.
    ///
    /// # Errors
    /// [`ExportError`] if the file cannot be written; what stood there before is then whole.
    pub fn save(&self, path: impl AsRef<Path>) -> Result<(), ExportError> {
        write_atomically(path, |out| self.write(out))
    }
}

fn read(lines: &mut Lines<impl BufRead>) -> Result<Run, RecordErrorKind> {
    match lines.next() {
        Err(RecordErrorKind::NoText) => return Err(RecordErrorKind::NoRun),
        other => other?,
    };
    let Some(version) = lines.text().strip_prefix("mode13h run") else { return Err(RecordErrorKind::NoRun) };
    if version.trim().parse() != Ok(VERSION) {
        return Err(RecordErrorKind::Version { found: excerpt(version.trim()) });
    }
    let mut run = Run::default();
    loop {
        lines.need("an error in shades or \"end\"")?;
        if lines.text() == "end" {
            break;
        }
        match lines.text().parse::<f32>() {
            Ok(error) if error > 0.0 && error.is_finite() => run.errors.push(error),
            _ => {
                let found = excerpt(lines.text());
                return Err(RecordErrorKind::Expected { expected: "an error in shades above 0 or \"end\"", found });
            }
        }
    }
    match lines.next()? {
        true => Err(RecordErrorKind::Expected { expected: "nothing after \"end\"", found: excerpt(lines.text()) }),
        false => Ok(run),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_fault_is_named_with_its_line() {
        for (text, line, what) in [
            ("", 1, "no run: it would begin with"),
            ("mode13h record 1\nend\n", 1, "no run: it would begin with"),
            ("mode13h run 2\nend\n", 1, "a record of version \"2\""),
            ("mode13h run 1\n4\n", 3, "the file ends where an error in shades or \"end\" should follow"),
            ("mode13h run 1\n4\n\n-4\nend\n", 4, "expected an error in shades above 0 or \"end\", found \"-4\""),
            ("mode13h run 1\nNaN\nend\n", 2, "found \"NaN\""),
            ("mode13h run 1\n4 4\nend\n", 2, "found \"4 4\""),
            ("mode13h run 1\nend\n4\n", 3, "expected nothing after \"end\", found \"4\""),
        ] {
            let error = Run::read(text.as_bytes()).expect_err(text);
            assert!(error.line == line && error.to_string().contains(what), "{text:?}: {error}");
        }
        let with_blanks = "# a run\n mode13h run 1 \r\n\n 4 \n# one more\n0.1\nend\n";
        assert_eq!(Run::read(with_blanks.as_bytes()).expect("sound"), Run { errors: vec![4.0, 0.1] });
    }
}
