//! The file, section by section.

use maud::{DOCTYPE, Markup, PreEscaped, html as markup};

use super::{budget_svg, budgets, chart_svg, choices, method, shadings, summary, time_svg, times};
use crate::cost::Study;

const STYLE: &str = include_str!("style.css");

/// The whole study as one HTML file that needs nothing else: pictures and charts are in it, and nothing is loaded.
#[must_use]
pub fn html(study: &Study) -> String {
    let title = format!("What accuracy costs: {}", study.input);
    let [first, second] = summary(study);
    let page = markup! {
        (DOCTYPE)
        html lang="en" {
            head {
                meta charset="utf-8";
                meta name="viewport" content="width=device-width, initial-scale=1";
                title { (title) }
                style { (PreEscaped(STYLE)) }
                // Without scripts nothing moves the slider, so both pictures stand side by side.
                noscript { style { ".pair{display:grid;grid-template-columns:1fr 1fr}.pair img{position:static;clip-path:none}.slide{display:none}" } }
            }
            body {
                main {
                    header {
                        p.kicker { "mode13h cost" }
                        h1 { (title) }
                        p.summary { (first) " " (second) }
                        p.unit {
                            "A shade is 1/255 of full intensity. Errors are those of the light on a face, before texture, fog and dither: "
                            "against " em { "gouraud" } ", exact linear interpolation of exact vertex light, which shows what arithmetic does, and "
                            "against " em { "lit" } ", the lighting model at every pixel, which shows what the technique does."
                        }
                    }
                    section {
                        h2 { "Error against time" }
                        (chart(&chart_svg(study), "Error against lit and time for a frame of every shading and budget, both logarithmic; the table below has the figures"))
                    }
                    (shadings::tables(study))
                    (shadings::pictures(study))
                    (budgets::section(study, || chart(&budget_svg(study), "Time for a frame against the accepted error, both logarithmic; the table has the figures")))
                    (times::section(study, || chart(&time_svg(study), "Largest error against the time that is given for a frame, both logarithmic; the table has the figures")))
                    (choices::options(study))
                    (choices::claims(study))
                    (method::section(study))
                }
            }
        }
    };
    page.into_string()
}

fn chart(svg: &str, description: &str) -> Markup {
    markup! { figure.chart role="img" aria-label=(description) { (PreEscaped(svg)) } }
}
