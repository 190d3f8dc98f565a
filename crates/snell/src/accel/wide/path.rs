//! The way of one of many rays in flight: a step at a time, and from one step to the next its memory is asked for.
//!
//! In a tree that is larger than the caches a ray spends most of its time waiting for nodes. While one waits, others go on:
//! Kocberber, Falsafi and Grot, "Asynchronous Memory Access Chaining", VLDB 9(4), 2015, do so for lookups in databases.

use snell_math::lanes::Eight;

use super::probe::{BoxRay, entry_of};
use super::stack::Stack;
use super::traverse::{PLACES, go_on};
use super::{LEAF, WideTree};

/// Where a ray is in the tree, and what it left for later.
pub struct Path {
    /// A node or a leaf.
    current: u32,
    height: usize,
    stack: Stack<u64, PLACES>,
}

impl Path {
    /// At the root.
    #[inline(always)]
    pub const fn new() -> Self {
        Self { current: 0, height: 0, stack: Stack::new() }
    }

    /// At the root again.
    #[inline(always)]
    pub fn restart(&mut self) {
        (self.current, self.height) = (0, 0);
    }

    /// The leaf where it is, if it is at one.
    #[inline(always)]
    pub fn leaf(&self) -> Option<u32> {
        (self.current & LEAF != 0).then_some(self.current & !LEAF)
    }

    /// From a node to the nearest of its children that the ray enters before the limit, or where none is, on; false where that is
    /// the end.
    #[inline(always)]
    pub fn descend<F: Eight>(&mut self, tree: &WideTree, ray: &BoxRay<F>, limit: f32) -> bool {
        let node = &tree.nodes[self.current as usize];
        let (mut entered, enter) = ray.enter(node, F::splat(limit));
        if entered == 0 {
            return self.leave(limit);
        }
        self.current = go_on(node, &mut entered, enter, &mut self.stack, &mut self.height);
        true
    }

    /// On to the next that was left for later and begins before the limit; false where there is none.
    #[inline(always)]
    pub fn leave(&mut self, limit: f32) -> bool {
        while let Some(next) = self.stack.pop(&mut self.height) {
            if entry_of(next) <= limit {
                self.current = next as u32;
                return true;
            }
        }
        false
    }

    /// Asks for the memory of the node where it is; of a leaf by `leaf`.
    #[inline(always)]
    pub fn prefetch<F: Eight>(&self, tree: &WideTree, leaf: impl FnOnce(u32)) {
        match self.leaf() {
            Some(place) => leaf(place),
            None => F::prefetch(&tree.nodes[self.current as usize]),
        }
    }
}
