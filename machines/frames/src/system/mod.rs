//! The interface to a machine: an entry point, its arguments, printing a line, and exiting.

#[cfg(not(feature = "std"))]
#[cfg_attr(target_os = "linux", path = "linux.rs")]
#[cfg_attr(target_arch = "wasm32", path = "wasm.rs")]
#[cfg_attr(target_os = "windows", path = "windows.rs")]
#[cfg_attr(target_os = "none", path = "semihosting.rs")]
mod this;
#[cfg(not(feature = "std"))]
pub(crate) use this::{exit, print};

#[cfg(feature = "std")]
pub(crate) fn print(text: &str) {
    print!("{text}");
}
