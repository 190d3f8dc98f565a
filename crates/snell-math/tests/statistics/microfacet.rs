//! Rough surfaces: densities of what is sampled, normalisation, reciprocity, and the white furnace.

use snell_math::microfacet::{ConductorCompensation, DielectricCompensation, Ggx};
use snell_math::sampler::Sampler;
use snell_math::warp::{cosine_hemisphere, cosine_hemisphere_density};
use snell_math::{Vector3, portable};
use snell_testkit::chi_square::Histogram;
use snell_testkit::must_fail;
use std::f64::consts::PI;

const SURFACES: [[f64; 2]; 4] = [[0.1, 0.1], [0.5, 0.5], [1.0, 1.0], [0.2, 0.7]];

fn from_angle(degrees: f64) -> Vector3 {
    let angle = degrees * PI / 180.0;
    Vector3::new(portable::sin(angle) * 0.8, portable::sin(angle) * 0.6, portable::cos(angle))
}

fn reflect(wo: Vector3, normal: Vector3) -> Vector3 {
    normal * (2.0 * wo.dot(normal)) - wo
}

fn refract(wo: Vector3, normal: Vector3, eta: f64) -> Option<Vector3> {
    let cos = wo.dot(normal);
    let squared = 1.0 - eta * eta * (1.0 - cos * cos);
    (squared > 0.0).then(|| normal * (eta * cos - squared.sqrt()) - wo * eta)
}

/// Fresnel's share by the textbook, for `eta` = η_o / η_i.
fn fresnel(cos: f64, eta: f64) -> f64 {
    let squared = 1.0 - eta * eta * (1.0 - cos * cos);
    if squared <= 0.0 {
        return 1.0;
    }
    let t = squared.sqrt();
    let (s, p) = ((eta * cos - t) / (eta * cos + t), (cos - eta * t) / (cos + eta * t));
    0.5 * (s * s + p * p)
}

#[test]
fn visible_normals_and_what_they_reflect_and_refract() {
    let angles = [0.0, 30.0, 75.0];
    let tests = (SURFACES.len() * angles.len() * 4) as u32;
    let upper = Histogram::over([[0.0, 1.0], [-PI, PI]]).one_of(tests);
    let all = Histogram::of_directions().one_of(tests);
    for (alpha, angle) in SURFACES.into_iter().flat_map(|alpha| angles.map(|angle| (alpha, angle))) {
        let (ggx, wo) = (Ggx::new(alpha), from_angle(angle));
        let normal = |u| ggx.sample_visible(wo, u);
        upper.assert_directions("normals", |u| Some(normal(u)), |m| ggx.visible_density(wo, m));
        all.assert_directions("reflected", |u| Some(reflect(wo, normal(u))), |wi| ggx.reflection_density(wo, wi));
        for eta in [1.0 / 1.5, 1.5] {
            let density = |wi| ggx.transmission_density(wo, wi, eta);
            // From one side, since some light is refracted to the wrong one.
            let below = |u| refract(wo, normal(u), eta).filter(|wi| wi.z() < 0.0);
            all.assert_directions(&format!("refracted {alpha:?} {angle} {eta}"), below, density);
        }
    }
    let (ggx, wo) = (Ggx::new([0.3, 0.3]), from_angle(60.0));
    must_fail("normals without masking", || {
        let density = |m: Vector3| ggx.distribution(m) * m.z();
        upper.assert_directions("normals", |u| Some(ggx.sample_visible(wo, u)), density);
    });
    must_fail("a width that is off", || {
        let other = Ggx::new([0.32, 0.3]);
        upper.assert_directions("normals", |u| Some(other.sample_visible(wo, u)), |m| ggx.visible_density(wo, m));
    });
    must_fail("a forgotten Jacobian", || {
        let density = |wi| ggx.reflection_density(wo, wi) * 1.1;
        all.assert_directions("reflected", |u| Some(reflect(wo, ggx.sample_visible(wo, u))), density);
    });
}

