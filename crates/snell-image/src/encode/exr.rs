//! OpenEXR (openexr.com, "OpenEXR File Layout"): scene-linear light and what else the renderer knows of each pixel, as
//! channels of one part, ZIP-compressed in blocks of 16 scan lines.
//!
//! Channels: `R`, `G`, `B` (half or float); `Z` the depth, `N.X`, `N.Y`, `N.Z` the normal (float), `id` the object
//! (32 bit whole numbers), see [`Layers`] for their meaning. Primaries are said to be Rec. 709's.

use std::io::Cursor;

use exr::meta::attribute::Chromaticities;
use exr::prelude::{
    AnyChannel, AnyChannels, Compression, Encoding, FlatSamples, Layer, LayerAttributes, LineOrder, SmallVec, Text,
    Vec2, WritableImage, f16,
};
use snell_math::Rgb;

use super::EncodeError;
use crate::{Image, Layers};

/// How an EXR is written.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct ExrOptions {
    /// The precision of colours; layers have full precision always.
    pub precision: ExrPrecision,
    /// The program that made the picture, its `software` attribute.
    pub software: Option<String>,
    /// Anything to say, its `comments` attribute.
    pub comments: Option<String>,
}

/// The precision of colours.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum ExrPrecision {
    /// 32 bit floating point: exactly what was computed.
    #[default]
    Float,
    /// 16 bit floating point: half the size, 11 significant bits, up to 65504 (brighter becomes infinite).
    Half,
}

/// Encodes scene-linear light, with those layers that are there.
///
/// # Errors
/// Where the picture has no pixels or a layer has another size.
///
/// ```
/// use snell_image::{ExrOptions, Image, Layers, decode, encode_exr};
/// use snell_math::Rgb;
/// let light = Image::from_fn(5, 4, |x, y| Rgb::new(x as f32, -1.5, y as f32 * 1e6));
/// let file = encode_exr(&light, &Layers::default(), &ExrOptions::default())?;
/// assert_eq!(decode(&file, &Default::default())?.image, light);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn encode_exr(light: &Image<Rgb>, layers: &Layers, options: &ExrOptions) -> Result<Vec<u8>, EncodeError> {
    let (width, height) = light.size();
    if light.is_empty() {
        return Err(EncodeError::Empty { width, height });
    }

    let mut channels = SmallVec::new();
    let mut channel = |name: &str, samples: FlatSamples| channels.push(AnyChannel::new(name, samples));
    let component = |get: fn(&Rgb) -> f32| match options.precision {
        ExrPrecision::Float => FlatSamples::F32(light.pixels().iter().map(get).collect()),
        ExrPrecision::Half => FlatSamples::F16(light.pixels().iter().map(|pixel| f16::from_f32(get(pixel))).collect()),
    };
    channel("R", component(|pixel| pixel.r));
    channel("G", component(|pixel| pixel.g));
    channel("B", component(|pixel| pixel.b));
    if let Some(depth) = same_size("depth", &layers.depth, light)? {
        channel("Z", FlatSamples::F32(depth.pixels().to_vec()));
    }
    if let Some(normal) = same_size("normal", &layers.normal, light)? {
        for (axis, name) in ["N.X", "N.Y", "N.Z"].into_iter().enumerate() {
            channel(name, FlatSamples::F32(normal.pixels().iter().map(|normal| normal[axis]).collect()));
        }
    }
    if let Some(object) = same_size("object", &layers.object, light)? {
        channel("id", FlatSamples::U32(object.pixels().to_vec()));
    }

    let attributes = LayerAttributes {
        software_name: options.software.as_deref().map(text),
        comments: options.comments.as_deref().map(text),
        ..LayerAttributes::default()
    };
    let encoding = Encoding {
        compression: Compression::ZIP16,
        blocks: exr::image::Blocks::ScanLines,
        // Fixes the order of blocks in the file, whichever thread finishes first.
        line_order: LineOrder::Increasing,
    };
    let size = Vec2(width as usize, height as usize);
    let layer = Layer::new(size, attributes, encoding, AnyChannels::sort(channels));
    let mut image = exr::image::Image::from_layer(layer);
    image.attributes.chromaticities = Some(rec709());

    let mut bytes = Cursor::new(Vec::new());
    image.write().to_buffered(&mut bytes).map_err(|error| EncodeError::Format(error.to_string()))?;
    Ok(bytes.into_inner())
}

/// The primaries of ITU-R BT.709 and white D65, as CIE 1931 xy.
pub(crate) fn rec709() -> Chromaticities {
    Chromaticities {
        red: Vec2(0.64, 0.33),
        green: Vec2(0.30, 0.60),
        blue: Vec2(0.15, 0.06),
        white: Vec2(0.3127, 0.3290),
    }
}

fn same_size<'a, P>(
    layer: &'static str,
    image: &'a Option<Image<P>>,
    light: &Image<Rgb>,
) -> Result<Option<&'a Image<P>>, EncodeError> {
    match image {
        Some(image) if image.size() != light.size() => {
            Err(EncodeError::LayerSize { layer, size: image.size(), expected: light.size() })
        }
        other => Ok(other.as_ref()),
    }
}

/// EXR texts are bytes; NUL would end one early.
fn text(text: &str) -> Text {
    Text::from_bytes_unchecked(text.bytes().filter(|&byte| byte != 0).collect())
}
