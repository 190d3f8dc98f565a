//! Affine maps between spaces, kept with their inverses.

use glam::{DAffine3, DMat3, DQuat, DVec3};

use crate::lanes::{LaneVector, Lanes};
use crate::{Bounds3, Normal3, Point3, Ray, Vector3, portable};

/// An invertible affine map, named destination-from-source where it is stored: `world_from_object`.
///
/// ```
/// use snell_math::{Point3, Transform, Vector3};
/// let world_from_object = Transform::translate(Vector3::new(1.0, 0.0, 0.0)) * Transform::scale(Vector3::new(2.0, 2.0, 2.0));
/// let p = world_from_object.point(Point3::new(1.0, 0.0, 0.0));
/// assert_eq!(p, Point3::new(3.0, 0.0, 0.0));
/// assert_eq!(world_from_object.inverse().point(p), Point3::new(1.0, 0.0, 0.0));
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Transform {
    forward: DAffine3,
    inverse: DAffine3,
}

impl Default for Transform {
    fn default() -> Self {
        Self::IDENTITY
    }
}

impl Transform {
    /// The map that leaves everything where it is.
    pub const IDENTITY: Self = Self { forward: DAffine3::IDENTITY, inverse: DAffine3::IDENTITY };

    /// From a matrix; `None` where it is singular or not finite.
    pub fn from_affine(forward: DAffine3) -> Option<Self> {
        let determinant = forward.matrix3.determinant();
        if !forward.is_finite() || !determinant.is_finite() || determinant == 0.0 {
            return None;
        }
        let inverse = forward.inverse();
        inverse.is_finite().then_some(Self { forward, inverse })
    }

    /// From three columns (the images of x, y and z) and the image of the origin; `None` where they are degenerate.
    pub fn from_columns(x: Vector3, y: Vector3, z: Vector3, origin: Point3) -> Option<Self> {
        Self::from_affine(DAffine3 { matrix3: DMat3::from_cols(x.0, y.0, z.0), translation: origin.0 })
    }

    /// Moves by `offset`.
    pub fn translate(offset: Vector3) -> Self {
        Self { forward: DAffine3::from_translation(offset.0), inverse: DAffine3::from_translation(-offset.0) }
    }

    /// Scales along the axes.
    ///
    /// # Panics
    /// Where a factor is zero or not finite: the readers refuse those before.
    pub fn scale(factors: Vector3) -> Self {
        assert!(factors.is_finite() && factors.0.cmpne(DVec3::ZERO).all(), "a scale must not be zero: {factors:?}");
        Self { forward: DAffine3::from_scale(factors.0), inverse: DAffine3::from_scale(DVec3::ONE / factors.0) }
    }

    /// Turns about a unit axis by an angle in radians, counter-clockwise seen from the axis's tip.
    pub fn rotate(axis: Vector3, angle: f64) -> Self {
        let (sin, cos) = (portable::sin(0.5 * angle), portable::cos(0.5 * angle));
        let quaternion = DQuat::from_xyzw(axis.x() * sin, axis.y() * sin, axis.z() * sin, cos);
        let matrix3 = DMat3::from_quat(quaternion.normalize());
        Self {
            forward: DAffine3 { matrix3, translation: DVec3::ZERO },
            inverse: DAffine3 { matrix3: matrix3.transpose(), translation: DVec3::ZERO },
        }
    }

    /// The map back.
    pub fn inverse(&self) -> Self {
        Self { forward: self.inverse, inverse: self.forward }
    }

    /// The forward matrix.
    pub fn affine(&self) -> &DAffine3 {
        &self.forward
    }

    /// Where a point goes.
    #[inline]
    pub fn point(&self, p: Point3) -> Point3 {
        Point3(self.forward.transform_point3(p.0))
    }

    /// Where a point comes from.
    #[inline]
    pub fn inverse_point(&self, p: Point3) -> Point3 {
        Point3(self.inverse.transform_point3(p.0))
    }

    /// Where a displacement goes.
    #[inline]
    pub fn vector(&self, v: Vector3) -> Vector3 {
        Vector3(self.forward.transform_vector3(v.0))
    }

