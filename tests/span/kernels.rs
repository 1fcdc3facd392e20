//! Hard cases S1 to S6: every kernel of this machine against a naive oracle. The long run:
//!
//! ```text
//! cargo test --release --test span -- --ignored --nocapture
//! ```

use crate::support::tried::Tried;
#[cfg(all(feature = "asm", feature = "simd", target_arch = "x86_64"))]
use crate::support::tried::is_here;
use mode13h::span::Kernel;
use mode13h_conformance::loops::Cases;
use mode13h_conformance::loops::canvas::{Canvas, Shape};
use mode13h_conformance::loops::spans::{check_fill, check_span, naive_span};
use mode13h_conformance::random::{Random, seed};

/// Bytes before and after the row that must not change.
const GUARD: usize = 64;
/// Three blocks of 64 minus one: at least two of the widest blocks, and every tail.
const EXHAUSTIVE_LENGTH: usize = 191;

/// Shades and steps around which a sign changes or a carry occurs, and the largest ones.
const EDGES: [u16; 16] =
    [0, 1, 2, 0x7F, 0x80, 0xFF, 0x100, 0x101, 0x7FFF, 0x8000, 0x8001, 0xFEFF, 0xFF00, 0xFF01, 0xFFFE, 0xFFFF];

/// Checks a span: its bytes match the definition, and no other byte has changed.
fn check(canvas: &mut Canvas, kernel: Kernel, shape: Shape, shades: (u16, u16)) {
    if let Err(wrong) = check_span(canvas, shape, shades, |row, shade, step| kernel.fill(row, shade, step)) {
        panic!("{kernel}: {wrong}");
    }
}

/// S1: nothing is written.
fn s1_no_pixels(kernel: Kernel) {
    let mut tried = Tried::new(format!("s1_no_pixels {}", kernel.name()), 64 * 16 * 16);
    let mut canvas = Canvas::new(0);
    kernel.fill(&mut [], 0x1234, 0x0101); // a pointer to nothing at all
    for alignment in 0..64 {
        for shade in EDGES {
            for step in EDGES {
                check(&mut canvas, kernel, Shape { length: 0, alignment }, (shade, step));
                tried.add(1);
            }
        }
    }
    tried.done();
}

/// S2: the start shade is written, whatever the step.
fn s2_one_pixel(kernel: Kernel) {
    let mut tried = Tried::new(format!("s2_one_pixel {}", kernel.name()), 65_536 * 16);
    let mut canvas = Canvas::new(1);
    for step in EDGES {
        for shade in 0..=u16::MAX {
            check(&mut canvas, kernel, Shape { length: 1, alignment: usize::from(shade % 64) }, (shade, step));
            tried.add(1);
        }
    }
    tried.done();
}

/// S3: from any whole shade to any other within two pixels, including 0 to 255 and back.
fn s3_two_pixels(kernel: Kernel) {
    let mut tried = Tried::new(format!("s3_two_pixels {}", kernel.name()), 65_536);
    let mut canvas = Canvas::new(2);
    for first in 0..=255_u8 {
        for second in 0..=255_u8 {
            let shade = i32::from(first) * 256;
            let step = i32::from(second) * 256 - shade; // −65,280 to 65,280: 17 bits
            assert!((0..65_536).contains(&(shade + step)), "no wrap");
            let shades = (shade as u16, step as u16);
            assert_eq!(naive_span(2, shades.0, shades.1), [first, second]);
            check(&mut canvas, kernel, Shape { length: 2, alignment: 63 }, shades);
            tried.add(1);
        }
    }
    tried.done();
}

/// S5: every length of a screen row and the lengths around the 16-bit count, at every alignment; and S4 in small, random
/// and extreme starts and steps at the length of the long run.
fn s5_lengths_and_alignments(kernel: Kernel) {
    let mut tried = Tried::new(format!("s5_lengths_and_alignments {}", kernel.name()), 40_000);
    match check_fill(Cases::full(seed()), |row, shade, step| kernel.fill(row, shade, step)) {
        Ok(cases) => tried.add(cases),
        Err(wrong) => panic!("{kernel}, MODE13H_SEED={}: {wrong}", seed()),
    }
    tried.done();
}

