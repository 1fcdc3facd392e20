//! Batches against the oracle, at every kernel level: bytes, depths and counts.

use mode13h::internals::span::depth::Cell;
use mode13h::raster::{DepthBuffer, DrawStats, Frame, Interpolation, Raster, Rect, Vertex};
use mode13h::span::Kernel;

use super::shapes::{CLASSES, shape};
use super::{MOST, interpolations, together};
use crate::support::triangles::{contains, rect};
use crate::support::tried::Tried;
use mode13h_conformance::Random;
use mode13h_conformance::oracle;

/// A depth buffer's cells.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
enum Cells {
    None,
    Wide,
    Narrow,
}

const CELLS: [Cells; 3] = [Cells::None, Cells::Wide, Cells::Narrow];

/// Where a batch is drawn.
#[derive(Clone, Debug)]
struct Place {
    width: u32,
    height: u32,
    pitch: usize,
    clip: Rect,
    background: u8,
    cells: Cells,
}

/// Bytes, depths and counts.
#[derive(PartialEq, Eq, Debug)]
struct Picture {
    bytes: Vec<u8>,
    depths: Vec<u32>,
    covered: u32,
    tested: u32,
    pixels: u32,
}

type Triangle = ([Vertex; 3], Interpolation);

impl Place {
    fn random(random: &mut Random) -> Self {
        let (width, height) =
            random.one_of(&[(24, 24), (40, 12), (72, 9), (9, 60), (200, 6), (320, 4), (640, 2), (64, 17)]);
        let part = rect(random, width, height);
        let whole = Rect { x0: 0, y0: 0, x1: width, y1: height };
        Self {
            width,
            height,
            pitch: width as usize + random.one_of(&[0, 0, 1, 9]),
            clip: random.one_of(&[whole, whole, whole, part]),
            background: random.within(0, 255) as u8,
            cells: random.one_of(&CELLS),
        }
    }

    /// The picture before anything is drawn.
    fn empty(&self) -> Picture {
        let cells = if self.cells == Cells::None { 0 } else { self.width as usize * self.height as usize };
        let bytes = vec![self.background; self.pitch * self.height as usize];
        Picture { bytes, depths: vec![0; cells], covered: 0, tested: 0, pixels: 0 }
    }

    /// Draws one more triangle with the oracle, and returns the number of pixels it covers.
    fn draw_by_oracle(&self, (vertices, interpolation): &Triangle, picture: &mut Picture) -> u32 {
        let before = picture.covered;
        let pixels = oracle::pixels(vertices, *interpolation, self.width as i32, self.height as i32);
        let depths = (!pixels.is_empty()).then(|| oracle::Depths::of_vertices(vertices));
        for (pixel, depths) in pixels.into_iter().filter_map(|pixel| depths.as_ref().map(|depths| (pixel, depths))) {
            let (x, y) = (pixel.x as u32, pixel.y as u32);
            if !contains(self.clip, x, y) {
                continue;
            }
            picture.covered += 1;
            let depth = match self.cells {
                Cells::None => None,
                Cells::Wide => Some(depths.at(pixel.x, pixel.y)),
                Cells::Narrow => Some(oracle::narrow_depth(depths.at(pixel.x, pixel.y)).into()),
            };
            if let Some(depth) = depth {
                picture.tested += 1;
                let nearest = &mut picture.depths[(y * self.width + x) as usize];
                // With equal depths the first submitted wins.
                if depth <= *nearest {
                    continue;
                }
                *nearest = depth;
            }
            picture.pixels += 1;
            picture.bytes[y as usize * self.pitch + x as usize] = pixel.byte;
        }
        picture.covered - before
    }

    /// Drawn by the oracle, triangle by triangle.
    fn expected(&self, triangles: &[Triangle]) -> Picture {
        let mut picture = self.empty();
        for triangle in triangles {
            self.draw_by_oracle(triangle, &mut picture);
        }
        picture
    }

    /// Drawn by the raster.
    fn drawn(&self, triangles: &[Triangle], kernel: Kernel) -> Picture {
        let mut bytes = vec![self.background; self.pitch * self.height as usize];
        let frame = Frame::new(&mut bytes, self.width, self.height, self.pitch).expect("legal");
        let (depths, drawn) = match self.cells {
            Cells::None => {
                (Vec::new(), together(&mut Raster::new(frame).with_kernel(kernel).with_clip(self.clip), triangles))
            }
            Cells::Wide => self.drawn_with_depth::<u32>(frame, triangles, kernel),
            Cells::Narrow => self.drawn_with_depth::<u16>(frame, triangles, kernel),
        };
        let DrawStats { covered, tested, pixels, .. } = drawn;
        Picture { bytes, depths, covered, tested, pixels }
    }

