//! DEFLATE (RFC 1951) for filtered rows of pictures: zeros that follow each other are told as repetitions of the one before, all
//! other bytes by a Huffman code made for the strip at hand.
//!
//! What a filter leaves is zero where the picture is smooth, and small numbers without much of a pattern elsewhere; searching
//! for longer repetitions costs ten times as much as all of this and gains little. A strip is one block, and what follows it
//! begins with a new byte, so that strips can be compressed each by itself and joined.

use std::iter::repeat_n;
use std::ops::Range;

use super::huffman::{code_lengths, codes};

/// Literals, the end of a block, and lengths of repetitions.
const SYMBOLS: usize = 286;
const END_OF_BLOCK: usize = 256;
/// The longest code: four of them fit between two flushes of the bit buffer.
const LIMIT: usize = 12;
/// The longest repetition.
const LONGEST: usize = 258;
/// Symbols of the code for the lengths of the other codes, and the order in which its own lengths are told.
const LENGTH_SYMBOLS: usize = 19;
const LENGTH_ORDER: [usize; LENGTH_SYMBOLS] = [16, 17, 18, 0, 8, 7, 9, 6, 10, 5, 11, 4, 12, 3, 13, 2, 14, 1, 15];
/// More than the bytes of a block's header and end.
const FRAME: usize = 512;

/// Compresses bytes into one block that is not the last, and an empty stored one, at whose end a byte ends.
///
/// `zlib_header` are bytes to begin with.
pub fn compress(zlib_header: &[u8], bytes: &[u8]) -> Vec<u8> {
    let segments = segments(bytes);
    let counts = count(bytes, &segments);
    let lengths = code_lengths(&counts, LIMIT);
    let mut total = 0;
    for symbol in 0..SYMBOLS {
        let extra = symbol.checked_sub(END_OF_BLOCK + 1).map_or(0, |at| u64::from(LENGTHS.extra_bits[at]) + 1);
        total += u64::from(counts[symbol]) * (u64::from(lengths[symbol]) + extra);
    }

    let mut file = vec![0; zlib_header.len() + FRAME + (total / 8) as usize];
    file[..zlib_header.len()].copy_from_slice(zlib_header);
    let mut bits = Bits { bytes: file, at: zlib_header.len(), buffer: 0, count: 0 };
    bits.header(&lengths);
    let codes = codes(&lengths);
    let symbols = std::array::from_fn(|symbol| u32::from(codes[symbol]) | u32::from(lengths[symbol]) << 16);
    let mut bits = write(bytes, &segments, &symbols, bits);
    // An empty stored block: not the last, type 0, up to the next byte; its length, and that inverted.
    bits.put(0, 3);
    bits.flush_to_byte();
    bits.put(0xffff_0000, 32);
    bits.flush();
    bits.bytes.truncate(bits.at);
    bits.bytes
}

/// Bytes as they are, and the zeros that follow them.
struct Segment {
    literals: Range<usize>,
    zeros: usize,
}

impl Segment {
    /// How the zeros are told: some one by one, the first of which the others repeat; how many of the longest repetitions; and
    /// the length of one more if that is not zero. None is shorter than three, the least there can be.
    #[inline(always)]
    fn parts(&self) -> (usize, usize, usize) {
        let Some(repeated) = self.zeros.checked_sub(1) else { return (0, 0, 0) };
        let (longest, last) = (repeated / LONGEST, repeated % LONGEST);
        if last < 3 { (1 + last, longest, 0) } else { (1, longest, last) }
    }
}

/// Finds the runs of zeros that are worth it, which are those with a word of zeros in them: one look tells.
fn segments(bytes: &[u8]) -> Vec<Segment> {
    let (words, _) = bytes.as_chunks::<8>();
    let value = |at: usize| u64::from_le_bytes(words[at]);
    let mut segments = Vec::new();
    let (mut begin, mut at) = (0, 0);
    loop {
        at += words[at..].iter().take_while(|&&word| word != [0; 8]).count();
        if at == words.len() {
            segments.push(Segment { literals: begin..bytes.len(), zeros: 0 });
            return segments;
        }
        // The zeros at the end of the word before, if they are no part of the run before.
        let before = if at > 0 { value(at - 1).leading_zeros() as usize / 8 } else { 0 };
        let first = (at * 8 - before).max(begin);
        let fours = words[at..].as_chunks::<4>().0;
        at += 4 * fours.iter().take_while(|&&four| four == [[0; 8]; 4]).count();
        at += words[at..].iter().take_while(|&&word| word == [0; 8]).count();
        let end = at * 8 + if at < words.len() { value(at).trailing_zeros() as usize / 8 } else { 0 };
        segments.push(Segment { literals: begin..first, zeros: end - first });
        begin = end;
    }
}

