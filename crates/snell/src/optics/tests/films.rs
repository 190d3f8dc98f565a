//! Metals and thin films against closed forms: bare boundaries, quarter and half waves, conservation of energy, the
//! incoherent mean, and tunnelling.

use proptest::prelude::*;

use super::config;
use crate::optics::{
    ComplexIndex, ThinFilm, fresnel_conductor, fresnel_conductor_average, fresnel_conductor_polarized,
    fresnel_dielectric_polarized, thin_film,
};

const COSINES: [f64; 6] = [1e-6, 0.01, 0.2, 0.5, 0.9, 1.0];

fn near(a: [f64; 2], b: [f64; 2], tolerance: f64) -> bool {
    (0..2).all(|i| (a[i] - b[i]).abs() < tolerance)
}

#[test]
fn a_metal_without_extinction_is_glass() {
    for cos in COSINES {
        for (from, to) in [(1.0, 1.5), (1.5, 1.0), (1.33, 2.4), (2.4, 1.33)] {
            let metal = fresnel_conductor_polarized(cos, from, ComplexIndex::from(to));
            let glass = fresnel_dielectric_polarized(cos, from, to);
            assert!(near(metal, glass, 1e-12), "{cos} {from} {to}: {metal:?} {glass:?}");
            let twin = fresnel_conductor_polarized(cos, from, ComplexIndex::new(to, 0.1));
            assert!(cos < 0.1 || !near(twin, glass, 1e-7), "the twin");
        }
    }
    assert_eq!(fresnel_conductor(0.0, 1.0, ComplexIndex::new(0.2, 3.0)), 1.0);
}

#[test]
fn metals_reflect_what_the_textbook_says() {
    for (n, k) in [(0.29, 2.863), (0.14, 4.15), (1.2, 7.0), (2.0, 0.5)] {
        // At normal incidence, ((n − 1)² + k²) / ((n + 1)² + k²).
        let closed = ((n - 1.0) * (n - 1.0) + k * k) / ((n + 1.0) * (n + 1.0) + k * k);
        assert!((fresnel_conductor(1.0, 1.0, ComplexIndex::new(n, k)) - closed).abs() < 1e-14);
        assert!((fresnel_conductor(1.0, 1.0, ComplexIndex::new(n, 1.1 * k)) - closed).abs() > 1e-3, "the twin");
        // At 45°, R_p = R_s² for any medium (Abelès).
        let [s, p] = fresnel_conductor_polarized(0.5_f64.sqrt(), 1.0, ComplexIndex::new(n, k));
        assert!((p - s * s).abs() < 1e-14, "{n} {k}");
        assert!((p - s).abs() > 1e-3, "the twin");
        let average = fresnel_conductor_average(1.0, ComplexIndex::new(n, k));
        assert!((0.0..1.0).contains(&average) && (average - closed).abs() < 0.1, "{average} {closed}");
    }
    // Walsh's closed form for glass of 1.5.
    assert!((fresnel_conductor_average(1.0, ComplexIndex::from(1.5)) - 0.091_777_959_342_4).abs() < 1e-5);
}

#[test]
fn no_film_and_a_film_of_one_of_the_media_are_not_there() {
    let gold = ComplexIndex::new(0.29, 2.863);
    for cos in COSINES {
        for behind in [ComplexIndex::from(1.5), ComplexIndex::from(1.1), gold] {
            let bare = fresnel_conductor_polarized(cos, 1.2, behind);
            for (index, thickness_nm) in [(1.9, 0.0), (1.2, 333.0)] {
                let film = ThinFilm { index: index.into(), thickness_nm };
                let shares = thin_film(cos, 1.2, film, behind, 500.0);
                assert!(near(shares.reflected, bare, 1e-9), "{cos} {behind:?}: {shares:?} {bare:?}");
            }
            // The behind medium once more as a film: what is reflected is the same, what comes through has been absorbed on.
            let film = ThinFilm { index: behind, thickness_nm: 100.0 };
            assert!(near(thin_film(cos, 1.2, film, behind, 500.0).reflected, bare, 1e-9));
            let film = ThinFilm { index: 1.9.into(), thickness_nm: 77.0 };
            // Under total reflection a film changes nothing.
            let shares = thin_film(cos, 1.2, film, behind, 500.0);
            assert!(cos < 0.1 || bare[0] > 0.99 || !near(shares.reflected, bare, 1e-4), "the twin");
        }
    }
}

#[test]
fn quarter_and_half_waves() {
    let (outside, film, glass, wavelength) = (1.0, 1.38, 1.52, 550.0);
    let reflected = |thickness_nm: f64| {
        thin_film(1.0, outside, ThinFilm { index: film.into(), thickness_nm }, glass.into(), wavelength).unpolarized()
            [0]
    };
    let quarter = wavelength / (4.0 * film);
    let amplitude = (outside * glass - film * film) / (outside * glass + film * film);
    assert!((reflected(quarter) - amplitude * amplitude).abs() < 1e-14);
    assert!((reflected(3.0 * quarter) - amplitude * amplitude).abs() < 1e-13);
    // It is the minimum; a half wave is not there.
    assert!(reflected(quarter) < reflected(0.98 * quarter) && reflected(quarter) < reflected(1.02 * quarter));
    assert!((reflected(2.0 * quarter) - reflected(0.0)).abs() < 1e-14);
    assert!((reflected(1.9 * quarter) - reflected(0.0)).abs() > 1e-4, "the twin");
    // The root of the glass's index makes a quarter wave perfect.
    let perfect = ThinFilm { index: glass.sqrt().into(), thickness_nm: wavelength / (4.0 * glass.sqrt()) };
    assert!(thin_film(1.0, 1.0, perfect, glass.into(), wavelength).unpolarized()[0] < 1e-28);
}

