//! Shading of faces: `--shading`, `--max-error` and `--max-time`.

use clap::Args;
use mode13h::render::Renderer;
use mode13h::scene::Scene;
use mode13h::settings::{Accuracy, Settings, Shading};
use mode13h::span::Kernel;
use mode13h::vga::Vga;
use mode13h_lab::cost::calibrate;

use super::{Drawing, one_of, shades};
use crate::failure::Failure;
use crate::host::clock;

/// How faces are shaded. The scene decides what is not said here, and the library what the scene leaves open.
#[derive(Args, Clone)]
#[command(next_help_heading = "How faces are shaded")]
pub(crate) struct ShadingOptions {
    #[arg(
        long,
        value_name = "NAME",
        value_parser = one_of(Shading::ALL, Shading::name),
        hide_possible_values = true,
        help = "The shading of every face",
        long_help = long_help(),
    )]
    shading: Option<Shading>,
    /// Give each face the cheapest shading that is off by at most E shades
    ///
    /// A shade is 1/255 of full intensity. Not beside --shading.
    #[arg(long, value_name = "E", value_parser = shades, conflicts_with = "shading")]
    max_error: Option<f32>,
    /// Draw each frame within the least error that fits in T milliseconds
    ///
    /// The error is at most 16 shades, or that of --max-error. It is chosen by the times that frames take on this machine.
    /// Not beside --shading.
    #[arg(long, value_name = "T", value_parser = milliseconds, conflicts_with = "shading")]
    max_time: Option<f32>,
}

/// A time for a frame on the command line.
fn milliseconds(words: &str) -> Result<f32, String> {
    match words.parse::<f32>() {
        Ok(number) if number.is_finite() && number > 0.0 => Ok(number),
        _ => Err("not a number of milliseconds above 0".to_string()),
    }
}

impl ShadingOptions {
    /// Accuracy of shades, if that was asked for.
    fn accuracy(&self) -> Option<Accuracy> {
        self.max_error.map(Accuracy::WithinError).or(self.shading.map(Accuracy::Shading))
    }

    /// Accuracy and time that are asked for with these settings of a scene.
    pub(crate) fn asked_for(&self, of_scene: &Settings) -> (Accuracy, Option<f32>) {
        let own = Settings { accuracy: self.accuracy(), max_time: self.max_time, ..Settings::default() };
        let settings = own.or(of_scene);
        (settings.asked_accuracy(), settings.time_for_error())
    }

    /// A renderer that is set as the command line says.
    pub(crate) fn renderer(&self, drawing: &Drawing, kernel: Kernel) -> Renderer {
        let mut renderer = drawing.renderer(kernel);
        (renderer.settings.accuracy, renderer.settings.max_time) = (self.accuracy(), self.max_time);
        renderer
    }

    /// Where the error is to fit in a time, finds it for this scene, says so, and has the renderer draw within it.
    pub(crate) fn settle(renderer: &mut Renderer, scene: &Scene) -> Result<(), Failure> {
        let Some(max_time) = renderer.settings.or(&scene.settings).time_for_error() else { return Ok(()) };
        let stats = calibrate(renderer, scene, &mut Vga::new(), clock()).map_err(Failure::from)?;
        if let Some(error) = stats.max_error {
            let accuracy = Accuracy::WithinError(error);
            match stats.fits {
                true => eprintln!("mode13h: {accuracy}, the least in {max_time} ms"),
                false => eprintln!("mode13h: {accuracy}, which takes more than {max_time} ms"),
            }
            (renderer.settings.accuracy, renderer.settings.max_time) = (Some(accuracy), None);
        }
        Ok(())
    }
}

fn long_help() -> String {
    let names = Shading::ALL.map(Shading::name).join(", ");
    format!(
        "The shading of every face, from cheap to exact: {names}\n\n[default: the scene's, otherwise {}]",
        Shading::default()
    )
}
