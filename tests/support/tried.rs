//! How many cases a test tried: counted, printed, and a failure where they are fewer than stated.

pub struct Tried {
    id: &'static str,
    cases: u64,
    at_least: u64,
}

impl Tried {
    /// A count for the hard case `id`; fewer than `at_least` cases fail the test when it ends.
    pub fn new(id: &'static str, at_least: u64) -> Self {
        assert!(at_least > 0);
        Self { id, cases: 0, at_least }
    }

    /// Counts one case.
    pub fn one(&mut self) {
        self.cases += 1;
    }

    /// Whether there are cases left to try; counts the next one if so.
    pub fn more(&mut self) -> bool {
        let more = self.cases < self.at_least;
        self.cases += u64::from(more);
        more
    }
}

impl Drop for Tried {
    fn drop(&mut self) {
        if !std::thread::panicking() {
            println!("tried {}: {} cases", self.id, self.cases);
            assert!(self.cases >= self.at_least, "{}: {} cases tried of {}", self.id, self.cases, self.at_least);
        }
    }
}
