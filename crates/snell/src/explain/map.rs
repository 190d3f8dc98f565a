//! Whole pictures of one property of their pixels: how deep trees go, how many rays they have, how much of the light came which way.
//!
//! A picture is rendered with an observer that keeps a few numbers for each sample instead of trees. With adaptive antialiasing a
//! pixel's first sample speaks for it; with a fixed number of samples, as paths have it, it is the mean of all.

use std::ops::Range;
use std::str::FromStr;

use rayon::prelude::*;
use snell_image::Image;
use snell_math::Rgb;
use snell_scene::scene::Antialiasing;

use crate::interaction::SurfaceInteraction;
use crate::observe::Observer;
use crate::render::{Progress, RenderSettings, Watch};
use crate::task::{Inside, RayKind, RayTask, ShadowQuestion, Term};
use crate::trace::Scratch;

/// Samples that are traced together.
const TOGETHER: usize = 1024;

/// What a map shows.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Property {
    /// The depth of the deepest ray; a camera ray has 1.
    Depth,
    /// How many rays there are, those to lights included.
    Rays,
    /// How often light meets total internal reflection.
    TotalInternalReflection,
    /// The share of the light that comes from lights through transparent bodies onto a surface; of paths, also off mirrors.
    Caustic,
    /// The share of the light that is of one kind.
    Share(ShareOf),
}

/// Kinds of light.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum ShareOf {
    /// Was reflected on its way at least once.
    Reflected,
    /// Was refracted on its way at least once.
    Refracted,
    /// Comes from the background.
    Background,
    /// Comes by ambient terms.
    Ambient,
    /// Comes by diffuse terms of lights.
    Diffuse,
    /// Comes by highlights.
    Specular,
    /// Was scattered in a milky body.
    Scattering,
    /// Was found where it is given off.
    Emission,
    /// Came as photons.
    Photons,
    /// Came to a surface or out of a medium that scattered it on its way, after the first one.
    Scattered,
    /// Comes from the surface of an object.
    Object(String),
    /// Comes from a light.
    Light(String),
}

/// The names, with what each is.
pub const PROPERTIES: &[(&str, &str)] = &[
    ("depth", "depth of the deepest ray"),
    ("rays", "number of rays"),
    ("tir", "total internal reflections"),
    ("caustic", "share of light through glass onto surfaces"),
    ("share:reflected", "share of light that was reflected"),
    ("share:refracted", "share of light that was refracted"),
    ("share:background", "share of the background's light"),
    ("share:ambient", "share of ambient terms"),
    ("share:diffuse", "share of diffuse terms"),
    ("share:specular", "share of highlights"),
    ("share:scattering", "share of light scattered in media"),
    ("share:emission", "share of light found where it is given off"),
    ("share:photons", "share of photons"),
    ("share:scattered", "share of light that paths found after a turn"),
    ("share:object=NAME", "share of an object's light"),
    ("share:light=NAME", "share of a light"),
];

/// There is no property of that name, or the scene has not what it names.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum MapError {
    /// The name means nothing.
    #[error("there is no map called \"{0}\"")]
    Unknown(String),
    /// The scene has no such object.
    #[error("the scene has no object called \"{0}\"")]
    NoObject(String),
    /// The scene has no such light.
    #[error("the scene has no light called \"{0}\"")]
    NoLight(String),
}

impl FromStr for Property {
    type Err = MapError;

    fn from_str(text: &str) -> Result<Self, MapError> {
        let unknown = || MapError::Unknown(text.to_owned());
        let Some(share) = text.strip_prefix("share:") else {
            return match text {
                "depth" => Ok(Self::Depth),
                "rays" => Ok(Self::Rays),
                "tir" => Ok(Self::TotalInternalReflection),
                "caustic" => Ok(Self::Caustic),
                _ => Err(unknown()),
            };
        };
        Ok(Self::Share(match (share, share.split_once('=')) {
            (_, Some(("object", name))) if !name.is_empty() => ShareOf::Object(name.to_owned()),
            (_, Some(("light", name))) if !name.is_empty() => ShareOf::Light(name.to_owned()),
            ("reflected", _) => ShareOf::Reflected,
            ("refracted", _) => ShareOf::Refracted,
            ("background", _) => ShareOf::Background,
            ("ambient", _) => ShareOf::Ambient,
            ("diffuse", _) => ShareOf::Diffuse,
            ("specular", _) => ShareOf::Specular,
            ("scattering", _) => ShareOf::Scattering,
            ("emission", _) => ShareOf::Emission,
            ("photons", _) => ShareOf::Photons,
            ("scattered", _) => ShareOf::Scattered,
            _ => return Err(unknown()),
        }))
    }
}

