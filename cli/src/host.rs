//! The machine and the program, by name.

use std::fs;
use std::process::Command;

use mode13h_lab::cost::{Clock, Host};

/// The features on which the measurements depend, and whether each is on.
const FEATURES: [(&str, bool); 2] = [("asm", cfg!(feature = "asm")), ("simd", cfg!(feature = "simd"))];

/// Machine and program that measure.
pub(crate) fn host() -> Host {
    let features: Vec<&str> = FEATURES.iter().filter(|(_, on)| *on).map(|(name, _)| *name).collect();
    let features = if features.is_empty() { "none of asm, simd".to_string() } else { features.join(", ") };
    let mut host = Host::default();
    host.processor = processor();
    host.compiler = env!("MODE13H_COMPILER").to_string();
    host.flags = format!("{}, features {features}", env!("MODE13H_FLAGS"));
    host
}

/// The processor's name, as it or the system reports it.
fn processor() -> String {
    let named = linux().or_else(macos).or_else(|| std::env::var("PROCESSOR_IDENTIFIER").ok());
    let name = named.as_deref().map(str::trim).filter(|name| !name.is_empty()).unwrap_or("unnamed processor");
    format!("{name} ({})", std::env::consts::ARCH)
}

fn linux() -> Option<String> {
    let text = fs::read_to_string("/proc/cpuinfo").ok()?;
    // On ARM there is no model name; some kernels have the board's.
    let value = |key: &str| {
        let line = text.lines().find(|line| line.split(':').next().is_some_and(|name| name.trim() == key))?;
        Some(line.split_once(':')?.1.trim().to_string())
    };
    value("model name").or_else(|| value("Model")).or_else(|| value("Hardware"))
}

fn macos() -> Option<String> {
    if !cfg!(target_os = "macos") {
        return None;
    }
    let output = Command::new("sysctl").args(["-n", "machdep.cpu.brand_string"]).output().ok()?;
    Some(String::from_utf8_lossy(&output.stdout).into_owned())
}

/// Clock that times are read from: how long this thread has run, where the system counts that.
pub(crate) fn clock() -> Clock {
    #[cfg(unix)]
    if has_run().is_ok() {
        return Clock { name: "the time that the thread has run", now: || has_run().unwrap_or_default() };
    }
    Clock::WALL
}

#[cfg(unix)]
fn has_run() -> nix::Result<std::time::Duration> {
    Ok(nix::time::clock_gettime(nix::time::ClockId::CLOCK_THREAD_CPUTIME_ID)?.into())
}
