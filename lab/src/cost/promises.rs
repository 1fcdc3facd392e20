//! The promises that a study checks, and its reports on broken ones.

use super::{BudgetRow, ShadingRow, Study};
use mode13h::settings::Shading;

/// Share of pixels that a budget, and any shading compared with it, must keep within the bound.
pub(super) const PROMISE: f64 = 1.0;

/// Greatest time a budget should take, as a ratio to the best single shading's. It is an aim, since it depends on the
/// processor.
const LIMIT: f64 = 1.05;

/// A study warns if at least this share of the covered pixels could not be compared.
const BLIND: f64 = 0.005;

/// Outcome of a promise.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
enum Promise {
    Kept,
    /// The promise cannot be distinguished from a kept one, as the excess may be chance.
    KeptWithinChance,
    Broken,
    /// There is nothing to compare with.
    Void,
    Unmeasured,
}

impl BudgetRow {
    fn accuracy(&self) -> Promise {
        if self.within >= PROMISE { Promise::Kept } else { Promise::Broken }
    }

    fn aim_of_time(&self) -> Promise {
        match (self.best_single_shading, self.ratio) {
            (None, _) => Promise::Void,
            (Some(_), Some((ratio, _))) if ratio <= LIMIT => Promise::Kept,
            (Some(_), Some((ratio, (low, _)))) if ratio > LIMIT && low <= LIMIT => Promise::KeptWithinChance,
            (Some(_), Some((ratio, _))) if ratio > LIMIT => Promise::Broken,
            _ => Promise::Unmeasured,
        }
    }

    /// The verdict on accuracy, which is promised, and on time, which is an aim, in words.
    #[must_use]
    pub fn verdict(&self) -> String {
        let accuracy = if self.accuracy() == Promise::Kept { "accuracy kept" } else { "accuracy not kept" };
        let time = match self.aim_of_time() {
            Promise::Kept => "time within its aim",
            Promise::KeptWithinChance => "time within its aim, as far as can be told",
            Promise::Broken => "time beyond its aim",
            Promise::Void => "no single shading keeps it, so there is no time to aim for",
            Promise::Unmeasured => "time not measured",
        };
        format!("{accuracy}; {time}")
    }
}

impl ShadingRow {
    /// Returns whether some pixel exceeds the shading's bound.
    fn is_beyond_its_bound(&self) -> bool {
        self.excess.is_some_and(|excess| excess > 0.0)
    }
}

/// Returns whether every promise was kept: each budget's error, and each shading's bound if it has one.
#[must_use]
pub fn promises_are_kept(study: &Study) -> bool {
    let is_kept = |row: &BudgetRow| row.accuracy() != Promise::Broken;
    study.budget.iter().all(is_kept) && !study.shadings.iter().any(ShadingRow::is_beyond_its_bound)
}

/// Warnings of a study, one per line: broken promises, and pixels that could not be compared.
#[must_use]
pub fn warnings(study: &Study) -> Vec<String> {
    let mut warnings = Vec::new();
    for row in &study.budget {
        let error = row.max_error;
        if row.accuracy() == Promise::Broken {
            let (share, promise) = (100.0 * row.within, 100.0 * PROMISE);
            warnings.push(format!(
                "the budget of {error} keeps {share:.2} % of the pixels within {error} shades, not {promise} %"
            ));
        }
        if let (Promise::Broken, Some(best), Some((ratio, _))) = (row.aim_of_time(), row.best_single_shading, row.ratio)
        {
            warnings.push(format!(
                "a budget of {error} takes {ratio:.2} times as long as {best}; the aim is at most {LIMIT}"
            ));
        }
    }
    for row in study.shadings.iter().filter(|row| row.is_beyond_its_bound()) {
        let (shading, excess) = (row.shading, row.excess.unwrap_or(0.0));
        warnings.push(format!("{shading} is off by {excess:.2} shades more than its bound"));
    }
    let not_compared = study.budget.iter().map(|row| row.not_compared).fold(0.0, f64::max);
    if not_compared >= BLIND {
        warnings.push(format!("{:.2} % of the covered pixels could not be compared with lit", 100.0 * not_compared));
    }
    warnings
}