/// S6: a row of 320 whose exact slope is just short of a step, rising and falling.
///
/// All sums are in units of 1/256 shade. With a start rounded toward where the shades come from, and a step rounded
/// toward zero, a sum lags behind the exact value by less than 1 for the start and less than 1 for each step: after 319
/// steps less than 320, which is 1.25 shades; reseeded every 64 pixels, less than 64, which is ¼.
fn s6_drift(kernel: Kernel) {
    let mut tried = Tried::new(format!("s6_drift {}", kernel.name()), 6 * 6 * 2 * 2 * 320);
    let mut random = Random::new(6);
    // Slopes numerator/denominator: steps of 0 and ±1, with the most drift that truncation can cause and with none.
    for denominator in [1_i64, 2, 3, 320, 65_521, (random.next_u64() % 10_000 + 2) as i64] {
        for numerator in [0, 1, denominator - 1, denominator, denominator + 1, 2 * denominator - 1] {
            for direction in [1, -1] {
                for reseed in [320, 64] {
                    let slope = direction * numerator;
                    // The exact value at pixel k, times the denominator; from mid-range, with a fraction.
                    let exact = |k: i64| 0x7F80 * denominator + denominator / 3 + slope * k;
                    let step = slope / denominator; // toward zero
                    let mut row = [0; 320];
                    let mut sums = Vec::new();
                    for (piece, pixels) in row.chunks_mut(reseed).enumerate() {
                        let at_start = exact((piece * reseed) as i64);
                        let down = at_start.div_euclid(denominator);
                        let up = -(-at_start).div_euclid(denominator);
                        let start = if slope >= 0 { down } else { up };
                        sums.extend((0..pixels.len() as i64).map(|k| start + k * step));
                        kernel.fill(pixels, (start + 128) as u16, step as u16);
                    }
                    let bound = if reseed == 320 { 320 } else { 64 };
                    for (k, (&byte, &sum)) in row.iter().zip(&sums).enumerate() {
                        let behind = exact(k as i64) - sum * denominator;
                        let lag = if slope >= 0 { behind } else { -behind };
                        let place =
                            format!("{kernel}: slope {slope}/{denominator}, reseeded every {reseed}, pixel {k}");
                        let measure = if reseed == 320 { "shades behind" } else { "reseeded" };
                        tried.worst(measure, lag as f64 / denominator as f64 / 256.0);
                        assert!((0..bound * denominator).contains(&lag), "{place}: lag {lag}/{denominator}");
                        assert_eq!(i64::from(byte), (sum + 128) / 256, "{place}");
                        tried.add(1);
                    }
                }
            }
        }
    }
    tried.done();
}

/// S6: rows of shades I and of shades 255 − I add up to 255, pixel by pixel.
///
/// Their sums in 1/256 shade, s and 65,280 − s, do so exactly, since truncation toward zero treats a slope and its
/// negative the same way. The bytes (s + 128) >> 8 then add up to 255, or to 256 where s is halfway between two shades,
/// as both are rounded up there.
fn s6_complement(kernel: Kernel) {
    let mut tried = Tried::new(format!("s6_complement {}", kernel.name()), 100_000);
    let mut random = Random::new(66);
    let corners = [(0, 255), (255, 0), (0, 0), (127, 128), (128, 127), (0, 1), (254, 255)];
    let drawn = (0..600).map(|_| ((random.next_u64() % 256) as i64, (random.next_u64() % 256) as i64));
    for (from, to) in corners.into_iter().chain(drawn.collect::<Vec<_>>()) {
        for pixels in [2_i64, 3, 64, 319, 320] {
            let span = |from: i64, to: i64| {
                let (start, step) = (from * 256, (to - from) * 256 / (pixels - 1));
                let mut row = vec![0; pixels as usize];
                kernel.fill(&mut row, (start + 128) as u16, step as u16);
                (0..pixels).map(|k| start + k * step).zip(row).collect::<Vec<_>>()
            };
            let (row, complement) = (span(from, to), span(255 - from, 255 - to));
            for (k, (&(sum, byte), &(other_sum, other_byte))) in row.iter().zip(&complement).enumerate() {
                let place = format!("{kernel}: {from} to {to} over {pixels} pixels, pixel {k}");
                assert_eq!(sum + other_sum, 65_280, "{place}");
                assert_eq!(i64::from(byte), (sum + 128) / 256, "{place}");
                let half_way = u16::from(sum % 256 == 128);
                assert_eq!(u16::from(byte) + u16::from(other_byte), 255 + half_way, "{place}");
                tried.add(1);
            }
        }
    }
    tried.done();
}

