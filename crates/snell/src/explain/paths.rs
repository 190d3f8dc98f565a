//! A pixel by the ways that its light took: terms gathered by what their rays met on the way from the eye.

use std::collections::BTreeMap;

use super::{Explanation, Kind, TermKind, luminance};

/// One step of a way from the eye.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct PathStep {
    /// How light left the surface before towards the eye: the camera ray's, a reflected or a refracted ray.
    pub kind: StepKind,
    /// The object that was met; `None` for the background.
    pub object: Option<String>,
}

/// How a step of a way was made.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum StepKind {
    /// From the eye.
    Camera,
    /// By reflection.
    Reflected,
    /// By refraction.
    Refracted,
    /// By a turn at a surface that is no mirror, or in a medium.
    Scattered,
}

/// What came to the pixel by ways of one shape.
#[derive(Clone, Debug, PartialEq)]
pub struct PathShare {
    /// The way, from the eye.
    pub steps: Vec<PathStep>,
    /// The mean over the pixel's samples.
    pub mean: [f64; 3],
    /// The variance of a sample's luminance by this way, about its mean over the samples.
    pub variance: f64,
    /// In how many samples there were rays of this shape that brought light.
    pub samples: u32,
}

impl PathShare {
    /// The way in one line: "eye - ball -T- ball -R- board", R for reflected, T for transmitted and D for scattered light.
    pub fn label(&self) -> String {
        let mut label = "eye".to_owned();
        for PathStep { kind, object } in &self.steps {
            label += match kind {
                StepKind::Camera => " - ",
                StepKind::Reflected => " -R- ",
                StepKind::Refracted => " -T- ",
                StepKind::Scattered => " -D- ",
            };
            label += object.as_deref().unwrap_or("background");
        }
        label
    }
}

/// The ways of all terms, the brightest first.
pub fn paths(told: &Explanation) -> Vec<PathShare> {
    let count = told.samples.len();
    // For each way, what each sample brought.
    let mut by_way: BTreeMap<Vec<PathStep>, Vec<Option<[f64; 3]>>> = BTreeMap::new();
    for term in told.terms.iter().filter(|term| term.kind != TermKind::Rounding && term.share != [0.0; 3]) {
        let Some(ray) = term.ray else { continue };
        let samples = by_way.entry(way(told, ray)).or_insert_with(|| vec![None; count]);
        let sum = samples[told.rays[ray].sample].get_or_insert([0.0; 3]);
        for (sum, share) in sum.iter_mut().zip(term.share) {
            *sum += share;
        }
    }
    let share = |(steps, samples): (Vec<PathStep>, Vec<Option<[f64; 3]>>)| {
        let mean = samples.iter().flatten().fold([0.0; 3], |sum, part| [0, 1, 2].map(|i: usize| sum[i] + part[i]));
        // Shares are divided by the number of samples already.
        let values = samples.iter().map(|part| luminance(part.unwrap_or_default()) * count as f64);
        let variance = values.map(|value| (value - luminance(mean)) * (value - luminance(mean))).sum::<f64>();
        let brought = samples.iter().flatten().count() as u32;
        PathShare { steps, mean, variance: variance / count as f64, samples: brought }
    };
    let mut paths: Vec<PathShare> = by_way.into_iter().map(share).collect();
    paths.sort_by(|a, b| luminance(b.mean).total_cmp(&luminance(a.mean)));
    paths
}

/// The way from the eye to what a ray met.
fn way(told: &Explanation, ray: usize) -> Vec<PathStep> {
    let mut steps = Vec::new();
    let mut at = Some(ray);
    while let Some(number) = at {
        let ray = &told.rays[number];
        let kind = match ray.kind {
            Kind::Camera | Kind::Shadow => StepKind::Camera,
            Kind::Reflected => StepKind::Reflected,
            Kind::Refracted => StepKind::Refracted,
            Kind::Scattered => StepKind::Scattered,
        };
        // A boundary without effect is not there: what follows is the same ray.
        let goes_on = steps.last().is_some_and(|_: &PathStep| ray.end == super::End::NoEffect);
        if !goes_on {
            steps.push(PathStep { kind, object: ray.surface.as_ref().map(|surface| surface.object.clone()) });
        }
        at = ray.parent;
    }
    steps.reverse();
    steps
}
