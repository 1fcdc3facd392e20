//! The properties that the fuzzer and the tests of the corpora share.

#[path = "../lab/tests/lab/fuzz_corpus/properties.rs"]
mod properties;

pub use properties::*;
