//! An explanation for people: a tree with a sentence for each ray, and how much of the pixel each of them brought.

use std::fmt::Write;

use snell::explain::words::{arrival, details, point, sentence, vector};
use snell::explain::{ExplainedRay, ExplainedTerm, Explanation, Kind, StepKind, Subject, TermKind};

use super::Picture;

/// The most paths that are listed one by one.
const MOST_PATHS: usize = 24;

/// What colours words have on a terminal that shows them.
mod style {
    pub const CAMERA: &str = "\x1b[1m";
    pub const REFLECTED: &str = "\x1b[31m";
    pub const REFRACTED: &str = "\x1b[34m";
    pub const SCATTERED: &str = "\x1b[32m";
    pub const SHADOW: &str = "\x1b[33m";
    pub const FAINT: &str = "\x1b[2m";
    pub const NONE: &str = "\x1b[0m";
}

/// The whole text, with colours.
pub fn text(picture: &Picture<'_>, told: &Explanation, details: bool) -> String {
    let mut text = heading(picture, told);
    if let [sample] = told.samples.as_slice() {
        text += "\n   share   red     green   blue\n";
        let mut tree = Tree { told, details, text: &mut text };
        tree.ray(sample.camera_ray, &mut Vec::new(), None);
        tree.rounding();
    } else {
        paths(told, &mut text);
        if let Subject::Pixel([x, y]) = told.subject {
            let last = told.samples.len() - 1;
            let _ = writeln!(text, "\n`--pixel {x},{y} --sample N`, N from 0 to {last}, shows the rays of one sample.");
        }
    }
    text
}

fn heading(picture: &Picture<'_>, told: &Explanation) -> String {
    let (width, height) = (picture.watch.settings.width, picture.watch.settings.height);
    let [r, g, b] = told.pixel.to_array();
    let what = match told.subject {
        Subject::Pixel([x, y]) => format!("Pixel {x},{y} of {} ({width}x{height})", picture.name),
        Subject::Sample([x, y], sample) => {
            format!("Sample {sample} of pixel {x},{y} of {} ({width}x{height})", picture.name)
        }
        Subject::Ray(ray, _) => {
            let (from, to) = (point(ray.origin), vector(ray.direction));
            format!("The ray from {from} towards {to} in {}", picture.name)
        }
    };
    let count = told.samples.len();
    let samples = if count == 1 { String::new() } else { format!(", the mean of {count} samples") };
    let mut text = format!("{what}: red {r:.4}, green {g:.4}, blue {b:.4}{samples}.\n");
    if let [sample] = told.samples.as_slice()
        && let [_, ..] = sample.wavelengths_nm[..]
    {
        let listed: Vec<String> = sample.wavelengths_nm.iter().map(|nm| format!("{nm:.0}")).collect();
        let _ = writeln!(text, "A path of {} nm; the first decides where it is bent.", listed.join(", "));
    }
    let lost = told.samples.iter().filter(|sample| !sample.color.is_finite()).count();
    if lost > 0 {
        let _ = writeln!(text, "{lost} of its samples are infinite or no numbers, and count as black.");
    }
    text
}

/// The ways that light took, as a table.
fn paths(told: &Explanation, text: &mut String) {
    text.push_str("\n   share   red     green   blue    variance  samples  path\n");
    for path in told.paths.iter().take(MOST_PATHS) {
        let [r, g, b] = path.mean;
        let (share, variance) = (percent(told, path.mean), path.variance);
        let samples = format!("{}/{}", path.samples, told.samples.len());
        let _ = writeln!(text, "{share} {r:7.4} {g:7.4} {b:7.4}  {variance:9.2e}  {samples:>7}  {}", path.label());
    }
    if told.paths.len() > MOST_PATHS {
        let rest = told.paths[MOST_PATHS..].iter().fold([0.0; 3], |sum, path| [0, 1, 2].map(|i| sum[i] + path.mean[i]));
        let [r, g, b] = rest;
        let count = told.paths.len() - MOST_PATHS;
        let _ = writeln!(text, "{} {r:7.4} {g:7.4} {b:7.4}  {:9}  {:7}  {count} more", percent(told, rest), "", "");
    }
    let is_scattered = told.paths.iter().any(|path| path.steps.iter().any(|step| step.kind == StepKind::Scattered));
    text.push_str(if is_scattered {
        "\nR reflected, T transmitted, D scattered.\n"
    } else {
        "\nR reflected, T transmitted.\n"
    });
}

/// A tree in the making.
struct Tree<'a> {
    told: &'a Explanation,
    details: bool,
    text: &'a mut String,
}

