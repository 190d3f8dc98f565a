//! Shadow rays side by side and what stands in hierarchies, instances and meshes: which of them are blocked, and what transparent
//! surfaces the others meet. As in `packets.rs`, what a ray meets is what it meets alone.

use std::ops::ControlFlow;

use snell_math::Ray;
use snell_math::lanes::{Bits, Lanes, WIDTH, Work};

use super::lanes::keep_met;
use super::packets::{RayGroup, are_worth_lanes};
use super::space::{NONE, Primitive, Space};
use super::{Geometry, Hit, LocalHit, LocalPlace, QueryScratch};
use crate::accel::wide::{Group, PrimitiveFinder};
use crate::shape::triangle_mesh::Sight;
use crate::shape::{LaneRay, LaneSpheres, RayRow, Shape, Sphere};

/// The instance of the world through which a prototype is seen: its number, and the material that it hands on.
pub(super) type Outer = Option<(u32, u32)>;

/// What all questions of one row of shadow rays have in common.
pub(super) struct Shadows<'a> {
    pub(super) distance: &'a [f64; WIDTH],
    pub(super) any_blocks: bool,
    /// Meetings with transparent surfaces, each with its lane.
    pub(super) hits: &'a mut Vec<(u8, Hit)>,
    pub(super) scratch: &'a mut QueryScratch,
}

/// The question which rays are blocked by one primitive of the world, or where there is no number, by those of its hierarchy.
pub(super) struct BlockedInWorld<'a, 's> {
    pub(super) geometry: &'a Geometry,
    pub(super) index: Option<u32>,
    pub(super) rays: RayRow<'a>,
    pub(super) active: Bits,
    pub(super) shadows: &'a mut Shadows<'s>,
}

impl Work for BlockedInWorld<'_, '_> {
    type Output = Bits;
    #[inline(always)]
    fn run<L: Lanes>(self) -> Bits {
        let Self { geometry, index, rays, active, shadows } = self;
        let group = &RayGroup::new(&rays.lanes::<L>(0));
        let (space, outer) = (&geometry.world, None);
        match index {
            Some(index) => geometry.block_together::<L>(space, outer, index, group, None, active, shadows),
            None => BlockedInSpace { geometry, space, outer, group, active, shadows }.run::<L>(),
        }
    }
}

/// The question which rays are blocked by the primitives of a space's hierarchy.
pub(super) struct BlockedInSpace<'a, 's> {
    pub(super) geometry: &'a Geometry,
    pub(super) space: &'a Space,
    pub(super) outer: Outer,
    pub(super) group: &'a RayGroup,
    pub(super) active: Bits,
    pub(super) shadows: &'a mut Shadows<'s>,
}

struct BlockedFinder<'a, 'r, 's, L> {
    geometry: &'a Geometry,
    space: &'a Space,
    outer: Outer,
    group: &'r RayGroup,
    sight: Option<&'r Sight<'r>>,
    ray: LaneRay<L>,
    distance: L,
    blocked: Bits,
    shadows: &'r mut Shadows<'s>,
}

impl Work for BlockedInSpace<'_, '_> {
    type Output = Bits;
    #[inline(always)]
    fn run<L: Lanes>(self) -> Bits {
        let Self { geometry, space, outer, group, active, shadows } = self;
        let ray = group.lanes::<L>();
        let distance = L::load(shadows.distance, 0);
        let probes = space.bvh.tree().approach_together(ray.origin, ray.direction, active, distance);
        let ready = &Group::new(&probes, distance);
        let sight = if space.has_meshes { Some(Sight::new(group.row(), &probes, ready)) } else { None };
        let (sight, blocked) = (sight.as_ref(), Bits::NONE);
        let mut finder = BlockedFinder::<L> { geometry, space, outer, group, sight, ray, distance, blocked, shadows };
        space.bvh.each_together(&probes, ready, &mut finder);
        let mut blocked = finder.blocked;
        for lane in probes.strange.lanes() {
            let (ray, distance) = (group.ray(lane), shadows.distance[lane]);
            let is_blocked = space
                .bvh
                .any(ray, distance, |index| geometry.is_blocked_alone(space, outer, index, ray, lane, shadows));
            if is_blocked {
                blocked |= Bits::lane(lane);
            }
        }
        blocked
    }
}

