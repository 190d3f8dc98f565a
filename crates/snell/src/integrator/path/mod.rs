//! Light as it is: paths from the eye, four wavelengths each, to lights of any size, together with photons that come to surfaces through
//! glass and off mirrors.
//!
//! Follows: Kajiya, "The Rendering Equation", SIGGRAPH 1986; Veach, "Robust Monte Carlo Methods for Light Transport Simulation", 1997
//! (asking lights and meeting them by chance, weighed by the balance heuristic); Wilkie et al. 2014 for wavelengths;
//! Hachisuka, Ogaki and Jensen, "Progressive Photon Mapping", 2008, and Georgiev et al., "Light Transport Simulation with Vertex
//! Connection and Merging", 2012, for [photons](photons).
//!
//! The same scenes and materials as for `whitted` serve, in the same units. Ambient light, which there stands for what paths find, is
//! left out; the background gives light. World space.

mod emission;
mod environment;
mod lights;
mod lobes;
#[cfg(test)]
mod lobes_tests;
mod materials;
mod medium;
mod photon_map;
mod photons;
mod reflector;
mod rough;
mod sample;
mod spectra;
mod watched;

use snell_math::lanes::{Bits, Lanes};
use snell_math::sampler::Sampler;
use snell_math::{Bounds3, Point3, Ray, Rgb};

use super::{Integrator, Sink, look_around, seen_at_once, seen_in_directions, view_of};
use crate::camera::{Camera, Projection, RealLens, Window};
use crate::compile::CompiledScene;
use crate::differential::RayDifferential;
use crate::geometry::{HitRows, RayRow, WorldSurface};
use crate::interaction::{SurfaceInteraction, SurfaceRows, Surroundings};
use crate::material::Material;
use crate::observe::Observer;
use crate::task::{Crossing, Cut, MediumStack, RayKind, RayRows, RayTask, ShadowQuestion, Term};
use emission::{Emission, Targets};
use lights::{LightIndex, Lights};
use lobes::{Lobes, Scattered, Transport};
use materials::{Boundary, Meeting, PathMaterials};
use medium::WayToLight;
pub use photon_map::PhotonMap;
pub use photons::PhotonPasses;
use sample::{Gathers, Vertex};
pub use sample::{PathSample, Purpose};
pub use spectra::Wavelengths;
use spectra::{BLACK, Colors, Spectral, largest, scaled, times};

/// From this depth on paths end by chance, the likelier the less they carry.
const ROULETTE_DEPTH: u16 = 4;
/// Straight from the eye only if they carry less than one over this.
const STRAIGHT_PATIENCE: f64 = 64.0;

/// A path divides where both ways carry more than this.
const LEAST_DIVIDED: f64 = 1.0 / 256.0;

/// Path tracing.
#[derive(Debug)]
pub struct Path {
    camera: Camera,
    /// Its real lens, where it has one.
    lens: Option<RealLens>,
    colors: Colors,
    materials: PathMaterials,
    lights: Lights,
    /// Light that sets out to what is specular; `None` where there is no such thing, or no light.
    emission: Option<Emission>,
    /// The photons of the pass.
    photons: Option<PhotonMap>,
}

impl Path {
    /// For a scene seen by a camera.
    pub fn new(scene: &CompiledScene, camera: &Camera) -> Self {
        let view = view_of(camera);
        let lights = Lights::new(scene, &view);
        let emission = targets(scene).and_then(|(targets, is_lit)| {
            let emission = Emission::new(scene, &lights, targets)?;
            // Photons of large lights are kept on surfaces alone.
            (is_lit || emission.has_small_light()).then_some(emission)
        });
        let materials = PathMaterials::new(scene);
        let (camera, lens, colors) = (camera.clone(), camera.real_lens(), Colors::new());
        Self { camera, lens, colors, materials, lights, emission, photons: None }
    }

    /// The passes of photons for a picture of so many pixels, under a seed; `None` where they would bring nothing.
    pub fn photon_passes(&self, seed: u32, pixels: u64) -> Option<PhotonPasses> {
        PhotonPasses::new(self, seed, pixels)
    }

    /// The size of a pixel as it is seen at a point, world units.
    fn pixel_size(&self, point: Point3) -> f64 {
        match self.camera.projection() {
            Projection::Perspective => self.camera.eye().distance(point) * self.camera.pixel_angle(),
            Projection::Orthographic => {
                let Window { left, right, .. } = self.camera.window();
                (right - left) / f64::from(self.camera.pixels()[0])
            }
        }
    }

