//! Tells the program which compiler built it, and how: `mode13h cost` states both beside its timings.

use std::env;
use std::process::Command;

fn main() {
    println!("cargo::rerun-if-changed=build.rs");
    let of = |name: &str| env::var(name).unwrap_or_default();
    let compiler = Command::new(of("RUSTC")).arg("--version").output().map(|output| output.stdout).unwrap_or_default();
    let compiler = String::from_utf8_lossy(&compiler);
    println!("cargo::rustc-env=MODE13H_COMPILER={}", compiler.trim());
    let flags = of("CARGO_ENCODED_RUSTFLAGS").replace('\x1f', " ");
    let flags = if flags.is_empty() { String::new() } else { format!(", {flags}") };
    println!(
        "cargo::rustc-env=MODE13H_FLAGS={}, opt-level {}, {}{flags}",
        of("PROFILE"),
        of("OPT_LEVEL"),
        of("TARGET")
    );
}
