//! Which of some lanes are meant: one bit each, the first lane the lowest.

use std::ops::{BitAnd, BitAndAssign, BitOr, BitOrAssign, Not};

use super::WIDTH;

/// A set of lanes.
///
/// ```
/// use snell_math::lanes::Bits;
/// let odd = Bits(0b1010);
/// assert_eq!(odd.lanes().collect::<Vec<_>>(), [1, 3]);
/// assert_eq!((odd & Bits::first(3)).count(), 1);
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub struct Bits(pub u8);

impl Bits {
    /// No lane.
    pub const NONE: Self = Self(0);

    /// The first lanes.
    ///
    /// # Panics
    /// With debug assertions, where there are not so many.
    #[inline(always)]
    #[must_use]
    pub const fn first(count: usize) -> Self {
        debug_assert!(count <= WIDTH);
        Self(((1_u32 << count) - 1) as u8)
    }

    /// One lane.
    #[inline(always)]
    #[must_use]
    pub const fn lane(lane: usize) -> Self {
        Self(1 << lane)
    }

    /// All lanes where the condition holds, none where it does not.
    #[inline(always)]
    #[must_use]
    pub const fn all_if(condition: bool) -> Self {
        Self(if condition { u8::MAX } else { 0 })
    }

    /// No lane is in it.
    #[inline(always)]
    #[must_use]
    pub const fn is_empty(self) -> bool {
        self.0 == 0
    }

    /// Some lane is in it.
    #[inline(always)]
    #[must_use]
    pub const fn any(self) -> bool {
        self.0 != 0
    }

    /// How many lanes are in it.
    #[inline(always)]
    #[must_use]
    pub const fn count(self) -> u32 {
        self.0.count_ones()
    }

    /// The first lane that is in it; 8 where there is none.
    #[inline(always)]
    #[must_use]
    pub const fn lowest(self) -> usize {
        self.0.trailing_zeros() as usize
    }

    /// Whether a lane is in it.
    #[inline(always)]
    #[must_use]
    pub const fn has(self, lane: usize) -> bool {
        self.0 >> lane & 1 == 1
    }

    /// The same in a register's width.
    #[inline(always)]
    #[must_use]
    pub const fn mask(self) -> u32 {
        self.0 as u32
    }

    /// These without those.
    #[inline(always)]
    #[must_use]
    pub const fn without(self, other: Self) -> Self {
        Self(self.0 & !other.0)
    }

    /// The lanes in it, in ascending order.
    #[inline(always)]
    pub fn lanes(self) -> impl Iterator<Item = usize> {
        let mut rest = self.0;
        std::iter::from_fn(move || {
            let lane = rest.trailing_zeros() as usize;
            let found = rest != 0;
            rest &= rest.wrapping_sub(1);
            // Masked only to show that the place is in a row.
            found.then_some(lane & (WIDTH - 1))
        })
    }
}

impl BitAnd for Bits {
    type Output = Self;
    #[inline(always)]
    fn bitand(self, other: Self) -> Self {
        Self(self.0 & other.0)
    }
}

impl BitOr for Bits {
    type Output = Self;
    #[inline(always)]
    fn bitor(self, other: Self) -> Self {
        Self(self.0 | other.0)
    }
}

impl Not for Bits {
    type Output = Self;
    #[inline(always)]
    fn not(self) -> Self {
        Self(!self.0)
    }
}

impl BitAndAssign for Bits {
    #[inline(always)]
    fn bitand_assign(&mut self, other: Self) {
        self.0 &= other.0;
    }
}

impl BitOrAssign for Bits {
    #[inline(always)]
    fn bitor_assign(&mut self, other: Self) {
        self.0 |= other.0;
    }
}
