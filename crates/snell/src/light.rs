//! Lights without extent, as the lecture has them: where they are, and how much light arrives at a point.

use snell_math::lanes::{Bits, LaneColor, LaneVector, Lanes};
use snell_math::spectrum::Spectrum;
use snell_math::{Point3, Rgb, Vector3, portable};
use snell_scene::scene;

/// A light ready to be asked. World space.
#[derive(Clone, Debug)]
pub struct Light {
    place: Place,
    intensity: Rgb,
    spectrum: Option<Spectrum>,
    falloff: scene::Falloff,
}

#[derive(Clone, Debug)]
enum Place {
    Point { position: Point3 },
    Directional { to_light: Vector3, angle: f64 },
    Spot { position: Point3, axis: Vector3, cosine_cone: f64, cosine_full: f64 },
}

/// Where a light without extent is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum LightOrigin {
    /// At a point of the world.
    Point(Point3),
    /// Infinitely far away in a direction of unit length, seen under an angle in radians.
    Direction(Vector3, f64),
}

/// What one light sends to one point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Illumination {
    /// Towards the light, unit length.
    pub to_light: Vector3,
    /// How far the light is; infinite for a directional one.
    pub distance: f64,
    /// The irradiance on a surface that faces the light, unblocked.
    pub irradiance: Rgb,
}

/// As [`Illumination`], side by side.
#[derive(Clone, Copy, Debug)]
pub struct LaneIllumination<L: Lanes> {
    /// See [`Illumination::to_light`].
    pub to_light: LaneVector<L>,
    /// See [`Illumination::distance`].
    pub distance: L,
    /// See [`Illumination::irradiance`].
    pub irradiance: LaneColor<L::Floats>,
}

impl Light {
    /// From the scene's light.
    pub fn new(light: &scene::Light) -> Self {
        let unit = |v: Vector3| v.try_normalize().unwrap_or(Vector3::Y);
        let place = match light.kind {
            scene::LightKind::Point { position } => Place::Point { position },
            scene::LightKind::Directional { direction, angle } => {
                Place::Directional { to_light: -unit(direction), angle }
            }
            scene::LightKind::Spot { position, direction, cone_angle, full_angle } => Place::Spot {
                position,
                axis: unit(direction),
                cosine_cone: portable::cos(cone_angle),
                cosine_full: portable::cos(full_angle),
            },
        };
        Self { place, intensity: light.intensity, spectrum: light.spectrum.clone(), falloff: light.falloff }
    }

    /// Its colour times its strength, as the scene gives it.
    pub fn intensity(&self) -> Rgb {
        self.intensity
    }

    /// Its spectrum times its strength, where the scene gives one.
    pub fn spectrum(&self) -> Option<&Spectrum> {
        self.spectrum.as_ref()
    }

    /// Where it is; the direction towards it for a directional one.
    pub fn origin(&self) -> LightOrigin {
        match self.place {
            Place::Point { position } | Place::Spot { position, .. } => LightOrigin::Point(position),
            Place::Directional { to_light, angle } => LightOrigin::Direction(to_light, angle),
        }
    }

    /// The share of its strength that it sends in a direction, of unit length: 1 but for the cone of a spot.
    pub fn share_in(&self, direction: Vector3) -> f64 {
        match self.place {
            Place::Point { .. } | Place::Directional { .. } => 1.0,
            Place::Spot { axis, cosine_cone, cosine_full, .. } => {
                let cosine = axis.dot(direction);
                if cosine <= cosine_cone {
                    0.0
                } else if cosine < cosine_full {
                    let x = (cosine - cosine_cone) / (cosine_full - cosine_cone);
                    x * x * (3.0 - 2.0 * x)
                } else {
                    1.0
                }
            }
        }
    }

    /// What is left of its strength at a distance, times the square of that distance: over what the spreading of rays does by
    /// itself. 1 for a light that falls off as real light does, and for a directional one.
    pub fn spread_at(&self, distance: f64) -> f64 {
        match (&self.place, self.falloff) {
            (Place::Directional { .. }, _) | (_, scene::Falloff::InverseSquare) => 1.0,
            _ => self.falloff_lanes(distance) * (distance * distance),
        }
    }

    /// What arrives at a world point; `None` where it is nothing: outside a spot's cone, or at the light itself.
    #[inline]
    pub fn illuminate(&self, point: Point3) -> Option<Illumination> {
        let (lit, LaneIllumination { to_light, distance, irradiance }) = self.illuminate_lanes::<f64>(point.into());
        let irradiance = Rgb::new(irradiance.r, irradiance.g, irradiance.b);
        lit.any().then(|| Illumination { to_light: to_light.into(), distance, irradiance })
    }

