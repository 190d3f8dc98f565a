//! A PNG in strips of rows that are made each by itself, in any order and by any thread, while the rest is not there yet.
//!
//! The rows of a strip are filtered and compressed without a look at others, and become a chunk of the file. What goes over
//! all of them, the checksum of the stream, is put together at the end. So the bytes of the file depend on the picture alone.

use super::adler::Adler;
use super::{PngOptions, deflate, filter, header};
use crate::{BitDepth, EncodeError};

/// The beginning of a zlib stream (RFC 1950): DEFLATE in a window of 32 KiB, not the best compression.
const ZLIB_HEADER: [u8; 2] = [0x78, 0x01];
/// An empty block with fixed codes that is the last one.
const LAST_BLOCK: [u8; 2] = [0x03, 0x00];

/// Bytes of the longest strip: a chunk has less than 2^31, and noise becomes a little longer by compression.
const LONGEST_STRIP: usize = 2_000_000_000;

/// Encodes a PNG in strips. The calls come in any order of strips; [`PngStrips::finish`] wants all of them, from the top.
///
/// ```
/// use snell_image::{BitDepth, DisplayImage, PngOptions, PngStrips, decode_display};
/// // Rows of 50 × 3 codes, as a renderer finishes them.
/// let rows: Vec<u8> = (0..70 * 150_u32).map(|i| (i / 150) as u8).collect();
/// let png = PngStrips::new(50, 70, BitDepth::Eight, &PngOptions::default())?;
/// let strips = (0..png.count()).map(|number| png.encode(number, &rows[png.bytes_of(number)])).collect::<Result<Vec<_>, _>>()?;
/// let file = png.finish(&strips);
/// let picture = decode_display(&file, &Default::default())?;
/// assert_eq!((picture.size(), picture.code(7, 69)), ((50, 70), [69, 69, 69]));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug)]
pub struct PngStrips {
    header: Vec<u8>,
    height: u32,
    row_length: usize,
    pixel_length: usize,
}

/// A strip, ready to be put into a file.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct PngStrip {
    chunk: Vec<u8>,
    adler: Adler,
}

impl PngStrips {
    /// Rows of a strip; the last one may have fewer. A constant, so that a picture is always the same file.
    pub const ROWS: u32 = 32;

    /// Begins a picture.
    ///
    /// # Errors
    /// As [`super::encode_png`].
    pub fn new(width: u32, height: u32, depth: BitDepth, options: &PngOptions) -> Result<Self, EncodeError> {
        let header = header((width, height), depth, options)?;
        let pixel_length = match depth {
            BitDepth::Eight => 3,
            BitDepth::Sixteen => 6,
        };
        let row_length = width as usize * pixel_length;
        if (row_length + 1).saturating_mul(height.min(Self::ROWS) as usize) > LONGEST_STRIP {
            return Err(EncodeError::Format(format!("{} rows of it have too many bytes for a chunk", Self::ROWS)));
        }
        Ok(Self { header, height, row_length, pixel_length })
    }

    /// How many strips there are.
    #[must_use]
    pub fn count(&self) -> u32 {
        self.height.div_ceil(Self::ROWS)
    }

    /// Where the bytes of a strip are in all rows of the picture.
    #[must_use]
    pub fn bytes_of(&self, strip: u32) -> std::ops::Range<usize> {
        let row = |strip: u32| strip.saturating_mul(Self::ROWS).min(self.height) as usize;
        let at = |strip| row(strip).saturating_mul(self.row_length);
        at(strip)..at(strip.saturating_add(1))
    }

    /// Filters and compresses the rows of a strip, counted from the top: bytes of the codes, of 16 bits the higher one first.
    ///
    /// # Errors
    /// Where there are not as many bytes as [`PngStrips::bytes_of`] says.
    pub fn encode(&self, strip: u32, rows: &[u8]) -> Result<PngStrip, EncodeError> {
        if rows.len() != self.bytes_of(strip).len() {
            return Err(EncodeError::Format(format!("{} bytes are not the rows of strip {strip}", rows.len())));
        }
        let filtered = filter::filter_strip(rows, self.row_length, self.pixel_length);
        let begin: &[u8] = if strip == 0 { &ZLIB_HEADER } else { &[] };
        Ok(PngStrip { chunk: chunk(*b"IDAT", &deflate::compress(begin, &filtered)), adler: Adler::of(&filtered) })
    }

