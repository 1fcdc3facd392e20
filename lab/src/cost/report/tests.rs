//! Reports of hand-made studies.

use std::collections::HashSet;

use super::{chart_svg, figures::name_of, html, summary, text};
use crate::cost::{
    Aspect, BudgetRow, Claim, Errors, Host, Nanoseconds, OptionRow, ShadingRow, Split, Study, TimeRow, Verdict,
};
use mode13h::settings::Shading;

fn time(median: f64) -> Nanoseconds {
    Nanoseconds { median, lower_quartile: 0.98 * median, upper_quartile: 1.05 * median }
}

fn errors(max: f64) -> Errors {
    Errors { max, mean: max / 8.0, rms: max / 5.0, off_by_one: 0.25, rms_of_blocks: max / 9.0 }
}

/// A shading whose time is a ratio to 100 µs, and its largest errors.
fn shading(shading: Shading, ratio: f64, gouraud: f64, lit: f64) -> ShadingRow {
    ShadingRow {
        shading,
        per_frame: time(1e5 * ratio),
        per_pixel: 5.0 * ratio,
        per_triangle: 90.0 * ratio,
        ratio,
        ratio_interval: (0.97 * ratio, 1.04 * ratio),
        split: Split { plan: 1e3, vertices: 2e4, setup: 3e4, spans: 4e4, scan_out: 1.6e4 },
        error_gouraud: errors(gouraud),
        error_lit: errors(lit),
        error_palette: 1.5,
        not_compared: 0.001_25,
        swim: 0.4,
        efficient: true,
        picture: (0..64_000).map(|i| (i % 320 * 4 / 5) as u8).collect(),
        error_map: (0..64_000).map(|i| if i % 320 < 20 { f32::NAN } else { (i % 320) as f32 / 16.0 }).collect(),
        ..ShadingRow::default()
    }
}

/// A row whose time cannot be distinguished from another's.
fn tied(row: ShadingRow, with: Shading) -> ShadingRow {
    ShadingRow { as_fast_as: vec![with], ..row }
}

fn budget(max_error: f64, within: f64, best: Option<(Shading, f64)>) -> BudgetRow {
    BudgetRow {
        max_error,
        within,
        not_compared: 0.001_25,
        largest: 1.1 * max_error,
        rms: 0.2 * max_error,
        patch: 12,
        swim: 0.3,
        per_frame: time(1.2e5),
        best_single_shading: best.map(|(shading, _)| shading),
        best_single: best.map(|(_, ratio)| time(1.2e5 / ratio)),
        ratio: best.map(|(_, ratio)| (ratio, (0.98 * ratio, 1.02 * ratio))),
        triangles: vec![(Shading::Flat.into(), 120), (Shading::Phong.into(), 1_380)],
    }
}

fn study(shadings: Vec<ShadingRow>) -> Study {
    Study {
        input: "torus".to_string(),
        host: Host { processor: "a processor".to_string(), ..Host::default() },
        kernel: "portable".to_string(),
        frames: 8,
        rounds: 101,
        shadings,
        ..Study::default()
    }
}

/// A study with every part that one can have.
fn whole() -> Study {
    let shadings =
        Shading::ALL.into_iter().zip(1_u8..).map(|(of, i)| shading(of, f64::from(i), 0.7, 20.0 / f64::from(i)));
    let mut study = study(shadings.collect());
    study.input = "<torus & \"cone\">'s".to_string();
    study.shadings[2].as_fast_as = vec![Shading::Flat, Shading::GouraudFloat];
    study.shadings[3].efficient = false;
    study.budget = vec![budget(8.0, 1.0, Some((Shading::Phong, 0.5))), budget(1.0, 0.93, None)];
    let goal = |max_time, largest| TimeRow {
        max_time,
        frames: 1_200,
        mean_time: 0.9 * max_time,
        least_that_fits: Some(0.5),
        within: 0.996,
        mean_error: 0.8 * largest,
        max_error: 2.0 * largest,
        largest,
    };
    study.times = vec![goal(1e5, 7.5), goal(1.2e5, 0.52)];
    let option = |aspect, name: &str| OptionRow {
        aspect,
        name: name.to_string(),
        per_frame: time(1e5),
        ratio: (1.0, (0.9, 1.1)),
        error: errors(0.5),
        cover_errors: 12_345,
    };
    study.options = vec![option(Aspect::VertexPath, "f32"), option(Aspect::VertexPath, "16.16")];
    let claim = |verdict| Claim { claim: "It <is> so.".to_string(), measured: "3 & 4".to_string(), verdict };
    study.claims = [Verdict::Holds, Verdict::HoldsInPart, Verdict::DoesNotHold].map(claim).to_vec();
    study
}

