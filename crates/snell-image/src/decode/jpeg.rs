//! JPEG (ITU-T T.81) to scene-linear light: baseline and progressive, gray, YCbCr, RGB, and CMYK by its plain formula.
//! Its codes are taken for sRGB; profiles and the orientation of cameras are not applied.
//!
//! The decoder beneath fills what is missing with gray, so a file that is cut short is found out before: the markers are
//! walked up to the end of the image.

use zune_core::bytestream::ZCursor;
use zune_core::colorspace::ColorSpace;
use zune_core::options::DecoderOptions;
use zune_jpeg::JpegDecoder;
use zune_jpeg::errors::DecodeErrors;

use super::error::COLOR_BYTES;
use super::{DecodeError, Format, Limits, Picture};
use crate::{Image, transfer};
use snell_math::Rgb;

const FORMAT: Format = Format::Jpeg;
/// Bytes of a pixel while a progressive picture is decoded: 16 bit coefficients and 8 bit codes of up to four components.
const WORKING_BYTES: u64 = 4 * 3;

/// Decodes a JPEG.
///
/// # Errors
/// See [`super::decode`].
pub fn decode(bytes: &[u8], limits: &Limits) -> Result<Picture, DecodeError> {
    let (width, height) = walk_markers(bytes)?;
    limits.check(FORMAT, width, height, COLOR_BYTES + WORKING_BYTES)?;

    // Without SIMD, which Cargo.toml switches off too, since the picture must be the same on every machine.
    let options = DecoderOptions::new_safe()
        .set_use_unsafe(false)
        .set_strict_mode(false)
        .set_max_width(usize::from(u16::MAX))
        .set_max_height(usize::from(u16::MAX))
        .jpeg_set_out_colorspace(ColorSpace::RGB);
    let mut decoder = JpegDecoder::new_with_options(ZCursor::new(bytes), options);
    let codes = decoder.decode().map_err(told)?;
    let mut pixels = codes.chunks_exact(3);
    if pixels.len() as u64 != u64::from(width) * u64::from(height) {
        return Err(DecodeError::Corrupt("the JPEG holds another number of pixels than it says".into()));
    }
    let mut notes = Vec::new();
    if decoder.icc_profile().is_some_and(|profile| !is_srgb(&profile)) {
        notes.push("the JPEG has a colour profile; it was taken for sRGB".into());
    }
    let table = transfer::linear_table(255);
    let image = Image::from_fn(width, height, |_, _| match pixels.next() {
        Some([red, green, blue]) => Rgb::from([*red, *green, *blue].map(|code| table[usize::from(code)])),
        _ => Rgb::BLACK,
    });
    Ok(Picture { image, alpha: None, format: FORMAT, notes })
}

/// True for a profile that names itself sRGB, as most profiles in JPEGs do.
fn is_srgb(profile: &[u8]) -> bool {
    let utf16: Vec<u8> = b"sRGB".iter().flat_map(|&letter| [0, letter]).collect();
    profile.windows(4).any(|window| window == b"sRGB") || profile.windows(8).any(|window| window == utf16)
}

/// Walks the markers from the start of the image to its end; gives width and height.
fn walk_markers(bytes: &[u8]) -> Result<(u32, u32), DecodeError> {
    let cut = |place: &str| DecodeError::Corrupt(format!("the JPEG is cut short: it ends {place}"));
    let mut size = None;
    let mut scanned = false;
    let mut at = 2;
    loop {
        // To the next marker. Between segments nothing else should stand; within a scan lie its data, where FF 00 is a
        // byte and FF D0 to D7 are restarts.
        let Some(found) = bytes.get(at..).and_then(|rest| rest.iter().position(|&byte| byte == 0xff)) else {
            return Err(cut(if scanned { "within its data" } else { "before its data" }));
        };
        at += found + 1;
        let Some(&marker) = bytes.get(at) else { return Err(cut("within a marker")) };
        match marker {
            // A fill byte: the next one may be the marker.
            0xff => continue,
            0xd9 => break,
            0x00 | 0x01 | 0xd0..=0xd8 => {
                at += 1;
                continue;
            }
            _ => {}
        }
        let Some(&[high, low]) = bytes.get(at + 1..at + 3) else { return Err(cut("within a segment")) };
        let length = usize::from(u16::from_be_bytes([high, low]));
        if length < 2 {
            return Err(DecodeError::Corrupt("the JPEG is damaged: a segment is shorter than its own head".into()));
        }
        let Some(segment) = bytes.get(at + 3..at + 1 + length) else { return Err(cut("within a segment")) };
        match marker {
            // Starts of frames; C4, C8 and CC are other things.
            0xc0..=0xcf if !matches!(marker, 0xc4 | 0xc8 | 0xcc) => {
                let [_, h1, h0, w1, w0, ..] = *segment else {
                    return Err(DecodeError::Corrupt("the JPEG is damaged: its frame header is too short".into()));
                };
                let sides = (u32::from(u16::from_be_bytes([w1, w0])), u32::from(u16::from_be_bytes([h1, h0])));
                if size.is_some_and(|size| size != sides) {
                    return Err(DecodeError::Unsupported("the JPEG has several frames".into()));
                }
                size = Some(sides);
            }
            0xda => scanned = true,
            _ => {}
        }
        at += 1 + length;
    }
    match size {
        Some(size) if scanned => Ok(size),
        _ => Err(DecodeError::Corrupt("the JPEG holds no picture".into())),
    }
}

/// The decoder's error in words for the picture's owner.
fn told(error: DecodeErrors) -> DecodeError {
    match error {
        DecodeErrors::Unsupported(_) => {
            DecodeError::Unsupported("the JPEG is lossless or arithmetically coded, which is not read".into())
        }
        DecodeErrors::ExhaustedData | DecodeErrors::IoErrors(_) => DecodeError::Corrupt("the JPEG is cut short".into()),
        DecodeErrors::LargeDimensions(_) => DecodeError::TooLarge("the JPEG's sides are too long".into()),
        DecodeErrors::HuffmanDecode(_) | DecodeErrors::MCUError(_) => {
            DecodeError::Corrupt("the JPEG's compressed data is damaged".into())
        }
        DecodeErrors::DqtError(_) => DecodeError::Corrupt("the JPEG's quantization tables are damaged".into()),
        DecodeErrors::SofError(_) => DecodeError::Corrupt("the JPEG's frame header is damaged".into()),
        DecodeErrors::SosError(_) => DecodeError::Corrupt("the JPEG's scan header is damaged".into()),
        _ => DecodeError::Corrupt("the JPEG is damaged".into()),
    }
}
