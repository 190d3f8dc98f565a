//! Does a line go through a triangle: a test without gaps between neighbours.
//!
//! Woop, Benthin and Wald, "Watertight Ray/Triangle Intersection", JCGT 2(1), 2013: a shear takes the ray to the third
//! axis, and the triangle, seen along the ray, is a triangle of the plane, which either contains the origin or does not.
//! Every corner is sheared by itself, so triangles that share a corner agree on where it is, whatever rounding did to it.
//! The paper then evaluates edge functions in the next higher precision where they vanish. Here their signs are exact,
//! always (Dekker, "A Floating-Point Technique for Extending the Available Precision", 1971), so that what is decided is
//! decided without any error for the triangles of the plane; and for these, that a closed surface covers the origin an
//! even number of times, or as often from the front as from the back, is a theorem and not a matter of luck.
//!
//! Where the line goes exactly through an edge or a corner, it is thought to be moved by (ε, ε²) in that plane, for an ε
//! smaller than any number, and then goes through none (Edelsbrunner and Mücke, "Simulation of Simplicity", ACM TOG 9(1),
//! 1990). Triangles round an edge or a corner so share it out without gap or overlap, whatever meshes they belong to.
//!
//! Space: that of the mesh and the ray, any unit of length; t is the ray parameter. The signs are exact while products of
//! two sheared coordinates neither overflow nor fall below about 1e-290.

use snell_math::Ray;
use snell_math::lanes::Lanes;

/// A ray with the shear that takes it to the third axis.
#[derive(Clone, Copy, Debug)]
pub(super) struct RaySpace {
    /// The ray's origin, on the first, second and third axis.
    origin: [f64; 3],
    /// Which axes of space become the first, second and third; the third is the one the ray is longest on.
    axes: [usize; 3],
    /// The slopes of the ray on the first two axes, at most 1 in magnitude, and the inverse of its third component.
    shear: [f64; 3],
}

/// Where the line of a ray goes through the plane of a triangle, inside it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Meeting {
    pub(super) t: f64,
    /// The barycentric weights of the three corners, none negative.
    pub(super) weights: [f64; 3],
    /// The corners are counter-clockwise, seen from where the ray comes from.
    pub(super) front: bool,
}

impl Meeting {
    /// Between two ray parameters, the second included.
    #[inline(always)]
    pub(super) fn is_within(&self, t_min: f64, t_max: f64) -> bool {
        t_min < self.t && self.t <= t_max
    }
}

impl RaySpace {
    /// Of what was worked out elsewhere.
    #[inline(always)]
    pub(super) const fn of_parts(origin: [f64; 3], axes: [usize; 3], shear: [f64; 3]) -> Self {
        Self { origin, axes, shear }
    }

    /// `None` where the direction is zero or anything is not finite: such a ray meets nothing.
    #[inline(always)]
    pub(super) fn new(ray: &Ray) -> Option<Self> {
        let (o, d) = (ray.origin.to_array(), ray.direction.to_array());
        // Without branches, since directions of rays that bounce cannot be foretold.
        let [x, y, z] = [d[0].abs(), d[1].abs(), d[2].abs()];
        let (is_y, is_z) = (usize::from(y > x), usize::from(z > x) & usize::from(z > y));
        let third = is_z << 1 | is_y & !is_z;
        let (first, second) = [(1, 2), (2, 0), (0, 1)][third];
        // Zero times a number is zero, times anything else it is NaN.
        let zero = 0.0;
        let zeros = (o[0] * zero + o[1] * zero + o[2] * zero) + (d[0] * zero + d[1] * zero + d[2] * zero);
        if zeros.is_nan() || !d[third].is_normal() {
            return None;
        }
        let inverse = 1.0 / d[third];
        Some(Self {
            origin: [o[first], o[second], o[third]],
            axes: [first, second, third],
            shear: [d[first] / d[third], d[second] / d[third], inverse],
        })
    }

    /// Which axes of space are the first, second and third: the third is the one the ray is longest on.
    #[inline]
    pub(super) fn axes(&self) -> [usize; 3] {
        self.axes
    }

    /// A corner in the space of the ray: two coordinates across it and one, not scaled, along it.
    #[inline(always)]
    fn shear(&self, corner: [f32; 3]) -> [f64; 3] {
        let [first, second, third] = self.axes;
        self.shear_ordered([corner[first], corner[second], corner[third]])
    }

