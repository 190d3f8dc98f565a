//! Filters of PNG (W3C recommendation, third edition, section 9): what a byte is more than its neighbours let expect.
//!
//! Each row has the filter that leaves the least behind, by the sum of magnitudes (section 12.7). The first row of a strip looks
//! only to its left, so that strips do not depend on each other.

/// A filter, by its number in the stream.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(u8)]
enum Filter {
    /// Less the byte one pixel to the left.
    Sub = 1,
    /// Less the byte above.
    Up = 2,
    /// Less that of the bytes to the left, above, and above left that is nearest to left plus above less above left.
    Paeth = 4,
}

/// Filters the rows of a strip, each of `row_length` bytes in pixels of `pixel_length`: before each row stands its filter.
pub fn filter_strip(rows: &[u8], row_length: usize, pixel_length: usize) -> Vec<u8> {
    let count = rows.len() / row_length.max(1);
    let mut filtered = Vec::with_capacity(rows.len() + count);
    let mut best = vec![0; row_length];
    let mut other = vec![0; row_length];
    let nothing = vec![0; row_length];
    let mut above = None;
    for row in rows.chunks_exact(row_length) {
        let mut filter = Filter::Sub;
        let mut residue = apply(filter, row, &nothing, pixel_length, &mut best);
        if let Some(above) = above {
            for another in [Filter::Up, Filter::Paeth] {
                // Nothing is less than nothing.
                if residue > 0 {
                    let left = apply(another, row, above, pixel_length, &mut other);
                    if left < residue {
                        (filter, residue) = (another, left);
                        std::mem::swap(&mut best, &mut other);
                    }
                }
            }
        }
        filtered.push(filter as u8);
        filtered.extend_from_slice(&best);
        above = Some(row);
    }
    filtered
}

/// Filters a row under another one, and returns the sum of magnitudes of what is left.
fn apply(filter: Filter, row: &[u8], above: &[u8], pixel_length: usize, out: &mut [u8]) -> u64 {
    let first = pixel_length.min(row.len());
    let (begin, out) = out.split_at_mut(first);
    // Left of the first pixel all is zero.
    let nothing = [0; 6];
    let neighbours = Neighbours { row: &row[..first], left: &nothing, above, above_left: &nothing };
    #[cfg_attr(not(target_arch = "x86_64"), expect(unused_mut, reason = "only more instructions add to it"))]
    let mut residue = neighbours.filter(filter, begin);

    let rest = row.len() - first;
    let neighbours =
        Neighbours { row: &row[first..], left: &row[..rest], above: &above[first..], above_left: &above[..rest] };
    #[cfg(target_arch = "x86_64")]
    if rest >= avx2::STEP && is_x86_feature_detected!("avx2") {
        // SAFETY: the machine has AVX2.
        residue += unsafe {
            match filter {
                Filter::Sub => avx2::filter::<{ Filter::Sub as u8 }>(&neighbours, out),
                Filter::Up => avx2::filter::<{ Filter::Up as u8 }>(&neighbours, out),
                Filter::Paeth => avx2::filter::<{ Filter::Paeth as u8 }>(&neighbours, out),
            }
        };
        return residue;
    }
    residue + neighbours.filter(filter, out)
}

/// The bytes to be filtered, and three neighbours of each; none is shorter than the row.
struct Neighbours<'a> {
    row: &'a [u8],
    left: &'a [u8],
    above: &'a [u8],
    above_left: &'a [u8],
}

impl Neighbours<'_> {
    /// Filters one byte after the other, and returns the sum of magnitudes.
    fn filter(&self, filter: Filter, out: &mut [u8]) -> u64 {
        let mut residue = 0;
        for (at, out) in out.iter_mut().enumerate() {
            let expected = match filter {
                Filter::Sub => self.left[at],
                Filter::Up => self.above[at],
                Filter::Paeth => paeth(self.left[at], self.above[at], self.above_left[at]),
            };
            *out = self.row[at].wrapping_sub(expected);
            residue += u64::from((*out as i8).unsigned_abs());
        }
        residue
    }
}

/// The predictor of section 9.4.
fn paeth(left: u8, above: u8, above_left: u8) -> u8 {
    let [a, b, c] = [left, above, above_left].map(i16::from);
    let [to_left, to_above, to_above_left] = [b - c, a - c, a + b - 2 * c].map(i16::abs);
    if to_left <= to_above && to_left <= to_above_left {
        left
    } else if to_above <= to_above_left {
        above
    } else {
        above_left
    }
}

