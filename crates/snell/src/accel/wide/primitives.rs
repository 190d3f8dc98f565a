//! A wide tree over primitives that are known by number: a closure tests them.

use std::ops::ControlFlow;

use snell_math::lanes::{Eight, InstructionSet, Lanes, WIDTH, Work, dispatch};
use snell_math::{Bounds3, Point3, Ray};

use super::hulls::{BallRay, Hull, Hulls};
use super::shared::{NONE, Visited, number};
use super::{Approach, BoxRay, Probe, WideTree, take_lane};
use crate::accel::bvh::{BuildError, BuildOptions, BuildQuality, Bvh};

/// What a primitive's test finds: something with a ray parameter. `f64` is the ray parameter alone, `(f64, T)` has
/// anything the caller wants to keep of the closest hit with it.
pub trait Candidate {
    /// The ray parameter.
    fn t(&self) -> f64;
}

impl Candidate for f64 {
    #[inline]
    fn t(&self) -> f64 {
        *self
    }
}

impl<T> Candidate for (f64, T) {
    #[inline]
    fn t(&self) -> f64 {
        self.0
    }
}

/// A hierarchy over boxes. Primitives are known by their place in the slice of boxes it was built from.
///
/// ```
/// use snell::accel::WideBvh;
/// use snell_math::{Bounds3, Point3, Ray, Vector3};
///
/// // Three unit boxes in a row; a ray along the row, and a test that takes the box's left side for the primitive.
/// let row: Vec<Bounds3> =
///     (0..3).map(|i| Bounds3::new(Point3::new(i as f64, 0.0, 0.0), Point3::new(i as f64 + 1.0, 1.0, 1.0))).collect();
/// let bvh = WideBvh::build(&row)?;
/// let ray = Ray::new(Point3::new(-2.0, 0.5, 0.5), Vector3::X);
/// let hit = bvh.closest(&ray, f64::INFINITY, |primitive, _t_max| Some(row[primitive as usize].min.x() + 2.0));
/// assert_eq!(hit, Some((0, 2.0)));
/// # Ok::<(), snell::accel::BuildError>(())
/// ```
#[derive(Clone, Debug)]
pub struct WideBvh {
    pub(super) tree: WideTree,
    /// Numbers of primitives, see [`WideTree::new`].
    pub(super) leaves: Vec<[u32; WIDTH]>,
    /// What primitives lie in.
    pub(super) hulls: Hulls,
    /// By what boxes are tested.
    set: InstructionSet,
}

impl WideBvh {
    /// Builds a hierarchy. An empty box is left out: no query reports its primitive.
    ///
    /// # Errors
    /// Where a box has a NaN or infinite corner (the first such box is named), or there are more than 2³¹ boxes.
    pub fn build(bounds: &[Bounds3]) -> Result<Self, BuildError> {
        Self::with_quality(bounds, BuildQuality::Medium)
    }

    /// As [`WideBvh::build`], with more or less work for it; nothing but speed depends on that.
    ///
    /// # Errors
    /// As [`WideBvh::build`].
    pub fn with_quality(bounds: &[Bounds3], quality: BuildQuality) -> Result<Self, BuildError> {
        let options = BuildOptions { quality, ..BuildOptions::default() };
        Ok(Self::from_binary(&Bvh::over_boxes(bounds, options)?))
    }

    /// The same primitives, eight children a node.
    pub fn from_binary(bvh: &Bvh) -> Self {
        let (tree, leaves) = WideTree::new(bvh);
        Self { tree, leaves, hulls: Hulls::default(), set: InstructionSet::best() }
    }

    /// The same hierarchy, with what its primitives lie in, one for each. Queries with rays then leave out most of those whose boxes
    /// are met and that are not; nothing else changes, where a primitive is met within its hull only, up to a few roundings of
    /// `f64`.
    ///
    /// # Panics
    /// Where there is a primitive without a hull.
    #[must_use]
    pub fn with_hulls(self, hulls: &[Hull]) -> Self {
        Self { hulls: Hulls::new(&self.leaves, hulls), ..self }
    }

    /// The same hierarchy, whose boxes are tested by other instructions; nothing else changes.
    #[must_use]
    pub fn with_instructions(self, set: InstructionSet) -> Self {
        Self { set, ..self }
    }

