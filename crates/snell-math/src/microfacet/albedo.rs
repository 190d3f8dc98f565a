//! How much of the light from one direction a rough surface sends on after one bounce, by quadrature.
//!
//! The mirrors seen are sampled on a grid of the spherical cap they come from, so the integrand is Fresnel's share times
//! G₂/G₁, smooth and bounded. No random numbers; the same bits on every machine.

use std::f64::consts::PI;

use super::Ggx;
use crate::{Vector3, portable};

/// Heights and half-turns of the grid.
const GRID: [u32; 2] = [96, 64];
/// Directions of a table.
const NODES: usize = 80;
/// Steps of the average over directions.
const STEPS: u32 = 4096;

/// A function of the cosine c with the normal, by a table in the root of t = ½ (c + c (1 + w) / (c + w)), which is fine near the
/// horizon and where the cosine is about the width w of the mirrors.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct CosineTable {
    width: f64,
    values: [f64; NODES],
}

impl CosineTable {
    /// The tables of two functions that are computed together.
    pub(super) fn pair(width: f64, functions: impl Fn(f64) -> [f64; 2]) -> [Self; 2] {
        // The cosine of a node's place: the root of c² + (1 + 2 w − 2 t) c − 2 t w.
        let cosine = |node: usize| {
            let share = node as f64 / (NODES - 1) as f64;
            let t = share * share;
            let b = 1.0 + 2.0 * width - 2.0 * t;
            let root = (b * b + 8.0 * t * width).sqrt();
            if b > 0.0 { 4.0 * t * width / (b + root) } else { 0.5 * (root - b) }
        };
        // At the horizon itself nothing is seen; the limit is as good as there.
        let values: [[f64; 2]; NODES] = std::array::from_fn(|node| functions(cosine(node).clamp(1e-6 * width, 1.0)));
        [0, 1].map(|which| Self { width, values: values.map(|both| both[which]) })
    }

    /// What is left of 1.
    pub(super) fn rest(self) -> Self {
        Self { values: self.values.map(|value| (1.0 - value).max(0.0)), ..self }
    }

    #[inline]
    pub(super) fn at(&self, cosine: f64) -> f64 {
        let cosine = cosine.clamp(0.0, 1.0);
        let place = 0.5 * (cosine + cosine * (1.0 + self.width) / (cosine + self.width));
        let position = place.sqrt() * (NODES - 1) as f64;
        let node = (position as usize).min(NODES - 2);
        let fraction = position - node as f64;
        self.values[node] * (1.0 - fraction) + self.values[node + 1] * fraction
    }

    /// 2 ∫ f(c) c dc: the mean over light that comes evenly from everywhere.
    pub(super) fn average(&self) -> f64 {
        let mut sum = 0.0;
        for step in 0..STEPS {
            // Even in the root of the cosine, which is denser at the horizon.
            let root = (f64::from(step) + 0.5) / f64::from(STEPS);
            let cosine = root * root;
            sum += 2.0 * self.at(cosine) * cosine * 2.0 * root / f64::from(STEPS);
        }
        sum
    }
}

/// The shares of light from a direction, given by its cosine, that are reflected and transmitted after one bounce. `eta` is the index
/// on its side over that on the other; `fresnel` the share that a mirror reflects, by the cosine with it.
pub(super) fn shares(ggx: Ggx, cosine: f64, eta: f64, fresnel: impl Fn(f64) -> f64) -> [f64; 2] {
    let wo = Vector3::new((1.0 - cosine * cosine).max(0.0).sqrt(), 0.0, cosine);
    let masking = ggx.masking(wo);
    let [ax, ay] = ggx.alpha();
    let stretched = Vector3::new(ax * wo.x(), ay * wo.y(), wo.z()).normalize();
    let (mut reflected, mut transmitted) = (0.0, 0.0);
    for (row, turn) in (0..GRID[0]).flat_map(|row| (0..GRID[1]).map(move |turn| (row, turn))) {
        // Finer towards both ends, where a few mirrors are much inclined: x³ (10 − 15 x + 6 x²), whose slope is the weight.
        let x = (f64::from(row) + 0.5) / f64::from(GRID[0]);
        let height = x * x * x * (10.0 - 15.0 * x + 6.0 * x * x) * (1.0 + stretched.z());
        let weight = 30.0 * x * x * (1.0 - x) * (1.0 - x);
        let radius = (height * (2.0 - height)).max(0.0).sqrt();
        // The other half is its mirror image.
        let angle = PI * (f64::from(turn) + 0.5) / f64::from(GRID[1]);
        let cap = Vector3::new(radius * portable::cos(angle), radius * portable::sin(angle), 1.0 - height);
        let half = cap + stretched;
        let normal = Vector3::new(ax * half.x(), ay * half.y(), half.z().max(0.0)).normalize();
        let facing = wo.dot(normal);
        let share = fresnel(facing);
        let mirrored = normal * (2.0 * facing) - wo;
        if mirrored.z() > 0.0 {
            reflected += weight * share * ggx.masking_shadowing(wo, mirrored) / masking;
        }
        let squared = 1.0 - eta * eta * (1.0 - facing * facing);
        if squared > 0.0 && share < 1.0 {
            let refracted = normal * (eta * facing - squared.sqrt()) - wo * eta;
            if refracted.z() < 0.0 {
                transmitted += weight * (1.0 - share) * ggx.masking_shadowing(wo, refracted) / masking;
            }
        }
    }
    [reflected, transmitted].map(|sum| sum / f64::from(GRID[0] * GRID[1]))
}
