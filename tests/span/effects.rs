//! Every pixel loop in every form that this machine has, through the checks of the conformance crate; and for each loop
//! deliberately wrong ones, which the same check must catch.

use crate::support::tried::Tried;
use mode13h::internals::lanes::LANES;
use mode13h::internals::span::channels::{mix_cube, mix_cube_portable, mix_nearest};
use mode13h::internals::span::curve::curve;
use mode13h::internals::span::depth::{copy_nearer, copy_nearer_keep_depth, fill_nearer};
use mode13h::internals::span::dither::{DitherPattern, ThresholdRow, fill_dithered};
use mode13h::internals::span::fixed16::fill_16_16;
use mode13h::internals::span::float::fill_float;
use mode13h::internals::span::hyperbolic::fill_quotients;
use mode13h::internals::span::listed;
use mode13h::internals::span::lit::interpolate;
use mode13h::internals::span::lookup;
use mode13h::internals::span::texture::{Texels, TexelsError, fill_affine};
use mode13h::palette::Rgb;
use mode13h::palette::cube;
use mode13h::span::Kernel;
use mode13h_conformance::loops::channels::{check_cube, check_nearest, naive_level};
use mode13h_conformance::loops::depth::{check_copy, check_fill as check_fill_nearer, check_list, check_list_nearer};
use mode13h_conformance::loops::light::{check_curve, check_interpolate, check_interpolate_at};
use mode13h_conformance::loops::spans::{check_16_16, check_dithered, check_fill, check_float, check_quotients};
use mode13h_conformance::loops::texels::{check_affine, check_lookup, check_perspective};
use mode13h_conformance::loops::{self, Cases, Checked};
use mode13h_conformance::random::seed;

/// All cases.
fn full() -> Cases {
    Cases::full(seed())
}

#[test]
fn every_loop_is_its_definition() {
    println!("MODE13H_SEED={}", seed());
    for outcome in loops::all(full()) {
        let mut tried = Tried::new(outcome.to_string(), 1);
        assert_eq!(outcome.wrong, None, "{outcome}");
        tried.add(outcome.cases);
    }
}

/// A wrong loop is caught, with a message that names a pixel, a byte, a cell or a count.
#[track_caller]
fn assert_caught(fault: &str, checked: Checked) {
    match checked {
        Ok(cases) => panic!("{fault}: not found in {cases} cases"),
        Err(wrong) => println!("{fault}: {wrong}"),
    }
}

#[test]
fn wrong_spans_are_caught() {
    let kernel = Kernel::default();
    assert_caught("a step's last bit is lost", check_fill(full(), |row, s, d| kernel.fill(row, s, d & !1)));
    assert_caught("a half is added", check_fill(full(), |row, s, d| kernel.fill(row, s.wrapping_add(128), d)));
    let narrow = |row: &mut [u8], shade: u16, step: u16| {
        let length = row.len().min(65_535);
        kernel.fill(&mut row[..length], shade, step);
    };
    assert_caught("a count of 16 bits", check_fill(full(), narrow));
    let last = |row: &mut [u8], shade: u16, step: u16| {
        kernel.fill(row, shade, step);
        if let [.., last] = row
            && shade == 0xFF01
        {
            *last ^= 1;
        }
    };
    assert_caught("the last pixel of a rare shade", check_fill(full(), last));
    let wrong = check_fill(full(), |row, _, _| row.fill(0x77)).expect_err("nothing is drawn");
    assert_eq!(wrong, "shade 0x0000 step 0x0000 length 1 alignment 0: pixel 0 is 0x77, not 0x00");
}

#[test]
fn wrong_spans_in_16_16_are_caught() {
    assert_caught(
        "a step's last bit is lost",
        check_16_16(full(), |row, shade, step| fill_16_16(row, shade, step & !1)),
    );
    let half = |row: &mut [u8], shade: u32, step| fill_16_16(row, shade.wrapping_add(0x8000), step);
    assert_caught("a half is added", check_16_16(full(), half));
    let last = |row: &mut [u8], shade, step| {
        fill_16_16(row, shade, step);
        if let Some(last) = row.last_mut().filter(|last| **last == 255) {
            *last = 0;
        }
    };
    assert_caught("the last byte of 255", check_16_16(full(), last));
}