    /// A path for a sample of a pixel under a seed. Those of a pass with photons share their wavelengths with them.
    pub fn begin(&self, seed: u32, pixel: [u32; 2], sample: u32) -> PathSample {
        let sampler = Sampler::new(seed, pixel, sample);
        let wavelengths = match &self.photons {
            Some(photons) => *photons.wavelengths(),
            None => {
                let [u, ..] = sampler.set(Purpose::Wavelengths.set(0));
                Wavelengths::sample(u)
            }
        };
        PathSample::new(sampler, wavelengths)
    }

    /// The ray with which a path begins behind a lens, from a raster position, by two numbers in [0, 1) for the way through it;
    /// `None` where the camera has none. Wavelengths that go different ways through a real one begin with different rays, so the path
    /// keeps the hero alone. On a way that leads against a rim it carries nothing.
    pub fn begin_behind_lens(&self, place: [f64; 2], u: [f64; 2], path: &mut PathSample) -> Option<Ray> {
        let Some(lens) = &self.lens else {
            let [x, y] = place;
            return self.camera.generate_lens_ray(x, y, u);
        };
        if lens.disperses() {
            path.wavelengths.give_up_others();
        }
        let found = lens.ray(place, u, path.wavelengths.hero_nm());
        path.throughput = found.map_or(BLACK, |(_, weight)| [weight; 4]);
        let [x, y] = place;
        Some(found.map_or_else(|| self.camera.generate_ray(x, y), |(ray, _)| ray))
    }
}

/// What is specular in a scene where light that it sends on may fall on something, a surface or a medium that scatters, with whether there are
/// such surfaces; else `None`.
fn targets(scene: &CompiledScene) -> Option<(Targets, bool)> {
    let surfaces = scene.geometry.world_surfaces();
    // Parts of solids and meshes may have materials of their own. The last material is that of objects without one.
    let given = scene.materials.split_last().map_or(&[][..], |(_, given)| given);
    let some = |keeps: &dyn Fn(&Material) -> bool| {
        let of_surface = |surface: &WorldSurface<'_>| keeps(&scene.materials[surface.material as usize]);
        given.iter().any(keeps) || surfaces.iter().any(of_surface)
    };
    let is_lit = some(&|material| material.is_lit());
    let scatters = |material: &Material| material.body.as_ref().is_some_and(|body| !body.medium.scattering.is_black());
    if !(is_lit || some(&scatters)) {
        return None;
    }
    let boxes: Vec<Bounds3> = surfaces
        .iter()
        .filter(|surface| scene.materials[surface.material as usize].is_specular())
        .map(|surface| surface.bounds)
        .collect();
    let bounded = surfaces.iter().filter(|surface| surface.bounds.is_finite());
    let everything = bounded.fold(Bounds3::EMPTY, |all, surface| all.union(&surface.bounds));
    let is_hidden = boxes.is_empty() && scene.materials.iter().any(Material::is_specular);
    let boxes = if is_hidden { vec![everything] } else { boxes };
    Some((Targets::new(&boxes, &everything)?, is_lit))
}

/// A ray of a path being shaded.
struct Step<'a, 'b, 's, O> {
    scene: &'a CompiledScene,
    task: RayTask,
    /// What its neighbours meet.
    around: &'a Surroundings,
    path: &'b mut PathSample,
    /// A path that leaves it here.
    born: Option<PathSample>,
    /// The number that such a one has.
    next_path: u32,
    out: &'b mut Sink<'s, O>,
}

impl Integrator for Path {
    /// The paths by their numbers, which rays have as [`RayTask::split`]: first one of each sample, then those that left others.
    type State = Vec<PathSample>;

    #[inline(always)]
    fn shade<L: Lanes, O: Observer>(
        &self,
        scene: &CompiledScene,
        state: &mut Vec<PathSample>,
        rays: &RayRows,
        at: usize,
        active: Bits,
        hits: &HitRows,
        surfaces: &mut SurfaceRows,
        out: &mut Sink<'_, O>,
    ) {
        let met = Bits(hits.met().0 >> at) & active;
        if met.any() {
            let row = RayRow { origin: &rays.origin, direction: &rays.direction };
            scene.geometry.surfaces::<L>(row, at, hits, met, surfaces);
            look_around(scene, rays, at, met, hits, surfaces, out);
        }
        for lane in active.lanes() {
            let interaction = met.has(lane).then(|| scene.geometry.interaction_of(hits, surfaces, at + lane));
            let task = rays.task(at + lane);
            out.met(&task, interaction.as_ref());
            let next_path = state.len() as u32;
            let path = &mut state[task.split as usize];
            let around = if scene.sees_pictures() { &surfaces.around[at + lane] } else { &Surroundings::NONE };
            let mut step = Step { scene, task, around, path, born: None, next_path, out };
            self.step(&mut step, interaction.as_ref());
            if let Some(born) = step.born {
                state.push(born);
            }
        }
    }
}

