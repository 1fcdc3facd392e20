//! Group R: triangles against the definition.

use super::drawing::{self, Configuration, Draw};
use super::oracle;
use super::random::Random;
use super::{Group, replay};
use crate::record::Record;
use mode13h::fixed::{I24F8, U8F8};
use mode13h::raster::{Interpolation, Rect, Vertex};
use mode13h::render::HiddenSurfaces::BackFaces;
use mode13h::span::Kernel;

/// Random triangles, a third of them slivers, some on centres and edges of pixels, some smaller than
/// one, some as large as the guard band, in hard cases R1 to R8, R11 and R14; under a second.
///
/// Each is drawn in any shading by the raster and by the oracle, which must agree to the byte. Then it is drawn with
/// its vertices in another order, inside a clip rectangle, in bands and at another place of the frame,
/// and split at points inside it: each pixel must then be covered exactly once.
///
/// ```
/// let group = mode13h_lab::verify::triangles(13);
/// assert!(group.passed(), "{:?}", group.failures);
/// ```
#[must_use]
pub fn triangles(seed: u64) -> Group {
    check(seed, 3_000, &drawing::draw)
}

fn check(seed: u64, cases: u32, draw: Draw<'_>) -> Group {
    let mut group = Group::new("triangles");
    let mut random = Random::new(seed, "triangles");
    let kernels: Vec<Kernel> = Kernel::available().collect();
    for _ in 0..cases {
        // Long rows are those that start anew.
        let long = random.below(8) == 0;
        let (most_columns, most_rows) = if long { (320, 6) } else { (48, 32) };
        let (width, height) = (1 + random.below(most_columns), 1 + random.below(most_rows));
        let Ok(mut record) = Record::new(width, height) else { continue };
        record.background = random.below(256) as u8;
        let vertices = any_triangle(&mut random, width, height);
        record.triangles.push((vertices, any_shading(&mut random)));
        let way = Configuration::new(BackFaces, random.one_of(&kernels));

        group.check_record("r2", &record, &|record| replay::against_oracle(record, way, draw));
        let order = random.one_of(&[[0, 2, 1], [1, 0, 2], [1, 2, 0], [2, 0, 1], [2, 1, 0]]);
        group.check_record("r6", &record, &|record| {
            let mut turned = record.clone();
            for (vertices, _) in &mut turned.triangles {
                *vertices = order.map(|corner| vertices[corner]);
            }
            let what = format!("with its vertices in the order {order:?}, {}", way.kernel);
            same(&what, record, draw(record, way), draw(&turned, way))
        });
        let rows_each = 1 + random.below(height);
        group.check_record("r8", &record, &|record| {
            let what = format!("in bands of {rows_each} rows, {}", way.kernel);
            same(&what, record, draw(record, way), draw(record, Configuration { rows_each, ..way }))
        });
        let clip = any_clip(&mut random, width, height);
        group.check_record("r8", &record, &|record| inside_clip(record, clip, way, draw));
        let by = (random.below(40), random.below(40));
        group.check_record("r11", &record, &|record| moved(record, by, way, draw));
        split(&mut group, &mut random, &record, way, draw);
    }
    refused(&mut group);
    group
}

/// Says what differs between two drawings of a frame.
fn same(
    what: &str,
    record: &Record,
    should: Result<Vec<u8>, drawing::Stray>,
    is: Result<Vec<u8>, drawing::Stray>,
) -> Option<String> {
    match (should, is) {
        (Ok(should), Ok(is)) => {
            replay::difference(record, &is, &should).map(|d| format!("{what}: {d}, and otherwise {:#04x}", d.should))
        }
        (Err(stray), _) | (_, Err(stray)) => Some(format!("{what}: {stray}")),
    }
}