    /// As [`Light::illuminate`], for points side by side: which lanes are lit, and how.
    #[inline(always)]
    pub fn illuminate_lanes<L: Lanes>(&self, point: LaneVector<L>) -> (Bits, LaneIllumination<L>) {
        let intensity = LaneColor::splat(self.intensity);
        let position = match &self.place {
            Place::Directional { to_light, .. } => {
                let to_light = LaneVector::splat(to_light.to_array());
                let distance = L::splat(f64::INFINITY);
                return (L::all(), LaneIllumination { to_light, distance, irradiance: intensity });
            }
            Place::Point { position } | Place::Spot { position, .. } => LaneVector::splat(position.to_array()),
        };
        let (zero, one) = (L::splat(0.0), L::splat(1.0));
        let offset = position - point;
        let distance = offset.length_squared().sqrt();
        let mut lit = L::all().without(distance.le(zero));
        let to_light = offset * (one / distance);
        let mut share = self.falloff_lanes(distance);
        if let Place::Spot { axis, cosine_cone, cosine_full, .. } = self.place {
            let cosine = -LaneVector::splat(axis.to_array()).dot(to_light);
            lit = lit.without(cosine.le(L::splat(cosine_cone)));
            let in_rim = cosine.lt(L::splat(cosine_full));
            if in_rim.any() {
                let x = (cosine - L::splat(cosine_cone)) / L::splat(cosine_full - cosine_cone);
                share = (share * (x * x * (L::splat(3.0) - L::splat(2.0) * x))).or_where_not(in_rim, share);
            }
        }
        (lit, LaneIllumination { to_light, distance, irradiance: intensity * share.to_floats() })
    }

    #[inline(always)]
    fn falloff_lanes<L: Lanes>(&self, distance: L) -> L {
        let one = L::splat(1.0);
        match self.falloff {
            scene::Falloff::None => one,
            scene::Falloff::Linear => one / distance,
            scene::Falloff::InverseSquare => one / (distance * distance),
            scene::Falloff::Polynomial { constant, linear, quadratic } => {
                let (constant, linear, quadratic) = (L::splat(constant), L::splat(linear), L::splat(quadratic));
                let share = one / (constant + distance * (linear + distance * quadratic));
                share.or_where_not(share.lt(one), one)
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn light(kind: scene::LightKind, falloff: scene::Falloff) -> Light {
        Light::new(&scene::Light { name: None, kind, intensity: Rgb::gray(8.0), spectrum: None, falloff })
    }

    #[test]
    fn falloffs_follow_their_formulas() {
        let at = |falloff| {
            light(scene::LightKind::Point { position: Point3::new(0.0, 2.0, 0.0) }, falloff)
                .illuminate(Point3::ORIGIN)
                .expect("lit")
                .irradiance
                .r
        };
        assert_eq!(at(scene::Falloff::None), 8.0);
        assert_eq!(at(scene::Falloff::Linear), 4.0);
        assert_eq!(at(scene::Falloff::InverseSquare), 2.0);
        assert_eq!(at(scene::Falloff::Polynomial { constant: 1.0, linear: 0.5, quadratic: 0.5 }), 2.0);
        assert_eq!(at(scene::Falloff::Polynomial { constant: 0.0, linear: 0.0, quadratic: 0.1 }), 8.0);
    }

    #[test]
    fn a_spot_is_full_inside_dark_outside_and_smooth_between() {
        let (cone_angle, full_angle) = (portable::radians(30.0), portable::radians(20.0));
        let spot = light(
            scene::LightKind::Spot {
                position: Point3::ORIGIN,
                direction: Vector3::new(0.0, -2.0, 0.0),
                cone_angle,
                full_angle,
            },
            scene::Falloff::None,
        );
        let at = |degrees: f64| {
            let angle = portable::radians(degrees);
            let point = Point3::new(portable::sin(angle), -portable::cos(angle), 0.0);
            spot.illuminate(point).map_or(0.0, |i| i.irradiance.r)
        };
        assert_eq!(at(0.0), 8.0);
        assert_eq!(at(19.9), 8.0);
        assert_eq!(at(30.1), 0.0);
        assert!(at(22.0) > at(25.0) && at(25.0) > at(28.0) && at(29.9) < 0.01);
        assert_eq!(at(180.0), 0.0);
    }

    #[test]
    fn a_light_at_the_point_itself_gives_nothing() {
        let point = light(scene::LightKind::Point { position: Point3::ORIGIN }, scene::Falloff::InverseSquare);
        assert_eq!(point.illuminate(Point3::ORIGIN), None);
    }
}
