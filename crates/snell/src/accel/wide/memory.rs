//! Memory for large trees: on pages of 2 MiB where Linux gives them, since a ray of a large tree touches a new page in
//! nearly every node, and looking up the address then costs more than the node.

use std::mem::MaybeUninit;

/// From how many bytes on it is worth asking.
const LARGE: usize = 8 << 20;

/// An empty vector with room for so many, on huge pages where there are many and the system has them. A wish: where it is
/// not granted nothing but speed is lost.
pub fn roomy<T>(capacity: usize) -> Vec<T> {
    let mut room = Vec::with_capacity(capacity);
    if capacity.saturating_mul(size_of::<T>()) >= LARGE {
        ask_for_large_pages(room.spare_capacity_mut());
    }
    room
}

/// Asks the system for pages of 2 MiB behind memory that is not used yet. A wish: where it is not granted, or there is nothing to grant,
/// nothing but speed is lost.
///
/// ```
/// let mut pixels: Vec<[f32; 3]> = Vec::with_capacity(1 << 20);
/// snell::accel::ask_for_large_pages(pixels.spare_capacity_mut());
/// ```
#[cfg_attr(not(target_os = "linux"), expect(unused_variables, reason = "there is nobody to ask"))]
pub fn ask_for_large_pages<T>(memory: &mut [MaybeUninit<T>]) {
    #[cfg(target_os = "linux")]
    {
        const PAGE: usize = 2 << 20;
        let start = memory.as_mut_ptr() as usize;
        let (first, last) = (start.next_multiple_of(PAGE), (start + size_of_val(memory)) / PAGE * PAGE);
        if first < last {
            // SAFETY: the range lies within memory that is ours alone, and the advice changes nothing of its contents.
            unsafe { libc::madvise(first as *mut libc::c_void, last - first, libc::MADV_HUGEPAGE) };
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn there_is_room() {
        let mut room = roomy::<u64>(LARGE);
        assert!(room.is_empty() && room.capacity() >= LARGE);
        room.extend(0..LARGE as u64);
        assert!(room.into_iter().eq(0..LARGE as u64));
    }
}
