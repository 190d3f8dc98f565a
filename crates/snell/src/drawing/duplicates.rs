//! No line twice: straight pieces that lie on others are taken out, whichever object they are of.
//!
//! Two boxes that share an edge, or a box on a table top whose edge is its own, would have a plotter go over the same line again.

use std::collections::BTreeMap;

/// Lines are the same where they are nearer than this, in pixels.
const SAME: f64 = 0.01;

/// What is left of straight lines after what an earlier one covers is taken away: for each line its parts, as shares in [0, 1] of
/// its length. Raster coordinates.
pub fn uncovered(lines: &[[[f64; 2]; 2]]) -> Vec<Vec<[f64; 2]>> {
    // Lines that may coincide have almost the same direction and distance from the origin; each is looked up in the cells beside
    // its own too.
    let mut by_place: BTreeMap<(i64, i64), Vec<usize>> = BTreeMap::new();
    lines
        .iter()
        .enumerate()
        .map(|(index, line)| {
            let Some((angle, offset)) = place(line) else { return Vec::new() };
            let mut left = vec![[0.0, 1.0]];
            for near_angle in angle - 1..=angle + 1 {
                // The same line has either normal; angles wrap around at half a turn.
                let (wrapped, mirrored) = wrap(near_angle);
                let offsets = if mirrored { -offset - 2..=1 - offset } else { offset - 1..=offset + 1 };
                for near_offset in offsets {
                    for &other in by_place.get(&(wrapped, near_offset)).into_iter().flatten() {
                        cover(line, &lines[other], &mut left);
                    }
                }
            }
            if !left.is_empty() {
                by_place.entry((angle, offset)).or_default().push(index);
            }
            left
        })
        .collect()
}

/// How many steps of angle half a turn has.
const ANGLES: i64 = 4096;

fn wrap(angle: i64) -> (i64, bool) {
    if angle < 0 {
        (angle + ANGLES, true)
    } else if angle >= ANGLES {
        (angle - ANGLES, true)
    } else {
        (angle, false)
    }
}

/// The cell of a line: its angle, and its distance from the origin. Distances of lines that are the same differ by more than
/// [`SAME`] where they are short and far away, so the step is large.
fn place([a, b]: &[[f64; 2]; 2]) -> Option<(i64, i64)> {
    let (dx, dy) = (b[0] - a[0], b[1] - a[1]);
    let length = (dx * dx + dy * dy).sqrt();
    if !(length > 1e-9 && length.is_finite()) {
        return None;
    }
    let (dx, dy) =
        if dy < 0.0 || dy == 0.0 && dx < 0.0 { (-dx / length, -dy / length) } else { (dx / length, dy / length) };
    let angle = snell_math::portable::atan2(dy, dx) / std::f64::consts::PI * ANGLES as f64;
    let offset = a[1] * dx - a[0] * dy;
    Some(((angle.floor() as i64).clamp(0, ANGLES - 1), (offset / 4.0).floor() as i64))
}

/// Takes away from what is left of a line what another one covers, if both lie on one line.
fn cover([a, b]: &[[f64; 2]; 2], other: &[[f64; 2]; 2], left: &mut Vec<[f64; 2]>) {
    let d = [b[0] - a[0], b[1] - a[1]];
    let squared = d[0] * d[0] + d[1] * d[1];
    let shares = other.map(|p| ((p[0] - a[0]) * d[0] + (p[1] - a[1]) * d[1]) / squared);
    let (from, to) = (shares[0].min(shares[1]), shares[0].max(shares[1]));
    let (from, to) = (from.max(0.0), to.min(1.0));
    if from >= to {
        return;
    }
    // On the stretch that both have, they must be as near as the same line.
    let e = [other[1][0] - other[0][0], other[1][1] - other[0][1]];
    let length = (e[0] * e[0] + e[1] * e[1]).sqrt();
    let apart = |share: f64| {
        let p = [a[0] + d[0] * share - other[0][0], a[1] + d[1] * share - other[0][1]];
        (p[0] * e[1] - p[1] * e[0]).abs() / length
    };
    if apart(from) > SAME || apart(to) > SAME {
        return;
    }
    let short = SAME / squared.sqrt();
    *left = left
        .iter()
        .flat_map(|&[start, end]| [[start, end.min(from)], [start.max(to), end]])
        .filter(|[start, end]| end - start > short)
        .collect();
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    #[test]
    fn what_lies_on_another_line_goes() {
        let lines = [
            [[0.0, 0.0], [10.0, 0.0]],
            [[10.0, 0.0], [0.0, 0.0]],
            [[5.0, 0.0], [20.0, 0.0]],
            [[-5.0, 0.0], [25.0, 0.0]],
            [[0.0, 0.5], [10.0, 0.5]],
            [[0.0, 0.0], [10.0, 1.0]],
            [[3.0, 3.0], [3.0, 3.0]],
        ];
        let left = uncovered(&lines);
        assert_eq!(left[0], [[0.0, 1.0]]);
        assert_eq!(left[1], [] as [[f64; 2]; 0]);
        assert!((left[2][0][0] - 1.0 / 3.0).abs() < 1e-12 && left[2].len() == 1);
        let ends: Vec<f64> = left[3].iter().flatten().map(|share| share * 30.0 - 5.0).collect();
        let expected = [-5.0, 0.0, 20.0, 25.0];
        assert!(ends.iter().zip(expected).all(|(a, b)| (a - b).abs() < 1e-9), "{ends:?}");
        assert_eq!((left[4].len(), left[5].len(), left[6].len()), (1, 1, 0));
    }

    proptest! {
        #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::default() })]
        #[test]
        fn nothing_is_lost_and_nothing_stays_twice(
            angle in 0.0..std::f64::consts::TAU, offset in -500.0..500.0f64, ends in prop::collection::vec([-300.0..300.0f64, -300.0..300.0], 1..12),
        ) {
            // Pieces of one line, at any place and angle.
            let (c, s) = (snell_math::portable::cos(angle), snell_math::portable::sin(angle));
            let at = |along: f64| [c * along - s * offset, s * along + c * offset];
            let ends: Vec<[f64; 2]> = ends.into_iter().filter(|[a, b]| (a - b).abs() > 0.5).collect();
            let lines: Vec<[[f64; 2]; 2]> = ends.iter().map(|e| e.map(at)).collect();
            let left = uncovered(&lines);
            let covers = |[a, b]: [f64; 2], x: f64| a.min(b) + 0.02 < x && x < a.max(b) - 0.02;
            let pieces: Vec<[f64; 2]> = ends.iter().zip(&left).flat_map(|([a, b], parts)| {
                parts.iter().map(move |part| part.map(|share| a + (b - a) * share))
            }).collect();
            for step in -600..600 {
                let x = f64::from(step) * 0.5 + 0.123;
                let near_an_end = ends.iter().flatten().any(|end| (end - x).abs() < 0.05);
                if near_an_end {
                    continue;
                }
                let before = ends.iter().filter(|e| covers(**e, x)).count();
                let after = pieces.iter().filter(|e| covers(**e, x)).count();
                prop_assert_eq!(after, before.min(1), "at {}", x);
            }
        }
    }
}
