//! Disjoint sets of numbers (union-find).

use alloc::vec::Vec;

/// A partition of the numbers below a count; at first each is in a set of its own.
#[derive(Default)]
pub(super) struct Sets {
    parents: Vec<u32>,
}

impl Sets {
    /// The numbers below `count`, each in a set of its own.
    pub(super) fn new(count: u32) -> Self {
        Self { parents: (0..count).collect() }
    }

    /// Starts over with the numbers below `count`.
    pub(super) fn renew(&mut self, count: u32) {
        self.parents.clear();
        self.parents.extend(0..count);
    }

    /// The representative of the set of `number`: the lowest number in it.
    pub(super) fn of(&mut self, mut number: u32) -> u32 {
        while self.parents[number as usize] != number {
            // Shortens the path for the next search.
            let next = self.parents[self.parents[number as usize] as usize];
            self.parents[number as usize] = next;
            number = next;
        }
        number
    }

    /// Joins the sets of two numbers.
    pub(super) fn join(&mut self, a: u32, b: u32) {
        let (a, b) = (self.of(a), self.of(b));
        self.parents[a.max(b) as usize] = a.min(b);
    }
}
