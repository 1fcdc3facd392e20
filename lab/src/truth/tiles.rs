//! The truth by [`Standard::Lit`] for parts of a picture, for callers who cannot wait for the whole.
//!
//! Every face is projected once and entered into the tiles that it may cover, unless it is a back face or outside the
//! frame. After that a tile costs no more than its own faces.

use core::ops::Range;

use super::{Face, Hit, Standard, Truth, TruthFrame, clip, ray};

/// Margin in pixels around a face's bounding box in which it is looked for. The ray test is exact to 10⁻¹⁰ pixel, so
/// this is more than enough.
const PAD: f64 = 1.0 / 64.0;

/// The faces of a scene, sorted into square tiles of the picture.
///
/// ```
/// use mode13h::mesh::shapes;
/// use mode13h::scene::Scene;
/// use mode13h_lab::truth::{Screen, Standard, Truth};
///
/// let scene = Scene::showing(shapes::torus(24, 12));
/// let truth = Truth::new(&scene, Screen::MODE_13H)?;
/// let mut tiles = truth.tiles();
/// let mut frame = tiles.empty_frame();
/// (0..tiles.count()).for_each(|tile| tiles.draw(tile, 1, &mut frame));
/// assert_eq!(frame, truth.draw(Standard::Lit));
/// # Ok::<(), mode13h_lab::truth::TruthError>(())
/// ```
#[derive(Clone, Debug)]
pub struct Tiles<'t, 'a> {
    truth: &'t Truth<'a>,
    columns: u32,
    faces: Vec<Listed>,
    /// Indices in `faces` of those that may cover each tile, row by row, ascending.
    tiles: Vec<Vec<u32>>,
    /// Hits in the tile that is being drawn.
    hits: Vec<Option<Hit>>,
}

/// A face that may be visible, and the pixels whose centres it may cover.
#[derive(Clone, Debug)]
struct Listed {
    face: Face,
    pixels: [Range<u16>; 2],
}

impl<'a> Truth<'a> {
    /// Sorts the scene's faces into tiles.
    #[must_use]
    pub fn tiles(&self) -> Tiles<'_, 'a> {
        let columns = self.screen.width.div_ceil(Tiles::SIDE);
        let rows = self.screen.height.div_ceil(Tiles::SIDE);
        let mut tiles = Tiles {
            truth: self,
            columns,
            faces: Vec::new(),
            tiles: vec![Vec::new(); columns as usize * rows as usize],
            hits: vec![None; (Tiles::SIDE * Tiles::SIDE) as usize],
        };
        for (object, body) in self.bodies.iter().enumerate() {
            for triangle in 0..body.object.mesh().triangles().len() {
                let face = Face { object, triangle };
                if let Some(pixels) = self.pixels_of(face) {
                    tiles.list(Listed { face, pixels });
                }
            }
        }
        tiles
    }

    /// The columns and rows of the pixels that a face may cover; `None` if there are none.
    fn pixels_of(&self, face: Face) -> Option<[Range<u16>; 2]> {
        let (body, corners) = self.triangle(face)?;
        if !body.shows(face.triangle, ray::is_turned(&corners)) {
            return None;
        }
        let points = clip::outline(&self.eye, &corners);
        let ranges = [(0, self.screen.width), (1, self.screen.height)].map(|(axis, size)| {
            let (low, high) = clip::bounds(&points, axis);
            // Centres lie at x + ½. Values from 0 to 4,096 survive the casts.
            let first = libm::ceil(low - PAD - 0.5).clamp(0.0, f64::from(size)) as u16;
            let end = (libm::floor(high + PAD - 0.5) + 1.0).clamp(0.0, f64::from(size)) as u16;
            first..end
        });
        ranges.iter().all(|range| !range.is_empty()).then_some(ranges)
    }
}

impl Tiles<'_, '_> {
    /// Side of a tile, in pixels. Tiles at the right and lower edges of the frame may be smaller.
    pub const SIDE: u32 = 16;

    /// Number of tiles, row by row.
    #[must_use]
    pub fn count(&self) -> usize {
        self.tiles.len()
    }

