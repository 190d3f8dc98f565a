//! Real lenses in front of cameras: as bright as thin ones, sharp where they are focused, the same on any number of threads.

use snell::image::Image;
use snell::math::Rgb;
use snell::render::PathSettings;
use snell_testkit::must_fail;

use crate::stage::Stage;

fn trace(stage: &Stage, samples: u32) -> Image<Rgb> {
    let paths = PathSettings { samples, ..PathSettings::default() };
    stage.picture_by_paths(&paths)
}

/// A scene with unequal quarters: a lamp in one, a coloured wall, before a camera with some lens.
fn scene(camera: &str) -> Stage {
    let text = format!(
        "unit = 'cm'\n[camera]\neye = [0, 0, 200]\nlook_at = [0, 0, 0]\n{camera}\n\
         [background]\ncolor = [0.2, 0.5, 0.3]\n\
         [material.lamp]\nemission = [4, 2, 1]\n\
         [material.wall]\nemission = {{ checker = {{ colors = [0.9, 0.1], size = 30 }} }}\n\
         [[object]]\nrectangle = {{ corner = [-60, -40, 0], edge_u = [80, 0, 0], edge_v = [0, 80, 0] }}\nmaterial = 'wall'\n\
         [[object]]\nsphere = {{ center = [9, 6, 40], radius = 3 }}\nmaterial = 'lamp'\n"
    );
    Stage::new(&text).sized(36, 24)
}

/// The mean of each of four by four parts.
fn parts(image: &Image<Rgb>) -> Vec<Rgb> {
    let (w, h) = (image.width() / 4, image.height() / 4);
    let part = |i: u32| {
        let (left, top) = (i % 4 * w, i / 4 * h);
        let pixels = (0..w * h).map(|p| *image.get(left + p % w, top + p / w).expect("inside"));
        pixels.fold(Rgb::BLACK, |sum, color| sum + color) * (1.0 / (w * h) as f32)
    };
    (0..16).map(part).collect()
}

#[track_caller]
fn assert_alike(first: &[Rgb], second: &[Rgb], tolerance: f32) {
    for (i, (a, b)) in first.iter().zip(second).enumerate() {
        assert!((*a - *b).max_abs() <= tolerance, "part {i}: {a:?}, {b:?}");
    }
}

#[test]
fn a_real_lens_shows_what_a_thin_one_of_its_focal_length_and_f_number_shows() {
    // Far from the focal length; the corners are darker by cos⁴ of at most 6°, and the film is small so that faults are.
    let real = scene("lens = { of = 'double-gauss', f_number = 4, film = 10 }");
    let camera = &real.scene.camera;
    let snell::scene::scene::Frame::HorizontalFov(fov) = camera.frame else { panic!() };
    // f = 50.36 mm at f/4.
    let thin = scene(&format!("fov = {}\nlens = {{ radius = {} }}", fov.to_degrees(), 0.1 * 50.36 / 8.0));
    let (real, thin) = (parts(&trace(&real, 256)), parts(&trace(&thin, 256)));
    assert_alike(&real, &thin, 0.12);
    must_fail("a picture that is upside down", || {
        assert_alike(&real.iter().rev().copied().collect::<Vec<_>>(), &thin, 0.12)
    });
    must_fail("a picture a third brighter", || {
        assert_alike(&real.iter().map(|color| *color * 1.33).collect::<Vec<_>>(), &thin, 0.12)
    });
}

#[test]
fn corners_are_darker_by_the_cosine_and_by_the_rims() {
    let white = |lens: &str| {
        let text = format!("unit = 'cm'\n[camera]\nlook_at = [0, 0, -500]\n{lens}\n[background]\ncolor = 1\n");
        trace(&Stage::new(&text).sized(18, 12), 256)
    };
    let at = |image: &Image<Rgb>, x, y| f64::from(image.get(x, y).expect("inside").g);
    let closed = white("lens = { of = 'double-gauss', f_number = 11 }");
    assert!((at(&closed, 9, 6) - 1.0).abs() < 0.03, "{}", at(&closed, 9, 6));
    // By cos⁴ of the angle at which the exit pupil is seen from there.
    let (corner, open) = (at(&closed, 0, 0), white("lens = 'double-gauss'"));
    assert!((0.7..0.97).contains(&corner), "{corner}");
    // Wide open, rims cut off more.
    assert!(at(&open, 0, 0) < 0.85 * corner, "{} {corner}", at(&open, 0, 0));
    // The middle of the film, without what is noise of one pixel.
    let middle = white("lens = { of = 'double-gauss', film = 2 }");
    let count = middle.pixels().len() as f64;
    let mean = middle.pixels().iter().map(|color| f64::from(color.g)).sum::<f64>() / count;
    let check = |mean: f64| assert!((mean - 1.0).abs() < 0.01, "{mean}");
    check(mean);
    must_fail("a fiftieth too bright", || check(1.02 * mean));
}

#[test]
fn threads_change_no_bit() {
    let image = |threads| {
        let mut stage = scene("lens = { of = 'double-gauss', film = 30, blades = 7 }");
        (stage.settings.threads, stage.settings.tile_size) = (Some(threads), if threads == 1 { 7 } else { 32 });
        trace(&stage, 5)
    };
    let one = image(1);
    assert_eq!(one.pixels(), image(3).pixels());
    assert_ne!(one.pixels(), trace(&scene("lens = { of = 'double-gauss', film = 30, blades = 6 }"), 5).pixels());
}

#[test]
fn whitted_has_a_pinhole_with_the_same_view() {
    let real = scene("lens = { of = 'double-gauss', f_number = 16, film = 20 }");
    let pinhole = parts(&real.picture());
    // Emission is the same in both; the lens darkens corners by cos⁴ of 11°.
    assert_alike(&parts(&trace(&real, 64)), &pinhole, 0.12);
}
