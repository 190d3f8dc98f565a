//! Random numbers for tests: PCG-XSH-RR 64/32 (O'Neill 2014, "PCG: A Family of Simple Fast Space-Efficient Statistically
//! Good Algorithms for Random Number Generation"). The same seed gives the same numbers on every machine.

use snell_math::Vector3;

const MULTIPLIER: u64 = 6_364_136_223_846_793_005;
const INCREMENT: u64 = 1_442_695_040_888_963_407;

/// A stream of random numbers.
///
/// ```
/// use snell_testkit::TestRng;
/// let mut rng = TestRng::new(42);
/// let x = rng.range(-2.0, 3.0);
/// assert!((-2.0..3.0).contains(&x));
/// assert_eq!(TestRng::new(42).range(-2.0, 3.0), x);
/// ```
#[derive(Clone, Debug)]
pub struct TestRng {
    state: u64,
}

impl TestRng {
    /// The stream of a seed.
    pub fn new(seed: u64) -> Self {
        let mut rng = Self { state: INCREMENT.wrapping_add(seed) };
        rng.step();
        rng
    }

    fn step(&mut self) {
        self.state = self.state.wrapping_mul(MULTIPLIER).wrapping_add(INCREMENT);
    }

    /// 32 random bits.
    pub fn bits(&mut self) -> u32 {
        let state = self.state;
        self.step();
        let mixed = (((state >> 18) ^ state) >> 27) as u32;
        mixed.rotate_right((state >> 59) as u32)
    }

    /// 64 random bits.
    pub fn bits64(&mut self) -> u64 {
        u64::from(self.bits()) << 32 | u64::from(self.bits())
    }

    /// Uniform in [0, 1), with 53 bits.
    pub fn unit(&mut self) -> f64 {
        (self.bits64() >> 11) as f64 / (1_u64 << 53) as f64
    }

    /// Uniform in [0, 1), with 24 bits.
    pub fn unit_f32(&mut self) -> f32 {
        (self.bits() >> 8) as f32 / (1_u32 << 24) as f32
    }

    /// Uniform in [low, high).
    pub fn range(&mut self, low: f64, high: f64) -> f64 {
        // Rounding may reach `high` itself.
        loop {
            let value = low + (high - low) * self.unit();
            if value < high || low >= high {
                return value;
            }
        }
    }

    /// A whole number below `end`, each as likely as the others; 0 for `end` 0.
    pub fn below(&mut self, end: u32) -> u32 {
        // Lemire 2019, "Fast Random Integer Generation in an Interval", with rejection.
        let threshold = end.wrapping_neg().checked_rem(end).unwrap_or(0);
        loop {
            let product = u64::from(self.bits()) * u64::from(end);
            if product as u32 >= threshold {
                return (product >> 32) as u32;
            }
        }
    }

    /// True as often as false.
    pub fn coin(&mut self) -> bool {
        self.bits() >> 31 == 1
    }

    /// One of the elements.
    ///
    /// # Panics
    /// Where there are none.
    pub fn pick<'a, T>(&mut self, from: &'a [T]) -> &'a T {
        &from[self.below(from.len() as u32) as usize]
    }

    /// A vector with each component uniform in [−size, size).
    pub fn vector(&mut self, size: f64) -> Vector3 {
        Vector3::new(self.range(-size, size), self.range(-size, size), self.range(-size, size))
    }

    /// A unit vector, uniform over the sphere.
    pub fn direction(&mut self) -> Vector3 {
        loop {
            let vector = self.vector(1.0);
            let length_squared = vector.length_squared();
            if length_squared <= 1.0 && length_squared > 1e-6 {
                return vector * (1.0 / length_squared.sqrt());
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_stream_is_that_of_its_definition() {
        // The definition once more, in 128 bit arithmetic.
        let mut rng = TestRng::new(7);
        let next = |state: u64| {
            ((u128::from(state) * u128::from(MULTIPLIER) + u128::from(INCREMENT)) & u128::from(u64::MAX)) as u64
        };
        let mut state = next(INCREMENT + 7);
        for _ in 0..100 {
            let mixed = (((state >> 18) ^ state) >> 27) as u32;
            // A rotation is the word written twice, shifted.
            let twice = u64::from(mixed) << 32 | u64::from(mixed);
            let expected = (twice >> (state >> 59)) as u32;
            assert_eq!(rng.bits(), expected);
            state = next(state);
        }
    }

    #[test]
    fn numbers_stay_in_their_ranges_and_fill_them() {
        let mut rng = TestRng::new(1);
        let mut counts = [0; 7];
        let mut sum = 0.0;
        for _ in 0..7000 {
            counts[rng.below(7) as usize] += 1;
            let unit = rng.unit();
            assert!((0.0..1.0).contains(&unit) && (0.0..1.0).contains(&rng.unit_f32()));
            assert!((-3.0..-2.0).contains(&rng.range(-3.0, -2.0)));
            sum += unit;
        }
        assert!(counts.iter().all(|count| (880..1120).contains(count)), "{counts:?}");
        assert!((sum / 7000.0 - 0.5).abs() < 0.015);
        assert_eq!((rng.below(0), rng.below(1), rng.range(2.0, 2.0)), (0, 0, 2.0));
    }

    #[test]
    fn directions_are_unit_and_have_no_preference() {
        let mut rng = TestRng::new(3);
        let mut sum = Vector3::ZERO;
        for _ in 0..4000 {
            let direction = rng.direction();
            assert!((direction.length() - 1.0).abs() < 1e-12);
            sum += direction;
        }
        assert!(sum.length() / 4000.0 < 0.04, "{sum:?}");
    }
}
