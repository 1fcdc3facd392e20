//! A recorded frame, drawn by every kernel and every hidden-surface method, and by the exact oracle. A frame that fails is
//! made as small as it can be.

mod definition;
mod drawing;
mod shrink;

use std::fmt;

use crate::record::Record;
use definition::Drawing;
use drawing::{Configuration, Draw, Stray};
use mode13h::raster::{Interpolation, Vertex};
use mode13h::settings::HiddenSurfaces;
use mode13h::span::Kernel;

/// Results of replaying a frame.
#[derive(Clone, PartialEq, Eq, Debug)]
#[non_exhaustive]
pub struct Replay {
    /// Pixels that some triangle covers.
    pub covered: u64,
    /// Pixels that more than one triangle covers.
    pub overlaid: u64,
    /// The frame by each hidden-surface method against that of the depth buffer.
    pub comparisons: Vec<Comparison>,
    /// One line for each thing that is wrong; empty if all went well.
    pub failures: Vec<String>,
    /// Smallest failing frame that could be found, if something is wrong.
    pub smallest: Option<Record>,
}

/// A hidden-surface method against the depth buffer.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
#[non_exhaustive]
pub struct Comparison {
    /// The method. [`BackFaces`](HiddenSurfaces::BackFaces) is the triangles one after the other, as
    /// they were recorded.
    pub hidden_surfaces: HiddenSurfaces,
    /// Pixels that differ.
    pub pixels: u64,
    /// True if there must be none: methods that compare depths give the same bytes, except for triangles without exact
    /// coverage, which the scan-line method draws exactly. Where the other methods differ, they are wrong.
    pub must_agree: bool,
}

/// Draws a recorded frame by every kernel of this machine and every hidden-surface method, whole and in
/// bands, and by the exact oracle.
///
/// A failure is: a kernel whose bytes are not those of the others; a frame in bands that is not that of
/// the whole; the scan-line method's frame that is not the depth buffer's, unless a triangle has no exact cover;
/// the depth buffer's frame that is not the oracle's, or a pixel of it out of the range of its triangle.
///
/// ```
/// use mode13h::mesh::shapes;
/// use mode13h_lab::record::Record;
/// use mode13h::render::{Renderer, Screen};
/// use mode13h::scene::Scene;
/// use mode13h_lab::replay::replay;
///
/// let scene = Scene::showing(shapes::torus(16, 8));
/// let record = Record::of_scene(&mut Renderer::new(), &scene, Screen::MODE_13H)?;
/// let replay = replay(&record);
/// assert!(replay.failures.is_empty() && replay.covered > 10_000);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[must_use]
pub fn replay(record: &Record) -> Replay {
    replay_by(record, &drawing::draw)
}

fn replay_by(record: &Record, draw: Draw<'_>) -> Replay {
    let by_definition = definition::frame(record, definition::NEAREST);
    let count = |least: u32| by_definition.covered.iter().filter(|times| **times >= least).count() as u64;
    let mut replay =
        Replay { covered: count(1), overlaid: count(2), comparisons: Vec::new(), failures: Vec::new(), smallest: None };
    let reference = Configuration::new(HiddenSurfaces::DepthBuffer, Kernel::PORTABLE);
    let mut wrong: Vec<Wrong<'_>> = vec![Box::new(move |record| against_oracle(record, reference, draw))];
    for way in HiddenSurfaces::ALL.map(|hidden_surfaces| Configuration { hidden_surfaces, ..reference }) {
        for kernel in Kernel::available().skip(1) {
            wrong.push(Box::new(move |record| differs(record, way, Configuration { kernel, ..way }, draw)));
        }
        wrong.push(Box::new(move |record| differs(record, way, Configuration { rows_each: 13, ..way }, draw)));
        let must_agree = way.hidden_surfaces == HiddenSurfaces::ScanLine
            && record.triangles.iter().all(|(_, interpolation)| interpolation.has_exact_cover());
        if must_agree {
            wrong.push(Box::new(move |record| differs(record, reference, way, draw)));
        }
        if way.hidden_surfaces != reference.hidden_surfaces
            && let (Ok(is), Ok(should)) = (draw(record, way), draw(record, reference))
        {
            let pixels = difference(record, &is, &should).map_or(0, |difference| difference.pixels);
            replay.comparisons.push(Comparison { hidden_surfaces: way.hidden_surfaces, pixels, must_agree });
        }
    }
    for wrong in wrong {
        let Some(line) = wrong(record) else { continue };
        replay.failures.push(line);
        if replay.smallest.is_none() {
            replay.smallest = Some(shrink::shrink(record, &mut |record| wrong(record).is_some()));
        }
    }
    replay
}

