//! Path tracing against what is known: lights over a plane, furnaces, enclosures, and itself from the other end.

use std::f64::consts::PI;

use snell::image::Image;
use snell::math::lanes::InstructionSet;
use snell::math::{Rgb, Vector3, portable};
use snell::render::{NoProgress, PathSettings, RenderSettings, explain_path, render_paths};
use snell_testkit::must_fail;

use crate::stage::Stage;

fn samples(samples: u32) -> PathSettings {
    PathSettings { samples, ..PathSettings::default() }
}

/// The mean colour of a picture, and the standard error of its green by the differences between pixels.
fn mean(image: &Image<Rgb>) -> (Rgb, f64) {
    let count = image.pixels().len() as f64;
    let sum = image.pixels().iter().fold([0.0; 3], |sum, color| {
        let color = color.to_array();
        std::array::from_fn(|i| sum[i] + f64::from(color[i]))
    });
    let mean = sum.map(|sum| sum / count);
    let squares: f64 = image.pixels().iter().map(|color| square(f64::from(color.g) - mean[1])).sum();
    (Rgb::from(mean.map(|x| x as f32)), (squares / (count * (count - 1.0))).sqrt())
}

fn square(x: f64) -> f64 {
    x * x
}

#[track_caller]
fn assert_near(found: Rgb, expected: f64, tolerance: f64) {
    for component in found.to_array() {
        let error = (f64::from(component) - expected).abs();
        assert!(error <= tolerance, "{found:?} is not {expected} within {tolerance}");
    }
}

/// The middle of a white floor, seen from straight above, beside whatever else there is.
fn floor(rest: &str) -> Stage {
    let text = format!(
        r#"
        ambient = 1.0
        [camera]
        eye = [0, 1, 0]
        look_at = [0, 0, 0]
        up = [0, 0, -1]
        fov = 0.02
        [material.lamp]
        emission = 3
        [material.floor]
        diffuse = 0.5
        [[object]]
        plane = {{ y = 0 }}
        material = "floor"
        {rest}
        "#
    );
    Stage::new(&text).sized(8, 8)
}

#[test]
fn lights_over_a_floor_give_what_integrals_say() {
    // Lambert's formulas for the irradiance below the middle of each; half of it over π comes back, of a radiance of three.
    let sphere = "[[object]]\nsphere = { center = [0, 5, 0], radius = 2 }\nmaterial = 'lamp'";
    let disk = "[[object]]\ndisk = { center = [0, 3, 0], normal = [0, -1, 0], radius = 2 }\nmaterial = 'lamp'";
    let rectangle =
        "[[object]]\nrectangle = { corner = [0, 3, 0], edge_u = [2, 0, 0], edge_v = [0, 0, 4] }\nmaterial = 'lamp'";
    let corner = |a: f64, b: f64, h: f64| {
        let (x, y) = ((a * a + h * h).sqrt(), (b * b + h * h).sqrt());
        0.5 * (a / x * portable::atan(b / x) + b / y * portable::atan(a / y))
    };
    let polygon = "[[object]]\nmesh = { vertices = [[-1, 2, -1], [2, 3, -1], [1, 4, 3]], faces = [[0, 1, 2]] }\nmaterial = 'lamp'";
    let sides =
        [[-1.0, 2.0, -1.0], [2.0, 3.0, -1.0], [1.0, 4.0, 3.0]].map(|[x, y, z]| Vector3::new(x, y, z).normalize());
    let side = |i: usize| {
        let (from, to) = (sides[i], sides[(i + 1) % 3]);
        let normal = from.cross(to);
        0.5 * portable::atan2(normal.length(), from.dot(to)) * normal.normalize().y()
    };
    let expected = [PI * 4.0 / 25.0, PI * 4.0 / 13.0, corner(2.0, 4.0, 3.0), (side(0) + side(1) + side(2)).abs()];
    for (light, irradiance) in [sphere, disk, rectangle, polygon].into_iter().zip(expected) {
        let (found, error) = mean(&floor(light).picture_by_paths(&samples(64)));
        let expected = 3.0 * irradiance * 0.5 / PI;
        assert!(error < 0.01 * expected, "{error}");
        assert_near(found, expected, 4.0 * error + 0.002 * expected);
        must_fail("a light a twentieth brighter", || {
            assert_near(found, 1.05 * expected, 4.0 * error + 0.002 * expected)
        });
    }
}

