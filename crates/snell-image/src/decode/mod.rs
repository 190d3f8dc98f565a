//! Pictures from bytes: PNG, JPEG, Radiance HDR and OpenEXR, told apart by their first bytes and never by a name.
//!
//! What comes out is scene-linear light. Whole-number formats are decoded by the sRGB transfer function unless the file
//! says otherwise (see [`png`]); floating-point formats hold light as it is. Primaries are taken for Rec. 709. What a
//! file asks for and does not get, such as a colour profile, is said in [`Picture::notes`].

mod error;
pub mod exr;
pub mod hdr;
pub mod jpeg;
pub mod png;

use snell_math::Rgb;

use crate::{BitDepth, DisplayImage, Image, Samples, ToneCurve};

pub use error::{DecodeError, Format, Limits};

/// What a file held.
#[derive(Clone, Debug, PartialEq)]
pub struct Picture {
    /// Its colours, scene-linear. Where the file has no colours, grays.
    pub image: Image<Rgb>,
    /// Its coverage from 0 to 1, where it has one. Colours are not multiplied by it in PNG, and are in EXR, as each
    /// format has it.
    pub alpha: Option<Image<f32>>,
    /// The format it was in.
    pub format: Format,
    /// What the file asks for and was not done, each a sentence for the user without full stop. Mostly empty.
    pub notes: Vec<String>,
}

/// Decodes a picture of any format that is read.
///
/// No input makes it panic, run long or use more memory than the limits say.
///
/// # Errors
/// [`DecodeError`] says who is to blame: the file, its kind, or its size.
///
/// ```
/// use snell_image::{DecodeError, decode};
/// let error = decode(b"GIF89a...", &Default::default()).unwrap_err();
/// assert!(matches!(error, DecodeError::Unsupported(_)));
/// assert_eq!(error.to_string(), "this is a GIF picture; pictures can be PNG, JPEG, Radiance HDR or OpenEXR");
/// ```
pub fn decode(bytes: &[u8], limits: &Limits) -> Result<Picture, DecodeError> {
    match sniff(bytes)? {
        Format::Png => png::decode(bytes, limits),
        Format::Jpeg => jpeg::decode(bytes, limits),
        Format::Hdr => hdr::decode(bytes, limits),
        Format::Exr => exr::decode(bytes, limits),
    }
}

/// Reads a PNG as the codes that it holds, without its alpha: for comparing and showing finished pictures.
///
/// A picture that is not sRGB-encoded is converted to 16 bit sRGB codes.
///
/// # Errors
/// As [`decode`]; formats other than PNG are refused.
pub fn decode_display(bytes: &[u8], limits: &Limits) -> Result<DisplayImage, DecodeError> {
    if sniff(bytes)? != Format::Png {
        return Err(DecodeError::Unsupported("a picture of display codes must be a PNG".into()));
    }
    let raw = png::read(bytes, limits)?;
    if raw.transfer != png::Transfer::Srgb {
        let light = raw.into_picture().image;
        return Ok(DisplayImage::develop(&light, ToneCurve::None, 0.0, BitDepth::Sixteen));
    }
    let samples = match &raw.samples {
        Samples::Eight(codes) => Samples::Eight(colors_of(codes, raw.channels)),
        Samples::Sixteen(codes) => Samples::Sixteen(colors_of(codes, raw.channels)),
    };
    Ok(DisplayImage::from_samples(raw.width, raw.height, samples))
}

/// Red, green and blue of pixels with one to four channels.
fn colors_of<S: Copy>(samples: &[S], channels: usize) -> Vec<S> {
    if channels == 3 {
        return samples.to_vec();
    }
    let (pixels, has_colors) = (samples.chunks_exact(channels), channels == 4);
    let colors: Vec<[S; 3]> =
        pixels.map(|pixel| if has_colors { [pixel[0], pixel[1], pixel[2]] } else { [pixel[0]; 3] }).collect();
    // Not a flat map, which the compiler goes through sample by sample.
    colors.into_flattened()
}

/// Which format the first bytes announce.
fn sniff(bytes: &[u8]) -> Result<Format, DecodeError> {
    const READ: [(&[u8], Format); 5] = [
        (b"\x89PNG\r\n\x1a\n", Format::Png),
        (b"\xff\xd8\xff", Format::Jpeg),
        (b"#?RADIANCE", Format::Hdr),
        (b"#?RGBE", Format::Hdr),
        (b"\x76\x2f\x31\x01", Format::Exr),
    ];
    const KNOWN: [(&[u8], &str); 8] = [
        (b"GIF8", "GIF"),
        (b"BM", "BMP"),
        (b"II*\0", "TIFF"),
        (b"MM\0*", "TIFF"),
        (b"RIFF", "WebP"),
        (b"\x00\x00\x00\x0cJXL ", "JPEG XL"),
        (b"DDS ", "DDS"),
        (b"\xabKTX", "KTX"),
    ];
    const CAN_BE: &str = "pictures can be PNG, JPEG, Radiance HDR or OpenEXR";
    if let Some((_, format)) = READ.iter().find(|(magic, _)| bytes.starts_with(magic)) {
        return Ok(*format);
    }
    if let Some((_, name)) = KNOWN.iter().find(|(magic, _)| bytes.starts_with(magic)) {
        return Err(DecodeError::Unsupported(format!("this is a {name} picture; {CAN_BE}")));
    }
    let head = &bytes[..bytes.len().min(20)];
    if head.windows(3).any(|window| window == b"PNG") || head.windows(4).any(|window| window == b"IHDR") {
        return Err(DecodeError::Corrupt(
            "the PNG's signature is damaged; perhaps it was transferred as text, not as bytes".into(),
        ));
    }
    if bytes.is_empty() {
        return Err(DecodeError::Corrupt("the picture's file is empty".into()));
    }
    if READ.iter().any(|(magic, _)| magic.starts_with(bytes)) {
        return Err(DecodeError::Corrupt("the picture is cut short: it ends within its first bytes".into()));
    }
    Err(DecodeError::Unsupported(format!("these bytes are no picture of a known kind; {CAN_BE}")))
}
