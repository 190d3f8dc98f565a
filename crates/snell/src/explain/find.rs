//! Pixels that show a phenomenon, the clearest first, so that nobody has to hunt for them.
//!
//! The seven rays are those of Watt's figure (*3D Computer Graphics*): each is looked for in what the first sample of a pixel did. A
//! picture is searched at most [`MOST_PIXELS`] pixels at a time: a coarse grid first, and then the pixels around what was found.

use std::str::FromStr;

use rayon::prelude::*;
use snell_math::Rgb;

use crate::compile::CompiledScene;
use crate::observe::{AnsweredShadow, RayTree, Share, TracedRay};
use crate::render::{RenderSettings, Watch};
use crate::task::{Cut, RayKind, Term};
use crate::trace::Scratch;

/// How many pixels of a large picture are looked at in the first round.
const MOST_PIXELS: u64 = 150_000;

/// What can be looked for.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Phenomenon {
    /// Total internal reflection.
    TotalInternalReflection,
    /// A highlight on the outside of a transparent body.
    OutsideHighlight,
    /// A highlight on the inside of a transparent body.
    InsideHighlight,
    /// One opaque thing both mirrored in a transparent body and seen through it.
    ReflectionAndRefraction,
    /// The background, seen through a transparent body.
    RefractedBackground,
    /// An opaque thing with light of its own colour that mirrors another thing.
    DiffuseAndReflection,
    /// An opaque thing turned to a light of which an opaque thing keeps all.
    CompleteShadow,
    /// An opaque thing turned to a light that comes through a transparent body.
    ShadowThroughGlass,
    /// White light that splits into its wavelengths.
    Dispersion,
    /// Light that was absorbed on its way.
    Absorption,
    /// Light that was not followed.
    Cut,
    /// A tree of so many generations, 1 for a camera ray alone.
    Depth(u32),
    /// Light of an object of that name, whether it is seen or mirrored or seen through glass.
    Object(String),
}

/// The names, with what each is; those with a value are written with it.
pub const PHENOMENA: &[(&str, &str)] = &[
    ("outside-highlight", "a highlight on the outside of a transparent body"),
    ("inside-highlight", "a highlight on the inside of a transparent body"),
    ("reflection-and-refraction", "one thing both mirrored in a transparent body and seen through it"),
    ("refracted-background", "the background, seen through a transparent body"),
    ("diffuse-and-reflection", "an opaque thing that mirrors another one"),
    ("complete-shadow", "a light of which an opaque thing keeps all"),
    ("shadow-through-glass", "a light that comes through a transparent body"),
    ("tir", "total internal reflection"),
    ("dispersion", "white light that splits into its wavelengths"),
    ("absorption", "light that was absorbed on its way"),
    ("cut", "light that was not followed"),
    ("depth=N", "rays of that depth; a camera ray has 1"),
    ("object=NAME", "light of an object, also by mirrors and through glass"),
];

/// The seven rays in the lecture's order.
pub const SEVEN_RAYS: [Phenomenon; 7] = [
    Phenomenon::OutsideHighlight,
    Phenomenon::InsideHighlight,
    Phenomenon::ReflectionAndRefraction,
    Phenomenon::RefractedBackground,
    Phenomenon::DiffuseAndReflection,
    Phenomenon::CompleteShadow,
    Phenomenon::ShadowThroughGlass,
];

/// There is no phenomenon of that name.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("there is no phenomenon called \"{0}\"")]
pub struct UnknownPhenomenon(pub String);

impl FromStr for Phenomenon {
    type Err = UnknownPhenomenon;

