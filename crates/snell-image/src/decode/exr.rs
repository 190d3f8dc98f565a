//! OpenEXR (openexr.com, "OpenEXR File Layout") to scene-linear light: scan lines or tiles, half, float or whole numbers,
//! every compression but DWA and HTJ2K. The first part with colours is read, at full resolution: its R, G and B,
//! or Y, or the first layer with such; A where it has one. The picture is the data window; chromaticities other than
//! Rec. 709's are noted. Deep data and subsampled colours are refused.
//!
//! Blocks are decompressed in parallel and put where they say; each pixel is written from one block, so the order has no
//! part in the result.

use std::io::Cursor;
use std::panic::{AssertUnwindSafe, catch_unwind};

use exr::block::chunk::{Chunk, CompressedBlock};
use exr::block::reader::ChunksReader;
use exr::block::{UncompressedBlock, reader::Reader};
use exr::compression::Compression;
use exr::meta::attribute::{ChannelList, SampleType};
use exr::meta::header::Header;
use exr::meta::{BlockDescription, MetaData};
use exr::prelude::f16;
use rayon::prelude::*;
use snell_math::Rgb;

use super::error::{ALPHA_BYTES, COLOR_BYTES};
use super::{DecodeError, Format, Limits, Picture};
use crate::Image;

const FORMAT: Format = Format::Exr;
/// Blocks that are decompressed at once; bounds the memory for blocks on their way.
const BATCH: usize = 64;

/// Decodes an OpenEXR picture.
///
/// # Errors
/// See [`super::decode`].
pub fn decode(bytes: &[u8], limits: &Limits) -> Result<Picture, DecodeError> {
    // The decompressors beneath compute with what a file says of itself; where overflow is checked, B44's panics on damaged
    // blocks. They hold no state that outlives the call, so a panic there means what is said here: the data is damaged.
    catch_unwind(AssertUnwindSafe(|| decode_unguarded(bytes, limits)))
        .unwrap_or_else(|_| Err(DecodeError::Corrupt("the OpenEXR's compressed data is damaged".into())))
}

fn decode_unguarded(bytes: &[u8], limits: &Limits) -> Result<Picture, DecodeError> {
    let reader = Reader::read_from_buffered(Cursor::new(bytes), false).map_err(told)?;
    for header in reader.headers() {
        check_size(header, limits)?;
    }
    let (layer, selection) = select(reader.headers())?;
    let header = &reader.headers()[layer];
    let notes = notes_on(header);
    let (width, height) = sides(header)?;

    // Reads the table of blocks: a file that lies about its size mostly ends within it, before memory is taken.
    let mut chunks = reader.all_chunks(false).map_err(told)?;
    let mut image = Image::filled(width, height, Rgb::BLACK);
    let mut alpha = selection.alpha.map(|_| Image::filled(width, height, 1.0_f32));
    let mut filled = 0_u64;
    let meta_data = chunks.meta_data().clone();
    loop {
        let mut batch = Vec::with_capacity(BATCH);
        for chunk in chunks.by_ref() {
            let chunk = chunk.map_err(told)?;
            if is_wanted(&chunk, layer) {
                batch.push(chunk);
                if batch.len() == BATCH {
                    break;
                }
            }
        }
        if batch.is_empty() {
            break;
        }
        for block in decompress(batch, &meta_data)? {
            filled += put(&block, &meta_data.headers[layer].channels, &selection, &mut image, alpha.as_mut())?;
        }
    }
    if filled < u64::from(width) * u64::from(height) {
        return Err(DecodeError::Corrupt("the OpenEXR is incomplete: some of its blocks are missing".into()));
    }
    Ok(Picture { image, alpha, format: FORMAT, notes })
}

fn decompress(batch: Vec<Chunk>, meta_data: &MetaData) -> Result<Vec<UncompressedBlock>, DecodeError> {
    batch
        .into_par_iter()
        .map(|chunk| UncompressedBlock::decompress_chunk(chunk, meta_data, false).map_err(told))
        .collect()
}

