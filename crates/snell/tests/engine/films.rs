//! Films whose thickness differs from place to place: each place is as if its film were that thick everywhere.

use snell::math::Rgb;
use snell::render::PathSettings;

use crate::stage::Stage;

/// A sheet before a coloured sky, seen by paths: rows from the top.
fn rows(material: &str) -> Vec<Vec<Rgb>> {
    let text = format!(
        "[camera]\neye = [0, 0, 5]\nfov = 30\n\
         [background]\ngradient = {{ horizon = [1, 0.9, 0.7], zenith = [0.2, 0.4, 1], nadir = [0.3, 0.2, 0.1] }}\n\
         [material.sheet]\n{material}\n\
         [[object]]\nbox = {{ min = [-2, -2, -0.1], max = [2, 2, 0] }}\nmaterial = 'sheet'\n"
    );
    let stage = Stage::new(&text).sized(8, 8);
    let paths = PathSettings { samples: 4, ..PathSettings::default() };
    let image = stage.picture_by_paths(&paths);
    image.pixels().chunks(8).map(<[Rgb]>::to_vec).collect()
}

#[test]
fn each_place_has_the_colours_of_its_own_thickness() {
    // Thin below the middle and thick above.
    let step = "{ gradient = { axis = [0, 1, 0], stops = [{ at = 0, color = 0 }, { at = 1e-9, color = 1 }] } }";
    for body in
        ["dielectric = { ior = 1.5, ", "metal = { of = 'copper', roughness = 0.3, ", "metal = { of = 'copper', "]
    {
        let of = |thickness: &str| rows(&format!("{body}film = {{ thickness = {thickness}, ior = 1.8 }} }}"));
        let (thin, thick) = (of("150"), of("420"));
        assert_ne!(thin, thick);
        let varying = of(&format!("{{ from = 150, to = 420, by = {step} }}"));
        assert_eq!(varying[..3], thick[..3], "{body}");
        assert_eq!(varying[5..], thin[5..], "{body}");
        assert_ne!(varying[..3], thin[..3], "{body}");
        // And between them by the share.
        assert_eq!(of("{ from = 100, to = 500, by = 0.125 }"), thin, "{body}");
    }
}
