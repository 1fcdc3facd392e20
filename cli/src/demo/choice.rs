//! One of a list.

/// A list of which one entry is chosen.
pub(super) struct Choice<T> {
    list: Vec<T>,
    at: usize,
}

impl<T> Choice<T> {
    /// Chooses `first`, which is put in front if the list does not contain it.
    pub(super) fn new(list: impl IntoIterator<Item = T>, first: T, same: fn(&T, &T) -> bool) -> Choice<T> {
        let mut list: Vec<T> = list.into_iter().collect();
        let at = list.iter().position(|entry| same(entry, &first)).unwrap_or_else(|| {
            list.insert(0, first);
            0
        });
        Choice { list, at }
    }

    pub(super) fn chosen(&self) -> &T {
        &self.list[self.at]
    }

    /// Chooses the first entry that is wanted. Returns whether there is one.
    pub(super) fn choose(&mut self, is_wanted: impl FnMut(&T) -> bool) -> bool {
        let found = self.list.iter().position(is_wanted);
        self.at = found.unwrap_or(self.at);
        found.is_some()
    }

    pub(super) fn go_round(&mut self) {
        self.at = (self.at + 1) % self.list.len();
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_choice_goes_round() {
        let mut choice = Choice::new([1, 2, 3], 2, |a, b| a == b);
        choice.go_round();
        assert_eq!(*choice.chosen(), 3);
        choice.go_round();
        assert_eq!(*choice.chosen(), 1);
        assert!(choice.choose(|&entry| entry > 1) && *choice.chosen() == 2);
        assert!(!choice.choose(|&entry| entry > 3) && *choice.chosen() == 2);
        assert_eq!(Choice::new([1, 2], 7, |a, b| a == b).list, [7, 1, 2]);
    }
}
