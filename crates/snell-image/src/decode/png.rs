//! PNG (W3C recommendation, third edition) to scene-linear light, at the full precision of its 1 to 16 bits.
//!
//! How its codes become light, the first that the file has: a cICP chunk (sRGB, BT.709 or linear transfer with BT.709
//! primaries; others are refused), an iCCP chunk (taken for sRGB, with a note), an sRGB chunk (sRGB), a gAMA chunk
//! (a power law with that exponent), none of these (sRGB). A cHRM chunk with other primaries than sRGB's is noted.
//! Of an animation the still picture is read.
//!
//! The frame of chunks is walked before the pixels are decoded, so that a cut or damaged file is told by its chunk's name.

use std::io::Cursor;

use png::{BitDepth, ColorType, DecodeOptions, Decoder, Info, Transformations};
use snell_math::{Rgb, portable};

use super::error::{ALPHA_BYTES, COLOR_BYTES, image_of};
use super::{DecodeError, Format, Limits, Picture};
use crate::{Image, Samples, transfer};

const FORMAT: Format = Format::Png;
/// Deflate never packs more bytes into one (its longest match over its shortest code).
const MAX_DEFLATE_RATIO: u64 = 1032;

/// From codes to light.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Transfer {
    Srgb,
    Linear,
    /// Light is the code, scaled to [0, 1], to this power.
    Power(f32),
}

/// A PNG's codes as they lie in it; palettes and fewer than 8 bits expanded.
pub(super) struct RawPng {
    pub width: u32,
    pub height: u32,
    /// 1 gray, 2 gray and alpha, 3 colour, 4 colour and alpha.
    pub channels: usize,
    pub samples: Samples,
    pub transfer: Transfer,
    notes: Vec<String>,
}

/// Decodes a PNG.
///
/// # Errors
/// See [`super::decode`].
pub fn decode(bytes: &[u8], limits: &Limits) -> Result<Picture, DecodeError> {
    Ok(read(bytes, limits)?.into_picture())
}

/// Reads the codes.
pub(super) fn read(bytes: &[u8], limits: &Limits) -> Result<RawPng, DecodeError> {
    let idat_bytes = walk_chunks(bytes)?;

    let mut options = DecodeOptions::default();
    options.set_ignore_adler32(false);
    options.set_ignore_text_chunk(true);
    let mut decoder = Decoder::new_with_options(Cursor::new(bytes), options);
    decoder.set_limits(png::Limits { bytes: usize::try_from(limits.max_bytes).unwrap_or(usize::MAX) });
    decoder.set_transformations(Transformations::EXPAND);
    {
        let info = decoder.read_header_info().map_err(told)?;
        let (width, height) = info.size();
        limits.check(FORMAT, width, height, COLOR_BYTES)?;
        let row_bits = u64::from(width) * info.bits_per_pixel() as u64;
        if row_bits.div_ceil(8) * u64::from(height) > idat_bytes * MAX_DEFLATE_RATIO {
            return Err(DecodeError::Corrupt(format!(
                "the PNG's {idat_bytes} bytes of data are too few for {width} × {height} pixels"
            )));
        }
    }

    let mut reader = decoder.read_info().map_err(told)?;
    let (color_type, bit_depth) = reader.output_color_type();
    let channels = color_type.samples();
    let (width, height) = reader.info().size();
    let sample_bytes = if bit_depth == BitDepth::Sixteen { 2 } else { 1 };
    let has_alpha = matches!(color_type, ColorType::GrayscaleAlpha | ColorType::Rgba);
    let finished = COLOR_BYTES + if has_alpha { ALPHA_BYTES } else { 0 };
    // 16 bit codes lie in memory twice for a moment: as bytes and as numbers.
    limits.check(FORMAT, width, height, finished + channels as u64 * (if sample_bytes == 2 { 4 } else { 1 }))?;
    let (transfer, notes) = transfer_of(reader.info())?;

    let size = reader.output_buffer_size().ok_or_else(|| DecodeError::TooLarge("the PNG is too large".into()))?;
    let mut data = vec![0; size];
    reader.next_frame(&mut data).map_err(told)?;
    reader.finish().map_err(told)?;
    let samples = if sample_bytes == 2 {
        Samples::Sixteen(data.chunks_exact(2).map(|pair| u16::from_be_bytes([pair[0], pair[1]])).collect())
    } else {
        Samples::Eight(data)
    };
    Ok(RawPng { width, height, channels, samples, transfer, notes })
}