/// R8: inside the clip rectangle the bytes that there are without it, outside the background.
fn inside_clip(record: &Record, clip: Rect, way: Configuration, draw: Draw<'_>) -> Option<String> {
    let clipped = record.clone().with_clip(Some(clip));
    let whole = draw(&record.clone().with_clip(None), way).map(|mut pixels| {
        for (place, pixel) in (0..).zip(&mut pixels) {
            let (x, y) = (place % record.width(), place / record.width());
            if !(clip.x0..clip.x1).contains(&x) || !(clip.y0..clip.y1).contains(&y) {
                *pixel = record.background;
            }
        }
        pixels
    });
    same(&format!("clipped to {clip:?}, {}", way.kernel), record, whole, draw(&clipped, way))
}

/// R11: a triangle inside the frame, moved by whole pixels in a frame that is larger by as many.
fn moved(record: &Record, (right, down): (u32, u32), way: Configuration, draw: Draw<'_>) -> Option<String> {
    let (width, height) = (record.width(), record.height());
    let inside = |v: &Vertex| {
        let (x, y) = (v.x().to_bits(), v.y().to_bits());
        // 4,096 pixels of 256 units fit.
        (0..=width as i32 * 256).contains(&x) && (0..=height as i32 * 256).contains(&y)
    };
    if record.triangles.iter().any(|(vertices, _)| !vertices.iter().all(inside)) {
        return None;
    }
    let mut larger = Record::new(width + right, height + down).ok()?;
    larger.background = record.background;
    for (vertices, interpolation) in &record.triangles {
        let place = |c: I24F8, pixels: u32| I24F8::from_bits(c.to_bits() + pixels as i32 * 256);
        let [a, b, c] =
            vertices.each_ref().map(|v| Vertex::new(place(v.x(), right), place(v.y(), down), v.shade(), v.depth()));
        larger.triangles.push(([a.ok()?, b.ok()?, c.ok()?], *interpolation));
    }
    let cut = draw(&larger, way).map(|pixels| {
        let rows = pixels.chunks((width + right) as usize).skip(down as usize);
        rows.flat_map(|row| &row[right as usize..]).copied().collect()
    });
    same(&format!("moved by ({right}, {down}) pixels, {}", way.kernel), record, draw(record, way), cut)
}

/// R5: the triangle split at points inside it, and those parts again.
fn split(group: &mut Group, random: &mut Random, record: &Record, way: Configuration, draw: Draw<'_>) {
    let Some((whole, _)) = record.triangles.first() else { return };
    let mut parts = vec![*whole];
    for _ in 0..=random.below(4) {
        let chosen = random.below(parts.len() as u32) as usize;
        let [a, b, c] = parts[chosen];
        let Some(p) = inside(random, &[a, b, c]) else { continue };
        parts[chosen] = [a, b, p];
        parts.extend([[b, c, p], [c, a, p]]);
    }
    let mut counts = vec![0_u32; record.width() as usize * record.height() as usize];
    oracle::draw(whole, Interpolation::Flat(0), (record.width(), record.height()), |pixel| {
        counts[pixel.y as usize * record.width() as usize + pixel.x as usize] += 1;
    });
    let mut drawn = vec![0_u32; counts.len()];
    let mut stray = None;
    for part in &parts {
        let mut one = record.clone();
        (one.background, one.triangles) = (0, vec![(*part, Interpolation::Flat(1))]);
        match draw(&one, way) {
            Ok(pixels) => drawn.iter_mut().zip(pixels).for_each(|(count, pixel)| *count += u32::from(pixel)),
            Err(error) => stray = Some(error),
        }
    }
    let wrong = (0..record.width() * record.height()).find(|place| drawn[*place as usize] != counts[*place as usize]);
    group.check(wrong.is_none() && stray.is_none(), || {
        let place = wrong.unwrap_or_default();
        let (x, y) = (place % record.width(), place / record.width());
        format!(
            "r5 {}: of {} parts {} cover pixel ({x}, {y}), not {}: {}",
            way.kernel,
            parts.len(),
            drawn[place as usize],
            counts[place as usize],
            parts.iter().map(describe).collect::<Vec<_>>().join("; "),
        )
    });
}

