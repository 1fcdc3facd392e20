//! Ranges of the cosines and distances that determine the light on a patch: from the three corners of each of eight
//! faces, or from the boxes and cones of eight clusters.

use crate::lanes::{LANES, Lanes, each};

/// x, y and z.
pub(super) type Vectors = [Lanes<f32>; 3];

pub(super) const ZERO: Lanes<f32> = [0.0; LANES];

/// Bound on the error of cosines in f32.
const ROUNDING: f32 = 4e-6;

/// Largest distance or bound: larger ones are clamped to it. Its square is still finite.
pub(super) const HUGE: f32 = 1e15;

/// Eight vectors, by axis and lane.
macro_rules! vectors {
    ($axis:ident, $lane:ident => $value:expr) => {{
        let mut vectors = [ZERO; 3];
        let mut $axis = 0;
        while $axis < 3 {
            vectors[$axis] = each!($lane => $value);
            $axis += 1;
        }
        vectors
    }};
}

/// A point, seen from eight patches.
pub(super) struct Sight<D> {
    pub(super) directions: D,
    /// Distances of the nearest and the farthest point of each patch.
    pub(super) near: Lanes<f32>,
    pub(super) far: Lanes<f32>,
}

/// Eight patches with known ranges, each range being the greatest and the least value.
pub(super) trait Patches {
    /// Directions from the patches to a light or the eye.
    type Directions;

    /// Directions to a sun.
    fn sun(&self, towards: [f32; 3]) -> Self::Directions;
    /// Directions and distances to a point; positions are off by at most `blur`, and no point of a patch is farther
    /// from its corners than `edge`.
    fn point(&self, at: [f32; 3], blur: f32, edge: &Lanes<f32>) -> Sight<Self::Directions>;
    /// Range of n·l.
    fn facing(&self, directions: &Self::Directions) -> [Lanes<f32>; 2];
    /// Range of the cosine between an axis and the directions, at the corners.
    fn along(&self, directions: &Self::Directions, axis: [f32; 3]) -> [Lanes<f32>; 2];
    /// Range of n·l times a lamp's fall-off, whose own range is `falls`.
    fn weighted(&self, sight: &Sight<Self::Directions>, falls: &[Lanes<f32>; 2], inverse_range: f32)
    -> [Lanes<f32>; 2];
    /// Range of r·v at the corners, and its greatest value anywhere; `turns` is how far directions to the light and to
    /// the eye turn along a patch's radius.
    fn mirrored(&self, light: &Self::Directions, eye: &Self::Directions, turns: &Lanes<f32>) -> [Lanes<f32>; 3];
}

/// Eight faces on the visible side: the values at their corners. Missing ones are zero.
#[derive(Clone, Copy, Debug)]
pub(super) struct EightFaces {
    pub(super) normals: [Vectors; 3],
    pub(super) positions: [Vectors; 3],
}

/// Unit directions from each corner, their distances, and the error of cosines.
pub(super) struct FromCorners {
    directions: [Vectors; 3],
    distances: [Lanes<f32>; 3],
    off: Lanes<f32>,
}

impl Patches for EightFaces {
    type Directions = FromCorners;

    #[inline(always)]
    fn sun(&self, towards: [f32; 3]) -> FromCorners {
        FromCorners { directions: [splat(towards); 3], distances: [ZERO; 3], off: [ROUNDING; LANES] }
    }

