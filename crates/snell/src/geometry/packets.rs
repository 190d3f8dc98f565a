//! Questions of rays side by side to what stands in hierarchies, to instances and to meshes: through the trees together.
//!
//! What a ray meets is what it meets alone: simple shapes are tested in all lanes by the code for one, triangles by the same tests, and
//! everything else by one ray after the other. Of hits at the same distance the lowest primitive's wins, in whatever order they
//! are found, so the way through the tree may be anybody's.

use std::cell::OnceCell;

use snell_math::Ray;
use snell_math::lanes::{Bits, Floats, Lanes, WIDTH, Work};

use super::lanes::{HitRows, key_of};
use super::space::{NONE, Primitive, Space};
use super::{Geometry, InnerHit, LocalHit, LocalPlace, Placement, QueryScratch, TOUCHING, Touching};
use crate::accel::wide::{Group, PrimitiveSeeker, widened_measure};
use crate::shape::triangle_mesh::Sight;
use crate::shape::{LaneRay, LaneSpheres, Passage, RayRow, Shape};

/// Rays side by side, in the space of what they are asked about.
pub(super) struct RayGroup {
    origin: [[f64; WIDTH]; 3],
    direction: [[f64; WIDTH]; 3],
    /// See [`Touching`], in world units also where the rays are not.
    along: [f64; WIDTH],
    /// Each by itself, where one is asked for: put together once, since what reads a ray as it has just been written, but in other
    /// widths, waits for it.
    rays: OnceCell<[Ray; WIDTH]>,
}

impl RayGroup {
    /// Of the world's rays.
    #[inline(always)]
    pub(super) fn new<L: Lanes>(ray: &LaneRay<L>) -> Self {
        let mut along = [0.0; WIDTH];
        (L::splat(TOUCHING) * ray.origin.max_abs()).store(&mut along, 0);
        Self::with_along(ray, along)
    }

    #[inline(always)]
    fn with_along<L: Lanes>(ray: &LaneRay<L>, along: [f64; WIDTH]) -> Self {
        let rows = [[0.0; WIDTH]; 3];
        let mut group = Self { origin: rows, direction: rows, along, rays: OnceCell::new() };
        ray.origin.store(&mut group.origin, 0);
        ray.direction.store(&mut group.direction, 0);
        group
    }

    /// The same, taken to a local space.
    #[inline(always)]
    pub(super) fn to_local<L: Lanes>(&self, placement: &Placement) -> Self {
        L::stage(ToLocal { group: self, placement })
    }

    /// The same, in the space of a primitive, in a place for it where that is another one.
    #[inline(always)]
    pub(super) fn in_space_of<'g, L: Lanes>(
        &'g self,
        space: &Space,
        primitive: &Primitive,
        carried: &'g mut Option<Self>,
    ) -> &'g Self {
        match space.placement(primitive) {
            None => self,
            Some(placement) => carried.insert(self.to_local::<L>(placement)),
        }
    }

    /// One of them.
    #[inline(always)]
    pub(super) fn ray(&self, lane: usize) -> &Ray {
        let rays = self.rays.get_or_init(|| std::array::from_fn(|lane| self.row().ray(lane)));
        &rays[lane & (WIDTH - 1)]
    }

    #[inline(always)]
    pub(super) fn row(&self) -> RayRow<'_> {
        RayRow { origin: &self.origin, direction: &self.direction }
    }

    #[inline(always)]
    pub(super) fn lanes<L: Lanes>(&self) -> LaneRay<L> {
        self.row().lanes(0)
    }
}

/// The question where rays are in a local space.
struct ToLocal<'a> {
    group: &'a RayGroup,
    placement: &'a Placement,
}

impl Work for ToLocal<'_> {
    type Output = RayGroup;
    #[inline(always)]
    fn run<L: Lanes>(self) -> RayGroup {
        RayGroup::with_along(&self.placement.lanes_to_local(self.group.lanes::<L>()), self.group.along)
    }
}