/// Including numerators next to a multiple of the divisor, where f64 cannot distinguish the quotient from the whole
/// number.
#[test]
fn c5_quotients_beside_whole_numbers() {
    let mut tried = Tried::new("c5_quotients_beside_whole_numbers", 20_000);
    tried.add(check_quotients(full(), fill_quotients).expect("exact quotients"));
}

#[test]
fn wrong_quotients_are_caught() {
    let estimated = |row: &mut [u8], n: i128, dn: i128, d: i128, dd: i128| {
        for (k, pixel) in (0..).zip(row) {
            *pixel = ((n + k * dn) as f64 / (d + k * dd) as f64) as u8;
        }
    };
    assert_caught("floors of estimates", check_quotients(full(), estimated));
    let linear = |row: &mut [u8], n, dn, d, _| fill_quotients(row, n, dn, d, 0);
    assert_caught("the divisor does not change", check_quotients(full(), linear));
    let upper = |row: &mut [u8], n: i128, dn: i128, d: i128, dd: i128| {
        fill_quotients(row, (n + d / 1_024).min(256 * d - 1), dn, d, dd);
    };
    assert_caught("a part of a thousand", check_quotients(full(), upper));
}

#[test]
fn wrong_spans_in_f32_are_caught() {
    let at_zero = |row: &mut [u8], _, n, d, range| fill_float(row, 0, n, d, range);
    assert_caught("the first pixel is always 0", check_float(full(), at_zero));
    let free = |row: &mut [u8], first, n, d, _| fill_float(row, first, n, d, [0.0, 255.0]);
    assert_caught("no clamp", check_float(full(), free));
    let added = |row: &mut [u8], first, n: [f32; 2], d: [f32; 2], [low, high]: [f32; 2]| {
        let (mut n0, mut d0) = (n[0] + first as f32 * n[1], d[0] + first as f32 * d[1]);
        for pixel in row {
            let shade = n0 / d0;
            let shade = if shade.is_nan() { low } else { shade.clamp(low, high) };
            *pixel = (shade + 0.5) as u8;
            (n0, d0) = (n0 + n[1], d0 + d[1]);
        }
    };
    assert_caught("sums that drift", check_float(full(), added));
}

#[test]
fn wrong_dithered_spans_are_caught() {
    let column = |row: &mut [u8], s, d, t: &ThresholdRow, _| fill_dithered(row, s, d, t, 0);
    assert_caught("the column is forgotten", check_dithered(full(), column));
    let half = |row: &mut [u8], s, d, t: &ThresholdRow, x| fill_dithered(row, s + 128 * u16::from(s < 99), d, t, x);
    assert_caught("the half is added, too", check_dithered(full(), half));
    let last = |row: &mut [u8], shade: u16, step: u16, thresholds: &ThresholdRow, x: usize| {
        fill_dithered(row, shade, step, thresholds, x);
        // The last eight, as if a block began there.
        if let Some(from) = row.len().checked_sub(8).filter(|from| *from >= 300) {
            let start = shade.wrapping_add(step.wrapping_mul(from as u16));
            fill_dithered(&mut row[from..], start, step, thresholds, x);
        }
    };
    assert_caught("the last block has the first one's thresholds", check_dithered(full(), last));
}

