//! Memory for large things, which files, meshes, hierarchies and pictures are: on pages of 2 MiB where Linux gives them. The system
//! then hands out, and clears, one page where it would be five hundred, and the processor finds more of them at once.

use std::alloc::{GlobalAlloc, Layout, System};
use std::mem::MaybeUninit;
use std::slice;

use snell::accel::ask_for_large_pages;

/// The system's allocator, which asks for large pages behind whatever is large.
pub struct LargePages;

/// From how many bytes on: less may have no whole page.
const LARGE: usize = 4 << 20;

// SAFETY: it is the system's allocator; what is asked for beside changes nothing of the memory or of who owns it.
unsafe impl GlobalAlloc for LargePages {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        // SAFETY: the caller keeps the promises of this very function; so below.
        advised(unsafe { System.alloc(layout) }, layout.size())
    }

    unsafe fn alloc_zeroed(&self, layout: Layout) -> *mut u8 {
        // SAFETY: see `alloc`.
        advised(unsafe { System.alloc_zeroed(layout) }, layout.size())
    }

    unsafe fn realloc(&self, memory: *mut u8, layout: Layout, size: usize) -> *mut u8 {
        // SAFETY: see `alloc`.
        advised(unsafe { System.realloc(memory, layout, size) }, size)
    }

    unsafe fn dealloc(&self, memory: *mut u8, layout: Layout) {
        // SAFETY: see `alloc`.
        unsafe { System.dealloc(memory, layout) }
    }
}

/// The same memory, of so many bytes, with large pages asked for where it is large.
#[inline]
fn advised(memory: *mut u8, size: usize) -> *mut u8 {
    if size >= LARGE && !memory.is_null() {
        // SAFETY: memory of so many bytes that was just handed out, and that nobody else knows of until this returns.
        ask_for_large_pages(unsafe { slice::from_raw_parts_mut(memory.cast::<MaybeUninit<u8>>(), size) });
    }
    memory
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn large_things_stay_what_they_are() {
        for size in [LARGE - 1, LARGE, 3 * LARGE + 5] {
            let mut bytes = vec![0_u8; size];
            assert!(bytes.iter().all(|byte| *byte == 0));
            bytes[size - 1] = 7;
            bytes.resize(2 * size, 1);
            bytes.shrink_to(size + 1);
            assert_eq!((bytes[0], bytes[size - 1], bytes[size], bytes[2 * size - 1]), (0, 7, 1, 1));
        }
    }
}
