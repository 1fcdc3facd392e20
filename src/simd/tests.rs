//! Compares every level's operations with those of plain arrays, lane by lane and bit by bit.

use super::*;
use crate::random::Random;

#[cfg(feature = "alloc")]
use F32Lanes8 as Eights;
#[cfg(not(feature = "alloc"))]
use Lanes8 as Eights;

/// Numbers of all sizes, signs and bit patterns.
struct Numbers(Random);

impl Numbers {
    fn bits(&mut self) -> u64 {
        self.0.next_u64()
    }

    fn i64s(&mut self) -> [i64; 8] {
        [(); 8]
            .map(|()| (self.bits() >> (self.bits() % 64)).cast_signed().wrapping_mul(1 - 2 * (self.bits() & 1) as i64))
    }

    fn i32s(&mut self) -> [i32; 8] {
        let ends = [0, 1, -1, i32::MAX, i32::MIN];
        self.i64s().map(|n| if n % 7 == 0 { ends[n.rem_euclid(5) as usize] } else { n as i32 })
    }

    /// Integers, for which fused and unfused multiply-adds round equally.
    fn f64s(&mut self) -> [f64; 8] {
        self.i64s().map(|n| (n % (1 << 24)) as f64)
    }
}

/// Compares the values of each type between two levels.
struct Checker<S> {
    s: S,
    name: &'static str,
}

impl<S: Lanes8> Checker<S> {
    fn f64s(&self, what: &str, found: S::F64, expected: [f64; 8]) {
        let mut lanes = [0.0; 8];
        self.s.store_f64(found, &mut lanes);
        assert_eq!(
            lanes.map(f64::to_bits),
            expected.map(f64::to_bits),
            "{what} of {}: {lanes:?} {expected:?}",
            self.name
        );
    }

    fn i32s(&self, what: &str, found: S::I32, expected: [i32; 8]) {
        let mut lanes = [0; 8];
        self.s.store_i32(found, &mut lanes);
        assert_eq!(lanes, expected, "{what} of {}", self.name);
    }

    fn i64s(&self, what: &str, found: S::I64, expected: [i64; 8]) {
        let mut lanes = [0; 8];
        self.s.store_i64(found, &mut lanes);
        assert_eq!(lanes, expected, "{what} of {}", self.name);
    }

    fn mask(&self, what: &str, found: S::Mask, expected: [i32; 8]) {
        assert_eq!(self.s.to_bitmask(found), Portable.to_bitmask(expected), "{what} of {}", self.name);
    }
}

/// Compares depth tests, where some depths equal their cells, with the definition.
fn check_depth_test<S: Lanes8>(s: S, name: &str, random: &mut Numbers) {
    let ([z, dz, ..], count) = (random.i64s(), (random.bits() % 9) as usize);
    let depths = [0, 1, 2, 3, 4, 5, 6, 7].map(|k| (z.wrapping_add(dz.wrapping_mul(k)) >> 32) as u32);
    let mut before = random.i32s().map(i32::cast_unsigned);
    for (lane, cell) in before.iter_mut().enumerate().filter(|(lane, _)| lane % 3 == 0) {
        *cell = depths[lane].wrapping_sub((random.bits() % 3) as u32);
    }
    for keeps in [false, true] {
        for (lanes, count) in [(4, count.min(4)), (8, count)] {
            let (mut after, mut stays, mut cells) = (before, [255; 8], before);
            for lane in (0..count).filter(|lane| depths[*lane] > before[*lane]) {
                stays[lane] = 0;
                if keeps {
                    after[lane] = depths[lane];
                }
            }
            let expected = u64::from_le_bytes(stays);
            let found = match lanes {
                4 => {
                    let four = cells.first_chunk_mut().expect("eight");
                    u64::from(u32::MAX) << 32 | u64::from(s.test_four(four, [z, dz], count, keeps))
                }
                _ => s.test_eight(&mut cells, [z, dz], count, keeps),
            };
            assert_eq!((found, cells), (expected, after), "depth test of {lanes} by {name}: {z}, {dz}, {before:?}");
            let (mut cells, mut pixels, bytes) = (before, [1, 2, 3, 4, 5, 6, 7, 8], [11, 12, 13, 14, 15, 16, 17, 18]);
            let nearer = s.copy_nearer((&mut pixels, &mut cells), (bytes, count), [z, dz], keeps);
            let copied =
                [0, 1, 2, 3, 4, 5, 6, 7].map(|lane| if stays[lane] == 0 { bytes[lane] } else { lane as u8 + 1 });
            assert_eq!(
                (nearer, cells, pixels),
                (expected.count_zeros() / 8, after, copied),
                "copy by {name}: {z}, {dz}"
            );
        }
    }
}

