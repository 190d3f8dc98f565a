//! Questions of shadow rays: is anything in the way, and what all is.

use std::ops::ControlFlow;

use snell_math::Ray;

use super::space::{Attributes, NONE, Primitive, Space};
use super::{Geometry, Hit, LocalHit, QueryScratch};

impl Geometry {
    /// True where any surface is met with 0 < t < `distance`.
    pub fn is_blocked(&self, ray: &Ray, distance: f64, scratch: &mut QueryScratch) -> bool {
        self.world.any(ray, distance, |index, primitive| {
            self.is_blocked_by(index, primitive, ray, distance, true, |_| (), scratch)
        })
    }

    /// Gathers every meeting with a transparent surface with 0 < t < `distance`, in no particular order. True, and then the
    /// list is not complete, where an opaque one is in the way.
    pub fn gather_blockers(&self, ray: &Ray, distance: f64, hits: &mut Vec<Hit>, scratch: &mut QueryScratch) -> bool {
        self.world.any(ray, distance, |index, primitive| {
            self.is_blocked_by(index, primitive, ray, distance, false, |hit| hits.push(hit), scratch)
        })
    }

    /// As [`Geometry::gather_blockers`], of the primitives in the world's hierarchy alone; the hits are those of the only lane.
    #[inline(never)]
    pub(super) fn is_blocked_by_bounded(
        &self,
        ray: &Ray,
        distance: f64,
        any_blocks: bool,
        hits: &mut Vec<(u8, Hit)>,
        scratch: &mut QueryScratch,
    ) -> bool {
        self.world.bvh.any(ray, distance, |index| {
            let keep = |hit| hits.push((0, hit));
            let primitive = &self.world.primitives[index as usize];
            self.is_blocked_by(index, primitive, ray, distance, any_blocks, keep, scratch)
        })
    }

    /// Whether one primitive of the world blocks all light of a ray; gives its transparent surfaces on the way to `keep`, where
    /// not everything blocks.
    #[expect(clippy::too_many_arguments, reason = "a private step of the functions above")]
    #[inline(always)]
    pub(super) fn is_blocked_by(
        &self,
        index: u32,
        primitive: &Primitive,
        ray: &Ray,
        distance: f64,
        any_blocks: bool,
        mut keep: impl FnMut(Hit),
        scratch: &mut QueryScratch,
    ) -> bool {
        if let Primitive::Instance { prototype, placement, material } = primitive {
            let space = &self.prototypes[*prototype as usize];
            let ray = self.world.placements[*placement as usize].to_local(ray);
            return space.any(&ray, distance, |inner, primitive| {
                let outer = (index, *material);
                self.is_blocked_inside(space, outer, inner, primitive, &ray, distance, any_blocks, &mut keep, scratch)
            });
        }
        let attributes = &self.world.attributes[index as usize];
        if any_blocks || attributes.is_opaque {
            return self.is_met(&self.world, primitive, ray, distance, scratch);
        }
        let keep = |LocalHit { t, place }| keep(Hit { t, primitive: index, inner: NONE, place });
        self.blocks(&self.world, attributes, primitive, NONE, ray, distance, scratch, keep)
    }

    /// As [`Geometry::is_blocked_by`], of one primitive of a prototype, whose space the ray is given in; `outer` is the instance in
    /// the world and the material that it hands on.
    #[expect(clippy::too_many_arguments, reason = "a private step of the functions above")]
    #[inline(always)]
    pub(super) fn is_blocked_inside(
        &self,
        space: &Space,
        (instance, material): (u32, u32),
        inner: u32,
        primitive: &Primitive,
        ray: &Ray,
        distance: f64,
        any_blocks: bool,
        mut keep: impl FnMut(Hit),
        scratch: &mut QueryScratch,
    ) -> bool {
        let attributes = &space.attributes[inner as usize];
        if any_blocks || attributes.is_opaque {
            return self.is_met(space, primitive, ray, distance, scratch);
        }
        let keep = |LocalHit { t, place }| keep(Hit { t, primitive: instance, inner, place });
        self.blocks(space, attributes, primitive, material, ray, distance, scratch, keep)
    }

    /// Whether a ray, given in the primitive's space, meets one primitive that is no instance with 0 < t < `distance`.
    #[inline(always)]
    fn is_met(
        &self,
        space: &Space,
        primitive: &Primitive,
        ray: &Ray,
        distance: f64,
        scratch: &mut QueryScratch,
    ) -> bool {
        match primitive {
            Primitive::Sphere(sphere) => sphere.intersect(ray, 0.0, distance).is_some(),
            Primitive::Plane(plane) => plane.intersect(ray, 0.0, distance).is_some(),
            Primitive::Mesh { mesh, .. } => {
                let carried = space.placement(primitive).map_or(*ray, |placement| placement.to_local(ray));
                self.meshes[*mesh as usize].any(&carried, 0.0, distance)
            }
            primitive => self.intersect_primitive(space, primitive, ray, 0.0, distance, scratch).is_some(),
        }
    }

    /// Whether one primitive, perhaps transparent, blocks all light; gives its transparent surfaces on the way to `keep`.
    #[expect(clippy::too_many_arguments, reason = "a private step of the function above")]
    #[inline]
    fn blocks(
        &self,
        space: &Space,
        attributes: &Attributes,
        primitive: &Primitive,
        inherited: u32,
        ray: &Ray,
        distance: f64,
        scratch: &mut QueryScratch,
        mut keep: impl FnMut(LocalHit),
    ) -> bool {
        let mut visit = |local: LocalHit| {
            let material = self.material_of(primitive, attributes, inherited, local.place);
            if !self.transparent[material as usize] {
                return ControlFlow::Break(());
            }
            keep(local);
            ControlFlow::Continue(())
        };
        match primitive {
            Primitive::Sphere(sphere) => sphere
                .hits_before(ray, distance)
                .into_iter()
                .flatten()
                .try_for_each(|hit| visit(LocalHit::from(hit)))
                .is_break(),
            Primitive::Mesh { mesh, .. } => {
                let carried = space.placement(primitive).map_or(*ray, |placement| placement.to_local(ray));
                let mesh = &self.meshes[*mesh as usize];
                mesh.for_each_hit(&carried, 0.0, distance, |hit| visit(LocalHit::from(hit))).is_break()
            }
            // The others have few surfaces: from one to the next.
            _ => {
                let mut t_min = 0.0;
                while let Some(local) = self.intersect_primitive(space, primitive, ray, t_min, distance, scratch) {
                    if visit(local).is_break() {
                        return true;
                    }
                    t_min = local.t;
                }
                false
            }
        }
    }
}
