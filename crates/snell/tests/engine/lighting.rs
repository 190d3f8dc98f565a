//! Light on surfaces in closed form: the lecture's `shade`, term by term, through the whole engine.

use snell::math::{Rgb, Vector3, portable};
use snell::task::Term;
use snell_testkit::must_fail;

use crate::stage::{Stage, assert_near, reflectance, refracted_path, share};

/// A wide floor at y = 0 of a material under lights, with other objects.
fn floor(material: &str, lights: &str, others: &str) -> Stage {
    Stage::new(&format!(
        "ambient = 0.25\n{lights}\n[[object]]\nrectangle = {{ corner = [-50, 0, 50], edge_u = [100, 0, 0], \
         edge_v = [0, 0, -100] }}\nmaterial = {{ {material} }}\n{others}"
    ))
}

/// What the floor shows at (x, 0, 0), seen from straight above and near, below whatever stands over it.
fn at(stage: &Stage, x: f64) -> Rgb {
    stage.color([x, 0.01, 0.0], [0.0, -1.0, 0.0])
}

const MATT: &str = "diffuse = [0.8, 0.4, 0.2], ambient = 0";

fn point(x: f64, y: f64, rest: &str) -> String {
    format!("[[light]]\npoint = {{ position = [{x:?}, {y:?}, 0] {rest} }}\n")
}

/// [`MATT`] in this much light.
fn lit(irradiance: f64) -> Rgb {
    Rgb::new(0.8, 0.4, 0.2) * irradiance as f32
}

#[test]
fn diffuse_light_goes_with_the_cosine() {
    let check = |factor: f64| {
        for (x, y) in [(0.0_f64, 2.0_f64), (1.0, 2.0), (-3.0, 1.0), (40.0, 0.5)] {
            let cosine = y / (x * x + y * y).sqrt();
            let seen = at(&floor(MATT, &point(x, y, ", intensity = 1.5"), ""), 0.0);
            assert_near(seen, lit(1.5 * cosine * factor), 1e-6, &format!("a light at {x}, {y}"));
        }
    };
    check(1.0);
    must_fail("a cosine that is 1e-4 too large", || check(1.0001));
    let sun = "[[light]]\ndirectional = { direction = [3, -4, 0], color = [1, 0.5, 0] }\n";
    assert_near(at(&floor(MATT, sun, ""), 7.0), lit(0.8) * Rgb::new(1.0, 0.5, 0.0), 1e-6, "a sun");
    // From below, and from exactly the side, comes nothing.
    for y in [-2.0, 0.0] {
        assert_eq!(at(&floor(MATT, &point(3.0, y, ""), ""), 0.0), Rgb::BLACK);
    }
    // Two lights add up.
    let two = point(0.0, 2.0, "") + &point(2.0, 2.0, "");
    assert_near(at(&floor(MATT, &two, ""), 0.0), lit(1.0 + 0.5_f64.sqrt()), 1e-6, "two lights");
}

#[test]
fn ambient_and_emission_are_there_without_light() {
    assert_eq!(at(&floor("diffuse = [0.8, 0.4, 0.2]", "", ""), 0.0), lit(0.25));
    assert_eq!(at(&floor("diffuse = 0.8, ambient = [0, 1, 0.5]", "", ""), 0.0), Rgb::new(0.0, 0.25, 0.125));
    assert_eq!(at(&floor("emission = [0.5, 2, 0.125]", "", ""), 0.0), Rgb::new(0.5, 2.0, 0.125));
    must_fail("ambient light twice", || assert_eq!(at(&floor("diffuse = 0.8", "", ""), 0.0), Rgb::gray(0.4)));
}

#[test]
fn light_falls_off_by_its_law() {
    type Law = fn(f64) -> f64;
    let laws: [(&str, Law); 4] = [
        (", falloff = \"none\"", |_| 1.0),
        (", falloff = \"linear\"", |d| 1.0 / d),
        (", falloff = \"inverse-square\"", |d| 1.0 / (d * d)),
        (", falloff = { constant = 0.5, linear = 0.25, quadratic = 0.125 }", |d| {
            (1.0 / (0.5 + 0.25 * d + 0.125 * d * d)).min(1.0)
        }),
    ];
    for (text, law) in laws {
        for height in [0.25, 1.0, 2.0, 7.5] {
            let seen = at(&floor(MATT, &point(0.0, height, text), ""), 0.0);
            assert_near(seen, lit(law(height)), 1e-5, &format!("{text} at {height}"));
            must_fail("a law that is 1e-3 off", || assert_near(seen, lit(law(height) + 1e-3), 1e-5, text));
        }
    }
}

