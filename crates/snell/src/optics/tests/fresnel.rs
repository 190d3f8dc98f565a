//! Fresnel's equations against a table made with another implementation, against their other textbook form, and by the
//! laws that hold between the two sides of a boundary.

use proptest::prelude::*;
use snell_math::portable;

use super::config;
use crate::optics::{
    FresnelAmplitudes, brewster_angle, cos_transmitted, critical_angle, fresnel_amplitudes, fresnel_dielectric,
    fresnel_dielectric_polarized,
};

const INDICES: [f64; 8] = [1.0, 1.000_036, 1.000_292_6, 1.31, 1.333, 1.5, 1.9, 2.419];

/// ∫ 2 R(c) c dc over [0, 1]: the share of diffuse light that is reflected. Midpoints in √c, in two pieces, because R
/// has a root's edge at the critical angle.
fn diffuse_reflectance(eta_i: f64, eta_t: f64) -> f64 {
    let edge = critical_angle(eta_i, eta_t).map_or(0.0, portable::cos);
    let steps = 20_000;
    let beyond = edge * edge;
    let inside: f64 = (0..steps)
        .map(|i| {
            let x = (f64::from(i) + 0.5) / f64::from(steps);
            let c = edge + (1.0 - edge) * x * x;
            2.0 * fresnel_dielectric(c, eta_i, eta_t) * c * (1.0 - edge) * 2.0 * x / f64::from(steps)
        })
        .sum();
    beyond + inside
}

/// An entry of the table against ours; true where it agrees or is none.
fn agree(ours: f64, expected: &str, relative: f64, absolute: f64) -> bool {
    expected == "none" || {
        let expected: f64 = expected.parse().unwrap();
        (ours - expected).abs() <= relative * expected.abs() + absolute
    }
}

#[test]
fn every_index_of_the_reference_table() {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/../../../shared/reference/fresnel_indices.csv");
    let Ok(table) = std::fs::read_to_string(path) else {
        println!("skipped: {path} is absent");
        return;
    };
    let mut checked = 0;
    for line in table.lines().skip(2) {
        let (name, numbers) = match line.strip_prefix('"') {
            Some(rest) => rest.split_once("\",").unwrap(),
            None => line.split_once(',').unwrap(),
        };
        let row: Vec<&str> = numbers.split(',').collect();
        let n: f64 = row[0].parse().unwrap();
        // The table has twelve digits; but its diffuse reflectances come from a closed form that cancels where n is
        // near one (helium's is 3e-4 off, as sixty decimal digits show), and ours from a quadrature.
        let normal = fresnel_dielectric(1.0, 1.0, n);
        let columns = [
            (normal, 5e-12, 0.0),
            (portable::degrees(brewster_angle(1.0, n)), 5e-12, 0.0),
            (portable::degrees(brewster_angle(n, 1.0)), 5e-12, 0.0),
            (critical_angle(n, 1.0).map_or(90.0, portable::degrees), 5e-12, 0.0),
            (diffuse_reflectance(1.0, n), 1e-7, 1e-8),
            (diffuse_reflectance(n, 1.0), 1e-7, 1e-8),
            (2.0 * normal / (1.0 + normal), 5e-12, 0.0),
        ];
        for ((ours, relative, absolute), expected) in columns.into_iter().zip(&row[1..]) {
            assert!(agree(ours, expected, relative, absolute), "{name}: {ours} instead of {expected}");
            // The twin: one part in a million aside.
            let none = *expected == "none" || *expected == "0";
            assert!(none || !agree(ours * 1.000_001 + 2e-8, expected, relative, absolute), "{name}: {ours}");
        }
        checked += 1;
    }
    assert!(checked >= 17, "only {checked} rows");
}

#[test]
fn diffuse_light_is_reflected_as_walsh_says() {
    // Walsh's closed form of 1926 for light on the outside, evaluated with sixty digits.
    for (n, expected) in [
        (1.000_036, 1.199_394_644_863_901e-5),
        (1.000_292_6, 9.722_309_594_568_033e-5),
        (1.31, 0.062_741_988_538_558_26),
        (1.5, 0.091_777_959_342_351_21),
    ] {
        let ours = diffuse_reflectance(1.0, n);
        assert!((ours / expected - 1.0).abs() < 1e-5, "{n}: {ours:e} {expected:e}");
    }
}

#[test]
fn normal_incidence_is_the_closed_form() {
    for a in INDICES {
        for b in INDICES {
            let amplitude = (a - b) / (a + b);
            let expected = amplitude * amplitude;
            let ours = fresnel_dielectric(1.0, a, b);
            assert!((ours - expected).abs() <= 1e-14 * expected, "{a} to {b}: {ours:e} instead of {expected:e}");
        }
    }
}

#[test]
fn total_and_grazing_reflection_are_exactly_one() {
    for a in INDICES {
        for b in INDICES.into_iter().filter(|b| *b != a) {
            assert_eq!(fresnel_dielectric(0.0, a, b), 1.0);
            assert_eq!(fresnel_dielectric(-0.0, a, b), 1.0);
            if let Some(critical) = critical_angle(a, b) {
                assert_eq!(fresnel_dielectric(portable::cos(critical + 1e-7), a, b), 1.0);
                assert!(fresnel_dielectric(portable::cos(critical - 1e-3), a, b) < 1.0);
            }
        }
    }
}