#[test]
fn mirrors_cover_the_surface_and_what_is_seen_of_it() {
    for alpha in SURFACES {
        let ggx = Ggx::new(alpha);
        let (mut covered, mut seen) = (0.0, 0.0);
        let wo = from_angle(50.0);
        let steps = 1000;
        for i in 0..steps {
            for j in 0..200 {
                // Finer about the normal, where narrow distributions have everything.
                let t = (f64::from(i) + 0.5) / f64::from(steps);
                let normal = Histogram::direction([1.0 - t * t, 2.0 * PI * (f64::from(j) + 0.5) / 200.0]);
                let solid_angle = 2.0 * t / f64::from(steps) * 2.0 * PI / 200.0;
                covered += ggx.distribution(normal) * normal.z() * solid_angle;
                seen += ggx.masking(wo) * ggx.distribution(normal) * wo.dot(normal).max(0.0) * solid_angle;
            }
        }
        assert!((covered - 1.0).abs() < 1e-4, "{alpha:?}: {covered}");
        assert!((seen / wo.z() - 1.0).abs() < 1e-4, "{alpha:?}: {seen}");
        assert!((covered * Ggx::new([alpha[0] * 1.01, alpha[1]]).alpha()[0] / alpha[0] - 1.0).abs() > 1e-3, "the twin");
    }
}

#[test]
fn reflection_and_transmission_are_the_same_both_ways() {
    let ggx = Ggx::new([0.3, 0.6]);
    let (wo, wi) = (from_angle(40.0), Vector3::new(-0.6, 0.64, 0.48));
    assert!((ggx.reflection(wo, wi) / ggx.reflection(wi, wo) - 1.0).abs() < 1e-12);
    let below = Vector3::new(-0.2, -0.3, -0.93).normalize();
    let (eta, flip) = (1.0 / 1.5, |v: Vector3| -v);
    // Power: f(o, i) η_o² = f(i, o) η_i². The surface is turned over for the way back.
    let there = ggx.transmission(wo, below, eta);
    let back = ggx.transmission(flip(below), flip(wo), 1.0 / eta);
    assert!((there * eta * eta / back - 1.0).abs() < 1e-12, "{there} {back}");
    assert!((there / back - 1.0).abs() > 0.1, "the twin: without the squares");
}

/// The light that leaves by one bounce and by compensation, of a unit of light from a direction; by well-spread numbers.
fn furnace(bounce: impl Fn([f64; 2], f64) -> f64, rest: impl Fn(Vector3) -> f64) -> f64 {
    let count = 1 << 15;
    let mut sum = 0.0;
    for sample in 0..count {
        let [a, b, c, d] = Sampler::new(1, [0, 0], sample).set(0);
        let wi = cosine_hemisphere([c, d]);
        sum += bounce([a, b], c) + rest(wi) * wi.z() / cosine_hemisphere_density(wi.z());
    }
    sum / f64::from(count)
}

const COSINES: [f64; 6] = [0.02, 0.1, 0.3, 0.5, 0.8, 1.0];
const WIDTHS: [f64; 6] = [0.0025, 0.05, 0.2, 0.4, 0.7, 1.0];

fn from_cosine(cosine: f64) -> Vector3 {
    Vector3::new((1.0 - cosine * cosine).sqrt(), 0.0, cosine)
}

#[test]
fn a_white_rough_mirror_in_a_white_furnace_is_white() {
    let (mut worst, mut without) = (0.0_f64, 0.0_f64);
    for alpha in WIDTHS {
        let ggx = Ggx::new([alpha; 2]);
        let table = ConductorCompensation::new(ggx);
        for cosine in COSINES {
            let wo = from_cosine(cosine);
            let bounce = |u, _| {
                let wi = reflect(wo, ggx.sample_visible(wo, u));
                if wi.z() > 0.0 { ggx.reflection(wo, wi) * wi.z() / ggx.reflection_density(wo, wi) } else { 0.0 }
            };
            let all = furnace(bounce, |wi| table.reflection(cosine, wi.z(), 1.0));
            let single = furnace(bounce, |_| 0.0);
            assert!(
                (single - table.albedo(cosine)).abs() < 1e-3,
                "{alpha} {cosine}: {single} {}",
                table.albedo(cosine)
            );
            worst = worst.max((all - 1.0).abs());
            without = without.max((single - 1.0).abs());
        }
        // Where each bounce loses light, more bounces lose more.
        assert!(table.reflection(0.5, 0.5, 0.6) <= 0.6 * table.reflection(0.5, 0.5, 1.0));
    }
    println!("furnace of mirrors: {worst:e}, without compensation {without}");
    assert!(worst < 1e-3, "{worst}");
    assert!(without > 0.3, "the twin: {without}");
}

