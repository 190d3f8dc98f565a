//! Up to eight rays through a tree together.
//!
//! A node is fetched once for all rays that enter it, and its box tests do not wait for each other, as those of one ray do. What
//! stands on the stack is a child with the set of rays that enter it (masked traversal: Tsakok, "Faster Incoherent Rays:
//! Multi-BVH Ray Stream Tracing", HPG 2009, for a few rays). Every ray is tested with every box by itself, so its leaves are those
//! that it finds alone, and where only one ray is left it goes on as if alone; only the order of leaves differs, by which no
//! answer may change. Rays that go different ways gain too: they share the upper part of the tree, and part below it.

use snell_math::lanes::{Bits, Eight, WIDTH};

use super::probe::entry_of;
use super::probes::BoxLines;
use super::stack::Stack;
use super::traverse::{PLACES, go_on, take_lane};
use super::{LEAF, WideNode, WideTree};

/// What looks at leaves for the closest hits.
pub trait Seeker {
    /// Looks at a leaf for some rays, and lowers their limits by what is found. Mark it `#[inline(always)]`.
    fn leaf(&mut self, leaf: u32, rays: Bits, limits: &mut [f32; WIDTH]);
    /// Asks for the memory of a leaf that will be looked at soon. Mark it `#[inline(always)]`.
    fn prefetch(&self, leaf: u32);
}

/// What looks at leaves until it knows enough.
pub trait Finder {
    /// Looks at a leaf for some rays; those that need not go on. Mark it `#[inline(always)]`.
    fn leaf(&mut self, leaf: u32, rays: Bits) -> Bits;
    /// As [`Seeker::prefetch`].
    fn prefetch(&self, leaf: u32);
}

/// What rays together find at a node.
struct Entered<F> {
    /// For each ray a byte: the children that it enters.
    by_ray: u64,
    /// The children that any of them enters.
    any: u32,
    /// Where the first of them enters each child.
    first: F,
}

impl<F: Eight> Entered<F> {
    #[inline(always)]
    fn new(node: &WideNode, lines: &BoxLines, rays: Bits, limits: &[f32; WIDTH]) -> Self {
        let beyond = F::splat(f32::INFINITY);
        let mut entered = Self { by_ray: 0, any: 0, first: beyond };
        let mut rest = rays.mask();
        while rest != 0 {
            let lane = take_lane(&mut rest);
            let (children, enter) = lines.spread::<F>(lane).enter(node, F::splat(limits[lane]));
            entered.by_ray |= u64::from(children) << (8 * lane);
            entered.any |= children;
            entered.first = enter.or_where_not(Bits(children as u8), beyond).lesser(entered.first);
        }
        entered
    }
}

/// The rays that have a child's bit in their byte: the bits are gathered by one product, in which no two of them meet.
#[inline(always)]
pub fn column_of(by_ray: u64, child: usize) -> Bits {
    let bits = by_ray >> child & 0x0101_0101_0101_0101;
    Bits((bits.wrapping_mul(0x0102_0408_1020_4080) >> 56) as u8)
}

/// A child behind the rays that enter it, behind where the first one does, rounded down by that.
#[inline(always)]
fn key_together(enter: f32, rays: Bits, child: u32) -> u64 {
    u64::from(enter.to_bits() & !0xFF | rays.mask()) << 32 | u64::from(child)
}

/// The entry of a [`key_together`], a little too near, and its rays.
#[inline(always)]
fn entry_together(key: u64) -> (f32, Bits) {
    let high = (key >> 32) as u32;
    (f32::from_bits(high & !0xFF), Bits(high as u8))
}

impl WideTree {
    /// Gives the leaves that rays enter before their limits to the seeker, with these rays; for each ray the nearer ones first, as
    /// far as boxes tell and the others agree. The limits of lanes without a ray are negative.
    #[inline(always)]
    pub(super) fn nearest_together<F: Eight>(
        &self,
        lines: &BoxLines,
        mut rays: Bits,
        limits: &mut [f32; WIDTH],
        seeker: &mut impl Seeker,
    ) {
        if rays.is_empty() {
            return;
        }
        let (mut stack, mut height) = (Stack::<_, PLACES>::new(), 0);
        let mut current = 0_u32;
        loop {
            if current & LEAF != 0 {
                seeker.leaf(current & !LEAF, rays, limits);
            } else if rays.count() == 1 {
                self.nearest_from::<F>(current, lines, rays, limits, &mut stack, &mut height, seeker);
            } else {
                let node = &self.nodes[current as usize];
                let mut entered = Entered::<F>::new(node, lines, rays, limits);
                if entered.any != 0 {
                    self.prefetch_children::<F>(node, entered.any, |leaf| seeker.prefetch(leaf));
                    (current, rays) = go_on_together(node, &mut entered, &mut stack, &mut height);
                    continue;
                }
            }
            loop {
                let Some(next) = stack.pop(&mut height) else { return };
                let (entry, entering) = entry_together(next);
                rays = entering & F::splat(entry).le(F::load(limits, 0));
                if rays.any() {
                    current = next as u32;
                    break;
                }
            }
        }
    }

    /// Asks for the memory of children that are entered, where there are several: while one is looked at, that of the others comes.
    #[inline(always)]
    fn prefetch_children<F: Eight>(&self, node: &WideNode, mut entered: u32, leaf: impl Fn(u32)) {
        if entered & (entered - 1) == 0 {
            return;
        }
        while entered != 0 {
            let child = node.children[take_lane(&mut entered)];
            if child & LEAF != 0 {
                leaf(child & !LEAF);
            } else {
                F::prefetch(&self.nodes[child as usize]);
            }
        }
    }

