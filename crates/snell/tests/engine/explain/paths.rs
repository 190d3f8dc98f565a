//! Explanations of path tracing: what is told of samples is what they added, and its numbers are those of the laws they follow.

use snell::explain::{End, Explanation, Kind, Property, Subject, TermKind, explain_watched, map};
use snell::math::{Point3, Ray, Vector3, portable};
use snell::render::{NoProgress, PathSettings, Watch};
use snell::scene::scene::Antialiasing;
use snell::trace::Scratch;
use snell_testkit::must_fail;

use super::{scenes_with, stage};
use crate::stage::{Stage, reflectance};

fn samples(samples: u32) -> PathSettings {
    PathSettings { samples, ..PathSettings::default() }
}

fn watch<'a>(stage: &'a Stage, paths: &PathSettings) -> Watch<'a> {
    Watch::paths(&stage.scene, &stage.settings, paths).expect("a camera")
}

/// Explains some pixels with all their samples: the terms, in order, add up to the pixel. `change` may spoil an explanation.
fn terms_add_up(name: &str, change: impl Fn(&mut Explanation)) -> Vec<Explanation> {
    let stage = stage(name, Antialiasing::None);
    let paths = samples(3);
    let picture = stage.picture_by_paths(&paths);
    let mut watch = watch(&stage, &paths);
    let mut all = Vec::new();
    // One pixel of each three by three: photons set out anew for each.
    for [x, y] in stage.pixels().filter(|[x, y]| x % 3 == 1 && y % 3 == 1) {
        let mut told = explain_watched(&mut watch, Subject::Pixel([x, y]), &mut Scratch::default());
        change(&mut told);
        assert_eq!(told.samples.len(), 3);
        let rendered = picture.get(x, y).expect("a pixel").to_array().map(f64::from);
        let sum = told.terms.iter().fold([0.0; 3], |sum, term| [0, 1, 2].map(|i| sum[i] + term.share[i]));
        assert_eq!(sum.map(f64::to_bits), rendered.map(f64::to_bits), "{name} at {x}, {y}");
        all.push(told);
    }
    all
}

#[test]
fn terms_of_paths_add_up_to_the_pixel() {
    let mut told = Vec::new();
    for name in scenes_with("integrator = \"path\"") {
        told.append(&mut terms_add_up(&name, |_| {}));
    }
    // Everything that can be told came up.
    for kind in [TermKind::Background, TermKind::Emission, TermKind::Diffuse, TermKind::Photons] {
        assert!(told.iter().flat_map(|told| &told.terms).any(|term| term.kind == kind), "{kind:?}");
    }
    let rays = || told.iter().flat_map(|told| &told.rays);
    for kind in [Kind::Reflected, Kind::Refracted, Kind::Scattered, Kind::Shadow] {
        assert!(rays().any(|ray| ray.kind == kind), "{kind:?}");
    }
    assert!(rays().any(|ray| ray.kind == Kind::Refracted && ray.wavelength_nm.is_some()), "light was split");
    assert!(rays().any(|ray| ray.kind == Kind::Refracted && ray.wavelength_nm.is_none()), "and was not");
    assert!(rays().any(|ray| ray.end == End::Chance && ray.kind != Kind::Camera), "a path ended by chance");
    must_fail("a share is lost", || {
        terms_add_up("caustic", |told| {
            told.terms.remove(0);
        });
    });
}

