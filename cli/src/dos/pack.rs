//! Packs films; [`unpack`](super::unpack) says how, and reads them.

use std::collections::HashMap;

use super::unpack::{Coder, Interval, MIN_REPEAT, Model, Token};

/// The longest repeat.
const MAX_REPEAT: usize = MIN_REPEAT + 255;
/// How many positions with the same three bytes are tried, from the nearest on.
const MAX_TRIED: usize = 256;
/// From this length on, no better repeat is looked for one byte later.
const LONG: usize = 64;

/// Packs bytes, less than 4 GB.
pub(super) fn pack(bytes: &[u8]) -> Vec<u8> {
    let mut writer = Writer { interval: Interval::ALL, out: (bytes.len() as u32).to_le_bytes().to_vec() };
    let (mut model, mut places) = (Model::new(), Places::new(bytes));
    let mut at = 0;
    while at < bytes.len() {
        let mut token = places.best(at, model.distance);
        places.add(at);
        if let Some(repeat) = token.filter(|repeat| repeat.length < LONG) {
            // A byte now, and a better repeat behind it.
            let later = places.best(at + 1, model.distance);
            token = token.filter(|_| later.is_none_or(|later| later.gain() <= repeat.gain() + 4));
        }
        let (token, length) = match token {
            Some(Repeat { distance, length, .. }) => (Token::Repeat { distance, length }, length),
            None => (Token::Byte(bytes[at]), 1),
        };
        model.token(&mut writer, at, token);
        (at + 1..at + length).for_each(|at| places.add(at));
        at += length;
    }
    writer.out.extend(writer.interval.low.to_be_bytes());
    writer.out
}

struct Writer {
    interval: Interval,
    out: Vec<u8>,
}

impl Coder for Writer {
    fn decide(&mut self, probability: u16, yes: bool) -> Option<bool> {
        self.interval.narrow(self.interval.middle(probability), yes);
        while let Some(byte) = self.interval.take() {
            self.out.push(byte);
        }
        Some(yes)
    }
}

#[derive(Clone, Copy)]
struct Repeat {
    distance: usize,
    length: usize,
    is_last_distance: bool,
}

impl Repeat {
    /// The bits saved, roughly.
    fn gain(self) -> usize {
        let cost = if self.is_last_distance { 4 } else { self.distance.ilog2() as usize + 8 };
        (8 * self.length).saturating_sub(cost)
    }
}

/// Where three bytes stood before.
struct Places<'a> {
    bytes: &'a [u8],
    last: HashMap<&'a [u8], usize>,
    /// The place before, with the same three bytes.
    before: Vec<Option<usize>>,
}

impl<'a> Places<'a> {
    fn new(bytes: &'a [u8]) -> Self {
        Self { bytes, last: HashMap::new(), before: vec![None; bytes.len()] }
    }

    fn add(&mut self, at: usize) {
        if let Some(three) = self.bytes.get(at..at + 3) {
            self.before[at] = self.last.insert(three, at);
        }
    }

    /// The number of bytes at a place that stand so far in front, too.
    fn length(&self, at: usize, distance: usize) -> usize {
        let Some(from) = at.checked_sub(distance) else { return 0 };
        let pairs = self.bytes[at..].iter().zip(&self.bytes[from..]).take(MAX_REPEAT);
        pairs.take_while(|(a, b)| a == b).count()
    }