impl Property {
    /// What the map shows, in words.
    pub fn title(&self) -> String {
        match self {
            Self::Depth => "depth of the deepest ray".to_owned(),
            Self::Rays => "rays".to_owned(),
            Self::TotalInternalReflection => "total internal reflections".to_owned(),
            Self::Caustic => "share of light through glass onto surfaces".to_owned(),
            Self::Share(of) => match of {
                ShareOf::Reflected => "share of reflected light".to_owned(),
                ShareOf::Refracted => "share of refracted light".to_owned(),
                ShareOf::Background => "share of the background".to_owned(),
                ShareOf::Ambient => "share of ambient light".to_owned(),
                ShareOf::Diffuse => "share of diffuse light".to_owned(),
                ShareOf::Specular => "share of highlights".to_owned(),
                ShareOf::Scattering => "share of light scattered in media".to_owned(),
                ShareOf::Emission => "share of light where it is given off".to_owned(),
                ShareOf::Photons => "share of photons".to_owned(),
                ShareOf::Scattered => "share of light after a turn".to_owned(),
                ShareOf::Object(name) => format!("share of light of {name}"),
                ShareOf::Light(name) => format!("share of light of {name}"),
            },
        }
    }

    /// Whether its values are whole numbers for each sample; else they are shares from 0 to 1.
    pub fn is_count(&self) -> bool {
        matches!(self, Self::Depth | Self::Rays | Self::TotalInternalReflection)
    }
}

/// A property of every pixel of a picture.
///
/// # Errors
/// [`MapError`], where the scene has no object or light of the name.
pub fn map(watch: &mut Watch<'_>, property: &Property, progress: &dyn Progress) -> Result<Image<f32>, MapError> {
    let wanted = Wanted::new(watch, property)?;
    let RenderSettings { width, height, antialiasing, .. } = *watch.settings;
    let of_pixel = match antialiasing {
        Antialiasing::Samples(count) => count.max(1),
        Antialiasing::None | Antialiasing::Adaptive => 1,
    };
    let mut sums = vec![PixelTally::default(); width as usize * height as usize];
    // Samples that need something of their own are traced number by number.
    let (passes, per_pass) = watch.passes().map_or((1, of_pixel), |passes| (passes, 1));
    for pass in 0..passes {
        watch.ready(pass);
        progress.pass(pass, sums.len() as u64);
        trace_pass(watch, &wanted, pass..pass + per_pass, &mut sums, progress);
        if progress.is_cancelled() {
            break;
        }
    }
    let values = sums.iter().map(|sum| wanted.value(sum)).collect();
    Ok(Image::from_pixels(width, height, values).unwrap_or_else(|_| Image::filled(width, height, 0.0)))
}

/// Adds some samples of every pixel to its sums.
fn trace_pass(
    watch: &Watch<'_>,
    wanted: &Wanted<'_>,
    numbers: Range<u32>,
    sums: &mut [PixelTally],
    progress: &dyn Progress,
) {
    let width = watch.settings.width as usize;
    let per_pixel = numbers.len();
    // Pieces of rows, so that the rays of a batch are neighbours.
    let together = (TOGETHER / per_pixel).clamp(1, width);
    let rows = sums.par_chunks_mut(width).enumerate();
    let worker = || (Scratch::default(), Tally::new(wanted));
    rows.for_each_init(worker, |(scratch, tally), (y, row)| {
        for (piece, sums) in row.chunks_mut(together).enumerate() {
            if progress.is_cancelled() {
                return;
            }
            let first = piece * together;
            let pixels = (first..first + sums.len()).map(|x| [x as u32, y as u32]);
            let samples: Vec<([u32; 2], u32)> =
                pixels.flat_map(|pixel| numbers.clone().map(move |number| (pixel, number))).collect();
            tally.begin(samples.len());
            watch.samples(&samples, scratch, tally);
            for (sum, samples) in sums.iter_mut().zip(tally.samples.chunks(per_pixel)) {
                samples.iter().for_each(|sample| sum.add(sample));
            }
        }
        progress.advance(row.len() as u64, 0);
    });
}