/// The nearest hits that are known.
pub(super) struct Found<'h> {
    /// What hits are compared by, see [`Touching`]; the limit where there is none.
    pub(super) key: [f64; WIDTH],
    pub(super) hits: &'h mut HitRows,
    /// The lanes whose hit is no simple one.
    pub(super) complex: Bits,
}

impl Found<'_> {
    /// Takes over a hit of one lane where it comes first.
    #[inline]
    fn take(&mut self, lane: usize, index: u32, hit: &InnerHit) {
        let key = self.key[lane];
        // No primitive is the last one of all.
        if hit.key < key || hit.key == key && index < self.hits.primitive[lane] {
            self.key[lane] = hit.key;
            self.hits.t[lane] = hit.local.t;
            self.hits.primitive[lane] = index;
            self.hits.inner[lane] = hit.inner;
            self.hits.place[lane] = hit.local.place;
            self.complex |= Bits::lane(lane);
        }
    }

    /// Takes over hits with a sphere where they come first; the lanes where they do.
    #[inline(always)]
    fn take_lanes<L: Lanes>(&mut self, index: u32, met: Bits, t: L, key: L) -> Bits {
        let before = L::load(&self.key, 0);
        let mut better = met & key.lt(before);
        let mut same = met & key.same(before);
        if same.any() {
            for lane in same.lanes() {
                if index >= self.hits.primitive[lane] {
                    same = same.without(Bits::lane(lane));
                }
            }
            better |= same;
        }
        if better.any() {
            key.or_where_not(better, before).store(&mut self.key, 0);
            t.or_where_not(better, L::load(&self.hits.t, 0)).store(&mut self.hits.t, 0);
            for lane in better.lanes() {
                self.hits.primitive[lane] = index;
                self.hits.inner[lane] = NONE;
                self.hits.place[lane] = LocalPlace::of_part(0);
            }
            self.complex = self.complex.without(better);
        }
        better
    }
}

/// The question for the nearest hits with one primitive of the world, or where there is no number, with those of its hierarchy.
pub(super) struct NearestInWorld<'a, 'h> {
    pub(super) geometry: &'a Geometry,
    pub(super) index: Option<u32>,
    pub(super) rays: RayRow<'a>,
    pub(super) active: Bits,
    pub(super) found: &'a mut Found<'h>,
    pub(super) scratch: &'a mut QueryScratch,
}

impl Work for NearestInWorld<'_, '_> {
    type Output = ();
    #[inline(always)]
    fn run<L: Lanes>(self) {
        let Self { geometry, index, rays, active, found, scratch } = self;
        let group = &RayGroup::new(&rays.lanes::<L>(0));
        let space = &geometry.world;
        match index {
            Some(index) => geometry.meet_together::<L>(space, index, group, None, active, found, scratch),
            None => NearestInSpace { geometry, space, group, active, found, scratch }.run::<L>(),
        }
    }
}

/// The question for the nearest hits with the primitives of a space's hierarchy.
pub(super) struct NearestInSpace<'a, 'h> {
    pub(super) geometry: &'a Geometry,
    pub(super) space: &'a Space,
    pub(super) group: &'a RayGroup,
    pub(super) active: Bits,
    pub(super) found: &'a mut Found<'h>,
    pub(super) scratch: &'a mut QueryScratch,
}

struct NearestSeeker<'a, 'r, 'h, L> {
    geometry: &'a Geometry,
    space: &'a Space,
    group: &'r RayGroup,
    ready: &'r Group,
    sight: Option<&'r Sight<'r>>,
    ray: LaneRay<L>,
    along: L,
    start: L,
    scale: L,
    found: &'r mut Found<'h>,
    scratch: &'r mut QueryScratch,
}

