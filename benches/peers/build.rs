//! Compiles the peers that are C libraries: Debian's `liballegro4-dev` and `libosmesa6-dev`.

fn main() {
    println!("cargo::rerun-if-changed=src/allegro.c");
    println!("cargo::rerun-if-changed=src/mesa.c");
    cc::Build::new().files(["src/allegro.c", "src/mesa.c"]).opt_level(3).warnings(false).compile("peers");
    println!("cargo::rustc-link-lib=alleg");
    println!("cargo::rustc-link-lib=OSMesa");
}