    /// Where a displacement comes from.
    #[inline]
    pub fn inverse_vector(&self, v: Vector3) -> Vector3 {
        Vector3(self.inverse.transform_vector3(v.0))
    }

    /// Where a normal goes: by the inverse transpose, not normalised. A mirroring map keeps the outward side outward.
    #[inline]
    pub fn normal(&self, n: Normal3) -> Normal3 {
        Normal3(self.inverse.matrix3.transpose() * n.0)
    }

    /// A ray of the destination in the source's space. The direction is not normalised: `t` means the same in both.
    #[inline]
    pub fn inverse_ray(&self, ray: &Ray) -> Ray {
        Ray { origin: self.inverse_point(ray.origin), direction: self.inverse_vector(ray.direction) }
    }

    /// As [`Transform::point`], a point in each lane, with the same bits.
    #[inline(always)]
    pub fn points<L: Lanes>(&self, p: LaneVector<L>) -> LaneVector<L> {
        product(&self.forward.matrix3, p) + LaneVector::splat(self.forward.translation.to_array())
    }

    /// As [`Transform::inverse_point`], a point in each lane, with the same bits.
    #[inline(always)]
    pub fn inverse_points<L: Lanes>(&self, p: LaneVector<L>) -> LaneVector<L> {
        product(&self.inverse.matrix3, p) + LaneVector::splat(self.inverse.translation.to_array())
    }

    /// As [`Transform::inverse_vector`], a displacement in each lane, with the same bits.
    #[inline(always)]
    pub fn inverse_vectors<L: Lanes>(&self, v: LaneVector<L>) -> LaneVector<L> {
        product(&self.inverse.matrix3, v)
    }

    /// As [`Transform::normal`], a normal in each lane, with the same bits.
    #[inline(always)]
    pub fn normals<L: Lanes>(&self, n: LaneVector<L>) -> LaneVector<L> {
        product(&self.inverse.matrix3.transpose(), n)
    }

    /// The sums of the magnitudes of what [`Transform::points`] adds, for components that are not negative.
    #[inline(always)]
    pub fn terms<L: Lanes>(&self, p: LaneVector<L>) -> LaneVector<L> {
        product(&self.forward.matrix3.abs(), p) + LaneVector::splat(self.forward.translation.abs().to_array())
    }

    /// The box around the image of a box.
    pub fn bounds(&self, b: &Bounds3) -> Bounds3 {
        if b.is_empty() {
            return *b;
        }
        (0..8).fold(Bounds3::EMPTY, |sum, corner| sum.including(self.point(b.corner(corner))))
    }

    /// The factor of a uniform scale, where this map is a rotation, an optional mirroring and a uniform scale (to
    /// within 1e-12); shapes under such a map keep their kind.
    pub fn uniform_scale(&self) -> Option<f64> {
        let [x, y, z] = [self.forward.matrix3.x_axis, self.forward.matrix3.y_axis, self.forward.matrix3.z_axis];
        let square = x.length_squared();
        let same = |v: f64| (v - square).abs() <= 1e-12 * square;
        let perpendicular = |v: f64| v.abs() <= 1e-12 * square;
        let uniform = same(y.length_squared())
            && same(z.length_squared())
            && perpendicular(x.dot(y))
            && perpendicular(y.dot(z))
            && perpendicular(z.dot(x));
        uniform.then(|| square.sqrt())
    }

    /// True where nothing moves.
    pub fn is_identity(&self) -> bool {
        self.forward == DAffine3::IDENTITY
    }
}

impl std::ops::Mul for Transform {
    type Output = Self;
    /// `(a * b)` does `b` first: `world_from_group * group_from_object`.
    fn mul(self, inner: Self) -> Self {
        Self { forward: self.forward * inner.forward, inverse: inner.inverse * self.inverse }
    }
}

