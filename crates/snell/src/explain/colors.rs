//! False colours: numbers as colours that grow lighter with them, and a bar that tells which colour is how much.

use snell_image::{DisplayImage, Image, Samples};
use snell_math::color::{linear_to_srgb, srgb_to_linear};

use super::map::Property;
use crate::vector::{
    Group, Horizontal, Item, Page, Path, Piece, Stroke, Subpath, Text, VectorError, Vertical, measure, rasterize,
};

/// From least to most, sRGB: from nearly black over blue, magenta and orange to light yellow, so that lightness alone tells the order,
/// in print and to those who see fewer colours.
const COLORS: [[u8; 3]; 7] =
    [[8, 8, 24], [44, 30, 110], [120, 28, 132], [190, 52, 96], [232, 100, 44], [246, 170, 50], [252, 246, 190]];
/// The bar's strip: pixels for a picture that is 640 wide.
const STRIP: f64 = 60.0;
/// Steps of a picture's colours.
const TABLE: u32 = 2048;
/// The steps of the bar.
const STEPS: u32 = 128;

/// A value from 0 to 1 as a colour.
pub fn color(share: f64) -> [u8; 3] {
    // So that NaN is the least.
    let place = if share > 0.0 { share.min(1.0) } else { 0.0 } * (COLORS.len() - 1) as f64;
    let first = (place as usize).min(COLORS.len() - 2);
    let within = (place - first as f64) as f32;
    let (a, b) = (COLORS[first], COLORS[first + 1]);
    [0, 1, 2].map(|i: usize| {
        let [a, b] = [a[i], b[i]].map(|code| srgb_to_linear(f32::from(code) / 255.0));
        (linear_to_srgb(a + (b - a) * within) * 255.0).round() as u8
    })
}

/// The range of a map's colours.
pub fn range(values: &Image<f32>, property: &Property) -> [f64; 2] {
    if !property.is_count() {
        return [0.0, 1.0];
    }
    let most = values.pixels().iter().fold(0.0_f32, |most, value| most.max(*value));
    let least = if *property == Property::Depth { 1.0 } else { 0.0 };
    [least, f64::from(most).ceil().max(least + 1.0)]
}

/// A map in false colours, with its bar below.
///
/// # Errors
/// [`VectorError`], where the picture is too large for a bar.
pub fn false_colors(values: &Image<f32>, property: &Property) -> Result<DisplayImage, VectorError> {
    let [least, most] = range(values, property);
    let width = values.width();
    // Finer than what 8 bits show.
    let table: Vec<[u8; 3]> = (0..=TABLE).map(|step| color(f64::from(step) / f64::from(TABLE))).collect();
    let step = |value: f32| {
        let share = (f64::from(value) - least) / (most - least);
        // NaN becomes 0.
        ((share * f64::from(TABLE)).round().clamp(0.0, f64::from(TABLE))) as usize
    };
    let mut codes: Vec<[u8; 3]> = values.pixels().iter().map(|value| table[step(*value)]).collect();
    let bar = bar(width, property, [least, most])?;
    if let Samples::Eight(samples) = bar.samples() {
        codes.extend(samples.chunks_exact(3).map(|code| [code[0], code[1], code[2]]));
    }
    let height = values.height() + bar.height();
    DisplayImage::from_codes(width, height, codes)
        .ok_or(VectorError::TooLarge { width: u64::from(width), height: u64::from(height) })
}

/// The strip with the bar, as wide as the picture.
fn bar(width: u32, property: &Property, [least, most]: [f64; 2]) -> Result<DisplayImage, VectorError> {
    // Millimetres are pixels here, of a picture that is 640 wide.
    let (full, margin) = (640.0, 24.0);
    let mut page = Page { width: full, height: STRIP, ..Page::default() };
    let (left, right, top, bottom) = (margin, full - margin, 26.0, 37.0);
    let at = |share: f64| left + (right - left) * share;
    let mut items = Vec::new();
    // Whole numbers have a field each.
    let fields = if property.is_count() && most - least <= 16.0 { (most - least) as u32 + 1 } else { STEPS };
    for field in 0..fields {
        let [from, to] = [field, field + 1].map(|edge| at(f64::from(edge) / f64::from(fields)));
        let corners = [[to, top], [to, bottom], [from, bottom]];
        let pieces = corners.map(|to| Piece::Line { to }).to_vec();
        let rectangle = Subpath { start: [from, top], pieces, closed: true };
        let fill = Some(color(f64::from(field) / f64::from((fields - 1).max(1))));
        items.push(Item::Path(Path { subpaths: vec![rectangle], stroke: None, fill }));
    }
    let text = |markup: &str, at: [f64; 2], size: f64| {
        Item::Text(Text {
            markup: markup.to_owned(),
            at,
            size,
            color: [0; 3],
            horizontal: Horizontal::Center,
            vertical: Vertical::Middle,
            rotation: 0.0,
            halo: false,
        })
    };
    let title = property.title().replace('\\', "\\\\").replace('_', "\\_").replace('*', "\\*").replace('^', "\\^");
    let size = 17.0 * (1.0_f64).min((right - left) / measure(&title, 17.0).width.max(1.0));
    items.push(text(&title, [0.5 * full, 13.0], size));
    for (share, label) in ticks(property, [least, most], fields) {
        let x = at(share);
        let tick = Subpath::polyline(&[[x, bottom], [x, bottom + 3.0]]);
        let stroke = Stroke { color: [0; 3], width: 0.8, dashes: Vec::new() };
        items.push(Item::Path(Path { subpaths: vec![tick], stroke: Some(stroke), fill: None }));
        items.push(text(&label, [x, bottom + 12.0], 15.0));
    }
    page.groups.push(Group { name: "bar".to_owned(), items });
    rasterize(&page, width)
}

/// Places on the bar with what they mean.
fn ticks(property: &Property, [least, most]: [f64; 2], fields: u32) -> Vec<(f64, String)> {
    if !property.is_count() {
        return (0..=4).map(|step| (f64::from(step) / 4.0, format!("{} %", 25 * step))).collect();
    }
    if fields != STEPS {
        let middle = |field: u32| (f64::from(field) + 0.5) / f64::from(fields);
        return (0..fields).map(|field| (middle(field), format!("{}", least + f64::from(field)))).collect();
    }
    let label = |share: f64| format!("{:.0}", least + (most - least) * share);
    [0.0, 0.25, 0.5, 0.75, 1.0].into_iter().map(|share| (share, label(share))).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn colours_grow_lighter() {
        let lightness = |share: f64| {
            let [r, g, b] = color(share).map(|code| srgb_to_linear(f32::from(code) / 255.0));
            0.2126 * r + 0.7152 * g + 0.0722 * b
        };
        for step in 0..100 {
            let share = f64::from(step) / 100.0;
            assert!(lightness(share + 0.01) >= lightness(share), "{share}");
        }
        assert_eq!(color(f64::NAN), COLORS[0]);
        assert_eq!((color(-1.0), color(2.0)), (COLORS[0], COLORS[6]));
    }
}
