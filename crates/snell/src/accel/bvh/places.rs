//! A set of primitives, one bit each.

/// Which of some numbers are in it. It takes no memory where none is.
#[derive(Clone, Debug, PartialEq, Default)]
pub(super) struct Places {
    words: Vec<u64>,
}

impl Places {
    /// Those of `members`, all less than `count`.
    pub(super) fn new(count: usize, members: &[u32]) -> Self {
        let mut words = vec![0; if members.is_empty() { 0 } else { count.div_ceil(64) }];
        for &member in members {
            words[member as usize / 64] |= 1 << (member % 64);
        }
        Self { words }
    }

    #[inline]
    pub(super) fn contains(&self, number: u32) -> bool {
        self.words.get(number as usize / 64).is_some_and(|word| word >> (number % 64) & 1 == 1)
    }

    pub(super) fn bytes(&self) -> usize {
        size_of_val(self.words.as_slice())
    }
}
