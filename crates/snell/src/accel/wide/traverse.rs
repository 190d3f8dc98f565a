//! The ways through the tree: the nearest leaves first, or all in the order in which they stand.
//!
//! Both are given a closure that looks at a leaf. A child that was put on the stack is looked at again only if it still
//! begins before the limit, which falls as hits are found; one that begins at the limit does, for the sake of ties.

use std::ops::ControlFlow;

use snell_math::lanes::{Eight, WIDTH};

use super::probe::{BoxRay, entry_of, key};
use super::slabs::Slabs;
use super::stack::Stack;
use super::{LEAF, STACK, WideNode, WideTree};

/// The places of a stack of children.
pub(super) const PLACES: usize = STACK.next_power_of_two();

/// The lowest lane of a mask that is not empty, which is left without it.
#[inline(always)]
pub fn take_lane(mask: &mut u32) -> usize {
    let lane = mask.trailing_zeros() as usize;
    *mask &= *mask - 1;
    // Masked only to show that the lane is in range.
    lane & (WIDTH - 1)
}

/// Of the children that are entered, one at least, the one that is entered first; the others wait, the nearest on top.
#[inline(always)]
pub(super) fn go_on<F: Eight>(
    node: &WideNode,
    entered: &mut u32,
    enter: F,
    stack: &mut Stack<u64, PLACES>,
    height: &mut usize,
) -> u32 {
    let first = take_lane(entered);
    if *entered == 0 {
        return node.children[first];
    }
    let enter = enter.to_array();
    let key = |lane: usize| key(enter[lane], node.children[lane]);
    let (a, b) = (key(first), key(take_lane(entered)));
    let (mut nearest, other) = if a < b { (a, b) } else { (b, a) };
    let base = *height;
    stack.push(height, other);
    while *entered != 0 {
        let mut next = key(take_lane(entered));
        if next < nearest {
            std::mem::swap(&mut next, &mut nearest);
        }
        stack.insert(height, next, base);
    }
    nearest as u32
}

impl WideTree {
    /// Gives the leaves that a ray enters before the limit to `visit`, the nearer ones first as far as boxes tell. It is
    /// given the limit too, and may lower it. Returns the last limit.
    #[inline(always)]
    pub fn nearest<F: Eight>(&self, ray: &BoxRay<F>, mut limit: f32, mut visit: impl FnMut(u32, &mut f32)) -> f32 {
        let (mut stack, mut height) = (Stack::<_, PLACES>::new(), 0);
        let mut current = 0_u32;
        loop {
            if current & LEAF == 0 {
                let node = &self.nodes[current as usize];
                let (mut entered, enter) = ray.enter(node, F::splat(limit));
                if entered != 0 {
                    current = go_on(node, &mut entered, enter, &mut stack, &mut height);
                    continue;
                }
            } else {
                visit(current & !LEAF, &mut limit);
            }
            loop {
                let Some(next) = stack.pop(&mut height) else { return limit };
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
        let enters = |node: &WideNode| {
            let enters = |lane: usize| node.has(lane) && slabs.enter(&node.bounds(lane), t_min, t_max).is_some();
            (0..WIDTH).fold(0, |mask, lane| mask | u32::from(enters(lane)) << lane)
        };
        self.each_where(enters, visit)
    }

    /// Gives the leaves to `visit` that `enters` lets through, until it breaks.
    #[inline(always)]
    pub(super) fn each_where(
        &self,
        enters: impl Fn(&WideNode) -> u32,
        mut visit: impl FnMut(u32) -> ControlFlow<()>,
    ) -> ControlFlow<()> {
        if self.nodes.is_empty() {
            return ControlFlow::Continue(());
        }
        let (mut stack, mut height) = (Stack::<_, PLACES>::new(), 0);
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
                        stack.push(&mut height, node.children[lane]);
                    }
                    continue;
                }
            } else {
                visit(current & !LEAF)?;
            }
            match stack.pop(&mut height) {
                Some(next) => current = next,
                None => return ControlFlow::Continue(()),
            }
        }
    }
}
