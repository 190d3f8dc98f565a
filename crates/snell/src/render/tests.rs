//! The main loop: every pixel once, in any tiles; passes where they are wanted; an end where it is asked for.

use std::sync::atomic::{AtomicU64, Ordering};

use snell_image::Image;
use snell_math::{Point3, Rgb, Vector3};
use snell_scene::scene::{Antialiasing, Background, Frame, Material, Object, Scene, Shape, Texture, Tone};
use snell_testkit::{TestRng, must_fail};

use super::adaptive::{Display, unsettled};
use super::{Job, Progress, RenderSettings, explain, render};
use crate::compile::CompiledScene;
use crate::integrator::Whitted;
use crate::viewing::ViewingError;

/// A glowing ball before a grey background.
fn ball() -> Scene {
    let mut scene = Scene { background: Background::Color(Rgb::gray(0.25)), ..Scene::default() };
    let emission = Some(scene.textures.push(Texture::constant(Rgb::WHITE)));
    let material = Some(scene.materials.push(Material { emission, ..Material::default() }));
    let sphere = Shape::Sphere { center: Point3::ORIGIN, radius: 1.0 };
    scene.objects.push(Object { material, ..Object::shape(sphere) });
    scene
}

fn settings(scene: &Scene, width: u32, height: u32) -> RenderSettings {
    RenderSettings { width, height, ..RenderSettings::from(&scene.settings) }
}

/// Counts what it is told; cancels after some tiles.
#[derive(Default)]
struct Told {
    passes: AtomicU64,
    announced: AtomicU64,
    advanced: AtomicU64,
    rays: AtomicU64,
    tiles: AtomicU64,
    tiles_until_cancelled: u64,
}

impl Progress for Told {
    fn pass(&self, number: u32, pixels: u64) {
        assert_eq!(self.passes.fetch_add(1, Ordering::Relaxed), u64::from(number));
        self.announced.fetch_add(pixels, Ordering::Relaxed);
    }
    fn advance(&self, pixels: u64, rays: u64) {
        self.advanced.fetch_add(pixels, Ordering::Relaxed);
        self.rays.fetch_add(rays, Ordering::Relaxed);
        self.tiles.fetch_add(1, Ordering::Relaxed);
    }
    fn is_cancelled(&self) -> bool {
        self.tiles.load(Ordering::Relaxed) >= self.tiles_until_cancelled
    }
}

#[test]
fn tiles_cover_every_pixel_once() {
    let scene = ball();
    let compiled = CompiledScene::build(&scene).expect("it compiles");
    for (width, height, tile_size) in [(1, 1, 32), (7, 5, 1), (33, 65, 32), (10, 3, 4), (5, 5, 0), (3, 4, u32::MAX)] {
        let settings = RenderSettings { tile_size, ..settings(&scene, width, height) };
        let camera = settings.camera(&compiled).expect("a camera");
        let integrator = Whitted::new(&compiled, &camera, settings.bands);
        let tiles = Job { scene: &compiled, integrator: &integrator, camera: &camera, settings: &settings }.tiles();
        let mut covered = vec![0; (width * height) as usize];
        let mut picture = Image::filled(width, height, Rgb::BLACK);
        for tile in tiles {
            let pixels: Vec<usize> = tile.pixels().map(|pixel| pixel.place(width)).collect();
            assert!(!pixels.is_empty() && pixels.len() as u64 <= u64::from(tile_size.max(1)).pow(2));
            pixels.iter().for_each(|&pixel| covered[pixel] += 1);
            let colors: Vec<Rgb> = pixels.iter().map(|&pixel| Rgb::gray(pixel as f32 + 1.0)).collect();
            tile.put(&colors, &mut picture);
        }
        assert!(covered.into_iter().all(|count| count == 1));
        assert!(picture.pixels().iter().zip(1..).all(|(color, number)| *color == Rgb::gray(number as f32)));
    }
}

#[test]
fn adaptive_pictures_look_closer_at_edges_only() {
    let scene = ball();
    let compiled = CompiledScene::build(&scene).expect("it compiles");
    let told = Told { tiles_until_cancelled: u64::MAX, ..Told::default() };
    let rendering = render(&compiled, &settings(&scene, 64, 48), &told).expect("a camera");
    assert!(rendering.complete && told.passes.into_inner() == 2);
    let rays = rendering.statistics.camera_rays;
    assert_eq!((told.announced.into_inner(), told.rays.into_inner()), (told.advanced.into_inner(), rays));
    // One in each pixel, and up to sixteen along the ball's edge, about 2 π 17 pixels long.
    assert!((64 * 48 + 500..64 * 48 + 8000).contains(&rays), "{rays}");
    // Edges are smooth now, and all else is as with one ray.
    let colors = rendering.image.pixels();
    assert!(colors.iter().any(|color| (0.3..0.9).contains(&color.r)));
    assert!(colors.iter().filter(|color| ![0.25, 1.0].contains(&color.r)).count() < 200);
}

