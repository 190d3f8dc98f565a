//! Light that sets out from lights towards what reflects and refracts it: where it begins, where it goes, and how likely that was.
//!
//! Only light that meets glass or a mirror is of use here, so directions are chosen within the cones in which bodies that are specular
//! are seen, and light from far away begins on the disks that they take up (Jensen, "Realistic Image Synthesis Using Photon
//! Mapping", 2001, section 5.2, calls it projection maps). World space.

use std::f64::consts::PI;

use snell_math::warp::{Cone, uniform_disk};
use snell_math::{Bounds3, Point3, Vector3};

use super::lights::{LightIndex, Lights, chosen, within};
use super::spectra::{BLACK, Colors, Spectral, Wavelengths, scaled};
use crate::compile::CompiledScene;
use crate::light::LightOrigin;
use crate::texture::SeenAtOnce;

/// Up to so many bodies are aimed at one by one.
const SINGLE_TARGETS: usize = 16;

/// What light is sent to: spheres around bodies that are specular.
#[derive(Clone, Debug)]
pub struct Targets {
    spheres: Vec<(Point3, f64)>,
    /// A sphere around everything that has bounds.
    whole: (Point3, f64),
}

/// Light that sets out.
#[derive(Clone, Copy, Debug)]
pub struct Emitted {
    /// Where it begins.
    pub origin: Point3,
    /// Where it goes, unit length.
    pub direction: Vector3,
    /// Its power, over the density of the choice of light, place and direction.
    pub power: Spectral,
    /// That density over the cosine with the surface of the light, or of a disk across its way; infinite for a light without extent,
    /// which nothing meets by chance.
    pub density: f64,
    /// Which light.
    pub light: LightIndex,
}

impl Targets {
    /// From boxes around bodies that are specular, and of everything; `None` where there are none. One without bounds makes everything
    /// a target.
    pub fn new(boxes: &[Bounds3], everything: &Bounds3) -> Option<Self> {
        let whole = sphere_around(everything)?;
        if boxes.is_empty() {
            return None;
        }
        let spheres: Option<Vec<(Point3, f64)>> = boxes.iter().map(sphere_around).collect();
        let spheres = match spheres {
            None => vec![whole],
            Some(spheres) if spheres.len() <= SINGLE_TARGETS => spheres,
            Some(_) => {
                let all = boxes.iter().fold(Bounds3::EMPTY, |sum, bounds| sum.union(bounds));
                vec![sphere_around(&all)?]
            }
        };
        Some(Self { spheres, whole })
    }

    /// A direction from a point towards one of them, by a number in [0, 1) for which and two for where.
    fn sample(&self, from: Point3, choice: f64, u: [f64; 2]) -> Option<Vector3> {
        let (center, radius) = self.spheres[self.pick(choice)];
        Some(Cone::around_sphere(from, center, radius)?.sample(u))
    }

    /// The density of that choice, per steradian.
    fn density(&self, from: Point3, direction: Vector3) -> f64 {
        let of = |&(center, radius): &(Point3, f64)| {
            Cone::around_sphere(from, center, radius).map_or(0.0, |cone| cone.density(direction))
        };
        self.spheres.iter().map(of).sum::<f64>() / self.spheres.len() as f64
    }

    fn pick(&self, choice: f64) -> usize {
        ((choice * self.spheres.len() as f64) as usize).min(self.spheres.len() - 1)
    }

    /// The density, per unit of area across a direction, with which ways to one of them are chosen.
    fn density_across(&self, place: Point3, direction: Vector3) -> f64 {
        let of = |&(center, radius): &(Point3, f64)| {
            let offset = center - place;
            let beside = offset - direction * offset.dot(direction);
            if beside.length_squared() <= radius * radius { 1.0 / (PI * radius * radius) } else { 0.0 }
        };
        self.spheres.iter().map(of).sum::<f64>() / self.spheres.len() as f64
    }

    /// A way in a direction through one of them, from outside of everything.
    fn sample_across(&self, direction: Vector3, choice: f64, u: [f64; 2]) -> Point3 {
        let (center, radius) = self.spheres[self.pick(choice)];
        let (x, y) = direction.orthonormal_basis();
        let [a, b] = uniform_disk(u);
        let place = center + x * (a * radius) + y * (b * radius);
        let (middle, reach) = self.whole;
        place - direction * ((place - middle).dot(direction) + 2.0 * reach)
    }

