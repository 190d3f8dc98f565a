//! Recursive ray tracing: the lecture's `RT_shade`, with Fresnel's equations, nested bodies, absorption and dispersion.
//!
//! Whitted, "An Improved Illumination Model for Shaded Display", CACM 23(6), 1980; `shade` follows the order of the lecture:
//! the ambient term, then each light, then reflection, then refraction. World space; `wo` leads to the viewer, `wi` to a
//! light, both leaving the surface. Everything is written for rays side by side, see [`snell_math::lanes`]; lanes count from the
//! place of the first.

use snell_math::lanes::{Bits, Floats, LaneColor, LaneVector, Lanes, WIDTH};
use snell_math::{Normal3, Ray, Rgb, Vector3};
use snell_scene::scene::Medium;

use super::dispersion::Dispersion;
use super::{
    Integrator, LaneQuestions, ShadedRays, Sink, Spawn, look_around, scattering, seen_at_once, seen_in_directions,
    view_of,
};
use crate::camera::{Camera, Projection};
use crate::compile::CompiledScene;
use crate::geometry::{Geometry, HitRows, RayRow};
use crate::interaction::{LaneSurface, SurfaceRows};
use crate::light::Light;
use crate::material::{LaneBsdf, Material};
use crate::observe::{BoundaryCrossing, Observer};
use crate::optics::{Stretches, beer_lambert, fresnel_dielectric_lanes, reflect_lanes, refract_lanes};
use crate::task::{Band, Crossing, Inside, MediumStack, RayKind, RayRows, RayTask, Term, column, set_column};
use crate::texture::{Footprint, LaneCoordinates, SeenAtOnce, ViewProjection};

/// Recursive ray tracing over lights without extent.
#[derive(Clone, Debug)]
pub struct Whitted {
    dispersion: Dispersion,
    camera: Camera,
    view: ViewProjection,
}

impl Whitted {
    /// For a scene seen by a camera, splitting white light into at most `bands` wavelength bands at dispersive surfaces.
    pub fn new(scene: &CompiledScene, camera: &Camera, bands: u32) -> Self {
        Self::at_wavelength(scene, camera, bands, None)
    }

    /// As [`Whitted::new`], with all light bent as it is at one wavelength, in nanometres, where that is given.
    pub fn at_wavelength(scene: &CompiledScene, camera: &Camera, bands: u32, only_nm: Option<f64>) -> Self {
        let dispersion = Dispersion::new(scene, bands, camera.pixel_angle(), only_nm);
        Self { dispersion, camera: camera.clone(), view: view_of(camera) }
    }

    /// The wavelength that stands for a band of this scene, in nanometres.
    pub fn wavelength_nm(&self, band: Band) -> Option<f64> {
        self.dispersion.wavelength_nm(band)
    }

    /// What a ray sees that leaves the scene.
    fn background<O: Observer>(&self, scene: &CompiledScene, task: &RayTask, out: &Sink<'_, O>) -> Rgb {
        let (background, direction) = (&scene.background, task.ray.direction);
        if !background.is_picture() {
            return background.evaluate(direction, &SeenAtOnce::POINT, &self.view);
        }
        let differential = out.differential(task.id);
        // The parallel rays of an orthographic camera see a photograph by where they are, not by where they go.
        if task.kind == RayKind::Camera && self.camera.projection() == Projection::Orthographic {
            let position = self.camera.picture_position(task.ray.origin);
            let seen = seen_at_once(&self.camera, &task.ray, position, differential.unwrap_or_default());
            return background.evaluate_at_pixel(position, direction, &seen);
        }
        background.evaluate(direction, &seen_in_directions(differential), &self.view)
    }
}

/// What most functions of this file are given: rays that met surfaces of one material, and where results go.
struct Shading<'a, 'b, 's, L, O> {
    scene: &'a CompiledScene,
    rays: ShadedRays<'a>,
    surfaces: &'a SurfaceRows,
    surface: LaneSurface<L>,
    /// To the viewers.
    wo: LaneVector<L>,
    out: &'b mut Sink<'s, O>,
}