#[test]
fn samples_are_taken_as_asked_for() {
    let scene = ball();
    let compiled = CompiledScene::build(&scene).expect("it compiles");
    for (antialiasing, expected) in
        [(Antialiasing::None, 1), (Antialiasing::Samples(5), 5), (Antialiasing::Samples(0), 1)]
    {
        let settings = RenderSettings { antialiasing, ..settings(&scene, 9, 7) };
        let rendering = render(&compiled, &settings, &super::NoProgress).expect("a camera");
        assert_eq!(rendering.statistics.camera_rays, 63 * expected);
    }
}

#[test]
fn what_is_different_is_judged_as_it_is_shown() {
    let settled = |colors: [f32; 3], tone: Tone, exposure: f32| {
        let scene = ball();
        let settings = RenderSettings { tone, exposure, ..settings(&scene, 3, 1) };
        let display = Display::new(&settings, 1);
        let picture = Image::from_fn(3, 1, |x, _| Rgb::gray(colors[x as usize]));
        unsettled(&picture, &display).into_iter().map(|unsettled| !unsettled).collect::<Vec<_>>()
    };
    assert_eq!(settled([0.5; 3], Tone::None, 0.0), [true; 3]);
    assert_eq!(settled([0.5, 0.5, 0.6], Tone::None, 0.0), [true, false, false]);
    // Beyond white nothing is different, and in the dark very little is.
    assert_eq!(settled([1.0, 5.0, 900.0], Tone::None, 0.0), [true; 3]);
    assert_eq!(settled([0.0, 0.01, 0.0], Tone::None, 0.0), [false; 3]);
    assert_eq!(settled([0.5, 0.5, 0.6], Tone::None, 4.0), [true; 3], "overexposed");
    assert_eq!(settled([0.5, 0.5, 0.6], Tone::None, -9.0), [true; 3], "underexposed");
    assert_eq!(settled([1.0, 1.0, 3.0], Tone::Reinhard, 0.0), [true, false, false]);
    // Later a pixel's own samples count and not its neighbours'.
    let scene = ball();
    let own = |count: u32, samples: [f32; 2]| {
        let display = Display::new(&settings(&scene, 2, 1), count);
        display.is_wide(&display.range(&samples.map(Rgb::gray)))
    };
    assert_eq!([own(4, [0.1, 0.9]), own(4, [0.9, 0.9])], [true, false]);
    // The more there are, the less it says that two of them differ.
    assert_eq!([own(1, [0.1, 0.18]), own(4, [0.1, 0.18])], [true, false]);
}

/// Against the definition: all nine samples of each neighbourhood, every pair of them.
#[test]
fn neighbours_are_those_of_all_sides() {
    let scene = ball();
    let display = Display::new(&settings(&scene, 1, 1), 1);
    let mut rng = TestRng::new(5);
    for (width, height) in [(1, 1), (1, 40), (40, 1), (7, 33), (20, 16), (3, 17)] {
        let mut sample = || if rng.below(9) == 0 { 0.5 + 0.16 * rng.unit_f32() } else { 0.5 };
        let picture = Image::from_fn(width, height, |_, _| Rgb::new(sample(), 0.5, sample()));
        let expected: Vec<bool> = (0..height as i64)
            .flat_map(|y| (0..width as i64).map(move |x| (x, y)))
            .map(|(x, y)| {
                let near = (-1..=1).flat_map(|dy| (-1..=1).map(move |dx| (x + dx, y + dy)));
                let near: Vec<Rgb> = near
                    .filter_map(|(x, y)| picture.get(u32::try_from(x).ok()?, u32::try_from(y).ok()?).copied())
                    .collect();
                display.is_wide(&display.range(&near))
            })
            .collect();
        let check = |found: &[bool]| assert_eq!(found, expected, "{width} x {height}");
        check(&unsettled(&picture, &display));
        must_fail("one pixel is judged otherwise", || {
            let mut other = unsettled(&picture, &display);
            other[0] = !other[0];
            check(&other);
        });
    }
}

