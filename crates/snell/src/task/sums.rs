//! The sums of samples' terms.

use snell_math::Rgb;
use snell_math::lanes::{Bits, Floats, LaneColor, Lanes, WIDTH};

/// What the terms of each sample add up to, in the order in which they are added: red, green and blue apart, so that the rays of
/// neighbouring samples add to them side by side.
#[derive(Clone, Debug, Default)]
pub struct SampleSums {
    /// Longer than there are samples, so that eight places follow each.
    planes: [Vec<f32>; 3],
    count: usize,
}

impl SampleSums {
    /// So many samples, all black.
    pub fn reset(&mut self, count: usize) {
        self.count = count;
        for plane in &mut self.planes {
            plane.clear();
            plane.resize(count + WIDTH - 1, 0.0);
        }
    }

    /// How many samples there are.
    pub fn count(&self) -> usize {
        self.count
    }

    /// The sums, in order.
    pub fn iter(&self) -> impl ExactSizeIterator<Item = Rgb> {
        let [r, g, b] = &self.planes;
        let (r, g, b) = (&r[..self.count], &g[..self.count], &b[..self.count]);
        (0..self.count).map(move |i| Rgb::new(r[i], g[i], b[i]))
    }

    /// Adds to one sample.
    #[inline(always)]
    pub fn add_one(&mut self, sample: u32, share: Rgb) {
        for (plane, component) in self.planes.iter_mut().zip(share.to_array()) {
            plane[sample as usize] += component;
        }
    }

    /// Adds terms to the samples of some lanes, which begin at place `at` of their row: each term to its own lanes. What belongs to one
    /// sample is added lane by lane, and of each lane term by term.
    #[inline(always)]
    pub fn add<L: Lanes, const N: usize>(
        &mut self,
        samples: &[u32; WIDTH],
        at: usize,
        terms: [(Bits, LaneColor<L::Floats>); N],
    ) {
        if L::COUNT == WIDTH && are_neighbours(samples) {
            let first = samples[0] as usize;
            let [r, g, b] = &mut self.planes;
            let (Some(r), Some(g), Some(b)) = (row_of(r, first), row_of(g, first), row_of(b, first)) else { return };
            let mut sum = LaneColor { r: Floats::load(r, 0), g: Floats::load(g, 0), b: Floats::load(b, 0) };
            for (lanes, shares) in terms {
                sum = (sum + shares).or_where_not(lanes, sum);
            }
            let LaneColor { r: red, g: green, b: blue }: LaneColor<L::Floats> = sum;
            red.store(r, 0);
            green.store(g, 0);
            blue.store(b, 0);
            return;
        }
        let mut rows = [[[0.0; WIDTH]; 3]; N];
        let mut all = Bits::NONE;
        for ((lanes, shares), rows) in terms.iter().zip(&mut rows) {
            shares.store(rows, 0);
            all |= *lanes;
        }
        for lane in all.lanes() {
            for ((lanes, _), [r, g, b]) in terms.iter().zip(&rows) {
                if lanes.has(lane) {
                    self.add_one(samples[at + lane], Rgb::new(r[lane], g[lane], b[lane]));
                }
            }
        }
    }
}

/// True where eight samples follow each other.
#[inline(always)]
fn are_neighbours(samples: &[u32; WIDTH]) -> bool {
    let mut same = true;
    for (lane, sample) in (0..).zip(samples) {
        same &= *sample == samples[0].wrapping_add(lane);
    }
    same
}

/// Eight places from one on.
#[inline(always)]
fn row_of(plane: &mut [f32], first: usize) -> Option<&mut [f32; WIDTH]> {
    plane.get_mut(first..)?.first_chunk_mut()
}

#[cfg(test)]
mod tests {
    use std::array::from_fn;

    use proptest::prelude::*;
    use snell_math::lanes::{InstructionSet, Work, dispatch};

    use super::*;

    struct Adding<'a>(&'a mut SampleSums, &'a [u32; WIDTH], [Bits; 2], &'a [[[f32; WIDTH]; 3]; 2]);

    impl Work for Adding<'_> {
        type Output = ();
        #[inline(always)]
        fn run<L: Lanes>(self) {
            let Self(sums, samples, lanes, shares) = self;
            for at in (0..WIDTH).step_by(L::COUNT) {
                let lanes = lanes.map(|lanes| Bits(lanes.0 >> at) & L::all());
                let terms = [(lanes[0], LaneColor::load(&shares[0], at)), (lanes[1], LaneColor::load(&shares[1], at))];
                sums.add::<L, 2>(samples, at, terms);
            }
        }
    }

    proptest! {
        #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::default() })]
        #[test]
        fn sums_are_those_of_one_share_after_the_other(
            rounds in prop::collection::vec((0_u32..30, 0_u32..4, any::<[u8; 2]>(), -1e3..1e3f32), 1..20),
        ) {
            for set in InstructionSet::available() {
                let (mut sums, mut expected) = (SampleSums::default(), [Rgb::BLACK; 30]);
                sums.reset(expected.len());
                for &(first, step, lanes, share) in &rounds {
                    // All one sample's, neighbours, or others. Not all need be there: lanes that are not meant may hold anything.
                    let samples: [u32; WIDTH] = from_fn(|lane| first + step * lane as u32);
                    let there = samples.iter().filter(|&&sample| sample < 30).count();
                    let lanes = lanes.map(|lanes| Bits(lanes) & Bits::first(there));
                    let shares: [[[f32; WIDTH]; 3]; 2] =
                        from_fn(|term| from_fn(|row| from_fn(|lane| share / (1 + term + row * 10 + lane) as f32)));
                    dispatch(set, Adding(&mut sums, &samples, lanes, &shares));
                    for lane in 0..there {
                        for (lanes, [r, g, b]) in lanes.iter().zip(&shares) {
                            if lanes.has(lane) {
                                expected[samples[lane] as usize] += Rgb::new(r[lane], g[lane], b[lane]);
                            }
                        }
                    }
                }
                prop_assert_eq!(sums.iter().collect::<Vec<_>>(), expected.to_vec(), "{:?}", set);
            }
        }
    }

    #[test]
    fn what_was_there_before_is_forgotten() {
        let mut sums = SampleSums::default();
        sums.reset(3);
        sums.add_one(1, Rgb::WHITE);
        assert_eq!(sums.iter().collect::<Vec<_>>(), [Rgb::BLACK, Rgb::WHITE, Rgb::BLACK]);
        sums.reset(2);
        assert_eq!(sums.count(), 2);
        assert!(sums.iter().all(|sum| sum == Rgb::BLACK));
    }
}