/// A boundary of transparent bodies as rays meet it.
struct Boundary<'a, L: Lanes> {
    crossings: &'a [Crossing; WIDTH],
    /// On the side of `wo`.
    normal: LaneVector<L>,
    /// The shares follow Fresnel's equations, scaled by the coefficients; or else are the coefficients.
    fresnel: bool,
    /// The reflected ray's coefficient.
    reflect: LaneColor<L::Floats>,
    /// The refracted ray's coefficient.
    transmit: LaneColor<L::Floats>,
}

impl Integrator for Whitted {
    type State = ();

    #[inline(always)]
    fn shade<L: Lanes, O: Observer>(
        &self,
        scene: &CompiledScene,
        (): &mut (),
        rays: &RayRows,
        at: usize,
        active: Bits,
        hits: &HitRows,
        surfaces: &mut SurfaceRows,
        out: &mut Sink<'_, O>,
    ) {
        let met = Bits(hits.met().0 >> at) & active;
        // What the bodies that the rays travel in do to them on the way.
        let weakened;
        let throughput = if active.lanes().all(|lane| rays.media[at + lane] == MediumStack::EMPTY) {
            &rays.throughput
        } else {
            weakened = travel::<L, O>(scene, rays, at, active, met, hits, out);
            &weakened
        };
        let rays = ShadedRays { rows: rays, at, throughput };
        let missed = active.without(met);
        if missed.any() {
            self.shade_missed::<L, O>(scene, &rays, missed, out);
        }
        if met.is_empty() {
            return;
        }
        let row = RayRow { origin: &rays.rows.origin, direction: &rays.rows.direction };
        scene.geometry.surfaces::<L>(row, at, hits, met, surfaces);
        look_around(scene, rays.rows, at, met, hits, surfaces, out);
        if out.is_watched() {
            for lane in met.lanes() {
                let interaction = scene.geometry.interaction_of(hits, surfaces, at + lane);
                out.met(&rays.task(lane), Some(&interaction));
            }
        }
        let mut rest = met;
        while rest.any() {
            let material = surfaces.material[at + rest.lowest()];
            let mut same = Bits::NONE;
            for lane in rest.lanes() {
                same |= Bits(u8::from(surfaces.material[at + lane] == material) << lane);
            }
            rest = rest.without(same);
            self.shade_material::<L, O>(scene, material, &rays, same, hits, surfaces, out);
        }
    }
}

impl Whitted {
    /// Rays that leave the scene.
    #[inline(always)]
    fn shade_missed<L: Lanes, O: Observer>(
        &self,
        scene: &CompiledScene,
        rays: &ShadedRays<'_>,
        missed: Bits,
        out: &mut Sink<'_, O>,
    ) {
        if out.is_watched() {
            missed.lanes().for_each(|lane| out.met(&rays.task(lane), None));
        }
        let color = match scene.background.constant() {
            Some(color) => LaneColor::splat(color),
            None => {
                let mut rows = [[0.0; WIDTH]; 3];
                for lane in missed.lanes() {
                    let color = self.background(scene, &rays.task(lane), out);
                    set_column(&mut rows, lane, color.to_array());
                }
                LaneColor::load(&rows, 0)
            }
        };
        out.add::<L>(rays, missed, Term::Background, color);
    }