#[test]
fn the_matrix_is_bayers() {
    // Each matrix is made from the next smaller: four times its ranks, plus 0, 2, 3 and 1.
    let mut ranks = vec![vec![0_u32]];
    while ranks.len() < 8 {
        let half = ranks.len();
        let place = |y: usize, x: usize| 4 * ranks[y % half][x % half] + [[0, 2], [3, 1]][y / half][x / half];
        ranks = (0..2 * half).map(|y| (0..2 * half).map(|x| place(y, x)).collect()).collect();
    }
    for (y, ranks) in ranks.iter().enumerate() {
        for (x, rank) in ranks.iter().enumerate() {
            let threshold = DitherPattern::Ordered.thresholds().row(y).at(x);
            let exact = f64::from(2 * rank + 1) * 255.0 / 128.0;
            assert!((f64::from(threshold) - exact).abs() < 0.5, "rank {rank}: {threshold}, not {exact}");
        }
    }
}

/// What a PlayStation adds to a channel before it cuts off three bits.
#[test]
fn the_matrix_of_the_playstation_cuts_off_three_bits_as_it_does() {
    const OFFSETS: [[i32; 4]; 4] = [[-4, 0, -3, 1], [2, -2, 3, -1], [-3, 1, -4, 0], [3, -1, 2, -2]];
    for (y, row) in OFFSETS.iter().enumerate() {
        for (x, offset) in row.iter().enumerate() {
            let threshold = DitherPattern::Ps1.thresholds().row(y + 4).at(x + 4);
            // A shade of 8.8 whose steps are those of 5 bits, so that dither chooses among them; no sum is above 255.
            for channel in 4..=252 {
                let mut byte = [0];
                // Less the half of a step, 4, that the offsets begin at.
                let shade = ((channel - 4) * 32) as u16;
                fill_dithered(&mut byte, shade, 0, DitherPattern::Ps1.thresholds().row(y), x);
                assert_eq!(i32::from(byte[0]), (channel + offset) >> 3, "{channel} at {x}, {y}: {threshold}");
            }
        }
    }
}

#[test]
fn the_thresholds_are_spread_evenly() {
    let pattern = DitherPattern::Ordered.thresholds();
    let mut thresholds: Vec<u8> = (0..64).map(|i| pattern.row(i / 8).at(i % 8)).collect();
    assert_eq!(thresholds.iter().map(|t| 2 * u32::from(*t)).sum::<u32>(), 64 * 255, "the mean is 127.5");
    thresholds.sort_unstable();
    for (low, high) in thresholds.iter().zip(thresholds.iter().rev()) {
        assert_eq!(u32::from(*low) + u32::from(*high), 255);
    }
    let steps: Vec<_> = thresholds.windows(2).map(|pair| pair[1] - pair[0]).collect();
    assert_eq!((steps.iter().filter(|step| **step == 4).count(), steps[31]), (62, 3));
    // Of 8 × 8 pixels as many take the upper byte as the fraction says. The thresholds are in the middles of 64 equal
    // parts, or within half a unit, so the share is off by at most half a part of 4 units.
    for fraction in 0..256_u16 {
        let mut upper = 0;
        for y in 0..8 {
            let mut row = [0; 8];
            fill_dithered(&mut row, 0x4000 + fraction, 0, pattern.row(y), 0);
            assert!(row.iter().all(|byte| [0x40, 0x41].contains(byte)));
            upper += row.iter().filter(|byte| **byte == 0x41).count();
        }
        assert!((4 * upper).abs_diff(usize::from(fraction)) <= 2, "{fraction} / 256: {upper} of 64");
    }
}

#[test]
fn wrong_affine_texels_are_caught() {
    let turned = |row: &mut [u8], texels: Texels<'_>, u, v, du, dv| {
        let (ubits, vbits) = (texels.width().ilog2(), texels.height().ilog2());
        let bytes: Vec<u8> = (0..1 << (ubits + vbits)).map(|i| texels.at(i << 16, (i >> ubits) << 16)).collect();
        fill_affine(row, Texels::new(&bytes, vbits, ubits).expect("a texture"), u, v, du, dv);
    };
    assert_caught("width for height", check_affine(full(), turned));
    let coarse = |row: &mut [u8], texels: Texels<'_>, u, v, du, dv| fill_affine(row, texels, u, v, du & !1, dv);
    assert_caught("a step's last bit is lost", check_affine(full(), coarse));
}