    /// The same of a corner whose coordinates are those on the first, second and third axis.
    #[inline(always)]
    fn shear_ordered(&self, corner: [f32; 3]) -> [f64; 3] {
        let x = f64::from(corner[0]) - self.origin[0];
        let y = f64::from(corner[1]) - self.origin[1];
        let z = f64::from(corner[2]) - self.origin[2];
        [x - self.shear[0] * z, y - self.shear[1] * z, z]
    }

    /// Where the line goes through a triangle. A line in the triangle's plane does not.
    #[inline(always)]
    pub(super) fn meet<L: Lanes>(&self, corners: [[f32; 3]; 3]) -> Option<Meeting> {
        let [p, q, r] = &[self.shear(corners[0]), self.shear(corners[1]), self.shear(corners[2])];
        let (mut a, mut b, mut c) = (edge(q, r), edge(r, p), edge(p, q));
        if (a < 0.0 || b < 0.0 || c < 0.0) && (a > 0.0 || b > 0.0 || c > 0.0) {
            return None;
        }
        if a == 0.0 || b == 0.0 || c == 0.0 {
            let moved = |edge: f64, from, to| if edge == 0.0 { moved_side(from, to) } else { edge };
            (a, b, c) = (moved(a, q, r), moved(b, r, p), moved(c, p, q));
            if !(a > 0.0 && b > 0.0 && c > 0.0 || a < 0.0 && b < 0.0 && c < 0.0) {
                return None;
            }
        }
        self.met::<L>(p, q, r)
    }

    /// As [`RaySpace::meet`], for a triangle of which it is known that the line goes through it. The corners' coordinates are those on
    /// the first, second and third axis.
    #[inline(always)]
    pub(super) fn meet_surely<L: Lanes>(&self, corners: &[[f32; 3]; 3]) -> Option<Meeting> {
        // No closure, see `BlockRay::across`.
        let (p, q) = (self.shear_ordered(corners[0]), self.shear_ordered(corners[1]));
        self.met::<L>(&p, &q, &self.shear_ordered(corners[2]))
    }

    /// Where the line goes through a triangle that it goes through.
    #[inline(always)]
    fn met<L: Lanes>(&self, p: &[f64; 3], q: &[f64; 3], r: &[f64; 3]) -> Option<Meeting> {
        // The edge functions are the weights of the opposite corners, up to scale. Those of a long and thin triangle lose most
        // of their digits to the difference of products, and the point would slide along the triangle.
        let [mut a, mut b, mut c] = exact_edges::<L>(p, q, r);
        if a.abs() < SMALL || b.abs() < SMALL || c.abs() < SMALL {
            [a, b, c] = exact_edges_anywhere(p, q, r);
        }
        let area = a + b + c;
        if area == 0.0 || area.is_nan() {
            return None;
        }
        let weights = [a / area, b / area, c / area];
        Some(Meeting {
            // A mean of the corners whose weights are not negative, so never in front of them all or behind.
            t: (weights[0] * p[2] + weights[1] * q[2] + weights[2] * r[2]) * self.shear[2],
            weights,
            front: (area < 0.0) == (self.shear[2] > 0.0),
        })
    }
}

/// On which side of the line from `from` to `to` the origin lies: `from` × `to`, with the exact sign. Exchanging the two
/// points changes the sign and nothing else.
#[inline]
fn edge(from: &[f64; 3], to: &[f64; 3]) -> f64 {
    let (left, right) = (from[0] * to[1], from[1] * to[0]);
    let difference = left - right;
    // The difference errs by u (|left| + |right|) + u |difference| with u = 2⁻⁵³, so by less than 3 u of the sum.
    if difference.abs() > 2.0 * f64::EPSILON * (left.abs() + right.abs()) { difference } else { near_edge(from, to) }
}

/// [`exact_edge`], where it is needed so seldom that it is kept out of the way.
#[cold]
fn near_edge(from: &[f64; 3], to: &[f64; 3]) -> f64 {
    exact_edge(from, to)
}

/// `from` × `to` with the exact sign and at most the last two bits wrong.
#[inline]
fn exact_edge(from: &[f64; 3], to: &[f64; 3]) -> f64 {
    exact_cross::<f64>(from, to)
}

/// Below this, products may be too small for their errors to be numbers, and instructions might differ.
pub(super) const SMALL: f64 = 1e-200;

/// [`exact_edge`] for the three edges that are opposite to the corners.
#[inline(always)]
fn exact_edges<L: Lanes>(p: &[f64; 3], q: &[f64; 3], r: &[f64; 3]) -> [f64; 3] {
    [exact_cross::<L>(q, r), exact_cross::<L>(r, p), exact_cross::<L>(p, q)]
}

