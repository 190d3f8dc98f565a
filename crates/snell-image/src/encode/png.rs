//! PNG (W3C recommendation, third edition) with 8 or 16 bits, an sRGB chunk, and texts.

use png::{ColorType, Compression, Encoder, SrgbRenderingIntent};

use super::EncodeError;
use crate::{BitDepth, DisplayImage, Samples};

/// How a PNG is written.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct PngOptions {
    /// Texts to go with it, as (keyword, text): `Software`, `Title`, `Comment`, `Source` and others of the standard.
    pub text: Vec<(String, String)>,
    /// Speed against size.
    pub effort: PngEffort,
}

/// Speed against size of a PNG; its pixels are the same.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum PngEffort {
    /// As fast as can be: a few milliseconds for 1024 × 768 pixels.
    #[default]
    Fast,
    /// Small: many times slower. For files that are kept.
    Small,
}

/// Encodes a picture as PNG.
///
/// # Errors
/// Where the picture has no pixels, is longer than 2^31 − 1 on a side, or a text's keyword is not allowed.
pub fn encode_png(image: &DisplayImage, options: &PngOptions) -> Result<Vec<u8>, EncodeError> {
    let (width, height) = image.size();
    if width == 0 || height == 0 {
        return Err(EncodeError::Empty { width, height });
    }
    let failed = |error: png::EncodingError| EncodeError::Format(error.to_string());

    let mut bytes = Vec::new();
    let mut encoder = Encoder::new(&mut bytes, width, height);
    encoder.set_color(ColorType::Rgb);
    encoder.set_depth(match image.depth() {
        BitDepth::Eight => png::BitDepth::Eight,
        BitDepth::Sixteen => png::BitDepth::Sixteen,
    });
    encoder.set_source_srgb(SrgbRenderingIntent::Perceptual);
    encoder.set_compression(match options.effort {
        PngEffort::Fast => Compression::Fast,
        PngEffort::Small => Compression::High,
    });
    for (keyword, text) in &options.text {
        let allowed = |letter: char| letter.is_ascii_graphic() || letter == ' ';
        if keyword.is_empty() || keyword.len() > 79 || keyword.trim() != keyword || !keyword.chars().all(allowed) {
            return Err(EncodeError::Keyword(keyword.clone()));
        }
        // NUL ends a text; nothing else is forbidden. Latin-1 is said plainly, all else in UTF-8.
        let text = text.replace('\0', " ");
        if text.chars().all(|letter| u32::from(letter) <= 0xff) {
            encoder.add_text_chunk(keyword.clone(), text).map_err(failed)?;
        } else {
            encoder.add_itxt_chunk(keyword.clone(), text).map_err(failed)?;
        }
    }
    let mut writer = encoder.write_header().map_err(failed)?;
    match image.samples() {
        Samples::Eight(codes) => writer.write_image_data(codes),
        Samples::Sixteen(codes) => {
            let big_endian: Vec<u8> = codes.iter().flat_map(|code| code.to_be_bytes()).collect();
            writer.write_image_data(&big_endian)
        }
    }
    .map_err(failed)?;
    writer.finish().map_err(failed)?;
    Ok(bytes)
}
