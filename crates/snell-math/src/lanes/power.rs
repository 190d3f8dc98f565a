//! Powers side by side, as exact as an `f32` needs: the brightness of highlights, and what absorption leaves of light.
//!
//! `x^y = e^(y ln x)`, each function by its series on a small interval: `ln m = 2 artanh((m − 1) / (m + 1))` for m from √½ to √2, e^r for
//! |r| up to ½ ln 2. The result is within a relative 2⁻⁴² of the true one while `y ln x` is above [`SMALLEST`]. Where both ends of
//! that interval round to the same `f32`, so does what [`portable::pow`] gives, which is nearer still to the true one; elsewhere,
//! once in some hundred thousand times, that function is asked itself. So the bits are its bits on every machine. Powers of e alone are
//! had the same way, with those of [`portable::exp`].

use std::f64::consts::{LN_2, LOG2_E, SQRT_2};

use super::{Bits, Floats, Lanes, WIDTH};
use crate::portable;

/// The least logarithm of a result that the error bound holds for; e to its power is far below the smallest `f32`.
const SMALLEST: f64 = -200.0;

/// How far the series may be from [`portable::pow`], relative.
const ERROR: f64 = 1.0 / (1_u64 << 42) as f64;

/// ln 2 in two parts, the first with so few digits that its product with a small whole number is exact.
const LN_2_HIGH: f64 = f64::from_bits(LN_2.to_bits() & !0xffff_ffff);
/// The rest, to twice the digits of an `f64`: the next ones of ln 2 are 0.23 × 10⁻¹⁶.
const LN_2_LOW: f64 = (LN_2 - LN_2_HIGH) + 2.319_046_813_846_299_6e-17;

/// Numbers from 0 to 1 to the power of one number, not negative, rounded to `f32`, in the lanes that are asked for; 0 in the others. The bits
/// are those of `portable::pow(base, exponent) as f32`.
///
/// ```
/// use snell_math::lanes::{Bits, power_to_f32};
/// use snell_math::portable::pow;
///
/// assert_eq!(power_to_f32(0.7, 20.0, Bits::first(1)), pow(0.7, 20.0) as f32);
/// ```
#[inline(always)]
pub fn power_to_f32<L: Lanes>(base: L, exponent: f64, asked: Bits) -> L::Floats {
    let logarithm = natural_logarithm(base) * L::splat(exponent);
    let in_range = base.ge(L::splat(f64::MIN_POSITIVE)) & logarithm.ge(L::splat(SMALLEST));
    rounded(exponential(logarithm), in_range, asked, base, |base| portable::pow(base, exponent))
}

/// e to the power of numbers that are not above 0, rounded to `f32`, in the lanes that are asked for; 0 in the others. The bits are those of
/// `portable::exp(number) as f32`.
///
/// ```
/// use snell_math::lanes::{Bits, exponential_to_f32};
/// use snell_math::portable::exp;
///
/// assert_eq!(exponential_to_f32(-0.7, Bits::first(1)), exp(-0.7) as f32);
/// ```
#[inline(always)]
pub fn exponential_to_f32<L: Lanes>(number: L, asked: Bits) -> L::Floats {
    // What is below the smallest is taken for it: both are 0 as an `f32`.
    rounded(exponential(number), number.le(L::splat(0.0)), asked, number, portable::exp)
}

/// Powers that err by [`ERROR`] where they are in range, rounded to `f32`, in the lanes that are asked for; 0 in the others. What they do
/// not decide is what `exact` makes of the numbers.
#[inline(always)]
fn rounded<L: Lanes>(power: L, in_range: Bits, asked: Bits, numbers: L, exact: impl Fn(f64) -> f64) -> L::Floats {
    let low = (power * L::splat(1.0 - ERROR)).to_floats();
    let high = (power * L::splat(1.0 + ERROR)).to_floats();
    let known = in_range.without(low.lt(high));
    let power = low.or_where_not(asked & known, L::Floats::splat(0.0));
    let rest = asked.without(known);
    if rest.is_empty() { power } else { one_by_one(numbers, rest, power, exact) }
}

