//! The ways through the tree: the nearest leaves first, or all in the order in which they stand.
//!
//! Both are given a closure that looks at a leaf. A child that was put on the stack is looked at again only if it still
//! begins before the limit, which falls as hits are found; one that begins at the limit does, for the sake of ties.

use std::mem::MaybeUninit;
use std::ops::ControlFlow;

use super::probe::{BoxRay, entry_of, key};
use super::simd::{Eight, WIDTH};
use super::slabs::Slabs;
use super::{LEAF, STACK, WideTree};

/// A stack of fixed size whose memory is not cleared: that would cost more than a short way through the tree.
struct Stack<T> {
    items: [MaybeUninit<T>; STACK],
    height: usize,
}

impl<T: Copy> Stack<T> {
    #[inline(always)]
    fn new() -> Self {
        Self { items: [const { MaybeUninit::uninit() }; STACK], height: 0 }
    }

    #[inline(always)]
    fn push(&mut self, item: T) {
        self.items[self.height].write(item);
        self.height += 1;
    }

    #[inline(always)]
    fn pop(&mut self) -> Option<T> {
        self.height = self.height.checked_sub(1)?;
        // SAFETY: everything below the height was written by `push`.
        Some(unsafe { self.items[self.height].assume_init() })
    }
}

impl Stack<u64> {
    /// Puts a key where it belongs among those from `base` on, the smallest on top.
    #[inline(always)]
    fn insert(&mut self, key: u64, base: usize) {
        self.push(key);
        let mut place = self.height - 1;
        while place > base {
            // SAFETY: everything below the height was written by `push`.
            let below = unsafe { self.items[place - 1].assume_init() };
            if below >= key {
                break;
            }
            self.items[place].write(below);
            place -= 1;
        }
        self.items[place].write(key);
    }
}

/// The lowest lane of a mask that is not empty, which is left without it.
#[inline(always)]
pub fn take_lane(mask: &mut u32) -> usize {
    let lane = mask.trailing_zeros() as usize;
    *mask &= *mask - 1;
    // Masked only to show that the lane is in range.
    lane & (WIDTH - 1)
}

impl WideTree {
    /// Gives the leaves that a ray enters before the limit to `visit`, the nearer ones first as far as boxes tell. It is
    /// given the limit too, and may lower it. Returns the last limit.
    #[inline(always)]
    pub fn nearest<F: Eight>(&self, ray: &BoxRay<F>, mut limit: f32, mut visit: impl FnMut(u32, &mut f32)) -> f32 {
        let mut stack = Stack::new();
        let mut current = 0_u32;
        loop {
            if current & LEAF == 0 {
                let node = &self.nodes[current as usize];
                let (mut entered, enter) = ray.enter(node, F::splat(limit));
                if entered != 0 {
                    let first = take_lane(&mut entered);
                    if entered == 0 {
                        current = node.children[first];
                        continue;
                    }
                    let enter = enter.to_array();
                    let key = |lane: usize| key(enter[lane], node.children[lane]);
                    let (a, b) = (key(first), key(take_lane(&mut entered)));
                    let (mut nearest, other) = if a < b { (a, b) } else { (b, a) };
                    let base = stack.height;
                    stack.push(other);
                    while entered != 0 {
                        let mut next = key(take_lane(&mut entered));
                        if next < nearest {
                            std::mem::swap(&mut next, &mut nearest);
                        }
                        stack.insert(next, base);
                    }
                    current = nearest as u32;
                    continue;
                }
            } else {
                visit(current & !LEAF, &mut limit);
            }
            loop {
                let Some(next) = stack.pop() else { return limit };
                if entry_of(next) <= limit {
                    current = next as u32;
                    break;
                }
            }
        }
    }

    /// Gives the leaves that a ray enters before the limit to `visit`, the large ones first, until it breaks.
    #[inline(always)]
    pub fn each<F: Eight>(
        &self,
        ray: &BoxRay<F>,
        limit: f32,
        visit: impl FnMut(u32) -> ControlFlow<()>,
    ) -> ControlFlow<()> {
        let limit = F::splat(limit);
        self.each_where(|node| ray.enter(node, limit).0, visit)
    }

    /// As [`WideTree::each`], in `f64` and up to a limit that may fall.
    #[inline(never)]
    pub fn each_strange(
        &self,
        slabs: &Slabs,
        t_min: f64,
        t_max: f64,
        visit: &mut dyn FnMut(u32) -> ControlFlow<()>,
    ) -> ControlFlow<()> {
        let enters = |node: &super::WideNode| {
            let enters = |lane: usize| node.has(lane) && slabs.enter(&node.bounds(lane), t_min, t_max).is_some();
            (0..WIDTH).fold(0, |mask, lane| mask | u32::from(enters(lane)) << lane)
        };
        self.each_where(enters, visit)
    }

    /// Gives the leaves to `visit` that `enters` lets through, until it breaks.
    #[inline(always)]
    pub(super) fn each_where(
        &self,
        enters: impl Fn(&super::WideNode) -> u32,
        mut visit: impl FnMut(u32) -> ControlFlow<()>,
    ) -> ControlFlow<()> {
        if self.nodes.is_empty() {
            return ControlFlow::Continue(());
        }
        let mut stack = Stack::new();
        let mut current = 0_u32;
        loop {
            if current & LEAF == 0 {
                let node = &self.nodes[current as usize];
                let mut entered = enters(node);
                if entered != 0 {
                    // The first lane is gone to, so it is not put on the stack; the second is the first to be taken off it.
                    current = node.children[take_lane(&mut entered)];
                    while entered != 0 {
                        let lane = (u32::BITS - 1 - entered.leading_zeros()) as usize & (WIDTH - 1);
                        entered &= !(1 << lane);
                        stack.push(node.children[lane]);
                    }
                    continue;
                }
            } else {
                visit(current & !LEAF)?;
            }
            match stack.pop() {
                Some(next) => current = next,
                None => return ControlFlow::Continue(()),
            }
        }
    }
}
