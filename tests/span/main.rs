//! The span kernels: their bytes against the naive loop, and the rules of the machine.

#[path = "../support/mod.rs"]
mod support;

#[cfg(all(feature = "asm", any(target_arch = "x86_64", target_arch = "x86")))]
mod abi;
mod blue_noise;
mod effects;
mod kernels;
