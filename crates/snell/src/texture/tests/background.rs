//! Backgrounds: the conventions of panorama, photograph and gradient, pinned by known directions.

use std::f64::consts::{PI, TAU};
use std::sync::Arc;

use proptest::prelude::*;
use snell_math::{Rgb, Transform, Vector3, portable};
use snell_scene::Id;
use snell_scene::scene;

use super::{NASTY, picture};
use crate::texture::{Background, BackgroundError, RampError, SeenAtOnce, TextureImage, ViewProjection};

fn view() -> ViewProjection {
    ViewProjection { u: Vector3::X, v: Vector3::Y, w: Vector3::Z, left: -1.0, right: 1.0, bottom: -0.5, top: 0.5 }
}

fn panorama(image: TextureImage, rotation: f64) -> Background {
    let background = scene::Background::Panorama { image: Id::from_index(0), intensity: 1.0, rotation };
    Background::compile(&background, &[Arc::new(image)]).unwrap()
}

fn photograph(image: TextureImage, intensity: f32) -> Background {
    let background = scene::Background::Photograph { image: Id::from_index(0), intensity };
    Background::compile(&background, &[Arc::new(image)]).unwrap()
}

/// The direction at a place of a panorama (x to the right, y down, in [0, 1]²): the convention written the other way.
fn direction(x: f64, y: f64) -> Vector3 {
    let (azimuth, polar) = (TAU * (x - 0.5), PI * y);
    let flat = portable::sin(polar);
    Vector3::new(flat * portable::sin(azimuth), portable::cos(polar), -flat * portable::cos(azimuth))
}

#[test]
fn axes_see_the_middles_of_their_sides() {
    // Five columns would put no centre at +x; eight put borders there, so the mean of two neighbours is seen. Odd rows put a
    // centre on the horizon.
    let image = picture(8, 5);
    let seen = |x: Vector3| panorama(image.clone(), 0.0).evaluate(x, &SeenAtOnce::POINT, &view());
    let between = |a, b| image.pixel(a, 2).lerp(image.pixel(b, 2), 0.5);
    assert_eq!(seen(Vector3::new(0.0, 0.0, -1.0)), between(3, 4));
    assert_eq!(seen(Vector3::X), between(5, 6));
    assert_eq!(seen(Vector3::Z), between(7, 0));
    assert_eq!(seen(-Vector3::X), between(1, 2));
    // The poles are the means of the outermost rows.
    let mean = |y| (0..8).fold(Rgb::BLACK, |sum, x| sum + image.pixel(x, y)) / 8.0;
    assert_eq!(seen(Vector3::Y), mean(0));
    assert_eq!(seen(-Vector3::Y), mean(4));
}

#[test]
fn quarter_turns_are_counter_clockwise_from_above() {
    let image = picture(8, 5);
    let seen = |rotation, direction| panorama(image.clone(), rotation).evaluate(direction, &SeenAtOnce::POINT, &view());
    let ahead = seen(0.0, Vector3::new(0.0, 0.0, -1.0));
    // From above, with −z up on the page and +x to the right, ahead turns to the left.
    let near = |a: Rgb, b: Rgb| (a - b).max_abs() < 1e-5;
    assert!(near(seen(0.5 * PI, -Vector3::X), ahead));
    assert!(near(seen(PI, Vector3::Z), ahead));
    assert!(near(seen(-0.5 * PI, Vector3::X), ahead));
    // The twin: the other sense is not the same.
    assert!(!near(seen(0.5 * PI, Vector3::X), ahead));
}

#[test]
fn the_poles_are_continuous() {
    // All azimuths agree more and more towards a pole, though the rows differ wildly along themselves.
    let panorama = panorama(picture(16, 8), 0.3);
    for (pole, sign) in [(Vector3::Y, 1.0), (-Vector3::Y, -1.0)] {
        let middle = panorama.evaluate(pole, &SeenAtOnce::POINT, &view());
        for i in 0..32 {
            let azimuth = TAU * f64::from(i) / 32.0;
            let near = Vector3::new(1e-6 * portable::cos(azimuth), sign, 1e-6 * portable::sin(azimuth));
            assert!((panorama.evaluate(near, &SeenAtOnce::POINT, &view()) - middle).max_abs() < 1e-3);
        }
    }
}

