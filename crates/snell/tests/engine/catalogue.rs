//! What paths take from the catalogue: measured indices in place of the lecture's numbers, and what glasses absorb.

use snell::image::Image;
use snell::math::Rgb;
use snell::math::spectrum::{d65, spectrum_to_rgb};
use snell::render::PathSettings;
use snell::scene::catalogue::{self, Glass};
use snell_testkit::must_fail;

use crate::stage::Stage;

fn trace(stage: &Stage, samples: u32) -> Image<Rgb> {
    let paths = PathSettings { samples, ..PathSettings::default() };
    stage.picture_by_paths(&paths)
}

fn ball(ior: &str) -> Stage {
    let text = format!(
        "[background]\ngradient = {{ horizon = 1, zenith = [0, 0.2, 0.9], nadir = [0.6, 0.1, 0] }}\n\
         [material.a]\ndielectric = {{ ior = {ior} }}\n[[object]]\nsphere = {{}}\nmaterial = 'a'\n"
    );
    Stage::new(&text).sized(12, 9)
}

#[test]
fn paths_take_what_was_measured_and_whitted_what_the_lecture_prints() {
    for (name, measured, printed) in [
        ("'diamond'", "'diamond-dispersive'", "2.419"),
        ("'water'", "'water-20C'", "1.333"),
        ("'Rock-Salt'", "'NaCl'", "1.516"),
    ] {
        assert_eq!(trace(&ball(name), 4).pixels(), trace(&ball(measured), 4).pixels(), "{name}");
        assert_eq!(ball(name).picture().pixels(), ball(printed).picture().pixels(), "{name}");
        assert_ne!(trace(&ball(name), 4).pixels(), trace(&ball(printed), 4).pixels(), "{name}");
        assert_ne!(ball(name).picture().pixels(), ball(measured).picture().pixels(), "{name}");
    }
    assert_eq!(trace(&ball("'ice'"), 4).pixels(), trace(&ball("1.31"), 4).pixels());
}

/// A white wall seen through a slab of a glass, whose surfaces reflect nothing.
fn slab(glass: &str, unit: &str, thickness: f64) -> Stage {
    let text = format!(
        "unit = {unit}\n[camera]\neye = [0, 0, 50]\nlook_at = [0, 0, 0]\nfov = 4\n[background]\ncolor = 1\n\
         [material.a]\ndielectric = {{ ior = '{glass}', absorption = 'catalogue', fresnel = false, reflect = 0, transmit = 1 }}\n\
         [[object]]\nbox = {{ min = [-90, -90, -{thickness}], max = [90, 90, 0] }}\nmaterial = 'a'\n"
    );
    Stage::new(&text).sized(16, 16)
}

#[test]
fn glasses_absorb_what_their_internal_transmittance_says() {
    let mean = |image: &Image<Rgb>| {
        image.pixels().iter().fold(Rgb::BLACK, |sum, color| sum + *color) * (1.0 / image.pixels().len() as f32)
    };
    for (name, thickness_mm) in [("F2G12", 40.0), ("SF6", 100.0), ("N-BK7", 500.0)] {
        let glass = Glass::from(catalogue::lookup(name).expect("known"));
        // At the ends of what was measured, what is nearest.
        let [low, high] = [glass.extinction[0][0], glass.extinction[glass.extinction.len() - 1][0]];
        let transmittance = |nm: f64| {
            let at = nm.clamp(low, high);
            let left = glass.internal_transmittance(at, thickness_mm).expect("measured");
            snell::math::portable::pow(left, at / nm)
        };
        let expected = spectrum_to_rgb(|nm| d65(nm) * transmittance(nm));
        let near = |found: Rgb, tolerance: f32| (found - expected).max_abs() <= tolerance;
        for (unit, in_mm) in [("'cm'", 10.0), ("1.0", 1.0), ("'in'", 25.4)] {
            let stage = slab(name, unit, thickness_mm / in_mm);
            let found = mean(&trace(&stage, 256));
            assert!(near(found, 0.02), "{name}, {unit}: {found:?}, not {expected:?}");
            // Three colours show what absorbs evenly; not the violet edge of a flint, which is gone before blue is.
            if name == "F2G12" {
                let shown = mean(&stage.picture());
                assert!(near(shown, 0.06), "{name}, {unit}, by its colour: {shown:?}, not {expected:?}");
            }
        }
        must_fail("a world unit of a metre", || {
            assert!(near(mean(&trace(&slab(name, "'m'", thickness_mm), 64)), 0.02))
        });
    }
}