/// Stamps the tests onto a kernel. A kernel that the machine lacks is reported and skipped.
macro_rules! stamp {
    ($($module:ident: $name:literal,)*) => {
        const STAMPED: &[&str] = &[$($name),*];
        $(mod $module {
            stamp!(@each $name: s1_no_pixels, s2_one_pixel, s3_two_pixels, s5_lengths_and_alignments, s6_drift,
                s6_complement);
        })*
    };
    (@each $name:literal: $($test:ident),*) => {
        $(#[test]
        fn $test() {
            match $name.parse::<mode13h::span::Kernel>() {
                Ok(kernel) => super::$test(kernel),
                Err(error) => println!("not tried: {error}"),
            }
        })*
    };
}

stamp! {
    portable: "portable",
    asm: "asm",
    asm_unrolled: "asm-unrolled",
    simd: "simd",
    simd_arrays: "simd-arrays",
    simd_sse2: "simd-sse2",
    simd_neon: "simd-neon",
    simd_wasm: "simd-wasm",
    simd_avx2: "simd-avx2",
    simd_avx512: "simd-avx512",
}

/// Every kernel has its tests, and the kernels that must be available are.
#[test]
fn every_kernel_is_tested() {
    let names: Vec<_> = Kernel::available().map(Kernel::name).collect();
    println!("{}", names.join(", "));
    for name in &names {
        assert!(STAMPED.contains(name), "{name} has no tests");
    }
    let mut certain = vec!["portable"];
    if cfg!(all(feature = "asm", any(target_arch = "x86_64", target_arch = "x86"))) {
        certain.push("asm");
    }
    if cfg!(all(feature = "asm", target_arch = "x86_64")) {
        certain.push("asm-unrolled");
    }
    if cfg!(feature = "simd") {
        certain.extend(["simd", "simd-arrays"]);
    }
    if cfg!(all(feature = "simd", target_arch = "x86_64")) {
        certain.push("simd-sse2");
    }
    if cfg!(all(feature = "simd", target_arch = "aarch64")) {
        certain.push("simd-neon");
    }
    if cfg!(all(feature = "simd", target_arch = "wasm32", target_feature = "simd128")) {
        certain.push("simd-wasm");
    }
    #[cfg(all(feature = "simd", feature = "std", target_arch = "x86_64"))]
    {
        if is_x86_feature_detected!("avx2") {
            certain.push("simd-avx2");
        }
        // Masked bytes, and the instruction that makes the mask.
        if is_x86_feature_detected!("avx512f")
            && is_x86_feature_detected!("avx512bw")
            && is_x86_feature_detected!("bmi2")
        {
            certain.push("simd-avx512");
        }
    }
    for name in certain {
        assert!(names.contains(&name), "{name} is missing");
    }
}

