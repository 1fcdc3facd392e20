//! Ranges of the cosines and distances that light on a patch depends on: from the three corners of each of eight faces,
//! or from the boxes and cones of eight nodes of the tree.

use crate::lanes::{LANES, Lanes};

/// x, y and z.
pub(super) type Vectors = [Lanes<f32>; 3];

pub(super) const ZERO: Lanes<f32> = [0.0; LANES];

/// Cosines of f32 are off by less.
const ROUNDING: f32 = 4e-6;

/// Greatest distance that is told from any other.
const FARTHEST: f32 = 1e15;

/// A point, seen from eight patches.
pub(super) struct Sight<D> {
    pub(super) directions: D,
    /// Distances of the nearest and the farthest point of each patch.
    pub(super) near: Lanes<f32>,
    pub(super) far: Lanes<f32>,
}

/// Eight patches of which ranges are known. Ranges are the greatest value and the least.
pub(super) trait Patches {
    /// Directions from the patches to a light or the eye.
    type Directions;

    /// Directions to a sun.
    fn sun(&self, towards: [f32; 3]) -> Self::Directions;
    /// Directions and distances to a point; positions are off by no more than `blur`, and no point of a patch is farther
    /// from its corners than `edge` says.
    fn point(&self, at: [f32; 3], blur: f32, edge: &Lanes<f32>) -> Sight<Self::Directions>;
    /// Range of n·l.
    fn facing(&self, directions: &Self::Directions) -> [Lanes<f32>; 2];
    /// Range of n·l times a lamp's fall-off, whose own range is `falls`.
    fn weighted(&self, sight: &Sight<Self::Directions>, falls: &[Lanes<f32>; 2], inverse_range: f32)
    -> [Lanes<f32>; 2];
    /// Range of r·v at the corners, and its greatest value anywhere; `turns` is what directions to the light and to the eye
    /// turn by along a patch's radius.
    fn mirrored(&self, light: &Self::Directions, eye: &Self::Directions, turns: &Lanes<f32>) -> [Lanes<f32>; 3];
}

/// Eight faces, on the side that is seen: what their corners have. Missing ones are zero.
#[derive(Clone, Copy, Debug)]
pub(super) struct EightFaces {
    pub(super) normals: [Vectors; 3],
    pub(super) positions: [Vectors; 3],
}

/// Unit directions from each corner, their distances, and how far cosines may be off.
pub(super) struct FromCorners {
    directions: [Vectors; 3],
    distances: [Lanes<f32>; 3],
    off: Lanes<f32>,
}

impl Patches for EightFaces {
    type Directions = FromCorners;

    #[inline(always)]
    fn sun(&self, towards: [f32; 3]) -> FromCorners {
        FromCorners { directions: [spread(towards); 3], distances: [ZERO; 3], off: [ROUNDING; LANES] }
    }

    #[inline(always)]
    fn point(&self, at: [f32; 3], blur: f32, edge: &Lanes<f32>) -> Sight<FromCorners> {
        let mut directions = self.positions;
        let mut distances = [ZERO; 3];
        for (ways, distances) in directions.iter_mut().zip(&mut distances) {
            for (values, to) in ways.iter_mut().zip(at) {
                values.iter_mut().for_each(|value| *value = to - *value);
            }
            let squares = dot(ways, ways);
            for lane in 0..LANES {
                distances[lane] = square_root(squares[lane]);
            }
            for values in ways {
                for lane in 0..LANES {
                    values[lane] /= distances[lane];
                }
            }
        }
        let (mut near, mut far, mut off) = (ZERO, ZERO, ZERO);
        for lane in 0..LANES {
            let [a, b, c] = [distances[0][lane], distances[1][lane], distances[2][lane]];
            let least = lesser(a, lesser(b, c)) * (1.0 - ROUNDING) - blur;
            // Lemma 1, of the squares of distances.
            let square = least * least - edge[lane] * edge[lane];
            near[lane] = if least > 0.0 { square_root(greater(square, 0.0)) } else { 0.0 };
            far[lane] = lesser(greater(a, greater(b, c)) * (1.0 + ROUNDING) + blur, FARTHEST);
            off[lane] = ROUNDING + lesser(4.0 * blur / least.abs(), 2.0);
        }
        Sight { directions: FromCorners { directions, distances, off }, near, far }
    }

    #[inline(always)]
    fn facing(&self, to: &FromCorners) -> [Lanes<f32>; 2] {
        let [a, b, c] = &self.normals;
        let [to_a, to_b, to_c] = &to.directions;
        ends(&[dot(a, to_a), dot(b, to_b), dot(c, to_c)], &to.off)
    }

    #[inline(always)]
    fn weighted(&self, sight: &Sight<FromCorners>, _: &[Lanes<f32>; 2], inverse_range: f32) -> [Lanes<f32>; 2] {
        let to = &sight.directions;
        let mut cosines = [ZERO; 3];
        for (corner, cosines) in cosines.iter_mut().enumerate() {
            *cosines = dot(&self.normals[corner], &to.directions[corner]);
            for (cosine, distance) in cosines.iter_mut().zip(&to.distances[corner]) {
                let away = distance * inverse_range;
                let left = greater(1.0 - away * away, 0.0);
                *cosine *= left * left;
            }
        }
        ends(&cosines, &to.off)
    }

