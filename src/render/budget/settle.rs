//! Linear faces of a chunk, found before any of them is looked at by itself.

use super::cluster::{Linear, Where};
use super::decided::{Bodies, Choice, Decided};
use super::eight::{Looked, NOUGHT, ends, greater};
use super::{Budget, LIGHTS};
use crate::lanes::LANES;
use crate::render::faces::Faces;
use crate::render::sift;
use crate::render::vertex::Geometry;

const ENOUGH: u32 = 8;

/// Back-off: as long as the last [`ENOUGH`] faces that were decided on all needed light at each pixel, only every
/// eighth small face is decided on, and the others are lit. Light bends alike on neighbours, and each answer costs some
/// 100 ns. (`still` within 1 shade 1.19 to 1.03 of the time of `phong`.)
#[derive(Clone, Copy, Debug, Default)]
pub(in crate::render) struct Vain {
    in_a_row: u32,
    left_out: u32,
    chunks_left_out: u32,
    /// Faces that bounds were found for by eights, and those that they decided.
    bounded: u32,
    settled: u32,
}

impl Vain {
    /// Returns whether the next small face is left out.
    pub(in crate::render) fn is_it(&mut self) -> bool {
        if self.in_a_row < ENOUGH || self.left_out == 7 {
            self.left_out = 0;
            return false;
        }
        self.left_out += 1;
        true
    }

    /// Returns whether the next chunk is left out, where bounds are found for eight at once: after longer, as that
    /// takes a tenth as much for a face, or as long as they decide less than a quarter. (`two-lights` within 2 shades
    /// takes 7 % less so, `torus` within 1 shade 6 %.)
    fn is_chunk(&mut self) -> bool {
        let mostly = self.bounded >= 4 * ENOUGH && self.settled < self.bounded / 4;
        if (self.in_a_row < 4 * ENOUGH && !mostly) || self.chunks_left_out == 3 {
            self.chunks_left_out = 0;
            return false;
        }
        self.chunks_left_out += 1;
        true
    }

    /// Counts the last faces that were bounded by eights, and those decided so. Those of long ago count less and less.
    fn by_eights(&mut self, bounded: u32, settled: u32) {
        (self.bounded, self.settled) = (self.bounded / 2 + bounded, self.settled / 2 + settled);
        if settled != 0 {
            self.in_a_row = 0;
        }
    }

    pub(in crate::render) fn decided(&mut self, choice: Choice) -> Choice {
        self.in_a_row = if choice == Choice::Phong { self.in_a_row + 1 } else { 0 };
        choice
    }
}

