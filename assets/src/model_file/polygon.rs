//! Splits a face with more than three corners into triangles: by a fan if it is convex, otherwise by ear clipping. A
//! large monotone face, such as a convex one whose corners were rounded, is split by a sweep.

use core::mem;

use earcut::Earcut;
use mode13h::glam::Vec3;

use super::ModelFileErrorKind;
use crate::wide::{Wide, add, cross, sub, widen};

/// The maximum number of corners of a concave face, unless it is monotone. Ear clipping takes quadratic time if corners
/// are spread unevenly or edges cross: 20,000 take 0.1 s in the shape of a star, 4 s in the shape of many crossing
/// pentagrams, and 64,000 already 10 s and more. So no corner of a file costs more than 20,000 steps.
const MAX_CONCAVE: usize = 20_000;

/// Buffers reused for every face.
#[derive(Default)]
pub(super) struct Splitter {
    earcut: Earcut<f64>,
    flat: Vec<[f64; 2]>,
    cut: Vec<u32>,
    triangles: Vec<[u32; 3]>,
    edges: Vec<(u32, u32)>,
    stack: Vec<u32>,
}

impl Splitter {
    /// Splits a face of n corners into n − 2 triangles, as indices of its corners, in the face's winding. Each edge of
    /// the face is an edge of one of them, so no gap opens to its neighbours. A corner in the middle of a straight edge
    /// is therefore preserved, if need be by a triangle without area.
    pub(super) fn split(&mut self, corners: &[Vec3]) -> Result<&[[u32; 3]], ModelFileErrorKind> {
        self.triangles.clear();
        if corners.len() > 3 && self.flatten(corners) && !self.is_convex() {
            if corners.len() <= MAX_CONCAVE {
                if !self.repeats_an_edge() {
                    self.cut_ears();
                }
            } else if !self.sweep(0) && !self.sweep(1) {
                return Err(ModelFileErrorKind::TooLarge("a concave face of more than 20,000 corners"));
            }
        }
        // Convex, collinear, or so tangled that ears could not be clipped.
        if self.triangles.len() != corners.len() - 2 {
            self.triangles.clear();
            // Fewer than 2³² corners, see `Lists::end_face`.
            self.triangles.extend((1..corners.len() as u32 - 1).map(|i| [0, i, i + 1]));
        }
        Ok(&self.triangles)
    }