    #[inline(always)]
    fn point(&self, at: [f32; 3], blur: f32, edge: &Lanes<f32>) -> Sight<FromCorners> {
        let (mut directions, mut distances) = ([[ZERO; 3]; 3], [ZERO; 3]);
        for corner in 0..3 {
            let ways = vectors!(axis, lane => at[axis] - self.positions[corner][axis][lane]);
            (directions[corner], distances[corner]) = units(&ways);
        }
        let [a, b, c] = &distances;
        let least = each!(lane => lesser(a[lane], lesser(b[lane], c[lane])) * (1.0 - ROUNDING) - blur);
        // Lemma 1, for the squares of distances.
        let near = each!(lane => {
            let square = least[lane] * least[lane] - edge[lane] * edge[lane];
            if least[lane] > 0.0 { square_root(greater(square, 0.0)) } else { 0.0 }
        });
        let far = each!(lane => lesser(greater(a[lane], greater(b[lane], c[lane])) * (1.0 + ROUNDING) + blur, HUGE));
        let off = each!(lane => ROUNDING + lesser(4.0 * blur / least[lane].abs(), 2.0));
        Sight { directions: FromCorners { directions, distances, off }, near, far }
    }

    #[inline(always)]
    fn facing(&self, to: &FromCorners) -> [Lanes<f32>; 2] {
        let [a, b, c] = &self.normals;
        let [to_a, to_b, to_c] = &to.directions;
        ends(&[dot(a, to_a), dot(b, to_b), dot(c, to_c)], &to.off)
    }

    #[inline(always)]
    fn along(&self, to: &FromCorners, axis: [f32; 3]) -> [Lanes<f32>; 2] {
        let axis = splat(axis);
        let [to_a, to_b, to_c] = &to.directions;
        ends(&[dot(&axis, to_a), dot(&axis, to_b), dot(&axis, to_c)], &to.off)
    }

    #[inline(always)]
    fn weighted(&self, sight: &Sight<FromCorners>, _: &[Lanes<f32>; 2], inverse_range: f32) -> [Lanes<f32>; 2] {
        let to = &sight.directions;
        let mut weighted = [ZERO; 3];
        let mut corner = 0;
        while corner < 3 {
            let cosines = dot(&self.normals[corner], &to.directions[corner]);
            weighted[corner] = each!(lane => {
                let away = to.distances[corner][lane] * inverse_range;
                let left = greater(1.0 - away * away, 0.0);
                cosines[lane] * (left * left)
            });
            corner += 1;
        }
        ends(&weighted, &to.off)
    }

    #[inline(always)]
    fn mirrored(&self, light: &FromCorners, eye: &FromCorners, turns: &Lanes<f32>) -> [Lanes<f32>; 3] {
        let off = each!(lane => 3.0 * (light.off[lane] + eye.off[lane]));
        let mut cosines = [ZERO; 3];
        let mut corner = 0;
        while corner < 3 {
            let (light, eye, normals) = (&light.directions[corner], &eye.directions[corner], &self.normals[corner]);
            cosines[corner] = mirror(&dot(normals, light), &dot(normals, eye), &dot(light, eye));
            corner += 1;
        }
        let [most, least] = ends(&cosines, &off);
        [most, least, self.highest(light, eye, &off, turns)]
    }
}

impl EightFaces {
    /// The greatest r·v anywhere on the faces, by the vector h half-way between light and eye at the first corner
    /// (Lemma 11): the components of the normals across h form a flat triangle, which lies no nearer to 0 than in any
    /// one direction.
    #[inline(always)]
    fn highest(&self, light: &FromCorners, eye: &FromCorners, off: &Lanes<f32>, turns: &Lanes<f32>) -> Lanes<f32> {
        let sums = vectors!(axis, lane => light.directions[0][axis][lane] + eye.directions[0][axis][lane]);
        let (squares, (half_way, _)) = (dot(&sums, &sums), units(&sums));
        let mut across = self.normals;
        let mut corner = 0;
        while corner < 3 {
            let normals = &self.normals[corner];
            let along = dot(normals, &half_way);
            across[corner] = vectors!(axis, lane => normals[axis][lane] - along[lane] * half_way[axis][lane]);
            corner += 1;
        }
        let sum = vectors!(axis, lane => across[0][axis][lane] + across[1][axis][lane] + across[2][axis][lane]);
        let lengths = dot(&sum, &sum);
        let [a, b, c] = [dot(&across[0], &sum), dot(&across[1], &sum), dot(&across[2], &sum)];
        each!(lane => {
            let least = lesser(a[lane], lesser(b[lane], c[lane])) / square_root(lengths[lane]) - off[lane];
            let sine = greater(least, 0.0);
            // |l + v|²/2 is 1 + l·v.
            let cosine = lesser(1.0 - 0.5 * squares[lane] * sine * sine + off[lane], 1.0);
            let turn = 2.0 * turns[lane];
            let more =
                turn * square_root(greater(1.0 - cosine * cosine, 0.0)) + 0.5 * turn * turn * greater(-cosine, 0.0);
            lesser(cosine + more, 1.0)
        })
    }
}