impl Faces<'_> {
    /// Finds a chunk's faces that are known to be linear, a bit for each, among those in `left`: from before, or from
    /// the chunk's bounds, or by bounds that are found for eight at once; and those that such bounds are too much for.
    /// `first` is the first one's number, `back` has the bits of those that show their other side.
    #[inline]
    pub(in crate::render) fn settled(
        &self,
        (budget, vain): (&Budget, &mut Vain),
        (first, back): (usize, u64),
        decided: &mut Decided,
        left: u64,
    ) -> (u64, u64) {
        let chunk = first / sift::MOST;
        let triangles = &self.geometry.triangles[first..];
        let before = *decided.linear(chunk) & left;
        let mut unknown = left & !before;
        if let Some(choices) = decided.chosen(chunk) {
            unknown &= !chosen(choices, unknown);
        }
        let mut settled = before;
        match budget.of_cluster(chunk) {
            Linear::Where(_) if budget.by_cones => settled |= self.by_cones(budget, (first, back), unknown),
            Linear::All => settled |= unknown,
            Linear::Where(Where { unmixed: true, from: 0.0 }) => settled |= self.unmixed(budget, first, unknown),
            Linear::Where(these) => {
                settled |= those(unknown, |at| budget.is_one_of(&these, triangles[at], self.lit));
            }
            Linear::Unknown => {}
        }
        unknown &= !settled;
        *decided.linear(chunk) |= settled;
        if unknown == 0 || vain.is_chunk() {
            return (settled, 0);
        }
        let (_, bodies) = decided.of_chunk(chunk);
        let asked = unknown.count_ones();
        let mut more = if budget.is_simple() && !budget.by_cones {
            self.linear_at_once(budget, (first, back), unknown)
        } else {
            0
        };
        unknown &= !more;
        let mut hopeless = 0;
        if unknown != 0 {
            let known = self.linear_as_known(budget, first, (unknown, back), bodies);
            let by_eights = self.linear_by_eights(budget, first, (unknown & !known, back), bodies);
            (more, hopeless) = (more | known | by_eights.linear, by_eights.hopeless);
        }
        vain.by_eights(asked, more.count_ones());
        *decided.linear(chunk) |= more;
        (settled | more, hopeless)
    }

    /// Finds faces among others which all see the sun, or all do not; and of the other faces those that are linear by
    /// their own corners' normals. (By `decide_at_once` these take 14 ns each, of 32 that it takes to draw one.)
    #[inline]
    fn by_cones(&self, budget: &Budget, (first, back): (usize, u64), asked: u64) -> u64 {
        let unmixed = asked & budget.unmixed_by_cones(first / sift::MOST);
        let mixed = asked & !unmixed;
        if mixed == 0 { unmixed } else { unmixed | self.by_normals(budget, (first, back), mixed) }
    }

    /// Finds linear faces by normals. With P the most that a corner lies in the light and S the most that one lies in
    /// the dark, linear shades are off by PS / (P + S), and bent by a share of P.
    #[inline(never)]
    fn by_normals(&self, budget: &Budget, (first, back): (usize, u64), asked: u64) -> u64 {
        let ([sun], [strength]) = (self.lights.suns, budget.strengths.as_slice()) else { return 0 };
        let (triangles, normals) = (&self.geometry.triangles[first..], self.geometry.normals);
        let (towards, left, bend) = (sun.towards * strength.body, budget.left_for_clamp, budget.bend);
        let (mut linear, mut bits) = (0, asked);
        while bits != 0 {
            let (mut of_lanes, mut cosines) = ([0; LANES], [NOUGHT; 3]);
            for lane in 0..LANES {
                if bits == 0 {
                    break;
                }
                let at = bits.trailing_zeros() as usize;
                of_lanes[lane] = 1 << at;
                bits &= bits - 1;
                let towards = if back >> at & 1 == 1 { -towards } else { towards };
                for (cosines, i) in cosines.iter_mut().zip(triangles[at]) {
                    cosines[lane] = normals[i as usize].dot(towards);
                }
            }
            let (most, least) = ends(&cosines);
            let mut keeps = [false; LANES];
            for (lane, keeps) in keeps.iter_mut().enumerate() {
                let (lit, dark) = (greater(most[lane], 0.0), greater(-least[lane], 0.0));
                // What is not mixed is linear anyway.
                *keeps = (lit * dark <= (lit + dark) * (left - lit * bend)) | (lit == 0.0) | (dark == 0.0);
            }
            linear |= of_lanes.into_iter().zip(keeps).fold(0, |all, (bit, keeps)| if keeps { all | bit } else { all });
        }
        linear
    }

    /// Finds faces whose corners see the same suns and are not clamped, or whose normals are so near to each other that
    /// this does no harm.
    #[inline]
    fn unmixed(&self, budget: &Budget, first: usize, asked: u64) -> u64 {
        let (triangles, facets) = (&self.geometry.triangles[first..], &budget.facets[first..]);
        let flags = self.lit.flags.as_slice();
        let unmixed = those(asked, |at| {
            let [a, b, c] = triangles[at].map(|i| flags[i as usize]);
            // The bit above the lights' is that of a shade that is clamped.
            (a ^ b | b ^ c | a >> LIGHTS) == 0
        });
        unmixed | those(asked & !unmixed, |at| facets[at].spread <= budget.harmless_spread)
    }

    /// Finds faces that are known to be linear at once.
    #[inline(never)]
    fn linear_at_once(&self, budget: &Budget, (first, back): (usize, u64), unknown: u64) -> u64 {
        let Geometry { triangles, triangle_surfaces, .. } = self.geometry;
        those(unknown, |at| {
            let (triangle, turned) = (first + at, back >> at & 1 == 1);
            let (surface, indices) = (triangle_surfaces[triangle], triangles[triangle]);
            let face = (triangle, indices, surface, turned);
            budget.decide_at_once(face, self.lit, self.geometry.normals) == Choice::Linear
        })
    }

    /// Asks the bounds for eight at once.
    #[inline(never)]
    fn linear_by_eights(
        &self,
        budget: &Budget,
        first: usize,
        (mut left, back): (u64, u64),
        bodies: &mut [Bodies],
    ) -> Looked {
        let mut all = Looked::default();
        while left != 0 {
            let looked = self.linear_of_eight(budget, first, (left, back), bodies);
            all.linear |= looked.linear;
            all.hopeless |= looked.hopeless;
            left &= !looked.at;
        }
        all
    }

    /// The shades of a face's corners, of each channel, or the one; the others are zero.
    #[inline]
    pub(in crate::render) fn corner_shades(&self, indices: [u32; 3], turned: bool) -> [[u16; 3]; 3] {
        if self.channels {
            let channels = indices.map(|i| self.extras[i as usize].side(turned).channels);
            [0, 1, 2].map(|channel| channels.map(|corner| corner[channel].to_bits()))
        } else {
            let shades = indices.map(|i| self.lit.shades[i as usize][usize::from(turned)].to_bits());
            [shades, [0; 3], [0; 3]]
        }
    }
}

/// Returns those of the bits for which this holds.
#[inline(always)]
fn those(mut bits: u64, is_one: impl Fn(usize) -> bool) -> u64 {
    let mut those = 0;
    while bits != 0 {
        let at = bits.trailing_zeros() as usize;
        bits &= bits - 1;
        those |= u64::from(is_one(at)) << at;
    }
    those
}

/// Returns the faces on which something has been decided.
fn chosen(choices: &[Choice], asked: u64) -> u64 {
    those(asked, |at| choices[at] != Choice::Unknown)
}
