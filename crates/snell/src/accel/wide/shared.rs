//! Primitives that several leaves have, as long ones do that were cut for the sake of smaller boxes.
//!
//! Their numbers are marked in the leaves. A query for the closest hit does not care; one that visits every primitive once
//! remembers the marked ones that it has seen, and only these.

use std::collections::BTreeSet;

use smallvec::SmallVec;

use super::WIDTH;

/// An empty place of a leaf.
pub const NONE: u32 = u32::MAX;

/// The mark in a primitive's number that says that other leaves have it too.
pub const SHARED: u32 = 1 << 31;

/// The number of a primitive, without the mark.
#[inline(always)]
pub fn number(entry: u32) -> u32 {
    entry & !SHARED
}

/// Marks what is in more than one of the leaves; numbers are below `count`.
pub(super) fn mark_shared(leaves: &mut [[u32; WIDTH]], count: usize) {
    let mut seen = vec![0_u64; count.div_ceil(64)];
    let mut shared = vec![0_u64; count.div_ceil(64)];
    let mut any = 0;
    for entry in leaves.iter().flatten().filter(|entry| **entry != NONE) {
        let (word, bit) = (*entry as usize / 64, 1 << (entry % 64));
        let again = seen[word] & bit;
        shared[word] |= again;
        any |= again;
        seen[word] |= bit;
    }
    if any != 0 {
        for entry in leaves.iter_mut().flatten().filter(|entry| **entry != NONE) {
            if shared[*entry as usize / 64] >> (*entry % 64) & 1 == 1 {
                *entry |= SHARED;
            }
        }
    }
}

/// Which of the marked primitives some rays' queries have visited.
#[derive(Debug, Default)]
pub struct Visited {
    few: SmallVec<[u64; 16]>,
    /// Once there are too many to look through.
    many: BTreeSet<u64>,
}

impl Visited {
    /// True the first time that a leaf's entry is asked for by the ray of a lane, and always for one that no other leaf has.
    #[inline(always)]
    pub fn is_new(&mut self, lane: usize, entry: u32) -> bool {
        entry & SHARED == 0 || self.insert((lane as u64) << 32 | u64::from(entry))
    }

    #[inline(never)]
    fn insert(&mut self, key: u64) -> bool {
        if self.many.is_empty() && self.few.len() < 16 {
            let is_new = !self.few.contains(&key);
            if is_new {
                self.few.push(key);
            }
            return is_new;
        }
        if self.many.is_empty() {
            self.many.extend(self.few.iter());
        }
        self.many.insert(key)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn marked_ones_are_new_once() {
        let mut visited = Visited::default();
        for round in 0..3 {
            for (primitive, lane) in (0..100).flat_map(|primitive| [(primitive, 0), (primitive, 5)]) {
                assert_eq!(visited.is_new(lane, primitive | SHARED), round == 0);
                assert!(visited.is_new(lane, 1000 + primitive));
            }
        }
    }

    #[test]
    fn what_two_leaves_have_is_marked() {
        let leaf = |entries: [u32; 2]| [entries[0], entries[1], NONE, NONE, NONE, NONE, NONE, NONE];
        let mut leaves = [leaf([0, 70]), leaf([1, 70]), leaf([2, NONE])];
        mark_shared(&mut leaves, 71);
        assert_eq!(leaves, [leaf([0, 70 | SHARED]), leaf([1, 70 | SHARED]), leaf([2, NONE])]);
    }
}
