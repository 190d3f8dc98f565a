//! Why a pixel looks as it does: the rays that made it, in full, and the share of the pixel that each of them brought.
//!
//! An [`Explanation`] is made of what the code that renders the pixel told a [`RayTree`]; nothing in it is computed a second time.
//! Its terms, in order, add up to the pixel exactly: see [`Explanation::terms`].

mod build;
mod colors;
mod figure;
mod find;
mod map;
mod paths;
pub mod words;

use snell_math::{Normal3, Point3, Ray, Rgb, Vector3};

pub use colors::false_colors;
pub use figure::{FigureSettings, View, figure};
pub use find::{Found, PHENOMENA, Phenomenon, SEVEN_RAYS, UnknownPhenomenon, find};
pub use map::{MapError, PROPERTIES, Property, ShareOf, map};
pub use paths::{PathShare, PathStep, StepKind};

use crate::compile::CompiledScene;
use crate::film::PixelSum;
use crate::observe::RayTree;
use crate::render::{RenderSettings, Watch};
use crate::trace::Scratch;
use crate::viewing::ViewingError;

/// What is explained.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Subject {
    /// A pixel of the picture, with all its samples; (0, 0) is at the upper left.
    Pixel([u32; 2]),
    /// One sample of a pixel, as if it were the only one.
    Sample([u32; 2], u32),
    /// A ray as if it came from the camera, with the random numbers of a sample; its direction may have any length but 0.
    Ray(Ray, u32),
}

/// A pixel, a sample or a ray, explained. Lengths are in world units, angles in radians, colours scene-linear.
#[derive(Clone, Debug)]
pub struct Explanation {
    /// What it is about.
    pub subject: Subject,
    /// Its colour, the very bits of the rendering.
    pub pixel: Rgb,
    /// The samples that it is the mean of.
    pub samples: Vec<ExplainedSample>,
    /// Every ray of every sample: camera rays, what they spawned, shadow rays, and rays that were not followed. A ray's number is its
    /// place in this list, and its parent comes before it.
    pub rays: Vec<ExplainedRay>,
    /// What was added to the pixel, sample by sample in the order in which it was added. The sum of the shares, as `f64` in this
    /// order from zero, is `pixel` exactly: terms of the kind [`TermKind::Rounding`] at the end say what was lost where numbers were
    /// rounded to be stored.
    pub terms: Vec<ExplainedTerm>,
    /// The pixel by the ways that its light took, the largest share first.
    pub paths: Vec<PathShare>,
}

/// One sample.
#[derive(Clone, Debug, PartialEq)]
pub struct ExplainedSample {
    /// Its place in the pixel's sequence of samples.
    pub number: u32,
    /// Where in the pixel it is, from the upper left corner; `None` for a ray of its own.
    pub place: Option<[f64; 2]>,
    /// Its colour.
    pub color: Rgb,
    /// The wavelengths of its path in nanometres, the hero first; none where it is of all light.
    pub wavelengths_nm: Vec<f64>,
    /// Its camera ray.
    pub camera_ray: usize,
}

/// What made a ray.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// The camera.
    Camera,
    /// Reflection.
    Reflected,
    /// Refraction.
    Refracted,
    /// A turn at a surface that is no mirror, or in a medium: what paths take.
    Scattered,
    /// A question to a light.
    Shadow,
}

/// How a ray ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum End {
    /// At a surface.
    Surface,
    /// At a surface that gives off light, or, of a shadow ray, at its light.
    Light,
    /// It left the scene.
    Background,
    /// At a boundary that another body covers, or that bends nothing: it went on as the ray that is its child.
    NoEffect,
    /// In a medium that scattered its light.
    Scattered,
    /// A shadow ray at a surface that nothing goes through.
    Blocked,
    /// It was not followed: it would have been deeper than allowed.
    DepthLimit,
    /// It was not followed: it would have weighed less than allowed.
    TooLittleWeight,
    /// It was not followed: its sample had too many rays already.
    TooManyRays,
    /// It was not followed by chance: paths that carry little end so, and those that go on carry more instead.
    Chance,
}

/// What a ray goes through.
#[derive(Clone, Debug, PartialEq)]
pub struct ExplainedMedium {
    /// The material of the body; `None` outside of all.
    pub material: Option<String>,
    /// The index of refraction at the ray's wavelength.
    pub index: f64,
}