    #[inline(always)]
    fn mirrored(&self, light: &FromCorners, eye: &FromCorners, turns: &Lanes<f32>) -> [Lanes<f32>; 3] {
        let mut off = ZERO;
        for (lane, off) in off.iter_mut().enumerate() {
            *off = 3.0 * (light.off[lane] + eye.off[lane]);
        }
        let mut cosines = [ZERO; 3];
        for (corner, cosines) in cosines.iter_mut().enumerate() {
            let (light, eye, normals) = (&light.directions[corner], &eye.directions[corner], &self.normals[corner]);
            *cosines = mirror(&dot(normals, light), &dot(normals, eye), &dot(light, eye));
        }
        let [most, least] = ends(&cosines, &off);
        [most, least, self.highest(light, eye, &off, turns)]
    }
}

impl EightFaces {
    /// The greatest r·v anywhere on the faces, by the vector h half-way between light and eye at the first corner (Lemma
    /// 11): what the normals have across h is a flat triangle, which lies no nearer to 0 than in any one direction.
    #[inline(always)]
    fn highest(&self, light: &FromCorners, eye: &FromCorners, off: &Lanes<f32>, turns: &Lanes<f32>) -> Lanes<f32> {
        let mut half_way = [ZERO; 3];
        for (axis, values) in half_way.iter_mut().enumerate() {
            for (lane, value) in values.iter_mut().enumerate() {
                *value = light.directions[0][axis][lane] + eye.directions[0][axis][lane];
            }
        }
        let squares = dot(&half_way, &half_way);
        for values in &mut half_way {
            for lane in 0..LANES {
                values[lane] /= square_root(squares[lane]);
            }
        }
        let (mut across, mut sum) = (self.normals, [ZERO; 3]);
        for vectors in &mut across {
            let along = dot(vectors, &half_way);
            for axis in 0..3 {
                for lane in 0..LANES {
                    vectors[axis][lane] -= along[lane] * half_way[axis][lane];
                    sum[axis][lane] += vectors[axis][lane];
                }
            }
        }
        let (lengths, [a, b, c]) =
            (dot(&sum, &sum), [dot(&across[0], &sum), dot(&across[1], &sum), dot(&across[2], &sum)]);
        let mut highest = ZERO;
        for lane in 0..LANES {
            let least = lesser(a[lane], lesser(b[lane], c[lane])) / square_root(lengths[lane]) - off[lane];
            let sine = greater(least, 0.0);
            // |l + v|²/2 is 1 + l·v.
            let cosine = 1.0 - 0.5 * squares[lane] * sine * sine + off[lane];
            let cosine = if cosine < 1.0 { cosine } else { 1.0 };
            let turn = 2.0 * turns[lane];
            let more =
                turn * square_root(greater(1.0 - cosine * cosine, 0.0)) + 0.5 * turn * turn * greater(-cosine, 0.0);
            highest[lane] = lesser(cosine + more, 1.0);
        }
        highest
    }
}

/// Eight nodes: a box that all their corners lie in, and a cone that all their normals lie in.
#[derive(Clone, Copy, Debug)]
pub(super) struct EightNodes {
    pub(super) centres: Vectors,
    /// Halves of the boxes' sides.
    pub(super) halves: Vectors,
    pub(super) axes: Vectors,
    /// Half of each cone's angle, in radians; π where it is a right angle or more.
    pub(super) angles: Lanes<f32>,
}

/// A direction from each box's middle, and how far those from other points are turned, in radians.
pub(super) struct FromBoxes {
    directions: Vectors,
    turns: Lanes<f32>,
}

impl Patches for EightNodes {
    type Directions = FromBoxes;

    #[inline(always)]
    fn sun(&self, towards: [f32; 3]) -> FromBoxes {
        FromBoxes { directions: spread(towards), turns: ZERO }
    }

    #[inline(always)]
    fn point(&self, at: [f32; 3], blur: f32, _: &Lanes<f32>) -> Sight<FromBoxes> {
        let (mut directions, mut nearest, mut farthest) = (self.centres, [ZERO; 3], [ZERO; 3]);
        for axis in 0..3 {
            for lane in 0..LANES {
                let way = at[axis] - self.centres[axis][lane];
                let half = self.halves[axis][lane] + blur;
                directions[axis][lane] = way;
                nearest[axis][lane] = greater(way.abs() - half, 0.0);
                farthest[axis][lane] = way.abs() + half;
            }
        }
        let (near, far) = (dot(&nearest, &nearest), dot(&farthest, &farthest));
        let (away, radius) = (dot(&directions, &directions), dot(&self.halves, &self.halves));
        let mut sight = Sight { directions: FromBoxes { directions, turns: ZERO }, near, far };
        for lane in 0..LANES {
            sight.near[lane] = square_root(near[lane]) * (1.0 - ROUNDING);
            sight.far[lane] = lesser(square_root(far[lane]) * (1.0 + ROUNDING), FARTHEST);
            // The sine of the greatest turn is the box's radius over the distance, and no more than its tangent.
            let radius = square_root(radius[lane]) + blur;
            let square = away[lane] * (1.0 - ROUNDING) - radius * radius;
            let tangent = radius / square_root(greater(square, 0.0));
            sight.directions.turns[lane] = lesser(tangent, 4.0);
            let distance = square_root(away[lane]);
            for values in &mut sight.directions.directions {
                values[lane] /= distance;
            }
        }
        sight
    }