/// Bytes are those at the masked indices, whatever the indices and the number of bytes.
fn check_bytes<S: Lanes8>(s: S, name: &str, (table, numbers): (&[u8; 65_536], [i32; 8])) {
    let lanes = s.load_i32(&numbers);
    assert_eq!(s.bytes_at(&[], lanes), [0; 8], "bytes_at of {name}");
    for length in [1, 2, 3, 64, 100, 256, 1_000, 32_768, 40_000, 65_535, 65_536] {
        let expected = numbers.map(|at| table[at as usize & (length - 1)]);
        assert_eq!(s.bytes_at(&table[..length], lanes), expected, "bytes_at of {name}, {length}");
    }
    let columns = numbers.map(|of| (of >> 16) as u8);
    let expected = [0, 1, 2, 3, 4, 5, 6, 7].map(|k| table[numbers[k] as usize & 0xFF00 | usize::from(columns[k])]);
    assert_eq!(s.look_up(table, lanes, columns), expected, "look_up of {name}");
    assert_eq!(s.join_bytes(columns), columns, "join_bytes of {name}");
}

fn check<S: Eights>(s: S, name: &'static str) {
    check_singles(s, name);
    let c = Checker { s, name };
    let p = Portable;
    let mut random = Numbers(Random::again(15));
    let mut table = [0; 65_536];
    for byte in &mut table {
        // The lowest eight bits.
        *byte = random.bits() as u8;
    }
    for round in 0..2_000 {
        let (a, b, d) = (random.f64s(), random.f64s(), random.f64s());
        let (fa, fb, fd) = (s.load_f64(&a), s.load_f64(&b), s.load_f64(&d));
        c.f64s("add", s.add(fa, fb), p.add(a, b));
        c.f64s("sub", s.sub(fa, fb), p.sub(a, b));
        c.f64s("mul", s.mul(fa, fb), p.mul(a, b));
        c.f64s("mul_add", s.mul_add(fa, fb, fd), p.mul_add(a, b, d));
        c.f64s("neg_mul_add", s.neg_mul_add(fa, fb, fd), p.neg_mul_add(a, b, d));
        let divisor = b.map(|x| if x == 0.0 { 1.0 } else { x });
        c.f64s("div", s.div(fa, s.load_f64(&divisor)), p.div(a, divisor));
        // Zeros of different signs are not compared.
        let positive = b.map(|x| x + 0.0);
        c.f64s("min", s.min(fa, s.load_f64(&positive)), p.min(a, positive));
        c.f64s("max", s.max(fa, s.load_f64(&positive)), p.max(a, positive));
        c.f64s("xor_sign", s.xor_sign(fa, fb), p.xor_sign(a, b));
        c.mask("is_less", s.is_less(fa, fb), p.is_less(a, b));
        c.mask("is_less, equal", s.is_less(fa, fa), [0; 8]);
        c.i32s("low_bits", s.low_bits(fa), p.low_bits(a));
        c.i64s("bits", s.bits(fa), p.bits(a));

        let (i, j) = (random.i32s(), random.i32s());
        let (ii, ij) = (s.load_i32(&i), s.load_i32(&j));
        c.f64s("to_f64", s.to_f64(ii), p.to_f64(i));
        c.f64s("unsigned_to_f64", s.unsigned_to_f64(ii), p.unsigned_to_f64(i));
        assert_eq!(s.low_bytes(ii), p.low_bytes(i), "low_bytes of {name}");
        assert_eq!(s.low_words(ii), p.low_words(i), "low_words of {name}");
        c.i32s("add_i32", s.add_i32(ii, ij), p.add_i32(i, j));
        c.i32s("sub_i32", s.sub_i32(ii, ij), p.sub_i32(i, j));
        c.i32s("mul_i32", s.mul_i32(ii, ij), p.mul_i32(i, j));
        c.i32s("min_i32", s.min_i32(ii, ij), p.min_i32(i, j));
        c.i32s("max_i32", s.max_i32(ii, ij), p.max_i32(i, j));
        c.i32s("and_i32", s.and_i32(ii, ij), p.and_i32(i, j));
        c.i32s("or_i32", s.or_i32(ii, ij), p.or_i32(i, j));
        c.i32s("xor_i32", s.xor_i32(ii, ij), p.xor_i32(i, j));
        let by = round % 32;
        c.i32s("shl_i32", s.shl_i32(ii, by), p.shl_i32(i, by));
        c.i32s("shr_i32", s.shr_i32(ii, by), p.shr_i32(i, by));
        let (greater, equal) = (s.is_greater(ii, ij), s.is_equal(ii, ij));
        c.mask("is_greater", greater, p.is_greater(i, j));
        c.mask("is_equal", equal, p.is_equal(i, j));
        c.mask("is_equal, equal", s.is_equal(ii, ii), [-1; 8]);
        let mask = p.is_greater(i, j);
        check_depth_test(s, name, &mut random);
        c.f64s("select", s.select(greater, fa, fb), p.select(mask, a, b));
        c.i32s("select_i32", s.select_i32(greater, ii, ij), p.select_i32(mask, i, j));
        let ([low, high], expected) = (s.interleave_i32(ii, ij), p.interleave_i32(i, j));
        c.i32s("interleave_i32", low, expected[0]);
        c.i32s("interleave_i32, high", high, expected[1]);

        let (k, l) = (random.i64s(), random.i64s());
        let (kk, ll) = (s.load_i64(&k), s.load_i64(&l));
        c.i64s("add_i64", s.add_i64(kk, ll), p.add_i64(k, l));
        c.i64s("sub_i64", s.sub_i64(kk, ll), p.sub_i64(k, l));
        c.i64s("mul_i64", s.mul_i64(kk, ll), p.mul_i64(k, l));
        c.i64s("mul_low_i64", s.mul_low_i64(kk, ll), p.mul_low_i64(k, l));
        let by = round % 64;
        c.i64s("shl_i64", s.shl_i64(kk, by), p.shl_i64(k, by));
        c.i64s("to_i64", s.to_i64(ii), p.to_i64(i));
        c.i64s("unsigned_to_i64", s.unsigned_to_i64(ii), p.unsigned_to_i64(i));
        c.i64s("halves_i64", s.halves_i64(k[0], k[1]), p.halves_i64(k[0], k[1]));
        c.i64s("splat_i64", s.splat_i64(k[2]), [k[2]; 8]);
        let ([low, high], expected) = (s.halves_of_i64(kk), p.halves_of_i64(k));
        c.i32s("halves_of_i64", low, expected[0]);
        c.i32s("halves_of_i64, high", high, expected[1]);
        let ([low, high], expected) = (s.interleave_i64(kk, ll), p.interleave_i64(k, l));
        c.i64s("interleave_i64", low, expected[0]);
        c.i64s("interleave_i64, high", high, expected[1]);

        #[cfg(feature = "alloc")]
        {
            let table = [(); 9].map(|()| random.bits());
            let rows = [(); 8].map(|()| [(); 3].map(|()| (random.bits() % 9) as u32));
            for (found, expected) in s.gather(&table, &rows).into_iter().zip(p.gather(&table, &rows)) {
                c.i64s("gather", found, expected);
            }
        }

        check_bytes(s, name, (&table, i));
        c.mask("and", s.and(greater, s.is_greater(ii, s.splat_i32(0))), p.and(mask, p.is_greater(i, [0; 8])));
        c.mask(
            "but_not",
            s.and_not(greater, s.is_greater(ii, s.splat_i32(0))),
            p.and_not(mask, p.is_greater(i, [0; 8])),
        );
    }
    for bits in 0..=u8::MAX {
        let mask = s.mask_from_bits(bits);
        assert_eq!(s.to_bitmask(mask), u32::from(bits), "mask_from_bits of {name}");
        let numbers = random.i32s();
        let wide = random.i64s();
        let set = (0..8).filter(|lane| bits >> lane & 1 == 1);
        let mut packed = Packed::<24>::new();
        packed.append(s, mask, s.load_i32(&numbers));
        packed.append(s, mask, s.load_i32(&numbers));
        let once = set.clone().map(|lane: usize| numbers[lane].cast_unsigned());
        assert!(packed.as_slice().iter().copied().eq(once.clone().chain(once)), "compress_i32 of {name}");
        let mut to = [0; 8];
        s.compress_i64(mask, [s.load_i64(&wide)], [&mut to]);
        for (to, lane) in to.iter().zip(set) {
            assert_eq!(*to, wide[lane], "compress_i64 of {name}");
        }
    }
}