#[test]
fn layers_say_what_each_pixel_shows() {
    let mut scene = ball();
    let wall = Shape::Plane { point: Point3::new(0.0, 0.0, -3.0), normal: -Vector3::Z };
    scene.objects.push(Object::shape(wall));
    scene.camera.frame = Frame::OrthographicWidth(3.0);
    let compiled = CompiledScene::build(&scene).expect("it compiles");
    let settings = RenderSettings { layers: true, ..settings(&scene, 31, 21) };
    let layers = render(&compiled, &settings, &super::NoProgress).expect("a camera").layers.expect("asked for");
    let (depth, normal, object) = (layers.depth.expect("a"), layers.normal.expect("b"), layers.object.expect("c"));
    let check = |factor: f32| {
        for (x, y) in [(15, 10), (20, 8), (10, 14), (0, 0), (30, 20)] {
            // The camera is at z = 5; a pixel is 3/31 wide.
            let [px, py] = [x as f32 - 15.0, 10.0 - y as f32].map(|c| c * 3.0 / 31.0);
            let height = 1.0 - px * px - py * py;
            let (z, expected, number) =
                if height > 0.0 { (height.sqrt(), [px, py, height.sqrt()], 1) } else { (-3.0, [0.0, 0.0, 1.0], 2) };
            let at = |image: &Image<f32>| *image.get(x, y).expect("a pixel");
            assert!((at(&depth) - (5.0 - z) * factor).abs() < 1e-5);
            let normal = normal.get(x, y).expect("a pixel");
            assert!(normal.iter().zip(expected).all(|(a, b)| (a - b).abs() < 1e-5), "{normal:?} {expected:?}");
            assert_eq!(object.get(x, y), Some(&number));
        }
    };
    check(1.0);
    must_fail("depths of the wrong scale", || check(1.001));
}

#[test]
fn who_cancels_gets_what_there_is() {
    let scene = ball();
    let compiled = CompiledScene::build(&scene).expect("it compiles");
    let settings = RenderSettings { tile_size: 8, threads: Some(1), ..settings(&scene, 64, 64) };
    for tiles_until_cancelled in [0, 3] {
        let told = Told { tiles_until_cancelled, ..Told::default() };
        let rendering = render(&compiled, &settings, &told).expect("a camera");
        assert!(!rendering.complete);
        assert_eq!(rendering.statistics.camera_rays, 64 * tiles_until_cancelled);
        let lit = rendering.image.pixels().iter().filter(|color| **color != Rgb::BLACK).count() as u64;
        assert_eq!(lit, 64 * tiles_until_cancelled);
    }
}

#[test]
fn cameras_that_see_nothing_are_errors() {
    let mut scene = ball();
    let compiled = CompiledScene::build(&scene).expect("it compiles");
    let none = settings(&scene, 0, 5);
    assert_eq!(
        render(&compiled, &none, &super::NoProgress).err(),
        Some(ViewingError::NoPixels { width: 0.0, height: 5.0 })
    );
    assert_eq!(explain(&compiled, &none, [0, 0], 0).err(), Some(ViewingError::NoPixels { width: 0.0, height: 5.0 }));
    scene.camera.gaze = scene.camera.up;
    let compiled = CompiledScene::build(&scene).expect("it compiles");
    let error = render(&compiled, &settings(&scene, 4, 4), &super::NoProgress).err();
    let parallel = ViewingError::Parallel { gaze: [0.0, 1.0, 0.0], up: [0.0, 1.0, 0.0] };
    assert_eq!(error, Some(parallel));
}

#[test]
fn nothing_beyond_the_far_plane_is_seen_or_explained() {
    let mut scene = ball();
    let window =
        |far: f64| Frame::PerspectiveWindow { left: -0.1, right: 0.1, bottom: -0.1, top: 0.1, near: -1.0, far };
    for (far, expected) in [(-4.5, 1.0), (-3.5, 0.25), (f64::NEG_INFINITY, 1.0)] {
        scene.camera.frame = window(far);
        let compiled = CompiledScene::build(&scene).expect("it compiles");
        let settings = RenderSettings { layers: true, ..settings(&scene, 3, 3) };
        let rendering = render(&compiled, &settings, &super::NoProgress).expect("a camera");
        assert_eq!(rendering.image.get(1, 1), Some(&Rgb::gray(expected)), "far plane at {far}");
        let tree = explain(&compiled, &settings, [1, 1], 0).expect("a camera");
        assert_eq!((tree.sum(), tree.rays.len()), (Rgb::gray(expected), 1));
        let object = rendering.layers.and_then(|layers| layers.object).expect("asked for");
        assert_eq!(object.get(1, 1), Some(&u32::from(expected == 1.0)));
    }
}
