//! How the program ends when it fails: one line and an exit status.

use std::fmt;
use std::process::ExitCode;

/// What is said on standard error, and the exit status.
#[derive(Debug)]
pub(crate) struct Failure {
    line: String,
    status: u8,
}

impl Failure {
    /// The work failed: status 1.
    pub(crate) fn work(reason: impl fmt::Display) -> Failure {
        Failure { line: on_one_line(&reason.to_string()), status: 1 }
    }

    /// The words on the command line were wrong: status 2.
    pub(crate) fn words(reason: impl fmt::Display) -> Failure {
        Failure { line: on_one_line(&reason.to_string()), status: 2 }
    }

    pub(crate) fn status(&self) -> ExitCode {
        ExitCode::from(self.status)
    }
}

impl fmt::Display for Failure {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.line)
    }
}

/// File names and the contents of files may hold line ends and worse; an error is one line, and no terminal is sent
/// what a file says.
pub(crate) fn on_one_line(text: &str) -> String {
    text.chars().map(|c| if c.is_control() { ' ' } else { c }).collect()
}