impl Work for NearestInSpace<'_, '_> {
    type Output = ();
    #[inline(always)]
    fn run<L: Lanes>(self) {
        let Self { geometry, space, group, active, found, scratch } = self;
        let ray = group.lanes::<L>();
        let end = L::load(&found.key, 0);
        let probes = space.bvh.tree().approach_together(ray.origin, ray.direction, active, end);
        let ready = &Group::new(&probes, end);
        let sight = if space.has_meshes { Some(Sight::new(group.row(), &probes, ready)) } else { None };
        let sight = sight.as_ref();
        let along = L::load(&group.along, 0);
        let (start, scale) = (probes.start, probes.scale);
        let mut seeker =
            NearestSeeker::<L> { geometry, space, group, ready, sight, ray, along, start, scale, found, scratch };
        space.bvh.nearest_together(&probes, ready, &mut seeker);
        for lane in probes.strange.lanes() {
            let (ray, touching) = (group.ray(lane), Touching(group.along[lane]));
            let limit = found.key[lane];
            let nearest = space.nearest_bounded(ray, touching, limit, |primitive, is_opaque, limit| {
                geometry.meet_in(space, primitive, is_opaque, ray, touching, limit, scratch)
            });
            if let Some((index, hit)) = nearest {
                found.take(lane, index, &hit);
            }
        }
    }
}

impl<L: Lanes> PrimitiveSeeker for NearestSeeker<'_, '_, '_, L> {
    #[inline(always)]
    fn primitive(&mut self, index: u32, rays: Bits, limits: &mut [f32; WIDTH]) {
        let primitive = &self.space.primitives[index as usize];
        if let Primitive::Sphere(sphere) = primitive {
            if rays.count() > 1 {
                let (met, t) = LaneSpheres::from(sphere).intersect_likely(&self.ray, L::splat(f64::INFINITY));
                let met = met & rays;
                if met.any() {
                    let is_opaque = self.space.attributes[index as usize].is_opaque;
                    let key = key_of(t, self.along, is_opaque);
                    let better = self.found.take_lanes(index, met, t, key);
                    if better.any() {
                        let measure = widened_measure((key - self.start) * self.scale);
                        measure.or_where_not(better, L::Floats::load(limits, 0)).store(limits, 0);
                    }
                }
                return;
            }
            let lane = rays.lowest() & (WIDTH - 1);
            if let Some(hit) = sphere.intersect_likely(self.group.ray(lane), 0.0, f64::INFINITY) {
                let is_opaque = self.space.attributes[index as usize].is_opaque;
                let hit = Touching(self.group.along[lane]).candidate(hit.into(), is_opaque);
                self.found.take(lane, index, &hit);
                limits[lane] = self.ready.limit(lane, self.found.key[lane]);
            }
            return;
        }
        self.geometry.meet_together::<L>(self.space, index, self.group, self.sight, rays, self.found, self.scratch);
        for lane in rays.lanes() {
            limits[lane] = self.ready.limit(lane, self.found.key[lane]);
        }
    }
}

/// From how many rays on a shape is met by all of them side by side.
const SIDE_BY_SIDE: u32 = 3;

/// Whether a shape is met side by side by so many rays.
#[inline(always)]
pub(super) fn are_worth_lanes(shape: &Shape, rays: Bits) -> bool {
    rays.count() >= SIDE_BY_SIDE && shape.has_lanes()
}

/// The question for the nearest hits with a shape, in whose space the rays are.
struct MeetShape<'a, 'h> {
    shape: &'a Shape,
    group: &'a RayGroup,
    rays: Bits,
    index: u32,
    is_opaque: bool,
    found: &'a mut Found<'h>,
}

impl Work for MeetShape<'_, '_> {
    type Output = ();
    #[inline(always)]
    fn run<L: Lanes>(self) {
        let Self { shape, group, rays, index, is_opaque, found } = self;
        let passages = shape.passages(&group.lanes::<L>());
        let Passage { met, t, part } = Passage::first_before(passages, L::splat(f64::INFINITY));
        let met = met & rays;
        if met.is_empty() {
            return;
        }
        let better = found.take_lanes(index, met, t, key_of(t, L::load(&group.along, 0), is_opaque));
        if better.any() {
            let mut parts = [0.0; WIDTH];
            part.store(&mut parts, 0);
            for lane in better.lanes() {
                found.hits.place[lane] = LocalPlace::of_part(parts[lane] as u32);
            }
            found.complex |= better;
        }
    }
}

