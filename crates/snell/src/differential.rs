//! How the rays of neighbouring samples differ from a ray, and so which part of a surface or of the sky it stands for.
//!
//! Igehy, "Tracing Ray Differentials", SIGGRAPH 1999: the first derivatives of a ray by the two coordinates of the picture,
//! here for a step from one sample to the next, to the right and down. World space throughout; directions have unit length.

use snell_math::{Ray, Vector3};

/// How a ray changes from one sample to the next: for a step to the right in the picture and for one down.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RayDifferential {
    /// How its origin moves, world units.
    pub origin: [Vector3; 2],
    /// How its direction turns.
    pub direction: [Vector3; 2],
}

impl Default for RayDifferential {
    fn default() -> Self {
        Self::NONE
    }
}

impl RayDifferential {
    /// Of a ray without neighbours: it sees points.
    pub const NONE: Self = Self { origin: [Vector3::ZERO; 2], direction: [Vector3::ZERO; 2] };

    /// Of a ray whose neighbours to the right and below are known.
    ///
    /// ```
    /// use snell::differential::RayDifferential;
    /// use snell::math::{Point3, Ray, Vector3};
    /// let ray = |x, y| Ray::new(Point3::new(x, y, 0.0), Vector3::Z);
    /// let differential = RayDifferential::between(&ray(0.0, 0.0), [&ray(0.5, 0.0), &ray(0.0, -0.5)]);
    /// assert_eq!(differential.origin, [Vector3::new(0.5, 0.0, 0.0), Vector3::new(0.0, -0.5, 0.0)]);
    /// assert_eq!(differential.direction, [Vector3::ZERO; 2]);
    /// ```
    #[must_use]
    pub fn between(ray: &Ray, neighbours: [&Ray; 2]) -> Self {
        Self {
            origin: neighbours.map(|other| other.origin - ray.origin),
            direction: neighbours.map(|other| other.direction - ray.direction),
        }
    }

    /// Where the neighbours are at a distance along the ray, relative to it.
    #[must_use]
    pub fn at(&self, t: f64) -> Self {
        Self { origin: [0, 1].map(|i| self.origin[i] + self.direction[i] * t), ..*self }
    }

    /// Where the neighbours of a ray meet a plane that it meets at a distance, relative to it; only the orientation of the
    /// plane's normal matters. (Igehy 1999, equations 10 to 12.)
    ///
    /// ```
    /// use snell::differential::RayDifferential;
    /// use snell::math::Vector3;
    /// // Under 60 degrees a beam of width 1 covers 2 of a plane.
    /// let beam = RayDifferential { origin: [Vector3::X, Vector3::Y], ..RayDifferential::NONE };
    /// let normal = Vector3::new(0.75_f64.sqrt(), 0.0, -0.5);
    /// let [along, across] = beam.on_plane(Vector3::Z, 1.0, normal).origin;
    /// assert!((along.length() - 2.0).abs() < 1e-12 && along.dot(normal).abs() < 1e-12);
    /// assert_eq!(across, Vector3::Y);
    /// ```
    #[must_use]
    pub fn on_plane(&self, direction: Vector3, t: f64, normal: Vector3) -> Self {
        let there = self.at(t);
        let facing = direction.dot(normal);
        Self { origin: there.origin.map(|offset| offset - direction * (offset.dot(normal) / facing)), ..there }
    }
}

/// How a surface changes from one sample to the next where a ray meets it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SurfaceDifferential {
    /// Where the neighbours meet the surface, and how their directions differ.
    pub arriving: RayDifferential,
    /// The unit normal by which the ray is reflected and refracted, on either side.
    pub normal: Vector3,
    /// How it turns from the ray to its neighbours.
    pub turns: [Vector3; 2],
}

impl SurfaceDifferential {
    /// Of a ray without neighbours.
    pub const NONE: Self = Self { arriving: RayDifferential::NONE, normal: Vector3::ZERO, turns: [Vector3::ZERO; 2] };

    /// The normal on the side where a ray comes from, with its turns.
    fn facing(&self, direction: Vector3) -> (Vector3, [Vector3; 2]) {
        if direction.dot(self.normal) > 0.0 {
            (-self.normal, self.turns.map(|turn| -turn))
        } else {
            (self.normal, self.turns)
        }
    }

    /// Of the mirrored ray of one that came in a direction. (Igehy 1999, equations 14 and 15.)
    #[must_use]
    pub fn reflected(&self, direction: Vector3) -> RayDifferential {
        let (normal, turns) = self.facing(direction);
        let cosine = direction.dot(normal);
        let turned = |i: usize| {
            let change = self.arriving.direction[i];
            let of_cosine = change.dot(normal) + direction.dot(turns[i]);
            change - (turns[i] * cosine + normal * of_cosine) * 2.0
        };
        finite(RayDifferential { origin: self.arriving.origin, direction: [turned(0), turned(1)] })
    }

    /// Of the refracted ray of one that came in a direction; `eta` is the index where it comes from over that where it goes.
    /// Under total internal reflection none. (Igehy 1999, equations 16 to 18.)
    #[must_use]
    pub fn refracted(&self, direction: Vector3, eta: f64) -> RayDifferential {
        let (normal, turns) = self.facing(direction);
        let cosine = direction.dot(normal);
        // Minus the cosine beyond.
        let beyond = -(1.0 - eta * eta * (1.0 - cosine * cosine)).max(0.0).sqrt();
        let mu = eta * cosine - beyond;
        let turned = |i: usize| {
            let change = self.arriving.direction[i];
            let of_cosine = change.dot(normal) + direction.dot(turns[i]);
            let of_mu = (eta - eta * eta * cosine / beyond) * of_cosine;
            change * eta - (turns[i] * mu + normal * of_mu)
        };
        finite(RayDifferential { origin: self.arriving.origin, direction: [turned(0), turned(1)] })
    }
}

/// The same, or none where it is no number or infinite, as at the edge of total internal reflection.
fn finite(differential: RayDifferential) -> RayDifferential {
    let RayDifferential { origin, direction } = differential;
    if origin.iter().chain(&direction).all(|v| v.is_finite()) { differential } else { RayDifferential::NONE }
}