    /// Rays that met surfaces of one material.
    #[expect(clippy::too_many_arguments, reason = "as `shade`, of which it is a part")]
    #[inline(always)]
    fn shade_material<L: Lanes, O: Observer>(
        &self,
        scene: &CompiledScene,
        number: u32,
        rays: &ShadedRays<'_>,
        met: Bits,
        hits: &HitRows,
        surfaces: &SurfaceRows,
        out: &mut Sink<'_, O>,
    ) {
        let material = &scene.materials[number as usize];
        let bsdf = lobes::<L>(scene, material, rays.at, met, hits, surfaces);
        let surface = LaneSurface::<L>::load(surfaces, rays.at);
        let direction = rays.direction::<L>();

        let mut lanes = met;
        let mut crossings = [Crossing::default(); WIDTH];
        if let Some(body) = &material.body {
            let leaving = surface.is_outward(direction);
            let origin = LaneVector::load(&rays.rows.origin, rays.at);
            let at_origin = Geometry::are_at_origin(origin, L::load(&hits.t, rays.at));
            for lane in met.lanes() {
                let from = rays.at + lane;
                let inside = Inside { solid: surfaces.solid[from], material: number, priority: body.priority };
                let stack = rays.rows.media[from];
                let crossing = out.media.cross(stack, inside, leaving.has(lane), at_origin.has(lane));
                crossings[lane] = crossing;
                // A boundary that a body of higher priority covers is not there.
                if crossing.is_without_effect() {
                    lanes = lanes.without(Bits::lane(lane));
                    let direction = Vector3::from(column(&rays.rows.direction, from));
                    let origin = LaneSurface::<f64>::load(surfaces, from).spawn_origin(direction.into());
                    out.pass(&rays.task(lane), Ray::new(origin.into(), direction), crossing.after);
                }
            }
            if lanes.is_empty() {
                return;
            }
        }

        if out.is_detailed() {
            for lane in lanes.lanes() {
                out.observer().surface(rays.rows.notes[rays.at + lane].id, &bsdf.lane(lane));
            }
        }
        let mut shading = Shading { scene, rays: *rays, surfaces, surface, wo: -direction, out };
        shading.add_local_terms(lanes, &bsdf);
        let mirrored = lanes.without(bsdf.mirror.is_black());
        if mirrored.any() {
            shading.spawn_reflected(mirrored, bsdf.mirror);
        }
        if let Some(fresnel) = bsdf.fresnel {
            let normal = shading.surface.consistent_normal(shading.wo);
            let LaneBsdf { reflect, transmit, .. } = bsdf;
            let boundary = Boundary { crossings: &crossings, normal, fresnel, reflect, transmit };
            self.spawn_at_interface(lanes, &boundary, &mut shading);
        }
    }

    /// Reflection and refraction at the boundary of a transparent body.
    #[inline(always)]
    fn spawn_at_interface<L: Lanes, O: Observer>(
        &self,
        lanes: Bits,
        boundary: &Boundary<'_, L>,
        shading: &mut Shading<'_, '_, '_, L, O>,
    ) {
        let mut split = Bits::NONE;
        if !self.dispersion.is_idle() {
            split = self.spawn_split(lanes, boundary, shading);
        }
        let together = lanes.without(split);
        if together.any() {
            let white = LaneColor::splat(Rgb::WHITE);
            let reflected = self.refract_band(together, boundary, None, white, shading);
            shading.spawn_reflected(together, reflected);
        }
    }

    /// Those rays of white light that split into bands, one after the other; tells which they were.
    #[inline(never)]
    fn spawn_split<L: Lanes, O: Observer>(
        &self,
        lanes: Bits,
        boundary: &Boundary<'_, L>,
        shading: &mut Shading<'_, '_, '_, L, O>,
    ) -> Bits {
        let (mut wo, mut normal) = ([[0.0; WIDTH]; 3], [[0.0; WIDTH]; 3]);
        shading.wo.store(&mut wo, 0);
        boundary.normal.store(&mut normal, 0);
        let (mut reflect, mut transmit) = ([[0.0; WIDTH]; 3], [[0.0; WIDTH]; 3]);
        boundary.reflect.store(&mut reflect, 0);
        boundary.transmit.store(&mut transmit, 0);
        let Shading { scene, rays, surfaces, .. } = *shading;
        let mut split = Bits::NONE;
        for lane in lanes.lanes() {
            let notes = &rays.rows.notes[rays.at + lane];
            if notes.band.is_some() {
                continue;
            }
            let crossing = boundary.crossings[lane];
            let sides = [crossing.before, crossing.beyond];
            let (wo, normal) = (LaneVector::<f64>::load(&wo, lane), LaneVector::<f64>::load(&normal, lane));
            let Some(bands) = self.dispersion.split(sides, wo.into(), normal.into(), notes.split) else {
                continue;
            };
            split |= Bits::lane(lane);
            let surface = LaneSurface::<f64>::load(surfaces, rays.at + lane);
            let mut alone = Shading { scene, rays: rays.only(lane), surfaces, surface, wo, out: &mut *shading.out };
            let boundary = Boundary {
                crossings: &[crossing; WIDTH],
                normal,
                fresnel: boundary.fresnel,
                reflect: LaneColor::<f32>::load(&reflect, lane),
                transmit: LaneColor::<f32>::load(&transmit, lane),
            };
            // Each band for itself: the reflected shares come together again, since reflection does not disperse.
            let black = LaneColor::<f32>::splat(Rgb::BLACK);
            let reflected = bands.fold(black, |sum, (band, weight)| {
                let weight = LaneColor::splat(weight);
                sum + weight * self.refract_band(Bits::lane(0), &boundary, Some(band), weight, &mut alone)
            });
            alone.spawn_reflected(Bits::lane(0), reflected);
        }
        split
    }

