//! Everything that gives off light, for paths: lights without extent, surfaces that shine, and the background.
//!
//! A light is chosen by what it would give a point if nothing were in the way, roughly: its irradiance. Lights without extent have the
//! lecture's units, in which a white matt surface that faces an intensity of one is one: π times the physical irradiance.

use std::f64::consts::PI;

use snell_math::spectrum::{SmoothEmission, Spectrum};
use snell_math::warp::Cone;
use snell_math::{Point3, Rgb, Vector3, portable};

use super::environment::Environment;
use super::spectra::{Colors, Spectral, Wavelengths, scaled};
use crate::compile::CompiledScene;
use crate::geometry::EmittingSurface;
use crate::interaction::{SolidId, SurfaceInteraction};
use crate::light::LightOrigin;
use crate::texture::{SeenAtOnce, ViewProjection};

/// Up to so many lights are weighed anew at every point; more are chosen by their power.
const WEIGHED: usize = 32;
/// For this share of choices each light is as likely as another.
const EVEN: f64 = 0.2;

/// All lights of a scene.
#[derive(Debug)]
pub struct Lights {
    /// Those of the scene that give light at all: their number there and their spectrum at intensity one.
    pub points: Vec<(u32, Spectrum)>,
    /// The surfaces that shine.
    pub surfaces: Vec<Emitter>,
    /// The background, where it is not black.
    pub environment: Option<Environment>,
    /// For each surface, the body and material by which it is found, and its place.
    by_body: Vec<((SolidId, u32), u32)>,
    /// The number of the first surface among the names of lights.
    first_surface: u32,
}

/// A surface that shines.
#[derive(Debug)]
pub struct Emitter {
    /// Where it is.
    pub place: EmittingSurface,
    /// Its radiance, where it is the same everywhere.
    pub radiance: Option<Spectrum>,
    /// Light comes from the outward side alone.
    pub one_sided: bool,
    /// The mean radiance, a guess where it is not the same everywhere.
    mean: f64,
}

impl Emitter {
    /// The mean radiance, a guess where it is not the same everywhere.
    pub fn mean(&self) -> f64 {
        self.mean
    }
}

/// The spectrum that the scene gives, or a smooth one of its colour.
fn spectrum_of(given: Option<&Spectrum>, color: Rgb) -> Spectrum {
    given.cloned().unwrap_or_else(|| Spectrum::Emission(SmoothEmission::new(color)))
}

/// Which of the lights.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum LightIndex {
    /// Of [`Lights::points`].
    Point(usize),
    /// Of [`Lights::surfaces`].
    Surface(usize),
    /// The background.
    Environment,
}

/// Light that may arrive at a point.
#[derive(Clone, Copy, Debug)]
pub struct Arriving {
    /// Which light.
    pub light: LightIndex,
    /// Towards the light, unit length.
    pub wi: Vector3,
    /// How far it is.
    pub distance: f64,
    /// Radiance over the density of the choice; the irradiance over the probability of the choice where there is no density.
    /// `None` where the radiance is only known where it is met.
    pub light_over_density: Option<Spectral>,
    /// The density per steradian of the whole choice; `None` for lights without extent.
    pub density: Option<f64>,
}

impl Lights {
    /// Those of a scene seen by a view.
    pub fn new(scene: &CompiledScene, view: &ViewProjection) -> Self {
        let mut points = Vec::new();
        for (light, number) in scene.lights.iter().zip(0..) {
            let intensity = light.intensity();
            if !intensity.is_black() {
                points.push((number, spectrum_of(light.spectrum(), intensity)));
            }
        }
        let emits = |material: u32| scene.materials[material as usize].emits();
        let surfaces: Vec<Emitter> = scene
            .geometry
            .emitting_surfaces(emits)
            .into_iter()
            .map(|place| {
                let material = &scene.materials[place.material as usize];
                let constant = material.constant_emission();
                let radiance = constant.map(|color| spectrum_of(material.emission_spectrum(), color));
                let mean = constant.map_or(0.5, |color| f64::from(color.mean()));
                Emitter { place, radiance, one_sided: material.is_one_sided(), mean }
            })
            .collect();
        let mut by_body: Vec<((SolidId, u32), u32)> =
            (0..).zip(&surfaces).map(|(i, emitter)| ((emitter.place.solid, emitter.place.material), i)).collect();
        by_body.sort_unstable();
        let environment = Environment::new(&scene.background, view);
        Self { points, surfaces, environment, by_body, first_surface: scene.lights.len() as u32 }
    }

    /// How many there are.
    fn count(&self) -> usize {
        self.points.len() + self.surfaces.len() + usize::from(self.environment.is_some())
    }