/// Which channels of a part are its colours.
struct Selection {
    /// Red, green, blue; three times the same for gray.
    colors: [usize; 3],
    alpha: Option<usize>,
}

/// The first part that has colours, and which channels they are.
fn select(headers: &[Header]) -> Result<(usize, Selection), DecodeError> {
    if headers.iter().all(|header| header.deep) {
        return Err(DecodeError::Unsupported("the OpenEXR holds deep data, many samples in a pixel".into()));
    }
    for (layer, header) in headers.iter().enumerate().filter(|(_, header)| !header.deep) {
        let names: Vec<String> = header.channels.list.iter().map(|channel| channel.name.to_string()).collect();
        let find = |name: String| names.iter().position(|other| *other == name);
        // Channels without a layer's name first, then each layer in the order of the file.
        let prefixes = names.iter().filter_map(|name| name.rfind('.').map(|dot| &name[..=dot]));
        for prefix in std::iter::once("").chain(prefixes) {
            let channel = |letter: &str| find(format!("{prefix}{letter}"));
            let colors = match (channel("R"), channel("G"), channel("B"), channel("Y")) {
                (Some(red), Some(green), Some(blue), _) => [red, green, blue],
                (None, None, None, Some(gray)) => {
                    if channel("RY").is_some() || channel("BY").is_some() {
                        return Err(DecodeError::Unsupported("the OpenEXR holds luminance and chroma".into()));
                    }
                    [gray; 3]
                }
                _ => continue,
            };
            let alpha = channel("A");
            // What a block of DWA says of its own sizes is believed by the decompressor, and may take all memory.
            if matches!(header.compression, Compression::DWAA(_) | Compression::DWAB(_)) {
                return Err(DecodeError::Unsupported(
                    "the OpenEXR is compressed by DWA; save it with ZIP or PIZ".into(),
                ));
            }
            let sampled = |index: &usize| header.channels.list[*index].sampling.area() != 1;
            if colors.iter().chain(&alpha).any(sampled) || header.channels.list.iter().any(|c| c.sampling.area() != 1) {
                return Err(DecodeError::Unsupported("the OpenEXR holds subsampled channels".into()));
            }
            return Ok((layer, Selection { colors, alpha }));
        }
    }
    Err(DecodeError::Unsupported("the OpenEXR has no channels R, G and B, nor Y".into()))
}

fn sides(header: &Header) -> Result<(u32, u32), DecodeError> {
    let side =
        |length: usize| u32::try_from(length).map_err(|_| DecodeError::TooLarge("the OpenEXR is too large".into()));
    Ok((side(header.layer_size.width())?, side(header.layer_size.height())?))
}

/// Refuses parts that are too large, whether read or not, and blocks that are too large to decompress.
fn check_size(header: &Header, limits: &Limits) -> Result<(), DecodeError> {
    let (width, height) = sides(header)?;
    limits.check(FORMAT, width, height, COLOR_BYTES + ALPHA_BYTES)?;
    let block_pixels = match header.blocks {
        // Blocks of scan lines have 256 lines at most.
        BlockDescription::ScanLines => u64::from(width) * u64::from(height.min(256)),
        BlockDescription::Tiles(tiles) => {
            let [x, y] = [tiles.tile_size.width(), tiles.tile_size.height()].map(|side| side as u64);
            if x == 0 || y == 0 {
                return Err(DecodeError::Corrupt("the OpenEXR's tiles have no pixels".into()));
            }
            x.saturating_mul(y)
        }
    };
    limits.check_bytes(FORMAT, block_pixels.saturating_mul(header.channels.bytes_per_pixel as u64))
}

fn is_wanted(chunk: &Chunk, layer: usize) -> bool {
    chunk.layer_index == layer
        && match &chunk.compressed_block {
            CompressedBlock::ScanLine(_) => true,
            CompressedBlock::Tile(tile) => tile.coordinates.is_largest_resolution_level(),
            _ => false,
        }
}