#[test]
fn a_mesh_and_a_rectangle_shine_alike() {
    let mesh = "[[object]]\nmesh = { vertices = [[-1, 3, -2], [1, 3, -2], [1, 3, 2], [-1, 3, 2]], faces = [[0, 1, 2], [0, 2, 3]] }\nmaterial = 'lamp'";
    let rectangle =
        "[[object]]\nrectangle = { corner = [-1, 3, -2], edge_u = [2, 0, 0], edge_v = [0, 0, 4] }\nmaterial = 'lamp'";
    let [(mesh, first), (rectangle, second)] =
        [mesh, rectangle].map(|light| mean(&floor(light).picture_by_paths(&samples(64))));
    assert_near(mesh, f64::from(rectangle.g), 4.0 * (first + second) + 0.001);
}

#[test]
fn lights_without_extent_are_as_bright_as_the_lectures() {
    let lights = [
        "[[light]]\npoint = { position = [1, 2, 0], intensity = 0.7, falloff = 'none' }",
        "[[light]]\npoint = { position = [1, 2, 0], intensity = 3, falloff = 'inverse-square' }",
        "[[light]]\ndirectional = { direction = [1, -2, 0.5], intensity = 0.6 }",
        "[[light]]\nspot = { position = [1, 2, 0], direction = [-1, -2, 0], cone_angle = 40, intensity = 0.8 }",
    ];
    for light in lights {
        let stage = floor(light);
        let (found, _) = mean(&stage.picture_by_paths(&samples(256)));
        // What `whitted` shows, less the ambient term, which stands for light that paths find.
        let expected = f64::from(mean(&stage.picture()).0.g) - 0.5;
        assert_near(found, expected, 0.004 * expected);
        must_fail("a light without the lecture's units", || assert_near(found, expected / PI, 0.004 * expected));
    }
}

/// What a furnace of radiance one shows: any arrangement that loses no light is invisible in it.
fn furnace(materials_and_objects: &str) -> Stage {
    let text = format!(
        r"
        [camera]
        eye = [0, 0, 5]
        look_at = [0, 0, 0]
        fov = 20
        [background]
        color = 1
        {materials_and_objects}
        "
    );
    Stage::new(&text).sized(24, 24)
}