/// Splits a page into the page without its one script, and the script.
fn apart(page: &str) -> (String, &str) {
    let (before, rest) = page.split_once("<script type=\"module\">").expect("a script");
    let (script, after) = rest.split_once("</script>").expect("an end of the script");
    (format!("{before}{after}"), script)
}

/// Turns an HTML page into XML: replaces the first line, drops the script, and closes void elements.
fn as_xml(page: &str) -> String {
    let (page, _) = apart(page);
    let mut text = page
        .strip_prefix("<!DOCTYPE html>")
        .expect("an HTML file")
        .replace("<noscript>", "")
        .replace("</noscript>", "");
    for name in ["<meta", "<img", "<input"] {
        let mut parts = text.split(name);
        let mut closed = parts.next().unwrap_or_default().to_string();
        for part in parts {
            // No attribute contains an unescaped `>`.
            let (attributes, rest) = part.split_once('>').expect("an end");
            closed += &format!("{name}{attributes}/>{rest}");
        }
        text = closed;
    }
    text
}

fn parsed(text: &str) -> roxmltree::Document<'_> {
    roxmltree::Document::parse(text).unwrap_or_else(|error| panic!("{error}"))
}

#[test]
fn a_report_is_well_formed_and_says_everything() {
    let study = whole();
    let page = html(&study);
    let xml = as_xml(&page);
    let document = parsed(&xml);
    let rows: HashSet<&str> =
        document.descendants().filter(|n| n.has_tag_name("th")).filter_map(|n| n.text()).collect();
    let alternatives: Vec<&str> = document.descendants().filter_map(|n| n.attribute("alt")).collect();
    for shading in Shading::ALL {
        assert!(rows.contains(shading.name()), "{shading} in {rows:?}");
        assert!(alternatives.contains(&format!("frame of {shading}").as_str()), "{shading}");
        assert!(alternatives.contains(&format!("error map of {shading}").as_str()), "{shading}");
    }
    let title = document.descendants().find(|n| n.has_tag_name("h1")).and_then(|n| n.text());
    assert_eq!(title, Some("What accuracy costs: <torus & \"cone\">'s"));
    let text: String = document.descendants().filter(|n| n.is_text()).filter_map(|n| n.text()).collect();
    for part in [
        "there is no time to aim for",
        "The time for a frame",
        "1\u{2009}200",
        "No measurable difference in time",
        "gouraud-8.8 and gouraud-float",
        "holds in part",
        "does not hold",
        "It <is> so.",
        "a processor",
    ] {
        assert!(text.contains(part), "{part}");
    }
    assert!(text.contains(&summary(&study).join(" ")));
}

/// The terminal shows what the page shows: every sentence, and every cell of its tables.
#[test]
fn the_text_says_what_the_page_says() {
    let study = whole();
    let (xml, text) = (as_xml(&html(&study)), text(&study));
    let page: String = parsed(&xml).descendants().filter(|n| n.is_text()).filter_map(|n| n.text()).collect();
    let says = |part: &str| assert!(page.contains(part), "{part}");
    assert!(text.starts_with(&summary(&study).join("\n")) && text.contains("(default)") && text.contains("★"));
    for line in text.lines() {
        // Columns of a table are two spaces apart, and a shared heading is a heading of its own.
        let is_input =
            line.starts_with(study.input.as_str()) || line.starts_with(&study.host.processor) || line.starts_with('"');
        for part in line.split("  ").map(str::trim).filter(|_| !is_input) {
            part.split(": ").for_each(says);
        }
    }
    for claim in &study.claims {
        assert!(text.contains(&format!("\"{}\" {}: {}", claim.claim, claim.verdict.name(), claim.measured)));
    }
}

