//! Short names for the conditions under which kernels exist, in place of features, architectures and their extensions.
//!
//! | name | vectors or assembly of | needs |
//! |---|---|---|
//! | `simd_x86_64` | SSE2, AVX2 and AVX-512 | feature `simd`, x86-64 with SSE2, which targets for kernels lack |
//! | `simd_neon` | NEON | feature `simd`, little-endian 64-bit ARM with NEON |
//! | `simd_wasm` | simd128 | feature `simd`, wasm32 with `-C target-feature=+simd128` |
//! | `asm_x86_64` | the span loop | feature `asm`, x86-64 |
//! | `asm_i686` | the span loop | feature `asm`, 32-bit x86 |

use std::env::var;

fn main() {
    println!("cargo::rerun-if-changed=build.rs");
    let has = |feature| var(format!("CARGO_FEATURE_{feature}")).is_ok();
    let is = |what, value| var(format!("CARGO_CFG_TARGET_{what}")).is_ok_and(|is| is == value);
    let extends =
        |extension| var("CARGO_CFG_TARGET_FEATURE").is_ok_and(|all| all.split(',').any(|each| each == extension));
    let names = [
        ("simd_x86_64", has("SIMD") && is("ARCH", "x86_64") && extends("sse2")),
        ("simd_neon", has("SIMD") && is("ARCH", "aarch64") && is("ENDIAN", "little") && extends("neon")),
        ("simd_wasm", has("SIMD") && is("ARCH", "wasm32") && extends("simd128")),
        ("asm_x86_64", has("ASM") && is("ARCH", "x86_64")),
        ("asm_i686", has("ASM") && is("ARCH", "x86")),
    ];
    for (name, holds) in names {
        println!("cargo::rustc-check-cfg=cfg({name})");
        if holds {
            println!("cargo::rustc-cfg={name}");
        }
    }
}
