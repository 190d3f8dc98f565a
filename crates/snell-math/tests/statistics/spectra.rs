//! Spectra of paths: the wavelengths and their colours, smooth spectra of colours and back, daylight and measured spectra.

use snell_math::Rgb;
use snell_math::spectrum::{
    Daylight, HeroWavelengths, MeasuredSpectrum, MeasuredSpectrumError, SmoothEmission, SmoothLattice,
    SmoothReflectance, Spectrum, VISIBLE_NM, color_matching, d65, spectrum_to_xyz, xyz_to_linear_srgb,
};
use snell_testkit::chi_square::Histogram;
use snell_testkit::{TestRng, must_fail};

/// The colour that a path has in expectation, by `count` paths at even numbers.
fn expectation(count: u32, wavelengths: impl Fn(f64) -> HeroWavelengths, spectrum: impl Fn(f64) -> f64) -> [f64; 3] {
    let mut sum = [0.0; 3];
    for i in 0..count {
        let wavelengths = wavelengths((f64::from(i) + 0.5) / f64::from(count));
        for (sum, value) in sum.iter_mut().zip(wavelengths.to_linear_srgb(wavelengths.nm().map(&spectrum))) {
            *sum += value / f64::from(count);
        }
    }
    sum
}

fn differs(a: [f64; 3], b: [f64; 3]) -> f64 {
    (0..3).map(|i| (a[i] - b[i]).abs()).fold(0.0, f64::max)
}

#[test]
fn white_is_exactly_white_in_expectation() {
    for wavelengths in [HeroWavelengths::sample, HeroWavelengths::even] {
        let white = expectation(1 << 14, wavelengths, d65);
        assert!(differs(white, [1.0; 3]) < 1e-7, "{white:?}");
        let alone = expectation(1 << 16, |u| wavelengths(u).hero_alone(), d65);
        assert!(differs(alone, [1.0; 3]) < 1e-6, "{alone:?}");
    }
    // The twins: light that is almost D65, and the equal-energy spectrum, which is reddish.
    assert!(differs(expectation(1 << 14, HeroWavelengths::sample, |nm| d65(nm + 0.1)), [1.0; 3]) > 1e-4);
    let equal = expectation(1 << 14, HeroWavelengths::sample, |_| 1.0);
    assert!(differs(equal, [1.2049, 0.9483, 0.9091]) < 3e-4, "{equal:?}");
}

#[test]
fn any_spectrum_has_its_colour_in_expectation() {
    let bump = |nm: f64| 1.0 / (1.0 + (nm - 480.0) * (nm - 480.0) / 400.0);
    let exact = {
        let mut sum = [0.0; 4];
        for i in 0..47_000 {
            let nm = VISIBLE_NM[0] + 0.01 * (f64::from(i) + 0.5);
            let xyz = color_matching(nm);
            for (sum, value) in sum.iter_mut().zip([xyz[0] * bump(nm), xyz[1] * bump(nm), xyz[2] * bump(nm), xyz[1]]) {
                *sum += value;
            }
        }
        xyz_to_linear_srgb([sum[0] / sum[3], sum[1] / sum[3], sum[2] / sum[3]])
    };
    // The published matrix makes D65 white to 0.00017 only; paths have it exactly.
    let ours = expectation(1 << 14, HeroWavelengths::sample, bump);
    assert!((0..3).all(|i| (ours[i] / exact[i] - 1.0).abs() < 2e-4), "{ours:?} {exact:?}");
    let wrong = expectation(1 << 14, HeroWavelengths::sample, |nm| bump(nm + 1.0));
    assert!((0..3).any(|i| (wrong[i] / exact[i] - 1.0).abs() > 1e-3), "the twin");
}

