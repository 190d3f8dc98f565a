//! An explanation as a drawing of its rays.

use snell::explain::{Explanation, FigureSettings, figure};
use snell::vector::Page;

use super::{Picture, failure};
use crate::arguments::{ExplainArguments, ExplainFormat};
use crate::draw::{self, encode};
use crate::failure::Failure;

/// Pixels of a millimetre in a PNG.
const PIXELS_PER_MM: f64 = 8.0;

/// The drawing's file.
pub fn bytes(
    arguments: &ExplainArguments,
    format: ExplainFormat,
    picture: &Picture<'_>,
    told: &Explanation,
    title: Option<String>,
) -> Result<Vec<u8>, Failure> {
    let settings =
        FigureSettings { view: arguments.view.clone().unwrap_or_default(), title, ..FigureSettings::default() };
    let page = figure(picture.watch.scene, picture.watch.settings, told, &settings).map_err(|error| failure(&error))?;
    encoded(&page, format)
}

/// A page's file in a format that is none for texts.
pub fn encoded(page: &Page, format: ExplainFormat) -> Result<Vec<u8>, Failure> {
    let format = match format {
        ExplainFormat::Pdf => draw::Format::Pdf,
        ExplainFormat::Png => draw::Format::Png,
        ExplainFormat::Text | ExplainFormat::Json | ExplainFormat::Svg => draw::Format::Svg,
    };
    encode(page, format, (page.width * PIXELS_PER_MM).round() as u32)
}
