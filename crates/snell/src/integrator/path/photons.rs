//! Photons: light that came to a surface through glass or off mirrors, kept where it fell, and gathered by paths that come near.
//!
//! What a path from the eye finds only by the luckiest of chances, a small light behind glass, light finds by itself. Photons serve for
//! those ways alone: from a light, by specular surfaces, to one that is not. A path may find the same way from the other end, unless the
//! light is a point; then both count, weighed by the balance heuristic. As all between is specular, the ratio of
//! their densities is known from the ends: N π r² times the density with which light sets out, over the cosine with the light, times
//! the cosine where photons fall over the density with which a path sets out from there. (Georgiev et al. 2012, equations 7 to 9; what the
//! specular surfaces do to densities is the same both ways, and so are the probabilities with which [`Lobes`] chooses.)
//!
//! Each pass has photons of its own, gathered from a smaller disk each time, as Hachisuka and Jensen, "Stochastic Progressive Photon Mapping",
//! SIGGRAPH Asia 2009, shrink it: what is blurred is so less and less, while noise averages out. Photons have the wavelengths of all paths
//! of their pass, so that colours come apart in glass as they should.
//!
//! Media that scatter keep photons as surfaces do, where they are scattered, gathered from balls instead of disks: N 4/3 π r³ times what the
//! medium takes away per length stands in the place of N π r² times the cosine.

use rayon::prelude::*;
use snell_math::sampler::Sampler;
use snell_math::{Point3, Ray, Vector3, portable};

use super::emission::{Emission, Emitted};
use super::lights::LightIndex;
use super::lobes::{Lobes, Transport};
use super::materials::{Boundary, Meeting};
use super::medium::{Travelled, travel};
use super::photon_map::{Photon, PhotonMap, place};
use super::spectra::{BLACK, Spectral, Wavelengths, is_black, largest, scaled, times};
use super::{Path, ROULETTE_DEPTH};
use crate::compile::CompiledScene;
use crate::geometry::QueryScratch;
use crate::integrator::sink::MAX_PASSES;
use crate::interaction::SurfaceInteraction;
use crate::task::{MediumStack, MediumStacks};
use crate::texture::Footprint;

/// What of r² is left after k passes is a product of (i + α) / (i + 1).
const ALPHA: f64 = 2.0 / 3.0;
/// The first radius, in pixels as they are seen where photons fall.
const FIRST_RADIUS: f64 = 2.5;
/// The same in media, where photons are fewer in a pixel's size.
const FIRST_RADIUS_IN_MEDIA: f64 = 8.0;
/// Photons that one thread follows at a time.
const PORTION: u32 = 4096;
/// How many specular surfaces a photon meets at most: as many as a path of the default depth.
const PHOTON_DEPTH: u32 = 63;

/// How the photons of the passes of a picture are made, one pass after the other.
#[derive(Debug)]
pub struct PhotonPasses {
    count: u32,
    seed: u32,
    /// Of the first pass, on surfaces and in media; unknown before a pass was made.
    first_radii: Option<[f64; 2]>,
}

impl PhotonPasses {
    /// For a picture of so many pixels; `None` where no light comes to surfaces by specular ones.
    pub fn new(path: &Path, seed: u32, pixels: u64) -> Option<Self> {
        path.emission.as_ref()?;
        let count = (pixels / 4).clamp(u64::from(PORTION), 1 << 20) as u32;
        Some(Self { count, seed, first_radii: None })
    }

    /// Lets the photons of a pass set out, those of its number whatever came before, for paths to gather.
    pub fn set_out(&mut self, number: u32, path: &mut Path, scene: &CompiledScene) {
        path.photons = self.photons(number, path, scene);
    }

    fn photons(&mut self, number: u32, path: &Path, scene: &CompiledScene) -> Option<PhotonMap> {
        let emission = path.emission.as_ref()?;
        let pass = |number: u32| {
            let [u, ..] = Sampler::new(self.seed, [u32::MAX, 0], number).set(0);
            Pass { path, scene, emission, wavelengths: Wavelengths::sample(u), seed: self.seed, number }
        };
        let this = pass(number);
        let photons = this.trace(self.count);
        let first = match (self.first_radii, number) {
            (Some(first), _) => first,
            (None, 0) => first_radii(path, &photons),
            (None, _) => first_radii(path, &pass(0).trace(self.count)),
        };
        self.first_radii = Some(first);
        let shrunk = |step: f64| (step + ALPHA - 1.0).max(ALPHA) / step;
        let [disk, ball] = first;
        let steps = || (1..=number).map(f64::from);
        let disk = steps().fold(disk, |radius, step| radius * shrunk(step).sqrt());
        // As their volumes shrink, not their areas. (Knaus and Zwicker, "Progressive Photon Mapping: A Probabilistic Approach", 2011, section 4.2.)
        let ball = steps().fold(ball, |radius, step| radius * portable::cbrt(shrunk(step)));
        Some(PhotonMap::new(photons, [disk, ball], self.count, this.wavelengths))
    }
}