impl RawPng {
    pub(super) fn into_picture(self) -> Picture {
        let (image, alpha) = match &self.samples {
            Samples::Eight(codes) => self.light(codes, u16::from(u8::MAX)),
            Samples::Sixteen(codes) => self.light(codes, u16::MAX),
        };
        Picture { image, alpha, format: FORMAT, notes: self.notes }
    }

    fn light<S: Copy + Into<u16>>(&self, codes: &[S], max_code: u16) -> (Image<Rgb>, Option<Image<f32>>) {
        let scaled = |code: S| f32::from(code.into()) / f32::from(max_code);
        let table = match self.transfer {
            Transfer::Srgb => transfer::linear_table(max_code),
            Transfer::Linear => (0..=max_code).map(|code| f32::from(code) / f32::from(max_code)).collect(),
            Transfer::Power(power) => (0..=max_code)
                .map(|code| portable::powf32(f32::from(code) / f32::from(max_code), power))
                .collect::<Vec<_>>(),
        };
        let linear = |code: S| table[usize::from(code.into())];
        let mut pixels = codes.chunks_exact(self.channels);
        let mut alpha = matches!(self.channels, 2 | 4).then(|| Vec::with_capacity(pixels.len()));
        let image = Image::from_fn(self.width, self.height, |_, _| {
            let Some(pixel) = pixels.next() else { return Rgb::BLACK };
            if let (Some(alpha), Some(last)) = (&mut alpha, pixel.last()) {
                alpha.push(scaled(*last));
            }
            match pixel {
                [red, green, blue, ..] => Rgb::new(linear(*red), linear(*green), linear(*blue)),
                [gray, ..] => Rgb::gray(linear(*gray)),
                [] => Rgb::BLACK,
            }
        });
        let alpha = alpha.and_then(|alpha| image_of(FORMAT, self.width, self.height, alpha).ok());
        (image, alpha)
    }
}

/// Walks the chunks, checks those that matter, and gives the number of bytes in IDAT chunks.
fn walk_chunks(bytes: &[u8]) -> Result<u64, DecodeError> {
    let corrupt = |text: String| Err(DecodeError::Corrupt(text));
    let mut rest = bytes.get(8..).unwrap_or_default();
    let mut idat_bytes = 0;
    let mut first = true;
    loop {
        let Some((head, after)) = rest.split_first_chunk::<8>() else {
            return corrupt("the PNG is cut short: it ends without an IEND chunk".into());
        };
        let [l0, l1, l2, l3, kind @ ..] = *head;
        let length = u32::from_be_bytes([l0, l1, l2, l3]) as usize;
        if !kind.iter().all(u8::is_ascii_alphabetic) {
            return corrupt(format!("the PNG is damaged at byte {}: no chunk begins there", bytes.len() - rest.len()));
        }
        let name = String::from_utf8_lossy(&kind);
        let Some((data, crc)) = after
            .split_at_checked(length)
            .and_then(|(data, after)| after.split_first_chunk::<4>().map(|(crc, _)| (data, *crc)))
        else {
            return corrupt(format!("the PNG is cut short: it ends inside chunk {name}"));
        };
        if first && kind != *b"IHDR" {
            return corrupt(format!("the PNG begins with chunk {name} in place of IHDR"));
        }
        first = false;
        let critical = kind[0].is_ascii_uppercase();
        if critical {
            let mut hasher = crc32fast::Hasher::new();
            hasher.update(&kind);
            hasher.update(data);
            if hasher.finalize() != u32::from_be_bytes(crc) {
                return corrupt(format!("the PNG's CRC is wrong in chunk {name}"));
            }
        }
        match &kind {
            b"IDAT" => idat_bytes += length as u64,
            b"IEND" if idat_bytes == 0 => return corrupt("the PNG has no data: its IDAT chunk is missing".into()),
            b"IEND" => return Ok(idat_bytes),
            b"IHDR" | b"PLTE" => {}
            _ if critical => {
                return Err(DecodeError::Unsupported(format!(
                    "the PNG has an unknown chunk {name} that it depends on"
                )));
            }
            _ => {}
        }
        rest = &after[length + 4..];
    }
}