/// How often each symbol occurs.
fn count(bytes: &[u8], segments: &[Segment]) -> [u32; SYMBOLS] {
    let mut counts = [0; SYMBOLS];
    for segment in segments {
        for &byte in &bytes[segment.literals.clone()] {
            counts[usize::from(byte)] += 1;
        }
        let (alone, longest, last) = segment.parts();
        counts[0] += alone as u32;
        counts[usize::from(LENGTHS.symbols[LONGEST])] += longest as u32;
        if last > 0 {
            counts[usize::from(LENGTHS.symbols[last])] += 1;
        }
    }
    counts[END_OF_BLOCK] = 1;
    // A code needs two symbols.
    counts[0] = counts[0].max(1);
    counts
}

/// Writes the segments by the codes of their symbols; the upper half of a code is its length.
///
/// The bits are taken and given back, so that they stay in registers meanwhile.
fn write(bytes: &[u8], segments: &[Segment], symbols: &[u32; SYMBOLS], mut bits: Bits) -> Bits {
    for segment in segments {
        let (fours, rest) = bytes[segment.literals.clone()].as_chunks::<4>();
        for four in fours {
            for &byte in four {
                bits.put_symbol(symbols[usize::from(byte)]);
            }
            bits.flush();
        }
        for &byte in rest {
            bits.put_symbol(symbols[usize::from(byte)]);
        }
        bits.flush();
        if segment.zeros == 0 {
            continue;
        }
        let (alone, longest, last) = segment.parts();
        for _ in 0..alone {
            bits.put_symbol(symbols[0]);
        }
        bits.flush();
        for length in repeat_n(LONGEST, longest).chain((last > 0).then_some(last)) {
            let symbol = usize::from(LENGTHS.symbols[length]);
            let at = symbol - END_OF_BLOCK - 1;
            let base = usize::from(LENGTHS.bases[at]);
            bits.put_symbol(symbols[symbol]);
            // The rest of the length, and the only code for a distance, which is one.
            bits.put((length - base) as u64, u32::from(LENGTHS.extra_bits[at]) + 1);
            bits.flush();
        }
    }
    bits.put_symbol(symbols[END_OF_BLOCK]);
    bits.flush();
    bits
}

/// Bits, the first one lowest in its byte.
#[derive(Debug)]
struct Bits {
    /// As long as ever needed, and longer by a word.
    bytes: Vec<u8>,
    /// How many bytes are finished.
    at: usize,
    /// Bits that are not there yet, the first one lowest.
    buffer: u64,
    count: u32,
}

impl Bits {
    /// Adds bits to the buffer; between two flushes there may be 56.
    #[inline(always)]
    fn put(&mut self, bits: u64, count: u32) {
        self.buffer |= bits << self.count;
        self.count += count;
    }

    #[inline(always)]
    fn put_symbol(&mut self, symbol: u32) {
        self.put((symbol & 0xffff).into(), symbol >> 16);
    }

    /// Writes whole bytes.
    #[inline(always)]
    fn flush(&mut self) {
        // There is always room: the length of everything is known before it is written.
        if let Some(word) = self.bytes.get_mut(self.at..).and_then(|rest| rest.first_chunk_mut()) {
            *word = self.buffer.to_le_bytes();
        }
        self.at += self.count as usize / 8;
        self.buffer >>= self.count & !7;
        self.count &= 7;
    }

    /// Fills the last byte with zeros.
    fn flush_to_byte(&mut self) {
        self.count = self.count.next_multiple_of(8);
        self.flush();
    }

    /// The beginning of a block with codes of its own: the lengths of all of them, which are told by a code too.
    fn header(&mut self, lengths: &[u8; SYMBOLS]) {
        // The code for distances has one symbol, of one bit.
        let told = run_lengths(lengths.iter().copied().chain([1]));
        let mut counts = [0; LENGTH_SYMBOLS];
        for (symbol, ..) in &told {
            counts[*symbol] += 1;
        }
        let length_lengths = code_lengths(&counts, 7);
        let length_codes = codes(&length_lengths);

        // Not the last block, and type 2; how many codes there are, less the fewest possible.
        self.put(0b100, 3);
        self.put((SYMBOLS - 257) as u64, 5);
        self.put(0, 5);
        self.put((LENGTH_SYMBOLS - 4) as u64, 4);
        self.flush();
        for symbol in LENGTH_ORDER {
            self.put(length_lengths[symbol].into(), 3);
            self.flush();
        }
        for (symbol, extra, count) in told {
            self.put(length_codes[symbol].into(), length_lengths[symbol].into());
            self.put(extra, count);
            self.flush();
        }
    }
}

