//! The optics against closed forms, an independent table, and instruments (lenses, a prism) whose behaviour is known.

mod directions;
mod films;
mod fresnel;
mod instruments;
mod medium;

use proptest::prelude::*;
use snell_math::{Normal3, Vector3, portable};

/// As many random cases as proptest's default, with no files written.
fn config() -> ProptestConfig {
    ProptestConfig { failure_persistence: None, ..ProptestConfig::default() }
}

/// A unit normal, and a unit vector on its side whose cosine with it is given, at an azimuth.
fn normal_and_wo(normal: [f64; 3], cos: f64, azimuth: f64) -> (Normal3, Vector3) {
    let n = Vector3::from(normal).try_normalize().unwrap_or(Vector3::Y);
    let (u, v) = n.orthonormal_basis();
    let sin = ((1.0 - cos) * (1.0 + cos)).sqrt();
    let wo = u * (sin * portable::cos(azimuth)) + v * (sin * portable::sin(azimuth)) + n * cos;
    (Normal3::from(n), wo.normalize())
}

/// The same, random.
fn any_normal_and_wo() -> impl Strategy<Value = (Normal3, Vector3)> {
    (prop::array::uniform3(-1.0..1.0f64), 1e-3..1.0f64, 0.0..6.3f64)
        .prop_map(|(normal, cos, azimuth)| normal_and_wo(normal, cos, azimuth))
}
