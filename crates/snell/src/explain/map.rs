//! Whole pictures of one property of their pixels: how deep trees go, how many rays they have, how much of the light came which way.
//!
//! A picture is rendered with an observer that keeps a few numbers for each sample instead of trees. With adaptive antialiasing a
//! pixel's first sample speaks for it; with a fixed number of samples it is the mean of all.

use std::str::FromStr;

use rayon::prelude::*;
use snell_image::Image;
use snell_math::Rgb;
use snell_scene::scene::Antialiasing;

use crate::compile::CompiledScene;
use crate::interaction::SurfaceInteraction;
use crate::observe::{Observer, ShadowStep};
use crate::render::{Progress, RenderSettings, Watch};
use crate::task::{Inside, RayKind, RayTask, ShadowQuestion, Term};
use crate::trace::Scratch;
use crate::viewing::ViewingError;

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
    /// The share of the light that comes from lights through transparent bodies onto a surface.
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
    ("share:scattering", "share of scattered light"),
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
    /// The camera is degenerate.
    #[error(transparent)]
    Viewing(#[from] ViewingError),
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
                ShareOf::Scattering => "share of scattered light".to_owned(),
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
/// [`MapError`], where the scene has no object or light of the name, or its camera is degenerate.
pub fn map(
    scene: &CompiledScene,
    settings: &RenderSettings,
    property: &Property,
    progress: &dyn Progress,
) -> Result<Image<f32>, MapError> {
    let wanted = Wanted::new(scene, property)?;
    let watch = Watch::new(scene, settings)?;
    let RenderSettings { width, height, .. } = *settings;
    let per_pixel = if let Antialiasing::Samples(count) = settings.antialiasing { count.max(1) } else { 1 };
    let mut values = vec![0.0; width as usize * height as usize];
    progress.pass(0, values.len() as u64);
    // Pieces of rows, so that the rays of a batch are neighbours.
    let together = (TOGETHER / per_pixel as usize).clamp(1, width as usize);
    let rows = values.par_chunks_mut(width as usize).enumerate();
    let worker = || (Scratch::default(), Tally::new(&wanted));
    rows.for_each_init(worker, |(scratch, tally), (y, row)| {
        for (piece, values) in row.chunks_mut(together).enumerate() {
            if progress.is_cancelled() {
                return;
            }
            let first = piece * together;
            let pixels = (first..first + values.len()).map(|x| [x as u32, y as u32]);
            let samples: Vec<([u32; 2], u32)> =
                pixels.flat_map(|pixel| (0..per_pixel).map(move |number| (pixel, number))).collect();
            tally.begin(samples.len());
            watch.samples(&samples, scratch, tally);
            for (value, samples) in values.iter_mut().zip(tally.samples.chunks(per_pixel as usize)) {
                *value = wanted.value(samples);
            }
        }
        progress.advance(row.len() as u64, 0);
    });
    Ok(Image::from_pixels(width, height, values).unwrap_or_else(|_| Image::filled(width, height, 0.0)))
}

/// A property, with numbers instead of names.
#[derive(Debug)]
enum Wanted {
    Depth,
    Rays,
    TotalInternalReflection,
    Caustic,
    Reflected,
    Refracted,
    Background,
    Ambient,
    Diffuse,
    Specular,
    Scattering,
    /// Objects that have the name.
    Objects(Vec<u32>),
    /// Lights that have the name.
    Lights(Vec<u32>),
}

impl Wanted {
    fn new(scene: &CompiledScene, property: &Property) -> Result<Self, MapError> {
        let Property::Share(of) = property else {
            return Ok(match property {
                Property::Depth => Self::Depth,
                Property::Rays => Self::Rays,
                Property::TotalInternalReflection => Self::TotalInternalReflection,
                Property::Caustic | Property::Share(_) => Self::Caustic,
            });
        };
        Ok(match of {
            ShareOf::Reflected => Self::Reflected,
            ShareOf::Refracted => Self::Refracted,
            ShareOf::Background => Self::Background,
            ShareOf::Ambient => Self::Ambient,
            ShareOf::Diffuse => Self::Diffuse,
            ShareOf::Specular => Self::Specular,
            ShareOf::Scattering => Self::Scattering,
            ShareOf::Object(name) => {
                let numbers = (0..scene.object_names.len() as u32)
                    .filter(|&number| scene.object_names.get(number).as_deref() == Some(name));
                let numbers: Vec<u32> = numbers.collect();
                if numbers.is_empty() {
                    return Err(MapError::NoObject(name.clone()));
                }
                Self::Objects(numbers)
            }
            ShareOf::Light(name) => {
                let numbers = (0..).zip(&scene.light_names).filter(|(_, other)| *other == name);
                let numbers: Vec<u32> = numbers.map(|(number, _)| number).collect();
                if numbers.is_empty() {
                    return Err(MapError::NoLight(name.clone()));
                }
                Self::Lights(numbers)
            }
        })
    }

    /// The value of a pixel by its samples.
    fn value(&self, samples: &[SampleTally]) -> f32 {
        let count = samples.len().max(1) as f32;
        let mean = |of: fn(&SampleTally) -> u32| samples.iter().map(|sample| of(sample) as f32).sum::<f32>() / count;
        match self {
            Self::Depth => samples.iter().map(|sample| sample.depth as f32).fold(0.0, f32::max),
            Self::Rays => mean(|sample| sample.rays),
            Self::TotalInternalReflection => mean(|sample| sample.totals),
            _ => {
                let [part, all] = [0, 1].map(|i: usize| samples.iter().map(|s| s.light[i]).sum::<f32>());
                if all > 0.0 { (part / all).clamp(0.0, 1.0) } else { 0.0 }
            }
        }
    }

    /// Whether a term is of the kind that is asked for.
    fn includes(&self, ray: RayTally, term: Term, through_body: bool) -> bool {
        match self {
            Self::Caustic => through_body && matches!(term, Term::Diffuse(_) | Term::Specular(_)),
            Self::Reflected => ray.reflected,
            Self::Refracted => ray.refracted,
            Self::Background => term == Term::Background,
            Self::Ambient => term == Term::Ambient,
            Self::Diffuse => matches!(term, Term::Diffuse(_)),
            Self::Specular => matches!(term, Term::Specular(_)),
            Self::Scattering => matches!(term, Term::Scattering(_)),
            Self::Objects(numbers) => ray.object.is_some_and(|object| numbers.contains(&object)),
            Self::Lights(numbers) => match term {
                Term::Diffuse(light) | Term::Specular(light) | Term::Scattering(light) => numbers.contains(&light),
                Term::Background | Term::Emission | Term::Ambient | Term::Photons => false,
            },
            Self::Depth | Self::Rays | Self::TotalInternalReflection => false,
        }
    }
}

/// What is known of a ray.
#[derive(Clone, Copy, Debug, Default)]
struct RayTally {
    sample: u32,
    reflected: bool,
    refracted: bool,
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

/// Counts what a map needs, for samples that are traced together.
#[derive(Debug)]
struct Tally<'w> {
    wanted: &'w Wanted,
    /// By the numbers of rays.
    rays: Vec<RayTally>,
    samples: Vec<SampleTally>,
    /// The shadow ray that was answered last went through a transparent body.
    through_body: bool,
    /// So did the one that is not answered yet.
    steps_through_body: bool,
}

impl<'w> Tally<'w> {
    fn new(wanted: &'w Wanted) -> Self {
        Self { wanted, rays: Vec::new(), samples: Vec::new(), through_body: false, steps_through_body: false }
    }

    fn begin(&mut self, samples: usize) {
        self.rays.clear();
        self.samples.clear();
        self.samples.resize(samples, SampleTally::default());
        (self.through_body, self.steps_through_body) = (false, false);
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
        // Numbered in the order in which they are spawned.
        self.rays.push(RayTally { sample: task.sample, reflected, refracted, object: None });
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
        if self.wanted.includes(ray, term, self.through_body) {
            light[0] += luminance;
        }
    }
    #[inline]
    fn shadow_step(&mut self, step: &ShadowStep) {
        self.steps_through_body |= step.surface.is_some() && !step.transmittance.is_black();
    }
    #[inline]
    fn shadow(&mut self, question: &ShadowQuestion, _: Rgb) {
        self.through_body = std::mem::take(&mut self.steps_through_body);
        self.samples[question.sample as usize].rays += 1;
    }
    #[inline]
    fn total_internal_reflection(&mut self, task: u32) {
        self.samples[self.rays[task as usize].sample as usize].totals += 1;
    }
}
