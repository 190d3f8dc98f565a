//! Clipping to the view volume in homogeneous coordinates, before the division.
//!
//! After the division, what is behind the eye looks as if it were before it, and a segment through the eye's plane seems to run
//! the wrong way around, through infinity. Before it, the volume is the cone |x| ≤ h, |y| ≤ h, |z| ≤ h, in which straight segments stay
//! straight: Blinn and Newell, "Clipping using homogeneous coordinates", SIGGRAPH 1978.

use snell_math::Homogeneous3;

/// A side of the canonical view volume [−1, 1]³, in which n is at z = 1 and f at z = −1.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Side {
    /// x = −1.
    Left,
    /// x = 1.
    Right,
    /// y = −1.
    Bottom,
    /// y = 1.
    Top,
    /// z = 1, where the near plane n is.
    Near,
    /// z = −1, where the far plane f is.
    Far,
}

impl Side {
    /// All six.
    pub const ALL: [Self; 6] = [Self::Left, Self::Right, Self::Bottom, Self::Top, Self::Near, Self::Far];

    /// How far inside of this side a point is, times h: not negative inside. Linear in the coordinates.
    #[inline]
    pub fn distance(self, p: Homogeneous3) -> f64 {
        match self {
            Self::Left => p.h() + p.x(),
            Self::Right => p.h() - p.x(),
            Self::Bottom => p.h() + p.y(),
            Self::Top => p.h() - p.y(),
            Self::Near => p.h() - p.z(),
            Self::Far => p.h() + p.z(),
        }
    }

    /// What people call it: `left`, `near`.
    pub fn name(self) -> &'static str {
        match self {
            Self::Left => "left",
            Self::Right => "right",
            Self::Bottom => "bottom",
            Self::Top => "top",
            Self::Near => "near",
            Self::Far => "far",
        }
    }
}

/// What is left of a segment: the part from parameter `from` to `to` of a + t (b − a).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Clipped {
    /// Where it begins, from 0.
    pub from: f64,
    /// Where it ends, up to 1, not below `from`.
    pub to: f64,
    /// The side that cut its beginning off.
    pub entered: Option<Side>,
    /// The side that cut its end off.
    pub left: Option<Side>,
}

/// Clips a segment to the canonical view volume. The ends are homogeneous, with the sign by which h > 0 before the eye; they
/// may be anywhere, also behind the eye, in its plane (h = 0), or the same. `None` where nothing is inside, or a coordinate is NaN.
///
/// ```
/// use snell::math::{Homogeneous3, Point3};
/// use snell::viewing::{Side, clip_segment};
/// // From before the eye to a point behind it, which has h < 0.
/// let (a, b) = (Homogeneous3::new(0.0, 0.0, 0.0, 1.0), Homogeneous3::new(0.0, 0.0, 6.0, -2.0));
/// let clipped = clip_segment(a, b).expect("it begins inside");
/// assert_eq!((clipped.from, clipped.left), (0.0, Some(Side::Near)));
/// let end = a.lerp(b, clipped.to).homogenize().unwrap();
/// assert!((end.z() - 1.0).abs() < 1e-15);
/// ```
pub fn clip_segment(a: Homogeneous3, b: Homogeneous3) -> Option<Clipped> {
    clip_segment_to(a, b, &Side::ALL)
}

/// As [`clip_segment`], to some sides alone, as of a volume that has no far plane. Left and right, or bottom and top, or near and
/// far must be among them: only two opposite sides keep what is behind the eye out.
pub fn clip_segment_to(a: Homogeneous3, b: Homogeneous3, sides: &[Side]) -> Option<Clipped> {
    let mut clipped = Clipped { from: 0.0, to: 1.0, entered: None, left: None };
    for &side in sides {
        let (start, end) = (side.distance(a), side.distance(b));
        if start.is_nan() || end.is_nan() || start < 0.0 && end < 0.0 {
            return None;
        }
        if start < 0.0 {
            let t = start / (start - end);
            if t > clipped.from {
                (clipped.from, clipped.entered) = (t, Some(side));
            }
        } else if end < 0.0 {
            let t = start / (start - end);
            if t < clipped.to {
                (clipped.to, clipped.left) = (t, Some(side));
            }
        }
    }
    // Between opposite sides h is not negative; the tip of the cone, h = 0, is no point.
    let middle = a.lerp(b, 0.5 * (clipped.from + clipped.to));
    (clipped.from <= clipped.to && middle.h() > 0.0).then_some(clipped)
}