/// Eight clusters, each with a box that contains all its corners, and a cone that contains all its normals.
#[derive(Clone, Copy, Debug)]
pub(super) struct EightClusters {
    pub(super) centres: Vectors,
    /// Halves of the boxes' sides.
    pub(super) halves: Vectors,
    pub(super) axes: Vectors,
    /// Half of each cone's angle, in radians; π where it is a right angle or more.
    pub(super) angles: Lanes<f32>,
}

/// A direction from each box's middle, and how far directions from other points are turned, in radians.
pub(super) struct FromBoxes {
    directions: Vectors,
    turns: Lanes<f32>,
}

impl Patches for EightClusters {
    type Directions = FromBoxes;

    #[inline(always)]
    fn sun(&self, towards: [f32; 3]) -> FromBoxes {
        FromBoxes { directions: splat(towards), turns: ZERO }
    }

    #[inline(always)]
    fn point(&self, at: [f32; 3], blur: f32, _: &Lanes<f32>) -> Sight<FromBoxes> {
        let ways = vectors!(axis, lane => at[axis] - self.centres[axis][lane]);
        let halves = vectors!(axis, lane => self.halves[axis][lane] + blur);
        let nearest = vectors!(axis, lane => greater(ways[axis][lane].abs() - halves[axis][lane], 0.0));
        let farthest = vectors!(axis, lane => ways[axis][lane].abs() + halves[axis][lane]);
        let (near, far) = (dot(&nearest, &nearest), dot(&farthest, &farthest));
        let (away, radius) = (dot(&ways, &ways), dot(&self.halves, &self.halves));
        // The sine of the greatest turn is the box's radius over the distance, and no more than its tangent.
        let turns = each!(lane => {
            let radius = square_root(radius[lane]) + blur;
            let square = away[lane] * (1.0 - ROUNDING) - radius * radius;
            lesser(radius / square_root(greater(square, 0.0)), 4.0)
        });
        Sight {
            directions: FromBoxes { directions: units(&ways).0, turns },
            near: each!(lane => square_root(near[lane]) * (1.0 - ROUNDING)),
            far: each!(lane => lesser(square_root(far[lane]) * (1.0 + ROUNDING), HUGE)),
        }
    }

    #[inline(always)]
    fn facing(&self, to: &FromBoxes) -> [Lanes<f32>; 2] {
        let turns = each!(lane => self.angles[lane] + to.turns[lane]);
        turned(&dot(&self.axes, &to.directions), &turns)
    }

    #[inline(always)]
    fn along(&self, to: &FromBoxes, axis: [f32; 3]) -> [Lanes<f32>; 2] {
        turned(&dot(&splat(axis), &to.directions), &to.turns)
    }

    #[inline(always)]
    fn weighted(&self, sight: &Sight<FromBoxes>, [most, least]: &[Lanes<f32>; 2], _: f32) -> [Lanes<f32>; 2] {
        let [above, below] = self.facing(&sight.directions);
        [
            each!(lane => above[lane] * if above[lane] > 0.0 { most[lane] } else { least[lane] }),
            each!(lane => below[lane] * if below[lane] > 0.0 { least[lane] } else { most[lane] }),
        ]
    }

