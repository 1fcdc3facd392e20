//! Failures of the program: one line and an exit status.

use std::fmt;

use mode13h::export::{ExportError, ExportErrorKind, PictureError};
use mode13h::render::RenderError;
use mode13h::window::WindowError;
use mode13h_assets::animation::AnimationError;
use mode13h_assets::model_file::{ModelFileError, ModelFileErrorKind};
use mode13h_assets::scene_file::{SceneError, SceneErrorKind};
use mode13h_assets::texture::LoadErrorKind;
use mode13h_lab::cost::CostError;
use mode13h_lab::explain::ExplainError;

/// The exit statuses, as `--help` lists them.
pub(crate) const EXIT_STATUS: &str = "\
Exit status:
  0    Done
  1    Failed: a file could not be read or written, `verify` found a wrong byte, `cost` found a broken promise
  2    Wrong arguments or wrong input
  130  Interrupted";

/// Line on standard error, and exit status.
#[derive(PartialEq, Debug)]
pub(crate) struct Failure {
    line: String,
    status: u8,
}

impl Failure {
    /// The command line or the input is wrong: status 2.
    pub(crate) fn words(reason: impl fmt::Display) -> Failure {
        Failure::new(&reason, 2)
    }

    /// The work failed: status 1. A check found something, a file could not be read or written, or the system refused
    /// something else.
    pub(crate) fn work(reason: impl fmt::Display) -> Failure {
        Failure::new(&reason, 1)
    }

    fn new(reason: &dyn fmt::Display, status: u8) -> Failure {
        Failure { line: on_one_line(&reason.to_string()), status }
    }

    /// A failure with the same status and another message.
    pub(crate) fn saying(&self, reason: impl fmt::Display) -> Failure {
        Failure::new(&reason, self.status)
    }

    pub(crate) fn status(&self) -> u8 {
        self.status
    }
}

impl fmt::Display for Failure {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.line)
    }
}

/// Errors that are always of one kind.
macro_rules! failures {
    ($($Error:ty => $kind:ident),* $(,)?) => {$(
        impl From<$Error> for Failure {
            fn from(error: $Error) -> Failure {
                Failure::$kind(error)
            }
        }
    )*};
}

failures! {
    RenderError => words,
    ExplainError => words,
    CostError => words,
    PictureError => words,
    AnimationError => work,
    WindowError => work,
    std::io::Error => work,
    rayon::ThreadPoolBuildError => work,
    serde_json::Error => work,
}

impl From<ExportError> for Failure {
    fn from(error: ExportError) -> Failure {
        match error.kind {
            // The picture that was asked for is too large.
            ExportErrorKind::Picture(_) => Failure::words(error),
            _ => Failure::work(error),
        }
    }
}

impl From<ModelFileError> for Failure {
    fn from(error: ModelFileError) -> Failure {
        if is_unreadable(&error.kind) { Failure::work(error) } else { Failure::words(error) }
    }
}

impl From<SceneError> for Failure {
    fn from(error: SceneError) -> Failure {
        let is_unreadable = match &*error.kind {
            SceneErrorKind::Read(_) | SceneErrorKind::Directory | SceneErrorKind::File { .. } => true,
            SceneErrorKind::Model(error) => is_unreadable(&error.kind),
            SceneErrorKind::Texture(error) => matches!(error.kind, LoadErrorKind::Read(_) | LoadErrorKind::NotAFile),
            _ => false,
        };
        if is_unreadable { Failure::work(error) } else { Failure::words(error) }
    }
}

fn is_unreadable(kind: &ModelFileErrorKind) -> bool {
    matches!(kind, ModelFileErrorKind::Read(_) | ModelFileErrorKind::Directory)
}

/// A text without line breaks and other control characters. File names and the contents of files may have them, but an
/// error is one line, and control characters from a file must not reach a terminal.
pub(crate) fn on_one_line(text: &str) -> String {
    text.chars().map(|c| if c.is_control() { ' ' } else { c }).collect()
}
