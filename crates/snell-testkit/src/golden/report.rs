//! What a golden picture's mismatch leaves for the eye: `NAME-expected.png`, `NAME-actual.png`, `NAME-difference.png`, the
//! three side by side in `NAME-triptych.png`, a page `NAME.html`, and `index.html` of all pages in the folder.
//!
//! In the difference picture, equal pixels are a faint gray copy of the expected ones; different ones are red, the brighter
//! the farther apart, and never too dark to see.

use std::fmt::Write;
use std::path::{Path, PathBuf};

use snell_image::metrics::Difference;
use snell_image::{BitDepth, DisplayImage, Image, ToneCurve};
use snell_math::Rgb;

use super::{Failure, write_png};

/// Writes the report and gives the page's path.
pub(super) fn write(
    folder: &Path,
    name: &str,
    expected: &DisplayImage,
    actual: &DisplayImage,
    difference: Option<&Difference>,
) -> Result<PathBuf, Failure> {
    let apart = difference_picture(expected, actual);
    let develop = |light: &Image<Rgb>| DisplayImage::develop(light, ToneCurve::None, 0.0, BitDepth::Eight);
    let triptych = side_by_side([&expected.to_linear(), &actual.to_linear(), &apart]);
    for (part, picture) in [
        ("expected", expected),
        ("actual", actual),
        ("difference", &develop(&apart)),
        ("triptych", &develop(&triptych)),
    ] {
        // A picture without pixels cannot be a file; the page then shows nothing in its place.
        if picture.width() > 0 && picture.height() > 0 {
            write_png(&folder.join(format!("{name}-{part}.png")), picture)?;
        }
    }

    let page = folder.join(format!("{name}.html"));
    super::write(&page, html(name, expected, actual, difference).as_bytes())?;
    super::write(&folder.join("index.html"), index(folder).as_bytes())?;
    Ok(page)
}

/// Light that shows where two pictures differ, over both their areas.
fn difference_picture(expected: &DisplayImage, actual: &DisplayImage) -> Image<Rgb> {
    let (width, height) = (expected.width().max(actual.width()), expected.height().max(actual.height()));
    let light = |image: &DisplayImage, x, y| {
        (x < image.width() && y < image.height())
            .then(|| image.code(x, y).map(|code| f32::from(code) / f32::from(image.depth().max_code())))
    };
    Image::from_fn(width, height, |x, y| match (light(expected, x, y), light(actual, x, y)) {
        (Some(a), Some(b)) if a == b => Rgb::gray(Rgb::from_srgb(a).luminance() * 0.1),
        (Some(a), Some(b)) => {
            let largest = a.iter().zip(b).map(|(a, b)| (a - b).abs()).fold(0.0, f32::max);
            Rgb::new(0.3 + 0.7 * largest, 0.0, 0.0)
        }
        // Only one of the pictures has this pixel.
        _ => Rgb::new(1.0, 0.0, 1.0),
    })
}

/// Pictures next to each other, with white gaps.
fn side_by_side(pictures: [&Image<Rgb>; 3]) -> Image<Rgb> {
    const GAP: u32 = 4;
    let width = pictures.iter().map(|picture| picture.width()).sum::<u32>() + 2 * GAP;
    let height = pictures.iter().map(|picture| picture.height()).max().unwrap_or(0);
    let mut result = Image::filled(width, height, Rgb::WHITE);
    let mut left = 0;
    for picture in pictures {
        for y in 0..picture.height() {
            for (x, pixel) in (left..).zip(picture.row(y)) {
                if let Some(target) = result.get_mut(x, y) {
                    *target = *pixel;
                }
            }
        }
        left += picture.width() + GAP;
    }
    result
}

fn html(name: &str, expected: &DisplayImage, actual: &DisplayImage, difference: Option<&Difference>) -> String {
    let told = match difference {
        Some(difference) => format!(
            "{} pixels differ, by up to {} codes (at {:?}); the first is {:?}; root mean square {:.4}.",
            difference.pixels,
            difference.largest,
            difference.largest_at.unwrap_or_default(),
            difference.first_at.unwrap_or_default(),
            difference.root_mean_squared(),
        ),
        None => format!(
            "Expected {} × {} pixels of {:?} bits, got {} × {} of {:?}.",
            expected.width(),
            expected.height(),
            expected.depth(),
            actual.width(),
            actual.height(),
            actual.depth(),
        ),
    };
    let mut pictures = String::new();
    for part in ["expected", "actual", "difference"] {
        // Writing to a string cannot fail.
        let _ = write!(
            pictures,
            "<figure><img src=\"{name}-{part}.png\" alt=\"{part}\"><figcaption>{part}</figcaption></figure>"
        );
    }
    format!(
        "<!doctype html><meta charset=\"utf-8\"><title>{name}</title>\
         <style>body{{font:16px sans-serif;background:#888}}figure{{display:inline-block;margin:8px}}\
         img{{image-rendering:pixelated;min-width:256px;max-width:30vw}}</style>\
         <h1>{name}</h1><p>{told}</p>{pictures}\
         <p>If the new picture is right: <code>SNELL_BLESS=1</code>, look, commit.</p>\n"
    )
}

/// A page of links to all pages of the folder, by name.
fn index(folder: &Path) -> String {
    let mut pages: Vec<String> = std::fs::read_dir(folder)
        .map(|entries| {
            entries
                .filter_map(|entry| entry.ok()?.file_name().into_string().ok())
                .filter(|file| file.ends_with(".html") && file != "index.html")
                .collect()
        })
        .unwrap_or_default();
    pages.sort();
    let links: String = pages
        .iter()
        .map(|page| {
            let name = page.trim_end_matches(".html");
            format!("<p><a href=\"{page}\"><img src=\"{name}-triptych.png\" alt=\"\" style=\"max-width:90vw\"><br>{name}</a></p>")
        })
        .collect();
    format!("<!doctype html><meta charset=\"utf-8\"><title>Golden pictures that differ</title>{links}\n")
}
