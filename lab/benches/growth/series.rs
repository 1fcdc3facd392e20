//! A series of cases that differ in one quantity, and how their time grows with it.

use crate::case::Case;
use crate::interleaved::median;

pub(crate) struct Series {
    pub(crate) title: &'static str,
    /// The name of x.
    pub(crate) of: &'static str,
    /// The unit that times are given per, besides a frame.
    unit: &'static str,
    pub(crate) cases: Vec<Case>,
}

impl Series {
    pub(crate) fn new(title: &'static str, of: &'static str, unit: &'static str, cases: Vec<Case>) -> Self {
        Self { title, of, unit, cases }
    }

    /// x and the median time in nanoseconds: per frame, or per triangle if the number of triangles is not what grows.
    pub(crate) fn points(&self) -> Vec<(f64, f64)> {
        let each = |case: &Case| if self.of == "pixels" { case.units } else { 1.0 };
        self.cases.iter().map(|case| (case.x, median(case.times.clone()) / each(case))).collect()
    }

    /// The exponent e of time ~ xᵉ, over the points with x from `least` on: the slope of the line through the logarithms,
    /// by least squares.
    pub(crate) fn exponent(&self, least: f64) -> Option<f64> {
        let points: Vec<(f64, f64)> =
            self.points().into_iter().filter(|(x, _)| *x >= least).map(|(x, y)| (x.ln(), y.ln())).collect();
        if points.len() < 2 {
            return None;
        }
        let count = points.len() as f64;
        let (sum_x, sum_y) = points.iter().fold((0.0, 0.0), |sum, point| (sum.0 + point.0, sum.1 + point.1));
        let (mean_x, mean_y) = (sum_x / count, sum_y / count);
        let along: f64 = points.iter().map(|(x, y)| (x - mean_x) * (y - mean_y)).sum();
        let square: f64 = points.iter().map(|(x, _)| (x - mean_x) * (x - mean_x)).sum();
        Some(along / square)
    }

    /// The ratio of the time per face at `to` faces to that at `from`: the median of the rounds' ratios.
    pub(crate) fn growth(&self, from: f64, to: f64) -> Option<f64> {
        // Spheres do not have exactly the number of faces asked for.
        let find = |faces: f64| self.cases.iter().find(|case| (case.x / faces - 1.0).abs() < 0.05);
        let (from, to) = (find(from)?, find(to)?);
        let ratios = from.times.iter().zip(&to.times).map(|(a, b)| (b / to.units) / (a / from.units));
        Some(median(ratios.collect()))
    }

    pub(crate) fn print(&self) {
        let each = format!("ns/{}", self.unit);
        println!("\n{}", self.title);
        println!("{:>10} {:>14} {each:>12} {:>12}", self.of, "us/frame", "pixels");
        let points = self.points();
        let most = points.iter().fold(0.0_f64, |most, (_, ns)| most.max(*ns));
        for (case, (_, ns)) in self.cases.iter().zip(&points) {
            let time = median(case.times.clone());
            let bar = "#".repeat((40.0 + 8.0 * (ns / most).log10()).max(1.0) as usize);
            println!("{:>10} {:>14.1} {:>12.1} {:>12} {bar}", case.x, time / 1e3, time / case.units, case.pixels);
        }
        if let Some(exponent) = self.exponent(0.0) {
            print!("exponent of growth {exponent:.2}");
            match self.exponent(self.large()) {
                Some(large) => println!(", from {} {} on {large:.2}", self.large(), self.of),
                None => println!(),
            }
        }
    }

    /// The x from which on constant costs hardly count.
    fn large(&self) -> f64 {
        match self.of {
            "faces" => 9_000.0,
            "pixels" => 1_000.0,
            _ => 8.0,
        }
    }
}
