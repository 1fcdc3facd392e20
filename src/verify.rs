//! The hard cases on the user's own machine, in a quick form. Prints nothing.

/// What one group of checks found.
#[derive(Clone, PartialEq, Eq, Debug)]
#[non_exhaustive]
pub struct Group {
    /// Its name, such as `spans`.
    pub name: &'static str,
    /// How many cases were tried. A group that tried none has shown nothing.
    pub cases: u64,
    /// One line for each case that failed, small enough to read; empty if all went well.
    pub failures: Vec<String>,
}
