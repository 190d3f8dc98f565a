//! PNG (W3C recommendation, third edition) with 8 or 16 bits, an sRGB chunk, and texts.
//!
//! What is to be fast is encoded by our own few pages, in strips: filters of 32 bytes at a time, and a compression that looks
//! only for zeros. What is to be small is left to the crate `png`.

mod adler;
mod deflate;
mod filter;
mod huffman;
mod strips;

use png::{ColorType, Compression, Encoder, SrgbRenderingIntent};
use rayon::prelude::*;
use snell_math::Rgb;

pub use strips::{PngStrip, PngStrips};

use super::EncodeError;
use crate::{BitDepth, Developer, DisplayImage, Image, Samples, ToneCurve};

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
    let big_endian: Vec<u8>;
    let bytes = match image.samples() {
        Samples::Eight(codes) => codes,
        Samples::Sixteen(codes) => {
            big_endian = codes.iter().flat_map(|code| code.to_be_bytes()).collect();
            &big_endian
        }
    };
    let (width, height) = image.size();
    match options.effort {
        PngEffort::Fast => {
            let png = PngStrips::new(width, height, image.depth(), options)?;
            let strips = (0..png.count()).into_par_iter().map(|strip| png.encode(strip, &bytes[png.bytes_of(strip)]));
            let strips = strips.collect::<Result<Vec<_>, _>>()?;
            Ok(png.finish(&strips))
        }
        PngEffort::Small => {
            let mut file = Vec::new();
            let mut writer = begin(&mut file, image.size(), image.depth(), options)?;
            writer.write_image_data(bytes).map_err(failed)?;
            writer.finish().map_err(failed)?;
            Ok(file)
        }
    }
}

/// Develops scene-linear light and encodes it as a PNG of 8 bits: the same bytes as [`DisplayImage::develop`] and
/// [`encode_png`] give with [`PngEffort::Fast`], a strip at a time, so that what a strip needs stays in the caches.
///
/// # Errors
/// As [`encode_png`].
///
/// ```
/// use snell_image::{BitDepth, DisplayImage, Image, PngOptions, ToneCurve, encode_png, encode_png_of_light};
/// use snell_math::Rgb;
/// let light = Image::from_fn(40, 50, |x, y| Rgb::new(x as f32 / 30.0, y as f32 / 30.0, 0.1));
/// let display = DisplayImage::develop(&light, ToneCurve::Filmic, 1.0, BitDepth::Eight);
/// let options = PngOptions::default();
/// assert_eq!(encode_png_of_light(&light, ToneCurve::Filmic, 1.0, &options)?, encode_png(&display, &options)?);
/// # Ok::<(), snell_image::EncodeError>(())
/// ```
pub fn encode_png_of_light(
    light: &Image<Rgb>,
    tone: ToneCurve,
    exposure: f32,
    options: &PngOptions,
) -> Result<Vec<u8>, EncodeError> {
    let (width, height) = light.size();
    let png = PngStrips::new(width, height, BitDepth::Eight, options)?;
    let developer = Developer::new(tone, exposure);
    let rows_of_strips = light.pixels().par_chunks(width as usize * PngStrips::ROWS as usize);
    let strips = rows_of_strips.enumerate().map(|(strip, rows)| {
        let mut codes = vec![0; rows.len() * 3];
        developer.develop(rows, &mut codes);
        png.encode(strip as u32, &codes)
    });
    let strips = strips.collect::<Result<Vec<_>, _>>()?;
    Ok(png.finish(&strips))
}

fn failed(error: png::EncodingError) -> EncodeError {
    EncodeError::Format(error.to_string())
}

/// All of a file that comes before the picture's rows.
fn header(size: (u32, u32), depth: BitDepth, options: &PngOptions) -> Result<Vec<u8>, EncodeError> {
    let mut file = Vec::new();
    // A writer that goes away ends the file, with a chunk of nothing but its frame.
    drop(begin(&mut file, size, depth, options)?);
    let end = strips::chunk(*b"IEND", &[]);
    file.truncate(file.len().saturating_sub(end.len()));
    Ok(file)
}

/// Writes all that comes before the picture's rows.
fn begin<'a>(
    file: &'a mut Vec<u8>,
    (width, height): (u32, u32),
    depth: BitDepth,
    options: &PngOptions,
) -> Result<png::Writer<&'a mut Vec<u8>>, EncodeError> {
    if width == 0 || height == 0 {
        return Err(EncodeError::Empty { width, height });
    }
    let mut encoder = Encoder::new(file, width, height);
    encoder.set_color(ColorType::Rgb);
    encoder.set_depth(match depth {
        BitDepth::Eight => png::BitDepth::Eight,
        BitDepth::Sixteen => png::BitDepth::Sixteen,
    });
    encoder.set_source_srgb(SrgbRenderingIntent::Perceptual);
    encoder.set_compression(Compression::High);
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
    encoder.write_header().map_err(failed)
}
