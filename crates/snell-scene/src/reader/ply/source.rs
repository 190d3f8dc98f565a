//! The numbers after a PLY header, row by row, from text or from binary data of either byte order.

use std::ops::Range;

use super::header::{Element, Kind, Scalar};
use crate::reader::text::{Lines, Words, parse_float};

/// Why a number could not be had.
pub(super) enum Fail {
    /// The file ends here.
    Ends(usize),
    /// The row's line ends here, before all its numbers.
    ShortRow(Range<usize>),
    /// This word is no number.
    NoNumber(Range<usize>),
}

/// Where the numbers come from.
pub(super) trait Source {
    /// The least number of bytes that a number of a type takes.
    fn least_size(scalar: Scalar) -> u64;
    /// Bytes left to read.
    fn remaining(&self) -> u64;
    /// To the next row. A row's numbers follow by [`Source::number`].
    fn begin_row(&mut self) -> Result<(), Fail>;
    /// The next number of the row.
    fn number(&mut self, scalar: Scalar) -> Result<f64, Fail>;
    /// The row is done. Gives the place of words that nobody asked for.
    fn end_row(&mut self) -> Option<Range<usize>>;
    /// The place of the last number, or of the row where it has none.
    fn place(&self) -> Range<usize>;

    /// Reads rows of three finite `float` numbers and no more, as long as they are such and at most `rows`; says how many. The
    /// row after them is read by [`Source::number`], which tells what is wrong with it. Only where that is faster.
    fn plain_positions(&mut self, _rows: u64, _positions: &mut Vec<[f32; 3]>) -> u64 {
        0
    }

    /// As [`Source::plain_positions`], rows of a list of three corners that are there and no more.
    fn plain_triangles(&mut self, _list: (Scalar, Scalar), _rows: u64, _vertices: u64, _corners: &mut Vec<u32>) -> u64 {
        0
    }

    /// Skips all rows of an element.
    fn skip(&mut self, element: &Element) -> Result<(), Fail>;
}

/// Numbers as words, a row a line; empty lines are skipped.
pub(super) struct Ascii<'a> {
    bytes: &'a [u8],
    lines: Lines<'a>,
    line: Range<usize>,
    words: Words<'a>,
    last: Range<usize>,
}

impl<'a> Ascii<'a> {
    pub fn new(bytes: &'a [u8], start: usize) -> Self {
        let none = start..start;
        let (lines, words) = (Lines::new(bytes, start, false), Words::new(bytes, none.clone()));
        Self { bytes, lines, line: none.clone(), words, last: none }
    }
}

impl Source for Ascii<'_> {
    fn least_size(_: Scalar) -> u64 {
        // A digit and what separates it from the next.
        2
    }

    fn remaining(&self) -> u64 {
        // The last line's end may be missing.
        (self.bytes.len() - self.lines.position()) as u64 + 1
    }

    fn begin_row(&mut self) -> Result<(), Fail> {
        loop {
            let Some(line) = self.lines.next_line() else { return Err(Fail::Ends(self.bytes.len())) };
            self.words = Words::new(self.bytes, line.clone());
            if self.words.clone().next().is_some() {
                self.last = line.clone();
                self.line = line;
                return Ok(());
            }
        }
    }

    #[inline]
    fn number(&mut self, _: Scalar) -> Result<f64, Fail> {
        let Some(word) = self.words.next() else { return Err(Fail::ShortRow(self.line.clone())) };
        self.last = word.range();
        parse_float(word.text).ok_or_else(|| Fail::NoNumber(word.range()))
    }

    fn end_row(&mut self) -> Option<Range<usize>> {
        self.words.next().map(|word| word.start..self.line.end)
    }

    fn place(&self) -> Range<usize> {
        self.last.clone()
    }

    fn skip(&mut self, element: &Element) -> Result<(), Fail> {
        (0..element.count).try_for_each(|_| self.begin_row())
    }
}

/// Numbers as they stand in memory.
pub(super) struct Binary<'a, const BIG: bool> {
    bytes: &'a [u8],
    position: usize,
    last: usize,
}

impl<'a, const BIG: bool> Binary<'a, BIG> {
    pub fn new(bytes: &'a [u8], position: usize) -> Self {
        Self { bytes, position: position.min(bytes.len()), last: position }
    }