    /// The best repeat at a place, if any is worth it: at the last distance, unless another is much longer.
    fn best(&self, at: usize, last_distance: usize) -> Option<Repeat> {
        let mut best: Option<Repeat> = None;
        let mut place = self.bytes.get(at..at + 3).and_then(|three| self.last.get(three).copied());
        for _ in 0..MAX_TRIED {
            let Some(from) = place else { break };
            let (distance, length) = (at - from, self.length(at, at - from));
            // A distance that is much dearer is worth a byte.
            let more = best.map_or(0, |best| best.length + usize::from(distance.ilog2() > best.distance.ilog2() + 6));
            if length > more {
                best = Some(Repeat { distance, length, is_last_distance: false });
            }
            place = self.before[from];
        }
        // Three bytes are cheaper than a far distance.
        best = best.filter(|best| best.length > 3 || best.distance <= 1 << 12);
        let length = if at < self.bytes.len() { self.length(at, last_distance) } else { 0 };
        if length >= MIN_REPEAT && best.is_none_or(|best| length + 2 >= best.length) {
            best = Some(Repeat { distance: last_distance, length, is_last_distance: true });
        }
        best
    }
}

#[cfg(test)]
mod tests {
    use super::super::unpack::unpack;
    use super::*;

    const PACKED: [u8; 18] = [16, 0, 0, 0, 223, 110, 94, 198, 133, 229, 210, 255, 34, 237, 11, 153, 89, 2];

    /// Bytes with runs, words and repeats, near and far.
    fn cases() -> Vec<Vec<u8>> {
        let mut state = 13_u32;
        let mut random = move || {
            state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            (state >> 24) as u8
        };
        let mut cases: Vec<Vec<u8>> = (0..5).map(|length| vec![7; length]).collect();
        cases.push((0..3000).map(|_| random()).collect());
        cases.push(vec![0; 70_000]);
        let words = (0..4000_u32).flat_map(|i| (i * i / 7).to_le_bytes());
        cases.push(words.chain((0..90_000).map(|i| (i % 251) as u8)).collect());
        // Far repeats of what is random, with a byte changed here and there.
        let block: Vec<u8> = (0..2000).map(|_| random()).collect();
        let mut far: Vec<u8> = (0..40).flat_map(|_| block.clone()).collect();
        for _ in 0..200 {
            let at = usize::from(random()) * 256 + usize::from(random());
            far[at] ^= random();
        }
        cases.push(far);
        cases
    }

    #[test]
    fn what_is_packed_is_unpacked() {
        for bytes in cases() {
            let packed = pack(&bytes);
            assert!(unpack(&packed) == Some(bytes.clone()), "{} bytes", bytes.len());
            // Random bytes grow by less than a twentieth.
            assert!(packed.len() <= bytes.len() * 21 / 20 + 8, "{} bytes, packed {}", bytes.len(), packed.len());
        }
    }

    /// The bytes of a program are those that a machine of other pointers or another order of bytes writes.
    #[test]
    fn packed_bytes_are_these() {
        assert_eq!(pack(b"ABABABAB\x01\x02\x03\x04\x01\x02\x03\x04"), PACKED);
        assert_eq!(pack(b""), [0, 0, 0, 0, 0, 0, 0, 0]);
    }

    #[test]
    fn repeats_take_little() {
        for (case, most) in [(6, 160), (8, 5200)] {
            let (bytes, packed) = (cases()[case].len(), pack(&cases()[case]).len());
            assert!(packed <= most, "{bytes} bytes, packed {packed}");
        }
    }

    /// Truncated, extended or altered data is refused or unpacks to something else: no panic, and not too many bytes.
    #[test]
    fn what_is_broken_is_refused() {
        for bytes in &cases()[5..] {
            let packed = pack(bytes);
            assert!((0..packed.len()).step_by(1 + packed.len() / 200).all(|end| unpack(&packed[..end]).is_none()));
            assert!(unpack(&packed[..packed.len() - 1]).is_none());
            assert!(unpack(&[&packed[..], &[0]].concat()).is_none());
            for at in (4..packed.len()).step_by(1 + packed.len() / 50) {
                let mut other = packed.clone();
                other[at] ^= 0x10;
                assert!(unpack(&other).is_none_or(|unpacked| unpacked.len() == bytes.len()));
            }
        }
        assert!(unpack(&[0xFF; 100]).is_none());
    }
}