/// Puts a block's colours into the picture; gives the number of pixels.
fn put(
    block: &UncompressedBlock,
    channels: &ChannelList,
    selection: &Selection,
    image: &mut Image<Rgb>,
    mut alpha: Option<&mut Image<f32>>,
) -> Result<u64, DecodeError> {
    let damaged = || DecodeError::Corrupt("the OpenEXR is damaged: a block does not fit the picture".into());
    let (columns, rows) = (block.index.pixel_size.width(), block.index.pixel_size.height());
    let (left, top) = (block.index.pixel_position.x(), block.index.pixel_position.y());
    let (width, height) = (image.width() as usize, image.height() as usize);
    if left + columns > width || top + rows > height {
        return Err(damaged());
    }
    // In a block lie row after row, in each row channel after channel.
    let row_bytes: usize = channels.list.iter().map(|channel| channel.sample_type.bytes_per_sample() * columns).sum();
    if block.data.len() != row_bytes * rows {
        return Err(damaged());
    }
    let starts: Vec<usize> = channels
        .list
        .iter()
        .scan(0, |start, channel| {
            let at = *start;
            *start += channel.sample_type.bytes_per_sample() * columns;
            Some(at)
        })
        .collect();
    for (y, row) in block.data.chunks_exact(row_bytes.max(1)).enumerate() {
        let samples =
            |channel: usize| Samples { kind: channels.list[channel].sample_type, row: &row[starts[channel]..] };
        let [red, green, blue] = selection.colors.map(samples);
        let at = (top + y) * width + left;
        for (x, pixel) in image.pixels_mut()[at..at + columns].iter_mut().enumerate() {
            *pixel = Rgb::new(red.get(x), green.get(x), blue.get(x));
        }
        if let (Some(alpha), Some(channel)) = (&mut alpha, selection.alpha) {
            let coverage = samples(channel);
            for (x, pixel) in alpha.pixels_mut()[at..at + columns].iter_mut().enumerate() {
                *pixel = coverage.get(x);
            }
        }
    }
    Ok((columns * rows) as u64)
}

/// A row of one channel, in the machine's byte order.
struct Samples<'a> {
    kind: SampleType,
    row: &'a [u8],
}

impl Samples<'_> {
    #[inline]
    fn get(&self, x: usize) -> f32 {
        match self.kind {
            SampleType::F16 => f16::from_ne_bytes([self.row[2 * x], self.row[2 * x + 1]]).to_f32(),
            SampleType::F32 => f32::from_ne_bytes(self.word(x)),
            SampleType::U32 => u32::from_ne_bytes(self.word(x)) as f32,
        }
    }

    fn word(&self, x: usize) -> [u8; 4] {
        [self.row[4 * x], self.row[4 * x + 1], self.row[4 * x + 2], self.row[4 * x + 3]]
    }
}

fn notes_on(header: &Header) -> Vec<String> {
    let mut notes = Vec::new();
    if let Some(found) = header.shared_attributes.chromaticities {
        let expected = crate::encode::exr::rec709();
        let far = |(a, b): (exr::math::Vec2<f32>, exr::math::Vec2<f32>)| {
            let off = (a.x() - b.x()).abs().max((a.y() - b.y()).abs());
            off.is_nan() || off > 0.002
        };
        let pairs = [
            (found.red, expected.red),
            (found.green, expected.green),
            (found.blue, expected.blue),
            (found.white, expected.white),
        ];
        if pairs.into_iter().any(far) {
            notes.push("the OpenEXR's primaries are not Rec. 709's; they were taken for such".into());
        }
    }
    notes
}

/// The library's error in words for the picture's owner.
fn told(error: exr::error::Error) -> DecodeError {
    match error {
        exr::error::Error::NotSupported(what) => {
            DecodeError::Unsupported(format!("the OpenEXR cannot be read: {what}"))
        }
        exr::error::Error::Invalid(what) if what == "reference to missing bytes" => {
            DecodeError::Corrupt("the OpenEXR is cut short".into())
        }
        exr::error::Error::Invalid(what) => DecodeError::Corrupt(format!("the OpenEXR is damaged: wrong {what}")),
        exr::error::Error::Io(_) | exr::error::Error::Aborted => {
            DecodeError::Corrupt("the OpenEXR is cut short".into())
        }
    }
}