/// Fault of a record, if it has any.
type Wrong<'a> = Box<dyn Fn(&Record) -> Option<String> + 'a>;

impl fmt::Display for Configuration {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}, {}", self.hidden_surfaces, self.kernel)?;
        if self.rows_each > 0 { write!(f, ", bands of {} rows", self.rows_each) } else { Ok(()) }
    }
}

/// Two drawings of a record that should be one.
fn differs(record: &Record, should: Configuration, is: Configuration, draw: Draw<'_>) -> Option<String> {
    match (draw(record, is), draw(record, should)) {
        (Ok(drawn), Ok(expected)) => difference(record, &drawn, &expected)
            .map(|difference| format!("{is}: {difference}, by {should} {:#04x}", difference.should)),
        (Err(stray), _) => Some(format!("{is}: {stray}")),
        (_, Err(stray)) => Some(format!("{should}: {stray}")),
    }
}

/// A drawing against the oracle's; the depth buffer's and the scan-line's by depth, others in turn.
fn against_oracle(record: &Record, way: Configuration, draw: Draw<'_>) -> Option<String> {
    let test = match way.hidden_surfaces {
        HiddenSurfaces::DepthBuffer | HiddenSurfaces::ScanLine => definition::NEAREST,
        _ => definition::LAST,
    };
    let should = definition::frame(record, test);
    let is = match draw(record, way) {
        Ok(is) => is,
        Err(Stray::Byte) => return Some(format!("{way}: {}", Stray::Byte)),
        Err(stray) => return Some(format!("{way}: {stray}")),
    };
    if let Some(difference) = difference(record, &is, &should.pixels) {
        let owner = should.owners[difference.place(record)];
        let of = owner.map_or("of no triangle".to_string(), |number| format!("of triangle {number}"));
        return Some(format!("{way}: {difference}, by the definition {:#04x} {of}", difference.should));
    }
    out_of_range(record, &should, &is).map(|line| format!("{way}: {line}"))
}

/// A pixel that is not between the shades of its triangle's vertices.
fn out_of_range(record: &Record, should: &Drawing, is: &[u8]) -> Option<String> {
    let ranges: Vec<(u8, u8)> = record
        .triangles
        .iter()
        .map(|(vertices, interpolation)| match interpolation {
            Interpolation::Flat(index) => (*index, *index),
            _ => {
                // At most 0xFF00 + 128; at most 255.
                let byte = |v: &Vertex| ((v.shade().to_bits() + u16::from(interpolation.rounding())) >> 8) as u8;
                let bytes = vertices.each_ref().map(byte);
                let [low, high] = [bytes.into_iter().min(), bytes.into_iter().max()].map(Option::unwrap_or_default);
                (low, high)
            }
        })
        .collect();
    (0..).zip(is.iter().zip(&should.owners)).find_map(|(place, (byte, owner))| {
        let (low, high) = ranges[(*owner)?];
        (!(low..=high).contains(byte)).then(|| {
            let (x, y) = (place % record.width(), place / record.width());
            format!("pixel ({x}, {y}) is {byte:#04x}, out of its triangle's range {low:#04x} to {high:#04x}")
        })
    })
}

/// Difference of two frames.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
struct Difference {
    pixels: u64,
    x: u32,
    y: u32,
    is: u8,
    should: u8,
}

impl Difference {
    fn place(&self, record: &Record) -> usize {
        self.y as usize * record.width() as usize + self.x as usize
    }
}

impl fmt::Display for Difference {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { pixels, x, y, is, .. } = self;
        if *pixels > 1 {
            write!(f, "{pixels} pixels differ, first ")?;
        }
        write!(f, "pixel ({x}, {y}) is {is:#04x}")
    }
}