/// Lengths of codes as symbols, each with the value and number of its extra bits: zeros are many.
fn run_lengths(lengths: impl Iterator<Item = u8>) -> Vec<(usize, u64, u32)> {
    let lengths: Vec<u8> = lengths.collect();
    let mut told = Vec::with_capacity(lengths.len());
    for run in lengths.chunk_by(|a, b| a == b) {
        let mut rest = run.len();
        if run[0] == 0 {
            while rest >= 11 {
                let count = rest.min(138);
                told.push((18, count as u64 - 11, 7));
                rest -= count;
            }
            if rest >= 3 {
                told.push((17, rest as u64 - 3, 3));
                rest = 0;
            }
        }
        told.extend(repeat_n((run[0].into(), 0, 0), rest));
    }
    told
}

/// The symbols of repetitions (RFC 1951, section 3.2.5).
struct Lengths {
    /// The symbol of each length.
    symbols: [u16; LONGEST + 1],
    /// The shortest length of each symbol, from the first behind the end of a block.
    bases: [u16; SYMBOLS - END_OF_BLOCK - 1],
    extra_bits: [u8; SYMBOLS - END_OF_BLOCK - 1],
}

static LENGTHS: Lengths = {
    let mut table = Lengths {
        symbols: [0; LONGEST + 1],
        bases: [0; SYMBOLS - END_OF_BLOCK - 1],
        extra_bits: [0; SYMBOLS - END_OF_BLOCK - 1],
    };
    let mut length = 3;
    let mut at = 0;
    while at < table.bases.len() {
        // Eight symbols without extra bits, then four each with one more; the last one has the longest length alone.
        let extra_bits = if at < 8 || at == 28 { 0 } else { at / 4 - 1 };
        if at == 28 {
            length = LONGEST;
        }
        table.bases[at] = length as u16;
        table.extra_bits[at] = extra_bits as u8;
        let end = length + (1 << extra_bits);
        while length < end && length <= LONGEST {
            table.symbols[length] = (END_OF_BLOCK + 1 + at) as u16;
            length += 1;
        }
        at += 1;
    }
    table
};

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    /// What another program reads in it, after a last block and the checksum.
    fn inflate(mut stream: Vec<u8>, bytes: &[u8]) -> Vec<u8> {
        stream.extend([0x03, 0x00]);
        stream.extend(super::super::adler::Adler::of(bytes).value().to_be_bytes());
        fdeflate::decompress_to_vec(&stream).unwrap()
    }

    fn check(bytes: &[u8]) -> usize {
        let stream = compress(&[0x78, 0x01], bytes);
        let length = stream.len();
        assert!(inflate(stream, bytes) == bytes, "{} bytes", bytes.len());
        length
    }

    #[test]
    fn runs_of_any_length_come_back() {
        for run in (0..1100).chain([258 * 40, 258 * 40 + 1, 100_000]) {
            for (before, after) in [(0, 0), (1, 0), (0, 3), (5, 9)] {
                check(&[vec![3; before], vec![0; run], vec![7; after]].concat());
            }
        }
    }

    #[test]
    fn every_byte_and_none_come_back() {
        check(&[]);
        check(&[0]);
        check(&(0..=255).collect::<Vec<u8>>());
        // So unequal that codes without a limit would be too long.
        let unequal: Vec<u8> = (0..20_u8).flat_map(|byte| repeat_n(byte + 1, 1 << byte)).collect();
        check(&unequal);
    }

    #[test]
    fn smooth_rows_become_small() {
        assert!(check(&[0; 100_000]) < 200);
        let noise: Vec<u8> = (0..100_000_u32).map(|i| (i.wrapping_mul(2_654_435_761) >> 24) as u8).collect();
        assert!(check(&noise) < 101_000);
    }

    #[test]
    fn a_wrong_byte_would_be_seen() {
        let mut stream = compress(&[0x78, 0x01], &[9; 100]);
        let end = stream.len() - 8;
        stream[end] ^= 4;
        stream.extend([0x03, 0x00]);
        stream.extend(super::super::adler::Adler::of(&[9; 100]).value().to_be_bytes());
        assert_ne!(fdeflate::decompress_to_vec(&stream).ok(), Some(vec![9; 100]));
    }

    proptest! {
        #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::default() })]
        #[test]
        fn anything_comes_back(bytes in prop::collection::vec(prop_oneof![3 => Just(0_u8), 1 => any::<u8>()], 0..3000)) {
            check(&bytes);
        }
    }
}