#[test]
fn rough_glass_in_a_white_furnace_is_not_there() {
    let (mut worst, mut without) = (0.0_f64, 0.0_f64);
    for (alpha, index) in WIDTHS.into_iter().map(|alpha| (alpha, 1.5)).chain([(0.4, 2.4), (0.7, 1.33)]) {
        let ggx = Ggx::new([alpha; 2]);
        let table = DielectricCompensation::new(ggx, index, fresnel);
        for (from_outside, cosine) in [true, false].into_iter().flat_map(|side| COSINES.map(|cosine| (side, cosine))) {
            let (wo, eta) = (from_cosine(cosine), if from_outside { 1.0 / index } else { index });
            let bounce = |u: [f64; 2], _| {
                let normal = ggx.sample_visible(wo, u);
                let share = fresnel(wo.dot(normal), eta);
                let mirrored = reflect(wo, normal);
                let back = if mirrored.z() > 0.0 {
                    share * ggx.reflection(wo, mirrored) * mirrored.z() / ggx.reflection_density(wo, mirrored)
                } else {
                    0.0
                };
                let through = refract(wo, normal, eta).filter(|wi| wi.z() < 0.0).map_or(0.0, |wi| {
                    let density = ggx.transmission_density(wo, wi, eta);
                    if density > 0.0 { (1.0 - share) * ggx.transmission(wo, wi, eta) * -wi.z() / density } else { 0.0 }
                });
                back + through
            };
            let rest = |wi: Vector3| {
                table.reflection(from_outside, cosine, wi.z()) + table.transmission(from_outside, cosine, wi.z())
            };
            let all = furnace(bounce, rest);
            let single = furnace(bounce, |_| 0.0);
            assert!((single - table.albedo(from_outside, cosine)).abs() < 1e-3, "{alpha} {cosine}: {single}");
            worst = worst.max((all - 1.0).abs());
            without = without.max((single - 1.0).abs());
        }
        // The same both ways, by the squares of the indices.
        let (there, back) = (table.transmission(true, 0.3, 0.8), table.transmission(false, 0.8, 0.3));
        assert!((there - back * index * index).abs() <= 1e-9 * there, "{alpha} {index}: {there} {back}");
        assert!((0.0..=1.0).contains(&table.crossing(true)) && (0.0..=1.0).contains(&table.crossing(false)));
    }
    println!("furnace of glass: {worst:e}, without compensation {without}");
    assert!(worst < 1e-3, "{worst}");
    assert!(without > 0.1, "the twin: {without}");
}

#[test]
fn numbers_stay_numbers() {
    for alpha in [f64::NAN, -1.0, 0.0, 1e-9, 1e3] {
        let ggx = Ggx::new([alpha; 2]);
        for z in [0.0, 1e-12, 1e-3, 1.0] {
            let wo = from_cosine(z);
            for u in [[0.0, 0.0], [0.5, 0.5], [0.999_999, 0.999_999]] {
                let normal = ggx.sample_visible(wo, u);
                assert!(normal.is_finite() && (normal.length() - 1.0).abs() < 1e-9, "{alpha} {z} {u:?}: {normal:?}");
                assert!(!ggx.visible_density(wo, normal).is_nan());
                assert!(!ggx.reflection(wo, reflect(wo, normal)).is_nan());
            }
        }
    }
    assert_eq!(Ggx::from_roughness(0.5).alpha(), [0.25; 2]);
}
