//! Memory for large trees: on pages of 2 MiB where Linux gives them, since a ray of a large tree touches a new page in
//! nearly every node, and looking up the address then costs more than the node.

/// From how many bytes on it is worth asking.
const LARGE: usize = 8 << 20;

/// An empty vector with room for so many, on huge pages where there are many and the system has them. A wish: where it is
/// not granted nothing but speed is lost.
pub fn roomy<T>(capacity: usize) -> Vec<T> {
    let mut room = Vec::with_capacity(capacity);
    if capacity.saturating_mul(size_of::<T>()) >= LARGE {
        advise(room.spare_capacity_mut());
    }
    room
}

/// The same vector; where it is large, moved to huge pages.
pub fn settled<T: Copy>(items: Vec<T>) -> Vec<T> {
    let mut room = roomy(items.len());
    room.extend_from_slice(&items);
    room
}

#[cfg(target_os = "linux")]
fn advise<T>(memory: &mut [T]) {
    const PAGE: usize = 2 << 20;
    let start = memory.as_mut_ptr() as usize;
    let (first, last) = (start.next_multiple_of(PAGE), (start + size_of_val(memory)) / PAGE * PAGE);
    if first < last {
        // SAFETY: the range lies within memory that is ours alone, and the advice changes nothing of its contents.
        unsafe { libc::madvise(first as *mut libc::c_void, last - first, libc::MADV_HUGEPAGE) };
    }
}

#[cfg(not(target_os = "linux"))]
fn advise<T>(_: &mut [T]) {}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_moved_stays_the_same() {
        let items: Vec<u32> = (0..3_000_000).collect();
        assert_eq!(settled(items.clone()), items);
        assert!(roomy::<u64>(LARGE).capacity() >= LARGE);
    }
}