#[test]
fn what_loses_no_light_is_invisible_in_a_white_world() {
    let arrangements = [
        ("glass", "[material.a]\ndielectric = { ior = 1.5 }\n[[object]]\nsphere = { radius = 1 }\nmaterial = 'a'"),
        (
            "dispersive glass",
            "[material.a]\ndielectric = { ior = 'SF11' }\n[[object]]\nsphere = { radius = 1 }\nmaterial = 'a'",
        ),
        ("mirror", "[material.a]\nmirror = 1\n[[object]]\nsphere = { radius = 1 }\nmaterial = 'a'"),
        ("matt", "[material.a]\ndiffuse = 1\n[[object]]\nsphere = { radius = 1 }\nmaterial = 'a'"),
        (
            "a bubble in glass in water",
            "[material.a]\ndielectric = { ior = 1.33 }\n[material.b]\ndielectric = { ior = 1.5 }\n\
             [material.c]\ndielectric = { ior = 1 }\n[[object]]\nsphere = { radius = 1 }\nmaterial = 'a'\n\
             [[object]]\nsphere = { radius = 0.7 }\nmaterial = 'b'\n[[object]]\nsphere = { radius = 0.4 }\nmaterial = 'c'",
        ),
        (
            "overlapping by priority",
            "[material.a]\ndielectric = { ior = 1.33, priority = 1 }\n[material.b]\ndielectric = { ior = 1.5, priority = 2 }\n\
             [[object]]\nsphere = { radius = 0.9, center = [-0.2, 0, 0] }\nmaterial = 'a'\n\
             [[object]]\nsphere = { radius = 0.7, center = [0.4, 0, 0] }\nmaterial = 'b'",
        ),
        (
            "frosted glass",
            "[material.a]\ndielectric = { ior = 1.5, roughness = 0.6 }\n[[object]]\nsphere = { radius = 1 }\nmaterial = 'a'",
        ),
        (
            "frosted water in frosted glass",
            "[material.a]\ndielectric = { ior = 1.5, roughness = 0.3 }\n[material.b]\ndielectric = { ior = 1.33, roughness = 0.8 }\n\
             [[object]]\nsphere = { radius = 1 }\nmaterial = 'a'\n[[object]]\nsphere = { radius = 0.7 }\nmaterial = 'b'",
        ),
        (
            "brushed metal",
            "[material.a]\nmetal = { color = 1, roughness = 0.7 }\n[[object]]\nsphere = { radius = 1 }\nmaterial = 'a'",
        ),
        (
            "a soap bubble",
            "[material.a]\ndielectric = { ior = 1, film = { thickness = 420, ior = 1.33 } }\n\
             [[object]]\nsphere = { radius = 1 }\nmaterial = 'a'",
        ),
        (
            "grey milk",
            "[material.a]\ndielectric = { ior = 1.3, scattering = { distance = 0.4 } }\n[[object]]\nsphere = { radius = 0.8 }\nmaterial = 'a'",
        ),
        (
            "coloured milk",
            "[material.a]\ndielectric = { ior = 1.3, scattering = { distance = 0.4, color = [0.4, 0.7, 1] } }\n[[object]]\nsphere = { radius = 0.8 }\nmaterial = 'a'",
        ),
        (
            "coloured fog",
            "[material.a]\ndielectric = { ior = 1, scattering = { distance = 0.4, color = [0.4, 0.7, 1], anisotropy = 0.5 } }\n\
             [[object]]\nsphere = { radius = 0.8 }\nmaterial = 'a'",
        ),
    ];
    let empty = furnace("[[object]]\nsphere = { radius = 0.001, center = [9, 9, 9] }").picture_by_paths(&samples(64));
    for (name, arrangement) in arrangements {
        let stage = furnace(arrangement);
        let image = stage.picture_by_paths(&PathSettings { depth: 1000, ..samples(64) });
        // The same wavelengths with and without what is in the way: their noise is not the arrangement's.
        let ((found, _), (expected, _)) = (mean(&image), mean(&empty));
        // Where wavelengths part, or are scattered each in its own way, there is noise of colour.
        let tolerance = match name {
            "dispersive glass" => 0.02,
            "coloured milk" | "coloured fog" => 0.01,
            "frosted glass" | "frosted water in frosted glass" | "brushed metal" => 4e-3,
            _ => 1e-3,
        };
        for (found, expected) in found.to_array().into_iter().zip(expected.to_array()) {
            assert!((found - expected).abs() < tolerance, "{name}: {found}, not {expected}");
        }
    }
    let gray = furnace(
        "[material.a]\ndielectric = { ior = 1.5, transmit = 0.95 }\n[[object]]\nsphere = { radius = 1 }\nmaterial = 'a'",
    );
    let (found, _) = mean(&gray.picture_by_paths(&samples(64)));
    must_fail("glass that keeps a twentieth", || assert_near(found, 1.0, 3e-3));
}