/// The primitive of the world and that of the prototype, by which a hit is known, and the material that is handed on.
#[inline(always)]
fn names_of(outer: Outer, index: u32) -> (u32, u32, u32) {
    match outer {
        None => (index, NONE, NONE),
        Some((instance, material)) => (instance, index, material),
    }
}

impl<L: Lanes> BlockedFinder<'_, '_, '_, L> {
    /// Gathers where rays meet a sphere that may be transparent; those that it blocks.
    #[inline(always)]
    fn gather_sphere(&mut self, index: u32, sphere: &Sphere, rays: Bits) -> Bits {
        let (primitive, inner, inherited) = names_of(self.outer, index);
        let (geometry, space, place) = (self.geometry, self.space, LocalPlace::of_part(0));
        let attributes = &space.attributes[index as usize];
        let material = geometry.material_of(&space.primitives[index as usize], attributes, inherited, place);
        let spheres = LaneSpheres::from(sphere);
        if !geometry.transparent[material as usize] {
            return spheres.intersect_likely(&self.ray, self.distance).0 & rays;
        }
        for (met, t) in spheres.hits_before(&self.ray, self.distance) {
            keep_met(self.shadows.hits, met & rays, t, primitive, inner);
        }
        Bits::NONE
    }
}

impl<L: Lanes> PrimitiveFinder for BlockedFinder<'_, '_, '_, L> {
    #[inline(always)]
    fn primitive(&mut self, index: u32, rays: Bits) -> Bits {
        let blocks_all = self.shadows.any_blocks || self.space.attributes[index as usize].is_opaque;
        let blocked = match &self.space.primitives[index as usize] {
            Primitive::Sphere(sphere) if blocks_all => {
                if rays.count() > 1 {
                    LaneSpheres::from(sphere).intersect_likely(&self.ray, self.distance).0 & rays
                } else {
                    let lane = rays.lowest() & (WIDTH - 1);
                    let (ray, distance) = (self.group.ray(lane), self.shadows.distance[lane]);
                    if sphere.intersect_likely(ray, 0.0, distance).is_some() { rays } else { Bits::NONE }
                }
            }
            Primitive::Sphere(sphere) if rays.count() > 1 => self.gather_sphere(index, sphere, rays),
            _ => {
                let Self { geometry, space, outer, group, sight, .. } = *self;
                geometry.block_together::<L>(space, outer, index, group, sight, rays, self.shadows)
            }
        };
        self.blocked |= blocked;
        blocked
    }
}

/// The question which rays are blocked by a shape, in whose space they are; `keep` says by which numbers the places are kept where
/// they meet it and it is transparent.
struct BlockedByShape<'a, 's> {
    shape: &'a Shape,
    group: &'a RayGroup,
    rays: Bits,
    keep: Option<(u32, u32)>,
    shadows: &'a mut Shadows<'s>,
}

impl Work for BlockedByShape<'_, '_> {
    type Output = Bits;
    #[inline(always)]
    fn run<L: Lanes>(self) -> Bits {
        let Self { shape, group, rays, keep, shadows } = self;
        let distance = L::load(shadows.distance, 0);
        let [near, far] = shape.passages(&group.lanes::<L>());
        let Some((primitive, inner)) = keep else {
            return (near.before(distance) | far.before(distance)) & rays;
        };
        for passage in [near, far] {
            let met = passage.before(distance) & rays;
            if met.any() {
                let (mut t, mut part) = ([0.0; WIDTH], [0.0; WIDTH]);
                passage.t.store(&mut t, 0);
                passage.part.store(&mut part, 0);
                for lane in met.lanes() {
                    let place = LocalPlace::of_part(part[lane] as u32);
                    shadows.hits.push((lane as u8, Hit { t: t[lane], primitive, inner, place }));
                }
            }
        }
        Bits::NONE
    }
}

