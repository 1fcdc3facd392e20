//! Links by the chip's map of memory.

fn main() {
    println!("cargo::rerun-if-changed=microbit.ld");
    println!("cargo::rustc-link-arg-bins=-T{}/microbit.ld", std::env!("CARGO_MANIFEST_DIR"));
}