    /// Returns whether no face can be visible in a tile, so that there is nothing to draw.
    #[must_use]
    pub fn is_empty(&self, tile: usize) -> bool {
        self.tiles.get(tile).is_none_or(Vec::is_empty)
    }

    /// The columns and the rows of a tile.
    #[must_use]
    pub fn area(&self, tile: usize) -> [Range<u32>; 2] {
        // No more than there are tiles in the frame.
        let tile = tile as u32;
        let [column, row] = [tile % self.columns.max(1), tile / self.columns.max(1)];
        let side = |place: u32, size: u32| (place * Self::SIDE).min(size)..((place + 1) * Self::SIDE).min(size);
        [side(column, self.truth.screen.width), side(row, self.truth.screen.height)]
    }

    /// An empty frame of the picture's size to draw into.
    #[must_use]
    pub fn empty_frame(&self) -> TruthFrame {
        let (width, height) = (self.truth.screen.width, self.truth.screen.height);
        TruthFrame { width, height, pixels: vec![None; width as usize * height as usize] }
    }

    /// Draws the pixels of a tile whose column and row both leave the remainder `step / 2` when divided by `step`; with
    /// a step of 1, all of them. Each is what [`Truth::draw`] makes of it with [`Standard::Lit`].
    ///
    /// Draws nothing outside `frame`, and nothing for a step of 0.
    pub fn draw(&mut self, tile: usize, step: u32, frame: &mut TruthFrame) {
        let [columns, rows] = self.area(tile);
        let Some(faces) = self.tiles.get(tile).filter(|_| step > 0) else { return };
        self.hits.fill(None);
        let place = |x: u32, y: u32| ((y - rows.start) * Self::SIDE + (x - columns.start)) as usize;
        for listed in faces.iter().map(|&place| &self.faces[place as usize]) {
            let [xs, ys] = [(&listed.pixels[0], &columns), (&listed.pixels[1], &rows)]
                .map(|(of_face, of_tile)| sampled(of_face, of_tile, step));
            if xs.clone().next().is_none() || ys.clone().next().is_none() {
                continue;
            }
            let Some((body, corners)) = self.truth.triangle(listed.face) else { continue };
            for y in ys {
                for x in xs.clone() {
                    let centre = [f64::from(x) + 0.5, f64::from(y) + 0.5];
                    let Some(hit) = Truth::hit(&self.truth.eye, listed.face, (body, &corners), centre) else {
                        continue;
                    };
                    let nearest = &mut self.hits[place(x, y)];
                    if nearest.is_none_or(|nearest| hit.inverse_w > nearest.inverse_w) {
                        *nearest = Some(hit);
                    }
                }
            }
        }
        for y in sampled(&(0..u16::MAX), &rows, step) {
            for x in sampled(&(0..u16::MAX), &columns, step) {
                let pixel = self.hits[place(x, y)].and_then(|hit| self.truth.pixel(Standard::Lit, hit));
                let there = (x < frame.width).then(|| y as usize * frame.width as usize + x as usize);
                if let Some(there) = there.and_then(|there| frame.pixels.get_mut(there)) {
                    *there = pixel;
                }
            }
        }
    }

    fn list(&mut self, listed: Listed) {
        let tiles = listed.pixels.each_ref().map(|range| {
            let [first, last] = [range.start, range.end - 1].map(|pixel| u32::from(pixel) / Self::SIDE);
            first..=last
        });
        let [columns, rows] = tiles;
        for row in rows {
            for column in columns.clone() {
                // Below 2³², as a mesh's triangles have 32-bit indices.
                self.tiles[(row * self.columns + column) as usize].push(self.faces.len() as u32);
            }
        }
        self.faces.push(listed);
    }
}

/// The values in both ranges that leave the remainder `step / 2` when divided by `step`.
fn sampled(of_face: &Range<u16>, of_tile: &Range<u32>, step: u32) -> impl Iterator<Item = u32> + Clone + use<> {
    let first = of_tile.start.max(of_face.start.into());
    let end = of_tile.end.min(of_face.end.into());
    let to_next = (step / 2 + step - first % step) % step;
    (first.saturating_add(to_next)..end).step_by(step as usize)
}
