//! A stack of fixed size, for what waits during a query.

use std::mem::MaybeUninit;

/// Memory for `PLACES` items, a power of two, so that an index is held in range by a mask. It is not cleared: that would cost more
/// than a short way through a tree. The height is a number beside it, which can so be kept in a register: 0
/// at first, and then what the functions here leave.
pub struct Stack<T, const PLACES: usize>([MaybeUninit<T>; PLACES]);

impl<T: Copy, const PLACES: usize> Stack<T, PLACES> {
    const MASK: usize = {
        assert!(PLACES.is_power_of_two());
        PLACES - 1
    };

    /// Without anything.
    #[inline(always)]
    pub const fn new() -> Self {
        Self([const { MaybeUninit::uninit() }; PLACES])
    }

    /// Puts an item on top; with more than `PLACES` it takes the place of another.
    #[inline(always)]
    pub fn push(&mut self, height: &mut usize, item: T) {
        self.0[*height & Self::MASK].write(item);
        *height += 1;
    }

    /// Takes off the top.
    #[inline(always)]
    pub fn pop(&mut self, height: &mut usize) -> Option<T> {
        *height = height.checked_sub(1)?;
        // SAFETY: everything below the height was written by `push`, and there are never more than there are places.
        Some(unsafe { self.0[*height & Self::MASK].assume_init() })
    }
}

impl<const PLACES: usize> Stack<u64, PLACES> {
    /// Puts a key where it belongs among those from `base` on, the smallest on top.
    #[inline(always)]
    pub fn insert(&mut self, height: &mut usize, key: u64, base: usize) {
        let mut place = *height;
        while place > base {
            let below = self.0[(place - 1) & Self::MASK];
            // SAFETY: everything below the height was written by `push`.
            if unsafe { below.assume_init() } >= key {
                break;
            }
            self.0[place & Self::MASK] = below;
            place -= 1;
        }
        self.0[place & Self::MASK].write(key);
        *height += 1;
    }
}
