//! Pages as PDF, by the library krilla. PDF counts in points, 72 to the inch; ISO 32000-2.

use krilla::Document;
use krilla::color::rgb;
use krilla::geom::{PathBuilder, Size, Transform};
use krilla::image::Image;
use krilla::metadata::Metadata;
use krilla::num::NormalizedF32;
use krilla::page::PageSettings;
use krilla::paint::{Fill, FillRule, LineCap, LineJoin, Stroke, StrokeDash};
use krilla::surface::Surface;

use super::text::{outlines, plain};
use super::{Item, Page, Path, Piece, VectorError};

/// Points in a millimetre.
const POINTS: f64 = 72.0 / 25.4;

/// Writes a page as PDF; the same page gives the same bytes.
///
/// # Errors
/// [`VectorError`], where the page has no extent, a coordinate is not finite, or the backdrop is no PNG.
pub fn encode_pdf(page: &Page) -> Result<Vec<u8>, VectorError> {
    page.check()?;
    let refused = |error: &dyn std::fmt::Debug| VectorError::Pdf(format!("{error:?}"));
    let mut document = Document::new();
    if let Some(title) = &page.title {
        document.set_metadata(Metadata::new().title(plain(title)));
    }
    let settings = PageSettings::from_wh((page.width * POINTS) as f32, (page.height * POINTS) as f32)
        .ok_or(VectorError::Page { width: page.width, height: page.height })?;
    let mut sheet = document.start_page_with(settings);
    let mut surface = sheet.surface();
    if let Some(backdrop) = &page.backdrop {
        let image = Image::from_png(backdrop.png.clone().into(), true)
            .map_err(|error| VectorError::Backdrop(format!("{error:?}")))?;
        let [x, y, w, h] = backdrop.place.map(|length| (length * POINTS) as f32);
        if let Some(size) = Size::from_wh(w, h) {
            surface.push_transform(&Transform::from_translate(x, y));
            surface.draw_image(image, size);
            surface.pop();
        }
    }
    for item in page.groups.iter().flat_map(|group| &group.items) {
        match item {
            Item::Path(path) => draw_path(&mut surface, path),
            Item::Text(text) => outlines(text).iter().for_each(|path| draw_path(&mut surface, path)),
        }
    }
    surface.finish();
    sheet.finish();
    document.finish().map_err(|error| refused(&error))
}

fn draw_path(surface: &mut Surface<'_>, path: &Path) {
    let mut builder = PathBuilder::new();
    let f = |x: f64| (x * POINTS) as f32;
    for subpath in &path.subpaths {
        builder.move_to(f(subpath.start[0]), f(subpath.start[1]));
        for piece in subpath.without_arcs() {
            match piece {
                Piece::Cubic { first, second, to } => {
                    builder.cubic_to(f(first[0]), f(first[1]), f(second[0]), f(second[1]), f(to[0]), f(to[1]));
                }
                other => {
                    let [x, y] = other.end();
                    builder.line_to(f(x), f(y));
                }
            }
        }
        if subpath.closed {
            builder.close();
        }
    }
    let Some(built) = builder.finish() else { return };
    let paint = |[r, g, b]: [u8; 3]| rgb::Color::new(r, g, b).into();
    surface.set_fill(path.fill.map(|color| Fill {
        paint: paint(color),
        opacity: NormalizedF32::ONE,
        rule: FillRule::NonZero,
    }));
    surface.set_stroke(path.stroke.as_ref().map(|stroke| {
        Stroke {
            paint: paint(stroke.color),
            width: f(stroke.width),
            line_cap: LineCap::Round,
            line_join: LineJoin::Round,
            dash: (!stroke.dashes.is_empty())
                .then(|| StrokeDash { array: stroke.dashes.iter().map(|dash| f(*dash)).collect(), offset: 0.0 }),
            ..Stroke::default()
        }
    }));
    surface.draw_path(&built);
}
