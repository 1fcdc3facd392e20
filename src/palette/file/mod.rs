//! Palette files.
