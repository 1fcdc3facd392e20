//! How errors print: `Debug` prints like `Display`, because a `main` that returns an error prints
//! it with `Debug`.

/// Implements `Debug` as `Display`.
macro_rules! debug_as_display {
    ($Error:ty) => {
        impl core::fmt::Debug for $Error {
            fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
                core::fmt::Display::fmt(self, f)
            }
        }
    };
}

/// Implements `Debug` as `Display`, and `Error` for an error without a source.
macro_rules! error_type {
    ($Error:ty) => {
        crate::errors::debug_as_display!($Error);
        impl core::error::Error for $Error {}
    };
}

pub(crate) use {debug_as_display, error_type};