    fn from_str(text: &str) -> Result<Self, UnknownPhenomenon> {
        let unknown = || UnknownPhenomenon(text.to_owned());
        if let Some((name, value)) = text.split_once('=') {
            return match name {
                "depth" => value.parse().ok().filter(|&depth| depth > 0).map(Self::Depth).ok_or_else(unknown),
                "object" if !value.is_empty() => Ok(Self::Object(value.to_owned())),
                _ => Err(unknown()),
            };
        }
        Ok(match text {
            "outside-highlight" => Self::OutsideHighlight,
            "inside-highlight" => Self::InsideHighlight,
            "reflection-and-refraction" => Self::ReflectionAndRefraction,
            "refracted-background" => Self::RefractedBackground,
            "diffuse-and-reflection" => Self::DiffuseAndReflection,
            "complete-shadow" => Self::CompleteShadow,
            "shadow-through-glass" => Self::ShadowThroughGlass,
            "tir" => Self::TotalInternalReflection,
            "dispersion" => Self::Dispersion,
            "absorption" => Self::Absorption,
            "cut" => Self::Cut,
            _ => return Err(unknown()),
        })
    }
}

/// A pixel that shows what was looked for.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Found {
    /// The pixel, from the upper left.
    pub pixel: [u32; 2],
    /// How clearly: a luminance, or a share of the light; above 0.
    pub clearness: f64,
}

/// Looks for a phenomenon in the first sample of a picture's pixels: at most `count` pixels, the clearest first, none of them close
/// to another.
pub fn find(watch: &mut Watch<'_>, phenomenon: &Phenomenon, count: usize) -> Vec<Found> {
    watch.ready(0);
    let watch = &*watch;
    let RenderSettings { width, height, .. } = *watch.settings;
    let mut step = 1;
    while u64::from(width.div_ceil(step)) * u64::from(height.div_ceil(step)) > MOST_PIXELS {
        step += 1;
    }
    let half = step / 2;
    let ys: Vec<u32> = (half..height).step_by(step as usize).collect();
    let row = |scratch: &mut Scratch, y: u32| -> Vec<Found> {
        (half..width).step_by(step as usize).filter_map(|x| look(watch, phenomenon, [x, y], scratch)).collect()
    };
    let mut found: Vec<Found> =
        ys.par_iter().map_init(Scratch::default, |scratch, &y| row(scratch, y)).flatten_iter().collect();
    let order = |a: &Found, b: &Found| {
        let place = |found: &Found| (found.pixel[1], found.pixel[0]);
        b.clearness.total_cmp(&a.clearness).then(place(a).cmp(&place(b)))
    };
    found.sort_by(order);
    let apart = f64::from(width.max(height)) / 24.0;
    let mut chosen: Vec<Found> = Vec::new();
    let mut scratch = Scratch::default();
    for found in found {
        if chosen.len() == count {
            break;
        }
        let is_near = |other: &Found| {
            let [x, y] = [0, 1].map(|k| f64::from(other.pixel[k]) - f64::from(found.pixel[k]));
            x * x + y * y < apart * apart
        };
        if chosen.iter().any(is_near) {
            continue;
        }
        // The clearest of those between the ones that were looked at.
        let mut best = found;
        if step > 1 {
            let around = |center: u32, end: u32| center.saturating_sub(half)..(center + step).min(end);
            for y in around(found.pixel[1], height) {
                for x in around(found.pixel[0], width) {
                    let other = look(watch, phenomenon, [x, y], &mut scratch);
                    best = other.filter(|other| order(other, &best).is_lt()).unwrap_or(best);
                }
            }
        }
        chosen.push(best);
    }
    chosen.sort_by(order);
    chosen
}

/// How clearly a pixel's first sample shows a phenomenon.
fn look(watch: &Watch<'_>, phenomenon: &Phenomenon, pixel: [u32; 2], scratch: &mut Scratch) -> Option<Found> {
    let mut tree = RayTree::default();
    watch.sample(pixel, 0, scratch, &mut tree);
    let clearness = Look { scene: watch.scene, tree: &tree }.clearness(phenomenon);
    (clearness > 0.0).then_some(Found { pixel, clearness })
}

/// A sample that is looked at.
struct Look<'a> {
    scene: &'a CompiledScene,
    tree: &'a RayTree,
}