/// f32 of all kinds: NaN, infinities, zeros of both signs, denormals.
#[cfg(feature = "alloc")]
impl Numbers {
    fn f32s(&mut self) -> [f32; 8] {
        let odd = [0.0, -0.0, 0.5, -1.5, f32::NAN, f32::INFINITY, f32::NEG_INFINITY, f32::MAX, 1e-40];
        [(); 8].map(|()| match self.bits() % 4 {
            0 => odd[(self.bits() % 9) as usize],
            1 => f32::from_bits(self.bits() as u32),
            _ => (self.bits() % 4_096) as f32 / 16.0 - 128.0,
        })
    }
}

#[cfg(feature = "alloc")]
impl<S: F32Lanes8> Checker<S> {
    fn f32s(&self, what: &str, found: S::F32, expected: [f32; 8]) {
        let mut lanes = [0; 8];
        self.s.store_i32(self.s.bits_of_f32(found), &mut lanes);
        for (found, expected) in lanes.into_iter().zip(expected) {
            // The levels may return different NaNs.
            let found = f32::from_bits(found.cast_unsigned());
            let same = found.to_bits() == expected.to_bits() || found.is_nan() && expected.is_nan();
            assert!(same, "{what} of {}: {found:?} for {expected:?}", self.name);
        }
    }
}