/// The first radii: so many pixels, where most photons fell.
fn first_radii(path: &Path, photons: &[Vec<Photon>; 2]) -> [f64; 2] {
    let median = |photons: &[Photon]| {
        let mut sizes: Vec<f64> = photons.iter().map(|photon| path.pixel_size(place(photon.point))).collect();
        let middle = sizes.len() / 2;
        if sizes.is_empty() {
            return 1.0;
        }
        *sizes.select_nth_unstable_by(middle, f64::total_cmp).1
    };
    let [on_surfaces, in_media] = photons;
    [FIRST_RADIUS * median(on_surfaces), FIRST_RADIUS_IN_MEDIA * median(in_media)]
}

/// One pass: what its photons are made from.
#[derive(Clone, Copy)]
struct Pass<'a> {
    path: &'a Path,
    scene: &'a CompiledScene,
    emission: &'a Emission,
    wavelengths: Wavelengths,
    seed: u32,
    number: u32,
}

/// The buffers of one thread.
#[derive(Default)]
struct Buffers {
    media: MediumStacks,
    query: QueryScratch,
}

impl Pass<'_> {
    /// Follows so many, and keeps them where they fall on surfaces and in media, in the order in which they set out.
    fn trace(&self, count: u32) -> [Vec<Photon>; 2] {
        let portions: Vec<[Vec<Photon>; 2]> = (0..count.div_ceil(PORTION))
            .into_par_iter()
            .map_init(Buffers::default, |buffers, portion| {
                let first = portion * PORTION;
                let mut kept = [Vec::new(), Vec::new()];
                for index in first..(first + PORTION).min(count) {
                    self.follow(index, buffers, &mut kept);
                }
                kept
            })
            .collect();
        let mut all = [Vec::new(), Vec::new()];
        for portion in portions {
            for (all, mut part) in all.iter_mut().zip(portion) {
                all.append(&mut part);
            }
        }
        all
    }

    /// Follows one photon.
    fn follow(&self, index: u32, buffers: &mut Buffers, [on_surfaces, in_media]: &mut [Vec<Photon>; 2]) {
        // Other numbers than those of any pixel.
        let sampler = Sampler::new(self.seed, [u32::MAX, 1 + self.number], index);
        let ([choice, target, u, v], [x, y, ..]) = (sampler.set(0), sampler.set(1));
        let Path { lights, colors, .. } = self.path;
        let (way, place) = ([u, v], [x, y]);
        let emitted = self.emission.sample(self.scene, lights, colors, &self.wavelengths, [choice, target], way, place);
        let Some(Emitted { origin, direction, power, density, light }) = emitted else { return };
        if is_black(power) {
            return;
        }
        buffers.media.clear();
        let mut photon = Flight {
            ray: Ray::new(origin, direction),
            media: self.scene.media_around(origin, &mut buffers.media, &mut buffers.query),
            power,
            travelled: 0.0,
            wavelengths: self.wavelengths,
        };
        let (mut events, mut passes) = (0_u32, 0_u16);
        while events < PHOTON_DEPTH && passes < MAX_PASSES {
            let Some(hit) = self.scene.geometry.intersect(&photon.ray, f64::INFINITY, &mut buffers.query) else {
                return;
            };
            let interaction = self.scene.geometry.interaction(&photon.ray, &hit);
            let draw = sampler.set(2 + events);
            if let Some(point) = photon.travel(self.path, hit.t, draw[3], &buffers.media) {
                if events > 0 && self.emission.serves_media(lights, light) {
                    let power = scaled(photon.power, self.fall_off(light, photon.travelled));
                    in_media.extend(photon.kept(point, Vector3::default(), power, density));
                }
                return;
            }
            let materials = &self.path.materials;
            let (nm, media) = (photon.wavelengths.nm(), photon.media);
            let crossing =
                match materials.boundary(self.scene, &mut buffers.media, media, &photon.ray, &interaction, nm) {
                    None => None,
                    Some(Boundary::Met(crossing)) => Some(crossing),
                    Some(Boundary::Passed { share, media }) => {
                        photon.power = times(photon.power, share);
                        photon.go_on(&interaction, photon.ray.direction, media);
                        passes += 1;
                        continue;
                    }
                };
            let number = interaction.material;
            let material = &self.scene.materials[number as usize];
            let bsdf = material.bsdf(&self.scene.textures, &interaction, &Footprint::SHARP);
            let meeting = Meeting {
                sides: crossing.map(|crossing| [crossing.before, crossing.beyond]),
                around: buffers.media.current(media),
                is_tinted: interaction.vertex_color.is_some(),
                film_nm: material.film_thickness(&self.scene.textures, &interaction, &Footprint::SHARP),
                nm,
                hero_alone: photon.wavelengths.is_hero_alone(),
            };
            let surface = materials.colors(colors, number, &bsdf, &meeting);
            let wo = -photon.ray.direction;
            let lobes = Lobes::new(&surface, &interaction, wo);
            if events > 0 && lobes.is_lit() {
                let power = scaled(photon.power, self.fall_off(light, photon.travelled));
                let normal = interaction.geometric_normal.as_vector();
                on_surfaces.extend(photon.kept(interaction.point, normal, power, density));
            }
            let Some(scattered) = lobes.sample(draw[0], [draw[1], draw[2]], Transport::Power) else { return };
            if scattered.density.is_some() {
                // What other surfaces send on is found by paths.
                return;
            }
            // Smooth meshes bend light other than they do seen from the eye: Veach 1997, section 5.3.
            let (shading, flat) = (interaction.shading_normal, interaction.geometric_normal);
            let bent = (shading.dot(wo) * flat.dot(scattered.wi) / (flat.dot(wo) * shading.dot(scattered.wi))).abs();
            photon.power = scaled(times(photon.power, scattered.weight), if bent.is_finite() { bent } else { 1.0 });
            if scattered.hero_alone {
                photon.give_up_others();
            }
            if events >= u32::from(ROULETTE_DEPTH) {
                let survival = (largest(photon.power) / largest(power)).min(1.0);
                if sampler.set(2 + events + PHOTON_DEPTH)[0] >= survival {
                    return;
                }
                photon.power = scaled(photon.power, 1.0 / survival);
            }
            let media = crossing.filter(|_| scattered.crosses).map_or(photon.media, |crossing| crossing.after);
            photon.go_on(&interaction, scattered.wi, media);
            events += 1;
        }
    }

    /// What a light without extent has become after a distance, over what the spreading of its rays does by itself.
    fn fall_off(&self, light: LightIndex, travelled: f64) -> f64 {
        match light {
            LightIndex::Point(number) => {
                let of_scene = &self.scene.lights[self.path.lights.points[number].0 as usize];
                of_scene.spread_at(travelled)
            }
            LightIndex::Surface(_) | LightIndex::Environment => 1.0,
        }
    }
}

