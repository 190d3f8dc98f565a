//! Polygons into triangles: fans where that is right, ears cut where it is not.

use snell_math::Vector3;

/// The triangles of a polygon, as numbers of its corners, in its own orientation: always two fewer than there are corners,
/// some perhaps without area.
pub(super) fn triangulate(corners: &[Vector3]) -> Vec<[usize; 3]> {
    let fan = || (1..corners.len().saturating_sub(1)).map(|i| [0, i, i + 1]).collect();
    if corners.len() <= 3 {
        return fan();
    }
    // Newell's normal: the areas of the projections, right for corners that are not quite in a plane as well.
    let next = |i: usize| corners[(i + 1) % corners.len()];
    let normal =
        (0..corners.len()).fold(Vector3::ZERO, |sum, i| sum + (corners[i] - corners[0]).cross(next(i) - corners[0]));
    let Some(normal) = normal.try_normalize() else { return fan() };
    let convex = (0..corners.len()).all(|i| {
        let (a, b, c) = (corners[i], next(i), next((i + 1) % corners.len()));
        (b - a).cross(c - b).dot(normal) >= 0.0
    });
    if convex {
        return fan();
    }
    let (u, v) = normal.orthonormal_basis();
    let flat: Vec<f64> = corners.iter().flat_map(|corner| [corner.dot(u), corner.dot(v)]).collect();
    match earcutr::earcut(&flat, &[], 2) {
        Ok(cut) if cut.len() == 3 * (corners.len() - 2) => {
            let triangles = cut.chunks_exact(3).map(|t| [t[0], t[1], t[2]]);
            triangles.map(|t| if signed_area(&flat, t) < 0.0 { [t[0], t[2], t[1]] } else { t }).collect()
        }
        // A polygon that crosses itself.
        _ => fan(),
    }
}

fn signed_area(flat: &[f64], [a, b, c]: [usize; 3]) -> f64 {
    let at = |i: usize| (flat[2 * i], flat[2 * i + 1]);
    let ((ax, ay), (bx, by), (cx, cy)) = (at(a), at(b), at(c));
    (bx - ax) * (cy - ay) - (cx - ax) * (by - ay)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn area(corners: &[Vector3]) -> f64 {
        let signed =
            |t: [usize; 3]| 0.5 * (corners[t[1]] - corners[t[0]]).cross(corners[t[2]] - corners[t[0]]).dot(Vector3::Z);
        let areas: Vec<f64> = triangulate(corners).into_iter().map(signed).collect();
        assert!(areas.iter().all(|area| *area >= 0.0), "{areas:?}");
        areas.iter().sum()
    }

    #[test]
    fn concave_polygons_keep_their_area_and_orientation() {
        let at = |x: f64, y: f64| Vector3::new(x, y, 0.0);
        assert_eq!(area(&[at(0.0, 0.0), at(1.0, 0.0), at(1.0, 1.0), at(0.0, 1.0)]), 1.0);
        // An arrow whose notch is at its second corner, so that a fan from the first would be wrong.
        let arrow = [at(0.0, 0.0), at(2.0, 1.0), at(4.0, 0.0), at(2.0, 4.0)];
        assert!((area(&arrow) - 6.0).abs() < 1e-12);
        let l_shape = [at(0.0, 2.0), at(0.0, 0.0), at(2.0, 0.0), at(2.0, 1.0), at(1.0, 1.0), at(1.0, 2.0)];
        assert!((area(&l_shape) - 3.0).abs() < 1e-12);
    }

    #[test]
    fn polygons_without_area_do_not_fail() {
        let line: Vec<Vector3> = (0..5).map(|i| Vector3::new(f64::from(i), 0.0, 0.0)).collect();
        assert_eq!(triangulate(&line).len(), 3);
    }
}
