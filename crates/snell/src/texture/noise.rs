//! Gradient noise in three dimensions: smooth, of zero mean, never repeating, chosen by a seed.
//!
//! K. Perlin, "Improving Noise", SIGGRAPH 2002: every point of the integer lattice has one of twelve gradients, the directions
//! from a cube's centre to the middles of its edges; their eight linear functions are blended with 6t⁵ − 15t⁴ + 10t³. Instead
//! of his table of 256 entries, which repeats, a hash of seed and lattice point chooses the gradient.
//!
//! Coordinates are `f64` in texture space, one lattice cell a unit.

/// From here on every coordinate is a whole number, hence a zero of the noise.
const LATTICE_LIMIT: f64 = (1_u64 << 52) as f64;

/// The gradients, in any order.
const GRADIENTS: [[f64; 3]; 12] = [
    [1.0, 1.0, 0.0],
    [-1.0, 1.0, 0.0],
    [1.0, -1.0, 0.0],
    [-1.0, -1.0, 0.0],
    [1.0, 0.0, 1.0],
    [-1.0, 0.0, 1.0],
    [1.0, 0.0, -1.0],
    [-1.0, 0.0, -1.0],
    [0.0, 1.0, 1.0],
    [0.0, -1.0, 1.0],
    [0.0, 1.0, -1.0],
    [0.0, -1.0, -1.0],
];

/// Odd multipliers that spread the lattice over 64 bits before [`mix`]: 2⁶⁴ over the powers of 1.2207…, the positive root of
/// x⁴ = x + 1, which makes the sums of few multiples differ much.
const SPREAD: [u64; 3] = [0xD1B5_4A32_D192_ED03, 0xABC9_8388_FB8F_AC03, 0x8CB9_2BA7_2F3D_8DD7];

/// A well-mixed bijection of 64 bits: the output function of SplitMix64 (Steele, Lea and Flood, OOPSLA 2014).
#[inline]
pub(super) fn mix(value: u64) -> u64 {
    let value = (value ^ (value >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
    let value = (value ^ (value >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
    value ^ (value >> 31)
}

/// The noise at a point: zero at lattice points, twice continuously differentiable, within ±1.0364 (the
/// largest blend of the largest values that each corner's gradients can give), of mean 0 and standard deviation 0.27 over
/// space; zero where a coordinate is NaN or so large that it is whole.
#[inline]
pub(super) fn gradient_noise(seed: u64, point: [f64; 3]) -> f64 {
    if !point.iter().all(|c| c.abs() < LATTICE_LIMIT) {
        return 0.0;
    }
    let cell = point.map(f64::floor);
    let [x, y, z] = [point[0] - cell[0], point[1] - cell[1], point[2] - cell[2]];
    let [u, v, w] = [x, y, z].map(fade);

    // Each corner's hash starts from a sum in which one step along an axis adds that axis's multiplier.
    let spread = |axis: usize| (cell[axis] as i64 as u64).wrapping_mul(SPREAD[axis]);
    let base = seed.wrapping_add(spread(0)).wrapping_add(spread(1)).wrapping_add(spread(2));
    let along_x =
        |hash: u64, y: f64, z: f64| lerp(corner(hash, x, y, z), corner(hash.wrapping_add(SPREAD[0]), x - 1.0, y, z), u);
    let along_y = |hash: u64, z: f64| lerp(along_x(hash, y, z), along_x(hash.wrapping_add(SPREAD[1]), y - 1.0, z), v);
    lerp(along_y(base, z), along_y(base.wrapping_add(SPREAD[2]), z - 1.0), w)
}

/// The linear function of one corner, by its hash and the point relative to it.
#[inline]
fn corner(hash: u64, x: f64, y: f64, z: f64) -> f64 {
    // The upper half of the hash, scaled to 0..12 without a remainder's bias.
    let gradient = GRADIENTS[(((mix(hash) >> 32) * GRADIENTS.len() as u64) >> 32) as usize];
    gradient[0] * x + gradient[1] * y + gradient[2] * z
}

#[inline]
fn fade(t: f64) -> f64 {
    t * t * t * (t * (t * 6.0 - 15.0) + 10.0)
}

#[inline]
fn lerp(a: f64, b: f64, t: f64) -> f64 {
    a + t * (b - a)
}

#[cfg(test)]
mod tests;