    /// Splits a face that is **monotone**: along one axis (0 or 1) its outline goes forward once and back once, so that
    /// a line across the axis meets it twice. Returns `false` if it is not. The time grows linearly with the number of
    /// corners (M. Garey and others, "Triangulating a simple polygon", 1978).
    ///
    /// Convex faces are monotone, and remain so when their corners are rounded, which preserves the order of
    /// coordinates. They do not remain convex: a corner of a ring of 30,000 rises above its neighbours by less than f32
    /// can represent.
    fn sweep(&mut self, axis: usize) -> bool {
        let n = self.flat.len();
        let at = |i: u32| self.flat[i as usize % n][axis];
        // Fewer than 2³² corners, see `Lists::end_face`.
        let count = n as u32;
        // The last corner with the least coordinate, and the one where the greatest is reached.
        let least = (0..count).fold(0, |best, i| if at(i) < at(best) { i } else { best });
        let Some(first) = (least..least + count).find(|&i| at(i + 1) > at(i)) else { return false };
        let turn = (first..first + count).find(|&i| at(i + 1) < at(i)).unwrap_or(first);
        if (turn..first + count).any(|i| at(i + 1) > at(i)) {
            return false;
        }
        // Merges both chains by coordinate; where it is equal, each chain keeps its own order, and the turn comes last.
        let (mut forth, mut back) = (first, first + count - 1);
        let mut was_forth = true;
        self.stack.clear();
        for i in 0..count {
            let is_forth = back <= turn || (forth < turn && at(forth) <= at(back));
            let corner = if is_forth { forth } else { back };
            if is_forth {
                forth += 1
            } else {
                back -= 1
            }
            let new = corner % count;
            if i > 1 && (is_forth != was_forth || i == count - 1) {
                // It sees all the remaining corners, which are on the other chain.
                self.triangles.extend(self.stack.windows(2).map(|pair| ascending([pair[0], pair[1], new])));
                if let Some(&last) = self.stack.last() {
                    self.stack.clear();
                    self.stack.push(last);
                }
            } else {
                // Clips what the last corners of its own chain leave open.
                while let [.., before, last] = *self.stack.as_slice() {
                    let [a, b, c] = [before, last, new].map(|corner| self.flat[corner as usize]);
                    let turns = (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
                    if (turns < 0.0) == is_forth || turns == 0.0 {
                        break;
                    }
                    self.triangles.push(ascending([before, last, new]));
                    self.stack.pop();
                }
            }
            self.stack.push(new);
            was_forth = is_forth;
        }
        true
    }

    fn cut_ears(&mut self) {
        self.earcut.earcut_slice(&self.flat, &[], &mut self.cut);
        // Sorted in the order of the face, the corners of each triangle have the face's winding.
        self.triangles.extend(self.cut.as_chunks::<3>().0.iter().map(|t| ascending(*t)));
        // Ear clipping may drop coincident corners and those on straight edges.
        if self.triangles.len() != self.flat.len() - 2 {
            self.put_back(self.flat.len());
        }
    }

    /// Returns whether the face traverses an edge twice in the same direction, as no outline does, not even one that is
    /// cut open to a hole. Ear clipping would take cubic time to find that out: a triangle traversed 1,300 times took
    /// 15 s.
    fn repeats_an_edge(&self) -> bool {
        let next = self.flat.iter().cycle().skip(1);
        // 0 and −0 are the same position.
        let key = |p: &[f64; 2]| p.map(|x| (x + 0.0).to_bits());
        let mut edges: Vec<_> = self.flat.iter().zip(next).map(|(a, b)| (key(a), key(b))).collect();
        edges.retain(|(a, b)| a != b);
        edges.sort_unstable();
        edges.windows(2).any(|pair| pair[0] == pair[1])
    }

    /// Projects the face onto the coordinate plane that it is most nearly parallel to, so that it is counter-clockwise
    /// there. Returns `false` if it has no area.
    fn flatten(&mut self, corners: &[Vec3]) -> bool {
        let origin = widen(corners[0]);
        let from_first = |p: Vec3| sub(widen(p), origin);
        // Newell's normal, whose length is twice the area.
        let mut normal: Wide = [0.0; 3];
        for pair in corners.windows(2) {
            normal = add(normal, cross(from_first(pair[0]), from_first(pair[1])));
        }
        let size = normal.map(libm::fabs);
        let axis = if size[0] > size[1].max(size[2]) {
            0
        } else if size[1] > size[2] {
            1
        } else {
            2
        };
        if size[axis] == 0.0 {
            return false;
        }
        let (mut right, mut up) = ((axis + 1) % 3, (axis + 2) % 3);
        if normal[axis] < 0.0 {
            mem::swap(&mut right, &mut up);
        }
        self.flat.clear();
        self.flat.extend(corners.iter().map(|&p| {
            let p = from_first(p);
            [p[right], p[up]]
        }));
        true
    }

    /// Returns whether the face turns left or not at all at each corner, and makes one full turn in all.
    fn is_convex(&self) -> bool {
        let n = self.flat.len();
        let edge = |i: usize| {
            let (a, b) = (self.flat[i % n], self.flat[(i + 1) % n]);
            [b[0] - a[0], b[1] - a[1]]
        };
        let upward = |e: [f64; 2]| e[1] > 0.0 || (e[1] == 0.0 && e[0] > 0.0);
        let mut rounds = 0;
        // At least one edge is not zero, since the face has an area.
        let Some(mut last) = (0..n).rev().map(edge).find(|e| *e != [0.0; 2]) else { return false };
        for next in (0..n).map(edge).filter(|e| *e != [0.0; 2]) {
            let turn = last[0] * next[1] - last[1] * next[0];
            let back = last[0] * next[0] + last[1] * next[1] < 0.0;
            if turn < 0.0 || (turn == 0.0 && back) {
                return false;
            }
            rounds += u32::from(!upward(last) && upward(next));
            last = next;
        }
        rounds == 1
    }

    /// Restores the corners that were dropped, each on the edge of the triangle that skipped it.
    fn put_back(&mut self, corners: usize) {
        let cut = mem::take(&mut self.triangles);
        self.edges.clear();
        self.edges.extend(cut.iter().flat_map(|&[a, b, c]| [(a, b), (b, c), (c, a)]));
        self.edges.sort_unstable();
        // At most `MAX_CONCAVE`.
        let n = corners as u32;
        for &[a, b, c] in &cut {
            // From corner to corner around the triangle, including those that its outer edges skip.
            let mut loop_ = Vec::new();
            let mut apex = 0;
            for (from, to) in [(a, b), (b, c), (c, a)] {
                let outer = self.edges.binary_search(&(to, from)).is_err();
                let passed = if outer { (to + n - from) % n } else { 1 };
                if passed == 1 {
                    // A fan from a corner between two unbroken edges has no needless degenerate triangle.
                    apex = loop_.len();
                }
                loop_.extend((0..passed).map(|i| (from + i) % n));
            }
            loop_.rotate_left(apex);
            // In a tangled face several edges may seem to skip the same corners: `split` will notice the wrong number,
            // so going on would only cost quadratic time.
            if self.triangles.len() + loop_.len() > corners {
                return;
            }
            self.triangles.extend(loop_.windows(2).skip(1).map(|pair| ascending([loop_[0], pair[0], pair[1]])));
        }
    }
}

/// The triangle's corners in the order of the face.
fn ascending(mut triangle: [u32; 3]) -> [u32; 3] {
    triangle.sort_unstable();
    triangle
}
