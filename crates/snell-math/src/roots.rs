//! Real roots of polynomials of low degree, and of any function between brackets.
//!
//! Roots are isolated by the critical points: between two neighbouring ones a polynomial is monotone, so it has one root
//! there where its sign changes and none where it does not. Each is then found by Newton's method inside a bracket that
//! bisection guards. Yuksel, "High-Performance Polynomial Root Finding for Graphics", HPG 2022. Nothing here can miss a
//! root that changes the sign, diverge or loop: the closed forms of Cardano and Ferrari do all three near multiple roots.
//!
//! All numbers are in the caller's units; coefficients are listed from the constant term up.

use std::ops::Deref;

/// The highest degree that [`in_interval`] takes.
pub const MAX_DEGREE: usize = 4;

/// Some real roots, in increasing order: a slice that lives on the stack.
#[derive(Clone, Copy, Debug, PartialEq, Default)]
pub struct Roots {
    values: [f64; MAX_DEGREE],
    len: usize,
}

impl Roots {
    fn push(&mut self, root: f64) {
        if let Some(slot) = self.values.get_mut(self.len) {
            *slot = root;
            self.len += 1;
        }
    }
}

impl Deref for Roots {
    type Target = [f64];
    #[inline]
    fn deref(&self) -> &[f64] {
        &self.values[..self.len]
    }
}

impl IntoIterator for Roots {
    type Item = f64;
    type IntoIter = std::iter::Take<std::array::IntoIter<f64, MAX_DEGREE>>;
    #[inline]
    fn into_iter(self) -> Self::IntoIter {
        self.values.into_iter().take(self.len)
    }
}

impl FromIterator<f64> for Roots {
    /// The first [`MAX_DEGREE`] of them.
    fn from_iter<I: IntoIterator<Item = f64>>(roots: I) -> Self {
        let mut all = Self::default();
        roots.into_iter().take(MAX_DEGREE).for_each(|root| all.push(root));
        all
    }
}

/// The real roots of `a x² + b x + c`, in increasing order, without cancellation; of `b x + c` where `a` is 0. A double
/// root is given once. Nothing where all coefficients are 0 or one is not finite.
///
/// The larger root in absolute value comes first from −(b ± √…)/2a with the sign that adds up, the other from their
/// product c/a (Press et al., Numerical Recipes, section 5.6).
///
/// ```
/// use snell_math::roots;
/// assert_eq!(*roots::quadratic(1.0, -1e9, 1.0), [1e-9, 1e9]);
/// assert!(roots::quadratic(1.0, 0.0, 1.0).is_empty());
/// ```
pub fn quadratic(a: f64, b: f64, c: f64) -> Roots {
    if a == 0.0 {
        let root = -c / b;
        return root.is_finite().then_some(root).into_iter().collect();
    }
    let half_b = 0.5 * b;
    let discriminant = difference_of_products(half_b, half_b, a, c);
    if discriminant.is_nan() || discriminant < 0.0 {
        return Roots::default();
    }
    let q = -(half_b + discriminant.sqrt().copysign(half_b));
    if discriminant == 0.0 || q == 0.0 {
        let root = -half_b / a;
        return root.is_finite().then_some(root).into_iter().collect();
    }
    let (first, second) = (q / a, c / q);
    let ordered = if first < second { [first, second] } else { [second, first] };
    ordered.into_iter().filter(|root| root.is_finite()).collect()
}

/// `a b − c d` to within two units in the last place, also where the products nearly cancel: their rounding errors are
/// found exactly (Dekker, Numerische Mathematik 18, 1971) and put back. Plain arithmetic where that would overflow.
fn difference_of_products(a: f64, b: f64, c: f64, d: f64) -> f64 {
    let (left, right) = (a * b, c * d);
    let plain = left - right;
    let corrected = plain + (product_error(a, b, left) - product_error(c, d, right));
    if corrected.is_finite() { corrected } else { plain }
}

/// `a b − product`, exactly, for `product` the rounded product: each factor is split into halves of 26 bits.
fn product_error(a: f64, b: f64, product: f64) -> f64 {
    const SPLITTER: f64 = 134_217_729.0; // 2²⁷ + 1
    let split = |x: f64| {
        let scaled = SPLITTER * x;
        let high = scaled - (scaled - x);
        (high, x - high)
    };
    let ((a_high, a_low), (b_high, b_low)) = (split(a), split(b));
    ((a_high * b_high - product) + a_high * b_low + a_low * b_high) + a_low * b_low
}

