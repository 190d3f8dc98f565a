//! Rays side by side, made ready for a tree, and their questions to primitives that are known by number.

use snell_math::lanes::{Bits, Eight, Floats, Lanes, WIDTH};

use super::group::{Finder, Seeker, column_of};
use super::hulls::BallLines;
use super::probe::{BoxRay, Measure, widened_measure};
use super::probes::{BoxLines, Probes};
use super::shared::{NONE, number};
use super::traverse::take_lane;
use super::{WideBvh, WideTree};

/// Up to eight rays, made ready for one tree: how far each goes, and what box tests need, in rows.
pub struct Group {
    /// How far each goes, measured as [`Measure::limit`] does.
    pub limits: [f32; WIDTH],
    start: [f64; WIDTH],
    scale: [f64; WIDTH],
    pub(super) lines: BoxLines,
}

impl Group {
    /// Of probes, each up to a parameter of its own.
    #[inline(always)]
    pub fn new<L: Lanes>(probes: &Probes<L>, t_max: L) -> Self {
        let lines = BoxLines::new(probes);
        let mut group = Self { limits: [0.0; WIDTH], start: [0.0; WIDTH], scale: [0.0; WIDTH], lines };
        widened_measure((t_max - probes.start) * probes.scale).store(&mut group.limits, 0);
        probes.start.store(&mut group.start, 0);
        probes.scale.store(&mut group.scale, 0);
        group
    }

    /// How one ray is measured.
    #[inline(always)]
    pub fn measure(&self, lane: usize) -> Measure {
        let lane = lane & (WIDTH - 1);
        Measure { start: self.start[lane], scale: self.scale[lane] }
    }

    /// One ray, ready for boxes.
    #[inline(always)]
    pub fn ray<F: Eight>(&self, lane: usize) -> BoxRay<F> {
        self.lines.spread(lane)
    }

    /// Lowers the limit of a ray to a parameter.
    #[inline(always)]
    pub fn limit(&self, lane: usize, t_max: f64) -> f32 {
        self.measure(lane).limit(t_max)
    }
}

impl Group {
    /// The limits of rays that go up to other parameters.
    #[inline(always)]
    pub fn limits_at<L: Lanes>(&self, t_max: L) -> [f32; WIDTH] {
        let mut limits = [0.0; WIDTH];
        widened_measure((t_max - L::load(&self.start, 0)) * L::load(&self.scale, 0)).store(&mut limits, 0);
        limits
    }

    /// Gives the leaves of the tree that some rays, plain ones, enter before their limits to the seeker.
    #[inline(always)]
    pub fn nearest_in<F: Eight>(
        &self,
        tree: &WideTree,
        rays: Bits,
        limits: &mut [f32; WIDTH],
        seeker: &mut impl Seeker,
    ) {
        tree.nearest_together::<F>(&self.lines, rays, limits, seeker);
    }

    /// Gives the leaves of the tree that some rays, plain ones, enter before their limits to the finder, until it has enough.
    #[inline(always)]
    pub fn each_in<F: Eight>(&self, tree: &WideTree, rays: Bits, finder: &mut impl Finder) {
        tree.each_together::<F>(&self.lines, rays, &self.limits, finder);
    }
}

/// What seeks the closest hits among primitives.
pub trait PrimitiveSeeker {
    /// Tests a primitive with some rays, and lowers their limits by what is found. Mark it `#[inline(always)]`.
    fn primitive(&mut self, primitive: u32, rays: Bits, limits: &mut [f32; WIDTH]);
}

/// What asks primitives until it knows enough.
pub trait PrimitiveFinder {
    /// Tests a primitive with some rays; those that need not go on. Mark it `#[inline(always)]`.
    fn primitive(&mut self, primitive: u32, rays: Bits) -> Bits;
}

/// What is known at a leaf.
struct Leaves<'a> {
    bvh: &'a WideBvh,
    balls: BallLines,
}

impl<'a> Leaves<'a> {
    #[inline(always)]
    fn new<L: Lanes>(bvh: &'a WideBvh, probes: &Probes<L>) -> Self {
        Self { bvh, balls: BallLines::new(probes) }
    }

    #[inline(always)]
    fn prefetch<L: Lanes>(&self, leaf: u32) {
        L::Eight::prefetch(&self.bvh.leaves[leaf as usize]);
        if let Some(hulls) = self.bvh.hulls.of(leaf) {
            hulls.prefetch::<L::Eight>();
        }
    }