impl Look<'_> {
    fn clearness(&self, phenomenon: &Phenomenon) -> f64 {
        let rays = &self.tree.rays;
        let Some(camera) = rays.first() else { return 0.0 };
        let first_is_body = self.is_body(camera);
        match phenomenon {
            Phenomenon::TotalInternalReflection => {
                let total = rays.iter().filter(|ray| ray.total_internal_reflection);
                total.map(|ray| self.share_below(ray).max(1e-6 * weight(ray.task.throughput))).fold(0.0, f64::max)
            }
            Phenomenon::OutsideHighlight if first_is_body && !is_leaving(camera) => {
                self.share(camera, |term| matches!(term, Term::Specular(_)))
            }
            Phenomenon::InsideHighlight if first_is_body => rays
                .iter()
                .filter(|ray| ray.task.kind == RayKind::Refracted && self.is_body(ray) && is_leaving(ray))
                .map(|ray| self.share(ray, |term| matches!(term, Term::Specular(_))))
                .fold(0.0, f64::max),
            Phenomenon::ReflectionAndRefraction if first_is_body => self.both_ways(camera),
            Phenomenon::RefractedBackground if first_is_body => {
                let through = self.through(camera).into_iter().filter(|ray| object(ray).is_none());
                through.map(|ray| self.share(ray, |term| term == Term::Background)).fold(0.0, f64::max)
            }
            Phenomenon::DiffuseAndReflection if !first_is_body => {
                let diffuse = self.share(camera, |term| matches!(term, Term::Diffuse(_)));
                let mirrored = self
                    .children(camera)
                    .filter(|ray| ray.task.kind == RayKind::Reflected && object(ray).is_some())
                    .map(|ray| self.share(ray, |_| true));
                diffuse.min(mirrored.fold(0.0, f64::max))
            }
            Phenomenon::CompleteShadow if !first_is_body && object(camera).is_some() => {
                if self.share(camera, |term| matches!(term, Term::Diffuse(_))) > 0.0 {
                    return 0.0;
                }
                camera
                    .shadows
                    .iter()
                    .filter(|shadow| shadow.transmittance.is_black())
                    .map(unblocked)
                    .fold(0.0, f64::max)
            }
            // Light that paths find behind glass comes as photons, wherever it comes to.
            Phenomenon::ShadowThroughGlass if !first_is_body => camera
                .shadows
                .iter()
                .filter(|shadow| shadow.steps.iter().any(|step| step.surface.is_some()))
                .map(|shadow| {
                    let arrives = luminance(shadow.transmittance);
                    // Clear where much comes and much is missing.
                    unblocked(shadow) * arrives.min(1.0 - arrives).max(0.0)
                })
                .fold(self.share(camera, |term| term == Term::Photons), f64::max),
            Phenomenon::Dispersion => {
                // A path whose other wavelengths were given up has one colour for certain.
                let alone = rays.iter().filter(|ray| ray.wavelengths.len() == 1);
                let alone: f64 = alone.map(|ray| self.share(ray, |_| true)).sum();
                let splits = rays.iter().filter(|ray| ray.boundaries.len() > 1);
                let weight = splits.map(|ray| weight(ray.task.throughput)).fold(0.0, f64::max);
                // Rays are numbered in the order of the list.
                let is_of_band =
                    |share: &&Share| rays.get(share.task as usize).is_some_and(|ray| ray.task.band.is_some());
                let of_bands = self.tree.shares.iter().filter(is_of_band);
                let [r, g, b] = of_bands.fold(Rgb::BLACK, |sum, share| sum + share.value).to_array();
                // Clear where much of its colour is left; where the bands come together again it is white.
                f64::from(r.max(g).max(b) - r.min(g).min(b)).max(1e-6 * weight).max(alone)
            }
            Phenomenon::Absorption => rays
                .iter()
                .filter(|ray| object(ray).is_some())
                .map(|ray| weight(ray.task.throughput) * (1.0 - luminance(ray.transmittance)))
                .fold(0.0, f64::max),
            Phenomenon::Cut => {
                let cuts = rays.iter().flat_map(|ray| &ray.cuts).filter(|cut| cut.why != Cut::Chance);
                cuts.map(|cut| weight(cut.weight)).sum()
            }
            Phenomenon::Depth(depth) => {
                let of_depth = rays.iter().filter(|ray| u32::from(ray.task.depth) == *depth);
                of_depth
                    .map(|ray| self.share(ray, |_| true).max(1e-9 * weight(ray.task.throughput)))
                    .fold(0.0, f64::max)
            }
            Phenomenon::Object(name) => rays
                .iter()
                .filter(|ray| {
                    object(ray).is_some_and(|number| self.scene.object_names.get(number).as_deref() == Some(name))
                })
                .map(|ray| self.share(ray, |_| true))
                .sum(),
            _ => 0.0,
        }
    }

    /// The opaque thing of which most light comes both by reflection at the first surface and from within the body, however it went
    /// there: the lesser of both.
    fn both_ways(&self, camera: &TracedRay) -> f64 {
        let of_kind = |kind: RayKind| self.children(camera).filter(move |ray| ray.task.kind == kind);
        let mirrored = of_kind(RayKind::Reflected).filter(|ray| !self.is_body(ray));
        let mirrored: Vec<(u32, f64)> =
            mirrored.filter_map(|ray| Some((object(ray)?, self.share(ray, |_| true)))).collect();
        let mut within: Vec<&TracedRay> = of_kind(RayKind::Refracted).collect();
        let mut next = 0;
        while let Some(ray) = within.get(next).copied() {
            within.extend(self.children(ray));
            next += 1;
        }
        let both = mirrored.iter().map(|(number, share)| {
            let seen = within.iter().filter(|ray| object(ray) == Some(*number));
            share.min(seen.map(|ray| self.share(ray, |_| true)).sum())
        });
        both.fold(0.0, f64::max)
    }

    /// All rays that go through bodies from a ray on, refracted at every boundary.
    fn through<'t>(&'t self, camera: &'t TracedRay) -> Vec<&'t TracedRay> {
        let (mut found, mut open) = (Vec::new(), vec![camera]);
        while let Some(ray) = open.pop() {
            for child in self.children(ray).filter(|child| child.task.kind == RayKind::Refracted) {
                found.push(child);
                open.push(child);
            }
        }
        found
    }

    /// What all rays brought that followed from one.
    fn share_below(&self, ray: &TracedRay) -> f64 {
        let mut below: Vec<&TracedRay> = self.children(ray).collect();
        let (mut sum, mut next) = (0.0, 0);
        while let Some(ray) = below.get(next).copied() {
            sum += self.share(ray, |_| true);
            below.extend(self.children(ray));
            next += 1;
        }
        sum
    }

    fn children<'t>(&'t self, parent: &'t TracedRay) -> impl Iterator<Item = &'t TracedRay> {
        let id = parent.task.id;
        self.tree.rays.iter().filter(move |ray| ray.task.parent == id && ray.task.id != id)
    }

    /// Whether a ray met the boundary of a transparent body.
    fn is_body(&self, ray: &TracedRay) -> bool {
        let surface = ray.hit.as_ref().and_then(Option::as_ref);
        surface.is_some_and(|surface| self.scene.materials[surface.material as usize].body.is_some())
    }

    /// What a ray's terms of a kind brought.
    fn share(&self, ray: &TracedRay, wanted: impl Fn(Term) -> bool) -> f64 {
        let of_ray = |share: &&Share| share.task == ray.task.id && wanted(share.term);
        self.tree.shares.iter().filter(of_ray).map(|share| luminance(share.value)).sum()
    }
}

/// Whether a ray met a surface from its inner side.
fn is_leaving(ray: &TracedRay) -> bool {
    let surface = ray.hit.as_ref().and_then(Option::as_ref);
    surface.is_some_and(|surface| surface.is_outward(ray.task.ray.direction))
}

fn object(ray: &TracedRay) -> Option<u32> {
    ray.hit.as_ref().and_then(Option::as_ref).map(|surface| surface.object)
}

/// What the diffuse term of a light would add.
fn unblocked(shadow: &AnsweredShadow) -> f64 {
    luminance(shadow.question.terms[0].1)
}

fn luminance(color: Rgb) -> f64 {
    f64::from(color.luminance())
}

fn weight(color: Rgb) -> f64 {
    luminance(color.map(f32::abs))
}