#[test]
fn a_spot_fades_smoothly_between_its_angles() {
    let spot = "[[light]]\nspot = { position = [0, 2, 0], direction = [0, -3, 0], cone_angle = 40, full_angle = 25 }\n";
    let stage = floor(MATT, spot, "");
    let [cone, full] = [40.0, 25.0].map(|degrees| portable::cos(portable::radians(degrees)));
    for degrees in [0.0, 10.0, 24.9, 25.1, 30.0, 35.0, 39.9, 40.1, 60.0] {
        let angle = portable::radians(degrees);
        let cosine = portable::cos(angle);
        let x = ((cosine - cone) / (full - cone)).clamp(0.0, 1.0);
        let expected = lit(cosine * x * x * (3.0 - 2.0 * x));
        assert_near(at(&stage, 2.0 * portable::tan(angle)), expected, 1e-6, &format!("{degrees} degrees"));
    }
    must_fail("a straight fade", || {
        let cosine = portable::cos(portable::radians(30.0));
        let straight = lit(cosine * (cosine - cone) / (full - cone));
        assert_near(at(&stage, 2.0 * portable::tan(portable::radians(30.0))), straight, 1e-6, "the twin");
    });
}

#[test]
fn highlights_are_phongs() {
    // (R·L)^n, R the mirrored view.
    let check = |exponent: f64| {
        let material = "specular = [0.5, 0.25, 0.125], shininess = 30";
        for (light, view) in [((2.0, 2.0), (-2.0, 2.0)), ((1.0, 2.0), (-2.0, 2.0)), ((0.5, 1.0), (0.3, 1.0))] {
            let stage = floor(material, &point(light.0, light.1, ", intensity = 2"), "");
            let seen = stage.color([view.0, view.1, 0.0], [-view.0, -view.1, 0.0]);
            let mirrored = Vector3::new(-view.0, view.1, 0.0).normalize();
            let cosine = mirrored.dot(Vector3::new(light.0, light.1, 0.0).normalize());
            let expected = Rgb::new(1.0, 0.5, 0.25) * portable::pow(cosine, exponent) as f32;
            assert_near(seen, expected, 2e-6, &format!("light {light:?}, view {view:?}"));
        }
    };
    check(30.0);
    must_fail("an exponent of 30.1", || check(30.1));
}

/// A body between the floor and the light at (0, 4, 0).
fn under(body: &str, shadows: &str) -> Stage {
    floor(
        MATT,
        &format!("[render]\nshadows = \"{shadows}\"\n{}", point(0.0, 4.0, "")),
        &format!("[[object]]\n{body}\n"),
    )
}

#[test]
fn opaque_bodies_block_all_light_unless_nothing_does() {
    for body in [
        "sphere = { center = [0, 2, 0] }",
        "box = { center = [0, 2, 0] }",
        "disk = { center = [0, 2, 0] }",
        "rectangle = { corner = [-1, 2, 1], edge_u = [2, 0, 0], edge_v = [0, 0, -2] }",
        "mesh = { vertices = [[-1, 2, 1], [1, 2, 1], [0, 2, -1]], faces = [[0, 1, 2]] }",
        "cylinder = { base = [0, 1, 0], top = [0, 3, 0], radius = 0.2 }",
        "torus = { center = [1, 2, 0], axis = [0, 0, 1] }",
        "difference = [{ sphere = { center = [0, 2, 0] } }, { sphere = { center = [0, 2, 0], radius = 0.9 } }]",
    ] {
        assert_eq!(at(&under(body, "filtered"), 0.0), Rgb::BLACK, "{body}");
        assert_eq!(at(&under(body, "opaque"), 0.0), Rgb::BLACK, "{body}");
        assert_near(at(&under(body, "none"), 0.0), lit(1.0), 1e-6, body);
    }
    // What is beyond the light, or behind the floor, casts no shadow.
    for body in
        ["sphere = { center = [0, 6, 0] }", "sphere = { center = [0, -2, 0] }", "sphere = { center = [3, 2, 0] }"]
    {
        assert_near(at(&under(body, "filtered"), 0.0), lit(1.0), 1e-6, body);
    }
    must_fail("a shadow that is not there", || {
        assert_near(at(&under("sphere = { center = [3, 2, 0] }", "filtered"), 0.0), Rgb::BLACK, 1e-6, "the twin");
    });
}