#[test]
fn wavelengths_have_their_density() {
    let grid = Histogram::over([VISIBLE_NM, [0.0, 1.0]]).with_cells([94, 2]).one_of(2);
    for rotation in [0, 3] {
        let sample = |[u, v]: [f64; 2]| Some([HeroWavelengths::sample(u).nm()[rotation], v]);
        grid.assert("wavelengths", sample, |[nm, _]| HeroWavelengths::visible_density(nm));
        must_fail("wavelengths five nanometres aside", || {
            grid.assert("", sample, |[nm, _]| HeroWavelengths::visible_density(nm + 5.0));
        });
    }
    for u in [0.0, 0.25, 0.5, 0.999_999_999, 1.0 - f64::EPSILON] {
        let wavelengths = HeroWavelengths::sample(u);
        for (nm, density) in wavelengths.nm().into_iter().zip(wavelengths.density()) {
            assert!((VISIBLE_NM[0]..=VISIBLE_NM[1]).contains(&nm) && density > 0.0, "{wavelengths:?}");
        }
    }
    assert_eq!(HeroWavelengths::visible_density(359.0) + HeroWavelengths::visible_density(f64::NAN), 0.0);
    let alone = HeroWavelengths::sample(0.3).hero_alone();
    assert!(alone.is_hero_alone() && alone.hero_alone() == alone);
}

#[test]
fn a_path_has_less_noise_than_with_even_wavelengths() {
    let noise = |wavelengths: fn(f64) -> HeroWavelengths| {
        let mut rng = TestRng::new(2);
        let square = |value: f64| (value - 1.0) * (value - 1.0);
        let mut sum = [0.0; 3];
        for _ in 0..4000 {
            let wavelengths = wavelengths(rng.unit());
            for (sum, value) in sum.iter_mut().zip(wavelengths.to_linear_srgb(wavelengths.nm().map(d65))) {
                *sum += square(value) / 4000.0;
            }
        }
        sum.map(f64::sqrt)
    };
    let (ours, even) = (noise(HeroWavelengths::sample), noise(HeroWavelengths::even));
    println!("noise of white: {ours:?}, evenly sampled: {even:?}");
    assert!((0..3).all(|i| ours[i] < 0.25 * even[i]), "{ours:?} {even:?}");
}

/// The colour of a reflectance under D65, by steps of a tenth of a nanometre; `aside` plants a defect.
fn under_d65(reflectance: impl Fn(f64) -> f64, aside: f64) -> [f64; 3] {
    let (mut sum, mut white) = ([0.0; 3], [0.0; 3]);
    for i in 0..4700 {
        let nm = VISIBLE_NM[0] + 0.1 * (f64::from(i) + 0.5);
        let rgb = xyz_to_linear_srgb(color_matching(nm));
        for channel in 0..3 {
            sum[channel] += rgb[channel] * d65(nm) * reflectance(nm + aside);
            white[channel] += rgb[channel] * d65(nm);
        }
    }
    std::array::from_fn(|channel| sum[channel] / white[channel])
}

/// The colours of a lattice over the cube, and some on its edges and near its corners.
fn colors(steps: u32) -> impl Iterator<Item = [f64; 3]> {
    let lattice = (0..steps * steps * steps)
        .map(move |i| [i % steps, i / steps % steps, i / (steps * steps)].map(|k| f64::from(k) / f64::from(steps - 1)));
    let mut rng = TestRng::new(77);
    let edges = (0..100).map(move |_| [(); 3].map(|()| *rng.pick(&[0.0, 0.001, 0.02, 0.5, 0.98, 0.999, 1.0])));
    lattice.chain(edges)
}

#[test]
fn colours_come_back_from_smooth_spectra() {
    let (mut worst, mut at) = (0.0, [0.0; 3]);
    for color in colors(6) {
        let smooth = SmoothReflectance::new(Rgb::from(color.map(|c| c as f32)));
        let error = differs(under_d65(|nm| smooth.at(nm), 0.0), color);
        if error > worst {
            (worst, at) = (error, color);
        }
    }
    println!("round trip: {worst:e} at {at:?}");
    assert!(worst < 1e-3, "{worst} at {at:?}");
    // The twin: a spectrum one nanometre aside.
    let orange = [0.8, 0.4, 0.1];
    let smooth = SmoothReflectance::new(Rgb::from(orange.map(|c| c as f32)));
    assert!(differs(under_d65(|nm| smooth.at(nm), 1.0), orange) > 2e-3);
}

