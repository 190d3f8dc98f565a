//! Pictures to bytes: PNG of display codes, OpenEXR of scene-linear light and its layers. The same picture and options
//! give the same bytes, for any number of threads.

pub(crate) mod exr;
mod png;

pub use exr::{ExrOptions, ExrPrecision, encode_exr};
pub use png::{PngEffort, PngOptions, PngStrip, PngStrips, encode_png, encode_png_of_light};

/// Why a picture was not encoded.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum EncodeError {
    /// It has no pixels, which no format can say.
    #[error("a picture of {width} × {height} pixels has none to write")]
    Empty {
        /// Columns.
        width: u32,
        /// Rows.
        height: u32,
    },
    /// A layer's size differs from the picture's.
    #[error("the layer {layer} is {} × {} pixels, the picture {} × {}", .size.0, .size.1, .expected.0, .expected.1)]
    LayerSize {
        /// `depth`, `normal` or `object`.
        layer: &'static str,
        /// The layer's size.
        size: (u32, u32),
        /// The picture's size.
        expected: (u32, u32),
    },
    /// A text's keyword is not 1 to 79 Latin letters, digits and the like.
    #[error("`{0}` cannot be the keyword of a text in a PNG")]
    Keyword(String),
    /// The format's own limits, in the words of the library that writes it.
    #[error("the picture cannot be written: {0}")]
    Format(String),
}