#[test]
fn shadows_of_glass_are_filtered() {
    let slab = |n: f64, rest: &str| {
        let body = format!(
            "box = {{ min = [-9, 1, -9], max = [9, 1.5, 9] }}\nmaterial = {{ dielectric = {{ ior = {n:?} {rest} }} }}"
        );
        at(&under(&body, "filtered"), 0.0)
    };
    for n in [1.0, 1.333, 1.5, 2.4] {
        // Straight through two boundaries.
        let once = 1.0 - ((n - 1.0) / (n + 1.0)) * ((n - 1.0) / (n + 1.0));
        assert_near(slab(n, ""), lit(once * once), 1e-6, &format!("index {n}"));
        let beer = portable::exp(portable::ln(0.3) * 0.5);
        let absorbing = slab(n, ", absorption = { color = 0.3 }");
        assert_near(absorbing, lit(once * once * beer), 1e-6, &format!("index {n}, absorbing"));
    }
    // Aslant: the light is seen from further along the floor.
    let body = "box = { min = [-9, 1, -9], max = [9, 1.5, 9] }\nmaterial = { dielectric = { ior = 1.5, absorption = { color = 0.3 } } }";
    let stage = under(body, "filtered");
    for x in [1.0, 3.0, 6.0] {
        let cosine = 4.0 / (16.0_f64 + x * x).sqrt();
        let once = 1.0 - reflectance(cosine, 1.0, 1.5);
        let expected = lit(cosine * once * once * portable::exp(portable::ln(0.3) * 0.5 / cosine));
        assert_near(at(&stage, x), expected, 1e-6, &format!("aslant at {x}"));
        must_fail("a shadow of one boundary", || {
            let wrong = lit(cosine * once * portable::exp(portable::ln(0.3) * 0.5 / cosine));
            assert_near(at(&stage, x), wrong, 1e-6, "the twin");
        });
    }
    // Filters that are told to be opaque are.
    assert_eq!(at(&under(body, "opaque"), 0.0), Rgb::BLACK);
}

#[test]
fn colored_filters_multiply() {
    let filter = |y: f64, color: [f64; 3]| {
        format!(
            "[[object]]\nbox = {{ min = [-9, {y:?}, -9], max = [9, {:?}, 9] }}\nmaterial = {{ dielectric = {{ ior = 1, \
             transmit = {color:?} }} }}\n",
            y + 0.1
        )
    };
    let (red, blue) = ([0.9, 0.5, 0.25], [0.5, 0.75, 1.0]);
    let light = point(0.0, 4.0, "");
    let [one, two] = [red, blue].map(|color| at(&floor(MATT, &light, &filter(1.0, color)), 0.0));
    let both = at(&floor(MATT, &light, &(filter(1.0, red) + &filter(2.0, blue))), 0.0);
    let squared = |color: [f64; 3]| Rgb::from(color.map(|c| (c * c) as f32));
    assert_near(one, lit(1.0) * squared(red), 1e-6, "a red one, which light goes into and out of");
    assert_near(both, lit(1.0) * squared(red) * squared(blue), 1e-6, "both");
    must_fail("filters that do not multiply", || assert_near(both, (one + two) * 0.5, 1e-6, "the twin"));
    // An opaque thing among them blocks all the same.
    let blocked = filter(1.0, red) + "[[object]]\ndisk = { center = [0, 1.5, 0] }\n" + &filter(2.0, blue);
    assert_eq!(at(&floor(MATT, &light, &blocked), 0.0), Rgb::BLACK);
}