impl Path {
    /// One ray of a path, and where it goes on.
    #[inline(never)]
    fn step<O: Observer>(&self, step: &mut Step<'_, '_, '_, O>, interaction: Option<&SurfaceInteraction>) {
        step.tell_wavelengths();
        let distance = interaction.map_or(f64::INFINITY, |interaction| interaction.t);
        if self.travel(step, distance) {
            return;
        }
        match interaction {
            None => self.leave(step),
            Some(interaction) => self.meet(step, interaction),
        }
    }

    /// A path that leaves the scene finds the background.
    fn leave<O: Observer>(&self, step: &mut Step<'_, '_, '_, O>) {
        let direction = step.task.ray.direction;
        let radiance = if let Some(color) = self.background_of_orthographic(step) {
            self.colors.light(color, step.path.wavelengths.nm(), step.path.wavelengths.white)
        } else {
            let seen = seen_in_directions(step.out.differential(step.task.id));
            self.lights.environment_radiance(&self.colors, &step.path.wavelengths, step.scene, direction, &seen)
        };
        let weight = match step.path.scattered {
            Some(vertex) if step.path.specular == 0 => {
                let asked = self.lights.density_of_environment(step.scene, vertex.point, direction);
                vertex.density / (vertex.density + asked)
            }
            Some(vertex) => self.weight_beside_photons(&vertex, LightIndex::Environment, |emission| {
                emission.density_of_environment(&self.lights, step.task.ray.origin, -direction)
            }),
            None => 1.0,
        };
        step.add(Term::Background, scaled(radiance, weight));
    }

    /// The parallel rays of an orthographic camera see a photograph by where they are, not by where they go.
    fn background_of_orthographic<O: Observer>(&self, step: &Step<'_, '_, '_, O>) -> Option<Rgb> {
        let is_parallel = self.camera.projection() == Projection::Orthographic && step.task.kind == RayKind::Camera;
        is_parallel.then(|| {
            let position = self.camera.picture_position(step.task.ray.origin);
            let differential = step.out.differential(step.task.id).unwrap_or_default();
            let seen = seen_at_once(&self.camera, &step.task.ray, position, differential);
            step.scene.background.evaluate_at_pixel(position, step.task.ray.direction, &seen)
        })
    }

    /// A path that meets a surface.
    fn meet<O: Observer>(&self, step: &mut Step<'_, '_, '_, O>, interaction: &SurfaceInteraction) {
        let number = interaction.material;
        let material = &step.scene.materials[number as usize];
        let wo = -step.task.ray.direction;
        let nm = step.path.wavelengths.nm();
        let RayTask { ray, media, .. } = step.task;
        let crossing = match self.materials.boundary(step.scene, step.out.media, media, &ray, interaction, nm) {
            None => None,
            Some(Boundary::Met(crossing)) => Some(crossing),
            Some(Boundary::Passed { share, media }) => {
                step.path.throughput = times(step.path.throughput, share);
                step.note_throughput();
                step.out.pass(&step.task, interaction.spawn_ray(ray.direction), media);
                return;
            }
        };
        let bsdf = material.bsdf(&step.scene.textures, interaction, &step.around.footprint);
        step.tell_surface(&bsdf);
        if !bsdf.emission.is_black() && (!bsdf.one_sided || interaction.is_outward(wo)) {
            self.find_light(step, interaction, bsdf.emission);
        }
        let meeting = Meeting {
            sides: crossing.map(|Crossing { before, beyond, .. }| [before, beyond]),
            around: step.out.media.current(media),
            is_tinted: interaction.vertex_color.is_some(),
            film_nm: material.film_thickness(&step.scene.textures, interaction, &step.around.footprint),
            nm,
            hero_alone: step.path.wavelengths.is_hero_alone(),
        };
        let colors = self.materials.colors(&self.colors, number, &bsdf, &meeting);
        let mut lobes = Lobes::new(&colors, interaction, wo);
        if step.path.is_straight() {
            lobes.favour_the_weaker();
        }
        if lobes.is_lit() {
            self.ask_light(step, interaction, &lobes, crossing);
            if let Some(photons) = &self.photons {
                let found = photons.gather(interaction, &lobes, step.path.wavelengths.is_hero_alone());
                step.add(Term::Photons, found);
            }
        }
        let scattered = self.go_on(step, interaction, &lobes, crossing);
        if let Some(crossing) = crossing {
            step.tell_boundary(&colors, &lobes, crossing, scattered.as_ref());
        }
    }