    #[inline(always)]
    fn facing(&self, to: &FromBoxes) -> [Lanes<f32>; 2] {
        self.turned(&dot(&self.axes, &to.directions), |lane| self.angles[lane] + to.turns[lane])
    }

    #[inline(always)]
    fn weighted(&self, sight: &Sight<FromBoxes>, falls: &[Lanes<f32>; 2], _: f32) -> [Lanes<f32>; 2] {
        let mut ends = self.facing(&sight.directions);
        for lane in 0..LANES {
            let (most, least) = (falls[0][lane], falls[1][lane]);
            ends[0][lane] *= if ends[0][lane] > 0.0 { most } else { least };
            ends[1][lane] *= if ends[1][lane] > 0.0 { least } else { most };
        }
        ends
    }

    #[inline(always)]
    fn mirrored(&self, light: &FromBoxes, eye: &FromBoxes, _: &Lanes<f32>) -> [Lanes<f32>; 3] {
        let (of_light, of_eye) = (dot(&self.axes, &light.directions), dot(&self.axes, &eye.directions));
        let along = mirror(&of_light, &of_eye, &dot(&light.directions, &eye.directions));
        let [most, least] = self.turned(&along, |lane| 2.0 * self.angles[lane] + light.turns[lane] + eye.turns[lane]);
        [most, least, most]
    }
}

impl EightNodes {
    /// Range of cosines of angles that are so far from these.
    #[inline(always)]
    fn turned(&self, cosines: &Lanes<f32>, turn: impl Fn(usize) -> f32) -> [Lanes<f32>; 2] {
        let mut ends = [[1.0; LANES], [-1.0; LANES]];
        for lane in 0..LANES {
            let (cosine, turn) = (cosines[lane], turn(lane));
            let sine = square_root(greater(1.0 - cosine * cosine, 0.0));
            // cos(μ ∓ t) by Taylor's series; the second term has the sign of a cosine between both.
            let half = 0.5 * turn * turn;
            let most = cosine + turn * sine + half * greater(-cosine, 0.0) + ROUNDING;
            let least = cosine - turn * sine - half * greater(cosine, 0.0) - ROUNDING;
            (ends[0][lane], ends[1][lane]) = (lesser(most, 1.0), greater(least, -1.0));
        }
        ends
    }
}

/// One vector in all lanes.
#[inline(always)]
pub(super) fn spread([x, y, z]: [f32; 3]) -> Vectors {
    [[x; LANES], [y; LANES], [z; LANES]]
}

/// r·v of n·l, n·v and l·v.
#[inline(always)]
fn mirror(light: &Lanes<f32>, eye: &Lanes<f32>, between: &Lanes<f32>) -> Lanes<f32> {
    let mut along = ZERO;
    for lane in 0..LANES {
        along[lane] = 2.0 * light[lane] * eye[lane] - between[lane];
    }
    along
}

/// The greatest and the least of three cosines, each off by no more than `off`. What is not a number may be any.
#[inline(always)]
fn ends(cosines: &[Lanes<f32>; 3], off: &Lanes<f32>) -> [Lanes<f32>; 2] {
    let mut ends = [[-1.0; LANES], [1.0; LANES]];
    for cosines in cosines {
        for lane in 0..LANES {
            let (most, least) = (cosines[lane] + off[lane], cosines[lane] - off[lane]);
            ends[0][lane] = greater(lesser(most, 1.0), ends[0][lane]);
            ends[1][lane] = lesser(greater(least, -1.0), ends[1][lane]);
        }
    }
    ends
}

/// The greater one; the second where one is not a number. In this form it is one instruction.
#[inline(always)]
pub(super) fn greater(a: f32, b: f32) -> f32 {
    if a > b { a } else { b }
}

/// The lesser one; the second where one is not a number.
#[inline(always)]
pub(super) fn lesser(a: f32, b: f32) -> f32 {
    if a < b { a } else { b }
}

#[inline(always)]
pub(super) fn dot(a: &Vectors, b: &Vectors) -> Lanes<f32> {
    let mut sums = ZERO;
    for (lane, sum) in sums.iter_mut().enumerate() {
        *sum = a[0][lane] * b[0][lane] + a[1][lane] * b[1][lane] + a[2][lane] * b[2][lane];
    }
    sums
}

/// Both are the number nearest to the root, so they are one number. The compiler makes vectors of the first.
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