#[test]
fn kernels_are_chosen_by_name() {
    for kernel in Kernel::available() {
        let again = kernel.name().parse::<Kernel>().expect("an available kernel");
        assert_eq!((again.name(), again.level()), (kernel.name(), kernel.level()));
    }
    assert_eq!(Kernel::available().next().map(Kernel::name), Some("portable"));
    let machine = if cfg!(target_arch = "x86_64") { "x86-64" } else { "i686" };
    let mut best = "arrays";
    for kernel in Kernel::available().filter(|kernel| kernel.name() != "simd") {
        let level = match kernel.name() {
            "asm" | "asm-unrolled" => machine,
            name => name.trim_start_matches("simd-"),
        };
        assert_eq!((kernel.level(), kernel.to_string()), (level, kernel.name().to_owned()));
        if kernel.name().starts_with("simd-") {
            best = level;
        }
    }
    if let Ok(simd) = "simd".parse::<Kernel>() {
        assert_eq!((simd.level(), simd.to_string()), (best, format!("simd ({best})")));
        assert_eq!(format!("{simd:?}"), format!("Kernel(simd ({best}))"));
    }
    let names: Vec<_> = Kernel::available().map(Kernel::name).collect();
    let error = "mmx".parse::<Kernel>().expect_err("no such kernel").to_string();
    assert_eq!(error, format!("no such kernel; this machine has {}", names.join(", ")));
    for name in STAMPED.iter().filter(|name| !names.contains(name)) {
        let error = name.parse::<Kernel>().expect_err("a kernel that is not here").to_string();
        assert_eq!(error, format!("this machine or build lacks the kernel {name}; it has {}", names.join(", ")));
    }
    assert!(names.contains(&Kernel::default().name()));
    if cfg!(feature = "simd") {
        assert_eq!(Kernel::default().name(), "simd");
    }
}

/// The long run, on as many threads as the machine has.
mod long {
    use super::*;
    use std::sync::Mutex;
    use std::thread;
    use std::time::Instant;

    /// One thread's findings.
    #[derive(Default)]
    struct Found {
        cases: u64,
        /// Number of wrong rows, and the first of them.
        wrong: u64,
        first: Option<String>,
    }

    impl Found {
        fn wrong(&mut self, what: impl FnOnce() -> String) {
            self.wrong += 1;
            self.first.get_or_insert_with(what);
        }
    }

    /// Runs `part(thread, threads)` on every thread.
    fn on_all_threads(tried: &mut Tried, part: impl Fn(u64, u64) -> Found + Sync) {
        let threads = thread::available_parallelism().map_or(1, |n| n.get()) as u64;
        let all = Mutex::new(Found::default());
        thread::scope(|scope| {
            for i in 0..threads {
                let (part, all) = (&part, &all);
                scope.spawn(move || {
                    let found = part(i, threads);
                    let mut all = all.lock().expect("no thread panicked");
                    all.cases += found.cases;
                    all.wrong += found.wrong;
                    all.first = all.first.take().or(found.first);
                });
            }
        });
        let all = all.into_inner().expect("no thread panicked");
        tried.add(all.cases);
        tried.worst("rows that differ", all.wrong as f64);
        assert!(all.wrong == 0, "{} rows differ: {}", all.wrong, all.first.unwrap_or_default());
    }

    fn failure(kernel: Kernel, shade: u16, step: u16, row: &[u8], expected: &[u8]) -> String {
        let pixel = row.iter().zip(expected).position(|(a, b)| a != b).unwrap_or(0);
        let (is, should) = (row[pixel], expected[pixel]);
        format!(
            "{kernel}: shade {shade:#06x} step {step:#06x} length {}: pixel {pixel} is {is:#04x}, not {should:#04x}",
            row.len()
        )
    }