#[cfg(target_arch = "x86_64")]
mod avx2 {
    use std::arch::x86_64::*;

    use super::{Filter, Neighbours};

    /// Bytes at a time.
    pub const STEP: usize = 32;

    /// Filters one step of bytes or more, and returns the sum of magnitudes. What is left after whole steps is done by a step that
    /// ends with the row and counts only what was not counted yet.
    #[target_feature(enable = "avx2")]
    pub fn filter<const FILTER: u8>(neighbours: &Neighbours<'_>, out: &mut [u8]) -> u64 {
        let count = out.len();
        let Neighbours { row, left, above, above_left } = *neighbours;
        let all = [row, left, above, above_left].map(|bytes| &bytes[..count]);
        let mut sums = _mm256_setzero_si256();
        let [row, left, above, above_left] = all.map(|bytes| bytes.as_chunks::<STEP>().0);
        let steps = row.iter().zip(left).zip(above).zip(above_left);
        for (out, (((row, left), above), above_left)) in out.as_chunks_mut::<STEP>().0.iter_mut().zip(steps) {
            let magnitudes = step::<FILTER>([row, left, above, above_left], out);
            sums = _mm256_add_epi64(sums, _mm256_sad_epu8(magnitudes, _mm256_setzero_si256()));
        }
        let rest = count % STEP;
        let last = all.map(|bytes| bytes.last_chunk::<STEP>());
        if let ([Some(row), Some(left), Some(above), Some(above_left)], Some(out)) =
            (last, out.last_chunk_mut::<STEP>())
        {
            let magnitudes = step::<FILTER>([row, left, above, above_left], out);
            let mut is_counted = [0_u8; STEP];
            is_counted[STEP - rest..].fill(0xff);
            let counted = _mm256_and_si256(magnitudes, load(&is_counted));
            sums = _mm256_add_epi64(sums, _mm256_sad_epu8(counted, _mm256_setzero_si256()));
        }
        let mut four = [0_u64; 4];
        // SAFETY: 32 bytes are there to be written.
        unsafe { _mm256_storeu_si256(four.as_mut_ptr().cast(), sums) };
        four.iter().sum()
    }

    #[target_feature(enable = "avx2")]
    fn load(bytes: &[u8; STEP]) -> __m256i {
        // SAFETY: 32 bytes are there to be read.
        unsafe { _mm256_loadu_si256(bytes.as_ptr().cast()) }
    }

    /// Filters one step of a row, given with its neighbours to the left, above and above left, and returns the magnitudes.
    #[inline]
    #[target_feature(enable = "avx2")]
    fn step<const FILTER: u8>([row, left, above, above_left]: [&[u8; STEP]; 4], out: &mut [u8; STEP]) -> __m256i {
        let expected = if FILTER == Filter::Sub as u8 {
            load(left)
        } else if FILTER == Filter::Up as u8 {
            load(above)
        } else {
            paeth(load(left), load(above), load(above_left))
        };
        let residue = _mm256_sub_epi8(load(row), expected);
        // SAFETY: 32 bytes are there to be written.
        unsafe { _mm256_storeu_si256(out.as_mut_ptr().cast(), residue) };
        _mm256_abs_epi8(residue)
    }