    /// Spawns the refracted rays, of one band of white light or of what their parents carry, with a weight; returns the
    /// coefficients of the reflected ones.
    #[inline(always)]
    fn refract_band<L: Lanes, O: Observer>(
        &self,
        lanes: Bits,
        boundary: &Boundary<'_, L>,
        band: Option<Band>,
        weight: LaneColor<L::Floats>,
        shading: &mut Shading<'_, '_, '_, L, O>,
    ) -> LaneColor<L::Floats> {
        let Shading { rays, surfaces, surface, wo, .. } = *shading;
        let (mut before, mut beyond, mut after) = ([1.0; WIDTH], [1.0; WIDTH], [MediumStack::EMPTY; WIDTH]);
        for lane in lanes.lanes() {
            let crossing = &boundary.crossings[lane];
            let band = rays.rows.notes[rays.at + lane].band.or(band);
            before[lane] = self.dispersion.index(crossing.before, band);
            beyond[lane] = self.dispersion.index(crossing.beyond, band);
            after[lane] = crossing.after;
        }
        let (eta_before, eta_beyond) = (L::load(&before, 0), L::load(&beyond, 0));
        let eta = eta_before / eta_beyond;
        let (refracts, direction) = refract_lanes(wo, boundary.normal, eta);
        let reflectance = boundary.reflectance(wo, eta_before, eta_beyond);
        let (reflect_share, transmit_share) = boundary.shares(reflectance, refracts);
        if shading.out.is_detailed() {
            let shares = [reflect_share, transmit_share, weight];
            boundary.tell(lanes, (&before, &beyond), (refracts, direction), reflectance, shares, band, shading);
        }
        let refracted = lanes & refracts;
        shading.out.total_internal_reflection(&rays, lanes.without(refracts));
        if refracted.is_empty() {
            return reflect_share;
        }
        let (followed, throughput) =
            shading.out.follow::<L>(&rays, RayKind::Refracted, refracted, weight * transmit_share);
        if followed.any() {
            let flat = surface.flat_normal(wo);
            // On a smooth mesh the shading normal may send it back to the side it came from; then the flat one decides.
            let through = flat.dot(direction).lt(L::splat(0.0));
            let mut direction = direction;
            if followed.without(through).any() {
                let (refracts, by_flat) = refract_lanes(wo, flat, eta);
                direction = direction.or_where_not(through, by_flat.or_where_not(refracts, -wo));
            }
            let (kind, origin, media) = (RayKind::Refracted, surface.spawn_origin(direction), Some(&after));
            let spawn = Spawn { kind, origin, direction, throughput, media, band, surfaces, eta };
            shading.out.spawn(&rays, followed, &spawn);
        }
        reflect_share
    }
}

/// What the bodies that rays travel in do to them on the way to what they meet: scatters over that stretch, and gives what
/// absorption leaves of what they carry.
#[inline(never)]
fn travel<L: Lanes, O: Observer>(
    scene: &CompiledScene,
    rays: &RayRows,
    at: usize,
    active: Bits,
    met: Bits,
    hits: &HitRows,
    out: &mut Sink<'_, O>,
) -> [[f32; WIDTH]; 3] {
    let mut stretches = Stretches::NONE;
    for lane in active.lanes() {
        let Some(medium) = medium_around(scene, rays.media[at + lane], out) else { continue };
        let distance = if met.has(lane) { hits.t[at + lane] } else { f64::INFINITY };
        let extinction = medium.absorption + medium.scattering;
        if !medium.scattering.is_black() {
            scattering::gather(scene, &rays.task(at + lane), medium, distance, out);
        }
        if out.is_watched() {
            out.observer().travelled(rays.notes[at + lane].id, beer_lambert(extinction, distance));
        }
        stretches.put(at + lane, extinction, distance);
    }
    let mut throughput = rays.throughput;
    if stretches.any() {
        stretches.absorb::<L>(&mut throughput, at);
    }
    throughput
}