    #[inline]
    fn take<const N: usize>(&mut self) -> Result<[u8; N], Fail> {
        let Some(&taken) = self.bytes[self.position..].first_chunk::<N>() else {
            return Err(Fail::Ends(self.bytes.len()));
        };
        self.last = self.position;
        self.position += N;
        Ok(taken)
    }

    #[inline]
    fn word(bytes: [u8; 4]) -> u32 {
        if BIG { u32::from_be_bytes(bytes) } else { u32::from_le_bytes(bytes) }
    }

    fn advance(&mut self, by: u64) -> Result<(), Fail> {
        if by > self.remaining() {
            return Err(Fail::Ends(self.bytes.len()));
        }
        self.position += by as usize;
        Ok(())
    }
}

impl<const BIG: bool> Source for Binary<'_, BIG> {
    fn least_size(scalar: Scalar) -> u64 {
        scalar.size() as u64
    }

    fn remaining(&self) -> u64 {
        (self.bytes.len() - self.position) as u64
    }

    #[inline]
    fn begin_row(&mut self) -> Result<(), Fail> {
        self.last = self.position;
        Ok(())
    }

    #[inline]
    fn number(&mut self, scalar: Scalar) -> Result<f64, Fail> {
        macro_rules! number {
            ($type:ty) => {{
                let bytes = self.take()?;
                f64::from(if BIG { <$type>::from_be_bytes(bytes) } else { <$type>::from_le_bytes(bytes) })
            }};
        }
        Ok(match scalar {
            Scalar::I8 => number!(i8),
            Scalar::U8 => number!(u8),
            Scalar::I16 => number!(i16),
            Scalar::U16 => number!(u16),
            Scalar::I32 => number!(i32),
            Scalar::U32 => number!(u32),
            Scalar::F32 => number!(f32),
            Scalar::F64 => number!(f64),
        })
    }

    fn end_row(&mut self) -> Option<Range<usize>> {
        None
    }

    fn plain_positions(&mut self, rows: u64, positions: &mut Vec<[f32; 3]>) -> u64 {
        let (records, _) = self.bytes[self.position..].as_chunks::<12>();
        let before = positions.len();
        let records = &records[..rows.min(records.len() as u64) as usize];
        let decoded = records.iter().map(|record| {
            let (numbers, _) = record.as_chunks::<4>();
            [0, 1, 2].map(|axis| f32::from_bits(Self::word(numbers[axis])))
        });
        positions.extend(decoded.take_while(|position| position.iter().all(|c| c.is_finite())));
        let read = positions.len() - before;
        self.position += 12 * read;
        read as u64
    }

    fn plain_triangles(
        &mut self,
        (count, item): (Scalar, Scalar),
        rows: u64,
        vertices: u64,
        corners: &mut Vec<u32>,
    ) -> u64 {
        // What would be negative is too large as well.
        let limit = match (count, item) {
            (Scalar::U8 | Scalar::I8, Scalar::U32) => vertices,
            (Scalar::U8 | Scalar::I8, Scalar::I32) => vertices.min(1 << 31),
            _ => return 0,
        };
        let (records, _) = self.bytes[self.position..].as_chunks::<13>();
        let mut read = 0;
        for &[size, ref numbers @ ..] in &records[..rows.min(records.len() as u64) as usize] {
            let (numbers, _) = numbers.as_chunks::<4>();
            let triangle = [0, 1, 2].map(|corner| Self::word(numbers[corner]));
            if size != 3 || triangle.iter().any(|&corner| u64::from(corner) >= limit) {
                break;
            }
            corners.extend(triangle);
            read += 1;
        }
        self.position += 13 * read;
        read as u64
    }

    fn place(&self) -> Range<usize> {
        self.last..self.position
    }

    fn skip(&mut self, element: &Element) -> Result<(), Fail> {
        let row = element.properties.iter().try_fold(0u64, |sum, property| match property.kind {
            Kind::Scalar(scalar) => Some(sum + scalar.size() as u64),
            Kind::List { .. } => None,
        });
        if let Some(row) = row {
            return self.advance(element.count.saturating_mul(row));
        }
        for _ in 0..element.count {
            for property in &element.properties {
                match property.kind {
                    Kind::Scalar(scalar) => self.advance(scalar.size() as u64)?,
                    Kind::List { count, item } => {
                        let length = self.number(count)?.max(0.0) as u64;
                        self.advance(length.saturating_mul(item.size() as u64))?;
                    }
                }
            }
        }
        Ok(())
    }
}