    /// The file.
    #[must_use]
    pub fn finish(self, strips: &[PngStrip]) -> Vec<u8> {
        let adler = strips.iter().fold(Adler::EMPTY, |sum, strip| sum.followed_by(strip.adler));
        let [a, b] = LAST_BLOCK;
        let [c, d, e, f] = adler.value().to_be_bytes();
        let length: usize = strips.iter().map(|strip| strip.chunk.len()).sum();
        let mut file = self.header;
        file.reserve_exact(length + 64);
        for strip in strips {
            file.extend_from_slice(&strip.chunk);
        }
        file.extend(chunk(*b"IDAT", &[a, b, c, d, e, f]));
        file.extend(chunk(*b"IEND", &[]));
        file
    }
}

/// A chunk of a PNG: its length, name, content and checksum.
pub fn chunk(name: [u8; 4], content: &[u8]) -> Vec<u8> {
    let mut chunk = Vec::with_capacity(content.len() + 12);
    chunk.extend((content.len() as u32).to_be_bytes());
    chunk.extend(name);
    chunk.extend_from_slice(content);
    let checksum = crc32fast::hash(&chunk[4..]);
    chunk.extend(checksum.to_be_bytes());
    chunk
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{DisplayImage, decode_display};

    /// Light that is smooth, flat and noisy in turn.
    fn codes(width: u32, height: u32) -> Vec<u8> {
        let noise = |i: u32| (i.wrapping_mul(2_654_435_761) >> 24) as u8;
        let pixels = (0..height).flat_map(|y| (0..width).map(move |x| (x, y)));
        pixels
            .flat_map(|(x, y)| match (x / 16 + y / 16) % 3 {
                0 => [x as u8, y as u8, (x + y) as u8],
                1 => [200, 3, 77],
                _ => [0, 1, 2].map(|i| noise((y * width + x) * 3 + i)),
            })
            .collect()
    }

    fn png(width: u32, height: u32) -> PngStrips {
        PngStrips::new(width, height, BitDepth::Eight, &PngOptions::default()).unwrap()
    }

    #[test]
    fn strips_in_any_order_are_the_file() {
        for (width, height) in [(1, 1), (5, 31), (7, 32), (40, 33), (100, 100), (3, 64)] {
            let (png, codes) = (png(width, height), codes(width, height));
            let strip = |number| png.encode(number, &codes[png.bytes_of(number)]).unwrap();
            let mut strips: Vec<_> = (0..png.count()).rev().map(strip).collect();
            strips.reverse();
            assert_eq!(png.bytes_of(png.count() - 1).end, codes.len());
            let file = png.finish(&strips);
            let (triples, _) = codes.as_chunks();
            let picture = DisplayImage::from_codes(width, height, triples.to_vec()).unwrap();
            assert!(decode_display(&file, &Default::default()).unwrap() == picture, "{width} × {height}");
            assert!(file == crate::encode_png(&picture, &PngOptions::default()).unwrap());
        }
    }

    #[test]
    fn the_checksum_is_that_of_all_strips() {
        let (png, codes) = (png(40, 70), codes(40, 70));
        let strips: Vec<_> = (0..3).map(|number| png.encode(number, &codes[png.bytes_of(number)]).unwrap()).collect();
        let stream = |strips: &[PngStrip]| -> Vec<u8> {
            let content = |strip: &PngStrip| strip.chunk[8..strip.chunk.len() - 4].to_vec();
            let file = png.clone().finish(strips);
            // The last two chunks: the end of the stream, and the end of the file.
            let end = &file[file.len() - 12 - 10..file.len() - 12 - 4];
            strips.iter().flat_map(content).chain(end.iter().copied()).collect()
        };
        assert!(fdeflate::decompress_to_vec(&stream(&strips)).is_ok());
        let mut wrong = stream(&strips);
        *wrong.last_mut().unwrap() ^= 1;
        assert!(fdeflate::decompress_to_vec(&wrong).is_err(), "the checksum is wrong");
    }

    #[test]
    fn rows_that_are_not_the_strips_are_refused() {
        let png = png(4, 40);
        assert!(png.encode(0, &[0; 4 * 3 * 32]).is_ok() && png.encode(1, &[0; 4 * 3 * 8]).is_ok());
        for (strip, length) in [(0, 0), (0, 383), (1, 384), (2, 12), (u32::MAX, 1)] {
            assert!(png.encode(strip, &vec![0; length]).is_err());
        }
        let huge = |width, height| PngStrips::new(width, height, BitDepth::Sixteen, &PngOptions::default());
        assert!(huge(1 << 28, 1).is_ok(), "the most pixels of a picture");
        assert!(huge(1 << 28, 32).is_err() && huge(0, 1).is_err() && huge(u32::MAX, 1).is_err());
    }
}