/// A matrix times a vector in each lane.
#[inline(always)]
fn product<L: Lanes>(matrix: &DMat3, v: LaneVector<L>) -> LaneVector<L> {
    LaneVector::splat(matrix.x_axis.to_array()) * v.x
        + LaneVector::splat(matrix.y_axis.to_array()) * v.y
        + LaneVector::splat(matrix.z_axis.to_array()) * v.z
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::lanes::{InstructionSet, WIDTH, Work, dispatch};

    #[test]
    fn normals_stay_perpendicular_under_a_skewing_scale() {
        let map = Transform::rotate(Vector3::Y, 0.7) * Transform::scale(Vector3::new(1.0, 4.0, 0.5));
        let (tangent, normal) = (Vector3::new(1.0, -1.0, 0.0), Normal3::new(1.0, 1.0, 0.0));
        assert!(map.normal(normal).dot(map.vector(tangent)).abs() < 1e-14);
        // The twin: a normal moved as if it were a vector is wrong.
        assert!(map.vector(normal.as_vector()).dot(map.vector(tangent)).abs() > 1.0);
    }

    /// A map of eight points, and of the same as vectors and normals.
    struct Maps<'a>(&'a Transform, &'a [[f64; WIDTH]; 3]);

    impl Work for Maps<'_> {
        type Output = [[[f64; WIDTH]; 3]; 4];
        #[inline(always)]
        fn run<L: Lanes>(self) -> Self::Output {
            let (map, mut images) = (self.0, [[[0.0; WIDTH]; 3]; 4]);
            for at in (0..WIDTH).step_by(L::COUNT) {
                let v = LaneVector::<L>::load(self.1, at);
                let all = [map.points(v), map.inverse_points(v), map.inverse_vectors(v), map.normals(v)];
                all.into_iter().zip(&mut images).for_each(|(image, rows)| image.store(rows, at));
            }
            images
        }
    }

    #[test]
    fn lanes_have_the_bits_of_one_at_a_time() {
        let map = Transform::translate(Vector3::new(1e3, -2.0, 0.1))
            * Transform::rotate(Vector3::new(1.0, 1.0, 3.0), 0.7)
            * Transform::scale(Vector3::new(1.0, -4.0, 0.3));
        let rows: [[f64; WIDTH]; 3] =
            std::array::from_fn(|axis| std::array::from_fn(|lane| portable::sin((7 * lane + axis) as f64) * 100.0));
        for set in InstructionSet::available() {
            let images = dispatch(set, Maps(&map, &rows));
            for lane in 0..WIDTH {
                let v = rows.map(|row| row[lane]);
                let expected = [
                    map.point(v.into()).to_array(),
                    map.inverse_point(v.into()).to_array(),
                    map.inverse_vector(v.into()).to_array(),
                    map.normal(Vector3::from(v).into()).to_array(),
                ];
                let found = images.map(|rows| rows.map(|row| row[lane]));
                assert_eq!(found.map(|v| v.map(f64::to_bits)), expected.map(|v| v.map(f64::to_bits)), "{set:?} {lane}");
            }
        }
    }

    #[test]
    fn terms_are_as_large_as_what_they_are_of() {
        let map = Transform::translate(Vector3::new(-5.0, 2.0, 0.1)) * Transform::scale(Vector3::new(1.0, -4.0, 0.5));
        let terms = map.terms(LaneVector::<f64>::splat([1.0, 2.0, 3.0]));
        assert_eq!([terms.x, terms.y, terms.z], [6.0, 10.0, 1.6]);
    }

    #[test]
    fn singular_matrices_are_refused() {
        assert!(Transform::from_columns(Vector3::X, Vector3::X, Vector3::Z, Point3::ORIGIN).is_none());
        assert!(
            Transform::from_columns(Vector3::X, Vector3::new(0.0, f64::NAN, 0.0), Vector3::Z, Point3::ORIGIN).is_none()
        );
    }

    #[test]
    fn uniform_scales_are_recognised() {
        let map = Transform::rotate(Vector3::X, 1.0) * Transform::scale(Vector3::new(3.0, 3.0, 3.0));
        assert!((map.uniform_scale().expect("uniform") - 3.0).abs() < 1e-12);
        assert!(Transform::scale(Vector3::new(1.0, 1.0, 1.1)).uniform_scale().is_none());
    }
}
