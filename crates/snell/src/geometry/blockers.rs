//! Questions of shadow rays: is anything in the way, and what all is.

use std::ops::ControlFlow;

use snell_math::Ray;

use crate::accel::Candidate;

use super::space::{NONE, Primitive, Space};
use super::{Geometry, Hit, LocalHit, QueryScratch};

impl Geometry {
    /// True where any surface is met with 0 < t < `distance`.
    pub fn is_blocked(&self, ray: &Ray, distance: f64, scratch: &mut QueryScratch) -> bool {
        self.world.any(ray, distance, |_, primitive| match primitive {
            Primitive::Instance { prototype, placement, .. } => {
                let space = &self.prototypes[*prototype as usize];
                let ray = self.world.placements[*placement as usize].to_local(ray);
                space.any(&ray, distance, |_, primitive| {
                    self.intersect_primitive(space, primitive, &ray, 0.0, distance, scratch).is_some()
                })
            }
            primitive => self.intersect_primitive(&self.world, primitive, ray, 0.0, distance, scratch).is_some(),
        })
    }

    /// Gathers every meeting with a transparent surface with 0 < t < `distance`, in no particular order. True, and then the
    /// list is not complete, where an opaque one is in the way.
    pub fn gather_blockers(&self, ray: &Ray, distance: f64, hits: &mut Vec<Hit>, scratch: &mut QueryScratch) -> bool {
        self.world.any(ray, distance, |index, primitive| match primitive {
            Primitive::Instance { prototype, placement, material } => {
                let space = &self.prototypes[*prototype as usize];
                let ray = self.world.placements[*placement as usize].to_local(ray);
                space.any(&ray, distance, |inner, primitive| {
                    let mut keep = |local: LocalHit| hits.push(Hit { t: local.t(), primitive: index, inner, local });
                    self.blocks(space, inner, primitive, *material, &ray, distance, scratch, &mut keep)
                })
            }
            primitive => {
                let mut keep = |local: LocalHit| hits.push(Hit { t: local.t(), primitive: index, inner: NONE, local });
                self.blocks(&self.world, index, primitive, NONE, ray, distance, scratch, &mut keep)
            }
        })
    }

    /// Whether one primitive blocks all light; gives its transparent surfaces on the way to `keep`.
    #[expect(clippy::too_many_arguments, reason = "a private step of the function above")]
    fn blocks(
        &self,
        space: &Space,
        index: u32,
        primitive: &Primitive,
        inherited: u32,
        ray: &Ray,
        distance: f64,
        scratch: &mut QueryScratch,
        keep: &mut impl FnMut(LocalHit),
    ) -> bool {
        let attributes = &space.attributes[index as usize];
        if attributes.is_opaque {
            return self.intersect_primitive(space, primitive, ray, 0.0, distance, scratch).is_some();
        }
        let mut visit = |local: LocalHit| {
            let material = self.material_of(primitive, attributes, inherited, &local);
            if !self.transparent[material as usize] {
                return ControlFlow::Break(());
            }
            keep(local);
            ControlFlow::Continue(())
        };
        if let Primitive::Mesh { mesh, .. } = primitive {
            let carried = space.placement(primitive).map_or(*ray, |placement| placement.to_local(ray));
            let mesh = &self.meshes[*mesh as usize];
            return mesh.for_each_hit(&carried, 0.0, distance, |hit| visit(LocalHit::Mesh(hit))).is_break();
        }
        // The others have few surfaces: from one to the next.
        let mut t_min = 0.0;
        while let Some(local) = self.intersect_primitive(space, primitive, ray, t_min, distance, scratch) {
            if visit(local).is_break() {
                return true;
            }
            t_min = local.t();
        }
        false
    }
}