    #[inline(always)]
    fn mirrored(&self, light: &FromBoxes, eye: &FromBoxes, _: &Lanes<f32>) -> [Lanes<f32>; 3] {
        let (of_light, of_eye) = (dot(&self.axes, &light.directions), dot(&self.axes, &eye.directions));
        let along = mirror(&of_light, &of_eye, &dot(&light.directions, &eye.directions));
        let turns = each!(lane => 2.0 * self.angles[lane] + light.turns[lane] + eye.turns[lane]);
        let [most, least] = turned(&along, &turns);
        [most, least, most]
    }
}

/// Splats a vector to eight lanes.
#[inline(always)]
pub(super) fn splat([x, y, z]: [f32; 3]) -> Vectors {
    [[x; LANES], [y; LANES], [z; LANES]]
}

/// Range of cosines of angles that differ from these by at most `turns`.
#[inline(always)]
fn turned(cosines: &Lanes<f32>, turns: &Lanes<f32>) -> [Lanes<f32>; 2] {
    let sine: Lanes<f32> = each!(lane => square_root(greater(1.0 - cosines[lane] * cosines[lane], 0.0)));
    // cos(μ ∓ t) by Taylor's series; the second term has the sign of a cosine between both.
    let half = each!(lane => 0.5 * turns[lane] * turns[lane]);
    [
        each!(lane => {
            let most = cosines[lane] + turns[lane] * sine[lane] + half[lane] * greater(-cosines[lane], 0.0) + ROUNDING;
            lesser(most, 1.0)
        }),
        each!(lane => {
            let least = cosines[lane] - turns[lane] * sine[lane] - half[lane] * greater(cosines[lane], 0.0) - ROUNDING;
            greater(least, -1.0)
        }),
    ]
}

/// Unit vectors of these directions, and their original lengths.
#[inline(always)]
fn units(of: &Vectors) -> (Vectors, Lanes<f32>) {
    let squares = dot(of, of);
    let lengths = each!(lane => square_root(squares[lane]));
    (vectors!(axis, lane => of[axis][lane] / lengths[lane]), lengths)
}

/// r·v from n·l, n·v and l·v.
#[inline(always)]
fn mirror(light: &Lanes<f32>, eye: &Lanes<f32>, between: &Lanes<f32>) -> Lanes<f32> {
    each!(lane => 2.0 * light[lane] * eye[lane] - between[lane])
}

/// The greatest and the least of three cosines, each off by at most `off`; arbitrary for NaN.
#[inline(always)]
fn ends(cosines: &[Lanes<f32>; 3], off: &Lanes<f32>) -> [Lanes<f32>; 2] {
    let (mut most, mut least) = ([-1.0; LANES], [1.0; LANES]);
    let mut corner = 0;
    while corner < 3 {
        let cosines = &cosines[corner];
        most = each!(lane => greater(lesser(cosines[lane] + off[lane], 1.0), most[lane]));
        least = each!(lane => lesser(greater(cosines[lane] - off[lane], -1.0), least[lane]));
        corner += 1;
    }
    [most, least]
}

/// The greater one; the second if one is NaN. Written this way, it is one instruction.
#[inline(always)]
pub(super) fn greater(a: f32, b: f32) -> f32 {
    if a > b { a } else { b }
}

/// The lesser one; the second if one is NaN.
#[inline(always)]
pub(super) fn lesser(a: f32, b: f32) -> f32 {
    if a < b { a } else { b }
}

#[inline(always)]
pub(super) fn dot(a: &Vectors, b: &Vectors) -> Lanes<f32> {
    each!(lane => a[0][lane] * b[0][lane] + a[1][lane] * b[1][lane] + a[2][lane] * b[2][lane])
}

/// The square root, with or without `std`: both round correctly, so they agree. The compiler vectorises that of `std`.
#[inline(always)]
pub(super) fn square_root(square: f32) -> f32 {
    #[cfg(feature = "std")]
    {
        square.sqrt()
    }
    #[cfg(not(feature = "std"))]
    {
        libm::sqrtf(square)
    }
}
