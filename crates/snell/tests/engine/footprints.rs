//! Pictures on surfaces and in the background are averaged over what a ray stands for: by closed forms, and against pictures of
//! very many rays.

use std::sync::Arc;

use snell::differential::RayDifferential;
use snell::image::{BitDepth, DisplayImage, Image, PngOptions, ToneCurve, encode_png};
use snell::interaction::Surroundings;
use snell::math::lanes::InstructionSet;
use snell::math::{Point3, Ray, Rgb, Vector3, portable};
use snell::render::PathSettings;
use snell::scene::Table;
use snell::scene::scene::{Antialiasing, ImageAsset};
use snell_testkit::{TestRng, must_fail};

use crate::files::scene_of_text;
use crate::stage::Stage;

/// A scene in which the picture that it names is another one.
fn stage_with(text: &str, picture: &Image<Rgb>) -> Stage {
    let display = DisplayImage::develop(picture, ToneCurve::None, 0.0, BitDepth::Eight);
    let png: Arc<[u8]> = encode_png(&display, &PngOptions::default()).expect("a small picture").into();
    let mut scene = scene_of_text("test.toml", text.as_bytes());
    let mut images = Table::default();
    for asset in scene.images.iter() {
        images.push(ImageAsset { bytes: Arc::clone(&png), ..asset.clone() });
    }
    scene.images = images;
    Stage::of(&scene)
}

/// A scene whose picture is white noise: nothing but detail.
fn stage(text: &str) -> Stage {
    let mut rng = TestRng::new(5);
    let mut noise = Image::filled(64, 64, Rgb::BLACK);
    noise.pixels_mut().iter_mut().for_each(|pixel| *pixel = if rng.coin() { Rgb::BLACK } else { Rgb::WHITE });
    stage_with(text, &noise)
}

/// What the neighbours of a ray meet first.
#[track_caller]
fn surroundings(stage: &Stage, ray: &Ray, differential: &RayDifferential) -> Surroundings {
    let scene = &stage.scene;
    let hit = scene.geometry.intersect(ray, f64::INFINITY, &mut Default::default()).expect("it meets something");
    scene.surroundings(ray, &hit, &scene.interaction(ray, &hit), differential)
}

#[track_caller]
fn assert_close(found: f64, expected: f64, what: &str) {
    assert!((found - expected).abs() <= 1e-3 * expected.abs(), "{what}: {found}, expected {expected}");
}

/// A beam of parallel rays of a small width along `direction`, aimed at a point: its first side is in the plane of `direction`
/// and y.
fn beam(at: Point3, direction: Vector3, width: f64) -> (Ray, RayDifferential) {
    let across = direction.cross(Vector3::Y).normalize();
    let origin = [across.cross(direction) * width, across * width];
    (Ray::new(at - direction * 5.0, direction), RayDifferential { origin, ..RayDifferential::NONE })
}

const PRINTED: &str =
    "[material.printed]\ndiffuse = { image = { file = \"scenes/images/page.png\" }, space = \"world\" }\n";

#[test]
fn a_floor_is_seen_as_far_as_the_pixel_reaches() {
    let text = PRINTED.to_owned()
        + "[image]\nwidth = 100\nheight = 100\n[camera]\neye = [0, 1, 0]\nlook_at = [0, 0, -3]\nfov = 2\n\
        [[object]]\nplane = { y = 0 }\nmaterial = \"printed\"\n";
    let stage = stage(&text);
    let camera = stage.settings.camera(&stage.scene).expect("a camera");
    let (ray, differential) = (camera.generate_ray(50.0, 50.0), camera.ray_differential(50.0, 50.0, 1.0));
    let [right, below] = surroundings(&stage, &ray, &differential).footprint.world;
    let distance = 10.0_f64.sqrt();
    // In the middle of a narrow view, pixels are as wide as their angle; a floor under the angle a is 1 / sin a times as long.
    let width = distance * camera.pixel_angle();
    assert_close(right.length(), width, "across");
    assert_close(below.length(), width * distance, "along");
    assert!(below.z() > 0.0 && right.x() > 0.0 && right.y().abs() + below.y().abs() < 1e-12);
    must_fail("a floor seen as if from above", || assert_close(below.length(), width, "along"));
    // Twice the rays each way stand for half as much each.
    let [half, _] = surroundings(&stage, &ray, &camera.ray_differential(50.0, 50.0, 0.5)).footprint.world;
    assert_close(half.length(), 0.5 * width, "half");
}