/// Each heading has rows below it, and each row has a non-empty cell; no pair is listed twice.
#[test]
fn no_table_is_empty_and_no_pair_stands_twice() {
    let mut few = study(vec![shading(Shading::Flat, 1.0, 9.0, 28.0)]);
    few.budget = vec![BudgetRow { triangles: Vec::new(), ..budget(8.0, 1.0, None) }];
    for study in [whole(), few, study(Vec::new())] {
        let xml = as_xml(&html(&study));
        let document = parsed(&xml);
        for table in document.descendants().filter(|n| n.has_tag_name("tbody")) {
            assert!(table.children().any(|row| row.has_tag_name("tr")), "{}", study.input);
        }
        for heading in document.descendants().filter(|n| n.has_tag_name("h3")) {
            let next = heading.next_sibling_element().expect("something below it");
            assert!(next.descendants().any(|n| n.has_tag_name("tr")), "{:?}", heading.text());
        }
    }
    let row = |of, with| tied(shading(of, 1.0, 9.0, 28.0), with);
    let both = study(vec![row(Shading::Flat, Shading::Phong), row(Shading::Phong, Shading::Flat)]);
    for said in [html(&both), text(&both)] {
        assert!(said.contains("flat and phong") && !said.contains("phong and flat"), "{said}");
    }
}

#[test]
fn charts_say_which_way_is_better() {
    let study = whole();
    let svg = chart_svg(&study);
    let document = parsed(&svg);
    let texts: Vec<&str> = document.descendants().filter_map(|n| n.text()).collect();
    assert!(texts.iter().any(|text| text.contains("better: down and left")), "{texts:?}");
    assert!(apart(&html(&study)).1.contains("better: down and left"));
}

#[test]
fn a_report_loads_nothing() {
    let page = html(&whole());
    let own = page.replace("http://www.w3.org/2000/svg", "");
    let (own, script) = apart(&own);
    for call in ["http", "fetch", "import", "XMLHttpRequest", "WebSocket", "src", "eval", "</", "<!"] {
        assert!(!script.contains(call), "{call}");
    }
    for foreign in ["http", "//", "@import", "<script", "<link", "url("] {
        // Base64 contains slashes.
        let outside = own.split('"').filter(|part| !part.starts_with("data:image/png;base64,"));
        assert!(outside.into_iter().all(|part| !part.contains(foreign)), "{foreign}");
    }
}

