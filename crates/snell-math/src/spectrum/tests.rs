//! Spectra against an independent implementation's colours (colour-science), and against closed forms.

use super::*;
use crate::dispersion::fraunhofer;

/// What our code gives for a row of the reference table: (X, Y, Z), where the row's spectrum has a formula. The
/// spectrum is read `aside` nanometres beside where it should be: 0, or else a planted defect.
fn tristimulus(name: &str, aside: f64) -> Option<[f64; 3]> {
    let scaled = |xyz: [f64; 3]| xyz.map(|value| value / xyz[1]);
    if let Some(kelvin) = name.strip_prefix("blackbody ") {
        // The table was made with the second radiation constant of 1990, 14388 µm K, not with that of the SI of 2019.
        let kelvin: f64 = kelvin.trim_end_matches('K').parse::<f64>().unwrap() * (14_387.768_775 / 14_388.0);
        Some(scaled(spectrum_to_xyz(|nm| blackbody(kelvin, nm + aside))))
    } else if let Some(rest) = name.strip_prefix("monochromatic ") {
        Some(color_matching(rest.split(' ').next().unwrap().parse::<f64>().unwrap() + aside))
    } else if name == "illuminant E" {
        Some(scaled(spectrum_to_xyz(|_| 1.0)))
    } else if name == "illuminant A" {
        // CIE 015:2018, 4.1: Planck's law at 2848 K with the second radiation constant of 1931.
        let planck = |nm: f64| 1.0 / (nm * nm * nm * nm * nm) / (portable::exp(1.435e7 / (2848.0 * nm)) - 1.0);
        Some(scaled(spectrum_to_xyz(|nm| planck(nm + aside) * 1e13)))
    } else {
        None
    }
}

fn largest_difference(a: [f64; 3], b: [f64; 3]) -> f64 {
    (0..3).map(|i| (a[i] - b[i]).abs()).fold(0.0, f64::max)
}

#[test]
fn colours_of_spectra_agree_with_the_reference_table() {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/../../../shared/reference/colour_spectra_to_rgb.csv");
    let Ok(table) = std::fs::read_to_string(path) else {
        println!("skipped: {path} is absent");
        return;
    };
    let mut checked = 0;
    for line in table.lines().skip(2) {
        // Names hold commas inside quotes; the numbers do not.
        let (name, numbers) = match line.strip_prefix('"') {
            Some(rest) => rest.split_once("\",").unwrap(),
            None => line.split_once(',').unwrap(),
        };
        let numbers: Vec<f64> = numbers.split(',').map(|n| n.parse().unwrap()).collect();
        let (expected_xyz, expected_rgb) = ([numbers[2], numbers[3], numbers[4]], [numbers[5], numbers[6], numbers[7]]);
        assert!(largest_difference(xyz_to_linear_srgb(expected_xyz), expected_rgb) < 5e-11, "{name}: the matrix");

        let Some(xyz) = tristimulus(name, 0.0) else { continue };
        // Between the rows of the observer's table a single wavelength is interpolated; sums over many are nearer.
        // Illuminant A's Z there comes from the CIE's rounded table (published: 0.35585).
        let tolerance = match name.split(' ').next().unwrap() {
            "monochromatic" => 2.5e-4,
            "illuminant" => 1e-4,
            _ => 1e-5,
        };
        assert!(largest_difference(xyz, expected_xyz) < tolerance, "{name}: {xyz:?}");
        assert!(largest_difference(xyz_to_linear_srgb(xyz), expected_rgb) < 3.0 * tolerance, "{name}");
        // The twin: the spectrum read half a nanometre aside; equal energy alone is the same there.
        let aside = tristimulus(name, 0.5).unwrap();
        assert!(largest_difference(aside, expected_xyz) > tolerance || name == "illuminant E", "{name}: twin");
        checked += 1;
    }
    assert!(checked >= 18, "only {checked} rows");
}

#[test]
fn the_observer_is_its_table_and_is_never_negative() {
    assert_eq!(color_matching(360.0), [0.0001299, 3.917e-6, 0.0006061]);
    assert_eq!(color_matching(450.0), [0.3362, 0.038, 1.77211]);
    assert_eq!(color_matching(830.0), [1.251141e-6, 4.5181e-7, 0.0]);
    for nanometre in 3000..9000 {
        assert!(color_matching(f64::from(nanometre) * 0.1).iter().all(|value| (0.0..2.0).contains(value)));
    }
    assert_eq!(color_matching(f64::NAN), [0.0; 3]);
}