    /// As [`super::paeth`]. What needs a ninth bit there, the distance of left plus above less twice above left, is here the sum of
    /// the two other distances where both lie on the same side, and their difference where not; a sum that is clipped at 255
    /// still is no less than either.
    #[target_feature(enable = "avx2")]
    fn paeth(left: __m256i, above: __m256i, above_left: __m256i) -> __m256i {
        let (a, b, c) = (left, above, above_left);
        let (larger_b, larger_a) = (_mm256_max_epu8(b, c), _mm256_max_epu8(a, c));
        let to_left = _mm256_sub_epi8(larger_b, _mm256_min_epu8(b, c));
        let to_above = _mm256_sub_epi8(larger_a, _mm256_min_epu8(a, c));
        let is_same_side = _mm256_cmpeq_epi8(_mm256_cmpeq_epi8(larger_b, b), _mm256_cmpeq_epi8(larger_a, a));
        let nearer = _mm256_min_epu8(to_left, to_above);
        let difference = _mm256_sub_epi8(_mm256_max_epu8(to_left, to_above), nearer);
        let to_above_left = _mm256_blendv_epi8(difference, _mm256_adds_epu8(to_left, to_above), is_same_side);
        let least = _mm256_min_epu8(nearer, to_above_left);
        let other = _mm256_blendv_epi8(c, b, _mm256_cmpeq_epi8(to_above, least));
        _mm256_blendv_epi8(other, a, _mm256_cmpeq_epi8(to_left, least))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const ALL: [Filter; 3] = [Filter::Sub, Filter::Up, Filter::Paeth];

    fn noise(length: usize, seed: u32) -> Vec<u8> {
        let value = |i: u32| (i.wrapping_mul(2_654_435_761).wrapping_add(seed).rotate_left(i % 32)) >> 21;
        // Small values too, so that neighbours are often equal.
        (0..length as u32).map(|i| (value(i) as u8) & [0xff, 0x03, 0x80][i as usize / 64 % 3]).collect()
    }

    /// By the words of the standard, backwards.
    fn undo(filter: Filter, filtered: &[u8], above: &[u8], pixel_length: usize) -> Vec<u8> {
        let mut row: Vec<u8> = Vec::new();
        for (at, byte) in filtered.iter().enumerate() {
            let [left, above_left] =
                [&row, above].map(|bytes| at.checked_sub(pixel_length).map_or(0, |before| bytes[before]));
            let expected = match filter {
                Filter::Sub => left,
                Filter::Up => above[at],
                Filter::Paeth => paeth(left, above[at], above_left),
            };
            row.push(byte.wrapping_add(expected));
        }
        row
    }

    #[test]
    fn filters_come_undone_and_their_sums_are_right() {
        for length in [3, 6, 30, 96, 99, 100 * 6, 1023] {
            for pixel_length in [3, 6] {
                let (row, above) = (noise(length, 1), noise(length, 77));
                for filter in ALL {
                    let mut out = vec![0; length];
                    let residue = apply(filter, &row, &above, pixel_length, &mut out);
                    assert!(undo(filter, &out, &above, pixel_length) == row, "{filter:?}, {length} bytes");
                    assert_eq!(residue, out.iter().map(|&byte| u64::from((byte as i8).unsigned_abs())).sum::<u64>());
                    let mut plain = vec![0; length];
                    let nothing = [0; 6];
                    let first = pixel_length.min(length);
                    let begin = Neighbours { row: &row, left: &nothing, above: &above, above_left: &nothing };
                    begin.filter(filter, &mut plain[..first]);
                    let rest =
                        Neighbours { row: &row[first..], left: &row, above: &above[first..], above_left: &above };
                    rest.filter(filter, &mut plain[first..]);
                    assert!(plain == out, "{filter:?} by all instructions");
                }
            }
        }
    }

    #[test]
    fn paeth_is_the_same_for_all_bytes() {
        // All triples in which at least one of four values is left, in rows that are long enough for any instructions.
        for left in [0, 1, 127, 255] {
            let mut row = vec![left; 65536 * 2];
            let mut above = vec![0; 65536 * 2];
            for triple in 0..65536 {
                row[triple * 2 + 1] = (triple >> 3) as u8;
                (above[triple * 2], above[triple * 2 + 1]) = (triple as u8, (triple >> 8) as u8);
            }
            let mut out = vec![0; row.len()];
            apply(Filter::Paeth, &row, &above, 1, &mut out);
            assert!(undo(Filter::Paeth, &out, &above, 1) == row);
        }
    }

    #[test]
    fn a_wrong_filter_would_be_seen() {
        let (row, above) = (noise(99, 1), noise(99, 77));
        let mut out = vec![0; 99];
        apply(Filter::Up, &row, &above, 3, &mut out);
        assert_ne!(undo(Filter::Paeth, &out, &above, 3), row);
        assert_ne!(undo(Filter::Up, &out, &row, 3), row);
    }

    #[test]
    fn each_row_has_the_filter_that_fits_it() {
        let ramp: Vec<u8> = (0..60).map(|i| i / 3 * 5).collect();
        let noise = noise(60, 3);
        let strip = filter_strip(&[&ramp[..], &noise, &noise].concat(), 60, 3);
        assert_eq!((strip.len(), strip[0], strip[122]), (183, Filter::Sub as u8, Filter::Up as u8));
        assert!(strip[123..].iter().all(|&byte| byte == 0));
    }
}
