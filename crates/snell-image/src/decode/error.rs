//! Why a picture was not decoded, said to its owner, and the limits that keep a hostile file from taking all memory.

use std::fmt;

use crate::Image;

/// A format of pictures that can be read.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Format {
    /// Portable Network Graphics, W3C recommendation, third edition.
    Png,
    /// JPEG (ITU-T T.81), baseline and progressive.
    Jpeg,
    /// Radiance's picture format, .hdr or .pic.
    Hdr,
    /// OpenEXR, scan lines or tiles.
    Exr,
}

impl fmt::Display for Format {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Png => "PNG",
            Self::Jpeg => "JPEG",
            Self::Hdr => "Radiance HDR",
            Self::Exr => "OpenEXR",
        })
    }
}

/// Why a picture was not decoded, by who is to blame. Each holds one sentence for the user, without full stop.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum DecodeError {
    /// Nobody: the file may be right, but is of a kind that is not read.
    #[error("{0}")]
    Unsupported(String),
    /// The file: it is damaged, cut short, or contradicts itself or its format.
    #[error("{0}")]
    Corrupt(String),
    /// The [`Limits`]: the picture is larger than they let in.
    #[error("{0}")]
    TooLarge(String),
}

/// How large a picture may be.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Limits {
    /// Columns; 32768 by default.
    pub max_width: u32,
    /// Rows; 32768 by default.
    pub max_height: u32,
    /// Bytes of memory that decoding may take at its peak, the finished picture included; 2 GiB by default, which lets in
    /// 8192 × 8192 pixels in any format and a panorama of 16384 × 8192 in floating point.
    pub max_bytes: u64,
}

impl Default for Limits {
    fn default() -> Self {
        Self { max_width: 1 << 15, max_height: 1 << 15, max_bytes: 2 << 30 }
    }
}

/// Bytes of a finished pixel: its colour.
pub(super) const COLOR_BYTES: u64 = size_of::<snell_math::Rgb>() as u64;
/// Bytes of a finished pixel's coverage.
pub(super) const ALPHA_BYTES: u64 = size_of::<f32>() as u64;

impl Limits {
    /// Refuses a picture by its sides, and by the bytes that decoding it takes for each pixel at the peak. To be asked
    /// before anything of the picture's size is allocated.
    pub(super) fn check(&self, format: Format, width: u32, height: u32, pixel_bytes: u64) -> Result<(), DecodeError> {
        if width == 0 || height == 0 {
            return Err(DecodeError::Corrupt(format!("the {format} is {width} × {height} pixels: it has none")));
        }
        if width > self.max_width || height > self.max_height {
            return Err(DecodeError::TooLarge(format!(
                "the {format} is {width} × {height} pixels; at most {} × {} are let in",
                self.max_width, self.max_height
            )));
        }
        let bytes = (u64::from(width) * u64::from(height)).saturating_mul(pixel_bytes);
        self.check_bytes(format, bytes)
    }

    /// Refuses what takes more bytes than allowed.
    pub(super) fn check_bytes(&self, format: Format, bytes: u64) -> Result<(), DecodeError> {
        if bytes > self.max_bytes {
            return Err(DecodeError::TooLarge(format!(
                "the {format} takes {} MiB to decode; at most {} MiB are let in",
                bytes.div_ceil(1 << 20),
                self.max_bytes >> 20
            )));
        }
        Ok(())
    }
}

/// A picture of pixels that the decoder counted itself.
pub(super) fn image_of<P>(format: Format, width: u32, height: u32, pixels: Vec<P>) -> Result<Image<P>, DecodeError> {
    Image::from_pixels(width, height, pixels).map_err(|error| DecodeError::Corrupt(format!("in the {format}, {error}")))
}