    /// All of them, in a fixed order.
    pub fn all(&self) -> impl Iterator<Item = LightIndex> {
        (0..self.count()).map(|number| self.index(number))
    }

    fn index(&self, number: usize) -> LightIndex {
        if number < self.points.len() {
            LightIndex::Point(number)
        } else if number < self.points.len() + self.surfaces.len() {
            LightIndex::Surface(number - self.points.len())
        } else {
            LightIndex::Environment
        }
    }

    /// The place of a light among [`Lights::all`].
    pub fn number(&self, index: LightIndex) -> usize {
        match index {
            LightIndex::Point(point) => point,
            LightIndex::Surface(surface) => self.points.len() + surface,
            LightIndex::Environment => self.points.len() + self.surfaces.len(),
        }
    }

    /// The number by which a light's terms are told apart: that of the scene's light, then the surfaces, then the background.
    pub fn name(&self, index: LightIndex) -> u32 {
        match index {
            LightIndex::Point(point) => self.points[point].0,
            LightIndex::Surface(surface) => self.first_surface + surface as u32,
            LightIndex::Environment => self.first_surface + self.surfaces.len() as u32,
        }
    }

    /// The radiance of a surface, where it is the same everywhere.
    pub fn constant_radiance(&self, index: LightIndex) -> Option<&Spectrum> {
        match index {
            LightIndex::Surface(surface) => self.surfaces[surface].radiance.as_ref(),
            LightIndex::Point(_) | LightIndex::Environment => None,
        }
    }

    /// The surface that shines where a ray met it; `None` where it is one that is not sampled.
    pub fn surface_at(&self, interaction: &SurfaceInteraction) -> Option<LightIndex> {
        let key = (interaction.solid, interaction.material);
        let at = self.by_body.binary_search_by_key(&key, |(key, _)| *key).ok()?;
        Some(LightIndex::Surface(self.by_body[at].1 as usize))
    }

    /// What a light may give a point, roughly; more than 0 wherever it may give anything. With many lights not of the point.
    fn weight(&self, scene: &CompiledScene, index: LightIndex, point: Point3) -> f64 {
        let weighed = self.count() <= WEIGHED;
        match index {
            LightIndex::Point(number) => {
                let light = &scene.lights[self.points[number].0 as usize];
                if !weighed {
                    return PI * f64::from(light.intensity().mean());
                }
                light.illuminate(point).map_or(0.0, |arriving| PI * f64::from(arriving.irradiance.mean()))
            }
            LightIndex::Surface(number) => {
                let Emitter { place, mean, .. } = &self.surfaces[number];
                let area = place.surface.area();
                if !weighed {
                    return mean * area;
                }
                let (center, radius) = place.surface.bounding_sphere();
                let squared = (center - point).length_squared().max(radius * radius);
                mean * (area / squared).min(PI)
            }
            LightIndex::Environment => self.environment.as_ref().map_or(0.0, |environment| PI * environment.mean()),
        }
    }

    /// The weights of all lights for a point: their sum, and how many are not 0.
    fn weights(&self, scene: &CompiledScene, point: Point3) -> (f64, u32) {
        self.all().fold((0.0, 0), |(sum, count), index| {
            let weight = self.weight(scene, index, point);
            (sum + weight, count + u32::from(weight > 0.0))
        })
    }

    /// The probability with which a light of a weight is chosen: by its weight mostly, and for a part each as likely as another, since
    /// the one that would give most may be hidden.
    fn probability(weight: f64, (sum, count): (f64, u32)) -> f64 {
        if weight > 0.0 { (1.0 - EVEN) * weight / sum + EVEN / f64::from(count) } else { 0.0 }
    }

    /// The probability with which a light is chosen for a point.
    fn probability_of(&self, scene: &CompiledScene, index: LightIndex, point: Point3) -> f64 {
        if self.count() == 1 {
            return 1.0;
        }
        Self::probability(self.weight(scene, index, point), self.weights(scene, point))
    }

    /// Chooses a light for a point, and of one with extent a place, by a number in [0, 1) for the one and two for the other.
    pub fn sample(
        &self,
        scene: &CompiledScene,
        colors: &Colors,
        wavelengths: &Wavelengths,
        point: Point3,
        choice: f64,
        u: [f64; 2],
    ) -> Option<Arriving> {
        let count = self.count();
        let (index, probability) = match count {
            0 => return None,
            1 => (self.index(0), 1.0),
            _ => {
                let weights = self.weights(scene, point);
                let probability = |index| Self::probability(self.weight(scene, index, point), weights);
                chosen(self.all().map(|index| (index, probability(index))), choice)?
            }
        };
        let arriving = self.arriving(scene, colors, wavelengths, index, point, u)?;
        Some(Arriving {
            light_over_density: arriving.light_over_density.map(|light| scaled(light, 1.0 / probability)),
            density: arriving.density.map(|density| density * probability),
            ..arriving
        })
    }