/// The sides that a point is outside of; `h` has the sign by which it is positive before the eye.
pub fn outside(p: Homogeneous3) -> impl Iterator<Item = Side> {
    // Negated, so that NaN is outside too.
    Side::ALL.into_iter().filter(move |side| side.distance(p).is_nan() || side.distance(p) < 0.0)
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    /// An interval that surely holds the exact value.
    #[derive(Clone, Copy)]
    struct Interval(f64, f64);

    impl Interval {
        fn exact(x: f64) -> Self {
            Self(x, x)
        }
        fn add(self, other: Self) -> Self {
            Self((self.0 + other.0).next_down(), (self.1 + other.1).next_up())
        }
        fn sub(self, other: Self) -> Self {
            self.add(Self(-other.1, -other.0))
        }
        fn mul(self, other: Self) -> Self {
            let products = [self.0 * other.0, self.0 * other.1, self.1 * other.0, self.1 * other.1];
            let low = products.into_iter().fold(f64::INFINITY, f64::min);
            let high = products.into_iter().fold(f64::NEG_INFINITY, f64::max);
            Self(low.next_down(), high.next_up())
        }
    }

    /// Whether the points a + t (b − a) for all t of an interval are surely inside (true), surely outside (false), or neither.
    fn proven(a: Homogeneous3, b: Homogeneous3, t: Interval) -> Option<bool> {
        let at = |k: usize| {
            let (a, b) = (Interval::exact(a.to_array()[k]), Interval::exact(b.to_array()[k]));
            a.add(t.mul(b.sub(a)))
        };
        let (p, h) = ([at(0), at(1), at(2)], at(3));
        let distances: Vec<Interval> = p.iter().flat_map(|&c| [h.add(c), h.sub(c)]).collect();
        if distances.iter().any(|d| d.1 < 0.0) {
            return Some(false);
        }
        distances.iter().all(|d| d.0 > 0.0).then_some(true)
    }

    /// Splits [0, 1] until every piece is proven to be inside or outside or is tiny, and compares with the clipped part.
    fn check(a: Homogeneous3, b: Homogeneous3, clipped: Option<Clipped>) -> Result<(), String> {
        let mut pieces = vec![(0.0, 1.0)];
        while let Some((from, to)) = pieces.pop() {
            match proven(a, b, Interval(from, to)) {
                Some(inside) => {
                    let overlaps = clipped.is_some_and(|c| c.from.max(from) < c.to.min(to) - 1e-12);
                    let covers = clipped.is_some_and(|c| c.from <= from + 1e-12 && to - 1e-12 <= c.to);
                    if inside && !covers || !inside && overlaps {
                        return Err(format!("[{from}, {to}] is {inside}, but {clipped:?}"));
                    }
                }
                None if to - from > 1e-6 => {
                    let middle = 0.5 * (from + to);
                    pieces.extend([(from, middle), (middle, to)]);
                }
                None => {}
            }
        }
        Ok(())
    }

    fn coordinate() -> impl Strategy<Value = f64> {
        // Whole numbers too, so that ends lie on sides, in the eye's plane and on each other.
        prop_oneof![-4.0..4.0f64, (-2..3i32).prop_map(f64::from)]
    }

    fn points() -> impl Strategy<Value = Homogeneous3> {
        [coordinate(), coordinate(), coordinate(), coordinate()].prop_map(|[x, y, z, h]| Homogeneous3::new(x, y, z, h))
    }

    proptest! {
        #![proptest_config(ProptestConfig { failure_persistence: None, cases: 512, ..ProptestConfig::default() })]
        #[test]
        fn what_is_left_is_what_interval_arithmetic_proves(a in points(), b in points(), same in 0..8u8) {
            let b = if same == 0 { a } else { b };
            let clipped = clip_segment(a, b);
            prop_assert!(check(a, b, clipped).is_ok(), "{:?}", check(a, b, clipped));
            // The ends are on the side that is named, and back to front it is the same part.
            if let Some(c) = clipped {
                for (t, side) in [(c.from, c.entered), (c.to, c.left)] {
                    let distance = side.map_or(0.0, |side| side.distance(a.lerp(b, t)));
                    prop_assert!(distance.abs() < 1e-14 * 16.0);
                }
                let back = clip_segment(b, a).expect("the same part");
                prop_assert!((back.from - (1.0 - c.to)).abs() < 1e-14 && (back.to - (1.0 - c.from)).abs() < 1e-14);
            }
        }
    }

    #[test]
    fn a_wrong_part_is_told() {
        // The twin of the test above: a part that is cut at the wrong place, and one that is forgotten.
        let (a, b) = (Homogeneous3::new(-3.0, 0.0, 0.0, 1.0), Homogeneous3::new(3.0, 0.5, 0.0, 1.0));
        let right = clip_segment(a, b).expect("it passes through");
        assert!(check(a, b, Some(right)).is_ok());
        assert!(check(a, b, Some(Clipped { from: right.from + 1e-3, ..right })).is_err());
        assert!(check(a, b, Some(Clipped { to: right.to + 1e-3, ..right })).is_err());
        assert!(check(a, b, None).is_err());
    }

    #[test]
    fn nothing_of_what_is_no_point_is_inside() {
        let nowhere = Homogeneous3::new(0.0, 0.0, 0.0, 0.0);
        assert_eq!(clip_segment(nowhere, nowhere), None);
        let nan = Homogeneous3::new(f64::NAN, 0.0, 0.0, 1.0);
        assert_eq!(clip_segment(nan, Homogeneous3::new(0.0, 0.0, 0.0, 1.0)), None);
        // All of a segment behind the eye, though after the division its ends would be inside.
        let behind = Homogeneous3::new(0.1, 0.0, 0.0, -1.0);
        assert_eq!(clip_segment(behind, Homogeneous3::new(0.0, 0.1, 0.5, -2.0)), None);
        assert_eq!(outside(behind).count(), 6);
        assert_eq!(outside(Homogeneous3::new(2.0, 0.0, 0.0, 1.0)).collect::<Vec<_>>(), [Side::Right]);
    }
}
