//! Every loop of this machine matches its definition, and none is left out.

use mode13h::span::Kernel;
use mode13h_conformance::loops::{Cases, all};

#[test]
fn every_loop_is_its_definition() {
    let outcomes: Vec<_> = all(Cases::quick(13)).collect();
    for outcome in &outcomes {
        assert_eq!(outcome.wrong, None, "{outcome}");
        assert!(outcome.cases > 500, "{outcome}: {} cases", outcome.cases);
    }
    let mut names: Vec<String> = outcomes.iter().map(ToString::to_string).collect();
    names.sort_unstable();
    names.dedup();
    assert_eq!(names.len(), outcomes.len(), "each loop once");
    for kernel in Kernel::available() {
        assert!(outcomes.iter().any(|outcome| outcome.kernel == Some(kernel)), "{kernel}");
    }
    let another: u64 = all(Cases::quick(14)).map(|outcome| outcome.cases).sum();
    assert_eq!(another, outcomes.iter().map(|outcome| outcome.cases).sum::<u64>());
}
