//! What the generators of scenes need of geometry: vectors, turns, the circular functions, and numbers that look random.

/// x, y and z.
pub type Vector = [f64; 3];

pub fn add(a: Vector, b: Vector) -> Vector {
    [a[0] + b[0], a[1] + b[1], a[2] + b[2]]
}

pub fn scaled(v: Vector, factor: f64) -> Vector {
    v.map(|component| component * factor)
}

pub fn dot(a: Vector, b: Vector) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

pub fn cross(a: Vector, b: Vector) -> Vector {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

/// Of length 1.
pub fn normalized(v: Vector) -> Vector {
    scaled(v, 1.0 / dot(v, v).sqrt())
}

/// Sine and cosine; the angle in radians.
#[expect(clippy::disallowed_methods, reason = "what is timed need not have the same bits on every machine")]
pub fn sin_cos(angle: f64) -> (f64, f64) {
    angle.sin_cos()
}

/// `v` turned about a unit axis through the origin, by Rodrigues' formula; the angle in radians.
pub fn turned(v: Vector, axis: Vector, angle: f64) -> Vector {
    let (sine, cosine) = sin_cos(angle);
    let across = scaled(cross(axis, v), sine);
    add(add(scaled(v, cosine), across), scaled(axis, dot(axis, v) * (1.0 - cosine)))
}

/// Numbers that look random and are the same in every run: SplitMix64 (Steele, Lea and Flood 2014).
pub struct Random(u64);

impl Random {
    /// A sequence of its own for each seed.
    pub fn new(seed: u64) -> Self {
        Self(seed)
    }

    /// From `low` up to `high`.
    pub fn between(&mut self, low: f64, high: f64) -> f64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut bits = self.0;
        bits = (bits ^ (bits >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        bits = (bits ^ (bits >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        bits ^= bits >> 31;
        low + (high - low) * ((bits >> 11) as f64 / (1_u64 << 53) as f64)
    }

    /// A unit vector in any direction: a point of a cube's inside that is in the ball.
    pub fn direction(&mut self) -> Vector {
        loop {
            let v = [0; 3].map(|_| self.between(-1.0, 1.0));
            if (0.01..1.0).contains(&dot(v, v)) {
                return normalized(v);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_quarter_turn_about_z_takes_x_to_y() {
        let [x, y, z] = turned([1.0, 0.0, 0.5], [0.0, 0.0, 1.0], std::f64::consts::FRAC_PI_2);
        assert!(x.abs() < 1e-15 && (y - 1.0).abs() < 1e-15 && z == 0.5);
    }

    #[test]
    fn random_numbers_repeat_and_fill_their_range() {
        let draw = |seed| {
            let mut random = Random::new(seed);
            (0..1000).map(|_| random.between(2.0, 3.0)).collect::<Vec<f64>>()
        };
        assert_eq!(draw(1), draw(1));
        assert_ne!(draw(1), draw(2));
        let mean = draw(1).iter().sum::<f64>() / 1000.0;
        assert!((mean - 2.5).abs() < 0.05 && draw(1).iter().all(|x| (2.0..3.0).contains(x)), "{mean}");
        let direction = Random::new(3).direction();
        assert!((dot(direction, direction) - 1.0).abs() < 1e-12);
    }
}