/// A photon on its way.
struct Flight {
    ray: Ray,
    media: MediumStack,
    power: Spectral,
    travelled: f64,
    wavelengths: Wavelengths,
}

impl Flight {
    /// Goes through the body that is there to a distance; gives the place where it is scattered before.
    fn travel(&mut self, path: &Path, distance: f64, u: f64, media: &MediumStacks) -> Option<Point3> {
        let body = media.current(self.media).and_then(|inside| path.materials.body(inside.material));
        let Some(body) = body else {
            self.travelled += distance;
            return None;
        };
        // One number chooses a wavelength, and what is left of it the distance.
        let choices = if self.wavelengths.is_hero_alone() { 1.0 } else { self.power.len() as f64 };
        match travel(body, &self.wavelengths, distance, || [u, (u * choices).fract()]) {
            Travelled::Through { left, weight } => {
                self.power = scaled(times(self.power, left), weight);
                self.travelled += distance;
                None
            }
            // What the medium scatters of it is in what paths carry that come here.
            Travelled::Scattered { distance, left, weight, .. } => {
                self.power = scaled(times(self.power, left), weight);
                self.travelled += distance;
                Some(self.ray.at(distance))
            }
        }
    }

    fn give_up_others(&mut self) {
        if !self.wavelengths.is_hero_alone() {
            self.wavelengths.give_up_others();
            // It counts for them all.
            let hero = self.power[0] * self.power.len() as f64;
            self.power = BLACK;
            self.power[0] = hero;
        }
    }

    fn go_on(&mut self, interaction: &SurfaceInteraction, direction: Vector3, media: MediumStack) {
        self.ray = interaction.spawn_ray(direction);
        self.media = media;
    }

    /// As it is kept at a place; `None` where something is not finite.
    fn kept(&self, point: Point3, normal: Vector3, power: Spectral, density: f64) -> Option<Photon> {
        let photon = Photon {
            point: point.to_array().map(|x| x as f32),
            direction: self.ray.direction.to_array().map(|x| x as f32),
            normal: normal.to_array().map(|x| x as f32),
            power: power.map(|x| x as f32),
            density: density as f32,
            hero_alone: self.wavelengths.is_hero_alone(),
        };
        let finite = photon.point.iter().chain(&photon.power).all(|x| x.is_finite());
        (finite && !is_black(power)).then_some(photon)
    }
}