/// One ray.
#[derive(Clone, Debug)]
pub struct ExplainedRay {
    /// The place of its sample in the list of samples.
    pub sample: usize,
    /// The ray that spawned it or asked the light.
    pub parent: Option<usize>,
    /// What made it.
    pub kind: Kind,
    /// Of a shadow ray, the light.
    pub light: Option<String>,
    /// 1 for a camera ray, its parent's plus one for a reflected or refracted one; a shadow ray has its parent's.
    pub depth: u32,
    /// The wavelength in nanometres, where it carries one band of split light, or one wavelength of a path alone.
    pub wavelength_nm: Option<f64>,
    /// Where it begins; `None` where it was not followed.
    pub origin: Option<Point3>,
    /// Where it goes, unit length; `None` where it was not followed.
    pub direction: Option<Vector3>,
    /// How it ended.
    pub end: End,
    /// How far it went; infinite where it left the scene, `None` where it was not followed.
    pub distance: Option<f64>,
    /// What it carried as it began: the factor on all that it sees, up to its sample.
    pub throughput: Rgb,
    /// What it went through.
    pub medium: ExplainedMedium,
    /// What absorption left of its light on the way.
    pub absorption: Rgb,
    /// What it met.
    pub surface: Option<ExplainedSurface>,
    /// Of a shadow ray, what was in its way.
    pub blockers: Vec<Blocker>,
    /// Of a shadow ray, the share of the light that arrives.
    pub transmittance: Option<Rgb>,
    /// What it and all that followed from it brought to the pixel.
    pub share: [f64; 3],
}

/// What a ray met.
#[derive(Clone, Debug, PartialEq)]
pub struct ExplainedSurface {
    /// The point.
    pub point: Point3,
    /// The object's name.
    pub object: String,
    /// Its number in the scene's list.
    pub object_number: u32,
    /// The material's name.
    pub material: String,
    /// The geometric normal, outward.
    pub normal: Normal3,
    /// The normal that is shaded with, outward.
    pub shading_normal: Normal3,
    /// The angle between the ray and the normal.
    pub incidence: f64,
    /// The coefficient of the mirrored ray; black where it does not mirror.
    pub mirror: Rgb,
    /// Where it is the boundary of a transparent body and has an effect: what happened there, once for each band.
    pub boundaries: Vec<Boundary>,
}

/// What happened at the boundary of a transparent body.
#[derive(Clone, Debug, PartialEq)]
pub struct Boundary {
    /// What is before it and behind it.
    pub media: [ExplainedMedium; 2],
    /// The wavelength in nanometres, where this is about one band of light, or about the hero of a path.
    pub wavelength_nm: Option<f64>,
    /// The part of the ray's light that this is about: white, or the band's where it splits here.
    pub part: Rgb,
    /// The angle of incidence.
    pub incidence: f64,
    /// The angle of refraction; `None` under total internal reflection.
    pub refraction: Option<f64>,
    /// The angle of incidence beyond which all is reflected; `None` towards the denser side.
    pub critical: Option<f64>,
    /// Fresnel's reflectance, 1 under total internal reflection.
    pub reflectance: f64,
    /// What goes through: 1 − reflectance.
    pub transmittance: f64,
    /// The rays' weights follow Fresnel's equations; or else they are the author's coefficients.
    pub fresnel: bool,
    /// What the reflected ray is weighted with, the author's coefficient in it.
    pub reflected_weight: Rgb,
    /// What the refracted ray is weighted with.
    pub refracted_weight: Rgb,
}

impl Boundary {
    /// All light is reflected.
    pub fn is_total(&self) -> bool {
        self.refraction.is_none()
    }
}

/// A surface in a shadow ray's way.
#[derive(Clone, Debug, PartialEq)]
pub struct Blocker {
    /// The point.
    pub point: Point3,
    /// The object's name.
    pub object: String,
    /// Its number in the scene's list.
    pub object_number: u32,
    /// The material's name.
    pub material: String,
    /// How far it is from where the shadow ray begins.
    pub distance: f64,
    /// What the way from the surface before left of the light.
    pub absorption: Rgb,
    /// Fresnel's reflectance.
    pub reflectance: f64,
    /// What the surface lets through; black where it blocks all.
    pub transmittance: Rgb,
}

/// Where a term comes from.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum TermKind {
    /// The background.
    Background,
    /// Light that the surface gives off.
    Emission,
    /// The ambient term.
    Ambient,
    /// The diffuse term of a light.
    Diffuse,
    /// The highlight of a light.
    Specular,
    /// Light scattered inside a milky body.
    Scattering,
    /// Light that came to the surface by specular ones, as photons.
    Photons,
    /// What rounding adds where the pixel is stored.
    Rounding,
}