/// A property of a scene.
#[derive(Debug)]
struct Wanted<'p> {
    property: &'p Property,
    /// The numbers of the objects or lights that have the name, where it has one.
    numbers: Vec<u32>,
}

impl<'p> Wanted<'p> {
    fn new(watch: &Watch<'_>, property: &'p Property) -> Result<Self, MapError> {
        let names = &watch.scene.object_names;
        let (numbers, error): (Vec<u32>, MapError) = match property {
            Property::Share(ShareOf::Object(name)) => {
                let is_named = |number: &u32| names.get(*number).as_deref() == Some(name);
                ((0..names.len() as u32).filter(is_named).collect(), MapError::NoObject(name.clone()))
            }
            Property::Share(ShareOf::Light(name)) => {
                let named = (0..).zip(watch.light_names()).filter(|(_, other)| *other == name);
                (named.map(|(number, _)| number).collect(), MapError::NoLight(name.clone()))
            }
            _ => return Ok(Self { property, numbers: Vec::new() }),
        };
        if numbers.is_empty() { Err(error) } else { Ok(Self { property, numbers }) }
    }

    /// The value of a pixel by its samples.
    fn value(&self, sum: &PixelTally) -> f32 {
        let mean = |sum_of: u64, samples: u32| sum_of as f32 / samples.max(1) as f32;
        match self.property {
            Property::Depth => sum.depth as f32,
            Property::Rays => mean(sum.rays, sum.samples),
            Property::TotalInternalReflection => mean(sum.totals, sum.samples),
            Property::Caustic | Property::Share(_) => {
                let [part, all] = sum.light;
                if all > 0.0 { (part / all).clamp(0.0, 1.0) } else { 0.0 }
            }
        }
    }

    /// Whether a term is of the kind that is asked for.
    fn includes(&self, ray: RayTally, term: Term, is_filtered: impl FnOnce() -> bool) -> bool {
        let of = match self.property {
            Property::Depth | Property::Rays | Property::TotalInternalReflection => return false,
            Property::Caustic => {
                return match term {
                    Term::Diffuse(_) | Term::Specular(_) => is_filtered(),
                    Term::Photons => true,
                    Term::Emission | Term::Background => ray.after_turn,
                    Term::Ambient | Term::Scattering(_) => false,
                };
            }
            Property::Share(of) => of,
        };
        match of {
            ShareOf::Reflected => ray.reflected,
            ShareOf::Refracted => ray.refracted,
            ShareOf::Background => term == Term::Background,
            ShareOf::Ambient => term == Term::Ambient,
            ShareOf::Diffuse => matches!(term, Term::Diffuse(_)),
            ShareOf::Specular => matches!(term, Term::Specular(_)),
            ShareOf::Scattering => matches!(term, Term::Scattering(_)),
            ShareOf::Emission => term == Term::Emission,
            ShareOf::Photons => term == Term::Photons,
            ShareOf::Scattered => ray.scattered,
            ShareOf::Object(_) => ray.object.is_some_and(|object| self.numbers.contains(&object)),
            ShareOf::Light(_) => match term {
                Term::Diffuse(light) | Term::Specular(light) | Term::Scattering(light) => self.numbers.contains(&light),
                Term::Background | Term::Emission | Term::Ambient | Term::Photons => false,
            },
        }
    }
}

/// What is known of a ray.
#[derive(Clone, Copy, Debug, Default)]
struct RayTally {
    sample: u32,
    reflected: bool,
    refracted: bool,
    /// Its path took a turn before, at a surface that is not specular or in a medium.
    scattered: bool,
    /// And from there on it met specular surfaces alone, one at least.
    after_turn: bool,
    object: Option<u32>,
}

