//! What the neighbours of a ray meet beside it: how the surface turns there, and the part of it that the ray stands for.

use snell_math::{Ray, Vector3};

use super::space::NONE;
use super::{Geometry, Hit, Primitive};
use crate::differential::{RayDifferential, SurfaceDifferential};
use crate::interaction::{SurfaceInteraction, Surroundings};
use crate::texture::{Footprint, Spaces};

/// So large a part of the way to a neighbour is gone: derivatives are differences over short ways.
const PART: f64 = 1.0 / 64.0;
/// But no farther than this, relative to coordinates and the distance: far beyond rounding, and short for any shape.
const FARTHEST: f64 = 1.0 / 1024.0;

impl Geometry {
    /// What the neighbours of a ray meet, as if they met the same part of the same surface. Nothing where they would meet it at
    /// no finite place.
    ///
    /// A shape need not know its derivatives: surfaces are worked out a little way beside the hit, on the tangent plane, and
    /// brought back onto it, so that placements of all kinds are in them.
    pub(crate) fn surroundings(
        &self,
        ray: &Ray,
        hit: &Hit,
        interaction: &SurfaceInteraction,
        differential: &RayDifferential,
    ) -> Surroundings {
        let flat = interaction.geometric_normal.as_vector();
        let arriving = differential.on_plane(ray.direction, hit.t, flat);
        let [right, below] = arriving.origin;
        if *differential == RayDifferential::NONE || !(right.is_finite() && below.is_finite()) {
            return Surroundings::NONE;
        }
        let sides = self.known_sides(hit, interaction, arriving.origin).unwrap_or_else(|| {
            let farthest = FARTHEST * (hit.t + interaction.point.max_abs());
            arriving.origin.map(|step| self.side(hit, interaction, step, farthest))
        });
        Surroundings {
            differential: SurfaceDifferential {
                arriving,
                normal: interaction.shading_normal.as_vector(),
                turns: sides.map(|side| side.turn),
            },
            footprint: Footprint {
                object: sides.map(|side| side.object),
                world: arriving.origin,
                uv: sides.map(|side| side.uv),
            },
        }
    }

    /// How spheres and planes change along some steps, which is known, where they stand in the world as they are and no texture
    /// looks at coordinates of theirs.
    fn known_sides(&self, hit: &Hit, interaction: &SurfaceInteraction, steps: [Vector3; 2]) -> Option<[Side; 2]> {
        let Spaces { object, uv, .. } = self.spaces[interaction.material as usize];
        let primitive = &self.world.primitives[hit.primitive as usize];
        if hit.inner != NONE || object || uv || self.world.placement(primitive).is_some() {
            return None;
        }
        let curvature = match primitive {
            Primitive::Sphere(sphere) => {
                let outward = interaction.shading_normal.as_vector().dot(interaction.point - sphere.center);
                1.0_f64.copysign(outward) / sphere.radius
            }
            Primitive::Plane(_) => 0.0,
            _ => return None,
        };
        Some(steps.map(|step| Side { turn: step * curvature, ..Side::default() }))
    }

    /// How the surface changes along a step.
    fn side(&self, hit: &Hit, interaction: &SurfaceInteraction, step: Vector3, farthest: f64) -> Side {
        let length = step.length();
        let part = PART.min(farthest / length);
        if length == 0.0 || part == 0.0 {
            return Side::default();
        }
        let beside = self.beside(hit, interaction, step * part);
        let per_step = 1.0 / part;
        let mut uv = difference(beside.uv, interaction.uv);
        if uv.iter().any(|change| change.abs() > 0.5) {
            // Perhaps over the seam of a surface that is closed: not so to the other side, then.
            let other = difference(interaction.uv, self.beside(hit, interaction, step * -part).uv);
            uv = [0, 1].map(|axis: usize| if other[axis].abs() < uv[axis].abs() { other[axis] } else { uv[axis] });
        }
        Side {
            turn: (beside.shading_normal.as_vector() - interaction.shading_normal.as_vector()) * per_step,
            object: (beside.object_point - interaction.object_point) * per_step,
            uv: uv.map(|change| change * per_step),
        }
    }

    /// The surface beside a hit, by a step in its tangent plane.
    fn beside(&self, hit: &Hit, interaction: &SurfaceInteraction, step: Vector3) -> SurfaceInteraction {
        let ray = Ray::new(interaction.point + step, -interaction.geometric_normal.as_vector());
        let hit = Hit { t: 0.0, ..*hit };
        if hit.inner == NONE {
            return self.interaction_in(&self.world, &ray, &hit, hit.primitive, NONE, true);
        }
        self.interaction_of_instance(&ray, &hit, true)
    }
}

/// How a surface changes from a ray to its neighbour.
#[derive(Clone, Copy, Debug, Default)]
struct Side {
    turn: Vector3,
    object: Vector3,
    uv: [f64; 2],
}

fn difference(a: [f64; 2], b: [f64; 2]) -> [f64; 2] {
    [a[0] - b[0], a[1] - b[1]]
}