    /// The box around all primitives, rounded outward to `f32`; empty where there is none.
    pub fn bounds(&self) -> Bounds3 {
        self.tree.bounds()
    }

    /// True where it holds no primitive.
    pub fn is_empty(&self) -> bool {
        self.tree.is_empty()
    }

    /// The memory of nodes and leaves, in bytes.
    pub fn bytes(&self) -> usize {
        self.tree.bytes() + size_of_val(self.leaves.as_slice()) + self.hulls.bytes()
    }

    /// The closest primitive on a ray from its origin to `t_max`, both included, and what its test returned.
    ///
    /// `test` is given a primitive and the largest t that still matters, which falls as hits are found. It returns its
    /// hit of smallest t in [0, that t], or `None`; a hit beyond is taken for none. Of hits at the same t the one of
    /// the lowest primitive wins, whatever the order of the tests. A ray that is not finite meets nothing for certain.
    #[inline]
    pub fn closest<H: Candidate>(
        &self,
        ray: &Ray,
        t_max: f64,
        test: impl FnMut(u32, f64) -> Option<H>,
    ) -> Option<(u32, H)> {
        self.closest_between(ray, 0.0, t_max, test)
    }

    /// As [`WideBvh::closest`], from `t_min`, which may be negative or −∞, to `t_max`; closest means of smallest t.
    #[inline]
    pub fn closest_between<H: Candidate>(
        &self,
        ray: &Ray,
        t_min: f64,
        t_max: f64,
        test: impl FnMut(u32, f64) -> Option<H>,
    ) -> Option<(u32, H)> {
        let mut search = Search { best: None, t_max, test };
        match self.tree.approach(ray, t_min, t_max) {
            Approach::Missed => return None,
            Approach::Plain(probe) => {
                dispatch(self.set, Closest { bvh: self, probe: &probe, search: &mut search });
            }
            Approach::Strange(slabs) => {
                // It never breaks, so there is nothing to know from its end; so below.
                let _ = self.tree.each_strange(&slabs, t_min, t_max, &mut |leaf| {
                    search.leaf(&self.leaves[leaf as usize], ALL);
                    ControlFlow::Continue(())
                });
            }
        }
        search.best
    }

    /// True where `test` holds for some primitive on the ray from its origin to `t_max`; stops at the first. Every
    /// primitive that is met there may be tested, in no particular order, and some that are not met.
    #[inline]
    pub fn any(&self, ray: &Ray, t_max: f64, mut test: impl FnMut(u32) -> bool) -> bool {
        let stop_if = |found| if found { ControlFlow::Break(()) } else { ControlFlow::Continue(()) };
        self.visit_between(ray, 0.0, t_max, |primitive| stop_if(test(primitive))).is_break()
    }

    /// Visits every primitive that the ray may meet from its origin to `t_max`, once, in no particular order.
    #[inline]
    pub fn all(&self, ray: &Ray, t_max: f64, mut visit: impl FnMut(u32)) {
        let _ = self.visit_between(ray, 0.0, t_max, |primitive| {
            visit(primitive);
            ControlFlow::Continue(())
        });
    }

    /// Visits every primitive that the line of the ray may meet between `t_min`, which may be negative or −∞, and
    /// `t_max`, once, in no particular order, until `visit` breaks; returns whether it did.
    #[inline]
    pub fn visit_between(
        &self,
        ray: &Ray,
        t_min: f64,
        t_max: f64,
        visit: impl FnMut(u32) -> ControlFlow<()>,
    ) -> ControlFlow<()> {
        let mut once = Once { visited: Visited::default(), visit };
        match self.tree.approach(ray, t_min, t_max) {
            Approach::Missed => ControlFlow::Continue(()),
            Approach::Plain(probe) => {
                let limit = probe.measure.limit(t_max);
                dispatch(self.set, Each { bvh: self, probe: &probe, limit, once: &mut once })
            }
            Approach::Strange(slabs) => {
                self.tree.each_strange(&slabs, t_min, t_max, &mut |leaf| once.leaf(&self.leaves[leaf as usize], ALL))
            }
        }
    }