#[test]
fn only_textures_are_taken() {
    for ubits in 0..=8 {
        for vbits in 0..=8 {
            let should = 1 << (ubits + vbits);
            let texels = Texels::new(&vec![0; should], ubits, vbits).map(|t| (t.width(), t.height()));
            assert_eq!(texels, Ok((1 << ubits, 1 << vbits)));
            for is in [should - 1, should + 1, 0] {
                let error = Texels::new(&vec![0; is], ubits, vbits).expect_err("no texture");
                assert_eq!(error, TexelsError::Length { is, should });
            }
        }
    }
    for (ubits, vbits) in [(9, 0), (0, 9), (32, 32), (u32::MAX, 1)] {
        let error = Texels::new(&[0; 512], ubits, vbits).expect_err("too large");
        assert_eq!(error, TexelsError::Bits { ubits, vbits });
    }
    let said = Texels::new(&[0; 5], 1, 1).expect_err("no texture").to_string();
    assert_eq!(said, "a texture of 4 texels with 5 bytes");
    let said = Texels::new(&[], 9, 1).expect_err("no texture").to_string();
    assert_eq!(said, "a texture of 2^9 × 2^1 texels; at most 256 × 256 are possible");
}

/// Draws with coordinates computed by `quotient`.
fn fill_by(
    quotient: impl Fn(i128, i128) -> i128,
    row: &mut [u8],
    texels: Texels<'_>,
    [u, v]: [i128; 2],
    [du, dv]: [i128; 2],
    d: i128,
    dd: i128,
) {
    for (k, pixel) in (0..).zip(row) {
        let d = d + k * dd;
        *pixel = texels.at(quotient(u + k * du, d) as u32, quotient(v + k * dv, d) as u32);
    }
}