#[test]
fn the_chart_that_scripts_draw_has_every_point() {
    let study = whole();
    let xml = as_xml(&html(&study));
    let document = parsed(&xml);
    let points = document.descendants().find_map(|n| n.attribute("data-points")).expect("points");
    assert_eq!(points.matches(r#"{"ms":"#).count(), study.shadings.len() + study.budget.len());
    for row in &study.shadings {
        let (ms, error) = (row.per_frame.median / 1e6, row.error_lit.rms);
        let point = format!(r#"{{"ms":{ms},"error":{error},"kind":"shading","name":"{}","#, name_of(row.shading));
        assert!(points.contains(&point), "{point} in {points}");
    }
    for row in &study.budget {
        let end = format!(r#""budget":{}}}"#, row.max_error);
        assert!(points.contains(&end), "{end} in {points}");
    }
    // The budgets' chart has each budget's time and, if there is one, a single shading's; the times' chart has each
    // time.
    let charts: Vec<&str> = document.descendants().filter_map(|n| n.attribute("data-points")).collect();
    let singles =
        study.budget.iter().filter(|row| row.best_single.is_some() && row.best_single_shading.is_some()).count();
    let expected = [charts[0].matches(r#""ms""#).count(), study.budget.len() + singles, study.times.len()];
    assert!(expected.iter().all(|count| *count > 0));
    let counts: Vec<usize> = charts.iter().map(|points| points.matches(r#""ms""#).count()).collect();
    assert_eq!(counts, expected);
    for row in &study.budget {
        let (ms, error) = (row.per_frame.median / 1e6, row.max_error);
        assert!(charts[1].contains(&format!(r#"{{"ms":{ms},"error":{error},"kind":"budget""#)), "{}", charts[1]);
    }
    for row in &study.times {
        let point = format!(r#"{{"ms":{},"error":{},"kind":"budget""#, row.max_time / 1e6, row.largest);
        assert!(charts[2].contains(&point), "{point} in {}", charts[2]);
    }
    // A study without times.
    let mut untimed = self::study(vec![shading(Shading::Flat, f64::NAN, 0.0, 0.0)]);
    untimed.budget.clear();
    assert!(html(&untimed).contains(r#"data-points="[]""#));
}

#[test]
fn charts_name_every_point() {
    let study = whole();
    let chart = chart_svg(&study);
    let texts = |svg: &str| -> Vec<String> {
        let document = parsed(svg);
        let text = document.descendants().filter(|n| n.has_tag_name("text"));
        text.filter_map(|n| n.text()).map(|text| text.trim().to_string()).collect()
    };
    let names = texts(&chart);
    for row in &study.shadings {
        assert!(names.contains(&name_of(row.shading)), "{} in {names:?}", row.shading);
    }
    assert!(names.contains(&"≤ 8".to_string()) && names.contains(&"≤ 1".to_string()), "{names:?}");
    assert!(!names.iter().any(|name| name.contains("drawn at")), "no error is below the floor");
    let page = html(&study);
    assert!(page.contains("7.5") && page.contains("0.52"), "{page}");
    // An error of 0 has a position, and the axis says so.
    let exact = self::study(vec![shading(Shading::Phong, 1.0, 0.0, 0.0)]);
    assert!(texts(&chart_svg(&exact)).iter().any(|name| name.contains("below 0.01 drawn at 0.01")));
}

#[test]
fn nothing_and_no_number_are_reported_too() {
    let empty = study(Vec::new());
    let mut nan = shading(Shading::Gouraud88, f64::NAN, f64::NAN, f64::NAN);
    (nan.picture, nan.error_map) = (Vec::new(), vec![f32::NAN; 3]);
    nan.split = Split { plan: f64::NAN, ..Split::default() };
    let mut strange = study(vec![nan, shading(Shading::Phong, 0.0, f64::INFINITY, -1.0)]);
    strange.budget = vec![budget(f64::NAN, f64::NAN, Some((Shading::Flat, f64::NAN))), budget(0.0, 0.0, None)];
    strange.budget[1].triangles.clear();
    strange.times =
        vec![TimeRow { max_time: f64::NAN, largest: f64::INFINITY, ..TimeRow::default() }, TimeRow::default()];
    for study in [empty, strange] {
        let page = html(&study);
        parsed(&as_xml(&page));
        parsed(&chart_svg(&study));
        assert!(!page.contains("NaN") && !page.contains("inf "));
    }
}

#[test]
fn a_summary_is_true_of_any_figures() {
    use Shading::{Flat, Gouraud88, Gouraud88Reseeded, GouraudVintage, Phong};
    let done_right = || shading(Gouraud88Reseeded, 1.0, 0.6, 14.6);
    let cases: Vec<(Vec<ShadingRow>, &str)> = vec![
        (
            vec![shading(GouraudVintage, 2.0, 9.0, 12.0), done_right(), shading(Phong, 5.8, 0.0, 1.4)],
            "On torus the old loop, done right, is within 0.6 of 255 shades of exact and 2 times as fast as the printed \
             one. Lighting every pixel takes the error from 14.6 to 1.4 shades and 5.8 times as long.",
        ),
        (
            vec![shading(GouraudVintage, 0.8, 9.0, 12.0), done_right(), shading(Phong, 0.9, 0.0, 0.0)],
            "On torus the old loop, done right, is within 0.6 of 255 shades of exact and takes 1.25 times as long as the \
             printed one. Lighting every pixel takes the error from 14.6 to 0 shades and 0.9 times as long.",
        ),
        (
            vec![tied(shading(GouraudVintage, 1.01, 9.0, 12.0), Gouraud88Reseeded), done_right()],
            "On torus the old loop, done right, is within 0.6 of 255 shades of exact and as fast as the printed one, as \
             far as can be told. It differs from light at every pixel by up to 14.6 shades.",
        ),
        (
            vec![shading(Gouraud88Reseeded, 1.0, 0.0, 0.0), shading(Phong, 5.0, 0.0, 0.0)],
            "On torus the old loop, done right, is exact and takes 100 µs a frame. Lighting every pixel leaves the error \
             at 0 shades and takes 5 times as long.",
        ),
        (
            vec![shading(Gouraud88, 1.1, 0.991, 0.5), shading(Phong, 5.5, 0.0, 0.51)],
            "On torus the old loop is within 1 of 255 shades of exact and takes 110 µs a frame. Lighting every pixel \
             leaves the error at 0.51 shades and takes 5 times as long.",
        ),
        (
            vec![done_right(), shading(Phong, 2.0, 0.0, 15.03)],
            "On torus the old loop, done right, is within 0.6 of 255 shades of exact and takes 100 µs a frame. Lighting \
             every pixel takes the error from 14.6 to 15.1 shades and 2 times as long.",
        ),
        (
            vec![shading(Gouraud88Reseeded, f64::NAN, f64::NAN, f64::NAN), shading(Phong, 2.0, 0.0, 1.0)],
            "On torus the old loop, done right, has an error that is not known and takes a time that is not known. What \
             lighting every pixel gains is not known; it takes a time that is not known.",
        ),
        (
            vec![shading(Flat, 1.0, 9.0, 28.0), shading(Phong, 5.0, 0.0, 0.5)],
            "On torus the fastest shading measured is flat: within 28 shades of light at every pixel, in 100 µs \
             per frame. The nearest is phong: off by at most 0.5 shades; it takes 5 times as long as that.",
        ),
        (
            vec![shading(Flat, 1.0, 9.0, 28.0)],
            "On torus the fastest shading measured is flat: within 28 shades of light at every pixel, in 100 µs \
             per frame. No other shading measured is nearer.",
        ),
        (Vec::new(), "On torus no shading was measured. So there is nothing to compare."),
    ];
    for (shadings, text) in cases {
        assert_eq!(summary(&study(shadings)).join(" "), text);
    }
}

#[test]
fn the_first_screen_says_what_accuracy_costs() {
    use Shading::{Flat, Gouraud88, Phong};
    let cases = [
        // The left one is flat shading, although another is faster.
        (
            vec![shading(Flat, 1.0, 9.0, 28.0), shading(Gouraud88, 0.5, 0.6, 14.6), shading(Phong, 5.8, 0.0, 0.5)],
            Some((
                "On torus, light at every pixel takes 5.8 times as long as one shade a face; no pixel is then off by \
                 more than 0.5 of 255 shades, instead of 28.",
                "<b>5.8 ×</b> <span>the time →</span>",
            )),
        ),
        (
            vec![shading(Phong, 3.0, 0.0, 0.5), shading(Gouraud88, 1.0, 0.6, 0.5)],
            // With equal errors the faster one is both ends.
            None,
        ),
        (
            vec![tied(shading(Phong, 1.01, 0.0, 0.5), Gouraud88), shading(Gouraud88, 1.0, 0.6, 14.6)],
            Some((
                "On torus, light at every pixel takes as long, as far as can be told, as a straight blend in 8.8; no \
                 pixel is then off by more than 0.5 of 255 shades, instead of 14.6.",
                "<b>the same time</b> <span>as far as can be told</span>",
            )),
        ),
        (vec![shading(Phong, 3.0, 0.0, 0.5)], None),
        (vec![shading(Flat, 1.0, 0.0, f64::NAN), shading(Phong, f64::NAN, 0.0, 0.5)], None),
        (Vec::new(), None),
    ];
    for (shadings, expected) in cases {
        let page = html(&study(shadings));
        let Some((sentence, ratio)) = expected else {
            assert!(!page.contains("bezel\""), "nothing to compare");
            continue;
        };
        let [sentence_at, ratio_at, chart_at, tables_at] = [sentence, ratio, "data-points", "The shadings"]
            .map(|part| page.find(part).unwrap_or_else(|| panic!("no {part}")));
        assert!(sentence_at < ratio_at && ratio_at < chart_at && chart_at < tables_at);
        assert_eq!(page[sentence_at..chart_at].matches("src=\"data:image/png;base64,").count(), 2);
    }
}