    /// Light that a surface gives off, found by a ray.
    fn find_light<O: Observer>(&self, step: &mut Step<'_, '_, '_, O>, interaction: &SurfaceInteraction, color: Rgb) {
        let wavelengths = &step.path.wavelengths;
        let found = self.lights.surface_at(interaction);
        let of_material = step.scene.materials[interaction.material as usize].emission_spectrum();
        let radiance = match of_material.or_else(|| self.lights.constant_radiance(found?)) {
            Some(radiance) => wavelengths.nm().map(|nm| radiance.at(nm)),
            None => self.colors.light(color, wavelengths.nm(), wavelengths.white),
        };
        let weight = match (step.path.scattered, found) {
            (Some(vertex), Some(index)) if step.path.specular == 0 => {
                let asked = self.lights.density_of_surface(step.scene, index, vertex.point, interaction);
                vertex.density / (vertex.density + asked)
            }
            (Some(vertex), Some(index)) => self.weight_beside_photons(&vertex, index, |emission| {
                let (place, normal) = (interaction.point, interaction.geometric_normal.as_vector());
                emission.density_of_surface(&self.lights, index, place, normal, -step.task.ray.direction)
            }),
            _ => 1.0,
        };
        step.add(Term::Emission, scaled(radiance, weight));
    }

    /// The weight of light that a path found by specular surfaces after it was scattered, where photons may have found it too.
    fn weight_beside_photons(&self, vertex: &Vertex, light: LightIndex, density: impl FnOnce(&Emission) -> f64) -> f64 {
        match (&self.photons, &self.emission) {
            (Some(_), Some(emission))
                if matches!(vertex.gathers, Gathers::Ball { .. }) && !emission.serves_media(&self.lights, light) =>
            {
                1.0
            }
            (Some(photons), Some(emission)) => {
                photons.weight_of_path(density(emission), vertex.gathers, vertex.density)
            }
            _ => 1.0,
        }
    }

    /// Asks one light for what it gives a surface.
    fn ask_light<O: Observer>(
        &self,
        step: &mut Step<'_, '_, '_, O>,
        interaction: &SurfaceInteraction,
        lobes: &Lobes<'_>,
        crossing: Option<Crossing>,
    ) {
        let [choice, u, v, _] = step.path.draw(Purpose::Light);
        let point = interaction.point;
        let wavelengths = &step.path.wavelengths;
        let Some(arriving) = self.lights.sample(step.scene, &self.colors, wavelengths, point, choice, [u, v]) else {
            return;
        };
        let (value, density) = lobes.evaluate(arriving.wi, Transport::Radiance);
        if density == 0.0 {
            return;
        }
        let weight = arriving.density.map_or(1.0, |asked| asked / (asked + density));
        let value = scaled(value, weight);
        let ray = interaction.spawn_ray(arriving.wi);
        let distance = arriving.distance - (ray.origin - point).dot(arriving.wi);
        let media = match crossing {
            Some(crossing) if lobes.flat_cosine(arriving.wi) < 0.0 => crossing.after,
            _ => step.task.media,
        };
        let way = WayToLight { ray, distance, media };
        self.ask(step, &arriving, way, value, Term::Diffuse(self.lights.name(arriving.light)));
    }

    /// Sends the path on from a surface, and gives the way it goes.
    fn go_on<O: Observer>(
        &self,
        step: &mut Step<'_, '_, '_, O>,
        interaction: &SurfaceInteraction,
        lobes: &Lobes<'_>,
        crossing: Option<Crossing>,
    ) -> Option<Scattered> {
        let [lobe, u, v, roulette] = step.path.draw(Purpose::Direction);
        if step.path.divides()
            && let Some([reflected, refracted]) = lobes.both_ways()
            && [&reflected, &refracted].iter().all(|way| step.path.would_carry(way.weight) > LEAST_DIVIDED)
        {
            let mut other = step.path.divide();
            self.send_on(step, interaction, (lobes, crossing), &refracted, roulette);
            let Step { scene, next_path, .. } = *step;
            let task = RayTask { split: next_path, ..step.task };
            let mut second =
                Step { scene, task, around: step.around, path: &mut other, born: None, next_path, out: &mut *step.out };
            self.send_on(&mut second, interaction, (lobes, crossing), &reflected, roulette);
            step.born = Some(other);
            return Some(refracted);
        }
        let scattered = lobes.sample(lobe, [u, v], Transport::Radiance)?;
        if lobes.is_total() && scattered.density.is_none() {
            step.out.total_internal_reflection_of(&step.task);
        }
        self.send_on(step, interaction, (lobes, crossing), &scattered, roulette);
        Some(scattered)
    }

