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

use rayon::prelude::*;
use snell_math::sampler::Sampler;
use snell_math::{Point3, Ray, Vector3};

use super::emission::{Emission, Emitted};
use super::lights::LightIndex;
use super::lobes::{Lobes, Transport};
use super::materials::{Boundary, Meeting};
use super::spectra::{BLACK, Spectral, Wavelengths, attenuated, is_black, largest, mean, plus, scaled, times};
use super::{Path, ROULETTE_DEPTH};
use crate::compile::CompiledScene;
use crate::geometry::QueryScratch;
use crate::integrator::sink::MAX_PASSES;
use crate::interaction::SurfaceInteraction;
use crate::task::{MediumStack, MediumStacks};

/// What of r² is left after k passes is a product of (i + α) / (i + 1).
const ALPHA: f64 = 2.0 / 3.0;
/// The first radius, in pixels as they are seen where photons fall.
const FIRST_RADIUS: f64 = 2.5;
/// Photons that one thread follows at a time.
const PORTION: u32 = 4096;
/// How many specular surfaces a photon meets at most: as many as a path of the default depth.
const PHOTON_DEPTH: u32 = 63;

/// A photon where it fell.
#[derive(Clone, Copy, Debug)]
struct Photon {
    point: [f32; 3],
    /// Where it was going.
    direction: [f32; 3],
    /// The outward normal of the surface.
    normal: [f32; 3],
    power: [f32; 4],
    /// See [`Emitted::density`].
    density: f32,
    /// It carries its hero alone, four times.
    hero_alone: bool,
}

/// The photons of one pass.
#[derive(Debug)]
pub struct PhotonMap {
    /// In the order of their cells.
    photons: Vec<Photon>,
    /// Where each cell's begin; one more for the end.
    starts: Vec<u32>,
    radius: f64,
    /// N π r², of those that set out.
    disks: f64,
    /// Theirs, and those of all paths of the pass.
    wavelengths: Wavelengths,
}

/// How the photons of the passes of a picture are made, one pass after the other.
#[derive(Debug)]
pub struct PhotonPasses {
    count: u32,
    seed: u32,
    next: u32,
    /// Of the first pass; unknown before a pass was made.
    first_radius: Option<f64>,
}

impl PhotonPasses {
    /// For a picture of so many pixels; `None` where no light comes to surfaces by specular ones.
    pub fn new(path: &Path, seed: u32, pixels: u64) -> Option<Self> {
        path.emission.as_ref()?;
        let count = (pixels / 4).clamp(u64::from(PORTION), 1 << 20) as u32;
        Some(Self { count, seed, next: 0, first_radius: None })
    }

    /// The photons of the next pass.
    pub fn next(&mut self, path: &Path, scene: &CompiledScene) -> Option<PhotonMap> {
        self.next += 1;
        self.of_pass(self.next - 1, path, scene)
    }

    /// The photons of any pass: those that [`Self::next`] gives in its turn.
    pub fn of_pass(&mut self, number: u32, path: &Path, scene: &CompiledScene) -> Option<PhotonMap> {
        let emission = path.emission.as_ref()?;
        let pass = |number: u32| {
            let [u, ..] = Sampler::new(self.seed, [u32::MAX, 0], number).set(0);
            Pass { path, scene, emission, wavelengths: Wavelengths::sample(u), seed: self.seed, number }
        };
        let photons = pass(number).trace(self.count);
        let first = match (self.first_radius, number) {
            (Some(first), _) => first,
            (None, 0) => first_radius(path, &photons),
            (None, _) => first_radius(path, &pass(0).trace(self.count)),
        };
        let wavelengths = pass(number).wavelengths;
        self.first_radius = Some(first);
        let radius = (1..=number)
            .map(f64::from)
            .fold(first, |radius, step| radius * ((step + ALPHA - 1.0).max(ALPHA) / step).sqrt());
        Some(PhotonMap::new(photons, radius, self.count, wavelengths))
    }
}