    /// For each ray a byte: the primitives of a leaf that it may meet before the limit; and all of them.
    #[inline(always)]
    fn candidates<L: Lanes>(&self, leaf: u32, rays: Bits, limits: &[f32; WIDTH]) -> (u64, u32) {
        let Some(hulls) = self.bvh.hulls.of(leaf) else { return (u64::MAX, 0xFF) };
        let (mut by_ray, mut any) = (0, 0);
        let mut rest = rays.mask();
        while rest != 0 {
            let lane = take_lane(&mut rest);
            let ray = self.balls.spread::<L::Eight>(lane);
            let met = ray.look(hulls, L::Eight::splat(limits[lane]));
            by_ray |= u64::from(met) << (8 * lane);
            any |= met;
        }
        (by_ray, any)
    }
}

struct SeekAtLeaves<'a, 's, L, S> {
    leaves: Leaves<'a>,
    seeker: &'s mut S,
    lanes: std::marker::PhantomData<L>,
}

impl<L: Lanes, S: PrimitiveSeeker> Seeker for SeekAtLeaves<'_, '_, L, S> {
    #[inline(always)]
    fn prefetch(&self, leaf: u32) {
        self.leaves.prefetch::<L>(leaf);
    }

    #[inline(always)]
    fn leaf(&mut self, leaf: u32, rays: Bits, limits: &mut [f32; WIDTH]) {
        let (by_ray, mut any) = self.leaves.candidates::<L>(leaf, rays, limits);
        let entries = &self.leaves.bvh.leaves[leaf as usize];
        while any != 0 {
            let place = take_lane(&mut any);
            if entries[place] == NONE {
                return;
            }
            self.seeker.primitive(number(entries[place]), column_of(by_ray, place) & rays, limits);
        }
    }
}

struct FindAtLeaves<'a, 's, L, S> {
    leaves: Leaves<'a>,
    limits: [f32; WIDTH],
    finder: &'s mut S,
    lanes: std::marker::PhantomData<L>,
}

impl<L: Lanes, S: PrimitiveFinder> Finder for FindAtLeaves<'_, '_, L, S> {
    #[inline(always)]
    fn prefetch(&self, leaf: u32) {
        self.leaves.prefetch::<L>(leaf);
    }

    #[inline(always)]
    fn leaf(&mut self, leaf: u32, rays: Bits) -> Bits {
        let (by_ray, mut any) = self.leaves.candidates::<L>(leaf, rays, &self.limits);
        let entries = &self.leaves.bvh.leaves[leaf as usize];
        let mut done = Bits::NONE;
        while any != 0 {
            let place = take_lane(&mut any);
            if entries[place] == NONE {
                break;
            }
            let asking = column_of(by_ray, place) & rays.without(done);
            if asking.any() {
                done |= self.finder.primitive(number(entries[place]), asking);
            }
        }
        done
    }
}

impl WideBvh {
    /// The tree, to make rays ready for.
    pub(crate) fn tree(&self) -> &WideTree {
        &self.tree
    }

    /// Gives the primitives that the plain rays of a group may meet before their limits to the seeker, with these rays; the nearer
    /// ones first, as far as boxes tell.
    #[inline(always)]
    pub(crate) fn nearest_together<L: Lanes>(
        &self,
        probes: &Probes<L>,
        group: &Group,
        seeker: &mut impl PrimitiveSeeker,
    ) {
        let leaves = Leaves::new(self, probes);
        let mut seeker = SeekAtLeaves::<L, _> { leaves, seeker, lanes: std::marker::PhantomData };
        let mut limits = group.limits;
        group.nearest_in::<L::Eight>(&self.tree, probes.plain, &mut limits, &mut seeker);
    }

    /// Gives the primitives that the plain rays of a group may meet before their limits to the finder, with these rays, in no
    /// particular order.
    #[inline(always)]
    pub(crate) fn each_together<L: Lanes>(&self, probes: &Probes<L>, group: &Group, finder: &mut impl PrimitiveFinder) {
        let (leaves, limits) = (Leaves::new(self, probes), group.limits);
        let mut finder = FindAtLeaves::<L, _> { leaves, limits, finder, lanes: std::marker::PhantomData };
        group.each_in::<L::Eight>(&self.tree, probes.plain, &mut finder);
    }
}