/// Finds the difference of two frames of a record, if they differ.
fn difference(record: &Record, is: &[u8], should: &[u8]) -> Option<Difference> {
    let mut found: Option<Difference> = None;
    for (place, (is, should)) in (0..).zip(is.iter().zip(should)) {
        if is != should {
            let (x, y) = (place % record.width(), place / record.width());
            found.get_or_insert(Difference { pixels: 0, x, y, is: *is, should: *should }).pixels += 1;
        }
    }
    found
}

#[cfg(test)]
mod tests {
    use super::*;
    use mode13h::Angle;
    use mode13h::light::Light;
    use mode13h::mesh::shapes;
    use mode13h::render::{Renderer, Screen};
    use mode13h::scene::{Object, Scene};

    fn torus() -> Record {
        let mut scene = Scene::new();
        scene.add(Object::new(shapes::torus(12, 6)));
        scene.add_light(Light::sun([0.4, 0.6, 1.0]));
        scene.objects_mut()[0].angles = [1.1, 0.0, 0.4].map(Angle::from_radians);
        Record::of_scene(&mut Renderer::new(), &scene, Screen::MODE_13H).expect("a legal scene")
    }

    #[test]
    fn a_frame_is_right_and_painters_order_is_no_failure() {
        let replay = replay(&torus());
        assert_eq!((replay.failures.len(), &replay.smallest), (0, &None));
        assert!(replay.covered > replay.overlaid && replay.overlaid > 100);
        let ways: Vec<HiddenSurfaces> =
            replay.comparisons.iter().map(|comparison| comparison.hidden_surfaces).collect();
        assert_eq!(ways, [HiddenSurfaces::BackFaces, HiddenSurfaces::PainterOrder, HiddenSurfaces::ScanLine]);
        assert_eq!((replay.comparisons[2].pixels, replay.comparisons[2].must_agree), (0, true));
        assert!(replay.comparisons[0].pixels > 0 && !replay.comparisons[0].must_agree);
    }

    /// The frame with one pixel more by one, wherever it is drawn `wrongly`.
    fn with_a_wrong_pixel(record: &Record, way: Configuration, wrongly: bool) -> Result<Vec<u8>, Stray> {
        let mut pixels = drawing::draw(record, way)?;
        let drawn = pixels.iter().position(|pixel| *pixel != record.background);
        if let Some(place) = drawn.filter(|_| wrongly) {
            pixels[place] = pixels[place].wrapping_add(1);
        }
        Ok(pixels)
    }

    #[test]
    fn a_wrong_kernel_is_told_by_one_triangle() {
        let Some(guilty) = Kernel::available().last().filter(|kernel| kernel.name() != "portable") else { return };
        let wrong =
            |record: &Record, way: Configuration| with_a_wrong_pixel(record, way, way.kernel.name() == guilty.name());
        let replay = replay_by(&torus(), &wrong);
        // By each of the four ways.
        assert_eq!(replay.failures.len(), 4);
        for line in &replay.failures {
            assert!(line.contains(&format!(", {guilty}: pixel (")) && line.contains(", portable 0x"), "{line}");
        }
        assert_eq!(replay.smallest.map(|record| record.triangles.len()), Some(1));
    }

    #[test]
    fn a_wrong_method_is_told() {
        let wrong = |record: &Record, way: Configuration| {
            with_a_wrong_pixel(record, way, way.hidden_surfaces == HiddenSurfaces::ScanLine)
        };
        let replay = replay_by(&torus(), &wrong);
        assert_eq!(replay.comparisons[2].pixels, 1);
        assert_eq!(replay.failures.len(), 1);
        let line = &replay.failures[0];
        assert!(
            line.starts_with("scan-line, portable: pixel (") && line.contains(", by depth-buffer, portable 0x"),
            "{line}"
        );
    }

    #[test]
    fn a_pixel_that_is_not_the_definitions_is_told_with_its_triangle() {
        let wrong = |record: &Record, way: Configuration| with_a_wrong_pixel(record, way, true);
        let line = &replay_by(&torus(), &wrong).failures[0];
        assert!(line.starts_with("depth-buffer, portable: pixel ("), "{line}");
        assert!(line.contains(", by the definition 0x") && line.contains(" of triangle "), "{line}");
        let stray = replay_by(&torus(), &|_, _| Err(Stray::Byte));
        assert_eq!(stray.failures[0], "depth-buffer, portable: a byte beside the frame was written");
    }
}