impl Geometry {
    /// Which rays are blocked by one primitive of a space, which may be any; what they meet of transparent ones is gathered. `sight` is
    /// what is known of them there, if anything.
    #[expect(clippy::too_many_arguments, reason = "it is asked from within loops that know all of these by themselves")]
    #[inline(never)]
    pub(super) fn block_together<L: Lanes>(
        &self,
        space: &Space,
        outer: Outer,
        index: u32,
        group: &RayGroup,
        sight: Option<&Sight<'_>>,
        rays: Bits,
        shadows: &mut Shadows<'_>,
    ) -> Bits {
        let primitive = &space.primitives[index as usize];
        match primitive {
            Primitive::Instance { prototype, placement, material }
                if self.prototypes[*prototype as usize].handful.is_empty() =>
            {
                let inner = &self.prototypes[*prototype as usize];
                let local = group.to_local::<L>(&space.placements[*placement as usize]);
                let outer = Some((index, *material));
                let mut blocked = Bits::NONE;
                for alone in inner.first_alone..inner.primitives.len() {
                    let open = rays.without(blocked);
                    if open.any() {
                        blocked |= self.block_together::<L>(inner, outer, alone as u32, &local, None, open, shadows);
                    }
                }
                let active = rays.without(blocked);
                if inner.first_alone > 0 && active.any() {
                    blocked |= L::stage(BlockedInSpace {
                        geometry: self,
                        space: inner,
                        outer,
                        group: &local,
                        active,
                        shadows,
                    });
                }
                blocked
            }
            Primitive::Mesh { mesh, .. } if shadows.any_blocks || space.attributes[index as usize].is_opaque => {
                let mut carried = None;
                let group = group.in_space_of::<L>(space, primitive, &mut carried);
                let sight = if space.placement(primitive).is_none() { sight } else { None };
                self.meshes[*mesh as usize].any_together::<L>(group.row(), sight, rays, shadows.distance)
            }
            Primitive::Mesh { mesh, .. } => {
                let mut carried = None;
                let group = group.in_space_of::<L>(space, primitive, &mut carried);
                let sight = if space.placement(primitive).is_none() { sight } else { None };
                let attributes = &space.attributes[index as usize];
                let (number, inner, inherited) = names_of(outer, index);
                let hits = &mut *shadows.hits;
                self.meshes[*mesh as usize].each_together::<L>(
                    group.row(),
                    sight,
                    rays,
                    shadows.distance,
                    |lane, hit| {
                        let LocalHit { t, place } = LocalHit::from(hit);
                        let material = self.material_of(primitive, attributes, inherited, place);
                        if !self.transparent[material as usize] {
                            return ControlFlow::Break(());
                        }
                        hits.push((lane as u8, Hit { t, primitive: number, inner, place }));
                        ControlFlow::Continue(())
                    },
                )
            }
            Primitive::Shape { shape, .. } if are_worth_lanes(&space.shapes[*shape as usize], rays) => {
                let mut carried = None;
                let (shape, group) =
                    (&space.shapes[*shape as usize], group.in_space_of::<L>(space, primitive, &mut carried));
                let attributes = &space.attributes[index as usize];
                let (number, inner, inherited) = names_of(outer, index);
                let is_transparent = || {
                    let material = self.material_of(primitive, attributes, inherited, LocalPlace::of_part(0));
                    self.transparent[material as usize]
                };
                let keep = !(shadows.any_blocks || attributes.is_opaque) && is_transparent();
                let keep = keep.then_some((number, inner));
                L::stage(BlockedByShape { shape, group, rays, keep, shadows })
            }
            _ => {
                let mut blocked = Bits::NONE;
                for lane in rays.lanes() {
                    if self.is_blocked_alone(space, outer, index, group.ray(lane), lane, shadows) {
                        blocked |= Bits::lane(lane);
                    }
                }
                blocked
            }
        }
    }

    /// Whether one ray is blocked by one primitive of a space.
    fn is_blocked_alone(
        &self,
        space: &Space,
        outer: Outer,
        index: u32,
        ray: &Ray,
        lane: usize,
        shadows: &mut Shadows<'_>,
    ) -> bool {
        let Shadows { distance, any_blocks, hits, scratch } = shadows;
        let (primitive, distance) = (&space.primitives[index as usize], distance[lane]);
        let keep = |hit| hits.push((lane as u8, hit));
        match outer {
            None => self.is_blocked_by(index, primitive, ray, distance, *any_blocks, keep, scratch),
            Some(outer) => {
                self.is_blocked_inside(space, outer, index, primitive, ray, distance, *any_blocks, keep, scratch)
            }
        }
    }
}
