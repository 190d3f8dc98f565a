//! Where samples lie: fixed points in a pixel, and random numbers that are a function of what they are for.
//!
//! Nothing here has a state. The place of a pixel's sample depends on its index alone, and a random number on (seed,
//! pixel, sample, dimension) alone, so a picture does not depend on threads, tiles or the number of samples, and the
//! first N samples of a longer rendering are those of a shorter one.
//!
//! Follows: Sobol', "On the distribution of points in a cube", 1967 (the first two dimensions are a (0,2)-sequence in
//! base 2, see Niederreiter 1992, definition 4.2); Burley, "Practical Hash-based Owen Scrambling", JCGT 9(4), 2020; the
//! permutation is Vegdahl's of the Laine–Karras kind; O'Neill, "PCG", 2014, as a hash after Jarzynski and Olano, "Hash
//! Functions for GPU Rendering", JCGT 9(3), 2020.

/// The place in its pixel of sample `index`: two numbers in [0, 1), u to the right and v down; (½, ½) is the pixel's
/// centre.
///
/// These are the points of Sobol's sequence in two dimensions after a fixed Owen scrambling and a digital shift that
/// puts sample 0 into the centre. Both keep the sequence a (0,2)-sequence: of 2ᵏ consecutive points that start at a
/// multiple of 2ᵏ, exactly one is in each of the 2ᵏ equal boxes of every shape 2⁻ᵃ × 2⁻ᵇ, a + b = k. The scrambling was
/// chosen among many for the first 4 to 64 points to be far apart (also from those of the neighbouring pixels) and to
/// balance about the centre.
///
/// ```
/// use snell_math::sampling::pixel_sample;
/// assert_eq!(pixel_sample(0), [0.5, 0.5]);
/// ```
#[inline]
#[must_use]
pub fn pixel_sample(index: u32) -> [f64; 2] {
    const SCRAMBLE: [u32; 2] = [0xfdc7_8b1d, 0x1dae_0d79];
    const CENTRE: u32 = 1 << 31;
    // Sample 0 of the sequence before scrambling is (0, 0): this exclusive-or takes where it went to the centre.
    const SHIFT: [u32; 2] = [nested_permutation(0, SCRAMBLE[0]) ^ CENTRE, nested_permutation(0, SCRAMBLE[1]) ^ CENTRE];
    let [u, v] = sobol(index);
    [
        to_unit_f64(nested_permutation(u, SCRAMBLE[0]) ^ SHIFT[0]),
        to_unit_f64(nested_permutation(v, SCRAMBLE[1]) ^ SHIFT[1]),
    ]
}

/// Point `index` of Sobol's sequence in two dimensions, in units of 2⁻³².
#[inline]
fn sobol(index: u32) -> [u32; 2] {
    // The second dimension's direction numbers belong to the polynomial x + 1: each is the one before, plus it shifted
    // by one.
    let (mut second, mut direction, mut remaining) = (0, 1 << 31, index);
    while remaining != 0 {
        if remaining & 1 == 1 {
            second ^= direction;
        }
        direction ^= direction >> 1;
        remaining >>= 1;
    }
    [index.reverse_bits(), second]
}

/// Owen's nested scrambling of a binary fraction: each digit is flipped or not as the digits above it say.
#[inline]
pub(crate) const fn nested_permutation(fraction: u32, seed: u32) -> u32 {
    // In reversed order each operation carries from a digit only to those after it.
    let mut x = fraction.reverse_bits();
    x ^= x.wrapping_mul(0x3d20_adea);
    x = x.wrapping_add(seed);
    x = x.wrapping_mul((seed >> 16) | 1);
    x ^= x.wrapping_mul(0x0552_6c56);
    x ^= x.wrapping_mul(0x53a2_2864);
    x.reverse_bits()
}

/// Thirty-two random bits for one purpose: the `dimension`-th number of a sample of a pixel under a seed.
///
/// For one seed, different (x, y, sample, dimension) have different 64-bit states, of which the upper half is given.
///
/// ```
/// use snell_math::sampling::{hash, to_unit_f64};
/// let number = to_unit_f64(hash(0, 320, 240, 7, 2));
/// assert!((0.0..1.0).contains(&number));
/// ```
#[inline]
#[must_use]
pub const fn hash(seed: u32, x: u32, y: u32, sample: u32, dimension: u32) -> u32 {
    let pixel = permutation(permutation(seed as u64) ^ pair(x, y));
    (permutation(pixel ^ pair(sample, dimension)) >> 32) as u32
}

#[inline]
const fn pair(high: u32, low: u32) -> u64 {
    ((high as u64) << 32) | low as u64
}

/// A permutation of 64-bit words: one step and the output function (RXS-M-XS) of PCG.
#[inline]
const fn permutation(word: u64) -> u64 {
    let state = word.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
    let word = ((state >> ((state >> 59) + 5)) ^ state).wrapping_mul(12_605_985_483_714_917_081);
    (word >> 43) ^ word
}