#[test]
fn a_mirror_ball_spreads_rays_by_its_curvature() {
    let text = PRINTED.to_owned()
        + "[material.mirror]\nmirror = 1\n\
        [[object]]\nplane = { y = -9 }\nmaterial = \"printed\"\n[[object]]\nsphere = { radius = 2 }\nmaterial = \"mirror\"\n";
    let stage = stage(&text);
    for degrees in [10.0_f64, 45.0, 70.0] {
        let angle = portable::radians(degrees);
        let (sine, cosine) = (portable::sin(angle), portable::cos(angle));
        let direction = -Vector3::Z;
        let (ray, differential) = beam(Point3::new(0.0, 2.0 * sine, 2.0 * cosine), direction, 1e-3);
        let [up, across] = surroundings(&stage, &ray, &differential).differential.reflected(direction).direction;
        // Coddington's equations for a mirror: 2 / (R cos i) in the plane of incidence, 2 cos i / R across.
        assert_close(up.length(), 1e-3 * 2.0 / (2.0 * cosine), "in the plane");
        assert_close(across.length(), 1e-3 * 2.0 * cosine / 2.0, "across");
        must_fail("a flat mirror", || assert_close(0.0, up.length(), "in the plane"));
    }
}

#[test]
fn refraction_turns_neighbours_by_snells_law() {
    let text = PRINTED.to_owned()
        + "[material.glass]\ndielectric = { ior = 1.5 }\n\
        [[object]]\nplane = { y = -9 }\nmaterial = \"printed\"\n\
        [[object]]\nbox = { min = [-50, -2, -50], max = [50, 0, 50] }\nmaterial = \"glass\"\n";
    let stage = stage(&text);
    let (small, eta) = (1e-4, 1.0 / 1.5);
    for degrees in [5.0_f64, 40.0, 75.0] {
        let angle = portable::radians(degrees);
        let (sine, cosine) = (portable::sin(angle), portable::cos(angle));
        let direction = Vector3::new(0.0, -cosine, -sine);
        let steeper = Vector3::new(0.0, sine, -cosine);
        let differential =
            RayDifferential { direction: [steeper * small, Vector3::X * small], ..RayDifferential::NONE };
        let ray = Ray::new(Point3::ORIGIN - direction * 4.0, direction);
        let around = surroundings(&stage, &ray, &differential).differential;
        let turned = around.refracted(direction, eta);
        // The derivative of sin i = 1.5 sin r; across, tangents keep their ratio to the sines.
        let beyond = (1.0 - eta * eta * sine * sine).sqrt();
        assert_close(turned.direction[0].length(), small * eta * cosine / beyond, "in the plane");
        assert_close(turned.direction[1].length(), small * eta, "across");
        assert_close(turned.origin[0].length(), small * 4.0 / cosine, "on the surface");
        must_fail("no bending", || assert_close(small, turned.direction[0].length(), "in the plane"));
    }
}

/// The root mean square of the differences of some pixels.
fn error(a: &[Rgb], b: &[Rgb]) -> f64 {
    let sum: f64 = a.iter().zip(b).map(|(a, b)| f64::from((*a - *b).g)).map(|difference| difference * difference).sum();
    (sum / a.len() as f64).sqrt()
}

/// A picture of one ray in each pixel, with footprints and without, and one of 256.
fn three_pictures(stage: &mut Stage) -> [Vec<Rgb>; 3] {
    let one = stage.picture().pixels().to_vec();
    let sharp = stage.trees().map(|(_, tree)| tree.sum()).collect();
    stage.settings.antialiasing = Antialiasing::Samples(256);
    let many = stage.picture().pixels().to_vec();
    stage.settings.antialiasing = Antialiasing::None;
    [one, sharp, many]
}

const ROOM: &str =
    "ambient = 1\n[image]\nwidth = 64\nheight = 40\n[camera]\neye = [0, 1, 0]\nlook_at = [0, 0.6, -2]\nfov = 60\n";

#[test]
fn a_receding_floor_is_smooth_with_one_ray_a_pixel() {
    for space in ["world", "object", "uv"] {
        let text = ROOM.to_owned()
            + "[material.printed]\ndiffuse = { image = { file = \"scenes/images/page.png\" }, space = \""
            + space
            + "\", rotate = [90, 0, 0] }\n\
            [[object]]\nplane = { y = 0 }\nmaterial = \"printed\"\n";
        let text = if space == "uv" { text.replace(", rotate = [90, 0, 0]", "") } else { text };
        let [one, sharp, many] = three_pictures(&mut stage(&text));
        assert!(error(&one, &many) < 0.04, "{space}: {}", error(&one, &many));
        must_fail("points instead of footprints", || assert!(error(&sharp, &many) < 0.1));
    }
}

