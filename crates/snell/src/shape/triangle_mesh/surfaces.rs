//! Hits with a mesh side by side, worked out.

use snell_math::lanes::{Bits, LaneVector, Lanes, WIDTH};

use super::TriangleMesh;
use super::spaces::{Corners, RaySpaces};
use crate::shape::{LaneRay, LaneSurfacePoint};

impl TriangleMesh {
    /// What [`TriangleMesh::hit`] and [`TriangleMesh::surface`] make of hits of rays, given in the mesh's space, with a triangle each;
    /// and the lanes where it is that: where nothing is out of the ordinary. Made for all lanes that there may be.
    #[inline(always)]
    pub(crate) fn surfaces<L: Lanes>(
        &self,
        ray: &LaneRay<L>,
        triangles: &[u32; WIDTH],
        lanes: Bits,
    ) -> (LaneSurfacePoint<L>, Bits) {
        let has_normals = !self.normals.is_empty();
        let (mut corners, mut normals) = (Corners::NOTHING, Corners::NOTHING);
        for lane in lanes.lanes() {
            let [a, b, c] = self.triangles[triangles[lane] as usize].map(|vertex| vertex as usize);
            corners.put(lane, &[self.positions[a], self.positions[b], self.positions[c]]);
            if has_normals {
                normals.put(lane, &[self.normals[a], self.normals[b], self.normals[c]]);
            }
        }
        let spaces = &RaySpaces::new(ray.origin, ray.direction);
        let [a, b, c] = corners.lanes::<L>();
        let axes = spaces.axes;
        let meeting = spaces.meet([axes.in_order(a), axes.in_order(b), axes.in_order(c)]);
        let weights = meeting.weights;
        let (ab, ac) = (b - a, c - a);
        let (geometric_normal, mut usual) = ab.cross(ac).normalize_usual();
        let mut shading_normal = geometric_normal;
        if has_normals {
            let [at_a, at_b, at_c] = normals.lanes::<L>();
            // From zero on, so that no sum is −0.
            let mixed = LaneVector::splat([0.0; 3]) + at_a * weights.x + at_b * weights.y + at_c * weights.z;
            let (unit, is_unit) = mixed.normalize_usual();
            let backward = unit.dot(geometric_normal).lt(L::splat(0.0));
            shading_normal = (-unit).or_where_not(backward, unit);
            usual &= is_unit;
        }
        let point = a + ab * weights.y + ac * weights.z;
        let surface =
            LaneSurfacePoint { point, error: L::splat(self.surface_error()), geometric_normal, shading_normal };
        (surface, lanes & spaces.usable & meeting.seen() & usual)
    }
}