/// The same by what every machine has.
#[cold]
fn exact_edges_anywhere(p: &[f64; 3], q: &[f64; 3], r: &[f64; 3]) -> [f64; 3] {
    exact_edges::<f64>(p, q, r)
}

/// See [`exact_edge`].
#[inline(always)]
fn exact_cross<L: Lanes>(from: &[f64; 3], to: &[f64; 3]) -> f64 {
    let (left, right) = (from[0] * to[1], from[1] * to[0]);
    let (left_error, right_error) = (L::product_error(from[0], to[1], left), L::product_error(from[1], to[0], right));
    exact_difference(left, right, left_error, right_error)
}

/// The difference of two products whose errors are known, as exact as [`exact_edge`].
#[inline(always)]
pub(super) fn exact_difference<L: Lanes>(left: L, right: L, left_error: L, right_error: L) -> L {
    // Where the products do not nearly cancel, the first term decides. Where they do, their difference has no error
    // (Sterbenz), that of their errors is a sum of two terms, and what does not fit into `high` is less than its last
    // place or the last place of the two terms that cancel.
    let (difference, difference_error) = exact_sum(left, -right);
    let (errors, errors_error) = exact_sum(left_error, -right_error);
    let (high, low) = exact_sum(difference, errors);
    high + (low + errors_error + difference_error)
}

/// a + b = first + second (Knuth).
#[inline(always)]
fn exact_sum<L: Lanes>(a: L, b: L) -> (L, L) {
    let sum = a + b;
    let b_part = sum - a;
    (sum, (a - (sum - b_part)) + (b - b_part))
}

/// The sign of the edge function for an origin moved by (ε, ε²), where it vanishes for the origin itself: of
/// ε (from.y − to.y) + ε² (to.x − from.x). Zero only where the two points coincide.
#[cold]
fn moved_side(from: &[f64; 3], to: &[f64; 3]) -> f64 {
    if from[1] != to[1] { from[1] - to[1] } else { to[0] - from[0] }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    fn exact_sign(from: [i64; 2], to: [i64; 2]) -> i32 {
        let [a, b, c, d] = [from[0], to[1], from[1], to[0]].map(i128::from);
        (a * b - c * d).signum() as i32
    }

    fn sign(x: f64) -> i32 {
        i32::from(x > 0.0) - i32::from(x < 0.0)
    }

    proptest! {
        #![proptest_config(ProptestConfig { cases: 4096, failure_persistence: None, ..ProptestConfig::default() })]
        #[test]
        fn signs_are_exact(
            x in -1 << 26..1_i64 << 26,
            y in -1 << 26..1_i64 << 26,
            k in 1..1_i64 << 26,
            nudge_x in -3..4_i64,
            nudge_y in -3..4_i64,
            scale in -60..60_i32,
        ) {
            // Two nearly parallel vectors of whole numbers of up to 53 bits, so that i128 has the truth.
            let (from, to) = ([x, y], [x * k + nudge_x, y * k + nudge_y]);
            let scale = power_of_two(scale);
            let point = |p: [i64; 2]| [p[0] as f64 * scale, p[1] as f64 * scale, 0.0];
            let value = edge(&point(from), &point(to));
            prop_assert_eq!(sign(value), exact_sign(from, to));
            prop_assert!(value == -edge(&point(to), &point(from)));
            // The weight is right too. The truth has less than 53 bits.
            let truth = (x * nudge_y - y * nudge_x) as f64 * scale * scale;
            let value = exact_edge(&point(from), &point(to));
            prop_assert!((value - truth).abs() <= 4.0 * f64::EPSILON * truth.abs());
        }
    }

    fn power_of_two(exponent: i32) -> f64 {
        let factor = if exponent < 0 { 0.5 } else { 2.0 };
        (0..exponent.abs()).fold(1.0, |x, _| x * factor)
    }

    /// The twin: the plain difference of products gets signs wrong on the same kind of input.
    #[test]
    fn plain_signs_are_not_exact() {
        let wrong = (1..200_i64)
            .filter(|i| {
                let (x, y, k) = (67_108_859 - i, 67_108_001 - 7 * i, 67_000_001);
                let (from, to) = ([x, y], [x * k + 1, y * k + 1]);
                let plain = from[0] as f64 * to[1] as f64 - from[1] as f64 * to[0] as f64;
                sign(plain) != exact_sign(from, to)
            })
            .count();
        assert!(wrong > 100, "{wrong}");
    }
}
