//! The properties that the fuzzer and the tests of the corpora share.

#[path = "../tests/fuzz_corpus/properties.rs"]
mod properties;

pub use properties::*;