/// A triangle on one line, in 1/256 pixel.
fn describe(vertices: &[Vertex; 3]) -> String {
    vertices.each_ref().map(|v| format!("({} {})", v.x().to_bits(), v.y().to_bits())).join(" ")
}

/// A point in the triangle or on its edge; `None` if rounding leads out of it.
fn inside(random: &mut Random, triangle: &[Vertex; 3]) -> Option<Vertex> {
    let (mut s, mut t) = (random.unit(), random.unit());
    if s + t > 1.0 {
        (s, t) = (1.0 - s, 1.0 - t);
    }
    let [a, b, c] = triangle.map(|v| (f64::from(v.x().to_bits()), f64::from(v.y().to_bits())));
    // Truncated: any point will do.
    let at = |a: f64, b: f64, c: f64| (a + (b - a) * s + (c - a) * t) as i64;
    let p = (at(a.0, b.0, c.0), at(a.1, b.1, c.1));
    let [a, b, c] = triangle.map(|v| (i64::from(v.x().to_bits()), i64::from(v.y().to_bits())));
    let side = |a: (i64, i64), b: (i64, i64)| (b.0 - a.0) * (p.1 - a.1) - (b.1 - a.1) * (p.0 - a.0);
    let sides = [side(a, b), side(b, c), side(c, a)];
    let whole = sides.iter().sum::<i64>().signum();
    sides.iter().all(|side| side.signum() * whole >= 0).then(|| vertex(p.0, p.1, 0, 0))
}

/// R9, R14 and the guard band: what may not enter is refused.
fn refused(group: &mut Group) {
    for bits in 0..=u16::MAX {
        let shade = U8F8::from_bits(bits);
        let made = Vertex::new(I24F8::default(), I24F8::default(), shade, 0);
        group.check(made.is_ok() == (bits <= 0xFF00), || format!("r14 a vertex of shade {bits:#06x}: {made:?}"));
    }
    for beyond in -3..=3 {
        for sign in [-1, 1] {
            let far = I24F8::from_bits(sign * (Vertex::GUARD_BAND + beyond));
            for (x, y) in [(far, I24F8::default()), (I24F8::default(), far)] {
                let made = Vertex::new(x, y, U8F8::default(), 0);
                group.check(made.is_ok() == (beyond <= 0), || format!("r7 a vertex at {x:?}, {y:?}: {made:?}"));
            }
        }
    }
}

/// Makes a vertex; values that do not fit are cut to those that do.
pub(super) fn vertex(x: i64, y: i64, shade: i64, depth: i64) -> Vertex {
    const BAND: i64 = Vertex::GUARD_BAND as i64;
    let coordinate = |c: i64| I24F8::from_bits(c.clamp(-BAND, BAND) as i32);
    let shade = U8F8::from_bits(shade.clamp(0, 0xFF00) as u16);
    Vertex::new(coordinate(x), coordinate(y), shade, depth.clamp(0, u32::MAX.into()) as u32).unwrap_or_default()
}

/// Flat, or any that interpolates.
pub(super) fn any_shading(random: &mut Random) -> Interpolation {
    let flat = random.below(256) as u8;
    if random.below(4) == 0 { Interpolation::Flat(flat) } else { random.one_of(Interpolation::INTERPOLATED) }
}

pub(super) fn any_clip(random: &mut Random, width: u32, height: u32) -> Rect {
    let mut ends = |size| {
        let (a, b) = (random.below(size + 1), random.below(size + 1));
        (a.min(b), a.max(b))
    };
    let ((x0, x1), (y0, y1)) = (ends(width), ends(height));
    Rect { x0, y0, x1, y1 }
}