#[test]
fn equal_indices_reflect_exactly_nothing() {
    for n in INDICES {
        for cos in [0.0, 1e-9, 0.3, 1.0] {
            assert_eq!(fresnel_dielectric(cos, n, n), 0.0);
        }
    }
}

#[test]
fn brewster_light_has_no_parallel_part() {
    for a in INDICES {
        for b in INDICES.into_iter().filter(|b| *b != a) {
            let cos = portable::cos(brewster_angle(a, b));
            let [s, p] = fresnel_dielectric_polarized(cos, a, b);
            assert!(p < 1e-30 && s > 0.0, "{a} to {b}: {p:e}");
            // There the reflected and the refracted ray are perpendicular.
            let sin_t = a / b * ((1.0 - cos) * (1.0 + cos)).sqrt();
            assert!((sin_t - cos).abs() < 1e-14);
        }
    }
}

#[test]
fn a_cosine_out_of_range_is_the_nearest_one() {
    assert_eq!(fresnel_dielectric(1.0 + 1e-12, 1.0, 1.5), fresnel_dielectric(1.0, 1.0, 1.5));
    assert_eq!(fresnel_dielectric(-0.5, 1.0, 1.5), 1.0);
    assert!((0.0..=1.0).contains(&fresnel_dielectric(f64::NAN, 1.0, 1.5)));
}

/// The share of power that goes through, from the amplitudes; `true` plants a defect: the beam's change of width is
/// forgotten.
fn transmitted(cos_i: f64, eta_i: f64, eta_t: f64, forget_width: bool) -> Option<[f64; 2]> {
    let FresnelAmplitudes { cos_t, t_s, t_p, .. } = fresnel_amplitudes(cos_i, eta_i, eta_t)?;
    let factor = eta_t / eta_i * if forget_width { 1.0 } else { cos_t / cos_i };
    Some([factor * t_s * t_s, factor * t_p * t_p])
}

proptest! {
    #![proptest_config(config())]

    #[test]
    fn sine_and_tangent_laws(cos_i in 0.01..0.999f64, eta_i in 1.0..2.5f64, eta_t in 1.0..2.5f64) {
        prop_assume!((eta_i - eta_t).abs() > 0.05);
        let Some(cos_t) = cos_transmitted(cos_i, eta_i / eta_t) else {
            prop_assert_eq!(fresnel_dielectric_polarized(cos_i, eta_i, eta_t), [1.0, 1.0]);
            return Ok(());
        };
        prop_assume!(cos_t > 0.01);
        let (i, t) = (portable::acos(cos_i), portable::acos(cos_t));
        let r_s = -portable::sin(i - t) / portable::sin(i + t);
        let r_p = portable::tan(i - t) / portable::tan(i + t);
        let ours = fresnel_amplitudes(cos_i, eta_i, eta_t).unwrap();
        // Angles lose digits where they are small: 1e-12 is of one.
        prop_assert!((ours.r_s - r_s).abs() < 1e-12 && (ours.r_p - r_p).abs() < 1e-12, "{ours:?} {r_s} {r_p}");
        let unpolarised = 0.5 * (r_s * r_s + r_p * r_p);
        prop_assert!((fresnel_dielectric(cos_i, eta_i, eta_t) - unpolarised).abs() < 1e-12);
        // The twin: indices swapped.
        let swapped = fresnel_amplitudes(cos_i, eta_t, eta_i).map_or(1.0, |other| other.r_s);
        prop_assert!((swapped - r_s).abs() > 1e-3);
    }

    #[test]
    fn no_power_is_lost(cos_i in 1e-4..1.0f64, eta_i in 1.0..2.5f64, eta_t in 1.0..2.5f64) {
        let Some(through) = transmitted(cos_i, eta_i, eta_t, false) else { return Ok(()) };
        let back = fresnel_dielectric_polarized(cos_i, eta_i, eta_t);
        for (r, t) in back.iter().zip(through) {
            prop_assert!((r + t - 1.0).abs() < 1e-12, "{r} + {t}");
        }
        if (eta_i - eta_t).abs() > 0.1 && cos_i < 0.9 {
            let defective = transmitted(cos_i, eta_i, eta_t, true).unwrap();
            prop_assert!((back[0] + defective[0] - 1.0).abs() > 1e-4, "the twin");
        }
    }

    #[test]
    fn stokes_relations(cos_i in 1e-3..1.0f64, eta_i in 1.0..2.5f64, eta_t in 1.0..2.5f64) {
        // The same boundary from behind, along the same path: r' = −r and t t' = 1 − r².
        prop_assume!((eta_i - eta_t).abs() > 1e-6);
        let Some(there) = fresnel_amplitudes(cos_i, eta_i, eta_t) else { return Ok(()) };
        prop_assume!(there.cos_t > 1e-3);
        let back = fresnel_amplitudes(there.cos_t, eta_t, eta_i).expect("the way back");
        prop_assert!((back.cos_t - cos_i).abs() < 1e-12);
        prop_assert!((back.r_s + there.r_s).abs() < 1e-12 && (back.r_p + there.r_p).abs() < 1e-12);
        prop_assert!((there.t_s * back.t_s - (1.0 - there.r_s * there.r_s)).abs() < 1e-12);
        prop_assert!((there.t_p * back.t_p - (1.0 - there.r_p * there.r_p)).abs() < 1e-12);
        let unpolarised = fresnel_dielectric(cos_i, eta_i, eta_t);
        prop_assert!((fresnel_dielectric(there.cos_t, eta_t, eta_i) - unpolarised).abs() < 1e-12, "the same both ways");
    }
}
