//! Octaves of gradient noise and the numbers in [0, 1] that are made of them; see [`NoiseKind`] for what they look like.
//!
//! K. Perlin, "An Image Synthesizer", SIGGRAPH 1985: octaves of doubled frequency and halved strength, their sum, the sum of
//! their absolute values (turbulence), and stripes disturbed by them (marble). Coordinates in texture space, `f64`.

use std::f64::consts::TAU;

use snell_math::{Point3, Vector3, portable};
use snell_scene::scene::texture::NoiseKind;

use super::noise::{gradient_noise, mix};

/// The most octaves that are summed.
pub(super) const MAX_OCTAVES: u32 = 16;

/// How many rings a noise of 1 moves wood by.
const WOOD_DISTURBANCE: f64 = 0.25;

/// One octave: its own lattice, so that the zeros and the grain of different octaves do not fall on each other, nor on the
/// whole numbers where the faces of objects like to lie.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Octave {
    seed: u64,
    frequency: f64,
    strength: f64,
    offset: Vector3,
}

/// The first `count` octaves of the noise with a seed.
pub(super) fn octaves(seed: u32, count: u32) -> impl Iterator<Item = Octave> {
    let mut scale = 1.0;
    (0..count).map(move |octave| {
        let seed = mix((u64::from(seed) << 32) | u64::from(octave));
        // 21 bits for each axis, all of [0, 1).
        let unit = |shift: u32| ((mix(seed) >> shift) & 0x1F_FFFF) as f64 / f64::from(1 << 21);
        let frequency = scale;
        scale *= 2.0;
        Octave { seed, frequency, strength: 1.0 / frequency, offset: Vector3::new(unit(0), unit(21), unit(42)) }
    })
}

/// What a kind of noise gives at a point: in [0, 1].
pub(super) fn value(kind: NoiseKind, octaves: &[Octave], point: Point3) -> f64 {
    let number = match kind {
        NoiseKind::Smooth => 0.5 + 0.5 * sum(octaves, point),
        NoiseKind::Turbulence => turbulence(octaves, point),
        NoiseKind::Marble => 0.5 + 0.5 * wave(point.x() + turbulence(octaves, point)),
        NoiseKind::Wood => {
            // A quarter of a turn back: the middle is noise 0.
            let radius = (point.x() * point.x() + point.z() * point.z()).sqrt();
            0.5 + 0.5 * wave(radius + WOOD_DISTURBANCE * sum(octaves, point) - 0.25)
        }
    };
    number.clamp(0.0, 1.0)
}

fn sum(octaves: &[Octave], point: Point3) -> f64 {
    octaves.iter().map(|octave| octave.strength * octave.noise(point)).sum()
}

fn turbulence(octaves: &[Octave], point: Point3) -> f64 {
    octaves.iter().map(|octave| octave.strength * octave.noise(point).abs()).sum()
}

/// A sine of period 1; the angle is reduced first, so that it is exact far from the origin. Zero where there is no angle.
fn wave(turns: f64) -> f64 {
    if turns.is_finite() { portable::sin(TAU * (turns - turns.floor())) } else { 0.0 }
}

impl Octave {
    #[inline]
    fn noise(&self, point: Point3) -> f64 {
        gradient_noise(self.seed, (point.to_vector() * self.frequency + self.offset).to_array())
    }
}

#[cfg(test)]
mod tests;
