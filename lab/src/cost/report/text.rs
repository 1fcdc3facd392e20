//! A study in a terminal: the page's sentences and tables, with fewer columns.

use super::page::NAMES;
use super::{budgets, choices, shadings, summary, times};
use crate::cost::{Claim, Study};
use crate::lines::lines;

/// The study as text: the page without its pictures, and with only the most important columns of its tables.
#[must_use]
pub fn text(study: &Study) -> String {
    let Study { input, host, kernel, frames, rounds, .. } = study;
    let mut parts = vec![
        format!("{}\n", summary(study).join("\n")),
        lines(NAMES, 100).join("\n") + "\n",
        format!(
            "{input}: {frames} frames, {rounds} rounds in shuffled order, kernel {kernel}\n{}; {}; {}\n",
            host.processor, host.compiler, host.flags
        ),
        shadings::times(study).text(),
    ];
    if let Some((says, tied)) = shadings::tied(study) {
        parts.push(format!("{says}\n  {}\n", tied.join("\n  ")));
    }
    parts.extend(
        [shadings::errors(study), budgets::table(study), times::table(study), choices::table(study)]
            .map(|table| table.text()),
    );
    for Claim { claim, measured, verdict } in &study.claims {
        parts.push(format!("\"{claim}\" {}: {measured}\n", verdict.name()));
    }
    parts.retain(|part| !part.is_empty());
    parts.join("\n")
}
