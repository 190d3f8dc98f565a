//! The numbers of an explanation against closed forms: a prism, a ball, and Fresnel's shares along random chains of slabs.

use proptest::prelude::*;
use snell::explain::{End, ExplainedRay, Explanation, Kind, Subject, TermKind, explain};
use snell::math::{Point3, Ray, Vector3, portable};
use snell_testkit::must_fail;

use crate::stage::{Stage, reflectance};

const EXACT: f64 = 1e-12;

fn told(stage: &Stage, origin: [f64; 3], direction: [f64; 3]) -> Explanation {
    let ray = Ray::new(Point3::from(origin), Vector3::from(direction));
    explain(&stage.scene, &stage.settings, Subject::Ray(ray, 0)).expect("a camera")
}

/// The rays that go straight through: the first, then the refracted child of each in turn.
fn chain(told: &Explanation) -> Vec<&ExplainedRay> {
    let (mut at, mut chain) = (0, vec![&told.rays[0]]);
    while let Some(next) = told.children(at).find(|&child| {
        let ray = &told.rays[child];
        ray.kind == Kind::Refracted && ray.origin.is_some()
    }) {
        chain.push(&told.rays[next]);
        at = next;
    }
    chain
}

#[track_caller]
fn near(actual: f64, expected: f64, what: &str) {
    // So that NaN fails.
    assert!((actual - expected).abs() <= EXACT, "{what}: {actual:?}, expected {expected:?}");
}

/// A ray through a prism with an apex angle, whose first face stands upright in the plane of incidence: the deviation is
/// i₁ + i₂ − A (Hecht, *Optics*, 5.5.1).
fn deviates(apex: f64, incidence: f64, n: f64, planted: f64) {
    // The wedge between two planes through the z axis: x ≥ 0 turned by half the apex each way, cut from a large box.
    let half = 0.5 * apex;
    let (s, c) = (portable::sin(half), portable::cos(half));
    // Both faces as large triangles of one closed mesh: a prism with its edge up, from y = 0 down to −10.
    let corners = [[0.0, 0.0], [-10.0 * s, -10.0 * c], [10.0 * s, -10.0 * c]];
    let points: Vec<String> =
        [-50.0, 50.0].iter().flat_map(|z| corners.iter().map(move |[x, y]| format!("[{x:?}, {y:?}, {z:?}]"))).collect();
    let faces = "[[1, 4, 3, 0], [5, 2, 0, 3], [1, 2, 5, 4], [2, 1, 0], [4, 5, 3]]";
    let stage = Stage::new(&format!(
        "[[object]]\nmesh = {{ vertices = [{}], faces = {faces} }}\nmaterial = {{ dielectric = {{ ior = {n:?} }} }}\n",
        points.join(", ")
    ));
    // The left face's outward normal is (−cos, sin); the ray meets it two units from the edge.
    let normal = Vector3::new(-c, s, 0.0);
    let along = Vector3::new(-s, -c, 0.0);
    let direction = -(normal * portable::cos(incidence)) - along * portable::sin(incidence);
    let target = Point3::ORIGIN + along * 2.0;
    let origin = target - direction * 3.0;
    let told = told(&stage, origin.to_array(), direction.to_array());
    let rays = chain(&told);
    assert_eq!(rays.len(), 3, "two refractions");
    let [first, second] = [0, 1].map(|i: usize| &rays[i].surface.as_ref().expect("a face").boundaries[0]);
    // Mesh corners are f32, so the apex is that of the mesh: taken from the normals that were met.
    let normals = [0, 1].map(|i: usize| rays[i].surface.as_ref().expect("a face").normal.as_vector());
    let apex =
        std::f64::consts::PI - portable::atan2(normals[0].cross(normals[1]).length(), normals[0].dot(normals[1]));
    assert!((apex - 2.0 * half).abs() < 1e-6);
    let i1 = first.incidence;
    let r1 = portable::asin(portable::sin(i1) / n);
    let i2 = portable::asin(n * portable::sin(apex - r1));
    near(first.refraction.expect("refracts"), r1, "first refraction");
    near(second.incidence, apex - r1, "second incidence");
    near(second.refraction.expect("refracts"), i2, "second refraction");
    let [into, out] = [rays[0], rays[2]].map(|ray| ray.direction.expect("traced"));
    let deviation = portable::atan2(into.cross(out).length(), into.dot(out));
    near(deviation, i1 + i2 - apex + planted, "deviation");
    near(second.critical.expect("towards air"), portable::asin(1.0 / n), "critical angle");
    assert_eq!(first.critical, None);
}

#[test]
fn a_prism_deviates_as_its_formula_says() {
    for (apex, incidence, n) in [(60.0, 50.0, 1.5), (45.0, 30.0, 1.62), (30.0, 5.0, 2.0), (60.0, 75.0, 1.45)] {
        deviates(portable::radians(apex), portable::radians(incidence), n, 0.0);
    }
    must_fail("the deviation is off", || {
        deviates(portable::radians(60.0), portable::radians(50.0), 1.5, 1e-11);
    });
}