    /// How much of a sphere around a point they take up, roughly: in [0, 4π].
    fn solid_angle(&self, from: Point3) -> f64 {
        let of = |&(center, radius): &(Point3, f64)| {
            Cone::around_sphere(from, center, radius).map_or(0.0, |cone| cone.solid_angle())
        };
        self.spheres.iter().map(of).sum::<f64>().min(4.0 * PI)
    }

    /// How much of all directions a light takes up, seen from the nearest of them, roughly.
    fn share_of_directions(&self, scene: &CompiledScene, lights: &Lights, index: LightIndex) -> f64 {
        match index {
            LightIndex::Point(number) => match scene.lights[lights.points[number].0 as usize].origin() {
                LightOrigin::Point(_) => 0.0,
                LightOrigin::Direction(_, angle) => angle * angle / 64.0,
            },
            LightIndex::Surface(number) => {
                let surface = &lights.surfaces[number].place.surface;
                let (place, _) = surface.bounding_sphere();
                let distances = self.spheres.iter().map(|(center, _)| center.distance(place));
                let nearest = distances.fold(f64::INFINITY, f64::min);
                surface.area() / (4.0 * PI * nearest * nearest)
            }
            LightIndex::Environment => 1.0,
        }
    }

    /// The area of their disks.
    fn area(&self) -> f64 {
        self.spheres.iter().map(|(_, radius)| PI * radius * radius).sum()
    }
}

/// A sphere around a box; `None` for one without bounds, or empty.
fn sphere_around(bounds: &Bounds3) -> Option<(Point3, f64)> {
    if !bounds.is_finite() {
        return None;
    }
    let center = bounds.min.lerp(bounds.max, 0.5);
    // A little more, so that nothing of the box is outside by rounding.
    let radius = center.distance(bounds.max) * (1.0 + 1e-9);
    (radius > 0.0).then_some((center, radius))
}

/// How light sets out from the lights of a scene.
#[derive(Debug)]
pub struct Emission {
    targets: Targets,
    /// The probability of each light, in the order of [`Lights::all`].
    probabilities: Vec<f64>,
    /// Which of them are so small that no path finds them by chance.
    is_small: Vec<bool>,
}

/// A light is small where it takes up less than this share of all directions.
const SMALL: f64 = 1e-3;

impl Emission {
    /// From the lights of a scene towards targets; `None` where no light reaches them.
    pub fn new(scene: &CompiledScene, lights: &Lights, targets: Targets) -> Option<Self> {
        let power = |index: LightIndex| match index {
            LightIndex::Point(number) => {
                let light = &scene.lights[lights.points[number].0 as usize];
                let of_target = |&(center, radius): &(Point3, f64)| {
                    let Some(arriving) = light.illuminate(center) else {
                        return f64::from(light.intensity().mean()) * 1e-3;
                    };
                    let distance = arriving.distance.min(1e12).max(radius);
                    let irradiance = PI * f64::from(arriving.irradiance.mean());
                    if arriving.distance.is_finite() && distance <= radius {
                        irradiance * distance * distance * 4.0 * PI
                    } else {
                        irradiance * PI * radius * radius
                    }
                };
                targets.spheres.iter().map(of_target).sum()
            }
            LightIndex::Surface(number) => {
                let emitter = &lights.surfaces[number];
                let (center, _) = emitter.place.surface.bounding_sphere();
                emitter.mean() * emitter.place.surface.area() * targets.solid_angle(center).min(PI)
            }
            LightIndex::Environment => {
                lights.environment.as_ref().map_or(0.0, |environment| environment.mean() * 4.0 * PI * targets.area())
            }
        };
        let powers: Vec<f64> = lights.all().map(power).collect();
        let sum: f64 = powers.iter().sum();
        if !(sum > 0.0 && sum.is_finite()) {
            return None;
        }
        let is_small = lights.all().map(|index| targets.share_of_directions(scene, lights, index) < SMALL).collect();
        let probabilities = powers.into_iter().map(|power| power / sum).collect();
        Some(Self { targets, probabilities, is_small })
    }

    /// True of a light whose photons are kept in media: a small one. They are gathered there from balls, which blur more than disks, and
    /// reach beyond the bounds of a body, while paths find a large light behind any boundary.
    pub fn serves_media(&self, lights: &Lights, light: LightIndex) -> bool {
        self.is_small.get(lights.number(light)).is_some_and(|is_small| *is_small)
    }