#[test]
fn smooth_spectra_are_smooth_and_between_0_and_1() {
    for color in colors(5) {
        let smooth = SmoothReflectance::new(Rgb::from(color.map(|c| c as f32)));
        assert!((3600..8300).all(|i| (0.0..=1.0).contains(&smooth.at(0.1 * f64::from(i)))), "{color:?}");
    }
    // A grey is the same everywhere; the ends are exact.
    for (grey, tolerance) in [(0.0, 0.0), (1.0, 0.0), (0.5, 0.0), (0.18, 1e-7), (0.999, 1e-7)] {
        let smooth = SmoothReflectance::new(Rgb::gray(grey));
        assert!([360.0, 550.0, 830.0].iter().all(|nm| (smooth.at(*nm) - f64::from(grey)).abs() <= tolerance), "{grey}");
    }
    // What is out of range counts as the end.
    let odd = SmoothReflectance::new(Rgb::new(f32::NAN, -1.0, 7.0));
    assert_eq!(odd, SmoothReflectance::new(Rgb::new(0.0, 0.0, 1.0)));
    // The spectrum of a moderate colour does not turn quickly.
    let skin = SmoothReflectance::new(Rgb::new(0.5, 0.3, 0.2));
    assert!((360..830).all(|nm| (skin.at(f64::from(nm)) - skin.at(f64::from(nm + 1))).abs() < 0.01));
}

#[test]
fn mixtures_have_their_colour_too() {
    let lattice = SmoothLattice::default();
    let mut rng = TestRng::new(5);
    let random = (0..60).map(|_| [(); 3].map(|()| rng.unit()));
    let mut worst = 0.0_f64;
    for color in random.collect::<Vec<_>>().into_iter().chain(colors(4)) {
        let mixture = lattice.mixture(Rgb::from(color.map(|c| c as f32)));
        worst = worst.max(differs(under_d65(|nm| mixture.at(nm), 0.0), color));
        let shifted = differs(under_d65(|nm| mixture.at(nm + 3.0), 0.0), color);
        let is_colorful = color[0] > color[1] + 0.2;
        assert!(!is_colorful || shifted > 1e-3, "the twin: {color:?} {shifted}");
    }
    println!("round trip of mixtures: {worst:e}");
    assert!(worst < 1e-3, "{worst}");
    assert_eq!(
        lattice.mixture(Rgb::new(f32::NAN, 2.0, -1.0)).at(500.0),
        lattice.mixture(Rgb::new(0.0, 1.0, 0.0)).at(500.0)
    );
}

#[test]
fn light_has_the_colour_it_was_given() {
    for color in [[1.0, 1.0, 1.0], [3.0, 2.0, 0.5], [0.0, 0.0, 40.0], [1e-3, 0.0, 0.0], [0.0; 3]] {
        let light = SmoothEmission::new(Rgb::from(color.map(|c: f64| c as f32)));
        let seen = expectation(1 << 12, HeroWavelengths::sample, |nm| light.at(nm));
        let largest = color.iter().fold(0.0, |a: f64, b| a.max(*b));
        assert!(differs(seen, color) <= 1e-3 * largest, "{color:?}: {seen:?}");
        let brighter = expectation(1 << 12, HeroWavelengths::sample, |nm| light.scaled(1.01).at(nm));
        assert!(differs(brighter, color) > 1e-3 * largest || largest == 0.0, "the twin");
        assert!((360..=830).all(|nm| light.at(f64::from(nm)) <= light.scale() * d65(f64::from(nm))));
    }
}