/// A ray that meets a ball of index n and radius 1 at a height: i = asin h, each refraction turns it by i − r, and the chord is
/// 2 cos r long.
fn goes_through_a_ball(height: f64, n: f64, planted: f64) {
    let stage = Stage::new(&format!(
        "[[object]]\nname = \"ball\"\nsphere = {{}}\nmaterial = {{ dielectric = {{ ior = {n:?} }} }}\n"
    ));
    let told = told(&stage, [0.0, height, 5.0], [0.0, 0.0, -2.0]);
    let rays = chain(&told);
    assert_eq!(rays.len(), 3);
    let i = portable::asin(height);
    let r = portable::asin(height / n);
    near(rays[0].distance.expect("traced"), 5.0 - portable::cos(i), "way to the ball");
    near(rays[1].distance.expect("traced"), 2.0 * portable::cos(r), "chord");
    let first = &rays[0].surface.as_ref().expect("the ball").boundaries[0];
    near(first.incidence, i, "incidence");
    near(first.refraction.expect("refracts"), r + planted, "refraction");
    let [into, out] = [rays[0], rays[2]].map(|ray| ray.direction.expect("traced"));
    near(portable::atan2(into.cross(out).length(), into.dot(out)), 2.0 * (i - r), "deviation");
    let fresnel = reflectance(portable::cos(i), 1.0, n);
    near(first.reflectance, fresnel, "reflectance");
    near(first.transmittance, 1.0 - fresnel, "transmittance");
    assert_eq!(first.media[0].material, None);
    near(first.media[1].index, n, "index");
    near(rays[1].medium.index, n, "index inside");
    assert_eq!((rays[2].end, rays[2].distance), (End::Background, Some(f64::INFINITY)));
}

#[test]
fn a_ball_bends_as_its_formula_says() {
    for (height, n) in [(0.0, 1.5), (0.3, 1.5), (0.7, 1.333), (0.9, 2.419), (0.5, 1.1)] {
        goes_through_a_ball(height, n, 0.0);
    }
    must_fail("the refraction is off", || goes_through_a_ball(0.3, 1.5, 1e-11));
}

#[test]
fn light_inside_is_reflected_beyond_the_critical_angle() {
    let stage = Stage::new(
        "[[object]]\nbox = { min = [-10, -1, -10], max = [10, 1, 10] }\nmaterial = { dielectric = { ior = 1.5 } }\n",
    );
    let angle = portable::radians(50.0);
    let told = told(&stage, [0.0; 3], [portable::sin(angle), portable::cos(angle), 0.0]);
    let boundary = &told.rays[0].surface.as_ref().expect("a side").boundaries[0];
    near(boundary.incidence, angle, "incidence");
    near(boundary.critical.expect("towards air"), portable::asin(1.0 / 1.5), "critical angle");
    assert!(boundary.is_total() && boundary.reflectance == 1.0 && boundary.transmittance == 0.0);
    assert_eq!(told.rays[told.children(0).next().expect("a child")].kind, Kind::Reflected);
}

/// A stack of slabs of indices, one touching the next, and a ray from above at an angle: Snell's law keeps n sin θ from boundary
/// to boundary, and what goes on is the product of Fresnel's transmittances.
fn goes_through_slabs(indices: &[f64], angle: f64, planted: f64) {
    let mut text = String::from("[render]\ndepth = 30\nmin_weight = 0\n[background]\ncolor = 1\n");
    for (number, index) in indices.iter().enumerate() {
        let (top, bottom) = (-(number as f64) * 1.5, -(number as f64) * 1.5 - 1.0);
        text += &format!(
            "[[object]]\nname = \"slab {number}\"\nbox = {{ min = [-900, {bottom:?}, -900], max = [900, {top:?}, 900] }}\n\
             material = {{ dielectric = {{ ior = {index:?} }} }}\n"
        );
    }
    let mut stage = Stage::new(&text);
    stage.settings.depth = 2 * indices.len() as u16 + 2;
    let told = told(&stage, [0.0, 1.0, 0.0], [portable::sin(angle), -portable::cos(angle), 0.0]);
    let rays = chain(&told);
    assert_eq!(rays.len(), 2 * indices.len() + 1);
    let (mut through, mut expected) = (1.0, 1.0);
    for (number, ray) in rays.iter().enumerate() {
        // Colours are f32.
        let carried = f64::from(ray.throughput.g);
        assert!((carried / through - 1.0).abs() < 1e-6, "ray {number}: {carried}, expected {through}");
        let Some(surface) = &ray.surface else { continue };
        let boundary = &surface.boundaries[0];
        let [from, to] = if number % 2 == 0 { [1.0, indices[number / 2]] } else { [indices[number / 2], 1.0] };
        near(boundary.media[0].index, from, "index before");
        near(boundary.media[1].index, to, "index behind");
        near(from * portable::sin(boundary.incidence), portable::sin(angle), "n sin before");
        near(to * portable::sin(boundary.refraction.expect("refracts")), portable::sin(angle), "n sin behind");
        through *= boundary.transmittance;
        // Apart from the engine: the angle inside follows from the one outside.
        let cosine = |n: f64| (1.0 - (portable::sin(angle) / n) * (portable::sin(angle) / n)).sqrt();
        expected *= 1.0 - reflectance(cosine(from), from, to);
        near(through, expected + planted, "product of transmittances");
    }
    let last = told.terms.iter().find(|term| term.kind == TermKind::Background && term.ray.is_some());
    assert!(last.is_some(), "some light comes through");
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 48, failure_persistence: None, ..ProptestConfig::default() })]
    #[test]
    fn chains_of_slabs_follow_snell_and_fresnel(
        indices in prop::collection::vec(1.05..2.5_f64, 1..5),
        angle in 0.0..1.3_f64,
    ) {
        goes_through_slabs(&indices, angle, 0.0);
    }
}

#[test]
fn a_wrong_chain_is_told() {
    goes_through_slabs(&[1.5, 1.7], 0.7, 0.0);
    must_fail("the product is off", || goes_through_slabs(&[1.5, 1.7], 0.7, 1e-11));
}
