//! The checksum of a zlib stream (RFC 1950, section 9) in parts: what two stretches of bytes have, their concatenation has by
//! arithmetic alone.

/// The largest prime below 2^16.
const MODULUS: u64 = 65521;

/// The checksum of some bytes, and their number.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Adler {
    value: u32,
    length: u64,
}

impl Adler {
    /// Of no bytes.
    pub const EMPTY: Self = Self { value: 1, length: 0 };

    /// Of bytes.
    pub fn of(bytes: &[u8]) -> Self {
        Self { value: simd_adler32::adler32(&bytes), length: bytes.len() as u64 }
    }

    /// Of these bytes and then others.
    pub fn followed_by(self, other: Self) -> Self {
        let halves = |value: u32| (u64::from(value & 0xffff), u64::from(value >> 16));
        let ((a, b), (other_a, other_b)) = (halves(self.value), halves(other.value));
        // The second sum counts the first one once more for every byte; the other began with one instead of `a`.
        let one_less = a + MODULUS - 1;
        let first = (one_less + other_a) % MODULUS;
        let second = (b + other_b + one_less % MODULUS * (other.length % MODULUS)) % MODULUS;
        Self { value: (second << 16 | first) as u32, length: self.length + other.length }
    }

    /// The four bytes of the stream, as a number.
    pub fn value(self) -> u32 {
        self.value
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn parts_give_the_whole() {
        let bytes: Vec<u8> = (0..200_000_u32).map(|i| (i.wrapping_mul(i) >> 3) as u8 | 0xc0).collect();
        for cut in [0, 1, 2, 65520, 65521, 65522, 131_042, 199_999, 200_000] {
            let (front, back) = bytes.split_at(cut);
            assert_eq!(Adler::of(front).followed_by(Adler::of(back)), Adler::of(&bytes), "{cut}");
            assert_eq!(Adler::of(front).followed_by(Adler::of(back)).followed_by(Adler::EMPTY), Adler::of(&bytes));
        }
        assert_ne!(Adler::of(b"ab").followed_by(Adler::of(b"c")), Adler::of(b"abd"));
        // RFC 1950's algorithm by hand: a is 1 + 97, b is 1 · 1 + 97.
        assert_eq!(Adler::of(b"a").value(), 98 << 16 | 98);
    }
}