/// A random triangle near a frame.
pub(super) fn any_triangle(random: &mut Random, width: u32, height: u32) -> [Vertex; 3] {
    let (width, height) = (i64::from(width) * 256, i64::from(height) * 256);
    let kind = random.below(9);
    let reach = if kind == 0 { i64::from(Vertex::GUARD_BAND) } else { random.log_uniform(16).min(width * 2) };
    let (cx, cy) = (random.within(-500, width + 500), random.within(-500, height + 500));
    // On the centres and corners of pixels, on sixteenths, anywhere.
    let grid = if kind == 1 {
        128
    } else if kind == 2 {
        16
    } else {
        1
    };
    let mut place = || {
        let (x, y) = (cx + random.within(-reach, reach), cy + random.within(-reach, reach));
        (x / grid * grid, y / grid * grid)
    };
    let (a, mut b, mut c) = (place(), place(), place());
    match kind {
        // A sliver: c lies on a–b but for a few units.
        3..=5 => {
            let t = random.unit();
            let along = |a: i64, b: i64| a + ((b - a) as f64 * t) as i64;
            c = (along(a.0, b.0) + random.within(-3, 3), along(a.1, b.1) + random.within(-3, 3));
        }
        6 => b.1 = a.1,
        7 => b.0 = a.0,
        _ => {}
    }
    [a, b, c].map(|(x, y)| {
        let shade = if random.below(4) == 0 { random.one_of(&[0, 0xFF00]) } else { random.within(0, 0xFF00) };
        vertex(x, y, shade, random.log_uniform(30))
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::verify::drawing::Stray;

    #[test]
    fn the_raster_is_right() {
        let group = check(1, 300, &drawing::draw);
        assert_eq!(group.failures, [""; 0]);
        assert!(group.cases > 300 * 6);
    }

    /// Vertices rounded to whole pixels, as in 1994.
    fn whole_pixels(record: &Record, way: Configuration) -> Result<Vec<u8>, Stray> {
        let mut record = record.clone();
        for (vertices, _) in &mut record.triangles {
            *vertices = vertices.map(|v| {
                let whole = |c: I24F8| i64::from(c.to_bits() / 256 * 256);
                vertex(whole(v.x()), whole(v.y()), v.shade().to_bits().into(), v.depth().into())
            });
        }
        drawing::draw(&record, way)
    }

    #[test]
    fn a_fault_is_told_by_one_small_triangle() {
        let group = check(1, 50, &whole_pixels);
        let names_a_pixel = |failure: &String| failure.starts_with("r2 ") && failure.contains(": pixel (");
        assert!(group.failures.iter().any(names_a_pixel), "{:?}", group.failures);
        let record = group.record.expect("a record");
        assert_eq!(record.triangles.len(), 1);
        let way = Configuration::new(BackFaces, Kernel::PORTABLE);
        assert!(replay::against_oracle(&record, way, &whole_pixels).is_some(), "it still fails");
        assert_eq!(replay::against_oracle(&record, way, &drawing::draw), None);
    }

    /// A raster that begins anew at every clip rectangle, and one that writes a byte too many.
    #[test]
    fn clip_rectangles_and_bytes_beside_are_looked_at() {
        let shifted = |record: &Record, way: Configuration| match record.clip() {
            Some(clip) if clip.x0 > 0 => whole_pixels(record, way),
            _ => drawing::draw(record, way),
        };
        let group = check(1, 200, &shifted);
        assert!(group.failures[0].contains("clipped to Rect"), "{:?}", group.failures);
        let group = check(1, 1, &|_, _| Err(Stray::Byte));
        assert!(group.failures[0].ends_with("a byte beside the frame was written"), "{:?}", group.failures);
    }

    /// No fill rule: what lies on an edge is drawn by both neighbours.
    #[test]
    fn pixels_drawn_twice_are_counted() {
        let fat = |record: &Record, way: Configuration| {
            let mut pixels = drawing::draw(record, way)?;
            if let Some((vertices, Interpolation::Flat(1))) = record.triangles.first() {
                let place = vertices[2].x().to_bits() / 256 + vertices[2].y().to_bits() / 256 * record.width() as i32;
                if let Some(pixel) = usize::try_from(place).ok().and_then(|place| pixels.get_mut(place)) {
                    *pixel = 1;
                }
            }
            Ok(pixels)
        };
        let group = check(1, 200, &fat);
        assert!(group.failures.iter().any(|line| line.starts_with("r5 ")), "{:?}", group.failures);
    }
}