/// Those lanes that the series does not decide.
#[cold]
#[inline(never)]
fn one_by_one<L: Lanes>(numbers: L, lanes: Bits, others: L::Floats, exact: impl Fn(f64) -> f64) -> L::Floats {
    let (mut row, mut powers) = ([0.0; WIDTH], [0.0; WIDTH]);
    numbers.store(&mut row, 0);
    others.store(&mut powers, 0);
    for lane in lanes.lanes() {
        powers[lane] = exact(row[lane]) as f32;
    }
    L::Floats::load(&powers, 0)
}

/// The natural logarithm of positive normal numbers, within a few units in the last place.
#[inline(always)]
fn natural_logarithm<L: Lanes>(number: L) -> L {
    let (one, half) = (L::splat(1.0), L::splat(0.5));
    let exponent = number.exponent();
    // From 1 to 2, then from √½ to √2.
    let mantissa = number.times_power_of_two(-exponent);
    let upper = mantissa.gt(L::splat(SQRT_2));
    let (mantissa, exponent) =
        ((mantissa * half).or_where_not(upper, mantissa), (exponent + one).or_where_not(upper, exponent));
    let s = (mantissa - one) / (mantissa + one);
    let square = s * s;
    // 2 (s + s³/3 + s⁵/5 + …): the first term that is left out is below 10⁻¹⁷ of the sum.
    let mut sum = L::splat(2.0 / 21.0);
    for n in (1..10).rev() {
        sum = sum * square + L::splat(2.0 / f64::from(2 * n + 1));
    }
    let small = s * (sum * square) + exponent * L::splat(LN_2_LOW);
    exponent * L::splat(LN_2_HIGH) + (s * L::splat(2.0) + small)
}

