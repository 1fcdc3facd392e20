//! A hash table from edges to numbers that reuses its memory from frame to frame.
//!
//! Open addressing: an edge is in the first free slot at or after the one its hash gives, and the
//! table is never more than half full. It is only looked up, never iterated, so no byte depends on
//! the hash.

use alloc::vec::Vec;

/// Marks a free slot; it is not an edge, because the ends of an edge differ.
const FREE: (u32, u32) = (u32::MAX, u32::MAX);

/// Map from an edge, a pair of different numbers, to a number.
#[derive(Debug, Default)]
pub(super) struct EdgeMap {
    /// Edges and their numbers, at indices by hash. The length is a power of two, or zero.
    slots: Vec<((u32, u32), u32)>,
    count: usize,
}

impl EdgeMap {
    /// Removes all edges.
    pub(super) fn clear(&mut self) {
        self.slots.fill((FREE, 0));
        self.count = 0;
    }

    pub(super) fn is_empty(&self) -> bool {
        self.count == 0
    }

    /// The number of an edge, if it has one.
    pub(super) fn get(&self, edge: (u32, u32)) -> Option<u32> {
        let (known, number) = *self.slots.get(self.slot(edge)?)?;
        (known == edge).then_some(number)
    }

    /// Sets the number of an edge, replacing an earlier one.
    pub(super) fn insert(&mut self, edge: (u32, u32), number: u32) {
        if 2 * (self.count + 1) > self.slots.len() {
            self.grow();
        }
        if let Some(slot) = self.slot(edge) {
            self.count += usize::from(self.slots[slot].0 == FREE);
            self.slots[slot] = (edge, number);
        }
    }

    /// The slot of an edge, or the one where it would be inserted; `None` in a table without slots.
    fn slot(&self, (a, b): (u32, u32)) -> Option<usize> {
        let last = self.slots.len().checked_sub(1)?;
        // Knuth's multiplicative hash (The Art of Computer Programming, 6.4), 2⁶⁴ over the golden ratio. Its upper
        // half is the better one, and 32 bits fit a `usize`.
        let hash = (u64::from(a) << 32 | u64::from(b)).wrapping_mul(0x9E37_79B9_7F4A_7C15) >> 32;
        let mut slot = hash as usize & last;
        // At least half of the slots are free, so this ends.
        while self.slots[slot].0 != FREE && self.slots[slot].0 != (a, b) {
            slot = (slot + 1) & last;
        }
        Some(slot)
    }

    /// Doubles the number of slots.
    #[cold]
    fn grow(&mut self) {
        let slots = (2 * self.slots.len()).max(16);
        let before = core::mem::replace(&mut self.slots, alloc::vec![(FREE, 0); slots]);
        self.count = 0;
        before.into_iter().filter(|(edge, _)| *edge != FREE).for_each(|(edge, number)| self.insert(edge, number));
    }
}

#[cfg(test)]
mod tests {
    use alloc::collections::BTreeMap;

    use super::EdgeMap;

    #[test]
    fn it_is_a_map() {
        let (mut map, mut naive) = (EdgeMap::default(), BTreeMap::new());
        assert_eq!((map.get((0, 1)), map.is_empty()), (None, true));
        let mut random = 1_u64;
        for number in 0..20_000 {
            // Knuth's generator for MMIX; edges occur more than once.
            random = random.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            let (a, b) = ((random >> 33) as u32 % 90, (random >> 45) as u32 % 90 + 90);
            assert_eq!(map.get((a, b)), naive.get(&(a, b)).copied());
            if number % 3 == 0 {
                map.insert((a, b), number);
                naive.insert((a, b), number);
            }
        }
        assert_eq!((map.count, map.is_empty()), (naive.len(), false));
        let slots = map.slots.len();
        map.clear();
        assert!(map.is_empty() && naive.keys().all(|edge| map.get(*edge).is_none()));
        naive.iter().for_each(|(edge, number)| map.insert(*edge, *number));
        assert!(naive.iter().all(|(edge, number)| map.get(*edge) == Some(*number)));
        assert_eq!(map.slots.len(), slots, "its memory is used again");
    }
}