impl Geometry {
    /// The nearest hits of rays with one primitive of a space, which may be any; `sight` is what is known of them there, if anything.
    #[expect(clippy::too_many_arguments, reason = "it is asked from within loops that know all of these by themselves")]
    #[inline(never)]
    pub(super) fn meet_together<L: Lanes>(
        &self,
        space: &Space,
        index: u32,
        group: &RayGroup,
        sight: Option<&Sight<'_>>,
        rays: Bits,
        found: &mut Found<'_>,
        scratch: &mut QueryScratch,
    ) {
        let primitive = &space.primitives[index as usize];
        match primitive {
            Primitive::Instance { prototype, placement, .. }
                if self.prototypes[*prototype as usize].handful.is_empty() =>
            {
                let inner = &self.prototypes[*prototype as usize];
                let local = group.to_local::<L>(&space.placements[*placement as usize]);
                let mut hits = HitRows::NOTHING;
                let mut nearest = Found { key: found.key, hits: &mut hits, complex: Bits::NONE };
                for alone in inner.first_alone..inner.primitives.len() {
                    self.meet_together::<L>(inner, alone as u32, &local, None, rays, &mut nearest, scratch);
                }
                if inner.first_alone > 0 {
                    let (geometry, found, group) = (self, &mut nearest, &local);
                    L::stage(NearestInSpace { geometry, space: inner, group, active: rays, found, scratch });
                }
                let key = nearest.key;
                for lane in rays.lanes().filter(|lane| hits.primitive[*lane] != NONE) {
                    let local = LocalHit { t: hits.t[lane], place: hits.place[lane] };
                    found.take(lane, index, &InnerHit { key: key[lane], inner: hits.primitive[lane], local });
                }
            }
            Primitive::Mesh { mesh, .. } => {
                let mut carried = None;
                let group = group.in_space_of::<L>(space, primitive, &mut carried);
                let sight = if space.placement(primitive).is_none() { sight } else { None };
                let is_opaque = space.attributes[index as usize].is_opaque;
                let mut hits = [None; WIDTH];
                let t_max = found.key.map(f64::next_up);
                self.meshes[*mesh as usize].intersect_together::<L>(group.row(), sight, rays, &t_max, &mut hits);
                for lane in rays.lanes() {
                    if let Some(hit) = hits[lane] {
                        self.meshes[*mesh as usize].prefetch_triangle::<L::Eight>(hit.triangle);
                        found.take(lane, index, &Touching(group.along[lane]).candidate(hit.into(), is_opaque));
                    }
                }
            }
            Primitive::Shape { shape, .. } if are_worth_lanes(&space.shapes[*shape as usize], rays) => {
                let mut carried = None;
                let (shape, group) =
                    (&space.shapes[*shape as usize], group.in_space_of::<L>(space, primitive, &mut carried));
                let is_opaque = space.attributes[index as usize].is_opaque;
                L::stage(MeetShape { shape, group, rays, index, is_opaque, found });
            }
            _ => {
                for lane in rays.lanes() {
                    let (ray, touching) = (group.ray(lane), Touching(group.along[lane]));
                    let is_opaque = space.attributes[index as usize].is_opaque;
                    let met = self.meet_in(space, primitive, is_opaque, ray, touching, found.key[lane], scratch);
                    if let Some(hit) = met {
                        found.take(lane, index, &hit);
                    }
                }
            }
        }
    }
}

impl Geometry {
    /// Asks for the memory that working out a hit begins with.
    #[inline(always)]
    pub(super) fn prefetch_surface<L: Lanes>(&self, hits: &HitRows, lane: usize) {
        let mut primitive = &self.world.primitives[hits.primitive[lane] as usize];
        if let Primitive::Instance { prototype, .. } = primitive
            && let Some(inner) = self.prototypes[*prototype as usize].primitives.get(hits.inner[lane] as usize)
        {
            primitive = inner;
        }
        if let Primitive::Mesh { mesh, .. } = primitive {
            self.meshes[*mesh as usize].prefetch_corners::<L::Eight>(hits.place[lane].part);
        }
    }
}
