//! Shading of faces: `--shading`, `--max-error` and `--max-time`.

use clap::Args;
use std::time::Duration;

use mode13h::render::{Pace, Renderer};
use mode13h::scene::Scene;
use mode13h::settings::{Accuracy, Settings, Shading, VertexPath};
use mode13h::span::Kernel;
use mode13h::vga::Vga;
use mode13h_assets::scene_file::GOURAUD;
use mode13h_lab::cost::calibrate;

use super::{Drawing, number, shades, shading_of};
use crate::failure::Failure;
use crate::host::clock;
use crate::output;

/// How faces are shaded. The scene decides what is not said here, and the library what the scene leaves open.
#[derive(Args, Clone)]
#[command(next_help_heading = "Shading")]
pub(crate) struct ShadingOptions {
    #[arg(
        long,
        value_name = "NAME",
        value_parser = shading_of(Shading::ALL),
        hide_possible_values = true,
        help = "Shade every face by this method",
        long_help = long_help(),
    )]
    shading: Option<Shading>,
    /// Use the cheapest shading within E shades of error
    ///
    /// A shade is 1/255 of full intensity. Not with --shading.
    #[arg(long, value_name = "E", value_parser = shades, conflicts_with = "shading")]
    max_error: Option<f32>,
    /// Draw with the smallest error that fits in T milliseconds
    ///
    /// The error is found by timing frames, and is at most 16 shades, or --max-error. Not with --shading.
    #[arg(long, value_name = "T", value_parser = milliseconds, conflicts_with = "shading")]
    max_time: Option<f32>,
}

/// A time for a frame on the command line.
fn milliseconds(words: &str) -> Result<f32, String> {
    number(words, " of milliseconds above 0", |time| *time > 0.0 && duration(*time).is_some())
}

/// Milliseconds as a duration; `None` if they are negative or too many for one.
fn duration(milliseconds: f32) -> Option<Duration> {
    Duration::try_from_secs_f32(milliseconds / 1000.0).ok()
}

/// The pace that gives each frame this many milliseconds, within this error.
pub(crate) fn pace(milliseconds: f32, max_error: f32) -> Pace {
    Pace::new(duration(milliseconds).unwrap_or_default()).at_most(max_error)
}

impl ShadingOptions {
    /// Accuracy of shades, if the command line sets one.
    fn accuracy(&self) -> Option<Accuracy> {
        self.max_error.map(Accuracy::WithinError).or(self.shading.map(Accuracy::Shading))
    }

    /// Accuracy and time that result from the command line and these settings of a scene.
    pub(crate) fn asked_for(&self, of_scene: &Settings) -> (Accuracy, Option<f32>) {
        match self.max_time {
            Some(_) => (Accuracy::WithinError(self.max_error.unwrap_or(Pace::MAX_ERROR)), self.max_time),
            None => (self.accuracy().or(of_scene.accuracy).unwrap_or_default(), None),
        }
    }

    /// The time for a frame, in milliseconds.
    pub(crate) fn max_time(&self) -> Option<f32> {
        self.max_time
    }

    /// The pace of the frames of this renderer, if a time was asked for and its vertex path supports budgets.
    pub(crate) fn pace(&self, renderer: &Renderer) -> Option<Pace> {
        let knows_budgets = renderer.settings.vertex_path != Some(VertexPath::Integer);
        let max_error = self.max_error.unwrap_or(Pace::MAX_ERROR);
        self.max_time.filter(|_| knows_budgets).map(|milliseconds| pace(milliseconds, max_error))
    }

    /// Names the options that the 16.16 path of this renderer ignores.
    pub(crate) fn note_ignored(&self, renderer: &Renderer) {
        if renderer.settings.vertex_path != Some(VertexPath::Integer) {
            return;
        }
        let shading = self.shading.filter(|shading| shading.in_integers() != *shading);
        let ignored = [
            shading.map(|shading| format!("--shading {shading}")),
            self.max_error.map(|_| "--max-error".to_string()),
            self.max_time.map(|_| "--max-time".to_string()),
        ];
        let ignored: Vec<String> = ignored.into_iter().flatten().collect();
        if !ignored.is_empty() {
            output::note(format_args!("ignored, because vertices are computed in 16.16: {}", ignored.join(", ")));
        }
    }

    /// A renderer with the settings of the command line.
    pub(crate) fn renderer(&self, drawing: &Drawing, kernel: Kernel) -> Renderer {
        let mut renderer = drawing.renderer(kernel);
        renderer.settings.accuracy = self.accuracy();
        renderer
    }

    /// Finds the error for this scene if frames have to fit in a time, prints it, and has the renderer draw within it.
    pub(crate) fn settle(&self, renderer: &mut Renderer, scene: &Scene) -> Result<(), Failure> {
        self.note_ignored(renderer);
        let (Some(max_time), Some(mut pace)) = (self.max_time, self.pace(renderer)) else { return Ok(()) };
        calibrate((renderer, &mut pace), scene, &mut Vga::new(), clock())?;
        let accuracy = pace.accuracy();
        match pace.fits() {
            true => output::remark(format_args!("{accuracy}, the smallest error that fits in {max_time} ms")),
            false => output::note(format_args!("{accuracy}, which takes more than {max_time} ms")),
        }
        renderer.settings.accuracy = Some(accuracy);
        // A renderer without the vertices of the timed frames, so that the next frame is its first.
        *renderer = renderer.with_same_settings();
        Ok(())
    }
}

fn long_help() -> String {
    let names = Shading::ALL.map(Shading::name).join(", ");
    format!(
        "Shade every face by this method, from cheap to exact: {names}. `mode13h list shadings` explains them.\n\n[default: \
         the scene's, or else {GOURAUD}, which is short for {}]",
        Shading::default()
    )
}