/// e to the power of numbers from [`SMALLEST`] to 0, within a few units in the last place.
#[inline(always)]
fn exponential<L: Lanes>(number: L) -> L {
    let bounded = number.larger(L::splat(SMALLEST));
    let power = (bounded * L::splat(LOG2_E) + L::splat(0.5)).floor();
    let r = (bounded - power * L::splat(LN_2_HIGH)) - power * L::splat(LN_2_LOW);
    // 1 + r (1 + r/2 (1 + r/3 …)): the first term that is left out is below 10⁻¹⁵ of the sum.
    let mut sum = L::splat(1.0);
    for n in (1..13).rev() {
        sum = L::splat(1.0) + sum * r * L::splat(1.0 / f64::from(n));
    }
    sum.times_power_of_two(power)
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;
    use crate::lanes::{InstructionSet, Work, dispatch};

    /// The numbers, their exponent, or else e to the power of them, and the lanes that are asked for.
    struct Powers<'a>(&'a [f64; WIDTH], Option<f64>, Bits);

    impl Work for Powers<'_> {
        type Output = [f32; WIDTH];
        #[inline(always)]
        fn run<L: Lanes>(self) -> [f32; WIDTH] {
            let mut powers = [0.0; WIDTH];
            for at in (0..WIDTH).step_by(L::COUNT) {
                let (numbers, asked) = (L::load(self.0, at), Bits(self.2.0 >> at) & L::all());
                let some = match self.1 {
                    Some(exponent) => power_to_f32(numbers, exponent, asked),
                    None => exponential_to_f32(numbers, asked),
                };
                some.store(&mut powers, at);
            }
            powers
        }
    }

    fn base() -> impl Strategy<Value = f64> {
        prop_oneof![
            0.0..=1.0f64,
            (0.0..1e-3f64).prop_map(|x| 1.0 - x),
            (0.0..1e-9f64).prop_map(|x| 1.0 - x),
            (-330.0..0.0f64).prop_map(|x| portable::pow(10.0, x)),
            prop::sample::select(vec![0.0, -0.0, 1.0, 0.5, 0.25, 5e-324, f64::MIN_POSITIVE, f64::NAN]),
        ]
    }

    fn exponent() -> impl Strategy<Value = f64> {
        let powers = vec![0.0, 1.0, 2.0, 0.5, 10.0, 60.0, 1e6, 1e300];
        prop_oneof![0.0..2.0f64, 0.0..1e3f64, 0.0..1e9f64, prop::sample::select(powers)]
    }

    fn number() -> impl Strategy<Value = f64> {
        // Where `f32` has its smallest numbers, and where it has none.
        let special = vec![0.0, -0.0, -5e-324, SMALLEST, -200.1, -1e300, f64::NEG_INFINITY, f64::NAN, 0.5, 100.0];
        prop_oneof![-1.0..0.0f64, -20.0..0.0f64, -110.0..-80.0f64, -250.0..0.0f64, prop::sample::select(special)]
    }

    fn same(a: f32, b: f32) -> bool {
        a.to_bits() == b.to_bits() || a.is_nan() && b.is_nan()
    }

    proptest! {
        #![proptest_config(ProptestConfig { failure_persistence: None, cases: 4096, ..ProptestConfig::default() })]
        #[test]
        fn powers_are_those_of_one_at_a_time(
            bases in prop::collection::vec(base(), WIDTH), exponent in exponent(), asked in any::<u8>(),
        ) {
            let bases: [f64; WIDTH] = std::array::from_fn(|i| bases[i]);
            for set in InstructionSet::available() {
                let powers = dispatch(set, Powers(&bases, Some(exponent), Bits(asked)));
                for lane in 0..WIDTH {
                    let expected = portable::pow(bases[lane], exponent) as f32;
                    let expected = if Bits(asked).has(lane) { expected } else { 0.0 };
                    prop_assert!(same(powers[lane], expected), "{set:?}: {}^{exponent}: {}", bases[lane], powers[lane]);
                }
            }
        }

        #[test]
        fn exponentials_are_those_of_one_at_a_time(
            numbers in prop::collection::vec(number(), WIDTH), asked in any::<u8>(),
        ) {
            let numbers: [f64; WIDTH] = std::array::from_fn(|i| numbers[i]);
            for set in InstructionSet::available() {
                let powers = dispatch(set, Powers(&numbers, None, Bits(asked)));
                for lane in 0..WIDTH {
                    let expected = portable::exp(numbers[lane]) as f32;
                    let expected = if Bits(asked).has(lane) { expected } else { 0.0 };
                    prop_assert!(same(powers[lane], expected), "{set:?}: e^{}: {}", numbers[lane], powers[lane]);
                }
            }
        }

        #[test]
        fn the_series_of_the_exponential_is_as_exact_as_is_said(number in number()) {
            if (SMALLEST..=0.0).contains(&number) {
                let (exact, series) = (portable::exp(number), exponential(number));
                prop_assert!((series - exact).abs() <= 0.5 * ERROR * exact, "e^{number}: {series}, {exact}");
            }
        }

        /// The series keep within the error that the decision rests on; a tenth of it would be too little to promise.
        #[test]
        fn the_series_are_as_exact_as_is_said(base in base(), exponent in exponent()) {
            let logarithm = natural_logarithm(base) * exponent;
            if (f64::MIN_POSITIVE..=1.0).contains(&base) && logarithm >= SMALLEST {
                let (exact, series) = (portable::pow(base, exponent), exponential(logarithm));
                prop_assert!((series - exact).abs() <= 0.5 * ERROR * exact, "{base}^{exponent}: {series}, {exact}");
            }
        }
    }

    #[test]
    fn lanes_that_are_not_asked_for_may_hold_anything() {
        let bases = [-1.0, -1e300, 1e300, f64::INFINITY, f64::NEG_INFINITY, f64::NAN, -0.0, 0.5];
        for set in InstructionSet::available() {
            let powers = dispatch(set, Powers(&bases, Some(1e9), Bits::lane(7)));
            assert_eq!(powers, [0.0; WIDTH], "{set:?}");
            assert_eq!(dispatch(set, Powers(&bases, Some(2.0), Bits::lane(7)))[7], 0.25, "{set:?}");
        }
    }

    #[test]
    fn a_series_cut_short_is_found() {
        // The twin: without its last term that counts, the logarithm is off by more than the error that is allowed.
        let (base, exponent) = (0.71, 100.0);
        let s: f64 = (base - 1.0) / (base + 1.0);
        let short = 2.0 * (0..6).map(|n| portable::pow(-s, f64::from(2 * n + 1)) / f64::from(-2 * n - 1)).sum::<f64>();
        let (exact, series) = (portable::pow(base, exponent), exponential(short * exponent));
        assert!((series - exact).abs() > 0.5 * ERROR * exact);
    }
}
