//! Watching rays: the same code that renders a pixel tells what it did.
//!
//! The tracing loop and the integrator report every ray, hit, boundary, term and answer to an [`Observer`], each where it is
//! computed. [`NoObserver`] compiles away; a [`RayTree`] remembers all, and its shares add up to the pixel, since each is
//! recorded where it is added.

use snell_math::{Normal3, Rgb, Vector3};

use crate::interaction::SurfaceInteraction;
use crate::material::Bsdf;
use crate::task::{Band, Cut, Inside, RayKind, RayTask, ShadowQuestion, Term};

/// Sees everything the tracing loop does, in order: ray after ray where it wants [details](Self::DETAILS), else rays of several samples side
/// by side; what concerns one sample is in the same order. All methods do nothing by default.
pub trait Observer {
    /// False where nothing is seen, so that what would only be seen need not be computed.
    const WATCHES: bool = true;
    /// False where surfaces, boundaries and what blocks a light are not told, which takes time.
    const DETAILS: bool = Self::WATCHES;

    /// A ray was spawned; its parent is known already.
    fn ray(&mut self, task: &RayTask) {
        let _ = task;
    }
    /// A ray met a surface, or nothing; on the way it was inside of `medium`, or outside of all bodies.
    fn hit(&mut self, task: &RayTask, interaction: Option<&SurfaceInteraction>, medium: Option<Inside>) {
        let _ = (task, interaction, medium);
    }
    /// What the body that a ray went through left of its light on the way to what it met.
    fn travelled(&mut self, task: u32, transmittance: Rgb) {
        let _ = (task, transmittance);
    }
    /// The wavelengths that a path's ray carries, in nanometres: its hero first, which decides where it goes.
    fn wavelengths(&mut self, task: u32, nm: &[f64]) {
        let _ = (task, nm);
    }
    /// A medium scattered the light of a ray at a distance, before it came to what it met.
    fn scattered(&mut self, task: u32, distance: f64) {
        let _ = (task, distance);
    }
    /// What the surface that a ray met does with light there.
    fn surface(&mut self, task: u32, bsdf: &Bsdf) {
        let _ = (task, bsdf);
    }
    /// A ray met a boundary of transparent bodies that has an effect: once, or once for each band that it splits into.
    fn boundary(&mut self, task: u32, boundary: &BoundaryCrossing) {
        let _ = (task, boundary);
    }
    /// A term was added to a sample: the share has the ray's throughput in it. One that a light adds follows its shadow question.
    fn term(&mut self, task: u32, term: Term, share: Rgb) {
        let _ = (task, term, share);
    }
    /// A surface on a shadow ray's way let some of the light through that a term would add; the answer to its question follows, with others.
    fn filtered(&mut self, task: u32, term: Term) {
        let _ = (task, term);
    }
    /// A shadow ray came to a surface, or after the last one to its light; the answer to its question follows.
    fn shadow_step(&mut self, step: &ShadowStep) {
        let _ = step;
    }
    /// A shadow question was answered: the share of the light that arrives.
    fn shadow(&mut self, question: &ShadowQuestion, transmittance: Rgb) {
        let _ = (question, transmittance);
    }
    /// A ray of a kind was not followed, and this weight is lost to the sample.
    fn cut(&mut self, parent: u32, kind: RayKind, why: Cut, weight: Rgb) {
        let _ = (parent, kind, why, weight);
    }
    /// Light met total internal reflection.
    fn total_internal_reflection(&mut self, task: u32) {
        let _ = task;
    }
}

/// Sees nothing and costs nothing.
#[derive(Clone, Copy, Debug, Default)]
pub struct NoObserver;

impl Observer for NoObserver {
    const WATCHES: bool = false;
}

/// What happened where a ray met the boundary between two media.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BoundaryCrossing {
    /// The bodies before the boundary and beyond it; outside of all where `None`.
    pub media: [Option<Inside>; 2],
    /// Their indices of refraction, in the band; at the hero of a path.
    pub indices: [f64; 2],
    /// The band of white light that this is about, where it splits here or was split before.
    pub band: Option<Band>,
    /// The normal that the directions were reckoned with, on the incident ray's side.
    pub normal: Normal3,
    /// The refracted direction; `None` under total internal reflection.
    pub refracted: Option<Vector3>,
    /// Fresnel's reflectance for unpolarised light, 1 under total internal reflection.
    pub reflectance: f64,
    /// The shares follow Fresnel's equations; or else the author's coefficients alone.
    pub fresnel: bool,
    /// What the reflected and the refracted ray are weighted with, the author's coefficients in it.
    pub weights: [Rgb; 2],
    /// The part of the ray's light that this is about: white, or the band's where it splits here.
    pub share: Rgb,
}

/// A shadow ray's way to the next surface, and what that surface lets through.
#[derive(Clone, Copy, Debug)]
pub struct ShadowStep {
    /// What it came to; the light where `None`.
    pub surface: Option<SurfaceInteraction>,
    /// The body that it went through on this part of its way.
    pub medium: Option<Inside>,
    /// What that body left of the light on this part of its way.
    pub absorption: Rgb,
    /// What the surface lets through: white where it has no effect, black where it is opaque.
    pub transmittance: Rgb,
    /// Fresnel's reflectance there.
    pub reflectance: f64,
}

/// Remembers everything that happened to the rays of one sample.
#[derive(Clone, Debug, Default)]
pub struct RayTree {
    /// The rays in the order in which they were spawned: generation by generation, the camera's first.
    pub rays: Vec<TracedRay>,
    /// The shares of the sample in the order in which they were added to it.
    pub shares: Vec<Share>,
    /// The steps of a shadow ray whose question is not answered yet.
    steps: Vec<ShadowStep>,
}

