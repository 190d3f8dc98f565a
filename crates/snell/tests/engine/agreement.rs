//! Path tracing against another renderer: means over regions of the pictures of benches/agreement, as Mitsuba has them.
//!
//! `cargo xtask bench agreement` compares converged pictures and keeps Mitsuba's means; here few samples must agree with those within their noise.

use snell::image::Image;
use snell::math::Rgb;
use snell::render::PathSettings;
use snell_testkit::must_fail;

use crate::files::{root, scene_of_text};
use crate::stage::Stage;

/// Regions in a row of the grid, and rows.
const GRID: [usize; 2] = [4, 3];
/// Twelve pixels to a region, each way: means over regions do not depend on the size of pixels.
const SIZE: [u32; 2] = [48, 36];
/// Pictures, each under a seed of its own, and their samples in each pixel.
const SEEDS: u32 = 16;
const SAMPLES: u32 = 4;

/// Subjects with photons, with which all pixels of a pass share their four wavelengths: few passes are a little too bright or too dark
/// as a whole, by as much as white is under the same seed, which is divided out.
const WITH_PHOTONS: [&str; 3] = ["smooth-glass", "medium", "environment"];
/// A white world, with glass and something matt behind the camera to have photons.
const WHITE_WORLD: &str = "[camera]\n[background]\ncolor = 1\n[[object]]\nsphere = { center = [0, 0, 30] }\n\
                           [[object]]\nsphere = { center = [0, 0, 20] }\nmaterial = { dielectric = {} }";

/// A mean with its standard error.
#[derive(Clone, Copy, Debug)]
struct Mean {
    mean: f64,
    error: f64,
}

/// What Mitsuba has for the regions of a subject, row by row.
fn theirs(subject: &str) -> Vec<Mean> {
    let table = include_str!("../data/mitsuba_means.csv");
    let rows = table.lines().filter_map(|line| line.strip_prefix(subject)?.strip_prefix(','));
    let mean = |row: &str| {
        let numbers: Vec<f64> = row.split(',').map(|number| number.parse().expect("a number")).collect();
        Mean { mean: numbers[2], error: numbers[3] }
    };
    rows.map(mean).collect()
}

/// What we have for a scene of benches/agreement, changed by `change`.
fn ours(subject: &str, change: impl FnOnce(String) -> String) -> Vec<Mean> {
    let path = format!("benches/agreement/{subject}.toml");
    let text = std::fs::read_to_string(root().join(&path)).expect("the scene is there");
    let stage = Stage::of(&scene_of_text(&path, change(text).as_bytes())).sized(SIZE[0], SIZE[1]);
    let white_world = Stage::new(WHITE_WORLD).sized(GRID[0] as u32, GRID[1] as u32);
    let pictures: Vec<Vec<f64>> = (0..SEEDS)
        .map(|seed| {
            let whites = if WITH_PHOTONS.contains(&subject) { trace(&white_world, seed) } else { vec![1.0] };
            trace(&stage, seed).into_iter().map(|mean| mean / whites[0]).collect()
        })
        .collect();
    let count = f64::from(SEEDS);
    let of_region = |region: usize| {
        let mean = pictures.iter().map(|picture| picture[region]).sum::<f64>() / count;
        let squares: f64 = pictures.iter().map(|picture| square(picture[region] - mean)).sum();
        Mean { mean, error: (squares / (count * (count - 1.0))).sqrt() }
    };
    (0..GRID[0] * GRID[1]).map(of_region).collect()
}

/// The means over the regions of a picture under a seed.
fn trace(stage: &Stage, seed: u32) -> Vec<f64> {
    let paths = PathSettings { samples: SAMPLES, depth: 1000, seed, ..PathSettings::default() };
    regions(&stage.picture_by_paths(&paths))
}

/// The mean of all channels over each region.
fn regions(image: &Image<Rgb>) -> Vec<f64> {
    let [width, height] = [image.width(), image.height()].map(|size| size as usize);
    let mut sums = vec![0.0; GRID[0] * GRID[1]];
    for (number, color) in image.pixels().iter().enumerate() {
        let (x, y) = (number % width, number / width);
        let sum: f64 = color.to_array().into_iter().map(f64::from).sum();
        sums[y * GRID[1] / height * GRID[0] + x * GRID[0] / width] += sum;
    }
    let values = (3 * width * height / sums.len()) as f64;
    sums.into_iter().map(|sum| sum / values).collect()
}

fn square(x: f64) -> f64 {
    x * x
}

/// Every region within four standard errors, and half a percent.
#[track_caller]
fn assert_agree(ours: &[Mean], theirs: &[Mean]) {
    assert_eq!(ours.len(), theirs.len(), "regions");
    for (region, (ours, theirs)) in ours.iter().zip(theirs).enumerate() {
        let allowed = 4.0 * (square(ours.error) + square(theirs.error)).sqrt() + 0.005 * theirs.mean;
        let deviation = (ours.mean - theirs.mean).abs();
        assert!(deviation <= allowed, "region {region}: {} for {}, {allowed} allowed", ours.mean, theirs.mean);
    }
}

/// A subject agrees, and does not where one word of its scene is another.
#[track_caller]
fn check(subject: &str, word: &str, defect: &str) {
    let theirs = theirs(subject);
    assert_agree(&ours(subject, |text| text), &theirs);
    let planted = ours(subject, |text| {
        assert!(text.contains(word), "{subject} has no `{word}`");
        text.replace(word, defect)
    });
    must_fail(defect, || assert_agree(&planted, &theirs));
}

#[test]
fn light_between_matt_surfaces_agrees_with_mitsuba() {
    check("diffuse", "diffuse = 0.75", "diffuse = 0.7125");
}

#[test]
fn smooth_glass_agrees_with_mitsuba() {
    check("smooth-glass", "ior = 1.5 ", "ior = 1.6 ");
}

#[test]
fn rough_glass_agrees_with_mitsuba() {
    check("rough-glass", "ior = 1.5,", "ior = 1.5, transmit = 0.95,");
}

#[test]
fn media_agree_with_mitsuba() {
    check("medium", "distance = 0.5", "distance = 0.6");
}

#[test]
fn lamps_agree_with_mitsuba() {
    check("area-light", "emission = 6", "emission = 6.3");
}

#[test]
fn a_panorama_agrees_with_mitsuba() {
    check("environment", "rotation = 40", "rotation = 42");
}
