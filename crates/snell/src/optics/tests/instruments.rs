//! Lenses and a prism, traced ray by ray: what optics has known of them for long must come out.

use snell_math::{Normal3, Point3, Vector3, portable};

use crate::optics::refract;

/// One spherical face of a lens on the z axis: where it meets the axis, its radius (positive where the centre is at
/// greater z), and the indices before and behind it.
struct Face {
    vertex: f64,
    radius: f64,
    before: f64,
    behind: f64,
}

/// A ray through the faces, in order; `None` where it misses one or is totally reflected.
fn through(faces: &[Face], mut at: Point3, mut direction: Vector3) -> Option<(Point3, Vector3)> {
    for face in faces {
        let centre = Point3::new(0.0, 0.0, face.vertex + face.radius);
        let from_centre = at - centre;
        let b = from_centre.dot(direction);
        let root = (b * b - from_centre.length_squared() + face.radius * face.radius).max(0.0).sqrt();
        // The crossing on the vertex's side of the centre.
        at = at + direction * (-b - root.copysign(face.radius));
        let normal = Normal3::from((at - centre) * (1.0 / face.radius)).normalize();
        direction = refract(-direction, normal.face_forward(-direction), face.before / face.behind)?;
    }
    Some((at, direction))
}

/// The focal length and the place of the focus on the axis, for a ray parallel to it at this height.
fn focus(faces: &[Face], height: f64) -> (f64, f64) {
    let (at, direction) = through(faces, Point3::new(0.0, height, -10.0), Vector3::Z).expect("a ray near the axis");
    let slope = direction.y() / direction.z();
    (-height / slope, at.z() - at.y() / slope)
}

/// The same at height zero: spherical aberration grows with the square of the height, so two heights cancel it.
fn paraxial_focus(faces: &[Face]) -> (f64, f64) {
    let (one, half) = (focus(faces, 2e-3), focus(faces, 1e-3));
    ((4.0 * half.0 - one.0) / 3.0, (4.0 * half.1 - one.1) / 3.0)
}

fn lens(n: f64, first: f64, second: f64, thickness: f64) -> [Face; 2] {
    [
        Face { vertex: 0.0, radius: first, before: 1.0, behind: n },
        Face { vertex: thickness, radius: second, before: n, behind: 1.0 },
    ]
}

#[test]
fn a_ball_lens_has_its_focal_length() {
    for n in [1.333, 1.5, 1.5168, 1.9] {
        let (focal_length, at) = paraxial_focus(&lens(n, 1.0, -1.0, 2.0));
        // n D / (4 (n − 1)), measured from the centre.
        let expected = n * 2.0 / (4.0 * (n - 1.0));
        assert!((focal_length / expected - 1.0).abs() < 1e-9, "{n}: {focal_length} {expected}");
        assert!((at - 1.0 - expected).abs() < 1e-9 * expected, "{n}: {at}");
    }
}

#[test]
fn a_thick_lens_has_the_lensmakers_focal_length() {
    for (n, first, second, thickness) in
        [(1.5168, 3.0, -5.0, 0.4), (1.62, 2.0, 4.0, 0.3), (1.5, -2.0, 3.0, 0.2), (1.785, 2.0, -2.0, 1.0)]
    {
        let power = (n - 1.0) * (1.0 / first - 1.0 / second + (n - 1.0) * thickness / (n * first * second));
        let back = (1.0 - (n - 1.0) * thickness / (n * first)) / power;
        let (focal_length, at) = paraxial_focus(&lens(n, first, second, thickness));
        assert!((focal_length * power - 1.0).abs() < 1e-9, "{focal_length} {power}");
        assert!((at - thickness - back).abs() < 1e-9 * back.abs(), "{at} {back}");
        // The twin: a face with its indices the wrong way round.
        let mut wrong = lens(n, first, second, thickness);
        wrong[0] = Face { before: n, behind: 1.0, ..lens(n, first, second, thickness)[0] };
        assert!((paraxial_focus(&wrong).0 * power - 1.0).abs() > 1e-2);
    }
}

#[test]
fn spherical_aberration_grows_with_the_square_of_the_height() {
    let faces = lens(1.5, 1.0, -1.0, 2.0);
    let axis = paraxial_focus(&faces).0;
    let ratio = (focus(&faces, 0.02).0 - axis) / (focus(&faces, 0.01).0 - axis);
    assert!((ratio - 4.0).abs() < 1e-2, "{ratio}");
}

/// The angle by which a prism of this apex angle turns a ray that meets it at `incidence`; `None` where it does not get
/// out.
fn prism_deviation(n: f64, apex: f64, incidence: f64) -> Option<f64> {
    // Faces that lean by half the apex angle to either side of the y axis; light travels towards +x.
    let (cos, sin) = (portable::cos(0.5 * apex), portable::sin(0.5 * apex));
    let (first, second) = (Normal3::new(-cos, sin, 0.0), Normal3::new(cos, sin, 0.0));
    let tangent = Vector3::new(-sin, -cos, 0.0);
    let wo = first.as_vector() * portable::cos(incidence) + tangent * portable::sin(incidence);
    let inside = refract(wo, first, 1.0 / n)?;
    let outside = refract(-inside, -second, n)?;
    Some(portable::atan2(wo.cross(outside).length(), -wo.dot(outside)))
}

#[test]
fn a_prism_deviates_least_when_passed_symmetrically() {
    for (n, apex_degrees) in [(1.333, 60.0), (1.5168, 60.0), (1.78472, 60.0), (1.62, 45.0), (2.4175, 30.0)] {
        let apex = portable::radians(apex_degrees);
        let incidence = portable::asin(n * portable::sin(0.5 * apex));
        let least = prism_deviation(n, apex, incidence).expect("light comes through");
        // Fraunhofer's way to measure glass: n = sin((A + D) / 2) / sin(A / 2).
        let measured = portable::sin(0.5 * (apex + least)) / portable::sin(0.5 * apex);
        assert!((measured / n - 1.0).abs() < 1e-12, "{n}, {apex_degrees}°: {measured}");
        for aside in [-0.1, -0.01, 0.01, 0.1] {
            let more = prism_deviation(n, apex, incidence + aside);
            assert!(more.is_none_or(|deviation| deviation > least), "{n}, {apex_degrees}°, {aside}");
        }
    }
}

#[test]
fn a_steep_prism_lets_nothing_through() {
    // Beyond an apex angle of twice the critical angle no ray gets out, at whatever incidence.
    let apex = portable::radians(85.0);
    for incidence in -15..15 {
        assert_eq!(prism_deviation(1.5, apex, f64::from(incidence) * 0.1), None);
    }
}
