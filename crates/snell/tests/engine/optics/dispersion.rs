//! Wavelengths: bands bend each for itself, and together they are white.

use snell::math::spectrum::Bands;
use snell::math::{Point3, Ray, Rgb, Vector3};
use snell_testkit::must_fail;

use crate::stage::{Stage, assert_near, assert_pictures, children, snell, unit};

/// A prism and a ball before a sky and above a board.
fn scene(dielectric: &str, bands: u32) -> Stage {
    Stage::new(&format!(
        r#"
[render]
bands = {bands}
[camera]
eye = [0, 1, 6]
look_at = [0, 0.8, 0]
[background]
gradient = {{ horizon = [0.9, 0.9, 1], zenith = [0.3, 0.4, 0.8] }}
[[light]]
point = {{ position = [3, 5, 4] }}
[material.glass]
dielectric = {{ {dielectric} }}
[[object]]
plane = {{}}
material = {{ diffuse = {{ checker = {{}} }} }}
[[object]]
sphere = {{ center = [-1, 1, 0], radius = 0.9 }}
material = "glass"
[[object]]
mesh = {{ vertices = [[0.2, 0.1, 1], [1.8, 0.1, 1], [1, 1.4, 1], [0.2, 0.1, -1], [1.8, 0.1, -1], [1, 1.4, -1]], faces = [[0, 1, 2], [5, 4, 3], [0, 3, 4, 1], [1, 4, 5, 2], [2, 5, 3, 0]] }}
material = "glass"
"#
    ))
    .sized(24, 18)
}

/// The same, with every ray followed up to a depth, so that light in 16 bands is not cut where light in one is not.
fn followed(dielectric: &str) -> snell::image::Image<Rgb> {
    let mut stage = scene(dielectric, 16);
    (stage.settings.min_weight, stage.settings.depth) = (0.0, 5);
    stage.picture()
}

#[test]
fn glass_that_does_not_disperse_is_the_same_by_any_formula() {
    let constant = followed("ior = 1.6");
    // In one ray, since nothing depends on the wavelength.
    assert_pictures(&followed("ior = { cauchy = [1.6, 0.0] }"), &constant, 0.0);
    // In one ray for each band, whose indices differ by less than what rounding does to a direction.
    assert_pictures(&followed("ior = { cauchy = [1.6, 1e-13] }"), &constant, 5e-6);
    must_fail("real dispersion", || assert_pictures(&followed("ior = { cauchy = [1.58, 0.007] }"), &constant, 5e-6));
}

#[test]
fn bands_together_are_white_again() {
    // With fixed shares and the same background everywhere, nothing can be seen of the spectrum; before a gradient it can.
    let prism = |ior: &str, bands: u32, background: &str| {
        let stage = Stage::new(&format!(
            "[render]\nbands = {bands}\n[background]\n{background}\n[[object]]\nmaterial = {{ dielectric = {{ \
             fresnel = false, reflect = 0, transmit = 1, ior = {ior} }} }}\nmesh = {{ vertices = [[-1, 0, 1], [1, 0, 1], \
             [0, 1.7, 1], [-1, 0, -1], [1, 0, -1], [0, 1.7, -1]], faces = [[0, 1, 2], [5, 4, 3], [0, 3, 4, 1], [1, 4, 5, 2], \
             [2, 5, 3, 0]] }}"
        ));
        let (tree, statistics) =
            stage.shoot(Ray::new(Point3::new(-5.0, -2.435, 0.1), Vector3::new(1.0, 0.73, 0.0).normalize()));
        assert_eq!(statistics.total_internal_reflections, 0);
        tree.sum()
    };
    let same = "color = [0.8, 0.5, 0.3]";
    for bands in [2, 3, 16, 64] {
        let split = prism("\"N-SF11\"", bands, same);
        assert_near(split, prism("1.7", 1, same), 4e-7, &format!("{bands} bands"));
    }
    must_fail("a colour that is 1e-6 off", || {
        assert_near(prism("\"N-SF11\"", 16, same), Rgb::new(0.8, 0.5, 0.300_001), 4e-7, "the twin");
    });
    let step = "gradient = { stops = [{ at = -0.6, color = 0 }, { at = 0.6, color = 1 }] }";
    let seen = prism("\"N-SF11\"", 16, step);
    assert!((seen.r - seen.b).abs() > 0.01, "a rainbow: {seen:?}");
}

#[test]
fn every_band_goes_its_own_way() {
    // Pixels so small that they show every band.
    let stage = scene("ior = \"N-SF11\"", 16).sized(60_000, 4);
    let (tree, _) = stage.shoot(Ray::new(Point3::new(-1.0, 1.4, 9.0), -Vector3::Z));
    let hit = tree.rays[0].hit.flatten().expect("the ball");
    let glass = snell::scene::catalogue::lookup("N-SF11").expect("a glass").dispersion();
    let bands = Bands::shifted(16, 0.0);
    let rays: Vec<_> = children(&tree, tree.rays[0].task.id).filter(|ray| ray.task.band.is_some()).collect();
    assert_eq!((rays.len(), bands.len()), (16, 16));
    let check = |shift: f64| {
        for (ray, band) in rays.iter().zip(bands.iter()) {
            let index = glass.index(band.wavelength_nm + shift);
            let expected = snell(-Vector3::Z, unit(hit.geometric_normal), 1.0, index).expect("refracted");
            assert!((ray.task.ray.direction - expected).length() < 1e-12, "{band:?}");
        }
    };
    check(0.0);
    must_fail("wavelengths off by a nanometre", || check(1.0));
    // Red, the longest wavelength, is bent least.
    let turn = |ray: &snell::observe::TracedRay| 1.0 + ray.task.ray.direction.z();
    assert!(rays.windows(2).all(|pair| turn(pair[0]) > turn(pair[1])));
}
