//! Cutting a set of items in two by copying it: no branch depends on where an item goes, and threads can share the work.
//!
//! The halves' centres are looked over on the way, for the binning of the next level. The order of the copies depends on
//! that of the items alone.

use rayon::prelude::*;

use super::item::{Hull, Item};
use super::split::{CHUNK, Split};

/// Copies the items to `target`, those of the first part to its front; returns how many they are, and the boxes around
/// the half centres of both parts.
pub(super) fn partition(items: &[Item], target: &mut [Item], split: &Split) -> (usize, [Hull; 2]) {
    let mut centers = [Hull::EMPTY; 2];
    let (mut low, mut high) = (0, items.len());
    for item in items {
        let center = item.half_center();
        let is_first = split.is_first(center);
        high -= usize::from(!is_first);
        target[if is_first { low } else { high }] = *item;
        low += usize::from(is_first);
        centers[usize::from(!is_first)].grow_point(center);
    }
    (low, centers)
}

/// As [`partition`] by several threads; `counts` says how many items of each portion belong to the first part.
pub(super) fn partition_many(
    items: &[Item],
    target: &mut [Item],
    split: &Split,
    counts: &[usize],
) -> (usize, [Hull; 2]) {
    let first_count = counts.iter().sum();
    // Every portion gets a slice of its own in both parts.
    let (mut front, mut back) = target.split_at_mut(first_count);
    let mut jobs = Vec::with_capacity(counts.len());
    for (chunk, &count) in items.chunks(CHUNK).zip(counts) {
        let (mine_in_front, front_rest) = front.split_at_mut(count);
        let (mine_in_back, back_rest) = back.split_at_mut(chunk.len() - count);
        jobs.push((chunk, mine_in_front, mine_in_back));
        (front, back) = (front_rest, back_rest);
    }
    let copy = |(chunk, front, back): (&[Item], &mut [Item], &mut [Item])| {
        let mut centers = [Hull::EMPTY; 2];
        let (mut front, mut back) = (front.iter_mut(), back.iter_mut());
        for item in chunk {
            let center = item.half_center();
            let is_first = split.is_first(center);
            centers[usize::from(!is_first)].grow_point(center);
            if let Some(place) = if is_first { front.next() } else { back.next() } {
                *place = *item;
            }
        }
        centers
    };
    let centers =
        jobs.into_par_iter().map(copy).reduce(|| [Hull::EMPTY; 2], |a, b| [a[0].union(&b[0]), a[1].union(&b[1])]);
    (first_count, centers)
}
