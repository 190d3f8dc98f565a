//! The same bits from any number of threads and any size of tiles.

use snell::image::Image;
use snell::math::Rgb;
use snell::scene::scene::Antialiasing;
use snell_testkit::must_fail;

use crate::stage::Stage;

/// Everything that could make a picture depend on the order of work: glass in glass, dispersion, absorption, a milky body,
/// solids made of solids, a mesh, instances, patterns, filtered shadows, several lights.
const EVERYTHING: &str = r#"
ambient = 0.1
[image]
width = 45
height = 34
[render]
bands = 5
depth = 8
[camera]
eye = [0.3, 2.2, 6]
look_at = [0, 0.8, 0]
[background]
gradient = { horizon = [0.8, 0.9, 1.0], zenith = [0.2, 0.4, 0.8] }
[[light]]
point = { position = [4, 6, 5], intensity = 0.7 }
[[light]]
spot = { position = [-4, 5, 3], look_at = [0, 0, 0], cone_angle = 40, intensity = 0.5 }
[material.floor]
diffuse = { checker = { colors = [0.9, 0.1], size = 0.7 } }
[material.crystal]
specular = 0.4
dielectric = { ior = "N-SF11" }
[material.green]
dielectric = { ior = 1.5, absorption = { color = [0.3, 0.9, 0.4] } }
[material.water]
dielectric = { ior = "water", priority = -1 }
[material.milk]
dielectric = { ior = 1.3, scattering = { distance = 0.3 } }
[material.shiny]
diffuse = { noise = { colors = ["tomato", "gold"], size = 0.4 } }
mirror = 0.3
[[object]]
plane = { y = 0 }
material = "floor"
[[object]]
sphere = { center = [-1.4, 0.8, 0.5], radius = 0.8 }
material = "crystal"
[[object]]
material = "green"
difference = [{ sphere = {} }, { sphere = { radius = 0.85 } }]
scale = [1, 0.8, 1]
rotate = [0, 30, 10]
translate = [0.6, 1, 0.3]
[[object]]
sphere = { center = [0.6, 1, 0.3], radius = 0.9 }
material = "water"
[[object]]
sphere = { center = [2.2, 0.5, 1.2], radius = 0.5 }
material = "milk"
[[object]]
mesh = { vertices = [[0, 1.4, 0], [-0.7, 0, 0.7], [0.7, 0, 0.7], [0, 0, -0.9]], faces = [[0, 1, 2], [0, 2, 3], [0, 3, 1], [1, 3, 2]] }
material = "shiny"
translate = [-0.3, 0, 2]
[prototype.cluster]
group = [
  { torus = { center = [0, 0.4, 0], major_radius = 0.4, minor_radius = 0.12 } },
  { sphere = { center = [0.5, 0.2, 0], radius = 0.2 } },
  { sphere = { center = [-0.5, 0.2, 0], radius = 0.2 } },
  { cone = { base = [0, 0, 0.4], base_radius = 0.2, top = [0, 0.5, 0.4] } },
  { cylinder = { base = [0, 0, -0.4], top = [0, 0.5, -0.4], radius = 0.15 } },
]
[[object]]
instance = "cluster"
material = "shiny"
translate = [-2.3, 0, -1]
[[object]]
instance = "cluster"
material = "green"
rotate = [0, 70, 0]
translate = [1.8, 0, -1.5]
"#;

#[track_caller]
fn same_bits(a: &Image<Rgb>, b: &Image<Rgb>, what: &str) {
    let bits = |image: &Image<Rgb>| -> Vec<[u32; 3]> {
        image.pixels().iter().map(|color| color.to_array().map(f32::to_bits)).collect()
    };
    assert!(bits(a) == bits(b), "{what}: other bits");
}

#[test]
fn threads_and_tiles_change_no_bit() {
    let mut stage = Stage::new(EVERYTHING);
    for antialiasing in [Antialiasing::Adaptive, Antialiasing::Samples(2)] {
        stage.settings.antialiasing = antialiasing;
        (stage.settings.threads, stage.settings.tile_size) = (Some(1), 32);
        let first = stage.render();
        assert!(first.statistics.total_internal_reflections > 0 && first.statistics.max_depth == 8);
        let variants = match antialiasing {
            Antialiasing::Adaptive => &[(1, 1), (2, 7), (7, 32), (2, 4096), (7, 1)][..],
            _ => &[(1, 4096), (2, 1), (7, 7)][..],
        };
        for &(threads, tile_size) in variants {
            (stage.settings.threads, stage.settings.tile_size) = (Some(threads), tile_size);
            let again = stage.render();
            let what = format!("{antialiasing:?}, {threads} threads, tiles of {tile_size}");
            same_bits(&first.image, &again.image, &what);
            assert_eq!(first.statistics, again.statistics, "{what}");
        }
    }
}

#[test]
fn one_other_bit_is_told() {
    let picture = Stage::new(EVERYTHING).sized(6, 4).picture();
    let mut other = picture.clone();
    let last = other.pixels_mut().last_mut().expect("a pixel");
    last.b = f32::from_bits(last.b.to_bits() ^ 1);
    must_fail("the last bit of the last pixel", || same_bits(&picture, &other, "the twin"));
}