#[test]
fn an_enclosure_shines_by_the_sum_of_all_its_reflections() {
    let text = "[camera]\neye = [0.3, 0.1, 0]\nlook_at = [1, 0, 0]\nfov = 60\n[material.wall]\nemission = 0.2\ndiffuse = 0.6\n\
                [[object]]\nsphere = { radius = 2 }\nmaterial = 'wall'";
    let stage = Stage::new(text).sized(16, 16);
    let (found, error) = mean(&stage.picture_by_paths(&samples(64)));
    assert_near(found, 0.2 / (1.0 - 0.6), 4.0 * error + 0.002);
    must_fail("one reflection only", || assert_near(found, 0.2 * 1.6, 4.0 * error + 0.002));
}

/// A glass ball under a large light over a floor: its caustic can be found from both ends.
fn caustic() -> Stage {
    let text = r#"
        [camera]
        eye = [0, 3, 4]
        look_at = [0.2, 0, 0.2]
        fov = 22
        [material.lamp]
        emission = 4
        [material.floor]
        diffuse = 0.7
        [material.glass]
        dielectric = { ior = 1.5, absorption = { color = [0.7, 0.9, 0.95], distance = 1 } }
        [[object]]
        plane = { y = 0 }
        material = "floor"
        [[object]]
        sphere = { center = [0, 1, 0], radius = 0.7 }
        material = "glass"
        [[object]]
        sphere = { center = [-1, 4, 0], radius = 0.8 }
        material = "lamp"
    "#;
    Stage::new(text).sized(24, 18)
}

#[test]
fn photons_and_paths_agree() {
    // Finer than elsewhere: photons are gathered from disks of some pixels, which blurs what is smaller.
    let stage = caustic().sized(64, 48);
    let with = stage.picture_by_paths(&samples(64));
    let without = stage.picture_by_paths(&PathSettings { photons: false, ..samples(512) });
    let ((with_mean, _), (without_mean, _)) = (mean(&with), mean(&without));
    let tolerance = 0.01 * f64::from(without_mean.g);
    for (a, b) in with_mean.to_array().into_iter().zip(without_mean.to_array()) {
        assert!((f64::from(a) - f64::from(b)).abs() < tolerance, "{with_mean:?} {without_mean:?}");
    }
    // And where the caustic is brightest.
    let brightest =
        (0..without.pixels().len()).max_by(|&a, &b| without.pixels()[a].g.total_cmp(&without.pixels()[b].g));
    let at = brightest.expect("there are pixels");
    let (a, b) = (with.pixels()[at].g, without.pixels()[at].g);
    assert!((a - b).abs() < 0.1 * b, "{a} {b}");
    let half = Stage::new("[[object]]\nsphere = { radius = 1 }\n[background]\ncolor = 1").sized(4, 4);
    let (other, _) = mean(&half.picture_by_paths(&samples(4)));
    must_fail("another scene", || assert_near(other, f64::from(without_mean.g), tolerance));
}

/// A milky ball in a lamp's light: what is inside is lit by refraction alone.
fn milk(light: &str) -> Stage {
    let text = format!(
        r#"
        [camera]
        eye = [0, 2, 4]
        look_at = [0, 0, 0]
        fov = 30
        [material.lamp]
        emission = 4
        [material.milk]
        dielectric = {{ ior = 1.3, scattering = {{ distance = 0.4, color = [0.5, 0.7, 0.9], anisotropy = 0.3 }} }}
        [[object]]
        sphere = {{ radius = 1 }}
        material = "milk"
        {light}
    "#
    );
    Stage::new(&text).sized(32, 24)
}

#[test]
fn photons_and_paths_agree_in_a_medium() {
    // Small enough for photons, large enough for paths. Balls that photons are gathered from reach beyond the surface, where there are none:
    // less so the smaller a pixel is.
    let stage = milk("[[object]]\nsphere = { center = [-2, 3, 0], radius = 0.2 }\nmaterial = 'lamp'").sized(160, 120);
    let with = mean(&stage.picture_by_paths(&samples(64))).0;
    let without = mean(&stage.picture_by_paths(&PathSettings { photons: false, ..samples(192) })).0;
    let near = |factor: f32| assert!((with.g * factor - without.g).abs() < 0.04 * without.g, "{with:?} {without:?}");
    near(1.0);
    must_fail("a tenth is missing", || near(0.9));
}