#[test]
fn the_mean_over_a_whole_turn_of_the_phase_is_that_of_powers() {
    // Averaged over half a wave of thickness, transmission is that of powers: T₁ T₂ / (1 − R₁ R₂).
    let (eta_i, eta_f, eta_t, cos_i, wavelength) = (1.0, 1.8, 1.33, 0.6, 500.0);
    let cos_f = (1.0_f64 - (1.0 - cos_i * cos_i) / (eta_f * eta_f)).sqrt();
    let half_wave = wavelength / (2.0 * eta_f * cos_f);
    let first = fresnel_dielectric_polarized(cos_i, eta_i, eta_f);
    let second = fresnel_dielectric_polarized(cos_f, eta_f, eta_t);
    for i in 0..2 {
        let steps = 64;
        let mean = |range: f64| {
            let at =
                |step: u32| ThinFilm { index: eta_f.into(), thickness_nm: range * f64::from(step) / f64::from(steps) };
            (0..steps).map(|s| thin_film(cos_i, eta_i, at(s), eta_t.into(), wavelength).transmitted[i]).sum::<f64>()
                / f64::from(steps)
        };
        let powers = (1.0 - first[i]) * (1.0 - second[i]) / (1.0 - first[i] * second[i]);
        assert!((mean(half_wave) - powers).abs() < 1e-12);
        // Parallel light is near Brewster's angle here, where films show little.
        assert!((mean(0.6 * half_wave) - powers).abs() > if i == 0 { 1e-3 } else { 1e-6 }, "the twin");
    }
}

#[test]
fn light_tunnels_through_a_thin_gap() {
    // Total reflection in glass is frustrated by glass behind a gap of air, and less so the wider the gap.
    let gap = |thickness_nm| {
        thin_film(0.5, 1.5, ThinFilm { index: 1.0.into(), thickness_nm }, 1.5.into(), 500.0).unpolarized()
    };
    let through: Vec<f64> = [0.0, 50.0, 200.0, 1000.0].into_iter().map(|nm| gap(nm)[1]).collect();
    assert!((through[0] - 1.0).abs() < 1e-12 && through[3] < 1e-5);
    assert!(through.windows(2).all(|pair| pair[0] > pair[1]), "{through:?}");
    let [reflected, transmitted] = gap(100.0);
    assert!((reflected + transmitted - 1.0).abs() < 1e-12);
}

proptest! {
    #![proptest_config(config())]

    #[test]
    fn transparent_films_lose_nothing_and_absorbing_ones_gain_nothing(
        cos in 1e-3..1.0f64, eta_i in 1.0..2.5f64, eta_f in 1.0..2.5f64, eta_t in 1.0..2.5f64,
        thickness_nm in 0.0..2000.0f64, wavelength in 360.0..830.0f64, k in 0.05..3.0f64,
    ) {
        let film = ThinFilm { index: eta_f.into(), thickness_nm };
        let shares = thin_film(cos, eta_i, film, eta_t.into(), wavelength);
        for i in 0..2 {
            let sum = shares.reflected[i] + shares.transmitted[i];
            prop_assert!((sum - 1.0).abs() < 1e-9, "{shares:?}");
        }
        let absorbing = ThinFilm { index: ComplexIndex::new(eta_f, k), thickness_nm: thickness_nm + 20.0 };
        let shares = thin_film(cos, eta_i, absorbing, eta_t.into(), wavelength);
        for i in 0..2 {
            let sum = shares.reflected[i] + shares.transmitted[i];
            prop_assert!(sum < 1.0 - 1e-9 || cos < 0.01 && sum < 1.0 + 1e-12, "the twin: {shares:?}");
        }
    }

    #[test]
    fn what_comes_through_is_the_same_both_ways(
        cos in 0.05..1.0f64, eta_t in 1.0..2.5f64, n in 0.1..3.0f64, k in 0.0..3.0f64, thickness_nm in 0.0..200.0f64,
    ) {
        // Between two transparent media, along the same path; the film may absorb.
        let film = ThinFilm { index: ComplexIndex::new(n, k), thickness_nm };
        let there = thin_film(cos, 1.0, film, eta_t.into(), 500.0).transmitted;
        let cos_t = (1.0 - (1.0 - cos * cos) / (eta_t * eta_t)).sqrt();
        let back = thin_film(cos_t, eta_t, film, 1.0.into(), 500.0).transmitted;
        prop_assert!(near(there, back, 1e-9), "{there:?} {back:?}");
    }
}
