//! Real lenses against closed forms and an independent trace.

use snell_math::dispersion::fraunhofer::{HYDROGEN_C, HYDROGEN_F};
use snell_scene::assets::MemoryAssets;
use snell_scene::document::read_scene;
use snell_scene::scene::{CameraLens, LensPrescription, PixelGrid};
use snell_testkit::must_fail;

use super::*;
use crate::camera::Camera;

/// The camera with a lens, written as the value of `lens`; and a world unit of a millimetre.
fn camera(lens: &str) -> (Camera, LensSystem) {
    let text = format!("unit = 'mm'\n[camera]\neye = [0, 0, 0]\nlook_at = [0, 0, -1e6]\nlens = {lens}\n");
    let (scene, diagnostics) = read_scene("a.toml", text.as_bytes(), &MemoryAssets::default(), &[]);
    let scene = scene.unwrap_or_else(|| panic!("{:#?}", diagnostics.list));
    let camera = Camera::new(&scene.camera, 36, 24, PixelGrid::Centers).expect("a camera");
    let Some(CameraLens::System(system)) = scene.camera.lens else { panic!("no real lens") };
    (camera, *system)
}

fn lens(text: &str) -> RealLens {
    camera(text).0.real_lens().expect("a real lens")
}

#[track_caller]
fn assert_close(found: f64, expected: f64, tolerance: f64) {
    assert!((found - expected).abs() <= tolerance * expected.abs().max(1.0), "{found}, not {expected}");
}

/// Where a ray parallel to the axis at a height meets the axis behind the last surface, and its slope there: traced from the
/// world to the film by angles with the axis, in two dimensions, apart from the engine (Smith, "Modern Optical Engineering", section 10.2).
fn meridional(lens: &LensPrescription, height: f64, nm: f64) -> [f64; 2] {
    let (mut z, mut y, mut angle, mut vertex, mut before) = (0.0, height, 0.0_f64, 0.0, 1.0);
    for surface in &lens.surfaces {
        // To the surface, by a few steps of Newton's for y(z) and its sag.
        let slope = portable::sin(angle) / portable::cos(angle);
        let sag = |y: f64| {
            if surface.radius.is_finite() {
                surface.radius - surface.radius.signum() * (surface.radius * surface.radius - y * y).sqrt()
            } else {
                0.0
            }
        };
        let mut at = vertex;
        for _ in 0..200 {
            at = vertex + sag(y + slope * (at - z));
        }
        (y, z) = (y + slope * (at - z), at);
        let behind = surface.behind.index(nm);
        // The normal's angle with the axis, as the ray's is counted.
        let normal = if surface.radius.is_finite() { -portable::asin(y / surface.radius) } else { 0.0 };
        let incidence = angle - normal;
        angle = normal + portable::asin(before / behind * portable::sin(incidence));
        before = behind;
        vertex += surface.thickness;
    }
    let last = lens.surfaces.len() - 1;
    let slope = portable::sin(angle) / portable::cos(angle);
    [z - y / slope - (vertex - lens.surfaces[last].thickness), slope]
}

#[test]
fn spherical_and_chromatic_aberration_are_those_of_an_independent_trace() {
    let forms = [
        "{ of = { surfaces = [{ radius = 40, thickness = 5, glass = 'N-BK7', diameter = 20, stop = true }, { radius = -60, diameter = 20 }] } }",
        "'double-gauss'",
        "'cooke-triplet'",
    ];
    for form in forms {
        let (_, system) = camera(form);
        let prescription = &system.prescription;
        for (height, nm) in [(0.5, 550.0), (3.0, HYDROGEN_F), (5.5, HYDROGEN_C)] {
            let [focus, slope] = meridional(prescription, height, nm);
            let place = LensSystem { film_distance: focus, ..system.clone() };
            let frame = LensFrame {
                origin: Point3::ORIGIN,
                axes: [Vector3::X, Vector3::Y, Vector3::Z],
                millimetre: 1.0,
                film_from_raster: [[1.0, 0.0]; 2],
            };
            let mut traced = RealLens::new(&place, frame, [1.0, 1.0]);
            // The same ray, backwards: from its crossing with the axis it leaves parallel to it, at its height.
            let check = |lens: &RealLens| {
                let (origin, direction) =
                    lens.trace([0.0, 0.0], [-slope * focus, 0.0], nm, Shape::Round).expect("it passes");
                assert_close(origin.x(), height, 1e-9);
                assert_close(direction.x(), 0.0, 1e-11);
                assert_close(direction.z(), 1.0, 1e-11);
            };
            check(&traced);
            traced.film_distance += 0.01;
            must_fail("a film that is a hundredth of a millimetre away", || check(&traced));
        }
    }
}

