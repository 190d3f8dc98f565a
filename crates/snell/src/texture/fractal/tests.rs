//! The kinds of noise: their ranges, means and shapes, and that octaves do not show a lattice.

use snell_math::Point3;

use super::*;

fn field(seed: u32, count: u32) -> Vec<Octave> {
    octaves(seed, count).collect()
}

/// Mean, standard deviation and the part that is cut off, over a volume.
fn statistics(kind: NoiseKind, count: u32) -> (f64, f64, f64) {
    let (field, number) = (field(5, count), 40_000_u32);
    let (mut sum, mut squares, mut cut) = (0.0, 0.0, 0.0);
    for i in 1..=number {
        let coordinates = [0.819_172_513_396_164_4, 0.671_043_606_703_789_2, 0.549_700_477_901_970_3];
        let value = value(kind, &field, Point3::from(coordinates.map(|step| (f64::from(i) * step).fract() * 300.0)));
        assert!((0.0..=1.0).contains(&value));
        sum += value;
        squares += value * value;
        cut += f64::from(u8::from(value == 0.0 || value == 1.0));
    }
    let mean = sum / f64::from(number);
    (mean, (squares / f64::from(number) - mean * mean).sqrt(), cut / f64::from(number))
}

#[test]
fn ranges_means_and_deviations_are_as_documented() {
    for (kind, count, mean, deviation) in [
        (NoiseKind::Smooth, 1, 0.5, 0.133),
        (NoiseKind::Smooth, 8, 0.5, 0.154),
        (NoiseKind::Turbulence, 1, 0.215, 0.157),
        (NoiseKind::Turbulence, 8, 0.44, 0.18),
        (NoiseKind::Marble, 6, 0.5, 0.354),
        (NoiseKind::Wood, 6, 0.5, 0.354),
    ] {
        let (found_mean, found_deviation, cut) = statistics(kind, count);
        assert!((found_mean - mean).abs() < 0.007, "{kind:?} {count}: mean {found_mean}");
        assert!((found_deviation - deviation).abs() < 0.007, "{kind:?} {count}: deviation {found_deviation}");
        assert!(cut < 0.004, "{kind:?} {count}: {cut} is cut off");
    }
}

#[test]
fn whole_numbers_are_no_zeros_of_the_sum() {
    let field = field(1, 6);
    let zeros = (-500..500).filter(|x| (sum(&field, Point3::new(f64::from(*x), 0.0, 3.0))).abs() < 1e-3).count();
    assert!(zeros < 20, "{zeros} of 1000");
    // The twin: without offsets all octaves vanish on the lattice.
    let aligned: Vec<Octave> = field.iter().map(|octave| Octave { offset: Vector3::ZERO, ..*octave }).collect();
    assert!((-500..500).all(|x| sum(&aligned, Point3::new(f64::from(x), 0.0, 3.0)) == 0.0));
}

#[test]
fn octaves_double_and_halve_and_differ() {
    let field = field(9, MAX_OCTAVES);
    for (i, octave) in field.iter().enumerate() {
        assert_eq!(octave.frequency, f64::from(1 << i));
        assert_eq!(octave.strength * octave.frequency, 1.0);
        assert!(octave.offset.to_array().iter().all(|c| (0.0..1.0).contains(c)));
        assert!(field[..i].iter().all(|other| other.seed != octave.seed && other.offset != octave.offset));
    }
    assert_eq!(field, octaves(9, MAX_OCTAVES).collect::<Vec<_>>());
    assert_ne!(field[0], octaves(10, 1).next().unwrap());
}

#[test]
fn without_disturbance_marble_has_stripes_and_wood_has_rings() {
    for i in -40..40 {
        let x = f64::from(i) * 0.13;
        let marble = value(NoiseKind::Marble, &[], Point3::new(x, 3.3, -8.0));
        assert!((marble - (0.5 + 0.5 * portable::sin(TAU * x))).abs() < 1e-12);
        let wood = value(NoiseKind::Wood, &[], Point3::new(0.6 * x, f64::from(i), -0.8 * x));
        assert!((wood - (0.5 - 0.5 * portable::cos(TAU * x))).abs() < 1e-12);
    }
    assert_eq!(value(NoiseKind::Wood, &[], Point3::ORIGIN), 0.0);
}

#[test]
fn broken_points_give_numbers_in_range() {
    let field = field(1, MAX_OCTAVES);
    for kind in [NoiseKind::Smooth, NoiseKind::Turbulence, NoiseKind::Marble, NoiseKind::Wood] {
        for c in [f64::NAN, f64::INFINITY, -f64::INFINITY, 1.7e308, -1.7e308, 1e200, 5e-324, 1e15] {
            for point in [Point3::new(c, 0.0, 0.0), Point3::new(0.1, c, c), Point3::new(c, c, -c)] {
                let value = value(kind, &field, point);
                assert!((0.0..=1.0).contains(&value), "{kind:?} at {point:?}: {value}");
            }
        }
    }
}
