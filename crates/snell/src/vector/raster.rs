//! Pages as pixels, antialiased on white paper.

use snell_image::{DisplayImage, Limits, decode_display};
use tiny_skia::{
    Color, FillRule, FilterQuality, IntSize, LineCap, LineJoin, Paint, PathBuilder, Pixmap, PixmapPaint, StrokeDash,
    Transform,
};

use super::text::outlines;
use super::{Backdrop, Item, Page, Path, Piece, VectorError};

/// The most pixels of a drawing.
pub const MOST_PIXELS: u64 = 100_000_000;

/// A page as a picture of `width` pixels from left to right; its height follows.
///
/// # Errors
/// [`VectorError`], where the page has no extent, a coordinate is not finite, or there would be too many pixels.
pub fn rasterize(page: &Page, width: u32) -> Result<DisplayImage, VectorError> {
    page.check()?;
    let scale = f64::from(width) / page.width;
    let height = (page.height * scale).round().max(1.0);
    let too_large = VectorError::TooLarge { width: u64::from(width), height: height as u64 };
    if width == 0 || f64::from(width) * height > MOST_PIXELS as f64 {
        return Err(too_large);
    }
    // Below the limit it fits.
    let mut pixmap = Pixmap::new(width, height as u32).ok_or(too_large)?;
    pixmap.fill(Color::WHITE);
    if let Some(backdrop) = &page.backdrop {
        draw_backdrop(&mut pixmap, backdrop, scale)?;
    }
    for item in page.groups.iter().flat_map(|group| &group.items) {
        match item {
            Item::Path(path) => draw_path(&mut pixmap, path, scale),
            Item::Text(text) => outlines(text).iter().for_each(|path| draw_path(&mut pixmap, path, scale)),
        }
    }
    // On white paper nothing is left transparent, so the codes are those of the colours.
    let codes: Vec<[u8; 3]> = pixmap.pixels().iter().map(|p| [p.red(), p.green(), p.blue()]).collect();
    DisplayImage::from_codes(width, height as u32, codes)
        .ok_or(VectorError::Page { width: page.width, height: page.height })
}

fn draw_path(pixmap: &mut Pixmap, path: &Path, scale: f64) {
    let mut builder = PathBuilder::new();
    let f = |x: f64| (x * scale) as f32;
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
    let mut paint = Paint { anti_alias: true, ..Paint::default() };
    if let Some([r, g, b]) = path.fill {
        paint.set_color_rgba8(r, g, b, 255);
        pixmap.fill_path(&built, &paint, FillRule::Winding, Transform::identity(), None);
    }
    if let Some(stroke) = &path.stroke {
        let [r, g, b] = stroke.color;
        paint.set_color_rgba8(r, g, b, 255);
        // As in an SVG, an odd list is gone through twice.
        let rounds = 1 + stroke.dashes.len() % 2;
        let dashes: Vec<f32> = std::iter::repeat_n(&stroke.dashes, rounds).flatten().map(|dash| f(*dash)).collect();
        let stroke = tiny_skia::Stroke {
            width: f(stroke.width),
            line_cap: LineCap::Round,
            line_join: LineJoin::Round,
            dash: StrokeDash::new(dashes, 0.0),
            ..tiny_skia::Stroke::default()
        };
        pixmap.stroke_path(&built, &paint, &stroke, Transform::identity(), None);
    }
}

fn draw_backdrop(pixmap: &mut Pixmap, backdrop: &Backdrop, scale: f64) -> Result<(), VectorError> {
    let picture =
        decode_display(&backdrop.png, &Limits::default()).map_err(|error| VectorError::Backdrop(error.to_string()))?;
    let (width, height) = picture.size();
    let mut bytes = Vec::with_capacity(width as usize * height as usize * 4);
    for y in 0..height {
        for x in 0..width {
            let most = u32::from(picture.depth().max_code());
            let eight = |code: u16| ((u32::from(code) * 255 + most / 2) / most) as u8;
            bytes.extend(picture.code(x, y).map(eight));
            bytes.push(255);
        }
    }
    let source = IntSize::from_wh(width, height).and_then(|size| Pixmap::from_vec(bytes, size));
    let source = source.ok_or_else(|| VectorError::Backdrop("it has no pixels".to_owned()))?;
    let [x, y, w, h] = backdrop.place.map(|length| length * scale);
    let (sx, sy) = (w / f64::from(width), h / f64::from(height));
    let exact = (sx - 1.0).abs() < 1e-9 && (sy - 1.0).abs() < 1e-9;
    let quality = if exact { FilterQuality::Nearest } else { FilterQuality::Bilinear };
    let paint = PixmapPaint { quality, ..PixmapPaint::default() };
    let transform = Transform::from_row(sx as f32, 0.0, 0.0, sy as f32, x as f32, y as f32);
    pixmap.draw_pixmap(0, 0, source.as_ref(), &paint, transform, None);
    Ok(())
}