/// What is known of a sample.
#[derive(Clone, Copy, Debug, Default)]
struct SampleTally {
    depth: u32,
    rays: u32,
    totals: u32,
    /// The luminance of what is asked for, and of all.
    light: [f32; 2],
}

/// What is known of a pixel: sums over its samples.
#[derive(Clone, Copy, Debug, Default)]
struct PixelTally {
    samples: u32,
    /// Of the deepest.
    depth: u32,
    rays: u64,
    totals: u64,
    light: [f32; 2],
}

impl PixelTally {
    fn add(&mut self, sample: &SampleTally) {
        self.samples += 1;
        self.depth = self.depth.max(sample.depth);
        self.rays += u64::from(sample.rays);
        self.totals += u64::from(sample.totals);
        for (sum, light) in self.light.iter_mut().zip(sample.light) {
            *sum += light;
        }
    }
}

/// Counts what a map needs, for samples that are traced together.
#[derive(Debug)]
struct Tally<'w> {
    wanted: &'w Wanted<'w>,
    /// By the numbers of rays.
    rays: Vec<RayTally>,
    samples: Vec<SampleTally>,
    /// The rays and terms to which light comes through a transparent body, of the questions that are answered together.
    filtered: Vec<(u32, Term)>,
    /// Their terms have begun to be told.
    is_answered: bool,
}

impl<'w> Tally<'w> {
    fn new(wanted: &'w Wanted<'w>) -> Self {
        Self { wanted, rays: Vec::new(), samples: Vec::new(), filtered: Vec::new(), is_answered: false }
    }

    fn begin(&mut self, samples: usize) {
        self.rays.clear();
        self.samples.clear();
        self.samples.resize(samples, SampleTally::default());
        self.filtered.clear();
    }
}

impl Observer for Tally<'_> {
    const DETAILS: bool = false;

    #[inline]
    fn ray(&mut self, task: &RayTask) {
        let before = match task.kind {
            RayKind::Camera => RayTally::default(),
            RayKind::Reflected | RayKind::Refracted | RayKind::Scattered => self.rays[task.parent as usize],
        };
        let reflected = before.reflected || task.kind == RayKind::Reflected;
        let refracted = before.refracted || task.kind == RayKind::Refracted;
        let turns = task.kind == RayKind::Scattered;
        let scattered = before.scattered || turns;
        let after_turn = scattered && !turns;
        // Those that are spawned side by side are not told in the order of their numbers.
        if self.rays.len() <= task.id as usize {
            self.rays.resize(task.id as usize + 1, RayTally::default());
        }
        self.rays[task.id as usize] =
            RayTally { sample: task.sample, reflected, refracted, scattered, after_turn, object: None };
        let sample = &mut self.samples[task.sample as usize];
        sample.depth = sample.depth.max(u32::from(task.depth));
        sample.rays += 1;
    }
    #[inline]
    fn hit(&mut self, task: &RayTask, interaction: Option<&SurfaceInteraction>, _: Option<Inside>) {
        self.rays[task.id as usize].object = interaction.map(|interaction| interaction.object);
    }
    #[inline]
    fn term(&mut self, task: u32, term: Term, share: Rgb) {
        let ray = self.rays[task as usize];
        let light = &mut self.samples[ray.sample as usize].light;
        let luminance = share.luminance();
        light[1] += luminance;
        self.is_answered = true;
        // A question has a diffuse and a specular term, and is told by the first.
        let first = if let Term::Specular(light) = term { Term::Diffuse(light) } else { term };
        if self.wanted.includes(ray, term, || self.filtered.contains(&(task, first))) {
            light[0] += luminance;
        }
    }
    #[inline]
    fn filtered(&mut self, task: u32, term: Term) {
        if std::mem::take(&mut self.is_answered) {
            self.filtered.clear();
        }
        self.filtered.push((task, term));
    }
    #[inline]
    fn shadow(&mut self, question: &ShadowQuestion, _: Rgb) {
        self.samples[question.sample as usize].rays += 1;
    }
    #[inline]
    fn total_internal_reflection(&mut self, task: u32) {
        self.samples[self.rays[task as usize].sample as usize].totals += 1;
    }
}