#[test]
fn a_point_lights_the_inside_of_milk_as_a_small_ball_does() {
    // A ball of radiance L and radius r has the intensity π r² L; the lecture's is π times less.
    let point = milk("[[light]]\npoint = { position = [-2, 3, 0], intensity = 4.0, falloff = 'inverse-square' }");
    let ball = milk("[[object]]\nsphere = { center = [-2, 3, 0], radius = 0.05 }\nmaterial = { emission = 1600 }");
    let dark = PathSettings { photons: false, ..samples(16) };
    let (point_image, ball_image) = (point.picture_by_paths(&samples(128)), ball.picture_by_paths(&samples(128)));
    // In the ball's middle, where nothing mirrors the light.
    let middle = |image: &Image<Rgb>| {
        let pixels = (8..16).flat_map(|y| (12..20).map(move |x| [x, y]));
        pixels.map(|[x, y]| f64::from(image.get(x, y).expect("a pixel").g)).sum::<f64>() / 64.0
    };
    let (found, expected) = (middle(&point_image), middle(&ball_image));
    assert!((found - expected).abs() < 0.03 * expected, "{found} {expected}");
    assert!(middle(&point.picture_by_paths(&dark)) < 1e-9, "no path meets a point");
}

#[test]
fn no_thread_tile_or_instruction_changes_a_bit() {
    let stage = caustic();
    let paths = samples(3);
    let expected = stage.picture_by_paths(&paths);
    let mut others = vec![
        RenderSettings { tile_size: 7, ..stage.settings.clone() },
        RenderSettings { threads: Some(1), ..stage.settings.clone() },
        RenderSettings { threads: Some(3), tile_size: 5, ..stage.settings.clone() },
    ];
    for instructions in InstructionSet::available() {
        others.push(RenderSettings { instructions, ..stage.settings.clone() });
    }
    for settings in others {
        let found = render_paths(&stage.scene, &settings, &paths, &NoProgress).expect("a camera").image;
        assert!(found == expected, "{settings:?}");
    }
    let seeded = stage.picture_by_paths(&PathSettings { seed: 1, ..paths });
    assert!(seeded != expected, "another seed gives other noise");
}

#[test]
fn a_path_is_explained_by_the_shares_of_its_sample() {
    let stage = caustic();
    let paths = samples(1);
    let image = stage.picture_by_paths(&paths);
    let mut with_photons = 0;
    for y in 0..18 {
        for x in 0..24 {
            let tree = explain_path(&stage.scene, &stage.settings, &paths, [x, y], 0).expect("a camera");
            let mut film = snell::film::PixelSum::default();
            assert!(film.add(tree.sum()));
            assert_eq!(Some(&film.mean()), image.get(x, y), "pixel {x}, {y}");
            with_photons += usize::from(tree.shares.iter().any(|share| share.term == snell::task::Term::Photons));
        }
    }
    assert!(with_photons > 5, "{with_photons}");
}

#[test]
fn a_target_of_noise_ends_and_is_kept() {
    let stage = caustic();
    let noise = Some(0.05);
    let settings = PathSettings { samples: 4096, noise, ..PathSettings::default() };
    let rendering = render_paths(&stage.scene, &stage.settings, &settings, &NoProgress).expect("a camera");
    let pixels = 24 * 18;
    let mean = rendering.statistics.camera_rays / pixels;
    assert!((16..4096).contains(&mean), "{mean} samples in a pixel");
    let fine = stage.picture_by_paths(&PathSettings { seed: 9, ..samples(512) });
    let errors = rendering.image.pixels().iter().zip(fine.pixels());
    let squares: f64 = errors.map(|(a, b)| square(f64::from(a.g - b.g) / f64::from(b.g.max(0.05)))).sum();
    let error = (squares / pixels as f64).sqrt();
    assert!(error < 0.08, "{error}");
}