    /// Light of one light, chosen with certainty.
    fn arriving(
        &self,
        scene: &CompiledScene,
        colors: &Colors,
        wavelengths: &Wavelengths,
        light: LightIndex,
        point: Point3,
        u: [f64; 2],
    ) -> Option<Arriving> {
        match light {
            LightIndex::Point(number) => {
                let (number, spectrum) = &self.points[number];
                let light_of_scene = &scene.lights[*number as usize];
                let arriving = light_of_scene.illuminate(point)?;
                let share = PI * f64::from(arriving.irradiance.max_abs() / light_of_scene.intensity().max_abs());
                let light_over_density = Some(wavelengths.nm().map(|nm| share * spectrum.at(nm)));
                // A light of some angle is a point that is elsewhere each time: nothing meets it by chance.
                let wi = match light_of_scene.origin() {
                    LightOrigin::Direction(to_light, angle) => within(to_light, angle, u),
                    LightOrigin::Point(_) => arriving.to_light,
                };
                Some(Arriving { light, wi, distance: arriving.distance, light_over_density, density: None })
            }
            LightIndex::Surface(number) => {
                let emitter = &self.surfaces[number];
                let place = emitter.place.surface.sample_from(point, u)?;
                let towards = place.point - point;
                let distance = towards.length();
                let wi = towards.try_normalize()?;
                if emitter.one_sided && place.normal.dot(wi) >= 0.0 || place.density <= 0.0 {
                    return None;
                }
                let light_over_density = emitter
                    .radiance
                    .as_ref()
                    .map(|radiance| wavelengths.nm().map(|nm| radiance.at(nm) / place.density));
                Some(Arriving { light, wi, distance, light_over_density, density: Some(place.density) })
            }
            LightIndex::Environment => {
                let (wi, density) = self.environment.as_ref()?.sample(u)?;
                let radiance = self.environment_radiance(colors, wavelengths, scene, wi, &SeenAtOnce::POINT);
                let light_over_density = Some(scaled(radiance, 1.0 / density));
                Some(Arriving { light, wi, distance: f64::INFINITY, light_over_density, density: Some(density) })
            }
        }
    }

    /// What of the background is seen in a direction and around it.
    pub fn environment_radiance(
        &self,
        colors: &Colors,
        wavelengths: &Wavelengths,
        scene: &CompiledScene,
        direction: Vector3,
        seen: &SeenAtOnce,
    ) -> Spectral {
        let Some(environment) = &self.environment else { return super::spectra::BLACK };
        let color: Rgb = scene.background.evaluate(direction, seen, environment.view());
        colors.light(color, wavelengths.nm(), wavelengths.white)
    }

    /// The density per steradian with which [`Lights::sample`] chooses a place of a surface that shines, for a point.
    pub fn density_of_surface(
        &self,
        scene: &CompiledScene,
        index: LightIndex,
        point: Point3,
        interaction: &SurfaceInteraction,
    ) -> f64 {
        let LightIndex::Surface(number) = index else { return 0.0 };
        let surface = &self.surfaces[number].place.surface;
        let normal = interaction.geometric_normal.as_vector();
        surface.density_from(point, interaction.point, normal) * self.probability_of(scene, index, point)
    }

    /// And a direction of the background.
    pub fn density_of_environment(&self, scene: &CompiledScene, point: Point3, direction: Vector3) -> f64 {
        self.environment.as_ref().map_or(0.0, |environment| {
            environment.density(direction) * self.probability_of(scene, LightIndex::Environment, point)
        })
    }
}

/// A direction of those in which a light of some angle is seen, by two numbers in [0, 1).
pub fn within(to_light: Vector3, angle: f64, u: [f64; 2]) -> Vector3 {
    if angle == 0.0 {
        return to_light;
    }
    // 1 − cos of half the angle.
    let half = portable::sin(0.25 * angle);
    Cone::new(to_light, 2.0 * half * half).sample(u)
}

/// One of some lights, by their probabilities and a number in [0, 1), with its own; `None` where none has any.
pub fn chosen(lights: impl Iterator<Item = (LightIndex, f64)>, choice: f64) -> Option<(LightIndex, f64)> {
    let mut rest = choice;
    let mut chosen = None;
    for (light, probability) in lights {
        if probability > 0.0 {
            chosen = Some((light, probability));
            if rest < probability {
                break;
            }
        }
        rest -= probability;
    }
    chosen
}