/// What the file says of its codes' meaning.
fn transfer_of(info: &Info<'_>) -> Result<(Transfer, Vec<String>), DecodeError> {
    let mut notes = Vec::new();
    if let Some(points) = &info.coding_independent_code_points {
        // ITU-T H.273: BT.709 and the two BT.2020 curves are made to be shown as sRGB nearly is.
        let transfer = match points.transfer_function {
            1 | 6 | 13 | 14 | 15 => Transfer::Srgb,
            8 => Transfer::Linear,
            4 => Transfer::Power(2.2),
            other => {
                return Err(DecodeError::Unsupported(format!(
                    "the PNG's transfer function is number {other} of ITU-T H.273 (as in HDR video); export it as EXR"
                )));
            }
        };
        if points.color_primaries != 1 {
            notes.push(format!(
                "the PNG's primaries are number {} of ITU-T H.273; they were taken for BT.709's",
                points.color_primaries
            ));
        }
        return Ok((transfer, notes));
    }
    if info.icc_profile.is_some() && info.srgb.is_none() {
        notes.push("the PNG has a colour profile; it was taken for sRGB".into());
        return Ok((Transfer::Srgb, notes));
    }
    if info.srgb.is_some() {
        return Ok((Transfer::Srgb, notes));
    }
    if let Some(primaries) = info.chrm_chunk {
        let values = [primaries.red, primaries.green, primaries.blue, primaries.white].map(|(x, y)| [x, y]);
        let srgb = [[0.64, 0.33], [0.30, 0.60], [0.15, 0.06], [0.3127, 0.3290]];
        let far = |(value, expected): (&png::ScaledFloat, f32)| (value.into_value() - expected).abs() > 0.002;
        if values.as_flattened().iter().zip(srgb.as_flattened().iter().copied()).any(far) {
            notes.push("the PNG's primaries are not sRGB's; they were taken for such".into());
        }
    }
    let transfer = match info.gama_chunk.map(png::ScaledFloat::into_value) {
        Some(gamma) if gamma > 0.0 => Transfer::Power(1.0 / gamma),
        _ => Transfer::Srgb,
    };
    Ok((transfer, notes))
}

/// The decoder's error in words for the picture's owner.
fn told(error: png::DecodingError) -> DecodeError {
    let text = error.to_string();
    match error {
        png::DecodingError::LimitsExceeded => DecodeError::TooLarge("the PNG takes too much memory to decode".into()),
        png::DecodingError::IoError(_) => DecodeError::Corrupt("the PNG is cut short".into()),
        _ if text.contains("deflate") => DecodeError::Corrupt("the PNG's compressed data is damaged".into()),
        // These texts name chunks by the library's own structures.
        _ if text.contains("ChunkType {") => {
            DecodeError::Corrupt("the PNG's chunks are malformed or out of order".into())
        }
        _ => {
            let mut letters = text.trim_end_matches('.').chars();
            let first = letters.next().map(|letter| letter.to_lowercase().to_string()).unwrap_or_default();
            DecodeError::Corrupt(format!("the PNG is damaged: {first}{}", letters.as_str()))
        }
    }
}