/// The first radius: so many pixels, where most photons fell.
fn first_radius(path: &Path, photons: &[Photon]) -> f64 {
    let mut sizes: Vec<f64> = photons.iter().map(|photon| path.pixel_size(place(photon.point))).collect();
    let middle = sizes.len() / 2;
    if sizes.is_empty() {
        return 1.0;
    }
    let (_, median, _) = sizes.select_nth_unstable_by(middle, f64::total_cmp);
    FIRST_RADIUS * *median
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
    /// Follows so many, and keeps them where they fall, in the order in which they set out.
    fn trace(&self, count: u32) -> Vec<Photon> {
        let portions: Vec<Vec<Photon>> = (0..count.div_ceil(PORTION))
            .into_par_iter()
            .map_init(Buffers::default, |buffers, portion| {
                let first = portion * PORTION;
                let mut kept = Vec::new();
                for index in first..(first + PORTION).min(count) {
                    self.follow(index, buffers, &mut kept);
                }
                kept
            })
            .collect();
        portions.concat()
    }

    /// Follows one photon.
    fn follow(&self, index: u32, buffers: &mut Buffers, kept: &mut Vec<Photon>) {
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
            if !photon.travel(self.path, hit.t, draw[3], &buffers.media) {
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
            let bsdf = material.bsdf(&self.scene.textures, &interaction);
            let meeting = Meeting {
                sides: crossing.map(|crossing| [crossing.before, crossing.beyond]),
                around: buffers.media.current(media),
                is_tinted: interaction.vertex_color.is_some(),
                nm,
                hero_alone: photon.wavelengths.is_hero_alone(),
            };
            let surface = materials.colors(colors, number, &bsdf, &meeting);
            let wo = -photon.ray.direction;
            let lobes = Lobes::new(&surface, &interaction, wo);
            if events > 0 && lobes.is_lit() {
                let power = scaled(photon.power, self.fall_off(light, photon.travelled));
                kept.extend(photon.fallen(&interaction, power, density));
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
    /// Goes through the body that is there to a distance; false where it is scattered before.
    fn travel(&mut self, path: &Path, distance: f64, u: f64, media: &MediumStacks) -> bool {
        self.travelled += distance;
        let Some(inside) = media.current(self.media) else { return true };
        let Some(body) = path.materials.body(inside.material) else { return true };
        let [absorption, scattering] = body.at(self.wavelengths.nm());
        let left = plus(absorption, scattering).map(|extinction| attenuated(extinction, distance));
        self.power = times(self.power, left);
        if is_black(scattering) {
            return true;
        }
        let through = if self.wavelengths.is_hero_alone() { left[0] } else { mean(left) };
        self.power = scaled(self.power, 1.0 / through);
        u < through
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

    /// As it is kept; `None` where something is not finite.
    fn fallen(&self, interaction: &SurfaceInteraction, power: Spectral, density: f64) -> Option<Photon> {
        let photon = Photon {
            point: interaction.point.to_array().map(|x| x as f32),
            direction: self.ray.direction.to_array().map(|x| x as f32),
            normal: interaction.geometric_normal.as_vector().to_array().map(|x| x as f32),
            power: power.map(|x| x as f32),
            density: density as f32,
            hero_alone: self.wavelengths.is_hero_alone(),
        };
        let finite = photon.point.iter().chain(&photon.power).all(|x| x.is_finite());
        (finite && !is_black(power)).then_some(photon)
    }
}

impl PhotonMap {
    fn new(photons: Vec<Photon>, radius: f64, count: u32, wavelengths: Wavelengths) -> Self {
        let cells = photons.len().next_power_of_two().max(2);
        let size = 2.0 * radius;
        let mut keyed: Vec<(u32, Photon)> =
            photons.par_iter().map(|photon| (cell(coordinates(place(photon.point), size), cells), *photon)).collect();
        // Photons of one cell stay in the order in which they set out.
        keyed.par_sort_by_key(|(cell, _)| *cell);
        let mut starts = vec![0; cells + 1];
        for (cell, _) in &keyed {
            starts[*cell as usize + 1] += 1;
        }
        for cell in 0..cells {
            starts[cell + 1] += starts[cell];
        }
        let photons = keyed.into_iter().map(|(_, photon)| photon).collect();
        let disks = f64::from(count) * std::f64::consts::PI * radius * radius;
        Self { photons, starts, radius, disks, wavelengths }
    }

    /// The wavelengths of the pass.
    pub fn wavelengths(&self) -> &Wavelengths {
        &self.wavelengths
    }

    /// The weight of light that a path found by itself, which photons may have found too: `density` is that with which light sets out
    /// (as it is kept with photons), `cosine` and `sent` are those of the path where it was sent on.
    pub fn weight_of_path(&self, density: f64, cosine: f64, sent: f64) -> f64 {
        1.0 / (1.0 + self.disks * density * cosine / sent)
    }

    /// What the photons around a place make of the surface there, seen along a path.
    pub fn gather(&self, interaction: &SurfaceInteraction, lobes: &Lobes<'_>, hero_alone: bool) -> Spectral {
        let mut sum = BLACK;
        if self.photons.is_empty() {
            return sum;
        }
        let (point, normal) = (interaction.point, interaction.geometric_normal);
        let size = 2.0 * self.radius;
        let cells = self.starts.len() - 1;
        // The disk touches the cells around its corner: two in each direction.
        let low = coordinates(point - Vector3::new(self.radius, self.radius, self.radius), size);
        let mut seen = [u32::MAX; 8];
        for corner in 0..8 {
            let at = std::array::from_fn(|axis| low[axis].wrapping_add((corner >> axis) & 1));
            let cell = cell(at, cells);
            if seen[..corner as usize].contains(&cell) {
                continue;
            }
            seen[corner as usize] = cell;
            let range = self.starts[cell as usize] as usize..self.starts[cell as usize + 1] as usize;
            for photon in &self.photons[range] {
                let offset = place(photon.point) - point;
                if offset.length_squared() > self.radius * self.radius {
                    continue;
                }
                // Not around corners.
                if vector(photon.normal).dot(normal.as_vector()) < 0.5 {
                    continue;
                }
                let wi = -vector(photon.direction);
                let (value, sent) = lobes.evaluate(wi, Transport::Radiance);
                if sent <= 0.0 {
                    continue;
                }
                let cosine = lobes.flat_cosine(wi).abs();
                let ratio = self.disks * f64::from(photon.density) * cosine / sent;
                let weight = if ratio.is_finite() { ratio / (1.0 + ratio) } else { 1.0 };
                let power = photon.power.map(f64::from);
                // Where both have given up the others, the hero counts four times, not sixteen.
                let power = if hero_alone && photon.hero_alone { scaled(power, 0.25) } else { power };
                sum = plus(sum, scaled(times(value, power), weight / (cosine * self.disks)));
            }
        }
        sum
    }
}

/// The cell of a place.
fn coordinates(point: Point3, size: f64) -> [i64; 3] {
    point.to_array().map(|x| {
        let cell = (x / size).floor();
        // Saturates, which puts what is very far away into few cells.
        cell as i64
    })
}

/// The place of a cell in a table whose size is a power of two. (Teschner et al., "Optimized Spatial Hashing", VMV 2003.)
fn cell([x, y, z]: [i64; 3], cells: usize) -> u32 {
    let mixed = (x.wrapping_mul(73_856_093)) ^ (y.wrapping_mul(19_349_663)) ^ (z.wrapping_mul(83_492_791));
    let mixed = mixed as u64 ^ (mixed as u64 >> 17);
    (mixed & (cells as u64 - 1)) as u32
}

fn place(point: [f32; 3]) -> Point3 {
    Point3::from(point.map(f64::from))
}

fn vector(v: [f32; 3]) -> Vector3 {
    Vector3::from(v.map(f64::from))
}
