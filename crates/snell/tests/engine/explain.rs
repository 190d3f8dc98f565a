//! What is explained is what was rendered: the shares of a pixel's samples add up to the pixel, bit for bit.

use snell::film::PixelSum;
use snell::observe::RayTree;
use snell::render::explain;
use snell::scene::scene::Antialiasing;
use snell_testkit::must_fail;

use crate::files::scene_of_file;
use crate::stage::Stage;

/// Explains every sample of every pixel of a small picture and compares with the rendering. `change` may spoil a tree.
fn shares_add_up(name: &str, antialiasing: Antialiasing, change: impl Fn(&mut RayTree)) {
    let mut stage = Stage::of(&scene_of_file(&format!("scenes/{name}.toml"))).sized(16, 12);
    stage.settings.antialiasing = antialiasing;
    let samples = if let Antialiasing::Samples(count) = antialiasing { count } else { 1 };
    let picture = stage.picture();
    for [x, y] in stage.pixels() {
        let mut sum = PixelSum::default();
        for sample in 0..samples {
            let mut tree = explain(&stage.scene, &stage.settings, [x, y], sample).expect("a camera");
            change(&mut tree);
            assert!(sum.add(tree.sum()), "{name}: no number at {x}, {y}");
        }
        let rendered = picture.get(x, y).expect("a pixel").to_array().map(f32::to_bits);
        assert_eq!(sum.mean().to_array().map(f32::to_bits), rendered, "{name} at {x}, {y}");
    }
}

#[test]
fn shares_add_up_to_the_pixel() {
    for name in ["seven-rays", "five-glass-balls", "bubble", "second-order-reflection", "milky-sphere"] {
        shares_add_up(name, Antialiasing::None, |_| {});
    }
    // Dispersion, and several samples a pixel.
    shares_add_up("refraction-and-wavelength", Antialiasing::Samples(3), |_| {});
}

#[test]
fn a_lost_share_is_told() {
    let message = must_fail("the last share is missing", || {
        shares_add_up("seven-rays", Antialiasing::None, |tree| {
            tree.shares.pop();
        });
    });
    assert!(message.contains("seven-rays at"), "{message}");
}
