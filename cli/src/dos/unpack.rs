//! Unpacks films: bytes that stood before are repeats (LZ77), and each decision is coded by how often it was taken before
//! (an adaptive arithmetic coder of bits). The program for DOS includes this file; `pack` is its counterpart.
//!
//! ```text
//! u32, little-endian: bytes when unpacked. Decisions, until there are as many:
//!     a repeat?  by the place in a word of four bytes, and by whether a repeat stood before
//!         no:    the byte, by its place in a word
//!         yes:   the distance of the last repeat?
//!                length - MIN_REPEAT, in 8 bits
//!                if not the last distance: the digits of the distance after its first, in 5 bits; these digits
//! ```
//!
//! Numbers have their high bit first. A bit's probability is that of the bits above it.

use alloc::vec::Vec;

/// The shortest repeat.
pub(crate) const MIN_REPEAT: usize = 2;

/// Codes decisions.
pub(crate) trait Coder {
    /// Returns a decision whose probability of being yes is given in 65,536ths. The packer is told the decision and
    /// codes it; the unpacker finds it. `None` if there is nothing left to read.
    fn decide(&mut self, probability: u16, yes: bool) -> Option<bool>;
}

/// The numbers that still stand for what is coded so far.
pub(crate) struct Interval {
    pub(crate) low: u32,
    high: u32,
}

impl Interval {
    pub(crate) const ALL: Self = Self { low: 0, high: u32::MAX };

    /// The last number that stands for yes: at least `low`, and below `high`.
    pub(crate) fn middle(&self, probability: u16) -> u32 {
        self.low + ((self.high - self.low) >> 16) * u32::from(probability)
    }

    pub(crate) fn narrow(&mut self, middle: u32, yes: bool) {
        if yes { self.high = middle } else { self.low = middle + 1 }
    }

    /// Takes the first byte off, if all numbers have the same.
    pub(crate) fn take(&mut self) -> Option<u8> {
        let byte = self.low.to_be_bytes()[0];
        (byte == self.high.to_be_bytes()[0]).then(|| {
            (self.low, self.high) = (self.low << 8, self.high << 8 | 0xFF);
            byte
        })
    }
}

/// A part of a film.
#[derive(Clone, Copy)]
pub(crate) enum Token {
    Byte(u8),
    /// Bytes that stand so far in front, `MIN_REPEAT` of them and up to 255 more.
    Repeat {
        distance: usize,
        length: usize,
    },
}

/// How probable every decision is.
pub(crate) struct Model {
    is_repeat: [[u16; 4]; 2],
    is_last_distance: [u16; 4],
    byte: [[u16; 256]; 4],
    length: [[u16; 256]; 2],
    digits: [[u16; 32]; 4],
    digit: [[u16; 32]; 32],
    /// The distance of the last repeat.
    pub(crate) distance: usize,
    /// 1 after a repeat.
    after: usize,
}

impl Model {
    pub(crate) fn new() -> Self {
        const EVEN: u16 = 1 << 15;
        Self {
            is_repeat: [[EVEN; 4]; 2],
            is_last_distance: [EVEN; 4],
            byte: [[EVEN; 256]; 4],
            length: [[EVEN; 256]; 2],
            digits: [[EVEN; 32]; 4],
            digit: [[EVEN; 32]; 32],
            distance: 1,
            after: 0,
        }
    }

    /// Codes what stands at a place: what a writer is told, or what a reader finds.
    pub(crate) fn token(&mut self, coder: &mut impl Coder, place: usize, told: Token) -> Option<Token> {
        let (is_repeat, byte, told_distance, told_length) = match told {
            Token::Byte(byte) => (false, byte, 1, MIN_REPEAT),
            Token::Repeat { distance, length } => (true, 0, distance, length),
        };
        let place = place % 4;
        if !bit(coder, &mut self.is_repeat[self.after][place], is_repeat)? {
            self.after = 0;
            return Some(Token::Byte(tree(coder, &mut self.byte[place], 8, byte.into())? as u8)); // below 2⁸
        }
        self.after = 1;
        let is_last = bit(coder, &mut self.is_last_distance[place], told_distance == self.distance)?;
        let more = tree(coder, &mut self.length[usize::from(is_last)], 8, told_length - MIN_REPEAT)?;
        if !is_last {
            let digits = tree(coder, &mut self.digits[more.min(3)], 5, told_distance.ilog2() as usize)?;
            self.distance = 1;
            for i in (0..digits).rev() {
                let digit = bit(coder, &mut self.digit[digits][i], told_distance >> i & 1 == 1)?;
                self.distance = self.distance << 1 | usize::from(digit);
            }
        }
        Some(Token::Repeat { distance: self.distance, length: more + MIN_REPEAT })
    }
}

/// Codes a decision, and makes the one that was taken more probable.
fn bit(coder: &mut impl Coder, probability: &mut u16, yes: bool) -> Option<bool> {
    let yes = coder.decide(*probability, yes)?;
    // Stays within 15 and 65,520.
    if yes {
        *probability += (u16::MAX - *probability) >> 4
    } else {
        *probability -= *probability >> 4
    }
    Some(yes)
}

/// Codes a number of some bits.
fn tree(coder: &mut impl Coder, probabilities: &mut [u16], bits: u32, number: usize) -> Option<usize> {
    let mut node = 1;
    for i in (0..bits).rev() {
        let probability = probabilities.get_mut(node)?;
        node = node << 1 | usize::from(bit(coder, probability, number >> i & 1 == 1)?);
    }
    Some(node - (1 << bits))
}

struct Reader<'a> {
    interval: Interval,
    number: u32,
    rest: &'a [u8],
}

impl Reader<'_> {
    fn read_byte(&mut self) -> Option<()> {
        let (byte, rest) = self.rest.split_first()?;
        (self.number, self.rest) = (self.number << 8 | u32::from(*byte), rest);
        Some(())
    }
}

impl Coder for Reader<'_> {
    fn decide(&mut self, probability: u16, _: bool) -> Option<bool> {
        let middle = self.interval.middle(probability);
        let yes = self.number <= middle;
        self.interval.narrow(middle, yes);
        while self.interval.take().is_some() {
            self.read_byte()?;
        }
        Some(yes)
    }
}

/// Unpacks bytes; `None` if they are broken off, or were not packed, or if there is no room.
pub(crate) fn unpack(bytes: &[u8]) -> Option<Vec<u8>> {
    let (count, rest) = bytes.split_first_chunk()?;
    let count = usize::try_from(u32::from_le_bytes(*count)).ok()?;
    let mut out = Vec::new();
    out.try_reserve_exact(count).ok()?;
    let mut reader = Reader { interval: Interval::ALL, number: 0, rest };
    // One by one: the compiler makes BSWAP of `from_be_bytes`, for a 386, too, which lacks it.
    for _ in 0..4 {
        reader.read_byte()?;
    }
    let mut model = Model::new();
    while out.len() < count {
        match model.token(&mut reader, out.len(), Token::Byte(0))? {
            Token::Byte(byte) => out.push(byte),
            Token::Repeat { distance, length } => {
                let from = out.len().checked_sub(distance)?;
                if length > count - out.len() {
                    return None;
                }
                // A repeat may repeat itself.
                (from..from + length).for_each(|i| out.push(out[i]));
            }
        }
    }
    reader.rest.is_empty().then_some(out)
}