/// A path through a ball of dispersive glass bends as the index at its hero says, and carries that wavelength alone from there on.
#[test]
fn a_path_is_bent_by_its_hero() {
    let stage = Stage::new(
        "[background]\ncolor = 1\n[[object]]\nname = \"ball\"\nsphere = {}\nmaterial = { dielectric = { ior = \"SF11\" } }\n",
    );
    let mut watch = watch(&stage, &samples(1));
    let ray = Ray::new(Point3::new(0.0, 0.6, 5.0), Vector3::new(0.0, 0.0, -1.0));
    let (incidence, mut heroes) = (portable::asin(0.6), Vec::new());
    for number in 0..24 {
        let told = explain_watched(&mut watch, Subject::Ray(ray, number), &mut Scratch::default());
        let hero = told.samples[0].wavelengths_nm[0];
        assert_eq!((told.samples[0].wavelengths_nm.len(), told.rays[0].wavelength_nm), (4, None));
        let first = &told.rays[0].surface.as_ref().expect("the ball").boundaries[0];
        assert_eq!(first.wavelength_nm, Some(hero));
        let n = first.media[1].index;
        let near = |actual: f64, expected: f64| assert!((actual - expected).abs() < 1e-12, "{actual} {expected}");
        near(first.incidence, incidence);
        near(first.refraction.expect("refracts"), portable::asin(0.6 / n));
        near(first.reflectance, reflectance(portable::cos(incidence), 1.0, n));
        if let Some(inside) = told.rays.iter().find(|ray| ray.kind == Kind::Refracted && ray.depth == 2) {
            assert_eq!(inside.wavelength_nm, Some(hero));
            near(inside.medium.index, n);
            near(inside.distance.expect("traced"), 2.0 * portable::cos(portable::asin(0.6 / n)));
        }
        heroes.push((hero, n));
    }
    heroes.sort_by(|a, b| a.0.total_cmp(&b.0));
    assert!(heroes.windows(2).all(|pair| pair[0].1 > pair[1].1), "shorter waves are bent more: {heroes:?}");
    assert!(heroes[23].0 - heroes[0].0 > 100.0);
}

#[test]
fn light_that_a_medium_scatters_is_told() {
    let stage = Stage::new(
        "[background]\ncolor = 1\n[[object]]\nsphere = {}\nmaterial = { dielectric = { ior = 1.3, scattering = { distance = 0.2 } } }\n",
    );
    let mut watch = watch(&stage, &samples(1));
    let ray = Ray::new(Point3::new(0.0, 0.0, 5.0), Vector3::new(0.0, 0.0, -1.0));
    let mut scattered = 0;
    for number in 0..16 {
        let told = explain_watched(&mut watch, Subject::Ray(ray, number), &mut Scratch::default());
        for (number, ray) in told.rays.iter().enumerate().filter(|(_, ray)| ray.end == End::Scattered) {
            let distance = ray.distance.expect("traced");
            assert!(distance < 2.0 && ray.surface.is_none() && ray.medium.material.is_some(), "{ray:?}");
            let end = ray.origin.expect("traced") + ray.direction.expect("traced") * distance;
            if let Some(child) = told.children(number).find_map(|child| told.rays[child].origin) {
                assert!(child.distance(end) < 1e-9);
                scattered += 1;
            }
        }
    }
    assert!(scattered > 16, "{scattered}");
}

#[test]
fn maps_of_paths_are_what_samples_say() {
    let stage = stage("caustic", Antialiasing::None);
    let paths = samples(2);
    let mut watch = watch(&stage, &paths);
    for (name, wanted) in [("share:photons", TermKind::Photons), ("share:emission", TermKind::Emission)] {
        let property: Property = name.parse().expect("a name");
        let values = map(&mut watch, &property, &NoProgress).expect("a map");
        let mut some = 0;
        for [x, y] in stage.pixels().filter(|[x, y]| x % 4 == 1 && y % 3 == 2) {
            let told = explain_watched(&mut watch, Subject::Pixel([x, y]), &mut Scratch::default());
            let luminance = |of: &dyn Fn(TermKind) -> bool| -> f32 {
                told.terms.iter().filter(|term| of(term.kind)).map(|term| term.value.luminance()).sum()
            };
            let all = luminance(&|kind| kind != TermKind::Rounding);
            let expected = if all > 0.0 { (luminance(&|kind| kind == wanted) / all).clamp(0.0, 1.0) } else { 0.0 };
            let value = *values.get(x, y).expect("a pixel");
            assert!((value - expected).abs() < 1e-5, "{name} at {x}, {y}: {value}, expected {expected}");
            some += u32::from(value > 0.0);
        }
        assert!(some > 0 || wanted == TermKind::Emission, "{name}");
    }
}
