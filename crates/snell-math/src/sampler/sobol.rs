//! Sobol's sequence in four dimensions.
//!
//! Follows: Sobol', "On the distribution of points in a cube", 1967; Bratley and Fox, "Algorithm 659", ACM TOMS 14(1),
//! 1988, for the recurrence; the primitive polynomials of degree 0 to 3 with the first direction numbers that Joe and Kuo
//! recommend, "Constructing Sobol' Sequences with Better Two-Dimensional Projections", SIAM J. Sci. Comput. 30, 2008.
//! The sequence is a (t, 4)-sequence in base 2 with t = 3, the sum of the degrees less one.

/// A primitive polynomial over the numbers 0 and 1, and where its direction numbers begin.
struct Dimension {
    degree: usize,
    /// The inner coefficients, highest power first.
    inner: u32,
    /// m₁, m₂, …: odd, and mᵢ < 2ⁱ.
    first: [u32; 3],
}

/// x + 1, x² + x + 1 and x³ + x + 1; the first dimension is the digits of the index, mirrored.
const DIMENSIONS: [Dimension; 3] = [
    Dimension { degree: 1, inner: 0, first: [1, 0, 0] },
    Dimension { degree: 2, inner: 1, first: [1, 3, 0] },
    Dimension { degree: 3, inner: 1, first: [1, 3, 1] },
];

/// What each value of each four bits of the index adds (exclusive or) to the four coordinates: 2 KiB.
static NIBBLES: [[[u32; 4]; 16]; 8] = nibbles();

/// The direction numbers: what each bit of the index adds to each coordinate.
const fn directions() -> [[u32; 4]; 32] {
    let mut directions = [[0; 4]; 32];
    let mut bit = 0;
    while bit < 32 {
        directions[bit][0] = 1 << (31 - bit);
        let mut dimension = 0;
        while dimension < DIMENSIONS.len() {
            let Dimension { degree, inner, first } = &DIMENSIONS[dimension];
            directions[bit][dimension + 1] = if bit < *degree {
                first[bit] << (31 - bit)
            } else {
                let oldest = directions[bit - *degree][dimension + 1];
                let mut value = oldest ^ (oldest >> *degree);
                let mut back = 1;
                while back < *degree {
                    if (*inner >> (*degree - 1 - back)) & 1 == 1 {
                        value ^= directions[bit - back][dimension + 1];
                    }
                    back += 1;
                }
                value
            };
            dimension += 1;
        }
        bit += 1;
    }
    directions
}

const fn nibbles() -> [[[u32; 4]; 16]; 8] {
    let directions = directions();
    let mut table = [[[0; 4]; 16]; 8];
    let mut place = 0;
    while place < 8 {
        let mut value = 0;
        while value < 16 {
            let mut bit = 0;
            while bit < 4 {
                let mut coordinate = 0;
                while coordinate < 4 && (value >> bit) & 1 == 1 {
                    table[place][value][coordinate] ^= directions[4 * place + bit][coordinate];
                    coordinate += 1;
                }
                bit += 1;
            }
            value += 1;
        }
        place += 1;
    }
    table
}

/// The point of an index, in units of 2⁻³².
#[inline]
pub(super) fn point(index: u32) -> [u32; 4] {
    let mut sum = [0; 4];
    for (place, table) in NIBBLES.iter().enumerate() {
        let added = &table[(index >> (4 * place)) as usize & 15];
        for (sum, added) in sum.iter_mut().zip(added) {
            *sum ^= added;
        }
    }
    sum
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_first_points_are_those_of_the_literature() {
        // Bratley and Fox, and every table of the sequence since: the points 1 to 4 in eighths.
        let eighths = |index: u32| point(index).map(|x| x >> 29);
        assert_eq!(eighths(0), [0, 0, 0, 0]);
        assert_eq!(eighths(1), [4, 4, 4, 4]);
        assert_eq!(eighths(2), [2, 6, 6, 6]);
        assert_eq!(eighths(3), [6, 2, 2, 2]);
        assert_eq!(eighths(4)[..2], [1, 5]);
    }

    #[test]
    fn tables_say_what_bits_say() {
        let directions = directions();
        for index in [0_u32, 1, 12_345, 0x8000_0001, 0xdead_beef, u32::MAX] {
            let mut expected = [0; 4];
            for bit in (0..32).filter(|bit| (index >> bit) & 1 == 1) {
                for coordinate in 0..4 {
                    expected[coordinate] ^= directions[bit][coordinate];
                }
            }
            assert_eq!(point(index), expected);
        }
    }
}