#[test]
fn mirrors_glass_and_the_sky_are_smooth_with_one_ray_a_pixel() {
    let floor = "[material.printed]\ndiffuse = { image = { file = \"scenes/images/page.png\" }, space = \"world\", rotate = [90, 0, 0] }\n\
        [[object]]\nplane = { y = 0 }\nmaterial = \"printed\"\n";
    let ball = "[camera]\neye = [0, 1.5, 3]\nlook_at = [0, 1, 0]\nfov = 20\n[[object]]\nsphere = { center = [0, 1, 0], radius = 0.9 }\n";
    let cases = [
        ("mirror ball", floor.to_owned() + ball + "material = \"shiny\"\n[material.shiny]\nmirror = 1\n", 0.05),
        (
            "glass ball",
            floor.to_owned() + ball + "material = \"clear\"\n[material.clear]\ndielectric = { ior = 1.5 }\n",
            0.06,
        ),
        (
            "sky",
            "[background]\npanorama = { file = \"scenes/images/page.png\" }\n[camera]\nfov = 150\n".to_owned(),
            0.05,
        ),
        (
            "sky in a ball",
            "[background]\npanorama = { file = \"scenes/images/page.png\" }\n".to_owned()
                + ball
                + "material = \"shiny\"\n[material.shiny]\nmirror = 1\n",
            0.08,
        ),
    ];
    for (what, text, limit) in cases {
        // The sky has 64 pixels all around.
        let size = if what.starts_with("sky") { [10, 8] } else { [40, 32] };
        let mut stage = stage(&format!("ambient = 1\n{text}")).sized(size[0], size[1]);
        let [one, sharp, many] = three_pictures(&mut stage);
        let (found, without) = (error(&one, &many), error(&sharp, &many));
        assert!(found < limit, "{what}: {found} against {without}");
        must_fail("points instead of footprints", || assert!(without < limit));
    }
}

#[test]
fn a_picture_of_one_colour_is_that_colour_everywhere() {
    let white = Image::filled(37, 21, Rgb::gray(0.3));
    let text = ROOM.to_owned()
        + PRINTED
        + "[background]\npanorama = { file = \"scenes/images/page.png\" }\n\
        [[object]]\nplane = { y = 0 }\nmaterial = \"printed\"\n";
    let stage = stage_with(&text, &white);
    let picture = stage.picture();
    let first = picture.pixels()[0];
    assert!(
        picture.pixels().iter().all(|pixel| pixel.to_array().map(f32::to_bits) == first.to_array().map(f32::to_bits))
    );
    assert!((first.g - 0.3).abs() < 0.01);
}

/// A printed floor, seen straight, in a mirror mesh with normals, through glass, and through a boundary without effect.
fn everything() -> String {
    ROOM.to_owned()
        + PRINTED
        + "[background]\npanorama = { file = \"scenes/images/page.png\" }\n\
        [[light]]\npoint = { position = [1, 4, 2] }\n\
        [material.shiny]\nmirror = 0.8\n[material.clear]\ndielectric = { ior = \"N-BK7\" }\n\
        [material.under]\ndielectric = { ior = 1.3, priority = -1 }\n\
        [[object]]\nplane = { y = 0 }\nmaterial = \"printed\"\n\
        [[object]]\nsphere = { center = [-0.6, 0.6, -2], radius = 0.5 }\nmaterial = \"clear\"\n\
        [[object]]\nsphere = { center = [-0.3, 0.6, -2], radius = 0.5 }\nmaterial = \"under\"\n\
        [[object]]\ntorus = { center = [0.9, 0.6, -2.5], major_radius = 0.5, minor_radius = 0.2 }\nmaterial = \"shiny\"\n\
        rotate = [60, 10, 0]\n"
}

#[test]
fn threads_and_instructions_change_no_bit() {
    let mut stage = stage(&everything());
    stage.settings.antialiasing = Antialiasing::Adaptive;
    let bits = |image: &Image<Rgb>| -> Vec<[u32; 3]> {
        image.pixels().iter().map(|color| color.to_array().map(f32::to_bits)).collect()
    };
    let paths = PathSettings { samples: 3, ..PathSettings::default() };
    let pictures = |stage: &Stage| {
        let traced = stage.picture_by_paths(&paths);
        (bits(&stage.picture()), bits(&traced))
    };
    (stage.settings.threads, stage.settings.instructions) = (Some(1), InstructionSet::Scalar);
    let alone = pictures(&stage);
    for (threads, tile_size) in [(1, 8), (2, 32), (7, 5)] {
        (stage.settings.threads, stage.settings.tile_size) = (Some(threads), tile_size);
        stage.settings.instructions = InstructionSet::best();
        assert!(pictures(&stage) == alone, "{threads} threads, tiles of {tile_size}");
    }
    must_fail("other footprints", || {
        stage.settings.antialiasing = Antialiasing::Samples(16);
        assert!(pictures(&stage) == alone);
    });
}