/// What the innermost of some bodies is filled with, where light does not pass it unchanged.
#[inline]
fn medium_around<'a, O>(scene: &'a CompiledScene, media: MediumStack, out: &Sink<'_, O>) -> Option<&'a Medium> {
    let inside = out.media.current(media)?;
    let body = scene.materials[inside.material as usize].body.as_ref()?;
    (!body.medium.is_clear()).then_some(&body.medium)
}

/// The lobes of one material where rays met it.
#[inline(always)]
fn lobes<L: Lanes>(
    scene: &CompiledScene,
    material: &Material,
    at: usize,
    met: Bits,
    hits: &HitRows,
    surfaces: &SurfaceRows,
) -> LaneBsdf<L> {
    let is_colored = |lane: usize| surfaces.whole[at + lane].is_some_and(|whole| whole.vertex_color.is_some());
    match material.constant_bsdf() {
        Some(constant) if !met.lanes().any(is_colored) => LaneBsdf::splat(constant),
        None if material.is_plain() && met.without(surfaces.unplaced).is_empty() => {
            let surface = LaneSurface::<L>::load(surfaces, at);
            let coordinates = LaneCoordinates { point: surface.point, inside: surface.inside() };
            material.lane_bsdf(&scene.textures, &coordinates)
        }
        _ => LaneBsdf::gather(met.lanes().map(|lane| {
            let interaction = scene.geometry.interaction_of(hits, surfaces, at + lane);
            let footprint =
                if scene.sees_pictures() { &surfaces.around[at + lane].footprint } else { &Footprint::SHARP };
            (lane, material.bsdf(&scene.textures, &interaction, footprint))
        })),
    }
}

impl<L: Lanes> Boundary<'_, L> {
    /// Fresnel's reflectance.
    #[inline(always)]
    fn reflectance(&self, wo: LaneVector<L>, eta_before: L, eta_beyond: L) -> L {
        fresnel_dielectric_lanes(self.normal.dot(wo), eta_before, eta_beyond)
    }

    /// The coefficients of the reflected and the refracted rays.
    ///
    /// Under total internal reflection all that either would carry is reflected: the lecture's function has no transmitted
    /// ray there and says nothing of its share, but light does not vanish.
    #[inline(always)]
    fn shares(&self, reflectance: L, refracts: Bits) -> (LaneColor<L::Floats>, LaneColor<L::Floats>) {
        let Self { fresnel, reflect, transmit, .. } = *self;
        let black = LaneColor::splat(Rgb::BLACK);
        if fresnel {
            let reflectance = reflectance.to_floats();
            let transmittance = L::Floats::splat(1.0) - reflectance;
            let reflected = (reflect * reflectance).or_where_not(refracts, reflect);
            (reflected, (transmit * transmittance).or_where_not(refracts, black))
        } else {
            let reflected = reflect.or_where_not(refracts, reflect + transmit);
            (reflected, transmit.or_where_not(refracts, black))
        }
    }
}

impl<L: Lanes> Boundary<'_, L> {
    /// Tells a watcher what happens here: to which indices, where light goes on and whither, how much is reflected, and what the
    /// reflected and the refracted ray and this part of the light are weighted with.
    #[expect(clippy::too_many_arguments, reason = "what its only caller has worked out")]
    #[inline(never)]
    fn tell<O: Observer>(
        &self,
        lanes: Bits,
        (before, beyond): (&[f64; WIDTH], &[f64; WIDTH]),
        (refracts, direction): (Bits, LaneVector<L>),
        reflectance: L,
        shares: [LaneColor<L::Floats>; 3],
        band: Option<Band>,
        shading: &mut Shading<'_, '_, '_, L, O>,
    ) {
        let rays = shading.rays;
        let [mut normals, mut directions] = [[[0.0; WIDTH]; 3]; 2];
        self.normal.store(&mut normals, 0);
        direction.store(&mut directions, 0);
        let mut reflectances = [0.0; WIDTH];
        reflectance.store(&mut reflectances, 0);
        let mut weights = [[[0.0; WIDTH]; 3]; 3];
        for (share, weights) in shares.iter().zip(&mut weights) {
            share.store(weights, 0);
        }
        for lane in lanes.lanes() {
            let (notes, crossing) = (&rays.rows.notes[rays.at + lane], &self.crossings[lane]);
            let refracts = refracts.has(lane);
            let [reflected, transmitted, share] = [0, 1, 2].map(|i: usize| Rgb::from(column(&weights[i], lane)));
            let crossing = BoundaryCrossing {
                media: [crossing.before, crossing.beyond],
                indices: [before[lane], beyond[lane]],
                band: notes.band.or(band),
                normal: Normal3::from(Vector3::from(column(&normals, lane))),
                refracted: refracts.then(|| Vector3::from(column(&directions, lane))),
                reflectance: if refracts { reflectances[lane] } else { 1.0 },
                fresnel: self.fresnel,
                weights: [reflected, transmitted],
                share,
            };
            shading.out.observer().boundary(notes.id, &crossing);
        }
    }
}