    /// All 2³² starts and steps at 191 pixels: `portable` against the definition, the others against it.
    #[test]
    #[ignore = "the long run: minutes"]
    fn s4_long_every_start_and_step() {
        let kernels: Vec<_> = Kernel::available().filter(|k| !["portable", "simd"].contains(&k.name())).collect();
        let stated = (1 << 32) * (kernels.len() as u64 + 1);
        let mut tried = Tried::new("s4_long_every_start_and_step", stated);
        let started = Instant::now();
        on_all_threads(&mut tried, |thread, threads| {
            let mut found = Found::default();
            // Bytes, so that the compiler sees that no sum below can overflow, and vectorizes.
            let places: [u8; EXHAUSTIVE_LENGTH] = std::array::from_fn(|k| k as u8);
            let mut definition = [0; EXHAUSTIVE_LENGTH];
            let mut portable = [0; EXHAUSTIVE_LENGTH];
            let mut row = [0; EXHAUSTIVE_LENGTH];
            for step in (0..=u16::MAX).filter(|step| u64::from(*step) % threads == thread) {
                for shade in 0..=u16::MAX {
                    for (&k, pixel) in places.iter().zip(&mut definition) {
                        *pixel = ((u32::from(shade) + u32::from(k) * u32::from(step)) % 65_536 / 256) as u8;
                    }
                    Kernel::PORTABLE.fill(&mut portable, shade, step);
                    if portable != definition {
                        found.wrong(|| failure(Kernel::PORTABLE, shade, step, &portable, &definition));
                    }
                    for &kernel in &kernels {
                        kernel.fill(&mut row, shade, step);
                        if row != portable {
                            found.wrong(|| failure(kernel, shade, step, &row, &portable));
                        }
                    }
                    found.cases += kernels.len() as u64 + 1;
                    row[usize::from(shade) % EXHAUSTIVE_LENGTH] ^= 0xFF; // no kernel may lean on an old row
                }
            }
            found
        });
        println!("{} kernels, {:.0?}", kernels.len() + 1, started.elapsed());
        tried.done();
    }

    /// 10⁹ random spans of 1 to 4,095 pixels, log-uniform, at random alignments, guard bytes watched.
    #[test]
    #[ignore = "the long run: minutes"]
    fn s4_long_random_spans() {
        const SPANS: u64 = 1_000_000_000;
        let kernels: Vec<_> = Kernel::available().filter(|k| !["portable", "simd"].contains(&k.name())).collect();
        let mut tried = Tried::new("s4_long_random_spans", SPANS);
        let started = Instant::now();
        on_all_threads(&mut tried, |thread, threads| {
            let mut found = Found::default();
            let mut random = Random::new(400 + thread);
            let mut expected = [0; 4_095];
            let mut canvas = vec![0xA5; 4_095 + 64 + 63 + 2 * GUARD];
            let base = canvas.as_ptr().addr().next_multiple_of(64) - canvas.as_ptr().addr();
            let spans = SPANS.div_ceil(threads);
            for i in 0..spans {
                let length = random.log_uniform(12);
                let bits = random.next_u64();
                let (shade, step, alignment) = (bits as u16, (bits >> 16) as u16, (bits >> 32) as usize % 64);
                let expected = &mut expected[..length];
                Kernel::PORTABLE.fill(expected, shade, step);
                let kernel = kernels[i as usize % kernels.len()];
                let start = base + GUARD + alignment;
                let (before, rest) = canvas.split_at_mut(start);
                let (row, behind) = rest.split_at_mut(length);
                kernel.fill(row, shade, step);
                if row != expected {
                    found.wrong(|| failure(kernel, shade, step, row, expected));
                }
                if before[start - GUARD..] != [0xA5; GUARD] || behind[..GUARD] != [0xA5; GUARD] {
                    found
                        .wrong(|| format!("{kernel}: shade {shade} step {step} length {length}: a guard byte is gone"));
                    before[start - GUARD..].fill(0xA5);
                    behind[..GUARD].fill(0xA5);
                }
                row.fill(0xA5);
                found.cases += 1;
            }
            found
        });
        println!("{} kernels, {:.0?}", kernels.len(), started.elapsed());
        tried.done();
    }
}

/// Levels that this machine lacks are not tested; the line of `.ci/not_tried` names them.
#[cfg(all(feature = "asm", feature = "simd", target_arch = "x86_64"))]
#[test]
fn levels_that_are_missing_are_said() {
    let mut tried = Tried::new("levels_that_are_missing_are_said", 6);
    let all = ["asm", "asm-unrolled", "simd-arrays", "simd-sse2", "simd-avx2", "simd-avx512"];
    for name in all {
        is_here(name, name.parse::<Kernel>().is_ok());
        tried.add(1);
    }
    let known = |kernel: &Kernel| all.contains(&kernel.name()) || ["portable", "simd"].contains(&kernel.name());
    assert!(Kernel::available().all(|kernel| known(&kernel)), "a kernel that is not in this list");
}
