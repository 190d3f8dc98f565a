//! Lines, words and numbers of text formats, straight from bytes: nothing is copied, and every word knows its place.
//!
//! Numbers are read as Clinger's fast path allows ("How to read floating point numbers accurately", 1990): up to 19
//! digits and a small power of ten give the correctly rounded number with one multiplication or division; everything else
//! goes to the standard library, which rounds correctly too.

use std::ops::Range;

/// A word and where it starts.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Word<'a> {
    /// The word.
    pub text: &'a [u8],
    /// The place of its first byte in the file.
    pub start: usize,
}

impl Word<'_> {
    /// Its place in the file.
    pub fn range(&self) -> Range<usize> {
        self.start..self.start + self.text.len()
    }
}

/// Walks over lines. A line ends with a line feed, a carriage return, or both.
#[derive(Clone, Debug)]
pub(crate) struct Lines<'a> {
    bytes: &'a [u8],
    position: usize,
    /// A backslash before the line's end continues it on the next one.
    continued: bool,
}

impl<'a> Lines<'a> {
    /// The lines from a place on.
    pub fn new(bytes: &'a [u8], position: usize, continued: bool) -> Self {
        Self { bytes, position, continued }
    }

    /// Where the next line starts.
    pub fn position(&self) -> usize {
        self.position
    }

    /// The next line, without its end.
    pub fn next_line(&mut self) -> Option<Range<usize>> {
        if self.position >= self.bytes.len() {
            return None;
        }
        let start = self.position;
        let mut search = start;
        loop {
            let Some(length) = self.bytes[search..].iter().position(|&b| b == b'\n' || b == b'\r') else {
                self.position = self.bytes.len();
                return Some(start..self.position);
            };
            let end = search + length;
            self.position = end + if self.bytes[end..].starts_with(b"\r\n") { 2 } else { 1 };
            let goes_on = self.continued && end > start && self.bytes[end - 1] == b'\\';
            if !goes_on {
                return Some(start..end);
            }
            search = self.position;
        }
    }
}

/// Walks over the words of a stretch of a file, separated by blanks (and by continued lines' ends).
#[derive(Clone, Debug)]
pub(crate) struct Words<'a> {
    bytes: &'a [u8],
    position: usize,
    end: usize,
}

impl<'a> Words<'a> {
    /// The words of a stretch.
    pub fn new(bytes: &'a [u8], range: Range<usize>) -> Self {
        Self { bytes, position: range.start, end: range.end }
    }

    /// True at a blank, or at a backslash that continues the line.
    fn blank(&self, at: usize) -> bool {
        match self.bytes[at] {
            b' ' | b'\t' | b'\n' | b'\r' | 0x0b | 0x0c => true,
            b'\\' => at + 1 < self.end && matches!(self.bytes[at + 1], b'\n' | b'\r'),
            _ => false,
        }
    }

    /// Everything up to the end without blanks around it, as for names with spaces; empty where nothing is left.
    pub fn rest(mut self) -> Word<'a> {
        while self.position < self.end && self.blank(self.position) {
            self.position += 1;
        }
        while self.end > self.position && self.blank(self.end - 1) {
            self.end -= 1;
        }
        Word { text: &self.bytes[self.position..self.end], start: self.position }
    }
}

impl<'a> Iterator for Words<'a> {
    type Item = Word<'a>;

    #[inline]
    fn next(&mut self) -> Option<Word<'a>> {
        while self.position < self.end && self.blank(self.position) {
            self.position += 1;
        }
        if self.position >= self.end {
            return None;
        }
        let start = self.position;
        while self.position < self.end && !self.blank(self.position) {
            self.position += 1;
        }
        Some(Word { text: &self.bytes[start..self.position], start })
    }
}

/// Powers of ten that f64 holds exactly.
const TENS: [f64; 23] = [
    1e0, 1e1, 1e2, 1e3, 1e4, 1e5, 1e6, 1e7, 1e8, 1e9, 1e10, 1e11, 1e12, 1e13, 1e14, 1e15, 1e16, 1e17, 1e18, 1e19, 1e20,
    1e21, 1e22,
];

/// A decimal number, correctly rounded; also `nan` and `inf`, which the caller refuses where they make no sense.
#[inline]
pub(crate) fn parse_float(text: &[u8]) -> Option<f64> {
    simple_float(text).or_else(|| std::str::from_utf8(text).ok()?.parse().ok())
}

/// The digits of a number and its power of ten.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Decimal {
    pub negative: bool,
    /// The number that its digits are; wrapped around where there are very many.
    pub mantissa: u64,
    /// How many digits there are.
    pub digits: usize,
    /// The power of ten that the mantissa is multiplied by.
    pub exponent: i32,
}

impl Decimal {
    /// The correctly rounded number, where it is simple enough for that.
    #[inline]
    pub fn float(&self) -> Option<f64> {
        // No more than 18 digits, and so without overflow.
        if self.digits > 18 || self.mantissa > 1 << 53 || self.exponent.unsigned_abs() > 22 {
            return None;
        }
        let power = TENS[self.exponent.unsigned_abs() as usize];
        let value = if self.exponent < 0 { self.mantissa as f64 / power } else { self.mantissa as f64 * power };
        Some(if self.negative { -value } else { value })
    }