    fn drawn_with_depth<D: Cell + Into<u32>>(
        &self,
        frame: Frame<'_>,
        triangles: &[Triangle],
        kernel: Kernel,
    ) -> (Vec<u32>, DrawStats) {
        let mut depths = vec![D::default(); self.width as usize * self.height as usize];
        let depth = DepthBuffer::new(&mut depths, &frame).expect("long enough");
        let mut raster = Raster::new(frame).with_depth(depth).with_kernel(kernel).with_clip(self.clip);
        let drawn = together(&mut raster, triangles);
        (depths.into_iter().map(Into::into).collect(), drawn)
    }

    /// The fewest of these triangles, in order, that still differ.
    fn shrunk(&self, mut triangles: Vec<Triangle>, kernel: Kernel) -> Vec<Triangle> {
        let mut at = 0;
        while at < triangles.len() {
            let mut fewer = triangles.clone();
            fewer.remove(at);
            if self.drawn(&fewer, kernel) == self.expected(&fewer) {
                at += 1;
            } else {
                triangles = fewer;
            }
        }
        triangles
    }
}

/// Tests batches until `tried` has as many triangles as it states, each counted for every kernel.
pub(crate) fn batches_against_the_oracle(mut tried: Tried) {
    let mut random = Random::named("r4 batches");
    let kernels: Vec<Kernel> = Kernel::available().collect();
    let each = tried.stated() / kernels.len() as u64;
    // Triangles of each class, those that cover a pixel, and pixels that were overwritten by nearer ones or came too
    // late.
    let (mut of_class, mut covering, mut hidden) = ([0_u64; 3], [0_u64; 3], 0);
    while of_class.iter().sum::<u64>() < each {
        let place = Place::random(&mut random);
        let (mut triangles, mut expected) = (Vec::new(), place.empty());
        let is_mixed = random.within(0, 1) == 0;
        let least = |of_class: &[u64; 3]| (0..3).min_by_key(|&i| of_class[i]).expect("three");
        let first = least(&of_class);
        let mut interpolation = interpolations(&mut random);
        // Until the frame is full, so that little of what is drawn gets overdrawn.
        while expected.covered < place.width * place.height && triangles.len() < MOST {
            let class = if is_mixed { least(&of_class) } else { first };
            for vertices in shape(&mut random, CLASSES[class], (place.width.into(), place.height.into())) {
                if triangles.len() < MOST {
                    let triangle = (vertices, interpolation(&mut random));
                    covering[class] += u64::from(place.draw_by_oracle(&triangle, &mut expected) > 0);
                    of_class[class] += 1;
                    triangles.push(triangle);
                }
            }
        }
        hidden += u64::from(expected.tested.saturating_sub(expected.pixels));
        for &kernel in &kernels {
            if place.drawn(&triangles, kernel) != expected {
                let triangles = place.shrunk(triangles, kernel);
                let (drawn, expected) = (place.drawn(&triangles, kernel), place.expected(&triangles));
                panic!("{kernel} draws {triangles:?} in {place:?} as {drawn:?}, not as {expected:?}");
            }
            tried.add(triangles.len() as u64);
        }
    }
    tried.worst("kernels", kernels.len() as f64);
    for (class, measure) in ["slivers", "reaching the guard band", "with shared edges"].into_iter().enumerate() {
        tried.worst(measure, of_class[class] as f64);
        // Not all are visible.
        assert!(of_class[class] >= each / 4, "{measure}: {} of {each}", of_class[class]);
        assert!(covering[class] > each / 30, "{measure}: {} of {each} cover a pixel", covering[class]);
    }
    tried.worst("pixels hidden", hidden as f64);
    assert!(hidden > each / 10, "{hidden} pixels hidden");
}

/// Triangles with their corners in other orders give the same bytes, depths and counts.
pub(crate) fn orders_and_windings(mut tried: Tried) {
    let mut random = Random::named("r6 batches");
    while tried.more() {
        let place = Place::random(&mut random);
        let size = (place.width.into(), place.height.into());
        let mut interpolation = interpolations(&mut random);
        let mut triangles = Vec::new();
        while triangles.len() < MOST / 2 {
            let class = random.one_of(&CLASSES);
            let shapes = shape(&mut random, class, size);
            triangles.extend(shapes.into_iter().map(|vertices| (vertices, interpolation(&mut random))));
        }
        triangles.truncate(random.within(1, MOST as i64) as usize);
        let orders = [[0, 1, 2], [0, 2, 1], [1, 0, 2], [1, 2, 0], [2, 0, 1], [2, 1, 0]];
        let turned: Vec<Triangle> = triangles
            .iter()
            .map(|(vertices, interpolation)| (random.one_of(&orders).map(|corner| vertices[corner]), *interpolation))
            .collect();
        for kernel in Kernel::available() {
            let (drawn, expected) = (place.drawn(&turned, kernel), place.drawn(&triangles, kernel));
            assert!(drawn == expected, "{kernel}, {place:?}: {triangles:?} and {turned:?}");
        }
    }
}
