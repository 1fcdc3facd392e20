//! Properties over random values, shrunk by proptest, with the cases counted and the same seed as all other tests.

use std::cell::Cell;

use proptest::strategy::Strategy;
use proptest::test_runner::{Config, RngAlgorithm, TestCaseError, TestRng, TestRunner};

use super::tried::Tried;
use mode13h_conformance::random::seed;

/// Tests `property` on values of `strategy`: as many as `tried` states, or proptest's number of cases
/// (`PROPTEST_CASES`, 256) if that is more.
pub fn property<S: Strategy>(mut tried: Tried, strategy: S, property: impl Fn(S::Value) -> Result<(), TestCaseError>) {
    let mut bytes = [0; 32];
    bytes[..8].copy_from_slice(&seed().to_le_bytes());
    println!("MODE13H_SEED={}", seed());
    let usual = Config::default();
    let cases = usual.cases.max(u32::try_from(tried.stated()).expect("a number of cases"));
    let config = Config { cases, failure_persistence: None, ..usual };
    let done = Cell::new(0);
    let mut runner = TestRunner::new_with_rng(config, TestRng::from_seed(RngAlgorithm::ChaCha, &bytes));
    let result = runner.run(&strategy, |value| {
        property(value)?;
        done.set(done.get() + 1);
        Ok(())
    });
    if let Err(error) = result {
        panic!("{error}");
    }
    tried.add(done.get());
}
