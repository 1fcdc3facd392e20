//! A study in a terminal.

use std::path::Path;

use mode13h::render::Shading;
use mode13h_lab::cost::{BudgetRow, OptionRow, ShadingRow, Study, TimeRow, Verdict};

/// The tables of shadings and budgets, and where the rest is.
pub(super) fn text(study: &Study, directory: Option<&Path>) -> String {
    let Study { input, host, kernel, frames, rounds, .. } = study;
    let mut text = format!(
        "{input}: {frames} frames, {rounds} rounds in shuffled order, kernel {kernel}\n{}; {}; {}\n\n",
        host.processor, host.compiler, host.flags
    );
    text += &heading();
    text.extend(study.shadings.iter().map(shading));
    if let Some(row) = study.shadings.iter().find(|row| row.shading == Shading::default()) {
        let percent = row.not_compared * 100.0;
        text += &format!(
            "\ncover: pixels that show another face than the truth. They are not compared; {percent:.2} % of {}'s\n",
            row.shading
        );
    }
    text += "\n* none is as near to lit and faster, as far as times can be told apart. Errors in shades of 1/255: largest against gouraud, largest and root\n  \
             mean square against lit\n\n";
    text += "  budget  within E  largest    swim   µs/frame  best single shading        µs/frame  ratio\n";
    text.extend(study.budget.iter().map(budget));
    if !study.times.is_empty() {
        text += "\n  µs/frame given    frames  within 1.05  accepted  greatest  largest error\n";
        text.extend(study.times.iter().map(time));
    }
    if !study.options.is_empty() {
        text += &format!(
            "\n  {:50}{:>10}  {:>21}  {:>8}{:>8}{:>8}\n",
            "choice", "µs/frame", "ratio", "largest", "rms", "cover"
        );
        text.extend(study.options.iter().map(option));
    }
    for claim in &study.claims {
        let verdict = match claim.verdict {
            Verdict::Holds => "holds",
            Verdict::HoldsInPart => "holds in part",
            Verdict::DoesNotHold => "does not hold",
        };
        text += &format!("\n\"{}\" {verdict}: {}\n", claim.claim, claim.measured);
    }
    if let Some(directory) = directory {
        text += &format!("\nwritten to {}\n", directory.display());
    }
    text
}

fn heading() -> String {
    format!(
        "  {:22}{:>10}  {:>21}  {:>8}{:>8}{:>8}{:>8}{:>8}\n",
        "shading", "µs/frame", "ratio to gouraud-8.8", "gouraud", "lit", "rms", "swim", "cover"
    )
}

fn shading(row: &ShadingRow) -> String {
    let (low, high) = row.ratio_interval;
    format!(
        "{} {:22}{:>10.1}  {:>6.3} ({low:.3} to {high:.3})  {:>8.2}{:>8.2}{:>8.2}{:>8.2}{:>8}\n",
        if row.efficient { '*' } else { ' ' },
        row.shading.name(),
        row.per_frame.median / 1000.0,
        row.ratio,
        row.error_gouraud.max,
        row.error_lit.max,
        row.error_lit.rms,
        row.swim,
        row.cover_errors
    )
}

fn budget(row: &BudgetRow) -> String {
    let best = row.best_single_shading.map_or("none keeps it", |shading| shading.name());
    let time = row.best_single.map_or(String::new(), |time| format!("{:.1}", time.median / 1000.0));
    let ratio = row.ratio.map_or(String::new(), |(ratio, (low, high))| format!("{ratio:.3} ({low:.3} to {high:.3})"));
    format!(
        "  {:>6}  {:>7.3}%  {:>7.2}  {:>6.2}  {:>9.1}  {best:22}  {time:>12}  {ratio}\n",
        row.max_error,
        row.within * 100.0,
        row.largest,
        row.swim,
        row.per_frame.median / 1000.0
    )
}

fn time(row: &TimeRow) -> String {
    format!(
        "  {:>14.1}  {:>8}  {:>10.2}%  {:>8.2}  {:>8}  {:>13.2}\n",
        row.max_time / 1000.0,
        row.frames,
        row.within * 100.0,
        row.mean_error,
        row.max_error,
        row.largest
    )
}

fn option(row: &OptionRow) -> String {
    let (ratio, (low, high)) = row.ratio;
    format!(
        "  {:50}{:>10.1}  {ratio:>6.3} ({low:.3} to {high:.3})  {:>8.2}{:>8.2}{:>8}\n",
        format!("{}: {}", row.aspect, row.name),
        row.per_frame.median / 1000.0,
        row.error.max,
        row.error.rms,
        row.cover_errors
    )
}