    /// True where there is such a light.
    pub fn has_small_light(&self) -> bool {
        self.is_small.contains(&true)
    }

    /// Light that sets out, by a number in [0, 1) for the light, one for the target, two for the direction or the way, two for the
    /// place on the light or the direction of the background.
    #[expect(clippy::too_many_arguments, reason = "what light depends on, and six random numbers")]
    pub fn sample(
        &self,
        scene: &CompiledScene,
        lights: &Lights,
        colors: &Colors,
        wavelengths: &Wavelengths,
        [choice, target]: [f64; 2],
        way: [f64; 2],
        place: [f64; 2],
    ) -> Option<Emitted> {
        let (light, probability) = chosen(lights.all().zip(self.probabilities.iter().copied()), choice)?;
        match light {
            LightIndex::Point(number) => {
                let (of_scene, spectrum) = &lights.points[number];
                let of_scene = &scene.lights[*of_scene as usize];
                let spectrum = wavelengths.nm().map(|nm| spectrum.at(nm));
                match of_scene.origin() {
                    LightOrigin::Point(origin) => {
                        let direction = self.targets.sample(origin, target, way)?;
                        let density = probability * self.targets.density(origin, direction);
                        // The cone of a spot; how its light falls off is taken where it arrives.
                        let share = of_scene.share_in(direction);
                        let power = scaled(spectrum, PI * share / density);
                        (share > 0.0).then_some(Emitted { origin, direction, power, density: f64::INFINITY, light })
                    }
                    LightOrigin::Direction(to_light, angle) => {
                        let direction = -within(to_light, angle, place);
                        let origin = self.targets.sample_across(direction, target, way);
                        let density = probability * self.targets.density_across(origin, direction);
                        let power = scaled(spectrum, PI / density);
                        Some(Emitted { origin, direction, power, density: f64::INFINITY, light })
                    }
                }
            }
            LightIndex::Surface(number) => {
                let emitter = &lights.surfaces[number];
                let point = emitter.place.surface.sample_area(place)?;
                let direction = self.targets.sample(point.point, target, way)?;
                let cosine = point.normal.dot(direction);
                if cosine == 0.0 || emitter.one_sided && cosine < 0.0 {
                    return None;
                }
                let density = probability * point.density * self.targets.density(point.point, direction);
                let radiance = match &emitter.radiance {
                    Some(radiance) => wavelengths.nm().map(|nm| radiance.at(nm)),
                    // Unknown until it is met from there, which light that sets out is not.
                    None => BLACK,
                };
                // Off its surface, by more than rounding does to places of it.
                let (center, reach) = emitter.place.surface.bounding_sphere();
                let rounding = 64.0 * f64::EPSILON * (center.max_abs() + reach);
                let origin = point.point + point.normal * rounding.copysign(cosine);
                let power = scaled(radiance, cosine.abs() / density);
                Some(Emitted { origin, direction, power, density: density / cosine.abs(), light })
            }
            LightIndex::Environment => {
                let (to_light, density) = lights.environment.as_ref()?.sample(place)?;
                let direction = -to_light;
                let origin = self.targets.sample_across(direction, target, way);
                let density = probability * density * self.targets.density_across(origin, direction);
                let radiance = lights.environment_radiance(colors, wavelengths, scene, to_light, &SeenAtOnce::POINT);
                Some(Emitted { origin, direction, power: scaled(radiance, 1.0 / density), density, light })
            }
        }
    }

    /// [`Emitted::density`] of light that sets out from a place of a surface in a direction, which a path found there.
    pub fn density_of_surface(
        &self,
        lights: &Lights,
        light: LightIndex,
        place: Point3,
        normal: Vector3,
        direction: Vector3,
    ) -> f64 {
        let LightIndex::Surface(number) = light else { return 0.0 };
        let emitter = &lights.surfaces[number];
        if emitter.radiance.is_none() {
            return 0.0;
        }
        let cosine = normal.dot(direction).abs();
        let probability = self.probabilities[lights.number(light)];
        probability / emitter.place.surface.area() * self.targets.density(place, direction) / cosine
    }

    /// And of light of the background that goes through a place in a direction.
    pub fn density_of_environment(&self, lights: &Lights, place: Point3, direction: Vector3) -> f64 {
        let Some(environment) = &lights.environment else { return 0.0 };
        let probability = self.probabilities[lights.number(LightIndex::Environment)];
        probability * environment.density(-direction) * self.targets.density_across(place, direction)
    }
}
