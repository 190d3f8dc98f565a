//! Lobes against their densities, and both ways that light may go.

use snell_math::microfacet::{ConductorCompensation, DielectricCompensation, Ggx};
use snell_math::{Normal3, Point3, Vector3, portable};
use snell_testkit::chi_square::Histogram;
use snell_testkit::{TestRng, must_fail};

use super::lobes::{Lobes, SurfaceColors, Transport};
use super::reflector::Reflector;
use super::rough::{Rough, RoughKind};
use super::spectra::{BLACK, Spectral, WHITE};
use crate::interaction::{SolidId, SurfaceInteraction};
use crate::optics::fresnel_dielectric;

const NM: Spectral = [450.0, 500.0, 550.0, 600.0];
const GLASS: f64 = 1.5;

/// A place on a surface that faces +z.
fn place() -> SurfaceInteraction {
    let up = Normal3::new(0.0, 0.0, 1.0);
    SurfaceInteraction {
        t: 1.0,
        point: Point3::ORIGIN,
        error: 0.0,
        geometric_normal: up,
        shading_normal: up,
        uv: [0.0; 2],
        object_point: Point3::ORIGIN,
        object_inside: Vector3::default(),
        vertex_color: None,
        material: 0,
        object: 0,
        solid: SolidId(0),
    }
}

fn opaque<'a>(diffuse: f64, specular: f64, shininess: f64) -> SurfaceColors<'a> {
    SurfaceColors {
        diffuse: [diffuse; 4],
        specular: [specular; 4],
        shininess,
        mirror: BLACK,
        one_sided: false,
        metal: None,
        boundary: None,
        rough: None,
    }
}

fn rough<'a>(ggx: Ggx, reflector: Reflector, kind: RoughKind<'a>) -> SurfaceColors<'a> {
    SurfaceColors { rough: Some(Rough { ggx, reflector, kind, hero_alone: false }), ..opaque(0.0, 0.0, 1.0) }
}

/// The boundary of rough glass, seen from outside of it or from inside.
fn frosted(ggx: Ggx, compensation: &DielectricCompensation, from_outside: bool) -> SurfaceColors<'_> {
    let [before, beyond] = if from_outside { [1.0, GLASS] } else { [GLASS, 1.0] };
    let reflector = Reflector::dielectric([before; 4], [beyond; 4], None, NM);
    let kind = RoughKind::Dielectric { compensation: Some(compensation), from_outside, tints: [WHITE; 2] };
    rough(ggx, reflector, kind)
}

fn glass_compensation(ggx: Ggx) -> DielectricCompensation {
    DielectricCompensation::new(ggx, GLASS, |cosine, eta| fresnel_dielectric(cosine, eta, 1.0))
}

fn away(cosine: f64) -> Vector3 {
    Vector3::new((1.0 - cosine * cosine).sqrt(), 0.0, cosine)
}

/// Compares the directions that lobes choose with their density, which `planted` spoils unless it is 1.
fn directions_follow_their_density(what: &str, lobes: &Lobes<'_>, tests: u32, planted: f64) {
    let mut rng = TestRng::new(7);
    let histogram = Histogram { samples: 60_000, ..Histogram::of_directions().one_of(tests) };
    histogram.assert_directions(
        what,
        |u| lobes.sample(rng.unit(), u, Transport::Radiance).map(|scattered| scattered.wi),
        |wi| lobes.evaluate(wi, Transport::Radiance).1 * (1.0 + (planted - 1.0) * (wi.x() > 0.0) as u8 as f64),
    );
}

#[test]
fn directions_of_every_lobe_follow_their_density() {
    let ggx = Ggx::from_roughness(0.5);
    let (metal, glass) = (ConductorCompensation::new(ggx), glass_compensation(ggx));
    let mirror = Reflector::dielectric([1.0; 4], [2.5; 4], None, NM);
    let surfaces = [
        ("matt", opaque(0.7, 0.0, 1.0)),
        ("highlight", opaque(0.0, 0.8, 12.0)),
        ("matt with a highlight", opaque(0.4, 0.5, 30.0)),
        ("rough metal", rough(ggx, mirror, RoughKind::Metal { compensation: &metal, average: [0.3; 4] })),
        ("rough glass from outside", frosted(ggx, &glass, true)),
        ("rough glass from inside", frosted(ggx, &glass, false)),
    ];
    let cosines = [0.95, 0.5, 0.2];
    let tests = (surfaces.len() * cosines.len()) as u32;
    for (what, colors) in &surfaces {
        for cosine in cosines {
            let lobes = Lobes::new(colors, &place(), away(cosine));
            directions_follow_their_density(&format!("{what}, cosine {cosine}"), &lobes, tests, 1.0);
        }
    }
    must_fail("a density that is a twentieth too small on one side", || {
        directions_follow_their_density("matt", &Lobes::new(&surfaces[0].1, &place(), away(0.5)), 1, 0.95);
    });
}

/// What light from `wi` becomes seen from `wo`, without the cosine.
fn value(colors: &SurfaceColors<'_>, wo: Vector3, wi: Vector3, transport: Transport) -> f64 {
    Lobes::new(colors, &place(), wo).evaluate(wi, transport).0[0] / wi.z().abs()
}

/// Light that goes from `a` to `b` is weighed as light from `b` to `a` is: radiance one way, power the other.
fn is_reciprocal(colors: [&SurfaceColors<'_>; 2], a: Vector3, b: Vector3, planted: f64) {
    let [on_a, on_b] = colors;
    let (there, back) = (value(on_a, a, b, Transport::Radiance), value(on_b, b, a, Transport::Power) * planted);
    assert!((there - back).abs() <= 1e-9 * (there + back).max(1e-3), "{there} one way, {back} the other");
}

#[test]
fn rough_surfaces_are_reciprocal() {
    let ggx = Ggx::from_roughness(0.4);
    let (metal, glass) = (ConductorCompensation::new(ggx), glass_compensation(ggx));
    let mirror = Reflector::dielectric([1.0; 4], [2.5; 4], None, NM);
    let metal = rough(ggx, mirror, RoughKind::Metal { compensation: &metal, average: [0.3; 4] });
    let [outside, inside] = [true, false].map(|from_outside| frosted(ggx, &glass, from_outside));
    let mut rng = TestRng::new(3);
    let mut direction = || {
        let (cosine, angle) = (0.05 + 0.9 * rng.unit(), 6.0 * rng.unit());
        let sine = (1.0 - cosine * cosine).sqrt();
        Vector3::new(sine * portable::cos(angle), sine * portable::sin(angle), cosine)
    };
    for _ in 0..200 {
        let (a, b) = (direction(), direction());
        is_reciprocal([&opaque(0.6, 0.0, 1.0); 2], a, b, 1.0);
        is_reciprocal([&metal, &metal], a, b, 1.0);
        is_reciprocal([&outside, &outside], a, b, 1.0);
        // A surface faces +z, and what is below it is glass: seen from there the lobes are those of the inside.
        is_reciprocal([&outside, &inside], a, -b, 1.0);
    }
    let (a, b) = (away(0.9), away(0.7));
    must_fail("a hundredth more one way", || is_reciprocal([&metal, &metal], a, b, 1.01));
}
