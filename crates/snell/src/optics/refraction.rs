//! The refracted direction, by Snell's law, and total internal reflection.
//!
//! Follows: CS5310, lecture 3, "Refraction"; Heckbert and Hanrahan, "Beam Tracing Polygonal Objects", SIGGRAPH 1984,
//! appendix. η = η_i / η_t throughout; cosines with the normal are those of the angles in [0, π/2].

use snell_math::lanes::{Bits, LaneVector, Lanes};
use snell_math::{Normal3, Vector3, portable};

/// The square of the transmitted ray's cosine; negative under total internal reflection.
///
/// The textbook's 1 − η² (1 − c²), but summed as (1 − η²) + (η c)²: exact where η = 1, and for η < 1 a sum of positive
/// numbers, so that nothing cancels at grazing angles.
#[inline(always)]
pub(super) fn cos_transmitted_squared<L: Lanes>(cos_i: L, eta: L) -> L {
    let one = L::splat(1.0);
    (one - eta) * (one + eta) + (eta * cos_i) * (eta * cos_i)
}

/// The cosine of the angle between the transmitted ray and the normal, or `None` under total internal reflection.
#[inline]
#[must_use]
pub fn cos_transmitted(cos_i: f64, eta: f64) -> Option<f64> {
    let squared = cos_transmitted_squared(cos_i, eta);
    (squared >= 0.0).then(|| squared.sqrt())
}

/// The direction in which light goes on behind a boundary, or `None` where there is total internal reflection:
/// T = (η (N·I) − √(1 − η² (1 − (N·I)²))) N − η I.
///
/// `wo` is the lecture's I: it leaves the surface, against the incident ray, on the side of `normal`. `eta` is the
/// index of refraction there over that behind. The result leaves the surface on the other side and is made unit length
/// after rounding. At the critical angle itself it is tangent to the surface, and carries no light.
///
/// ```
/// use snell::optics::refract;
/// use snell_math::{Normal3, Vector3};
/// let up = Normal3::new(0.0, 1.0, 0.0);
/// let into_water = refract(Vector3::new(0.6, 0.8, 0.0), up, 1.0 / 1.333).unwrap();
/// assert!((into_water.x() + 0.6 / 1.333).abs() < 1e-15, "sin θ_t = sin θ_i / 1.333, on the other side of the normal");
/// assert_eq!(refract(Vector3::new(0.8, 0.6, 0.0), up, 1.333), None);
/// ```
#[inline]
#[must_use]
pub fn refract(wo: Vector3, normal: Normal3, eta: f64) -> Option<Vector3> {
    let (refracts, direction) = refract_lanes::<f64>(wo.into(), normal.into(), eta);
    refracts.any().then(|| direction.into())
}

/// As [`refract`], side by side: the lanes where light goes on, and where it goes.
#[inline(always)]
#[must_use]
pub fn refract_lanes<L: Lanes>(wo: LaneVector<L>, normal: LaneVector<L>, eta: L) -> (Bits, LaneVector<L>) {
    let cos_i = normal.dot(wo);
    let squared = cos_transmitted_squared(cos_i, eta);
    let refracts = squared.ge(L::splat(0.0));
    let cos_t = squared.sqrt();
    (refracts, (normal * (eta * cos_i - cos_t) - wo * eta).normalize())
}

/// The angle of incidence in radians beyond which all light is reflected, for light that goes from `eta_i` towards
/// `eta_t`; `None` where the far side is not the thinner one.
///
/// ```
/// use snell::optics::critical_angle;
/// assert!((critical_angle(1.5, 1.0).unwrap().to_degrees() - 41.810).abs() < 1e-3);
/// assert_eq!(critical_angle(1.0, 1.5), None);
/// ```
#[inline]
#[must_use]
pub fn critical_angle(eta_i: f64, eta_t: f64) -> Option<f64> {
    (eta_i > eta_t).then(|| portable::asin(eta_t / eta_i))
}
