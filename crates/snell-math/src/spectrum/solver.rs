//! The smooth reflectance of a colour: its coefficients, found by the method of Levenberg and Marquardt.
//!
//! Follows: Jakob and Hanika, "A Low-Dimensional Function Space for Efficient Spectral Upsampling", Computer Graphics Forum 38(2)
//! (Eurographics), 2019, for the functions; Nocedal and Wright, "Numerical Optimization", 2nd edition, section 10.3, for the
//! method, which is Gauss and Newton's with a shorter step where that does not lead downhill. What is made small is the
//! difference to the wanted linear sRGB components under D65, of which the three coefficients can nearly always make zero.
//!
//! Wavelengths are nanometres at the door and t = (λ − 595) / 235 inside, −1 to 1 over the visible range.

use super::daylight::{LUMINOUS_NM, SRGB_SCALE, d65};
use super::observer::{VISIBLE_NM, color_matching};
use super::xyz_to_linear_srgb;

const STEP_NM: f64 = 5.0;
const NODES: usize = 95;
const MIDDLE_NM: f64 = 0.5 * (VISIBLE_NM[0] + VISIBLE_NM[1]);
const HALF_NM: f64 = 0.5 * (VISIBLE_NM[1] - VISIBLE_NM[0]);

/// What is near enough, in each linear component.
const CLOSE: f64 = 1e-7;
/// Steps of one search; most colours take less than ten.
const MOST_STEPS: u32 = 60;
/// Pieces of the way from grey to a colour that is not found at once.
const MOST_PIECES: u32 = 64;

/// What a node's reflectance adds to the linear components under D65; they sum to exactly one, to rounding.
const WEIGHTS: [[f64; 3]; NODES] = {
    let mut weights = [[0.0; 3]; NODES];
    let mut sum = [0.0; 3];
    let mut node = 0;
    while node < NODES {
        let wavelength_nm = VISIBLE_NM[0] + STEP_NM * node as f64;
        let rgb = xyz_to_linear_srgb(color_matching(wavelength_nm));
        let mut channel = 0;
        while channel < 3 {
            let weight = rgb[channel] * SRGB_SCALE[channel] * d65(wavelength_nm) * STEP_NM / LUMINOUS_NM;
            weights[node][channel] = weight;
            sum[channel] += weight;
            channel += 1;
        }
        node += 1;
    }
    node = 0;
    while node < NODES {
        let mut channel = 0;
        while channel < 3 {
            weights[node][channel] /= sum[channel];
            channel += 1;
        }
        node += 1;
    }
    weights
};

/// The coordinate t of a wavelength.
#[inline]
pub(super) fn coordinate(wavelength_nm: f64) -> f64 {
    (wavelength_nm - MIDDLE_NM) * (1.0 / HALF_NM)
}

/// The coefficients of t⁰, t¹ and t² for a reflectance with these linear sRGB components in [0, 1].
pub(super) fn solve(color: [f64; 3]) -> [f64; 3] {
    let mean = (color[0] + color[1] + color[2]) / 3.0;
    let start = [grey(mean), 0.0, 0.0];
    if color[0] == color[1] && color[1] == color[2] {
        return start;
    }
    let (mut best, mut error) = search(start, color);
    let mut pieces = 4;
    while error > CLOSE && pieces <= MOST_PIECES {
        // From a grey on, in pieces of the way, each from where the last one ended.
        let from = mean.clamp(0.1, 0.9);
        let mut coefficients = [grey(from), 0.0, 0.0];
        let mut reached = f64::INFINITY;
        for piece in 1..=pieces {
            let share = f64::from(piece) / f64::from(pieces);
            (coefficients, reached) = search(coefficients, color.map(|c| from + (c - from) * share));
        }
        if reached < error {
            (best, error) = (coefficients, reached);
        }
        pieces *= 4;
    }
    best
}

/// The coefficient of a grey: where the sigmoid is this; ±10⁹ for black and white, which rounds to 0 and 1.
fn grey(value: f64) -> f64 {
    ((value - 0.5) / (value * (1.0 - value)).max(1e-300).sqrt()).clamp(-1e9, 1e9)
}

