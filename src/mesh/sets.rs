//! Disjoint sets of numbers, which can be joined.

use alloc::vec::Vec;

/// The numbers below a count, each in one set; at first each in a set of its own.
#[derive(Default)]
pub(super) struct Sets {
    parents: Vec<u32>,
}

impl Sets {
    /// The numbers below `count`.
    pub(super) fn new(count: u32) -> Self {
        Self { parents: (0..count).collect() }
    }

    /// Begins anew with the numbers below `count`.
    pub(super) fn renew(&mut self, count: u32) {
        self.parents.clear();
        self.parents.extend(0..count);
    }

    /// The number that stands for the set of `number`: the lowest in it.
    pub(super) fn of(&mut self, mut number: u32) -> u32 {
        while self.parents[number as usize] != number {
            // Shortens the way for the next.
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
