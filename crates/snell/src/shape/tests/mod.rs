//! Random shapes with independently written distance functions, random and degenerate rays, for the tests of this folder.

mod degenerate;
mod hits;
mod lanes;
mod spawning;
mod surfaces;

use snell_math::{Point3, Ray, Vector3};

use super::{Cuboid, Disk, Frustum, Plane, Rectangle, Shape, Sphere, Torus};

/// Deterministic random numbers: SplitMix64 (Steele, Lea, Flood, OOPSLA 2014).
pub(crate) struct Random(pub(crate) u64);

impl Random {
    pub(crate) fn bits(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    /// In [0, 1).
    pub(crate) fn unit(&mut self) -> f64 {
        (self.bits() >> 11) as f64 / (1u64 << 53) as f64
    }

    pub(crate) fn range(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.unit()
    }

    pub(crate) fn below(&mut self, n: u64) -> u64 {
        self.bits() % n
    }

    /// A unit vector; along an axis, with zeros of both signs, one time in four.
    pub(crate) fn direction(&mut self) -> Vector3 {
        if self.below(4) == 0 {
            let sign = |bits: u64| if bits & 1 == 1 { -1.0 } else { 1.0 };
            let mut v = [0.0 * sign(self.bits()), 0.0 * sign(self.bits()), 0.0 * sign(self.bits())];
            v[self.below(3) as usize] = sign(self.bits());
            return Vector3::from(v);
        }
        loop {
            let v = Vector3::new(self.range(-1.0, 1.0), self.range(-1.0, 1.0), self.range(-1.0, 1.0));
            if (0.01..1.0).contains(&v.length()) {
                return v.normalize();
            }
        }
    }

    pub(crate) fn vector_in_ball(&mut self, radius: f64) -> Vector3 {
        let length = radius * self.unit();
        self.direction() * length
    }
}

/// A distance to a surface, negative inside where there is one.
type Distance = Box<dyn Fn(Point3) -> f64>;

/// A shape, and what is known about it without its code.
pub(crate) struct Fixture {
    pub(crate) shape: Shape,
    /// Lower bound of the distance to the surface, with its sign.
    pub(crate) distance: Distance,
    pub(crate) center: Point3,
    /// Radius of a sphere around the centre that holds it (for a plane: that is looked at).
    pub(crate) size: f64,
    /// A corner, apex or pole.
    pub(crate) tip: Point3,
}

/// Sizes of everything are around `scale`, somewhere around `center`. Kinds 0 to 5 are solid and all but the torus (5)
/// are convex; 6 and 7 are flat.
pub(crate) fn fixture(random: &mut Random, kind: u64, center: Point3, scale: f64) -> Fixture {
    let (a, b) = (scale * random.range(0.3, 1.0), scale * random.range(0.3, 1.0));
    let axis = random.direction();
    match kind {
        0 => Fixture {
            shape: Shape::Sphere(Sphere::new(center, a)),
            distance: Box::new(move |p| (p - center).length() - a),
            center,
            size: a,
            tip: center + axis * a,
        },
        1 => Fixture {
            shape: Shape::Plane(Plane::new(center, axis)),
            distance: Box::new(move |p| (p - center).dot(axis)),
            center,
            size: scale,
            tip: center,
        },
        2 => {
            let half = Vector3::new(a, b, scale * random.range(0.3, 1.0));
            let (min, max) = (center - half, center + half);
            Fixture {
                shape: Shape::Box(Cuboid::new(min, max)),
                distance: Box::new(move |p| (min.0 - p.0).max(p.0 - max.0).max_element()),
                center,
                size: half.length(),
                tip: max,
            }
        }
        3 | 4 => {
            // Of any slenderness, the cone also with an apex or nearly so, either end up.
            let length = 2.0 * scale * [1.0, 1e-2, 0.3][random.below(3) as usize];
            let other = if kind == 3 { a } else { b * [0.0, 1.0, 1e-3, 0.99][random.below(4) as usize] };
            let (r0, r1) = if random.below(2) == 0 { (a, other) } else { (other, a) };
            let (base, top) = (center - axis * (0.5 * length), center + axis * (0.5 * length));
            let frustum = Frustum::new(base, r0, top, r1, true);
            let slant = ((r1 - r0) / length) * ((r1 - r0) / length) + 1.0;
            Fixture {
                shape: if kind == 3 { Shape::Cylinder(frustum) } else { Shape::Cone(frustum) },
                distance: Box::new(move |p| {
                    let z = (p - base).dot(axis);
                    let side = (p - base - axis * z).length() - (r0 + (r1 - r0) * z / length);
                    (side / slant.sqrt()).max(-z).max(z - length)
                }),
                center,
                size: length + r0.max(r1),
                tip: if r0 < r1 { base } else { top },
            }
        }
        5 => {
            let minor = a * [0.99, 0.5, 1e-2, 1e-4][random.below(4) as usize];
            Fixture {
                shape: Shape::Torus(Torus::new(center, axis, a, minor)),
                distance: Box::new(move |p| {
                    let z = (p - center).dot(axis);
                    let from_circle = (p - center - axis * z).length() - a;
                    (from_circle * from_circle + z * z).sqrt() - minor
                }),
                center,
                size: a + minor,
                tip: center + axis.orthonormal_basis().0 * (a - minor),
            }
        }
        6 => Fixture {
            shape: Shape::Disk(Disk::new(center, axis, a, 0.3 * a)),
            distance: Box::new(move |p| (p - center).dot(axis)),
            center,
            size: a,
            tip: center,
        },
        _ => {
            let (x, y) = axis.orthonormal_basis();
            Fixture {
                shape: Shape::Rectangle(Rectangle::new(center - x * (0.5 * a) - y * (0.5 * b), [x * a, y * b])),
                distance: Box::new(move |p| (p - center).dot(axis)),
                center,
                size: a + b,
                tip: center,
            }
        }
    }
}

/// A ray that looks at the fixture in one of many ways, some of them degenerate, with a direction of any length.
pub(crate) fn ray_at(random: &mut Random, fixture: &Fixture, distance: f64) -> Ray {
    let Fixture { center, size, tip, .. } = *fixture;
    let origin = center + random.vector_in_ball(distance);
    let length = [1.0, 1e-3, 40.0][random.below(3) as usize];
    let direction = match random.below(8) {
        // Through the centre.
        0 => center - origin,
        // Along an axis or anywhere, from close by.
        1 => return Ray::new(center + random.vector_in_ball(1.5 * size), random.direction() * length),
        // From the centre.
        2 => return Ray::new(center, random.direction() * length),
        // Near the tip, by any order of magnitude.
        3 => {
            let miss = [0.0, 1e-15, 1e-12, 1e-8, 1e-4, 1e-2][random.below(6) as usize];
            tip + random.vector_in_ball(size * miss) - origin
        }
        _ => center + random.vector_in_ball(size) - origin,
    };
    let direction = direction.try_normalize().unwrap_or(Vector3::X);
    Ray::new(origin, direction * length)
}