/// Goes downhill from some coefficients; where that leads, and the largest difference of a component there.
fn search(start: [f64; 3], color: [f64; 3]) -> ([f64; 3], f64) {
    let mut at = start;
    let mut here = Model::at(at);
    let mut residual = here.residual(color);
    let mut damping = 1e-3;
    for _ in 0..MOST_STEPS {
        if largest(residual) < CLOSE {
            break;
        }
        let Some(step) = here.step(residual, damping) else { break };
        let next: [f64; 3] = std::array::from_fn(|i| at[i] - step[i]);
        let there = Model::at(next);
        let new = there.residual(color);
        if squares(new) < squares(residual) {
            (at, here, residual) = (next, there, new);
            damping = (damping * 0.1).max(1e-14);
        } else {
            damping *= 10.0;
            if damping > 1e12 {
                break;
            }
        }
    }
    (at, largest(residual))
}

fn squares(v: [f64; 3]) -> f64 {
    v[0] * v[0] + v[1] * v[1] + v[2] * v[2]
}

fn largest(v: [f64; 3]) -> f64 {
    v[0].abs().max(v[1].abs()).max(v[2].abs())
}

/// The components of a reflectance under D65, and how they change with its coefficients.
struct Model {
    color: [f64; 3],
    /// By channel, then by coefficient.
    slopes: [[f64; 3]; 3],
}

impl Model {
    fn at(coefficients: [f64; 3]) -> Self {
        let (mut color, mut slopes) = ([0.0; 3], [[0.0; 3]; 3]);
        for (node, weights) in WEIGHTS.iter().enumerate() {
            let t = (node as f64 - 0.5 * (NODES - 1) as f64) * (2.0 / (NODES - 1) as f64);
            let x = (coefficients[2] * t + coefficients[1]) * t + coefficients[0];
            let root = 1.0 / (1.0 + x * x).sqrt();
            let value = 0.5 + 0.5 * x * root;
            let slope = 0.5 * root * root * root;
            for channel in 0..3 {
                color[channel] += weights[channel] * value;
                let change = weights[channel] * slope;
                slopes[channel][0] += change;
                slopes[channel][1] += change * t;
                slopes[channel][2] += change * t * t;
            }
        }
        Self { color, slopes }
    }

    fn residual(&self, color: [f64; 3]) -> [f64; 3] {
        std::array::from_fn(|channel| self.color[channel] - color[channel])
    }

    /// The step to be taken back: (JᵀJ + damping · diagonal)⁻¹ Jᵀ residual; `None` where that is no number.
    fn step(&self, residual: [f64; 3], damping: f64) -> Option<[f64; 3]> {
        let j = &self.slopes;
        let mut normal: [[f64; 3]; 3] =
            std::array::from_fn(|a| std::array::from_fn(|b| j[0][a] * j[0][b] + j[1][a] * j[1][b] + j[2][a] * j[2][b]));
        let right: [f64; 3] =
            std::array::from_fn(|a| j[0][a] * residual[0] + j[1][a] * residual[1] + j[2][a] * residual[2]);
        for (i, row) in normal.iter_mut().enumerate() {
            row[i] += damping * row[i] + 1e-300;
        }
        solve_symmetric(normal, right)
    }
}

/// The solution of a positive definite system, by Cholesky's decomposition.
fn solve_symmetric(m: [[f64; 3]; 3], r: [f64; 3]) -> Option<[f64; 3]> {
    let a = m[0][0].sqrt();
    let (b, c) = (m[1][0] / a, m[2][0] / a);
    let d = (m[1][1] - b * b).sqrt();
    let e = (m[2][1] - b * c) / d;
    let f = (m[2][2] - c * c - e * e).sqrt();
    let x = r[0] / a;
    let y = (r[1] - b * x) / d;
    let z = (r[2] - c * x - e * y) / f;
    let third = z / f;
    let second = (y - e * third) / d;
    let first = (x - b * second - c * third) / a;
    let solution = [first, second, third];
    solution.iter().all(|value| value.is_finite()).then_some(solution)
}
