//! How faces are shaded: `--shading` and `--max-error`.

use clap::Args;
use mode13h::render::{Renderer, Shading};
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
    /// The shading of a scene that prefers this one.
    pub(crate) fn shading(&self, preferred: Option<Shading>) -> Shading {
        self.shading.or(preferred).unwrap_or_default()
    }

    /// The budget of a scene that prefers this one, if any is asked for.
    pub(crate) fn max_error(&self, preferred: Option<f32>) -> Option<f32> {
        self.max_error.or(preferred.filter(|_| self.shading.is_none()))
    }

    /// A renderer that is set as the command line says.
    pub(crate) fn renderer(&self, drawing: &Drawing, kernel: Kernel) -> Renderer {
        let mut renderer = drawing.renderer(kernel);
        if let Some(shading) = self.shading {
            renderer.set_shading(shading);
        }
        renderer.set_max_error(self.max_error);
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
