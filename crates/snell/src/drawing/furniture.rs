//! What a drawing has around its picture: title, scale, frame. Millimetres on the page.

use snell_math::{Bounds3, Point3, portable};
use snell_scene::scene;

use super::marks::LABEL;
use super::screen::Screen;
use crate::camera::Projection;
use crate::vector::{Group, Horizontal, Item, Path, Piece, Stroke, Subpath, Text, Vertical};
use crate::viewing::{Rectangle, RectangleMap};

/// The height of a title's letters.
const TITLE: f64 = 5.0;

/// A text at the origin in a drawing's manner: with a margin, so that it can be read over lines.
pub fn label_text(markup: &str, color: [u8; 3]) -> Text {
    Text {
        markup: markup.to_owned(),
        at: [0.0, 0.0],
        size: LABEL,
        color,
        horizontal: Horizontal::Left,
        vertical: Vertical::Baseline,
        rotation: 0.0,
        halo: true,
    }
}

/// How much higher a title makes the page.
pub fn title_height(drawing: &scene::Drawing) -> f64 {
    if drawing.title.is_some() { 1.8 * TITLE } else { 0.0 }
}

/// The round length (1, 2 or 5 times a power of ten) next below a positive length.
pub fn round_length(length: f64) -> f64 {
    if !(length > 0.0 && length.is_finite()) {
        return 1.0;
    }
    let mut unit = portable::pow(10.0, (portable::ln(length) / std::f64::consts::LN_10).floor());
    // The logarithm may be a rounding beside a power of ten.
    if unit > length {
        unit *= 0.1;
    }
    if 10.0 * unit <= length {
        unit *= 10.0;
    }
    let steps = [5.0, 2.0, 1.0];
    steps.into_iter().find(|step| step * unit <= length).unwrap_or(1.0) * unit
}

/// Title, scale and frame, as far as the drawing asks for them.
pub fn groups(
    drawing: &scene::Drawing,
    screen: &Screen<'_>,
    bounds: &Bounds3,
    page_from_raster: &RectangleMap,
    page_width: f64,
) -> Vec<Group> {
    let [width, height] = screen.pipeline.pixels.map(f64::from);
    let ([left, top], [right, bottom]) = (page_from_raster.point([0.0, 0.0]), page_from_raster.point([width, height]));
    let mut groups = Vec::new();
    if let Some(title) = &drawing.title {
        let at = [0.5 * page_width, 1.3 * TITLE];
        let text = Text { at, size: TITLE, horizontal: Horizontal::Center, halo: false, ..label_text(title, [0; 3]) };
        groups.push(Group { name: "title".to_owned(), items: vec![Item::Text(text)] });
    }
    if drawing.frame {
        let inset = 0.25 * drawing.line_width;
        let corners = Rectangle { left: left + inset, right: right - inset, bottom: bottom - inset, top: top + inset };
        groups.push(Group {
            name: "frame".to_owned(),
            items: vec![Item::Path(frame(&corners, 0.5 * drawing.line_width))],
        });
    }
    if drawing.scale_bar {
        groups.extend(scale_bar(screen, bounds, page_from_raster, [left, bottom]));
    }
    groups
}

/// A rectangle's border.
pub fn frame(r: &Rectangle, width: f64) -> Path {
    let pieces = [[r.right, r.top], [r.right, r.bottom], [r.left, r.bottom]].map(|to| Piece::Line { to });
    let outline = Subpath { start: [r.left, r.top], pieces: pieces.to_vec(), closed: true };
    Path { subpaths: vec![outline], stroke: Some(Stroke { color: [0; 3], width, dashes: Vec::new() }), fill: None }
}

/// A bar as long as a round number of world units is in the picture: everywhere in a parallel projection, and in perspective at the
/// depth of the scene's middle, which the label tells.
fn scale_bar(
    screen: &Screen<'_>,
    bounds: &Bounds3,
    page_from_raster: &RectangleMap,
    [left, bottom]: [f64; 2],
) -> Option<Group> {
    let camera = screen.camera;
    let back = camera.axes()[2];
    let middle = if bounds.is_finite() { bounds.center() } else { Point3::ORIGIN };
    let depth = -(middle - camera.eye()).dot(back);
    let is_perspective = camera.projection() == Projection::Perspective;
    if is_perspective && depth <= 0.0 {
        return None;
    }
    let per_unit = page_from_raster.scale()[0].abs() / screen.pixel_length(camera.eye() - back * depth);
    let length = round_length(45.0 / per_unit);
    let (x, y, tick) = (left + 5.0, bottom - 5.0, 1.2);
    let long = length * per_unit;
    let bar = Subpath {
        start: [x, y - tick],
        pieces: [[x, y], [x + long, y], [x + long, y - tick]].map(|to| Piece::Line { to }).to_vec(),
        closed: false,
    };
    let stroke = Stroke { color: [0; 3], width: 0.3, dashes: Vec::new() };
    let at_depth = if is_perspective { format!(" at depth {}", rounded(depth)) } else { String::new() };
    let text = format!("{} {}{at_depth}", rounded(length), if length == 1.0 { "unit" } else { "units" });
    let at = [x + 0.5 * long, y - 1.2];
    let label = Text { at, size: 2.8, horizontal: Horizontal::Center, ..label_text(&text, [0; 3]) };
    let items = vec![Item::Path(Path { subpaths: vec![bar], stroke: Some(stroke), fill: None }), Item::Text(label)];
    Some(Group { name: "scale".to_owned(), items })
}

/// A number to three digits.
fn rounded(x: f64) -> String {
    let decimals = if x >= 100.0 {
        0
    } else if x >= 10.0 {
        1
    } else if x >= 1.0 {
        2
    } else {
        4
    };
    let text = format!("{x:.decimals$}");
    if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.').to_owned() } else { text }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn round_lengths_are_one_two_or_five() {
        for (length, expected) in
            [(1.0, 1.0), (1.99, 1.0), (2.0, 2.0), (4.9, 2.0), (7.0, 5.0), (10.0, 10.0), (0.03, 0.02), (1e3, 1e3)]
        {
            let round = round_length(length);
            assert!((round / expected - 1.0).abs() < 1e-12, "{length}: {round}");
        }
        assert_eq!(round_length(f64::NAN), 1.0);
        assert_eq!(rounded(12.34), "12.3");
        assert_eq!(rounded(2.0), "2");
        assert_eq!(rounded(200.0), "200");
    }
}
