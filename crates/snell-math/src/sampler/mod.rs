//! The random numbers of paths: Owen-scrambled Sobol' points, as a pure function of (seed, pixel, sample, dimension).
//!
//! Nothing here has a state or knows how many samples there will be: the first N samples of a longer rendering are those
//! of a shorter one. The samples of a pixel are well spread in each set of four dimensions; between sets, and between
//! pixels, they are independent.
//!
//! Follows: Burley, "Practical Hash-based Owen Scrambling", JCGT 9(4), 2020: the four-dimensional points are scrambled by
//! a hash that is a nested uniform permutation, and padded to any number of dimensions by other orders of the same
//! points, each of which is shuffled by such a permutation too, so that every aligned block of 2ᵏ samples stays a net.
//! Owen, "Randomly permuted (t,m,s)-nets and (t,s)-sequences", 1995, for what scrambling does: the variance of a smooth
//! integrand falls as N⁻³ instead of N⁻¹.

mod sobol;

use crate::sampling::{hash, nested_permutation, to_unit_f64};

/// The dimensions of one set: draws of the same set are spread together.
pub const SET: u32 = 4;

/// The random numbers of one sample of a pixel.
///
/// Dimensions are drawn in any order. Which dimension serves which purpose is up to the caller, who should give
/// numbers that belong together (the two of a direction) the same set of four: dimensions 4k to 4k + 3.
///
/// ```
/// use snell_math::sampler::Sampler;
/// let sampler = Sampler::new(0, [320, 240], 7);
/// let [u, v] = sampler.pair(2);
/// assert_eq!([u, v], [sampler.single(2), sampler.single(3)]);
/// assert_eq!(sampler.set(0)[2..], [u, v]);
/// assert!((0.0..1.0).contains(&u) && (0.0..1.0).contains(&v));
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Sampler {
    /// A hash of the seed and the pixel.
    key: u32,
    /// Another hash of them, so that a collision of one is none of both.
    other_key: u32,
    sample: u32,
}

impl Sampler {
    /// The numbers of sample `sample` of the pixel in column `pixel[0]` and row `pixel[1]`, under a seed.
    #[inline]
    #[must_use]
    pub const fn new(seed: u32, pixel: [u32; 2], sample: u32) -> Self {
        let [x, y] = pixel;
        // The last two arguments keep these apart from the numbers that `sampling::hash` gives for samples.
        Self { key: hash(seed, x, y, u32::MAX, 0), other_key: hash(seed, x, y, u32::MAX, 1), sample }
    }

    /// The four numbers in [0, 1) of dimensions 4 `set` to 4 `set` + 3.
    #[inline]
    #[must_use]
    pub fn set(&self, set: u32) -> [f64; SET as usize] {
        let shuffled = nested_permutation(self.sample, hash(self.key, self.other_key, set, 0, 0));
        let point = sobol::point(shuffled);
        std::array::from_fn(|i| self.scrambled(point[i], set, i as u32))
    }

    /// The number in [0, 1) of a dimension.
    #[inline]
    #[must_use]
    pub fn single(&self, dimension: u32) -> f64 {
        let (set, within) = (dimension / SET, dimension % SET);
        let shuffled = nested_permutation(self.sample, hash(self.key, self.other_key, set, 0, 0));
        self.scrambled(sobol::point(shuffled)[within as usize], set, within)
    }

    /// The numbers in [0, 1) of a dimension and the next one (after the last comes the first). An even dimension gives
    /// two of the same set, in which every block of 2ᵏ samples is stratified in both together.
    #[inline]
    #[must_use]
    pub fn pair(&self, dimension: u32) -> [f64; 2] {
        if dimension % SET == SET - 1 {
            return [self.single(dimension), self.single(dimension.wrapping_add(1))];
        }
        let point = self.set(dimension / SET);
        let within = (dimension % SET) as usize;
        [point[within], point[within + 1]]
    }

    /// A cursor that hands out dimensions one after the other, from `dimension` on.
    ///
    /// ```
    /// use snell_math::sampler::Sampler;
    /// let sampler = Sampler::new(1, [0, 0], 0);
    /// let mut draws = sampler.draws(0);
    /// assert_eq!(draws.single(), sampler.single(0));
    /// assert_eq!(draws.pair(), sampler.pair(2), "pairs begin at even dimensions");
    /// assert_eq!(draws.next_dimension(), 4);
    /// ```
    #[inline]
    #[must_use]
    pub const fn draws(self, dimension: u32) -> Draws {
        Draws { sampler: self, dimension }
    }

    #[inline]
    fn scrambled(&self, digits: u32, set: u32, within: u32) -> f64 {
        to_unit_f64(nested_permutation(digits, hash(self.key, self.other_key, set, within, 1)))
    }
}

/// A [`Sampler`] and the dimension that comes next: see [`Sampler::draws`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Draws {
    sampler: Sampler,
    dimension: u32,
}

impl Draws {
    /// The number in [0, 1) of the next dimension.
    #[inline]
    pub fn single(&mut self) -> f64 {
        let dimension = self.dimension;
        self.dimension = dimension.wrapping_add(1);
        self.sampler.single(dimension)
    }

    /// The numbers in [0, 1) of the next two dimensions that are in one set and begin at an even dimension; one may be
    /// left out before.
    #[inline]
    pub fn pair(&mut self) -> [f64; 2] {
        let dimension = self.dimension.wrapping_add(self.dimension & 1);
        self.dimension = dimension.wrapping_add(2);
        self.sampler.pair(dimension)
    }

    /// The dimension that the next single number will have.
    #[inline]
    #[must_use]
    pub const fn next_dimension(&self) -> u32 {
        self.dimension
    }
}