#[test]
fn wrong_perspective_texels_are_caught() {
    type Fill = fn(&mut [u8], Texels<'_>, [i128; 2], [i128; 2], i128, i128);
    let truncated: Fill = |row, t, n, dn, d, dd| fill_by(|n, d| n / d, row, t, n, dn, d, dd);
    assert_caught("quotients toward zero", check_perspective(full(), truncated));
    let estimated: Fill = |row, t, n, dn, d, dd| {
        fill_by(|n, d| (n as f64 / d as f64).floor() as i128, row, t, n, dn, d, dd);
    };
    assert_caught("floors of estimates", check_perspective(full(), estimated));
    // Correct for non-negative quotients: toward zero, then one correction.
    let corrected: Fill = |row, t, n, dn, d, dd| {
        let floor = |n: i128, d: i128| {
            let near = (n as f64 / d as f64) as i128;
            let rest = n - near * d;
            near + i128::from(rest >= d) - i128::from(rest < 0)
        };
        fill_by(floor, row, t, n, dn, d, dd);
    };
    assert_caught("one correction of an estimate toward zero", check_perspective(full(), corrected));
    let affine: Fill = |row, t, n, dn, d, _| fill_by(i128::div_euclid, row, t, n, dn, d, 0);
    assert_caught("the divisor does not change", check_perspective(full(), affine));
}

#[test]
fn wrong_look_ups_are_caught() {
    let swapped = |row: &mut [u8], high: &[u8], table: &[u8; 65_536]| {
        for (pixel, high) in row.iter_mut().zip(high) {
            *pixel = table[usize::from(*pixel) << 8 | usize::from(*high)];
        }
    };
    assert_caught("the bytes change places", check_lookup(full(), swapped));
    let padded = |row: &mut [u8], high: &[u8], table: &[u8; 65_536]| {
        let mut high = high.to_vec();
        high.resize(row.len(), 0);
        lookup(row, &high, table);
    };
    assert_caught("pixels beyond the shorter row are drawn", check_lookup(full(), padded));
}

#[test]
fn wrong_mixtures_are_caught() {
    let lowered = |row: &ThresholdRow| -> ThresholdRow {
        ThresholdRow::new(&core::array::from_fn::<u8, 64, _>(|x| row.at(x).saturating_sub(1)))
    };
    type MixCube = fn(&mut [u8], &[u8], &[u8], &[u8], &ThresholdRow, usize);
    let lower = |row: &mut [u8], r: &[u8], g: &[u8], b: &[u8], t: &ThresholdRow, x| {
        mix_cube(row, r, g, b, &lowered(t), x);
    };
    assert_caught("a threshold that is reached counts as passed", check_cube(full(), lower));
    let places: MixCube = |row, r, g, b, t, x| mix_cube(row, g, r, b, t, x);
    assert_caught("red and green change places", check_cube(full(), places));
    let even: MixCube = |row, r, g, b, _, x| mix_cube(row, r, g, b, &ThresholdRow::new(&[128]), x);
    assert_caught("no dither", check_cube(full(), even));
    let up = |row: &mut [u8], r: &[u8], g: &[u8], b: &[u8], t: &ThresholdRow, x, spread: u8, map: &[u8; 32_768]| {
        mix_nearest(row, r, g, b, t, x, spread, map);
        if spread % 2 == 1 {
            // Half the spread, rounded up.
            let lower = |channel: &[u8]| channel.iter().map(|c| c.saturating_sub(1)).collect::<Vec<_>>();
            mix_nearest(row, &lower(r), &lower(g), &lower(b), t, x, spread, map);
        }
    };
    assert_caught("half the spread is rounded up", check_nearest(full(), up));
}

/// Every value of a channel at every threshold, with two other channels held constant.
#[test]
fn every_value_at_every_threshold() {
    let mut tried = Tried::new("every_value_at_every_threshold", 2 * 65_536 * 3);
    let values: Vec<u8> = (0..=255).collect();
    for mix in [mix_cube_portable, mix_cube] {
        for threshold in 0..=255 {
            for (channel, weight) in [36, 6, 1].into_iter().enumerate() {
                let mut rows = [[0; 256].as_slice(), &[52; 256], &[255; 256]];
                let others =
                    [0, 6, 5].iter().enumerate().filter(|(i, _)| *i != channel).map(|(_, base)| base).sum::<u8>();
                rows[channel] = &values;
                let mut row = [0; 256];
                mix(&mut row, rows[0], rows[1], rows[2], &ThresholdRow::new(&[threshold]), 0);
                for (value, entry) in values.iter().zip(row) {
                    let level = naive_level(*value, threshold);
                    assert_eq!(entry, weight * level + others, "{value} at {threshold}, channel {channel}");
                    if let Some(own) = [0, 52, 101, 154, 203, 255].iter().position(|level| level == value) {
                        assert_eq!(usize::from(level), own, "a level moved at threshold {threshold}");
                    }
                    tried.add(1);
                }
            }
        }
    }
    tried.done();
}

/// At 128 the nearest mixture; at 127 too, except that a value halfway between two levels goes up.
#[test]
fn in_the_middle_it_is_the_nearest_level() {
    let values: Vec<u8> = (0..=255).collect();
    let mut half_way = Vec::new();
    for value in 0..=255_u8 {
        let mut row = [0; 2];
        let grey = [value; 1];
        mix_cube(&mut row[..1], &grey, &grey, &grey, &ThresholdRow::new(&[128]), 0);
        mix_cube(&mut row[1..], &grey, &grey, &grey, &ThresholdRow::new(&[127]), 0);
        let nearest = cube::nearest_mixture(Rgb::new(value, value, value));
        assert_eq!(row[0], nearest, "{value}");
        if row[1] != nearest {
            assert_eq!(row[1], nearest + 43, "{value}");
            half_way.push(value);
        }
    }
    assert_eq!(half_way, [26, 229]); // of 0 and 52, of 203 and 255
    // And all mixtures, a few million of them, one plane of colours at a time.
    let mut tried = Tried::new("in_the_middle_it_is_the_nearest_level", 256 * 256);
    for red in 0..=255 {
        let mut row = [0; 256];
        let green: Vec<u8> = values.iter().map(|v| v.wrapping_mul(7).wrapping_add(red)).collect();
        mix_cube(&mut row, &[red; 256], &green, &values, &ThresholdRow::new(&[128]), 0);
        for (k, entry) in row.iter().enumerate() {
            assert_eq!(*entry, cube::nearest_mixture(Rgb::new(red, green[k], values[k])));
            tried.add(1);
        }
    }
    tried.done();
}

#[test]
fn wrong_depth_tests_are_caught() {
    let later = |row: &mut [u8], depth: &mut [u32], shade, step, z: i64, dz| {
        fill_nearer(row, depth, shade, step, z + (1 << 23), dz)
    };
    assert_caught("depths are rounded to the nearest", check_fill_nearer(full(), later));
    assert_caught(
        "the depths are not kept",
        check_copy::<u32>(full(), false, |_, row, depth, bytes, z, dz| copy_nearer(row, depth, bytes, z, dz)),
    );
    assert_caught(
        "the depths are kept",
        check_copy::<u16>(full(), true, |_, row, depth, bytes, z, dz| copy_nearer_keep_depth(row, depth, bytes, z, dz)),
    );
    assert_caught(
        "the depths of 16 bits are kept, and should stay",
        check_copy::<u16>(full(), false, |n, row, depth, bytes, z, dz| {
            listed::write_nearer(Kernel::default(), (row, depth), (bytes, n), true, [z, dz])
        }),
    );
    let equal = |_, row: &mut [u8], depth: &mut [u32], bytes: &[u8], z, dz| {
        let lower: Vec<u32> = depth.iter().map(|d| d.saturating_sub(1)).collect();
        copy_nearer_keep_depth(row, &lower, bytes, z, dz)
    };
    assert_caught("an equal depth counts as nearer", check_copy(full(), false, equal));
    let one_more = |n: usize, row: &mut [u8], depth: &mut [u32], bytes: &[u8], z, dz| {
        listed::write_nearer(Kernel::PORTABLE, (row, depth), (bytes, n + 1), true, [z, dz])
    };
    assert_caught("a pixel behind the last", check_copy(full(), true, one_more));
}

/// Spans that do not lie inside the cells are not drawn, whether or not pixels and cells share their offsets.
#[test]
fn spans_lie_inside_the_cells() {
    const PIXELS: usize = 300;
    for cells in [0, 1, 99, 100, 109, 110, 111, 299] {
        for shift in [0, 5] {
            let at = [0_u32, 40, 100, 109, 280];
            let span = |at| listed::ListedSpan { at, length: 10, shade: 7 << 8, step: 0 };
            let spans = at.map(|at| span(at + shift));
            let depths = at.map(|at| listed::ListedDepths { z: 1 << 54, dz: 0, at });
            let mut expected = vec![3; PIXELS];
            for (_, span) in at.iter().zip(&spans).filter(|(at, _)| **at as usize + 10 <= cells) {
                expected[span.at as usize..][..10].fill(7);
            }
            for kernel in Kernel::available() {
                let mut bytes = vec![3; PIXELS];
                listed::fill_where_nearer(kernel, &mut bytes, &mut vec![9_u32; cells], &spans, &depths);
                assert_eq!(bytes, expected, "{kernel:?}, {cells} cells, {shift} pixels before them");
                let mut bytes = vec![3; PIXELS];
                listed::fill_where_nearer(kernel, &mut bytes, &mut vec![9_u16; cells], &spans, &depths);
                assert_eq!(bytes, expected, "{kernel:?}, {cells} narrow cells, {shift} pixels before them");
            }
        }
    }
}

#[test]
fn wrong_lists_are_caught() {
    let kernel = Kernel::default();
    let last = |pixels: &mut [u8], spans: &[listed::ListedSpan]| {
        listed::fill(kernel, pixels, &spans[..spans.len().min(128)]);
    };
    assert_caught("no more spans than a list has room for", check_list(full(), last));
    let turned = |pixels: &mut [u8], spans: &[listed::ListedSpan]| {
        let turned: Vec<_> = spans.iter().rev().copied().collect();
        listed::fill(kernel, pixels, &turned);
    };
    assert_caught("the last span first", check_list(full(), turned));
    let pitch = |pixels: &mut [u8],
                 cells: &mut [u16],
                 spans: &[listed::ListedSpan],
                 depths: &[listed::ListedDepths]| {
        let depths: Vec<_> =
            spans.iter().zip(depths).map(|(span, depths)| listed::ListedDepths { at: span.at, ..*depths }).collect();
        listed::fill_where_nearer(kernel, pixels, cells, spans, &depths)
    };
    assert_caught("the pixels' pitch for the cells", check_list_nearer(full(), pitch));
}

#[test]
fn wrong_points_are_caught() {
    type Interpolate = fn(u16, &[f64; 6], &[f64; 6], f64, f64) -> mode13h::internals::lanes::Points;
    let accumulated: Interpolate = |first, a, da, d, dd| {
        let (from, mut points) = (f64::from(first), interpolate(first, a, da, d, dd));
        for (i, values) in points.iter_mut().enumerate() {
            for (steps, value) in (0..).map(f64::from).zip(values).skip(1) {
                let divisor = (d + from * dd) + steps * dd;
                *value = (((a[i] + from * da[i]) + steps * da[i]) * (1.0 / divisor)) as f32;
            }
        }
        points
    };
    assert_caught("sums that run on", check_interpolate(full(), accumulated));
    let reciprocal: Interpolate = |first, a, da, d, dd| {
        let mut points = [[0.0; LANES]; 6];
        for (i, values) in points.iter_mut().enumerate() {
            for (k, value) in (u32::from(first)..).map(f64::from).zip(values) {
                *value = (a[i] + k * da[i]) as f32 * (1.0 / (d + k * dd)) as f32;
            }
        }
        points
    };
    assert_caught("products with an f32 reciprocal", check_interpolate(full(), reciprocal));
    let last: Interpolate = |first, a, da, d, dd| {
        let mut points = interpolate(first, a, da, d, dd);
        points[5][LANES - 1] = 0.0;
        points
    };
    assert_caught("the last point", check_interpolate(full(), last));
    assert_caught(
        "points that follow the first",
        check_interpolate_at(full(), |places, a, da, d, dd| interpolate(places[0] as u16, a, da, d, dd)),
    );
}

#[test]
fn wrong_curves_are_caught() {
    type Curve = fn(&mut [u16], [f32; 3], u16, u16);
    let accumulated: Curve = |shades, [a, b, c], least, most| {
        let (mut at, mut step) = (a, b + c);
        for shade in shades {
            *shade = at.max(f32::from(least)).min(f32::from(most)).round_ties_even() as u16;
            at += step;
            step += 2.0 * c;
        }
    };
    assert_caught("sums that run on", check_curve(full(), accumulated));
    let truncated: Curve = |shades, [a, b, c], least, most| {
        for (k, shade) in (0_u16..).map(f32::from).zip(shades) {
            *shade = (a + k * (b + k * c)).max(f32::from(least)).min(f32::from(most)) as u16;
        }
    };
    assert_caught("shades that are cut off", check_curve(full(), truncated));
    let unheld: Curve = |shades, parabola, _, most| curve(Kernel::PORTABLE, shades, parabola, 0, most);
    assert_caught("no least", check_curve(full(), unheld));
    let fused: Curve = |shades, [a, b, c], least, most| {
        for (k, shade) in (0_u16..).map(f32::from).zip(shades) {
            let value = k.mul_add(k.mul_add(c, b), a);
            *shade = value.max(f32::from(least)).min(f32::from(most)).round_ties_even() as u16;
        }
    };
    assert_caught("products that are not rounded", check_curve(full(), fused));
}
