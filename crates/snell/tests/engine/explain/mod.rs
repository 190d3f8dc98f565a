//! What is explained is what was rendered: the shares of a pixel add up to the pixel, bit for bit, and its numbers are those of
//! closed forms.

mod figures;
mod numbers;
mod paths;
mod pictures;

use std::collections::BTreeSet;

use snell::explain::{Explanation, Kind, Subject, explain_watched};
use snell::film::PixelSum;
use snell::observe::RayTree;
use snell::render::{Watch, explain};
use snell::scene::scene::Antialiasing;
use snell::trace::Scratch;
use snell_testkit::must_fail;

use crate::files::{root, scene_of_file};
use crate::stage::Stage;

/// Every scene of the gallery that is rendered.
fn rendered_scenes() -> BTreeSet<String> {
    scenes_with("[[light]]")
}

/// Every scene of the gallery that has such a line.
fn scenes_with(line: &str) -> BTreeSet<String> {
    let files = std::fs::read_dir(root().join("scenes")).expect("a folder");
    let names: BTreeSet<String> = files
        .filter_map(|entry| {
            let path = entry.ok()?.path();
            let text = std::fs::read_to_string(&path).ok()?;
            let has_line = text.lines().any(|other| other.trim_end() == line);
            let stem = path.file_stem()?.to_string_lossy().into_owned();
            (path.extension()? == "toml" && has_line).then_some(stem)
        })
        .collect();
    assert!(names.len() > 4, "{names:?}");
    names
}

fn stage(name: &str, antialiasing: Antialiasing) -> Stage {
    let mut stage = Stage::of(&scene_of_file(&format!("scenes/{name}.toml"))).sized(16, 12);
    stage.settings.antialiasing = antialiasing;
    stage
}

/// Explains every sample of every pixel of a small picture and compares with the rendering. `change` may spoil a tree.
fn shares_add_up(name: &str, antialiasing: Antialiasing, change: impl Fn(&mut RayTree)) {
    let stage = stage(name, antialiasing);
    let samples = if let Antialiasing::Samples(count) = antialiasing { count } else { 1 };
    let picture = stage.picture();
    for [x, y] in stage.pixels() {
        let mut sum = PixelSum::default();
        for sample in 0..samples {
            let mut tree = explain(&stage.scene, &stage.settings, [x, y], sample).expect("a camera");
            change(&mut tree);
            assert!(sum.add(tree.sum()), "{name}: no number at {x}, {y}");
        }
        let rendered = picture.get(x, y).expect("a pixel").to_array().map(f32::to_bits);
        assert_eq!(sum.mean().to_array().map(f32::to_bits), rendered, "{name} at {x}, {y}");
    }
}

/// Explains every pixel of a small picture: the terms, in order, add up to the rendered pixel, and so do the shares of rays.
/// `change` may spoil an explanation.
fn terms_add_up(name: &str, antialiasing: Antialiasing, change: impl Fn(&mut Explanation)) -> u32 {
    let stage = stage(name, antialiasing);
    let picture = stage.picture();
    let mut watch = Watch::new(&stage.scene, &stage.settings).expect("a camera");
    let mut scratch = Scratch::default();
    let mut samples = 0;
    for [x, y] in stage.pixels() {
        let mut told = explain_watched(&mut watch, Subject::Pixel([x, y]), &mut scratch);
        change(&mut told);
        let rendered = picture.get(x, y).expect("a pixel").to_array().map(f64::from);
        let sum = told.terms.iter().fold([0.0; 3], |sum, term| [0, 1, 2].map(|i| sum[i] + term.share[i]));
        assert_eq!(sum.map(f64::to_bits), rendered.map(f64::to_bits), "{name} at {x}, {y}");
        let near = |sum: [f64; 3], what: &str| {
            for i in 0..3 {
                let error = (sum[i] - rendered[i]).abs();
                assert!(error <= 1e-6 * (1.0 + rendered[i].abs()), "{name} at {x}, {y}: {what} {sum:?} {rendered:?}");
            }
        };
        let cameras = told.rays.iter().filter(|ray| ray.kind == Kind::Camera && ray.parent.is_none());
        near(cameras.fold([0.0; 3], |sum, ray| [0, 1, 2].map(|i| sum[i] + ray.share[i])), "camera rays");
        near(told.paths.iter().fold([0.0; 3], |sum, path| [0, 1, 2].map(|i| sum[i] + path.mean[i])), "paths");
        for (number, ray) in told.rays.iter().enumerate() {
            assert!(ray.parent.is_none_or(|parent| parent < number), "parents come first");
        }
        samples += told.samples.len() as u32;
    }
    samples
}

#[test]
fn shares_add_up_to_the_pixel() {
    for name in rendered_scenes() {
        shares_add_up(&name, Antialiasing::None, |_| {});
    }
    // Dispersion, and several samples a pixel.
    shares_add_up("refraction-and-wavelength", Antialiasing::Samples(3), |_| {});
}

#[test]
fn terms_add_up_to_the_pixel() {
    for name in rendered_scenes() {
        terms_add_up(&name, Antialiasing::None, |_| {});
    }
    terms_add_up("refraction-and-wavelength", Antialiasing::Samples(5), |_| {});
}

#[test]
fn terms_add_up_where_pixels_have_as_many_samples_as_they_need() {
    for name in ["seven-rays", "refraction-and-wavelength", "five-glass-balls"] {
        let samples = terms_add_up(name, Antialiasing::Adaptive, |_| {});
        assert!(samples > 2 * 16 * 12, "{name}: {samples}");
    }
}

#[test]
fn a_lost_share_is_told() {
    let message = must_fail("the last share is missing", || {
        shares_add_up("seven-rays", Antialiasing::None, |tree| {
            tree.shares.pop();
        });
    });
    assert!(message.contains("seven-rays at"), "{message}");
    must_fail("a term is off by one bit", || {
        terms_add_up("seven-rays", Antialiasing::None, |told| {
            let share = &mut told.terms[0].share[1];
            *share = f64::from(f32::from_bits((*share as f32).to_bits() + 1));
        });
    });
    must_fail("one sample was not taken", || {
        terms_add_up("seven-rays", Antialiasing::Adaptive, |told| {
            if told.samples.len() > 1 {
                let last = told.samples.len() - 1;
                told.terms.retain(|term| term.ray.is_none_or(|ray| told.rays[ray].sample < last));
            }
        });
    });
}