    /// The digits as a whole number, where they are 18 at most.
    #[inline]
    pub fn integer(&self) -> Option<i64> {
        let value = if self.negative { -(self.mantissa as i64) } else { self.mantissa as i64 };
        (self.digits <= 18).then_some(value)
    }
}

/// The fast path: `None` where the number is not simple enough, or none.
#[inline]
fn simple_float(text: &[u8]) -> Option<f64> {
    // Longer ones seldom are simple.
    if text.len() > 20 {
        return None;
    }
    let mut decimal = Decimal { negative: text.first() == Some(&b'-'), ..Decimal::default() };
    let mut end = usize::from(decimal.negative || text.first() == Some(&b'+'));
    decimal.digits = digits(text, end, &mut decimal.mantissa);
    end += decimal.digits;
    if text.get(end) == Some(&b'.') {
        let fraction = digits(text, end + 1, &mut decimal.mantissa);
        end += 1 + fraction;
        decimal.digits += fraction;
        decimal.exponent = -(fraction as i32);
    }
    if end < text.len() {
        if text[end] | 0x20 != b'e' {
            return None;
        }
        let minus = text.get(end + 1) == Some(&b'-');
        let first = end + 1 + usize::from(minus || text.get(end + 1) == Some(&b'+'));
        let mut power = 0;
        let length = digits(text, first, &mut power);
        if length == 0 || length > 4 || first + length < text.len() {
            return None;
        }
        decimal.exponent += if minus { -(power as i32) } else { power as i32 };
    }
    if decimal.digits == 0 { None } else { decimal.float() }
}

/// How many digits stand from a place on; they are appended to `number`, which wraps around.
#[inline]
pub(crate) fn digits(text: &[u8], start: usize, number: &mut u64) -> usize {
    let mut count = 0;
    for &byte in text.get(start..).unwrap_or_default() {
        let digit = byte.wrapping_sub(b'0');
        if digit > 9 {
            break;
        }
        *number = number.wrapping_mul(10).wrapping_add(u64::from(digit));
        count += 1;
    }
    count
}

/// A decimal whole number with an optional sign; `None` for anything else, and beyond 18 digits.
#[inline]
pub(crate) fn parse_integer(text: &[u8]) -> Option<i64> {
    let (negative, digits) = match text {
        [b'-', rest @ ..] => (true, rest),
        [b'+', rest @ ..] => (false, rest),
        _ => (false, text),
    };
    if digits.is_empty() || digits.len() > 18 {
        return None;
    }
    let mut value = 0i64;
    for &digit in digits {
        if !digit.is_ascii_digit() {
            return None;
        }
        value = value * 10 + i64::from(digit - b'0');
    }
    Some(if negative { -value } else { value })
}

/// Where text after a byte order mark for UTF-8 begins, or what is wrong with the encoding.
pub(crate) fn text_start(bytes: &[u8]) -> Result<usize, &'static str> {
    match bytes {
        [0xef, 0xbb, 0xbf, ..] => Ok(3),
        [0xff, 0xfe, ..] => Err("UTF-16, little endian"),
        [0xfe, 0xff, ..] => Err("UTF-16, big endian"),
        _ => Ok(0),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::with_cases(400) })]
        #[test]
        fn numbers_are_those_of_the_standard_library(text in "[+-]?[0-9]{0,20}(\\.[0-9]{0,12})?([eE][+-]?[0-9]{1,3})?") {
            let standard = text.parse::<f64>().ok();
            prop_assert_eq!(parse_float(text.as_bytes()).map(f64::to_bits), standard.map(f64::to_bits));
        }

        #[test]
        fn whole_numbers_are_those_of_the_standard_library(text in "[+-]?[0-9]{0,17}x?") {
            prop_assert_eq!(parse_integer(text.as_bytes()), text.parse::<i64>().ok());
        }
    }

    #[test]
    fn lines_end_in_three_ways_and_go_on_after_a_backslash() {
        let bytes = b"a b\r\nc \\\r\n d\re\n\nf\\";
        let mut lines = Lines::new(bytes, 0, true);
        let mut all = Vec::new();
        while let Some(line) = lines.next_line() {
            all.push(Words::new(bytes, line).map(|w| String::from_utf8_lossy(w.text).into_owned()).collect::<Vec<_>>());
        }
        let expected: [&[&str]; 5] = [&["a", "b"], &["c", "d"], &["e"], &[], &["f\\"]];
        assert_eq!(all, expected);
    }

    #[test]
    fn the_rest_of_a_line_keeps_its_inner_spaces() {
        let bytes = b"usemtl  a  b  ";
        let mut words = Words::new(bytes, 0..bytes.len());
        words.next();
        assert_eq!(words.rest().text, b"a  b");
    }
}