/// One term of the pixel.
#[derive(Clone, Debug, PartialEq)]
pub struct ExplainedTerm {
    /// The ray that it was added for; `None` for [`TermKind::Rounding`].
    pub ray: Option<usize>,
    /// Where it comes from.
    pub kind: TermKind,
    /// The light's name.
    pub light: Option<String>,
    /// The shadow ray that asked for the light.
    pub shadow_ray: Option<usize>,
    /// What the light would add to the sample if nothing blocked it.
    pub unblocked: Option<Rgb>,
    /// What was added to the sample.
    pub value: Rgb,
    /// What that is of the pixel: the value divided by the number of samples.
    pub share: [f64; 3],
}

/// Explains a pixel, a sample or a ray.
///
/// # Errors
/// [`ViewingError`], where the scene's camera is degenerate.
///
/// ```
/// use snell::compile::CompiledScene;
/// use snell::explain::{Subject, explain};
/// use snell::math::{Point3, Rgb};
/// use snell::render::RenderSettings;
/// use snell::scene::scene::{Object, Scene, Shape};
///
/// let mut scene = Scene { ambient: Rgb::WHITE, ..Scene::default() };
/// scene.objects.push(Object::shape(Shape::Sphere { center: Point3::ORIGIN, radius: 1.0 }));
/// let compiled = CompiledScene::build(&scene).unwrap();
/// let settings = RenderSettings::from(&scene.settings);
/// let told = explain(&compiled, &settings, Subject::Pixel([320, 240])).unwrap();
/// assert_eq!(told.rays[0].surface.as_ref().unwrap().object, "sphere 1");
/// let sum = told.terms.iter().fold([0.0; 3], |sum, term| [0, 1, 2].map(|i| sum[i] + term.share[i]));
/// assert_eq!(sum, told.pixel.to_array().map(f64::from));
/// ```
pub fn explain(
    scene: &CompiledScene,
    settings: &RenderSettings,
    subject: Subject,
) -> Result<Explanation, ViewingError> {
    Ok(explain_watched(&mut Watch::new(scene, settings)?, subject, &mut Scratch::default()))
}

/// As [`explain`], for many pixels of one picture, and for one whose paths are traced: see [`Watch::paths`].
pub fn explain_watched(watch: &mut Watch<'_>, subject: Subject, scratch: &mut Scratch) -> Explanation {
    let samples = if let Subject::Pixel(pixel) = subject { watch.sample_count(pixel, scratch) } else { 1 };
    let mut traced: Vec<(u32, Option<[f64; 2]>, RayTree)> = Vec::new();
    let mut one = |number: u32, pixel: [u32; 2], scratch: &mut Scratch| {
        let mut tree = RayTree::default();
        watch.ready(number);
        watch.sample(pixel, number, scratch, &mut tree);
        traced.push((number, Some(watch.sample_place(pixel, number)), tree));
    };
    match subject {
        Subject::Pixel(pixel) => (0..samples).for_each(|number| one(number, pixel, scratch)),
        Subject::Sample(pixel, number) => one(number, pixel, scratch),
        Subject::Ray(ray, number) => {
            let mut tree = RayTree::default();
            watch.ready(number);
            watch.ray(Ray::new(ray.origin, ray.direction.normalize()), number, scratch, &mut tree);
            traced.push((number, None, tree));
        }
    }
    let pixel = if let [(_, _, tree)] = traced.as_slice() {
        PixelSum::mean_of_one(tree.sum()).0
    } else {
        let mut sum = PixelSum::default();
        for (_, _, tree) in &traced {
            // One that is no number counts as black, in the picture and here.
            let _ = sum.add(tree.sum());
        }
        sum.mean()
    };
    build::explanation(watch, subject, pixel, &traced)
}

impl Explanation {
    /// The children of a ray, in order.
    pub fn children(&self, ray: usize) -> impl Iterator<Item = usize> {
        (ray..self.rays.len()).filter(move |&child| self.rays[child].parent == Some(ray))
    }

    /// The terms of a ray, in order.
    pub fn terms_of(&self, ray: usize) -> impl Iterator<Item = &ExplainedTerm> {
        self.terms.iter().filter(move |term| term.ray == Some(ray))
    }

    /// How much of the pixel a share is, by luminance, 0 to 1 where nothing is negative; `None` where the pixel is black.
    pub fn portion(&self, share: [f64; 3]) -> Option<f64> {
        let whole = luminance(self.pixel.to_array().map(f64::from));
        (whole != 0.0).then(|| luminance(share) / whole)
    }
}

/// The luminance of a scene-linear colour, Rec. 709.
pub fn luminance([r, g, b]: [f64; 3]) -> f64 {
    0.2126 * r + 0.7152 * g + 0.0722 * b
}