impl<L: Lanes, O: Observer> Shading<'_, '_, '_, L, O> {
    /// Emission, the ambient term, and a question to each light that may show.
    #[inline(always)]
    fn add_local_terms(&mut self, lanes: Bits, bsdf: &LaneBsdf<L>) {
        let emitting = lanes.without(bsdf.emission.is_black());
        if emitting.any() {
            self.out.add::<L>(&self.rays, emitting, Term::Emission, bsdf.emission);
        }
        let ambient = bsdf.ambient * LaneColor::splat(self.scene.ambient);
        let lit_by_ambient = lanes.without(ambient.is_black());
        if lit_by_ambient.any() {
            self.out.add::<L>(&self.rays, lit_by_ambient, Term::Ambient, ambient);
        }
        let lit = lanes & bsdf.is_lit();
        if lit.is_empty() {
            return;
        }
        // The side that is lit: the viewer's, or the outward one of surfaces that have but one.
        let side = if bsdf.one_sided { L::splat(1.0) } else { self.surface.side(self.wo) };
        for (light, number) in self.scene.lights.iter().zip(0..) {
            self.ask_light(light, number, lit, bsdf, side);
        }
    }

    /// The question to one light, with the terms that it would add; `side` is 1 where the outward side is lit, −1 where the
    /// other is.
    #[inline(always)]
    fn ask_light(&mut self, light: &Light, number: u32, lanes: Bits, bsdf: &LaneBsdf<L>, side: L) {
        let (lit, arriving) = light.illuminate_lanes(self.surface.point);
        let wi = arriving.to_light;
        let normal = self.surface.shading_normal * side;
        // No question where the surface itself is in the way.
        let zero = L::splat(0.0);
        let turned_away = normal.dot(wi).le(zero) | (self.surface.geometric_normal.dot(wi) * side).le(zero);
        let asking = (lanes & lit).without(turned_away);
        if asking.is_empty() {
            return;
        }
        let local = bsdf.reflect_light(normal, self.wo, wi);
        let weight = self.rays.throughput::<L>() * arriving.irradiance;
        let origin = self.surface.spawn_origin(wi);
        // From where the ray really starts: the light may be as near as the offset.
        let distance = arriving.distance - (origin - self.surface.point).dot(wi);
        let [diffuse, specular] = local;
        let shares = [weight * diffuse, weight * specular];
        let questions = LaneQuestions { origin, direction: wi, distance, shares, light: number };
        self.out.ask_light(&self.rays, asking, &questions);
    }

    /// The mirrored rays, on the side they came from.
    #[inline(always)]
    fn spawn_reflected(&mut self, lanes: Bits, weight: LaneColor<L::Floats>) {
        let lanes = if self.out.rules.weightless_rays { lanes } else { lanes.without(weight.is_black()) };
        if lanes.is_empty() {
            return;
        }
        let Self { rays, surfaces, surface, wo, .. } = *self;
        let (followed, throughput) = self.out.follow::<L>(&rays, RayKind::Reflected, lanes, weight);
        if followed.any() {
            let mut direction = reflect_lanes(wo, surface.consistent_normal(wo));
            let flat = surface.flat_normal(wo);
            // On a smooth mesh the shading normal may send it through the surface; then the flat one decides.
            let back = flat.dot(direction).gt(L::splat(0.0));
            if followed.without(back).any() {
                direction = direction.or_where_not(back, reflect_lanes(wo, flat));
            }
            let (kind, origin) = (RayKind::Reflected, surface.spawn_origin(direction));
            let (media, band, eta) = (None, None, L::splat(1.0));
            let spawn = Spawn { kind, origin, direction, throughput, media, band, surfaces, eta };
            self.out.spawn(&rays, followed, &spawn);
        }
    }
}