    /// Sends the path on in a direction from a surface.
    fn send_on<O: Observer>(
        &self,
        step: &mut Step<'_, '_, '_, O>,
        interaction: &SurfaceInteraction,
        (lobes, crossing): (&Lobes<'_>, Option<Crossing>),
        scattered: &Scattered,
        roulette: f64,
    ) {
        let path = &mut *step.path;
        path.throughput = times(path.throughput, scattered.weight);
        path.compression *= scattered.compression;
        match scattered.density {
            Some(density) => {
                let (point, cosine) = (interaction.point, lobes.flat_cosine(scattered.wi).abs());
                path.scattered = Some(Vertex { point, density, gathers: Gathers::Disk { cosine } });
                path.specular = 0;
            }
            None => path.specular += 1,
        }
        if scattered.hero_alone {
            path.wavelengths.give_up_others();
        }
        let (kind, media) = match crossing {
            Some(crossing) if scattered.crosses => (RayKind::Refracted, crossing.after),
            _ if scattered.density.is_some() => (RayKind::Scattered, step.task.media),
            _ => (RayKind::Reflected, step.task.media),
        };
        // What is scattered has no neighbours: its pictures are averaged by samples.
        let differential = match scattered.density {
            None if step.scene.sees_pictures() => Some(if scattered.crosses {
                step.around.differential.refracted(step.task.ray.direction, lobes.eta())
            } else {
                step.around.differential.reflected(step.task.ray.direction)
            }),
            _ => None,
        };
        step.spawn(kind, interaction.spawn_ray(scattered.wi), media, roulette, differential);
    }

    /// What lights are called by whose numbers terms are told apart: see [`Term`].
    pub fn light_names(&self, scene: &CompiledScene) -> Vec<String> {
        let of_object = |number: u32| scene.object_names.get(number).unwrap_or_default().into_owned();
        let surfaces = self.lights.surfaces.iter().map(|emitter| of_object(emitter.place.object));
        let background = std::iter::once("the background".to_owned());
        scene.light_names.iter().cloned().chain(surfaces).chain(background).collect()
    }
}

impl<O: Observer> Step<'_, '_, '_, O> {
    /// Adds light that the ray sees to the sample.
    fn add(&mut self, term: Term, light: Spectral) {
        let color = self.path.wavelengths.color(times(self.path.throughput, light));
        if !color.is_black() {
            self.out.add_one(&self.task, term, color);
        }
    }

    /// Sends the path on, unless it ends by depth or by chance.
    fn spawn(
        &mut self,
        kind: RayKind,
        ray: Ray,
        media: MediumStack,
        roulette: f64,
        differential: Option<RayDifferential>,
    ) {
        let path = &mut *self.path;
        path.events += 1;
        let wavelengths = &path.wavelengths;
        let carried = if wavelengths.is_hero_alone() { path.throughput[0] } else { largest(path.throughput) };
        if carried == 0.0 {
            return;
        }
        if self.task.depth >= self.out.depth() {
            let lost = wavelengths.color(times(path.throughput, wavelengths.white));
            self.out.cut_path(&self.task, kind, Cut::Depth, lost);
            return;
        }
        if self.task.depth >= ROULETTE_DEPTH {
            // What is seen straight through glass has no noise but that of chance: few samples are to end before it is found.
            let patience = if path.is_straight() { STRAIGHT_PATIENCE } else { 1.0 };
            let survival = (carried * path.compression * patience).min(1.0);
            if roulette >= survival {
                if self.out.is_detailed() {
                    let carried = wavelengths.color(times(path.throughput, wavelengths.white));
                    self.out.cut_path(&self.task, kind, Cut::Chance, carried);
                }
                return;
            }
            path.throughput = scaled(path.throughput, 1.0 / survival);
        }
        self.note_throughput();
        self.out.send(&self.task, kind, ray, media, differential);
    }

    /// A question to a light, of a value that it adds if nothing is in the way.
    fn question(&self, way: WayToLight, term: Term, value: Rgb) -> ShadowQuestion {
        let WayToLight { ray, distance, media } = way;
        ShadowQuestion {
            ray,
            distance,
            terms: [(term, value), (term, Rgb::BLACK)],
            sample: self.task.sample,
            task: self.task.id,
            media,
            extinction_scale: 1.0,
        }
    }
}