#[test]
fn a_photograph_fills_the_window() {
    let image = picture(4, 2);
    let photograph = photograph(image.clone(), 2.0);
    // The centre of each pixel, on the plane z = −1.
    for (x, y) in (0..2).flat_map(|y| (0..4).map(move |x| (x, y))) {
        let at = Vector3::new(-0.75 + 0.5 * f64::from(x), 0.25 - 0.5 * f64::from(y), -1.0);
        let expected = image.pixel(x, y) * 2.0;
        for scale in [1e-200, 0.1, 1.0, 3.0, 1e200] {
            assert_eq!(photograph.evaluate(at * scale, &SeenAtOnce::POINT, &view()), expected, "pixel {x}, {y}");
            // Behind the camera the same is seen, mirrored in z.
            assert_eq!(
                photograph.evaluate(Vector3::new(at.x(), at.y(), 1.0) * scale, &SeenAtOnce::POINT, &view()),
                expected
            );
        }
        let position = [(f64::from(x) + 0.5) / 4.0, (f64::from(y) + 0.5) / 2.0];
        assert_eq!(photograph.evaluate_at_pixel(position, Vector3::X, &SeenAtOnce::POINT), expected);
    }
    // Outside the window is the nearest border.
    for (direction, corner) in [
        (Vector3::new(-9.0, 9.0, -1.0), (0, 0)),
        (Vector3::new(9.0, 9.0, -1.0), (3, 0)),
        (Vector3::new(9.0, -9.0, 0.0), (3, 1)),
        (Vector3::new(-9.0, -9.0, 1.0), (0, 1)),
        (Vector3::new(9.0, -0.25, -1.0), (3, 1)),
    ] {
        assert_eq!(
            photograph.evaluate(direction, &SeenAtOnce::POINT, &view()),
            image.pixel(corner.0, corner.1) * 2.0,
            "{direction:?}"
        );
    }
}

#[test]
fn off_centre_windows_and_turned_cameras_are_followed() {
    let turn = Transform::rotate(Vector3::Y, 0.8) * Transform::rotate(Vector3::X, -0.3);
    let view = ViewProjection {
        u: turn.vector(Vector3::X),
        v: turn.vector(Vector3::Y),
        w: turn.vector(Vector3::Z),
        left: 0.1,
        right: 0.9,
        bottom: -0.7,
        top: -0.2,
    };
    for (x, y, expected) in [(0.1, -0.2, [0.0, 0.0]), (0.9, -0.7, [1.0, 1.0]), (0.3, -0.325, [0.25, 0.25])] {
        let position = view.position(turn.vector(Vector3::new(x, y, -1.0) * 5.0));
        assert!((position[0] - expected[0]).abs() < 1e-12 && (position[1] - expected[1]).abs() < 1e-12, "{position:?}");
    }
}

#[test]
fn the_orthographic_stand_in_spans_forty_degrees() {
    let view = ViewProjection::for_orthographic(Vector3::X, Vector3::Y, Vector3::Z, 2.0);
    let border = Vector3::new(portable::sin(portable::radians(20.0)), 0.0, -portable::cos(portable::radians(20.0)));
    assert!((view.position(border)[0] - 1.0).abs() < 1e-12);
    assert_eq!(view.top * 2.0, view.right);
    assert_eq!(view.position(Vector3::new(0.0, 0.0, -1.0)), [0.5, 0.5]);
}

#[test]
fn a_gradient_goes_by_height() {
    let stops = vec![(-1.0, Rgb::BLACK), (0.0, Rgb::gray(0.25)), (0.5, Rgb::WHITE)];
    let sky = Background::compile(&scene::Background::Gradient(stops), &[]).unwrap();
    let seen = |y: f64| sky.evaluate(Vector3::new((1.0 - y * y).sqrt(), y, 0.0) * 3.0, &SeenAtOnce::POINT, &view()).r;
    assert_eq!(seen(-1.0), 0.0);
    assert_eq!(seen(0.0), 0.25);
    assert!((seen(0.25) - 0.625).abs() < 1e-6);
    assert_eq!(seen(0.9), 1.0);
    assert_eq!(sky.constant(), None);
}