#[test]
fn the_faults_of_a_single_lens_have_their_signs_and_sizes() {
    let (_, system) = camera(
        "{ of = { surfaces = [{ radius = 100, thickness = 0.5, glass = 'N-BK7', diameter = 9, stop = true }, { radius = -100, diameter = 9 }] } }",
    );
    let lens = &system.prescription;
    let paraxial = lens.paraxial_d();
    let f = paraxial.focal_length();
    // To third order, of a thin lens as convex on both sides, for what is far away: −h² / (8 f n (n − 1)) ((3n + 2)(n − 1) + n³/(n − 1))
    // (Jenkins and White, "Fundamentals of Optics", section 9.5).
    let n = lens.surfaces[0].behind.index(HELIUM_D);
    let height = 4.0;
    let sum = (3.0 * n + 2.0) * (n - 1.0) + n * n * n / (n - 1.0);
    let expected = -height * height / (8.0 * f * n * (n - 1.0)) * sum;
    let [marginal, _] = meridional(lens, height, HELIUM_D);
    let aberration = marginal - paraxial.back_focal_distance();
    assert!(aberration < 0.0, "the rim of a convex lens is too strong");
    assert_close(aberration / expected, 1.0, 0.02);
    // Blue is sharp before red, by f / V.
    let abbe = lens.surfaces[0].behind.abbe_number().expect("dispersive");
    let [blue, red] = [HYDROGEN_F, HYDROGEN_C].map(|nm| meridional(lens, 0.01, nm)[0]);
    assert_close((red - blue) * abbe / f, 1.0, 0.01);
    must_fail("flint", || assert_close((red - blue) * 25.0 / f, 1.0, 0.01));
}

#[test]
fn the_middle_of_the_film_receives_what_the_f_number_says() {
    for (name, f_number) in [("double-gauss", 4.0), ("cooke-triplet", 5.6), ("achromat", 8.0), ("double-gauss", 16.0)] {
        let found = lens(&format!("{{ of = '{name}', f_number = {f_number} }}")).axial_irradiance();
        let expected = PI / (4.0 * f_number * f_number);
        // The sine condition is kept to a hundredth of the angle by these.
        assert_close(found / expected, 1.0, 0.03);
        must_fail("a stop a twentieth wider", || assert_close(found * 1.05 * 1.05 / expected, 1.0, 0.03));
    }
}

/// What a place of the film receives of a white world, over what its middle receives: by a fine grid, without pupils.
fn received(lens: &RealLens, film: [f64; 2], nm: f64) -> f64 {
    let (half, cells, d) = (lens.first_grid(), 600, lens.film_distance);
    let step = 2.0 * half / f64::from(cells);
    let mut sum = 0.0;
    for i in 0..cells * cells {
        let place = [i % cells, i / cells].map(|i| -half + step * (f64::from(i) + 0.5));
        if lens.trace(film, place, nm, Shape::Blades).is_some() {
            let offset = [place[0] - film[0], place[1] - film[1]];
            let squared = offset[0] * offset[0] + offset[1] * offset[1] + d * d;
            sum += step * step * d * d / (squared * squared);
        }
    }
    sum / (lens.irradiance * lens.stop.open_share())
}

#[test]
fn weights_are_what_a_white_world_gives() {
    for form in ["'double-gauss'", "{ of = 'double-gauss', f_number = 5.6, blades = 6 }", "'singlet'"] {
        let lens = lens(form);
        for place in [[18.0, 12.0], [30.0, 5.0], [1.0, 23.0]] {
            let mut sum = 0.0;
            let side = 200;
            for i in 0..side * side {
                let u = [i % side, i / side].map(|i| (f64::from(i) + 0.5) / f64::from(side));
                sum += lens.ray(place, u, 550.0).map_or(0.0, |(_, weight)| weight);
            }
            let found = sum / f64::from(side * side);
            let [[ax, bx], [ay, by]] = lens.frame.film_from_raster;
            let expected = received(&lens, [ax * place[0] + bx, ay * place[1] + by], 550.0);
            assert_close(found / expected, 1.0, 0.01);
            if place == [18.0, 12.0] {
                assert_close(found, 1.0, 0.01);
            } else {
                assert!(found < 0.95, "{form} is dark towards its corners: {found}");
            }
            must_fail("light that comes past the rims", || assert_close(1.05 * found / expected, 1.0, 0.01));
        }
    }
}

#[test]
fn pupils_lose_no_ray() {
    for form in ["'double-gauss'", "{ of = 'double-gauss', f_number = 64 }", "'cooke-triplet'"] {
        let mut lens = lens(form);
        let lost = |lens: &RealLens| {
            let mut lost = 0;
            for ring in 0..RINGS {
                let radius = lens.film_radius * (ring as f64 + 0.3) / RINGS as f64;
                let half = lens.first_grid().min(6.0);
                for i in 0..120 * 60 {
                    let (x, y) =
                        (-half + half * (f64::from(i % 120) + 0.5) / 60.0, half * (f64::from(i / 120) + 0.5) / 60.0);
                    let inside = lens.pupils[ring]
                        .is_some_and(|pupil| (pupil.left..=pupil.right).contains(&x) && y <= pupil.half_height);
                    lost += u32::from(!inside && lens.trace([radius, 0.0], [x, y], 550.0, Shape::Round).is_some());
                }
            }
            lost
        };
        assert_eq!(lost(&lens), 0, "{form}");
        for pupil in lens.pupils.iter_mut().flatten() {
            pupil.right -= 0.25 * (pupil.right - pupil.left);
        }
        assert!(lost(&lens) > 0, "{form}: narrower pupils lose rays");
    }
}