/// One term's part of a sample.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Share {
    /// The id of the ray's task.
    pub task: u32,
    /// Where it comes from.
    pub term: Term,
    /// The value, the ray's throughput in it.
    pub value: Rgb,
    /// For what a light adds: the place of its answer in [`TracedRay::shadows`].
    pub shadow: Option<u32>,
}

/// One ray of a [`RayTree`].
#[derive(Clone, Debug)]
pub struct TracedRay {
    /// The ray as it was spawned.
    pub task: RayTask,
    /// What it met: `None` while unknown, `Some(None)` where it left the scene.
    pub hit: Option<Option<SurfaceInteraction>>,
    /// The body that it went through; outside of all where `None`.
    pub medium: Option<Inside>,
    /// What that body left of its light.
    pub transmittance: Rgb,
    /// The wavelengths that it carries, in nanometres, the hero first; none where it carries all light, or a band.
    pub wavelengths: Vec<f64>,
    /// How far it went until that body scattered its light.
    pub scattered: Option<f64>,
    /// What the surface does with light; `None` where it met none, or one without effect.
    pub bsdf: Option<Bsdf>,
    /// The boundary that it met, of each band.
    pub boundaries: Vec<BoundaryCrossing>,
    /// The lights that were asked for: which, whether the highlight would matter, and the share that arrived.
    pub shadows: Vec<AnsweredShadow>,
    /// Rays that were not followed.
    pub cuts: Vec<CutRay>,
    /// It met total internal reflection.
    pub total_internal_reflection: bool,
}

/// A ray that was not followed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CutRay {
    /// What would have made it.
    pub kind: RayKind,
    /// Why it was not followed.
    pub why: Cut,
    /// What it would have carried.
    pub weight: Rgb,
}

/// A shadow question with its answer.
#[derive(Clone, Debug)]
pub struct AnsweredShadow {
    /// The question.
    pub question: ShadowQuestion,
    /// The share of the light that arrives, by colour.
    pub transmittance: Rgb,
    /// The surfaces on the way, and the light where it was reached.
    pub steps: Vec<ShadowStep>,
}

impl RayTree {
    /// The sum of all shares: the sample's colour, to the last bit, since it is summed in the order in which they were added.
    pub fn sum(&self) -> Rgb {
        self.shares.iter().fold(Rgb::BLACK, |sum, share| sum + share.value)
    }

    /// The shares that one ray added.
    pub fn shares_of(&self, task: u32) -> impl Iterator<Item = &Share> {
        self.shares.iter().filter(move |share| share.task == task)
    }

    fn entry(&mut self, id: u32) -> Option<&mut TracedRay> {
        // Numbered in the order in which they are spawned, where there is one camera ray.
        let place = match self.rays.get(id as usize) {
            Some(ray) if ray.task.id == id => Some(id as usize),
            _ => self.rays.iter().rposition(|ray| ray.task.id == id),
        };
        self.rays.get_mut(place?)
    }
}

impl Observer for RayTree {
    fn ray(&mut self, task: &RayTask) {
        self.rays.push(TracedRay {
            task: *task,
            hit: None,
            medium: None,
            transmittance: Rgb::WHITE,
            wavelengths: Vec::new(),
            scattered: None,
            bsdf: None,
            boundaries: Vec::new(),
            shadows: Vec::new(),
            cuts: Vec::new(),
            total_internal_reflection: false,
        });
    }
    fn hit(&mut self, task: &RayTask, interaction: Option<&SurfaceInteraction>, medium: Option<Inside>) {
        if let Some(entry) = self.entry(task.id) {
            entry.hit = Some(interaction.copied());
            entry.medium = medium;
        }
    }
    fn travelled(&mut self, task: u32, transmittance: Rgb) {
        if let Some(entry) = self.entry(task) {
            entry.transmittance = transmittance;
        }
    }
    fn wavelengths(&mut self, task: u32, nm: &[f64]) {
        if let Some(entry) = self.entry(task) {
            entry.wavelengths = nm.to_vec();
        }
    }
    fn scattered(&mut self, task: u32, distance: f64) {
        if let Some(entry) = self.entry(task) {
            entry.scattered = Some(distance);
        }
    }
    fn surface(&mut self, task: u32, bsdf: &Bsdf) {
        if let Some(entry) = self.entry(task) {
            entry.bsdf = Some(*bsdf);
        }
    }
    fn boundary(&mut self, task: u32, boundary: &BoundaryCrossing) {
        if let Some(entry) = self.entry(task) {
            entry.boundaries.push(*boundary);
        }
    }
    fn term(&mut self, task: u32, term: Term, share: Rgb) {
        let shadow = match term {
            Term::Diffuse(_) | Term::Specular(_) | Term::Scattering(_) => {
                self.entry(task).and_then(|entry| (entry.shadows.len() as u32).checked_sub(1))
            }
            Term::Background | Term::Emission | Term::Ambient | Term::Photons => None,
        };
        self.shares.push(Share { task, term, value: share, shadow });
    }
    fn shadow_step(&mut self, step: &ShadowStep) {
        self.steps.push(*step);
    }
    fn shadow(&mut self, question: &ShadowQuestion, transmittance: Rgb) {
        let steps = std::mem::take(&mut self.steps);
        if let Some(entry) = self.entry(question.task) {
            entry.shadows.push(AnsweredShadow { question: *question, transmittance, steps });
        }
    }
    fn cut(&mut self, parent: u32, kind: RayKind, why: Cut, weight: Rgb) {
        if let Some(entry) = self.entry(parent) {
            entry.cuts.push(CutRay { kind, why, weight });
        }
    }
    fn total_internal_reflection(&mut self, task: u32) {
        if let Some(entry) = self.entry(task) {
            entry.total_internal_reflection = true;
        }
    }
}