#[test]
fn daylight_is_white() {
    let white = xyz_to_rgb([0.95047, 1.0, 1.08883]);
    assert!(white.to_array().iter().all(|c| (c - 1.0).abs() < 2e-4), "{white:?}");
}

#[test]
fn a_black_body_follows_wien_and_stefan_boltzmann() {
    // Wien: the peak is at 2.897771955 mm K / T.
    let peak = 2.897_771_955e6 / 5000.0;
    assert!(blackbody(5000.0, peak) > blackbody(5000.0, peak + 0.1));
    assert!(blackbody(5000.0, peak) > blackbody(5000.0, peak - 0.1));
    // Stefan and Boltzmann: the integral over wavelengths is σ T⁴ / π. Midpoints in ln λ, from 100 nm to 1 mm.
    let steps = 4000;
    let width = portable::ln(1e4) / f64::from(steps);
    let total: f64 = (0..steps)
        .map(|i| {
            let nm = 100.0 * portable::exp((f64::from(i) + 0.5) * width);
            blackbody(5000.0, nm) * nm * 1e-9 * width
        })
        .sum();
    let expected = 5.670_374_419e-8 * 5000.0 * 5000.0 * 5000.0 * 5000.0 / std::f64::consts::PI;
    assert!((total / expected - 1.0).abs() < 1e-6, "{total} {expected}");
}

#[test]
fn a_black_body_is_a_number_everywhere() {
    for kelvin in [f64::NAN, -1.0, 0.0, 1e-300, 1.0, 500.0, 1e6, 1e300, f64::INFINITY] {
        for nm in [f64::NAN, -1.0, 0.0, 1e-300, fraunhofer::SODIUM_D, 1e300, f64::INFINITY] {
            assert!(!blackbody(kelvin, nm).is_nan(), "{kelvin} K, {nm} nm");
        }
        assert!(blackbody_rgb(kelvin).is_finite(), "{kelvin} K");
    }
    assert!((blackbody_rgb(6500.0).luminance() - 1.0).abs() < 1e-3);
}

#[test]
fn the_cies_illuminants_have_its_chromaticities() {
    // CIE 015:2018, table T.3, and Planck's locus at 2000 and 6500 K (Wyszecki and Stiles, "Color Science", table 1(3.11)).
    let chromaticity = |spectrum: &Spectrum| {
        let [x, y, z] = spectrum.to_xyz();
        [x / (x + y + z), y / (x + y + z)]
    };
    let near = |spectrum: &Spectrum, expected: [f64; 2]| {
        let found = chromaticity(spectrum);
        (0..2).all(|i| (found[i] - expected[i]).abs() < 2e-4)
    };
    let daylight = |kelvin| Spectrum::Daylight(Daylight::new(kelvin), 1.0);
    for (spectrum, expected) in [
        (Spectrum::illuminant_a(), [0.447_58, 0.407_45]),
        (daylight(5003.0), [0.345_67, 0.358_51]),
        (daylight(5503.0), [0.332_43, 0.347_44]),
        (Spectrum::Daylight(Daylight::D65, 1.0), [0.312_72, 0.329_03]),
        (daylight(7504.0), [0.299_03, 0.314_88]),
        (Spectrum::Constant(1.0), [1.0 / 3.0, 1.0 / 3.0]),
        (Spectrum::blackbody(2000.0), [0.526_69, 0.413_31]),
        (Spectrum::blackbody(6500.0), [0.313_52, 0.323_63]),
    ] {
        assert!(near(&spectrum, expected), "{spectrum:?}: {:?}, not {expected:?}", chromaticity(&spectrum));
        assert!((spectrum.to_xyz()[1] - 1.0).abs() < 1e-3, "{spectrum:?} has the luminance of white");
        assert!(!near(&spectrum, [expected[0] + 5e-4, expected[1]]), "another colour is told apart");
    }
}

#[test]
fn no_line_is_too_narrow_to_be_seen() {
    let line = |nm: f64| MeasuredSpectrum::new(vec![nm - 0.2, nm, nm + 0.2], vec![0.0, 3.0, 0.0]).unwrap();
    for nm in [486.13, 546.5, 589.3] {
        let [x, y, z] = Spectrum::light(line(nm)).unwrap().to_xyz();
        assert!((y - 1.0).abs() < 1e-12);
        let [a, b, c] = color_matching(nm);
        assert!((x / (x + y + z) - a / (a + b + c)).abs() < 1e-3 && (z / (x + y + z) - c / (a + b + c)).abs() < 1e-3);
    }
    assert_eq!(Spectrum::light(line(1200.0)), None);
}