/// A line below a ray.
enum Below<'a> {
    Term(&'a ExplainedTerm),
    Ray(usize),
    /// Many shadow rays of a milky body, for one light.
    Scattered(&'a str, usize, [f64; 3]),
}

impl<'a> Tree<'a> {
    /// A ray and all below it; `branches` says for each level whether more follows.
    fn ray(&mut self, number: usize, branches: &mut Vec<bool>, parent: Option<&ExplainedRay>) {
        let ray = &self.told.rays[number];
        let (name, color) = match ray.kind {
            Kind::Camera if matches!(self.told.subject, Subject::Ray(..)) => ("ray", style::CAMERA),
            Kind::Camera => ("camera ray", style::CAMERA),
            Kind::Reflected => ("reflected ray", style::REFLECTED),
            Kind::Refracted => ("refracted ray", style::REFRACTED),
            Kind::Scattered => ("scattered ray", style::SCATTERED),
            Kind::Shadow => ("shadow ray", style::SHADOW),
        };
        let band = match (ray.wavelength_nm, parent.and_then(|parent| parent.wavelength_nm)) {
            (Some(own), None) => format!(" of {own:.0} nm"),
            _ => String::new(),
        };
        let sentence = sentence(ray);
        let head = format!("{color}{name}{band}{} {sentence}", style::NONE);
        self.line(ray.share, branches, &head);
        let below = self.below(number);
        if self.details {
            let bar = !below.is_empty();
            for line in details(ray) {
                self.detail(branches, bar, &line);
            }
        }
        let count = below.len();
        for (index, below) in below.into_iter().enumerate() {
            branches.push(index + 1 < count);
            match below {
                Below::Term(term) => {
                    let line = self.term(term);
                    self.line(term.share, branches, &line);
                }
                Below::Ray(child) => self.ray(child, branches, Some(ray)),
                Below::Scattered(light, rays, share) => {
                    let line = format!("light of {light}, scattered towards the eye on the way: {rays} shadow rays");
                    self.line(share, branches, &line);
                }
            }
            branches.pop();
        }
    }

    /// What is shown below a ray: its terms, then the rays that it spawned.
    fn below(&self, number: usize) -> Vec<Below<'a>> {
        let told = self.told;
        let mut below = Vec::new();
        let mut scattered: Vec<(&'a str, usize, [f64; 3])> = Vec::new();
        for term in told.terms_of(number) {
            let light = term.light.as_deref().unwrap_or_default();
            if term.kind != TermKind::Scattering {
                below.push(Below::Term(term));
                continue;
            }
            match scattered.iter_mut().find(|(name, ..)| *name == light) {
                Some((_, rays, sum)) => {
                    *rays += 1;
                    sum.iter_mut().zip(term.share).for_each(|(sum, share)| *sum += share);
                }
                None => scattered.push((light, 1, term.share)),
            }
        }
        below.extend(scattered.into_iter().map(|(light, rays, share)| Below::Scattered(light, rays, share)));
        let spawned = told.children(number).filter(|&child| told.rays[child].kind != Kind::Shadow);
        below.extend(spawned.map(Below::Ray));
        below
    }

    fn term(&self, term: &ExplainedTerm) -> String {
        let light = term.light.as_deref().unwrap_or("a light");
        let what = match term.kind {
            TermKind::Background => return "the background".to_owned(),
            TermKind::Emission => return "light that the surface gives off".to_owned(),
            TermKind::Ambient => return "ambient light".to_owned(),
            TermKind::Photons => return "photons: light that came here through glass or off mirrors".to_owned(),
            TermKind::Rounding => return "rounding where the pixel is stored".to_owned(),
            TermKind::Diffuse => format!("diffuse light of {light}"),
            TermKind::Specular => format!("highlight of {light}"),
            TermKind::Scattering => format!("light of {light}, scattered towards the eye"),
        };
        // A sample that is no number counts as black; what it would have been made of is worth a word.
        let is_lost = term.ray.is_some_and(|ray| {
            let sample = self.told.rays[ray].sample;
            !self.told.samples[sample].color.is_finite()
        });
        let [r, g, b] = term.value.to_array();
        let lost = if is_lost { format!("; it adds ({r:e}, {g:e}, {b:e})") } else { String::new() };
        match term.shadow_ray.map(|ray| &self.told.rays[ray]) {
            Some(ray) => format!("{what}: {}{lost}", arrival(ray)),
            None => format!("{what}{lost}"),
        }
    }

    /// What rounding adds is part of the sum, so it is shown where there is any.
    fn rounding(&mut self) {
        let told = self.told;
        for term in told.terms.iter().filter(|term| term.kind == TermKind::Rounding) {
            let line = format!("{}{}{}", style::FAINT, self.term(term), style::NONE);
            self.line(term.share, &[], &line);
        }
    }

    fn line(&mut self, share: [f64; 3], branches: &[bool], line: &str) {
        let [r, g, b] = share.map(positive_zero);
        let _ = write!(self.text, "{} {r:7.4} {g:7.4} {b:7.4}  ", percent(self.told, share));
        if let Some((last, above)) = branches.split_last() {
            above.iter().for_each(|more| self.text.push_str(if *more { "│  " } else { "   " }));
            self.text.push_str(if *last { "├─ " } else { "└─ " });
        }
        self.text.push_str(line);
        self.text.push('\n');
    }

    fn detail(&mut self, branches: &[bool], bar: bool, line: &str) {
        let _ = write!(self.text, "{:34}", "");
        branches.iter().for_each(|more| self.text.push_str(if *more { "│  " } else { "   " }));
        let bar = if bar { "│  " } else { "   " };
        let _ = writeln!(self.text, "{bar}{}{line}{}", style::FAINT, style::NONE);
    }
}

/// Without the minus sign of what rounds to zero in four decimals.
fn positive_zero(x: f64) -> f64 {
    if x.abs() < 5e-5 { 0.0 } else { x }
}

/// A share as percent of the pixel, in eight columns.
fn percent(told: &Explanation, share: [f64; 3]) -> String {
    match told.portion(share) {
        // No minus sign before a zero.
        Some(portion) if (portion * 100.0).abs() < 0.05 => format!("{:6.1} %", 0.0),
        Some(portion) => format!("{:6.1} %", portion * 100.0),
        None => format!("{:>8}", "-"),
    }
}