#[test]
fn daylight_is_the_cies() {
    // CIE 015:2018, table 11.1: D65 relative to 560 nm.
    for (nm, value) in [(360.0, 46.6383), (450.0, 117.008), (560.0, 100.0), (600.0, 90.0062), (780.0, 63.3828)] {
        let ours = 100.0 * d65(nm) / d65(560.0);
        assert!((ours - value).abs() < 6e-4, "{nm} nm: {ours}");
        assert!((100.0 * d65(nm + 1.0) / d65(560.0) - value).abs() > 6e-4, "the twin");
    }
    // Chromaticities of the series: the CIE's D50, D55, D65, D75, at their temperatures by the second radiation constant of 1990.
    for (kelvin, xy) in
        [(5003.0, [0.3457, 0.3585]), (5503.0, [0.3324, 0.3474]), (6504.0, [0.3127, 0.3290]), (7504.0, [0.2990, 0.3149])]
    {
        let [x, y, z] = spectrum_to_xyz(|nm| Daylight::new(kelvin).radiance(nm));
        let ours = [x / (x + y + z), y / (x + y + z)];
        assert!((ours[0] - xy[0]).abs() < 2e-4 && (ours[1] - xy[1]).abs() < 2e-4, "{kelvin} K: {ours:?}");
        assert!((y - 1.0).abs() < 1e-5);
    }
    assert_eq!(Daylight::new(f64::NAN), Daylight::new(4000.0));
    assert_eq!(d65(1000.0), d65(830.0));
    assert_eq!(d65(f64::NAN), d65(360.0));
}

#[test]
fn spectra_of_all_kinds() {
    let measured = MeasuredSpectrum::new(vec![400.0, 600.0], vec![0.2, 0.8]).unwrap();
    assert_eq!(measured.range_nm(), [400.0, 600.0]);
    let leaf = SmoothReflectance::new(Rgb::new(0.1, 0.3, 0.1));
    let kinds = [
        Spectrum::Constant(0.7),
        Spectrum::Reflectance(leaf),
        Spectrum::Emission(SmoothEmission::new(Rgb::new(1.0, 2.0, 3.0))),
        Spectrum::blackbody(3000.0),
        Spectrum::Daylight(Daylight::new(5000.0), 2.0),
        Spectrum::Measured(measured, 1.0),
    ];
    for spectrum in kinds {
        let twice = spectrum.clone().scaled(2.0);
        for nm in [400.0, 500.0, 600.0, 702.0] {
            let (one, two) = (spectrum.at(nm), twice.at(nm));
            assert!((two - 2.0 * one).abs() < 1e-2 * one, "{spectrum:?} at {nm}");
            assert!(one > 0.0);
        }
        let wavelengths = HeroWavelengths::sample(0.1);
        assert_eq!(spectrum.at_each(&wavelengths), wavelengths.nm().map(|nm| spectrum.at(nm)));
    }
    let lamp = Spectrum::blackbody(2856.0);
    assert!((spectrum_to_xyz(|nm| lamp.at(nm))[1] - 1.0).abs() < 1e-12);
    assert_eq!(Spectrum::blackbody(f64::NAN), Spectrum::blackbody(500.0));
}

#[test]
fn numbers_that_are_no_spectrum_are_told() {
    let new = |nm: &[f64], values: &[f64]| MeasuredSpectrum::new(nm.to_vec(), values.to_vec());
    assert_eq!(new(&[], &[]), Err(MeasuredSpectrumError::Count { wavelengths: 0, values: 0 }));
    assert_eq!(new(&[1.0, 1.0], &[0.0, 0.0]), Err(MeasuredSpectrumError::Order { index: 1 }));
    assert_eq!(new(&[f64::NAN], &[0.0]), Err(MeasuredSpectrumError::Order { index: 0 }));
    assert_eq!(new(&[1.0], &[f64::INFINITY]), Err(MeasuredSpectrumError::Value { index: 0 }));
    let told = new(&[2.0, 1.0], &[0.0, 0.0]).unwrap_err().to_string();
    assert_eq!(told, "wavelength 2 of the spectrum is not above the one before");
    assert_eq!(new(&[500.0], &[0.4]).unwrap().at(f64::NAN), 0.4);
}
