//! Numbers for tests, the same everywhere: SplitMix64 (Steele, Lea and Flood, OOPSLA 2014).

use snell_math::{Point3, Vector3};

pub(crate) struct Random(pub u64);

impl Random {
    pub(crate) fn bits(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let z = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    /// Below `count`.
    pub(crate) fn index(&mut self, count: usize) -> usize {
        self.bits() as usize % count
    }

    /// In [−1, 1).
    pub(crate) fn number(&mut self) -> f64 {
        (self.bits() >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
    }

    /// In the cube of side 2 around the origin.
    pub(crate) fn vector(&mut self) -> Vector3 {
        Vector3::new(self.number(), self.number(), self.number())
    }

    /// As [`Random::vector`].
    pub(crate) fn point(&mut self) -> Point3 {
        Point3::ORIGIN + self.vector()
    }
}
