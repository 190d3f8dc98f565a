//! Light inside a body: what absorption leaves, and where scattering sends it.
//!
//! Follows: Beer and Lambert's law. Henyey and Greenstein's phase function is its own sampling density and stands beside the
//! routine that samples it, in `snell_math::warp`. Coefficients are per unit of length of the space in which distances are measured (world units).

use snell_math::lanes::{Floats, LaneColor, Lanes, WIDTH, Work, exponential_to_f32};
pub use snell_math::warp::henyey_greenstein_density as henyey_greenstein;
use snell_math::{Rgb, portable};

/// The share of light that is left after `distance` in a medium of this coefficient (absorption, or absorption plus
/// scattering): exp(−coefficient · distance), per channel.
///
/// Exactly 1 in a channel whose coefficient is 0, over any distance, and at no cost. Negative products count as 0.
///
/// ```
/// use snell::optics::beer_lambert;
/// use snell_math::Rgb;
/// let left = beer_lambert(Rgb::new(0.0, 1.0, 2.0), 0.5);
/// assert_eq!(left.r, 1.0);
/// assert!((left.g * left.g - left.b).abs() < 1e-7);
/// ```
#[inline]
#[must_use]
pub fn beer_lambert(coefficient: Rgb, distance: f64) -> Rgb {
    coefficient.map(|per_length| {
        let depth = f64::from(per_length) * distance;
        // False for NaN too: 0 · ∞ is no absorption.
        if depth > 0.0 { portable::exp(-depth) as f32 } else { 1.0 }
    })
}

/// As [`beer_lambert`], in each lane.
#[inline(always)]
fn beer_lambert_lanes<L: Lanes>(coefficient: LaneColor<L::Floats>, distance: L) -> LaneColor<L::Floats> {
    let LaneColor { r, g, b } = coefficient;
    LaneColor { r: left_of::<L>(r, distance), g: left_of::<L>(g, distance), b: left_of::<L>(b, distance) }
}

/// The same of one channel.
#[inline(always)]
fn left_of<L: Lanes>(coefficient: L::Floats, distance: L) -> L::Floats {
    let depth = L::from_floats(coefficient) * distance;
    // As above, false for NaN too.
    let absorbed = depth.gt(L::splat(0.0));
    exponential_to_f32(-depth, absorbed).or_where_not(absorbed, L::Floats::splat(1.0))
}

/// How far rays side by side travel in which bodies; none where light passes unchanged.
pub(crate) struct Stretches {
    coefficients: [[f32; WIDTH]; 3],
    distances: [f64; WIDTH],
    any: bool,
}

impl Stretches {
    pub const NONE: Self = Self { coefficients: [[0.0; WIDTH]; 3], distances: [0.0; WIDTH], any: false };

    /// Puts in that of one ray: how much is lost per length, and how far it goes.
    #[inline(always)]
    pub fn put(&mut self, lane: usize, coefficient: Rgb, distance: f64) {
        let lane = lane & (WIDTH - 1);
        for (row, x) in self.coefficients.iter_mut().zip(coefficient.to_array()) {
            row[lane] = x;
        }
        self.distances[lane] = distance;
        self.any = true;
    }

    /// Whether there is any.
    #[inline(always)]
    pub fn any(&self) -> bool {
        self.any
    }

    /// Leaves of the light of rays, from a place on, what [`beer_lambert`] does. Work of its own, since most light is in no body, or in a
    /// clear one.
    #[inline(always)]
    pub fn absorb<L: Lanes>(&self, light: &mut [[f32; WIDTH]; 3], at: usize) {
        L::stage(Absorb { stretches: self, light, at });
    }
}

struct Absorb<'a> {
    stretches: &'a Stretches,
    light: &'a mut [[f32; WIDTH]; 3],
    at: usize,
}

impl Work for Absorb<'_> {
    type Output = ();
    #[inline(always)]
    fn run<L: Lanes>(self) {
        let Self { stretches: Stretches { coefficients, distances, .. }, light, at } = self;
        let left = beer_lambert_lanes(LaneColor::load(coefficients, at), L::load(distances, at));
        (LaneColor::<L::Floats>::load(light, at) * left).store(light, at);
    }
}
