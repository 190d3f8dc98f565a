//! The tail of the chi-square distribution: the regularised upper incomplete gamma function Q(k / 2, x).
//!
//! Follows: NIST Digital Library of Mathematical Functions, <https://dlmf.nist.gov>, 8.11.4 (the power series of the lower
//! function, for x < a + 1) and 8.9.2 (the continued fraction of the upper one, evaluated by Lentz's method).

use snell_math::portable;

/// Terms of either expansion; far more than the sizes of tests need.
const MOST_TERMS: u32 = 100_000;

/// Q(`degrees` / 2, `x`), to about twelve digits: 1 at x = 0, falling to 0.
pub(super) fn upper(degrees: u32, x: f64) -> f64 {
    let a = 0.5 * f64::from(degrees);
    if x <= 0.0 {
        return 1.0;
    }
    if !x.is_finite() {
        return 0.0;
    }
    let scale = portable::exp(a * portable::ln(x) - x - ln_gamma_half(degrees));
    if x < a + 1.0 {
        let (mut term, mut sum, mut denominator) = (1.0 / a, 1.0 / a, a);
        for _ in 0..MOST_TERMS {
            denominator += 1.0;
            term *= x / denominator;
            sum += term;
            if term < sum * 1e-16 {
                break;
            }
        }
        return (1.0 - sum * scale).clamp(0.0, 1.0);
    }
    let mut b = x + 1.0 - a;
    let (mut c, mut d) = (1e300, 1.0 / b);
    let mut fraction = d;
    for i in 1..MOST_TERMS {
        let i = f64::from(i);
        let numerator = -i * (i - a);
        b += 2.0;
        d = 1.0 / (numerator * d + b);
        c = b + numerator / c;
        let change = c * d;
        fraction *= change;
        if (change - 1.0).abs() < 1e-15 {
            break;
        }
    }
    (fraction * scale).clamp(0.0, 1.0)
}

/// ln Γ(k / 2), by the recursion Γ(z + 1) = z Γ(z) from Γ(½) = √π or Γ(1) = 1.
fn ln_gamma_half(k: u32) -> f64 {
    let (mut z, start) = if k.is_multiple_of(2) { (1.0, 0.0) } else { (0.5, 0.5 * portable::ln(std::f64::consts::PI)) };
    let mut sum = start;
    while z < 0.5 * f64::from(k) - 0.25 {
        sum += portable::ln(z);
        z += 1.0;
    }
    sum
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tails_are_those_of_closed_forms() {
        for x in [0.01, 0.5, 1.0, 3.0, 12.0, 40.0] {
            // Two degrees: e^−x. Four: (1 + x) e^−x. Six: (1 + x + x²/2) e^−x.
            let e = portable::exp(-x);
            for (degrees, expected) in [(2, e), (4, (1.0 + x) * e), (6, (1.0 + x + 0.5 * x * x) * e)] {
                let ours = upper(degrees, x);
                assert!((ours - expected).abs() < 1e-12 * expected.max(1e-3), "{degrees} {x}: {ours} {expected}");
                // The twin: one degree more has a longer tail.
                assert!(upper(degrees + 1, x) > ours);
            }
        }
        // One degree: the chance of more than 1.96 standard deviations is a twentieth.
        assert!((upper(1, 0.5 * 1.959_963_985 * 1.959_963_985) - 0.05).abs() < 1e-9);
        assert_eq!((upper(5, 0.0), upper(5, f64::INFINITY)), (1.0, 0.0));
        // Many degrees: the median is near k (1 − 2/(9k))³.
        let k: f64 = 5000.0;
        let root = 1.0 - 2.0 / (9.0 * k);
        assert!((upper(5000, 0.5 * k * root * root * root) - 0.5).abs() < 1e-4);
    }
}
