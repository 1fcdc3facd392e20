//! Shading of faces: `--shading` and `--max-error`.

use clap::Args;
use mode13h::render::{Accuracy, Renderer, Settings, Shading};
use mode13h::scene::Preferences;
use mode13h::span::Kernel;

use super::{Drawing, one_of, shades};

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
}

impl ShadingOptions {
    /// Accuracy of shades, if that was asked for.
    fn accuracy(&self) -> Option<Accuracy> {
        self.max_error.map(Accuracy::WithinError).or(self.shading.map(Accuracy::Shading))
    }

    /// Accuracy that is asked for with these preferences of a scene.
    pub(crate) fn accuracy_for(&self, preferences: &Preferences) -> Accuracy {
        let mut settings = Settings::default();
        settings.accuracy = self.accuracy();
        settings.resolve(preferences).asked
    }

    /// A renderer that is set as the command line says.
    pub(crate) fn renderer(&self, drawing: &Drawing, kernel: Kernel) -> Renderer {
        let mut renderer = drawing.renderer(kernel);
        renderer.settings.accuracy = self.accuracy();
        renderer
    }
}

fn long_help() -> String {
    let names = Shading::ALL.map(Shading::name).join(", ");
    format!(
        "The shading of every face, from cheap to exact: {names}\n\n[default: the scene's, otherwise {}]",
        Shading::default()
    )
}
