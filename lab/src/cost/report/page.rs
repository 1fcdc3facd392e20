//! The file, section by section.

use maud::{DOCTYPE, Markup, PreEscaped, html as markup};

use super::chart::{budget_points_json, points_json, time_points_json};
use super::{budgets, chart_svg, choices, first, method, shadings, summary, times};
use crate::cost::Study;

/// The report's own style, and what it shares with the web page: colours, chart and divider.
const STYLES: [&str; 3] =
    [include_str!("shared/tokens.css"), include_str!("style.css"), include_str!("shared/figures.css")];

const WITHOUT_SCRIPTS: &str = ".pair{display:grid;grid-template-columns:1fr 1fr}.pair img{position:static;clip-path:none}\
    .first{grid-template-columns:minmax(0,1fr)}.chart>svg{min-width:640px}";

/// Chart and divider.
const SCRIPTS: [&str; 2] = [include_str!("shared/chart.js"), include_str!("shared/divider.js")];

/// Redraws the chart to follow the window and its colour scheme, and puts a divider over each pair.
const MOUNT: &str = r#"
for (const chart of document.querySelectorAll("[data-points]")) {
  const points = JSON.parse(chart.dataset.points);
  new ResizeObserver(() => drawChart(chart, points, { ...chart.dataset, height: 420, description: chart.ariaLabel })).observe(chart);
}
for (const pair of document.querySelectorAll(".pair")) divide(pair, pair.dataset.label);
"#;

/// Explains the names in the summary and the errors.
pub(super) const NAMES: &str = "The old loop done right is gouraud-8.8-reseeded, the default; the printed one is gouraud-vintage; phong lights every \
    pixel. A shade is 1/255 of full intensity. Errors are those of the light on a face, before texture, fog and dither: \
    against gouraud, exact linear interpolation of exact vertex light, or against lit, the lighting model at every pixel.";

/// The whole study as one self-contained HTML file: pictures and charts are embedded, and nothing is loaded.
#[must_use]
pub fn html(study: &Study) -> String {
    let title = format!("What accuracy costs: {}", study.input);
    let [arithmetic, model] = summary(study);
    let page = markup! {
        (DOCTYPE)
        html lang="en" {
            head {
                meta charset="utf-8";
                meta name="generator" content="mode13h cost";
                meta name="viewport" content="width=device-width, initial-scale=1";
                title { (title) }
                @for style in STYLES { style { (PreEscaped(style)) } }
                // Without scripts nothing moves the divider, so both pictures stand side by side, and charts keep their
                // size.
                noscript { style { (PreEscaped(WITHOUT_SCRIPTS)) } }
            }
            body {
                main {
                    header {
                        p.kicker { "mode13h cost" }
                        h1 { (title) }
                    }
                    (first::screen(study, &error_chart(study)))
                    section {
                        h2 { "In two sentences" }
                        p { (arithmetic) " " (model) }
                        p.unit { (NAMES) }
                    }
                    (shadings::tables(study))
                    (shadings::pictures(study))
                    (budgets::section(study, || budget_chart(study)))
                    (times::section(study, || time_chart(study)))
                    (choices::options(study))
                    (choices::claims(study))
                    (method::section(study))
                }
                script type="module" { @for script in SCRIPTS { (PreEscaped(script)) } (PreEscaped(MOUNT)) }
            }
        }
    };
    page.into_string()
}

/// Error against time.
fn error_chart(study: &Study) -> Markup {
    let description = "Error against lit and time for a frame of every shading and budget, both logarithmic; the table \
                       below has the figures";
    let axes = ["time for a frame", "error in shades, r.m.s."];
    markup! {
        (chart(description, axes, &points_json(study), Some(&chart_svg(study))))
        p.key {
            span { "Filled and joined: efficient shadings. No shading as accurate is measurably faster." }
            span { "Triangles: budgets, labelled with the accepted error in shades." }
        }
    }
}

fn budget_chart(study: &Study) -> Markup {
    let description = "Accepted error against the time for a frame, both logarithmic; the table has the figures";
    let axes = ["time for a frame", "accepted error in shades"];
    markup! {
        (chart(description, axes, &budget_points_json(study), None))
        p.key {
            span { "Triangles: the budget, face by face." }
            span { "Circles: the cheapest single shading that keeps the same promise." }
        }
    }
}

fn time_chart(study: &Study) -> Markup {
    let description = "Largest error against the time allowed for a frame, both logarithmic; the table has the figures";
    let axes = ["time allowed for a frame", "largest error in shades"];
    chart(description, axes, &time_points_json(study), None)
}

/// A chart that the web page's script draws, or without scripts an SVG, if there is one.
fn chart(description: &str, [across, down]: [&str; 2], points: &str, svg: Option<&str>) -> Markup {
    markup! {
        figure.chart role="img" aria-label=(description) data-points=(points) data-across=(across) data-down=(down) {
            (PreEscaped(svg.unwrap_or("<noscript>The table has the figures.</noscript>")))
        }
    }
}