/// Shadings with no measurable difference in time, from fast to slow, each with the slower ones, so that no pair is
/// listed twice.
#[must_use]
pub fn ties(study: &Study) -> Vec<(Shading, Vec<Shading>)> {
    let mut rows: Vec<&ShadingRow> = study.shadings.iter().collect();
    rows.sort_by(|a, b| a.per_frame.median.total_cmp(&b.per_frame.median));
    let mut ties = Vec::new();
    for (i, row) in rows.iter().enumerate() {
        let are_tied =
            |other: &&&ShadingRow| row.as_fast_as.contains(&other.shading) || other.as_fast_as.contains(&row.shading);
        let slower: Vec<Shading> = rows[i + 1..].iter().filter(are_tied).map(|other| other.shading).collect();
        if !slower.is_empty() {
            ties.push((row.shading, slower));
        }
    }
    ties
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::cost::Nanoseconds;
    use crate::cost::measure::tests::row;

    fn budget(max_error: f64, within: f64, best: Option<(f64, (f64, f64))>) -> BudgetRow {
        BudgetRow {
            max_error,
            within,
            best_single_shading: best.map(|_| Shading::Phong),
            best_single: best.map(|_| Nanoseconds::default()),
            ratio: best,
            ..BudgetRow::default()
        }
    }

    fn study(shadings: Vec<ShadingRow>, budget: Vec<BudgetRow>) -> Study {
        Study { shadings, budget, ..Study::default() }
    }

    #[test]
    fn a_broken_promise_is_a_warning() {
        for (broken, says) in [
            (
                study(Vec::new(), vec![budget(8.0, PROMISE, None), budget(0.5, 0.9956, None)]),
                "the budget of 0.5 keeps 99.56 % of the pixels within 0.5 shades, not 100 %",
            ),
            (
                study(Vec::new(), vec![budget(4.0, 1.0, Some((1.2, (1.1, 1.3))))]),
                "a budget of 4 takes 1.20 times as long as phong; the aim is at most 1.05",
            ),
            (
                study(vec![ShadingRow { excess: Some(0.125), ..row(Shading::Gouraud88, 1.0, 0.0, &[]) }], Vec::new()),
                "gouraud-8.8 is off by 0.12 shades more than its bound",
            ),
        ] {
            assert_eq!(warnings(&broken), [says]);
            assert_eq!(promises_are_kept(&broken), says.contains("the aim"), "{says}");
        }
        // At the bound, at the limit, and beyond it by no more than chance allows.
        let at_bound = ShadingRow { excess: Some(0.0), ..row(Shading::Gouraud88, 1.0, 0.0, &[]) };
        let times = [(1.05, (1.02, 1.08)), (1.06, (1.04, 1.08))].map(|times| budget(4.0, 1.0, Some(times)));
        let kept = study(vec![at_bound], times.to_vec());
        assert!(warnings(&kept).is_empty() && promises_are_kept(&kept));
        // Pixels that were not compared break no promise, but are reported.
        let blind = study(Vec::new(), vec![BudgetRow { not_compared: 0.68, ..budget(4.0, 1.0, None) }]);
        assert_eq!(warnings(&blind), ["68.00 % of the covered pixels could not be compared with lit"]);
        assert!(promises_are_kept(&blind));
    }

    #[test]
    fn a_verdict_speaks_of_accuracy_and_of_time() {
        let phong = |ratio: f64| Some((ratio, (0.98 * ratio, 1.02 * ratio)));
        for (within, best, text) in [
            (1.0, phong(0.7), "accuracy kept; time within its aim"),
            (0.998_9, phong(1.05), "accuracy not kept; time within its aim"),
            (1.0, phong(1.06), "accuracy kept; time within its aim, as far as can be told"),
            (1.0, phong(1.2), "accuracy kept; time beyond its aim"),
            (1.0, None, "accuracy kept; no single shading keeps it, so there is no time to aim for"),
            (f64::NAN, phong(f64::NAN), "accuracy not kept; time not measured"),
        ] {
            let row = budget(4.0, within, best);
            assert_eq!(row.verdict(), text);
            assert_eq!(promises_are_kept(&study(Vec::new(), vec![row])), !text.contains("not kept"), "{text}");
        }
    }

    #[test]
    fn no_pair_is_listed_twice() {
        use Shading::{Flat, Gouraud88, GouraudFloat};
        let rows = [
            row(GouraudFloat, 3.0, 0.0, &[Flat]),
            row(Flat, 1.0, 0.0, &[GouraudFloat, Gouraud88]),
            row(Gouraud88, 2.0, 0.0, &[Flat]),
        ];
        assert_eq!(ties(&study(rows.to_vec(), Vec::new())), [(Flat, vec![Gouraud88, GouraudFloat])]);
    }
}
