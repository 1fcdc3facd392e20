//! Errors of animations.

use std::error::Error;
use std::fmt;
use std::io;
use std::ops::RangeInclusive;
use std::path::{Path, PathBuf};

use mode13h::export::{ExportError, ExportErrorKind, PictureError};

/// The range of an animation's frames per second.
pub(super) const FRAME_RATES: RangeInclusive<f64> = 0.1..=50.0;

/// The error of an animation that was not written.
#[non_exhaustive]
pub struct AnimationError {
    /// The file that was to be written; `None` if there is none, or not yet.
    pub path: Option<PathBuf>,
    /// The kind of the error.
    pub kind: AnimationErrorKind,
}

/// The kinds of errors of an animation.
#[derive(Debug)]
#[non_exhaustive]
pub enum AnimationErrorKind {
    /// A frame cannot be exported at all.
    Picture(PictureError),
    /// A frame shows a colour that is not among the animation's fixed ones.
    OtherColors,
    /// A frame's size differs from the first frame's.
    OtherSize {
        /// Width and height of the first frame, in pixels.
        first: (usize, usize),
        /// Width and height of this frame, in pixels.
        now: (usize, usize),
    },
    /// The rate is not between [`FrameRate::LOWEST`](super::FrameRate::LOWEST) and
    /// [`FrameRate::HIGHEST`](super::FrameRate::HIGHEST).
    FrameRate {
        /// The rate given.
        frames_per_second: f64,
    },
    /// The animation has no frame.
    NoFrames,
    /// The animation has more or fewer frames than promised.
    FrameCount {
        /// The number of frames that the file's header promises.
        promised: u32,
        /// The number of frames that were added.
        given: u32,
    },
    /// The writer failed.
    Io(io::Error),
    /// The file cannot be written.
    Export(ExportError),
}

impl AnimationError {
    /// Adds the file to the error, so that a write error names it.
    pub(super) fn in_file(self, path: &Path) -> AnimationError {
        match self.kind {
            AnimationErrorKind::Io(error) => ExportError::new(path, ExportErrorKind::from_writing(error)).into(),
            kind => AnimationError { path: Some(path.to_path_buf()), kind },
        }
    }
}

impl fmt::Display for AnimationError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match (&self.path, &self.kind) {
            // This error names the file itself.
            (_, AnimationErrorKind::Export(error)) => write!(f, "{error}"),
            (Some(path), kind) => write!(f, "{}: {kind}", path.display()),
            (None, kind) => write!(f, "{kind}"),
        }
    }
}

impl fmt::Display for AnimationErrorKind {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Picture(error) => write!(f, "{error}"),
            Self::OtherColors => f.write_str("a frame uses a colour that is not in the animation's palette"),
            Self::OtherSize { first, now } => {
                write!(f, "a frame of {} x {} pixels in an animation of {} x {}", now.0, now.1, first.0, first.1)
            }
            Self::FrameRate { frames_per_second: given } => {
                let (lowest, highest) = FRAME_RATES.into_inner();
                let too_fast = if *given > highest { ": browsers slow down anything faster" } else { "" };
                write!(f, "an animation shows {lowest} to {highest} frames a second, not {given}{too_fast}")
            }
            Self::NoFrames => f.write_str("an animation without frames"),
            Self::FrameCount { promised, given } => write!(f, "an animation of {promised} frames was given {given}"),
            Self::Io(error) => write!(f, "{error}"),
            Self::Export(error) => write!(f, "{error}"),
        }
    }
}

crate::errors::debug_as_display!(AnimationError);

impl Error for AnimationError {
    fn source(&self) -> Option<&(dyn Error + 'static)> {
        match &self.kind {
            AnimationErrorKind::Picture(error) => Some(error),
            AnimationErrorKind::Io(error) => Some(error),
            AnimationErrorKind::Export(error) => Some(error),
            _ => None,
        }
    }
}

impl From<AnimationErrorKind> for AnimationError {
    fn from(kind: AnimationErrorKind) -> AnimationError {
        AnimationError { path: None, kind }
    }
}

impl From<PictureError> for AnimationError {
    fn from(error: PictureError) -> AnimationError {
        AnimationErrorKind::Picture(error).into()
    }
}

impl From<io::Error> for AnimationError {
    fn from(error: io::Error) -> AnimationError {
        AnimationErrorKind::Io(error).into()
    }
}

impl From<ExportError> for AnimationError {
    fn from(error: ExportError) -> AnimationError {
        AnimationError { path: Some(error.path.clone()), kind: AnimationErrorKind::Export(error) }
    }
}