/// The value and the derivative of a polynomial, coefficients from the constant term up, by Horner's rule.
#[inline]
fn evaluate(coefficients: &[f64], x: f64) -> (f64, f64) {
    coefficients.iter().rev().fold((0.0, 0.0), |(value, slope), &c| (value * x + c, slope * x + value))
}

/// The roots in `[low, high]` of a polynomial of degree [`MAX_DEGREE`] at most, coefficients from the constant term up,
/// in increasing order. Leading coefficients may be 0. A root where the sign does not change, a touch, is given only
/// where rounding happens to show it. Higher degrees and coefficients or bounds that are not numbers give nothing.
///
/// ```
/// use snell_math::roots;
/// // (x − 1)(x − 2)(x − 3)(x − 4)
/// let found = roots::in_interval(&[24.0, -50.0, 35.0, -10.0, 1.0], 1.5, 10.0);
/// assert_eq!(found.len(), 3);
/// assert!((found[2] - 4.0).abs() < 1e-14);
/// ```
pub fn in_interval(coefficients: &[f64], low: f64, high: f64) -> Roots {
    let inside = |roots: Roots| roots.into_iter().filter(|root| (low..=high).contains(root)).collect();
    match *coefficients {
        [c, b] => inside(quadratic(0.0, b, c)),
        [c, b, a] => inside(quadratic(a, b, c)),
        _ if low <= high && (4..=MAX_DEGREE + 1).contains(&coefficients.len()) => {
            let mut derivative = [0.0; MAX_DEGREE];
            let mut power = 0.0;
            for (slot, &coefficient) in derivative.iter_mut().zip(&coefficients[1..]) {
                power += 1.0;
                *slot = power * coefficient;
            }
            let critical = in_interval(&derivative[..coefficients.len() - 1], low, high);
            sign_changes(low, critical, high, |x| evaluate(coefficients, x)).collect()
        }
        _ => Roots::default(),
    }
}

/// Finds, one by one and in increasing order, where a function changes its sign between `low`, the increasing `critical`
/// points and `high`. `function` gives its value and its derivative; it has to be monotone between the points for all
/// roots to be found. Zero counts as not positive.
pub fn sign_changes(
    low: f64,
    critical: impl IntoIterator<Item = f64>,
    high: f64,
    function: impl Fn(f64) -> (f64, f64),
) -> impl Iterator<Item = f64> {
    let mut start = low;
    let mut start_positive = function(low).0 > 0.0;
    let mut points = critical.into_iter().chain(std::iter::once(high));
    std::iter::from_fn(move || {
        for end in points.by_ref() {
            let (from, from_positive) = (start, start_positive);
            (start, start_positive) = (end, function(end).0 > 0.0);
            if from_positive != start_positive {
                return Some(refine(from, end, from_positive, &function));
            }
        }
        None
    })
}