#[test]
fn shadows_know_nested_bodies() {
    // Water in a glass box, overlapping its wall: air, glass, water, glass, air.
    let body = "box = { min = [-9, 2, -9], max = [9, 3, 9] }\nmaterial = { dielectric = { ior = 1.333, priority = 0, absorption = { color = 0.5 } } }\n\
                [[object]]\ndifference = [{ box = { min = [-10, 1.5, -10], max = [10, 3.5, 10] } }, { box = { min = [-8, 2.25, -8], max = [8, 2.75, 8] } }]\n\
                material = { dielectric = { ior = 1.5, priority = 1 } }";
    let pass = |a: f64, b: f64| 1.0 - ((a - b) / (a + b)) * ((a - b) / (a + b));
    let (outer, inner) = (pass(1.0, 1.5), pass(1.5, 1.333));
    let expected = lit(outer * outer * inner * inner * portable::exp(portable::ln(0.5) * 0.5));
    assert_near(at(&under(body, "filtered"), 0.0), expected, 1e-6, "water in glass");
    must_fail("the water counts where there is glass", || {
        let wrong = lit(outer * outer * inner * inner * 0.5);
        assert_near(at(&under(body, "filtered"), 0.0), wrong, 1e-6, "the twin");
    });
}

#[test]
fn one_sided_surfaces_are_lit_from_their_outward_side_alone() {
    // The floor's normal is +y. It is seen from above and from below, under a light above and under one below.
    let seen = |one_sided: bool, light: f64, eye: f64| {
        let material = format!("{MATT}, one_sided = {one_sided}");
        floor(&material, &point(0.0, light, ""), "").color([0.0, eye, 0.0], [0.0, -eye, 0.0])
    };
    for (one_sided, light, eye, bright) in [
        (true, 2.0, 1.0, true),
        (true, 2.0, -1.0, true),
        (true, -2.0, 1.0, false),
        (true, -2.0, -1.0, false),
        (false, 2.0, 1.0, true),
        (false, 2.0, -1.0, false),
        (false, -2.0, 1.0, false),
        (false, -2.0, -1.0, true),
    ] {
        let expected = if bright { lit(1.0) } else { Rgb::BLACK };
        assert_near(seen(one_sided, light, eye), expected, 1e-6, &format!("{one_sided}, light {light}, eye {eye}"));
    }
}

#[test]
fn highlights_on_the_inside_of_a_ball_of_glass() {
    // Seen through the middle, the far wall at (0, 0, −1) turns its inside to viewer and light.
    let (height, n) = (0.4, 1.5);
    let stage = Stage::new(&format!(
        "[[light]]\npoint = {{ position = [0, {height}, 4] }}\n[[object]]\nsphere = {{}}\nmaterial = {{ specular = 0.5, \
         shininess = 20, dielectric = {{ ior = {n:?} }} }}\n"
    ));
    let tree = stage.ray([0.0, 0.0, 5.0], [0.0, 0.0, -1.0]);
    let path = refracted_path(&tree);
    let wall = path[1].hit.flatten().expect("the far wall");
    assert!((wall.point.z() + 1.0).abs() < 1e-12);
    let seen = share(&tree, path[1].task.id, |term| term == Term::Specular(0));
    let to_light = Vector3::new(0.0, height, 5.0).normalize();
    // The shadow ray from the wall leaves the ball at the near side.
    let chord = 2.0 * to_light.z();
    let out = wall.point + to_light * chord;
    let cosine = out.to_vector().dot(to_light);
    let normal_incidence = ((n - 1.0) / (n + 1.0)) * ((n - 1.0) / (n + 1.0));
    let expected = |exponent: f64| {
        0.5 * (1.0 - normal_incidence) * portable::pow(to_light.z(), exponent) * (1.0 - reflectance(cosine, 1.0, n))
    };
    assert_near(seen, Rgb::gray(expected(20.0) as f32), 1e-6, "the highlight");
    must_fail("another exponent", || assert_near(seen, Rgb::gray(expected(21.0) as f32), 1e-6, "the twin"));
    // Its twin on the outside is brighter by what the boundaries keep.
    let outside = share(&tree, tree.rays[0].task.id, |term| term == Term::Specular(0));
    let mirrored = Vector3::new(0.0, height, 3.0).normalize();
    assert_near(outside, Rgb::gray((0.5 * portable::pow(mirrored.z(), 20.0)) as f32), 1e-6, "the outer highlight");
}
