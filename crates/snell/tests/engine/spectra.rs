//! Light by its spectrum, from scene files to pictures: its colour, and what glass and filters make of it.

use snell::image::Image;
use snell::math::Rgb;
use snell::math::spectrum::{MeasuredSpectrum, Spectrum, blackbody_rgb};
use snell::render::PathSettings;
use snell_testkit::must_fail;

use crate::stage::Stage;

fn mean(image: &Image<Rgb>) -> Rgb {
    image.pixels().iter().fold(Rgb::BLACK, |sum, color| sum + *color) * (1.0 / image.pixels().len() as f32)
}

fn trace(stage: &Stage) -> Rgb {
    let paths = PathSettings { samples: 256, ..PathSettings::default() };
    mean(&stage.picture_by_paths(&paths))
}

#[track_caller]
fn assert_near(found: Rgb, expected: Rgb, tolerance: f32) {
    let difference = (found - expected).max_abs();
    assert!(difference <= tolerance, "{found:?}, not {expected:?}");
}

/// The colour of light of three wavelengths, none at the first and the last.
fn light(nm: &[f64]) -> Rgb {
    let measured = MeasuredSpectrum::new(nm.to_vec(), vec![0.0, 4.0, 0.0]).expect("ascending");
    Spectrum::light(measured).expect("it is seen").to_rgb()
}

/// A wall that fills the picture and gives off light.
fn wall(emission: &str, before: &str) -> Stage {
    let text = format!(
        "[camera]\neye = [0, 0, 5]\nfov = 20\n[material.wall]\nemission = {emission}\n{before}\n\
         [[object]]\nrectangle = {{ corner = [-9, -9, 0], edge_u = [18, 0, 0], edge_v = [0, 18, 0] }}\nmaterial = 'wall'\n"
    );
    Stage::new(&text).sized(16, 16)
}

#[test]
fn lamps_have_the_colours_of_their_spectra() {
    for (emission, expected) in [
        ("{ blackbody = 3200, luminance = 2 }", blackbody_rgb(3200.0) * 2.0),
        ("{ blackbody = 9000 }", blackbody_rgb(9000.0)),
        ("{ illuminant = 'D65', luminance = 0.5 }", Rgb::gray(0.5)),
        ("{ illuminant = 'A' }", Spectrum::illuminant_a().to_rgb()),
        ("{ illuminant = 'E' }", Spectrum::Constant(1.0).to_rgb()),
        ("{ measured = [[500, 0], [560, 4], [620, 0]], luminance = 0.7 }", light(&[500.0, 560.0, 620.0]) * 0.7),
    ] {
        let stage = wall(emission, "");
        let found = trace(&stage);
        // Blue that no screen can show is negative in a path and left out in `whitted`.
        let shown = found.map(|component| component.max(0.0));
        let tolerance = if emission.contains("measured") { 0.15 } else { 0.02 };
        assert_near(shown, expected, tolerance);
        must_fail("white light", || assert_near(shown, expected * 1.25, tolerance));
        if !emission.contains("measured") {
            assert_near(mean(&stage.picture()), expected, 1e-3);
        }
    }
}

#[test]
fn lights_and_surfaces_have_them_alike() {
    // A white matt floor under a point light of intensity one, facing it, has the light's own colour in both algorithms.
    let text = |color: &str| {
        format!(
            "[camera]\neye = [0, 4, 0]\nlook_at = [0, 0, 0]\nup = [0, 0, -1]\nfov = 1\n\
             [[light]]\ndirectional = {{ direction = [0, -1, 0], color = {color} }}\n\
             [material.white]\ndiffuse = 1\n[[object]]\nplane = {{ y = 0 }}\nmaterial = 'white'\n"
        )
    };
    let stage = Stage::new(&text("{ blackbody = 2400 }")).sized(12, 12);
    let expected = Spectrum::blackbody(2400.0).to_rgb();
    assert_near(mean(&stage.picture()), expected, 1e-3);
    assert_near(trace(&stage), expected, 0.02);
    must_fail("daylight", || {
        assert_near(trace(&Stage::new(&text("{ illuminant = 'D65' }")).sized(12, 12)), expected, 0.1)
    });
}

#[test]
fn a_lamp_of_one_colour_cannot_show_another() {
    // A blue filter before a wall of sodium light and before a wall whose red, green and blue are those of sodium light.
    let filter = "[material.filter]\ndielectric = { ior = 1, absorption = { color = [0.02, 0.1, 0.9], distance = 1 } }\n\
                  [[object]]\nbox = { min = [-9, -9, 1], max = [9, 9, 2] }\nmaterial = 'filter'\n";
    let sodium = "{ measured = [[580, 0], [589, 1], [598, 0]] }";
    let through = trace(&wall(sodium, filter));
    let bare = trace(&wall(sodium, ""));
    // All that is left is as yellow as before: the ratio of red to green stays.
    let hue = |color: Rgb| color.r / color.g;
    assert!((hue(through) / hue(bare) - 1.0).abs() < 0.05, "{through:?} {bare:?}");
    let [r, g, b] = light(&[580.0, 589.0, 598.0]).to_array();
    let colored = trace(&wall(&format!("[{r}, {g}, {b}]"), filter));
    assert!(
        (hue(colored) / hue(bare) - 1.0).abs() > 0.1,
        "{colored:?}: a smooth spectrum of that colour changes its hue"
    );
}