#[cfg(feature = "alloc")]
fn check_singles<S: F32Lanes8>(s: S, name: &'static str) {
    use glam::Vec3;

    let c = Checker { s, name };
    let p = Portable;
    let mut random = Numbers(Random::again(32));
    let apart = |of: [f32; 8]| s.vectors(&of.map(Vec3::splat))[0];
    for _ in 0..2_000 {
        let (a, b) = (random.f32s(), random.f32s());
        let (fa, fb) = (apart(a), apart(b));
        let points: [Vec3; 8] = core::array::from_fn(|i| Vec3::new(a[i], b[i], a[7 - i]));
        for (found, expected) in s.vectors(&points).into_iter().zip(p.vectors(&points)) {
            c.f32s("vectors", found, expected);
        }
        c.f32s("splat_f32", s.splat_f32(a[0]), [a[0]; 8]);
        c.f32s("add_f32", s.add_f32(fa, fb), p.add_f32(a, b));
        c.f32s("sub_f32", s.sub_f32(fa, fb), p.sub_f32(a, b));
        c.f32s("mul_f32", s.mul_f32(fa, fb), p.mul_f32(a, b));
        c.f32s("div_f32", s.div_f32(fa, fb), p.div_f32(a, b));
        // A sum that is exact, whether it is rounded once or several times.
        let bytes = random.i32s().map(|n| (n >> 24) as f32);
        let all = s.load_f32(&bytes);
        c.f32s("mul_add_f32", s.mul_add_f32(all, all, all), p.mul_add_f32(bytes, bytes, bytes));
        let eighths = random.i32s().map(|n| n as f32 / 8.0);
        c.i32s("nearest_f32", s.nearest_f32(s.load_f32(&eighths)), p.nearest_f32(eighths));
        c.f32s("max_f32", s.max_f32(fa, fb), p.max_f32(a, b));
        c.f32s("min_f32", s.min_f32(fa, fb), p.min_f32(a, b));
        c.mask("is_at_least", s.is_at_least(fa, fb), p.is_at_least(a, b));
        c.mask("is_at_least, equal", s.is_at_least(fa, fa), p.is_at_least(a, a));
        let numbers = a.map(|x| if x.is_nan() { 1.0 } else { x });
        c.f64s("widen", s.widen(apart(numbers)), p.widen(numbers));
        // Halves between two f32, and values beyond all of them.
        let wide: [f64; 8] = core::array::from_fn(|i| {
            let next = f64::from(f32::from_bits(numbers[i].to_bits() + 1));
            if next.is_finite() { f64::midpoint(numbers[i].into(), next) } else { f64::MAX }
        });
        c.f32s("narrow", s.narrow(s.load_f64(&wide)), p.narrow(wide));
        let positive = random.i32s().map(|n| f64::from(n.unsigned_abs() >> 1) + (n & 3) as f64 / 4.0);
        c.i32s("whole", s.whole(s.load_f64(&positive)), positive.map(|x| x as i32));
    }
    check_light(s, name);
}

