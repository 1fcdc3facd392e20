//! The first screen: flat shading next to the most accurate one, the ratio of their times, and the curve.

use maud::{Markup, html};
use mode13h::settings::Shading;

use super::figures::{at_most, counted_shades, time};
use super::pictures;
use super::summary::{brief, times};
use crate::cost::{ShadingRow, Study};

/// The first screen of a study; `chart` is its curve, shown alone if there are no two shadings to compare.
pub(super) fn screen(study: &Study, chart: &Markup) -> Markup {
    let Some([cheap, near]) = ends(study) else { return html! { (chart) } };
    let [ratio, words] = price(cheap, near);
    html! {
        p.summary { (sentence(&study.input, cheap, near)) }
        div.first {
            div.bezel {
                @for row in [cheap, near] { (picture(row)) }
                @for row in [cheap, near] {
                    p.side {
                        span { (plain_name(row.shading)) }
                        b { (time(row.per_frame.median)) }
                        span { "off by at most " (counted_shades(&at_most(row.error_lit.max))) }
                    }
                }
                p.ratio { b { (ratio) } " " span { (words) } }
            }
            div { (chart) }
        }
    }
}

/// Flat shading, as on the web page, or else the fastest shading; and the one nearest to light at every pixel. `None`
/// if the two are one and the same, or figures are missing.
fn ends(study: &Study) -> Option<[&ShadingRow; 2]> {
    let is_known = |row: &&ShadingRow| row.per_frame.median.is_finite() && row.error_lit.max.is_finite();
    let known = || study.shadings.iter().filter(is_known);
    let by_time = |a: &&ShadingRow, b: &&ShadingRow| a.per_frame.median.total_cmp(&b.per_frame.median);
    let cheap = known().find(|row| row.shading == Shading::Flat).or_else(|| known().min_by(by_time))?;
    let near = known().min_by(|a, b| a.error_lit.rms.total_cmp(&b.error_lit.rms).then(by_time(a, b)))?;
    (cheap.shading != near.shading).then_some([cheap, near])
}

/// How many times as long the right-hand shading takes, in the form that the web page uses.
fn price(cheap: &ShadingRow, near: &ShadingRow) -> [String; 2] {
    match times(near, cheap) {
        Some(times) if times.is_finite() && times > 0.0 => [format!("{} ×", brief(times)), "the time →".into()],
        Some(_) => ["–".into(), "a time that is not known".into()],
        None => ["the same time".into(), "as far as can be told".into()],
    }
}

/// The result of a study, for a reader who knows none of its terms.
fn sentence(input: &str, cheap: &ShadingRow, near: &ShadingRow) -> String {
    let price = match times(near, cheap) {
        Some(times) if times.is_finite() && times > 0.0 => format!("{} times as long as", brief(times)),
        Some(_) => "a time that is not known, against that of".into(),
        None => "as long, as far as can be told, as".into(),
    };
    let [off, cheap_off] = [near, cheap].map(|row| at_most(row.error_lit.max));
    let gain = if off == cheap_off {
        format!("no pixel is then off by more than {off} of 255 shades, which is no less than before")
    } else {
        format!("no pixel is then off by more than {off} of 255 shades, instead of {cheap_off}")
    };
    format!("On {input}, {} takes {price} {}; {gain}.", plain_name(near.shading), plain_name(cheap.shading))
}

/// A shading in plain words.
fn plain_name(shading: Shading) -> String {
    let name = match shading {
        Shading::Flat => "one shade a face",
        Shading::GouraudVintage => "the straight blend of 1994",
        Shading::Gouraud88 => "a straight blend in 8.8",
        Shading::Gouraud88Reseeded => "a straight blend",
        Shading::Gouraud1616 => "a straight blend in 16.16",
        Shading::GouraudHyperbolic => "a blend that is straight in space",
        Shading::GouraudTessellated => "a straight blend on split faces",
        Shading::PhongTable => "light from a table",
        Shading::Phong => "light at every pixel",
        Shading::GouraudFloat => "a blend in floating point",
        _ => return shading.to_string(),
    };
    name.to_string()
}

fn picture(row: &ShadingRow) -> Markup {
    html! {
        @if let Some(frame) = pictures::frame(&row.picture) {
            img src=(frame) width="320" height="240" alt=(format!("the first frame by {}", plain_name(row.shading)));
        } @else { p.none { "no picture" } }
    }
}