/// Thirty-two bits as a number in [0, 1): the multiples of 2⁻³², exactly.
#[inline]
#[must_use]
pub const fn to_unit_f64(bits: u32) -> f64 {
    bits as f64 * (1.0 / 4_294_967_296.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// True where, for every k up to `max_k`, each of the first blocks of 2ᵏ points is a (0,k,2)-net.
    fn is_net_sequence(point: impl Fn(u32) -> [f64; 2], max_k: u32) -> bool {
        (0..=max_k).all(|k| {
            let count = 1_u32 << k;
            (0..3).all(|block| {
                (0..=k).all(|a| {
                    let (columns, rows) = (1_u32 << a, 1_u32 << (k - a));
                    let mut seen = vec![false; count as usize];
                    (block * count..(block + 1) * count).all(|index| {
                        let [u, v] = point(index);
                        let cell = (u * f64::from(columns)) as u32 + columns * (v * f64::from(rows)) as u32;
                        !std::mem::replace(&mut seen[cell as usize], true)
                    })
                })
            })
        })
    }

    #[test]
    fn every_prefix_is_a_net() {
        assert!(is_net_sequence(pixel_sample, 10));
        assert!(is_net_sequence(|i| sobol(i).map(to_unit_f64), 10));
    }

    #[test]
    fn broken_generators_are_no_nets() {
        // A wrong direction number, a shift that is not digital, and random points.
        let wrong_direction = |i: u32| [to_unit_f64(i.reverse_bits()), to_unit_f64(i.reverse_bits() >> 1)];
        let shifted = |i| pixel_sample(i).map(|c| (c + 0.3).fract());
        let random = |i| [to_unit_f64(hash(0, 0, 0, i, 0)), to_unit_f64(hash(0, 0, 0, i, 1))];
        assert!(!is_net_sequence(wrong_direction, 5));
        assert!(!is_net_sequence(shifted, 5));
        assert!(!is_net_sequence(random, 5));
    }

    #[test]
    fn sample_zero_is_the_centre_and_all_are_inside() {
        assert_eq!(pixel_sample(0), [0.5, 0.5]);
        for index in (0..4096).chain([u32::MAX, 1 << 31]) {
            assert!(pixel_sample(index).iter().all(|c| (0.0..1.0).contains(c)));
        }
    }

    #[test]
    fn small_sets_are_balanced_and_far_apart() {
        for (count, most_offset) in [(4_u32, 0.03), (8, 0.015), (16, 0.008), (32, 0.008), (64, 0.008)] {
            let points: Vec<_> = (0..count).map(pixel_sample).collect();
            for axis in 0..2 {
                let mean = points.iter().map(|p| p[axis]).sum::<f64>() / f64::from(count);
                assert!((mean - 0.5).abs() < most_offset, "the mean of {count} is {mean}");
            }
            let wrapped = |a: f64, b: f64| (a - b).abs().min(1.0 - (a - b).abs());
            for (i, p) in points.iter().enumerate() {
                for q in &points[..i] {
                    let (du, dv) = (wrapped(p[0], q[0]), wrapped(p[1], q[1]));
                    assert!((du * du + dv * dv).sqrt() > 0.45 / f64::from(count).sqrt(), "{count}: {p:?} {q:?}");
                }
            }
        }
    }

    /// The largest deviation from one half of the chance that an output bit flips with an input bit.
    fn avalanche_error(hash: impl Fn([u32; 5]) -> u32) -> f64 {
        const TRIALS: u32 = 2000;
        let mut worst = 0.0_f64;
        for input in 0..5 {
            for bit in 0..16 {
                let mut flips = [0_u32; 32];
                for trial in 0..TRIALS {
                    // Small coordinates, as they occur.
                    let mut key = [trial % 3, trial % 97, trial % 89, trial / 7, trial % 11];
                    let before = hash(key);
                    key[input] ^= 1 << bit;
                    let changed = before ^ hash(key);
                    for (output, count) in flips.iter_mut().enumerate() {
                        *count += (changed >> output) & 1;
                    }
                }
                let error = flips.iter().map(|n| (f64::from(*n) / f64::from(TRIALS) - 0.5).abs()).fold(0.0, f64::max);
                worst = worst.max(error);
            }
        }
        worst
    }

    #[test]
    fn hash_mixes_every_input_bit_into_every_output_bit() {
        // The deviation's standard error is 0.011, and the worst of 2560 is looked at.
        assert!(avalanche_error(|[s, x, y, i, d]| hash(s, x, y, i, d)) < 0.06);
        // Twins: a weak mix, and a hash that forgets the dimension.
        let weak = |[s, x, y, i, d]: [u32; 5]| (s ^ x ^ (y << 8) ^ (i << 16) ^ (d << 24)).wrapping_mul(0x9e37_79b9);
        assert!(avalanche_error(weak) > 0.4);
        assert!(avalanche_error(|[s, x, y, i, _]| hash(s, x, y, i, 0)) > 0.4);
    }

    #[test]
    fn hash_is_uniform_over_an_image() {
        let mut cells = [0_u32; 256];
        for y in 0..256 {
            for x in 0..256 {
                cells[(to_unit_f64(hash(1, x, y, 0, 0)) * 256.0) as usize] += 1;
            }
        }
        // χ² with 255 degrees of freedom: mean 255, standard deviation 22.6.
        let chi_squared: f64 = cells.iter().map(|n| (f64::from(*n) - 256.0) * (f64::from(*n) - 256.0) / 256.0).sum();
        assert!((150.0..370.0).contains(&chi_squared), "{chi_squared}");
    }

    #[test]
    fn values_never_change() {
        // Computed by a second implementation, in Python.
        assert_eq!(hash(0, 0, 0, 0, 0), 392_534_395);
        assert_eq!(hash(1, 2, 3, 4, 5), 3_819_305_943);
        let bits = |index| pixel_sample(index).map(|c| (c * 4_294_967_296.0) as u32);
        assert_eq!(bits(1), [0x2cc5_6e4a, 0x3c1b_4120]);
        assert_eq!(bits(1_000_003), [0x6733_41a2, 0x230c_ca61]);
        assert_eq!(to_unit_f64(u32::MAX), 1.0 - 1.0 / 4_294_967_296.0);
    }
}