#[test]
fn constants_are_known_and_bad_numbers_refused() {
    let compile = |background| Background::compile(&background, &[Arc::new(picture(2, 2))]);
    let gray = Rgb::gray(0.2);
    for same in [scene::Background::Color(gray), scene::Background::Gradient(vec![(0.0, gray), (0.1, gray)])] {
        let compiled = compile(same).unwrap();
        assert_eq!(compiled.constant(), Some(gray));
        assert_eq!(compiled.evaluate(Vector3::X, &SeenAtOnce::POINT, &view()), gray);
        assert_eq!(compiled.evaluate_at_pixel([0.1, 0.2], Vector3::X, &SeenAtOnce::POINT), gray);
    }
    let photograph = |image, intensity| scene::Background::Photograph { image: Id::from_index(image), intensity };
    let panorama = |rotation| scene::Background::Panorama { image: Id::from_index(0), intensity: 1.0, rotation };
    let error = |background| compile(background).unwrap_err();
    assert_eq!(error(photograph(1, 1.0)).to_string(), "the background refers to picture #1, but the scene has 1");
    assert_eq!(error(photograph(0, f32::INFINITY)), BackgroundError::BadIntensity(f32::INFINITY));
    assert_eq!(error(panorama(f64::INFINITY)), BackgroundError::BadRotation(f64::INFINITY));
    assert_eq!(error(scene::Background::Color(Rgb::gray(f32::NAN))), BackgroundError::BadColor);
    assert_eq!(error(scene::Background::Gradient(vec![])), BackgroundError::BadGradient(RampError::Empty));
}

#[test]
fn nasty_directions_and_windows_give_finite_colours() {
    let backgrounds = [panorama(picture(3, 1), 1e300), panorama(picture(1, 3), -7.0), photograph(picture(3, 2), 1.0)];
    let directions = NASTY.iter().flat_map(|x| NASTY.iter().flat_map(move |y| NASTY.iter().map(move |z| (x, y, z))));
    for (x, y, z) in directions {
        let direction = Vector3::new(*x, *y, *z);
        for background in &backgrounds {
            assert!(background.evaluate(direction, &SeenAtOnce::POINT, &view()).is_finite(), "{direction:?}");
            assert!(background.evaluate_at_pixel([*x, *y], direction, &SeenAtOnce::POINT).is_finite());
        }
        let empty = ViewProjection { left: *x, right: *y, bottom: *z, top: *x, ..view() };
        assert!(backgrounds[2].evaluate(direction, &SeenAtOnce::POINT, &empty).is_finite());
    }
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::default() })]

    /// The direction of each pixel's centre sees that pixel, but for the rounding of angles.
    #[test]
    fn panorama_round_trip(x in 0..16u32, y in 0..9u32, rotation in -10.0..10.0f64) {
        let image = picture(16, 9);
        let towards = direction((f64::from(x) + 0.5) / 16.0, (f64::from(y) + 0.5) / 9.0);
        let turned = Transform::rotate(Vector3::Y, rotation).vector(towards);
        let seen = panorama(image.clone(), rotation).evaluate(turned, &SeenAtOnce::POINT, &view());
        prop_assert!((seen - image.pixel(x, y)).max_abs() < 1e-4, "{:?} {:?}", seen, image.pixel(x, y));
    }

    /// What a ray through a position of the picture sees does not depend on which of the two ways is asked.
    #[test]
    fn photograph_both_ways(x in 0.0..1.0f64, y in 0.0..1.0f64) {
        let photograph = photograph(picture(16, 9), 1.0);
        let direction = Vector3::new(-1.0 + 2.0 * x, 0.5 - y, -1.0);
        let difference = photograph.evaluate(direction, &SeenAtOnce::POINT, &view()) - photograph.evaluate_at_pixel([x, y], direction, &SeenAtOnce::POINT);
        prop_assert!(difference.max_abs() < 1e-4);
    }
}