/// The root between `low` and `high`, where the function's sign differs, to about one unit in the last place of the
/// larger bound. Newton's step is taken where it stays inside the bracket and is at most half of the step before;
/// bisection otherwise. So every turn halves the step or the bracket, and a hundred always suffice.
fn refine(low: f64, high: f64, low_positive: bool, function: impl Fn(f64) -> (f64, f64)) -> f64 {
    let tolerance = f64::EPSILON * low.abs().max(high.abs());
    let (mut low, mut high) = (low, high);
    let mut x = 0.5 * (low + high);
    let mut last_step = high - low;
    for _ in 0..128 {
        let (value, slope) = function(x);
        if value == 0.0 {
            break;
        }
        if (value > 0.0) == low_positive {
            low = x;
        } else {
            high = x;
        }
        let newton = value / slope;
        let next = x - newton;
        let (next, step) = if next > low && next < high && newton.abs() <= 0.5 * last_step {
            (next, newton.abs())
        } else {
            (0.5 * (low + high), 0.5 * (high - low))
        };
        x = next;
        last_step = step;
        if step <= tolerance {
            break;
        }
    }
    x
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    /// The coefficients of the product of (x − root).
    fn from_roots(roots: &[f64]) -> Vec<f64> {
        roots.iter().fold(vec![1.0], |polynomial, root| {
            let mut product = vec![0.0; polynomial.len() + 1];
            for (i, c) in polynomial.iter().enumerate() {
                product[i + 1] += c;
                product[i] -= root * c;
            }
            product
        })
    }

    proptest! {
        #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::default() })]
        #[test]
        fn separate_roots_are_all_found(mut roots in prop::collection::vec(-10.0..10.0f64, 1..5), scale in -3..4i32) {
            roots.sort_by(f64::total_cmp);
            prop_assume!(roots.windows(2).all(|pair| pair[1] - pair[0] > 1e-2));
            let unit = (0..scale.abs()).fold(1.0, |p, _| p * if scale < 0 { 0.1 } else { 10.0 });
            let roots: Vec<f64> = roots.iter().map(|root| root * unit).collect();
            let found = in_interval(&from_roots(&roots), -11.0 * unit, 11.0 * unit);
            prop_assert_eq!(found.len(), roots.len());
            for (found, root) in found.iter().zip(&roots) {
                prop_assert!((found - root).abs() < 1e-6 * unit, "{} for {}", found, root);
            }
        }

        #[test]
        fn close_pairs_change_the_sign_twice(middle in -5.0..5.0f64, other in 6.0..9.0f64, gap in 1e-5..1e-2f64) {
            let found = in_interval(&from_roots(&[-8.0, middle - gap, middle + gap, other]), -20.0, 20.0);
            prop_assert_eq!(found.len(), 4);
            prop_assert!((found[1] - middle + gap).abs() < 1e-2 * gap);
        }

        #[test]
        fn quadratics_have_small_backward_error(a in -1e3..1e3f64, b in -1e3..1e3f64, c in -1e3..1e3f64) {
            for root in quadratic(a, b, c) {
                let size = (a * root * root).abs() + (b * root).abs() + c.abs();
                prop_assert!((a * root * root + b * root + c).abs() <= 1e-15 * size);
            }
        }
    }

    #[test]
    fn nearly_equal_roots_of_a_quadratic_keep_their_distance() {
        // (x − 1)(x − (1 + 2⁻²⁶)) has a rounded discriminant of 0 where the products are rounded first.
        let gap = 1.0 / 67_108_864.0;
        let found = quadratic(1.0, -(2.0 + gap), 1.0 + gap);
        assert_eq!(found.len(), 2);
        assert!(((found[1] - found[0]) / gap - 1.0).abs() < 1e-7);
        // The twin: without the correction the distance is lost.
        let plain: f64 = (2.0 + gap) * (2.0 + gap) - 4.0 * (1.0 + gap);
        assert!((plain.max(0.0).sqrt() / gap - 1.0).abs() > 1e-3);
    }

    #[test]
    fn degenerate_polynomials_give_nothing_or_their_lower_degree() {
        assert!(quadratic(0.0, 0.0, 1.0).is_empty());
        assert!(quadratic(0.0, 0.0, 0.0).is_empty());
        assert!(quadratic(f64::NAN, 1.0, 0.0).is_empty());
        assert_eq!(*quadratic(0.0, 2.0, -1.0), [0.5]);
        assert_eq!(*quadratic(1.0, -2.0, 1.0), [1.0]);
        assert_eq!(*quadratic(1.0, 0.0, 0.0), [0.0]);
        assert_eq!(in_interval(&[-1.0, 2.0, 0.0, 0.0, 0.0], 0.0, 1.0).len(), 1);
        assert!(in_interval(&[1.0, f64::NAN, 0.0, 1.0], -1.0, 1.0).len() <= MAX_DEGREE);
        assert!(in_interval(&[0.0, 0.0, 0.0, 1.0], f64::NAN, 1.0).is_empty());
        assert!(in_interval(&[1.0; 9], -1.0, 1.0).is_empty());
        assert!(in_interval(&[], -1.0, 1.0).is_empty());
        // A triple root is found by bisection where Newton creeps.
        let triple = in_interval(&from_roots(&[1.0, 1.0, 1.0]), -4.0, 3.0);
        assert!(!triple.is_empty() && triple.iter().all(|root| (root - 1.0).abs() < 1e-4));
    }
}
