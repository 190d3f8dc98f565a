//! Pictures: pixel buffers typed by what their numbers mean, tone curves, encoders, decoders and metrics.
//!
//! The types are the order of work, so that no picture is tone-mapped or encoded twice:
//!
//! | type | its numbers | made by |
//! |---|---|---|
//! | [`Image<Rgb>`](Image) | scene-linear light, Rec. 709 primaries, any size | rendering, [`decode()`] |
//! | [`DisplayImage`] | 8 or 16 bit sRGB codes | [`DisplayImage::develop`], [`decode_display`] |
//! | `Vec<u8>` | a PNG or EXR file | [`encode_png`], [`encode_exr`] |
//!
//! Row 0 is the top row everywhere. Nothing here opens files, prints or reads the environment.
//!
//! ```
//! use snell_image::{BitDepth, DisplayImage, Image, PngOptions, ToneCurve, encode_png};
//! use snell_math::Rgb;
//!
//! let light = Image::from_fn(4, 2, |x, _| Rgb::gray(x as f32 / 3.0));
//! let display = DisplayImage::develop(&light, ToneCurve::None, 0.0, BitDepth::Eight);
//! assert_eq!(display.code(0, 0), [0, 0, 0]);
//! assert_eq!(display.code(1, 0), [156, 156, 156]);    // a third of the light is more than half of the codes
//! let file = encode_png(&display, &PngOptions::default())?;
//! assert_eq!(snell_image::decode_display(&file, &Default::default())?, display);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

pub mod decode;
pub mod display;
pub mod encode;
pub mod flip;
mod image;
pub mod metrics;
pub mod preview;
pub mod resize;
pub mod tone;
pub mod transfer;

pub use decode::{DecodeError, Format, Limits, Picture, decode, decode_display};
pub use display::{BitDepth, Developer, DisplayImage, Samples};
pub use encode::{
    EncodeError, ExrOptions, ExrPrecision, PngEffort, PngOptions, PngStrip, PngStrips, encode_exr, encode_png,
    encode_png_of_light,
};
pub use image::{Image, Layers, WrongPixelCount};
pub use tone::ToneCurve;
