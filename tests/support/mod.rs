//! What several test files share.
#![expect(dead_code, reason = "each test file uses its part")]

pub mod display;
pub mod oracle;
