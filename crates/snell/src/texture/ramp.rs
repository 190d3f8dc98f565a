//! A colour ramp: stops of (position, colour), blended linearly in scene-linear colour. Positions have the unit of their
//! user: the gradient's axis, or the height of a direction.

use snell_math::Rgb;

/// Checked stops.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Ramp {
    /// At least one; positions do not decrease.
    stops: Vec<(f64, Rgb)>,
    /// Beyond the stops: again and again, or else the colours of the ends.
    repeat: bool,
}

/// Why stops make no ramp.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum RampError {
    /// There is nothing to take a colour from.
    #[error("it has no stops")]
    Empty,
    /// A position or colour is NaN or infinite, or the positions are further apart than numbers go.
    #[error("stop {index} is not finite")]
    NotFinite {
        /// Which stop, from 0.
        index: usize,
    },
    /// A stop lies before the one it follows.
    #[error("stop {index} lies before the stop that it follows")]
    Decreasing {
        /// Which stop, from 0.
        index: usize,
    },
}

impl Ramp {
    pub fn new(stops: &[(f64, Rgb)], repeat: bool) -> Result<Self, RampError> {
        let (first, _) = *stops.first().ok_or(RampError::Empty)?;
        for (index, (position, color)) in stops.iter().enumerate() {
            if !(position - first).is_finite() || !color.is_finite() {
                return Err(RampError::NotFinite { index });
            }
            if index > 0 && *position < stops[index - 1].0 {
                return Err(RampError::Decreasing { index });
            }
        }
        Ok(Self { stops: stops.to_vec(), repeat })
    }

    /// The colour, where it is the same at every position.
    pub fn constant(&self) -> Option<Rgb> {
        let color = self.stops[0].1;
        self.stops.iter().all(|stop| stop.1 == color).then_some(color)
    }

    /// The colour at a position. Where stops coincide, the last of them counts from there on. NaN is taken as the start.
    pub fn color(&self, position: f64) -> Rgb {
        let (first, last) = (self.stops[0], self.stops[self.stops.len() - 1]);
        let length = last.0 - first.0;
        let position = if self.repeat && length > 0.0 {
            let turns = (position - first.0) / length;
            let turn = turns - turns.floor();
            // A fraction of infinity is NaN, which is no more than the first position either.
            first.0 + turn * length
        } else {
            position
        };
        // How many stops lie at the position or before it.
        let passed = self.stops.partition_point(|stop| stop.0 <= position);
        if passed == 0 {
            return first.1;
        }
        if passed == self.stops.len() {
            return last.1;
        }
        let ((from, from_color), (to, to_color)) = (self.stops[passed - 1], self.stops[passed]);
        from_color.lerp(to_color, ((position - from) / (to - from)) as f32)
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    fn three() -> Vec<(f64, Rgb)> {
        vec![(-1.0, Rgb::new(1.0, 0.0, 0.3)), (0.5, Rgb::new(0.1, 0.7, 0.3)), (2.0, Rgb::new(0.2, 0.0, 4.0))]
    }

    #[test]
    fn stops_are_met_exactly_and_from_both_sides() {
        let ramp = Ramp::new(&three(), false).unwrap();
        for (position, color) in three() {
            assert_eq!(ramp.color(position), color);
            for near in [position - 1e-7, position + 1e-7] {
                assert!((ramp.color(near) - color).max_abs() < 1e-6, "jumps at {position}");
            }
        }
        assert_eq!(ramp.color(-0.25), Rgb::new(1.0, 0.0, 0.3).lerp(Rgb::new(0.1, 0.7, 0.3), 0.5));
        assert_eq!(ramp.color(-1e300), three()[0].1);
        assert_eq!(ramp.color(f64::INFINITY), three()[2].1);
    }

    #[test]
    fn stops_at_one_place_make_a_step() {
        let (a, b) = (Rgb::gray(0.0), Rgb::gray(1.0));
        let ramp = Ramp::new(&[(0.0, a), (1.0, a), (1.0, b), (2.0, b)], false).unwrap();
        assert_eq!(ramp.color(1.0 - 1e-15), a);
        assert_eq!(ramp.color(1.0), b);
        // Repeated over no length, it is a step too.
        let step = Ramp::new(&[(1.0, a), (1.0, b)], true).unwrap();
        assert_eq!((step.color(0.0), step.color(1.0), step.color(9.0)), (a, b, b));
    }

    #[test]
    fn what_is_no_ramp_is_refused() {
        assert_eq!(Ramp::new(&[], false), Err(RampError::Empty));
        let mut stops = three();
        stops[2].0 = 0.4;
        assert_eq!(Ramp::new(&stops, false), Err(RampError::Decreasing { index: 2 }));
        for bad in [f64::NAN, f64::INFINITY] {
            stops[2].0 = bad;
            assert_eq!(Ramp::new(&stops, false), Err(RampError::NotFinite { index: 2 }));
        }
        assert_eq!(
            Ramp::new(&[(-1.7e308, Rgb::BLACK), (1.7e308, Rgb::WHITE)], false),
            Err(RampError::NotFinite { index: 1 })
        );
        assert_eq!(Ramp::new(&[(0.0, Rgb::gray(f32::NAN))], false), Err(RampError::NotFinite { index: 0 }));
        assert_eq!(Ramp::new(&[(f64::NAN, Rgb::BLACK)], false), Err(RampError::NotFinite { index: 0 }));
    }

    #[test]
    fn equal_colours_are_constant() {
        assert_eq!(Ramp::new(&three(), false).unwrap().constant(), None);
        let flat = [(0.0, Rgb::gray(0.3)), (1.0, Rgb::gray(0.3))];
        assert_eq!(Ramp::new(&flat, true).unwrap().constant(), Some(Rgb::gray(0.3)));
    }

    proptest! {
        #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::default() })]

        #[test]
        fn repeats(position in -50.0..50.0f64, turns in -9..9i32) {
            let ramp = Ramp::new(&three(), true).unwrap();
            let (a, b) = (ramp.color(position), ramp.color(position + 3.0 * f64::from(turns)));
            // But for rounding across the jump between the last stop and the first.
            let turn = ((position + 1.0) / 3.0).fract().abs();
            prop_assume!(turn > 1e-9 && turn < 1.0 - 1e-9);
            prop_assert!((a - b).max_abs() < 1e-5);
        }

        #[test]
        fn every_position_gives_a_finite_colour_between_the_stops(bits: u64, repeat: bool) {
            let color = Ramp::new(&three(), repeat).unwrap().color(f64::from_bits(bits));
            prop_assert!(color.is_finite() && color.r >= 0.1 - 1e-6 && color.b <= 4.0);
        }
    }
}