    /// As [`WideTree::nearest`], for one of several rays, from a node on; the stack is left as it was.
    #[expect(clippy::too_many_arguments, reason = "a private step of the function above")]
    #[inline(always)]
    fn nearest_from<F: Eight>(
        &self,
        from: u32,
        lines: &BoxLines,
        rays: Bits,
        limits: &mut [f32; WIDTH],
        stack: &mut Stack<u64, PLACES>,
        height: &mut usize,
        seeker: &mut impl Seeker,
    ) {
        let lane = rays.lowest() & (WIDTH - 1);
        let ray = lines.spread::<F>(lane);
        let (base, mut current) = (*height, from);
        loop {
            if current & LEAF == 0 {
                let node = &self.nodes[current as usize];
                let (mut entered, enter) = ray.enter(node, F::splat(limits[lane]));
                if entered != 0 {
                    self.prefetch_children::<F>(node, entered, |leaf| seeker.prefetch(leaf));
                    current = go_on(node, &mut entered, enter, stack, height);
                    continue;
                }
            } else {
                seeker.leaf(current & !LEAF, rays, limits);
            }
            loop {
                if *height == base {
                    return;
                }
                let Some(next) = stack.pop(height) else { return };
                if entry_of(next) <= limits[lane] {
                    current = next as u32;
                    break;
                }
            }
        }
    }

    /// Gives the leaves that rays enter before their limits to the finder, with these rays, the large ones first.
    #[inline(always)]
    pub(super) fn each_together<F: Eight>(
        &self,
        lines: &BoxLines,
        mut rays: Bits,
        limits: &[f32; WIDTH],
        finder: &mut impl Finder,
    ) {
        let (mut stack, mut height) = (Stack::<u64, PLACES>::new(), 0);
        let (mut current, mut open) = (0_u32, rays);
        while rays.any() {
            let mut next = None;
            if current & LEAF != 0 {
                open = open.without(finder.leaf(current & !LEAF, rays));
            } else {
                let node = &self.nodes[current as usize];
                let mut entered = Entered::<F>::new(node, lines, rays, limits);
                if entered.any != 0 {
                    self.prefetch_children::<F>(node, entered.any, |leaf| finder.prefetch(leaf));
                    // The first is gone to, so it is not put on the stack; the second is the first to be taken off it.
                    let first = take_lane(&mut entered.any);
                    next = Some((node.children[first], column_of(entered.by_ray, first)));
                    while entered.any != 0 {
                        let lane = (u32::BITS - 1 - entered.any.leading_zeros()) as usize & (WIDTH - 1);
                        entered.any &= !(1 << lane);
                        let rays = column_of(entered.by_ray, lane);
                        stack.push(&mut height, key_together(0.0, rays, node.children[lane]));
                    }
                }
            }
            while next.is_none() {
                let Some(key) = stack.pop(&mut height) else { return };
                let rays = entry_together(key).1 & open;
                next = rays.any().then_some((key as u32, rays));
            }
            (current, rays) = next.unwrap_or((0, Bits::NONE));
        }
    }
}

/// Of the children that are entered, one at least, the one that is entered first, with its rays; the others wait, the nearest on
/// top.
#[inline(always)]
fn go_on_together<F: Eight>(
    node: &WideNode,
    entered: &mut Entered<F>,
    stack: &mut Stack<u64, PLACES>,
    height: &mut usize,
) -> (u32, Bits) {
    let Entered { by_ray, any, first } = entered;
    let lane = take_lane(any);
    if *any == 0 {
        return (node.children[lane], column_of(*by_ray, lane));
    }
    let first = first.to_array();
    let key = |lane: usize| key_together(first[lane], column_of(*by_ray, lane), node.children[lane]);
    let (a, b) = (key(lane), key(take_lane(any)));
    let (mut nearest, other) = if a < b { (a, b) } else { (b, a) };
    let base = *height;
    stack.push(height, other);
    while *any != 0 {
        let mut next = key(take_lane(any));
        if next < nearest {
            std::mem::swap(&mut next, &mut nearest);
        }
        stack.insert(height, next, base);
    }
    (nearest as u32, entry_together(nearest).1)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn columns_are_those_of_the_matrix() {
        let mut random = crate::accel::random::Random(3);
        for _ in 0..1000 {
            let matrix = (random.number() * 1.8e19) as u64;
            for child in 0..WIDTH {
                let expected = (0..WIDTH).fold(0, |bits, ray| bits | ((matrix >> (8 * ray + child) & 1) as u8) << ray);
                assert_eq!(column_of(matrix, child), Bits(expected), "{matrix:x} {child}");
            }
        }
    }

    #[test]
    fn keys_keep_children_and_rays_and_never_a_later_entry() {
        for enter in [0.0, 1e-30, 1.0, 1.000_000_1, 3e38, f32::INFINITY] {
            let key = key_together(enter, Bits(0xA5), LEAF | 7);
            let (entry, rays) = entry_together(key);
            assert!(entry <= enter && entry >= enter * (1.0 - 1.0 / 32768.0), "{entry} {enter}");
            assert_eq!((rays, key as u32), (Bits(0xA5), LEAF | 7));
        }
    }
}
