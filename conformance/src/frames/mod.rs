//! Whole frames by name, each with its hash.
