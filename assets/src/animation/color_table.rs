//! Colour tables of animations: each colour once, however many entries of a palette have it.
//!
//! A palette of 256 entries has few colours where its ramps are of a single hue: a DAC with 6 bits per channel has 64
//! greys. Merging the indices of equal colours gives the compressor more repetition: a turn of the torus takes half the
//! bytes.

use mode13h::palette::Rgb;

/// Distinct colours, at most 256.
pub(super) struct ColorTable {
    colors: Vec<Rgb>,
}

impl ColorTable {
    /// The colours of a palette, in the order of its entries.
    pub(super) fn of_all(palette: &[Rgb; 256]) -> ColorTable {
        ColorTable::new(palette.iter())
    }

    /// The colours of these palette indices, in the order of the palette's entries.
    pub(super) fn of_used(palette: &[Rgb; 256], indices: &[u8]) -> ColorTable {
        let used = used(indices);
        ColorTable::new(palette.iter().zip(used).filter_map(|(color, used)| used.then_some(color)))
    }

    fn new<'a>(all: impl Iterator<Item = &'a Rgb>) -> ColorTable {
        let mut colors: Vec<Rgb> = Vec::new();
        for color in all {
            if !colors.contains(color) {
                colors.push(*color);
            }
        }
        ColorTable { colors }
    }

    /// The index in this table of each entry of a palette; `None` if the indices use a colour that is not in it.
    pub(super) fn places(&self, palette: &[Rgb; 256], indices: &[u8]) -> Option<[u8; 256]> {
        let mut places = [0; 256];
        for ((place, color), used) in places.iter_mut().zip(palette).zip(used(indices)) {
            if used {
                // Below 256.
                *place = self.colors.iter().position(|known| known == color)? as u8;
            }
        }
        Some(places)
    }

    /// The first index of the table that none of these pixels uses, to mark transparent pixels.
    pub(super) fn free(&self, indices: &[u8]) -> Option<u8> {
        used(indices).iter().take(self.entries()).position(|used| !used).map(|free| free as u8)
    }

    /// The entry after the colours, if there is room for one: no pixel of any frame has it.
    pub(super) fn spare(&self) -> Option<u8> {
        u8::try_from(self.colors.len()).ok()
    }

    /// Red, green and blue of each entry: the colours, and one more if there is room.
    pub(super) fn bytes(&self) -> Vec<u8> {
        let spare = [Rgb::BLACK];
        let entries = self.colors.iter().chain(&spare).take(self.entries());
        entries.flat_map(|color| [color.r, color.g, color.b]).collect()
    }

    fn entries(&self) -> usize {
        (self.colors.len() + 1).min(256)
    }
}

/// Marks the indices that occur.
fn used(indices: &[u8]) -> [bool; 256] {
    let mut used = [false; 256];
    indices.iter().for_each(|&index| used[usize::from(index)] = true);
    used
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_table_has_each_color_once_and_room_for_one_more() {
        let mut palette: [Rgb; 256] = std::array::from_fn(|i| Rgb::new(i as u8 / 4 * 4, 0, 0));
        let table = ColorTable::of_all(&palette);
        assert_eq!(table.bytes().len(), 3 * 65);
        let places = table.places(&palette, &[0, 3, 4, 255]).expect("all are there");
        assert_eq!([0, 3, 4, 255].map(|i| places[i]), [0, 0, 1, 63]);
        assert_eq!(table.free(&[0, 1, 3]), Some(2));
        assert_eq!(table.free(&std::array::from_fn::<u8, 64, _>(|i| i as u8)), Some(64));
        // A missing colour matters only where it is used.
        palette[9] = Rgb::WHITE;
        assert!(table.places(&palette, &[8]).is_some() && table.places(&palette, &[9]).is_none());
        assert_eq!(ColorTable::of_used(&palette, &[9, 9, 0]).bytes(), [0, 0, 0, 255, 255, 255, 0, 0, 0]);
    }

    #[test]
    fn a_full_table_has_room_only_where_something_is_not_used() {
        let palette: [Rgb; 256] = std::array::from_fn(|i| Rgb::new(i as u8, 0, 0));
        let table = ColorTable::of_all(&palette);
        assert_eq!(table.bytes().len(), 768);
        let all: [u8; 256] = std::array::from_fn(|i| i as u8);
        assert_eq!((table.free(&all), table.free(&all[..255])), (None, Some(255)));
    }
}