#[cfg(feature = "alloc")]
fn check_light<S: F32Lanes8>(s: S, name: &'static str) {
    let c = Checker { s, name };
    let p = Portable;
    let mut random = Numbers(Random::again(33));
    for _ in 0..2_000 {
        let a = random.f32s();
        c.f32s("load_f32", s.load_f32(&a), a);
        let numbers = a.map(f64::from);
        let others: [f64; 8] = core::array::from_fn(|i| numbers[i * 3 % 8]);
        let (found, other) = (s.load_f64(&numbers), s.load_f64(&others));
        let squares = numbers.map(f64::abs);
        c.f64s("sqrt", s.sqrt(s.load_f64(&squares)), p.sqrt(squares));
        let [x, y] = [numbers, others].map(|lanes| lanes.map(|x| if x.is_nan() { 2.0 } else { x }));
        c.f64s("if_less", s.if_less(found, other, s.load_f64(&x)), p.if_less(numbers, others, x));
        c.f64s("if_less, equal", s.if_less(found, found, s.load_f64(&y)), [0.0; 8]);
    }
    for lane in 0..8 {
        let mut one = [0.0; 8];
        assert!(s.is_zero(s.load_f64(&one)) && p.is_zero(one), "is_zero of {name}");
        one[lane] = f64::from_bits(1);
        assert!(!s.is_zero(s.load_f64(&one)) && !p.is_zero(one), "is_zero of {name}, lane {lane}");
    }
}

#[cfg(not(feature = "alloc"))]
fn check_singles<S: Lanes8>(_: S, _: &'static str) {}

#[test]
fn every_level_has_the_operations_of_plain_arrays() {
    check(Portable, "plain arrays");
    #[cfg(simd_x86_64)]
    {
        check(SSE2, "SSE2");
        let tried = [Avx2::find().map(|s| check(s, "AVX2")), Avx512::find().map(|s| check(s, "AVX-512"))];
        for (name, tried) in ["AVX2", "AVX-512"].into_iter().zip(tried) {
            if tried.is_none() {
                std::eprintln!("NOT TRIED: this processor has no {name}");
            }
        }
    }
    #[cfg(simd_neon)]
    check(NEON, "NEON");
    #[cfg(simd_wasm)]
    check(SIMD128, "simd128");
}