    /// Visits every primitive whose box, rounded outward to `f32` and together with its neighbours in the tree, has the
    /// point inside or on its border: all whose exact box has it, and perhaps more. Each once.
    #[inline]
    pub fn point(&self, p: Point3, mut visit: impl FnMut(u32)) {
        let visit = |primitive| {
            visit(primitive);
            ControlFlow::Continue(())
        };
        let mut once = Once { visited: Visited::default(), visit };
        let has = |node: &super::WideNode| {
            (0..WIDTH).fold(0, |mask, lane| mask | u32::from(node.bounds(lane).contains_point(p)) << lane)
        };
        let _ = self.tree.each_where(has, |leaf| once.leaf(&self.leaves[leaf as usize], ALL));
    }
}

/// All lanes of a leaf.
const ALL: u32 = (1 << WIDTH) - 1;

/// The lanes of a leaf that a ray may meet before the limit.
#[inline(always)]
fn candidates<F: Eight>(bvh: &WideBvh, ray: &BallRay<F>, leaf: u32, limit: f32) -> u32 {
    match bvh.hulls.of(leaf) {
        Some(hulls) => ray.look(hulls, F::splat(limit)),
        None => ALL,
    }
}

/// A query for the closest hit.
struct Search<H, T> {
    best: Option<(u32, H)>,
    t_max: f64,
    test: T,
}

impl<H: Candidate, T: FnMut(u32, f64) -> Option<H>> Search<H, T> {
    /// Tests some primitives of a leaf.
    #[inline(always)]
    fn leaf(&mut self, entries: &[u32; WIDTH], mut lanes: u32) {
        while lanes != 0 {
            let entry = entries[take_lane(&mut lanes)];
            if entry == NONE {
                return;
            }
            let primitive = number(entry);
            let Some(hit) = (self.test)(primitive, self.t_max) else { continue };
            let t = hit.t();
            let wins_tie = || t == self.t_max && self.best.as_ref().is_none_or(|(other, _)| primitive < *other);
            if t < self.t_max || wins_tie() {
                self.t_max = t;
                self.best = Some((primitive, hit));
            }
        }
    }
}

struct Closest<'a, H, T> {
    bvh: &'a WideBvh,
    probe: &'a Probe,
    search: &'a mut Search<H, T>,
}

impl<H: Candidate, T: FnMut(u32, f64) -> Option<H>> Work for Closest<'_, H, T> {
    type Output = ();
    #[inline(always)]
    fn run<L: Lanes>(self) {
        let Self { bvh, probe, search } = self;
        let (boxes, balls) = (BoxRay::<L::Eight>::new(probe), BallRay::<L::Eight>::new(probe));
        bvh.tree.nearest(&boxes, probe.measure.limit(search.t_max), |leaf, limit| {
            search.leaf(&bvh.leaves[leaf as usize], candidates(bvh, &balls, leaf, *limit));
            *limit = probe.measure.limit(search.t_max);
        });
    }
}

/// A query for all primitives, each once.
struct Once<V> {
    visited: Visited,
    visit: V,
}

impl<V: FnMut(u32) -> ControlFlow<()>> Once<V> {
    #[inline(always)]
    fn leaf(&mut self, entries: &[u32; WIDTH], mut lanes: u32) -> ControlFlow<()> {
        while lanes != 0 {
            let entry = entries[take_lane(&mut lanes)];
            if entry == NONE {
                break;
            }
            if self.visited.is_new(0, entry) {
                (self.visit)(number(entry))?;
            }
        }
        ControlFlow::Continue(())
    }
}

struct Each<'a, V> {
    bvh: &'a WideBvh,
    probe: &'a Probe,
    limit: f32,
    once: &'a mut Once<V>,
}

impl<V: FnMut(u32) -> ControlFlow<()>> Work for Each<'_, V> {
    type Output = ControlFlow<()>;
    #[inline(always)]
    fn run<L: Lanes>(self) -> ControlFlow<()> {
        let Self { bvh, probe, limit, once } = self;
        let (boxes, balls) = (BoxRay::<L::Eight>::new(probe), BallRay::<L::Eight>::new(probe));
        bvh.tree.each(&boxes, limit, |leaf| once.leaf(&bvh.leaves[leaf as usize], candidates(bvh, &balls, leaf, limit)))
    }
}
