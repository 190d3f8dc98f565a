//! Pages as SVG: true sizes, a group for each name, ellipses as ellipses. Scalable Vector Graphics (SVG) 1.1, W3C 2011.

use std::collections::BTreeSet;
use std::fmt::Write;

use base64::Engine;
use base64::engine::general_purpose::STANDARD;

use super::text::outlines;
use super::{Arc, Group, Item, Page, Path, Piece, Subpath, VectorError};

/// The largest part of an ellipse that one command stands for, in radians.
const MOST_PER_ARC: f64 = 0.9 * std::f64::consts::PI;

/// Writes a page as SVG; the same page gives the same bytes.
///
/// ```
/// use snell::vector::{Group, Item, Page, Path, Stroke, Subpath, encode_svg};
/// let stroke = Some(Stroke { color: [0; 3], width: 0.3, dashes: vec![] });
/// let path = Path { subpaths: vec![Subpath::ellipse([5.0, 5.0], [3.0, 2.0], 0.0)], stroke, fill: None };
/// let group = Group { name: "a ring".to_owned(), items: vec![Item::Path(path)] };
/// let page = Page { width: 10.0, height: 10.0, groups: vec![group], ..Page::default() };
/// let svg = encode_svg(&page)?;
/// assert!(svg.contains("width=\"10mm\"") && svg.contains("<g id=\"a-ring\""));
/// assert!(svg.contains("<ellipse cx=\"5\" cy=\"5\" rx=\"3\" ry=\"2\"/>"));
/// # Ok::<(), snell::vector::VectorError>(())
/// ```
///
/// # Errors
/// [`VectorError`], where the page has no extent or a coordinate is not finite.
pub fn encode_svg(page: &Page) -> Result<String, VectorError> {
    page.check()?;
    let (width, height) = (number(page.width), number(page.height));
    let mut svg = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{width}mm\" height=\"{height}mm\" viewBox=\"0 0 {width} {height}\">\n"
    );
    if let Some(title) = &page.title {
        put(&mut svg, format_args!("<title>{}</title>\n", escaped(&super::text::plain(title))));
    }
    put(&mut svg, format_args!("<rect width=\"{width}\" height=\"{height}\" fill=\"#ffffff\"/>\n"));
    if let Some(backdrop) = &page.backdrop {
        let [x, y, w, h] = backdrop.place.map(number);
        let data = STANDARD.encode(&backdrop.png);
        put(
            &mut svg,
            format_args!(
                "<image x=\"{x}\" y=\"{y}\" width=\"{w}\" height=\"{h}\" preserveAspectRatio=\"none\" \
                 href=\"data:image/png;base64,{data}\"/>\n"
            ),
        );
    }
    let mut ids = BTreeSet::new();
    for group in &page.groups {
        write_group(&mut svg, group, &mut ids);
    }
    svg.push_str("</svg>\n");
    Ok(svg)
}

/// Appends; a `String` takes everything.
fn put(svg: &mut String, text: std::fmt::Arguments<'_>) {
    let _ = svg.write_fmt(text);
}

fn write_group(svg: &mut String, group: &Group, ids: &mut BTreeSet<String>) {
    put(
        svg,
        format_args!(
            "<g id=\"{}\" fill=\"none\" stroke-linecap=\"round\" stroke-linejoin=\"round\">\n<title>{}</title>\n",
            unique_id(&group.name, ids),
            escaped(&group.name)
        ),
    );
    for item in &group.items {
        match item {
            Item::Path(path) => write_path(svg, path),
            Item::Text(text) => {
                put(svg, format_args!("<g aria-label=\"{}\">\n", escaped(&super::text::plain(&text.markup))));
                outlines(text).iter().for_each(|path| write_letters(svg, path));
                svg.push_str("</g>\n");
            }
        }
    }
    svg.push_str("</g>\n");
}

fn write_path(svg: &mut String, path: &Path) {
    let mut attributes = String::new();
    if let Some(fill) = path.fill {
        put(&mut attributes, format_args!(" fill=\"{}\"", color(fill)));
    }
    if let Some(stroke) = &path.stroke {
        put(
            &mut attributes,
            format_args!(" stroke=\"{}\" stroke-width=\"{}\"", color(stroke.color), number(stroke.width)),
        );
        if !stroke.dashes.is_empty() {
            let dashes: Vec<String> = stroke.dashes.iter().map(|dash| number(*dash)).collect();
            put(&mut attributes, format_args!(" stroke-dasharray=\"{}\"", dashes.join(" ")));
        }
    }
    // Ellipses are elements of their own, and all else is one path.
    let mut data = String::new();
    let (ellipses, others): (Vec<&Subpath>, Vec<&Subpath>) =
        path.subpaths.iter().partition(|subpath| path.fill.is_none() && whole_ellipse(subpath).is_some());
    if !ellipses.is_empty() {
        put(svg, format_args!("<g{attributes}>\n"));
        ellipses.into_iter().filter_map(whole_ellipse).for_each(|arc| write_ellipse(svg, &arc));
        svg.push_str("</g>\n");
    }
    for subpath in others {
        match whole_ellipse(subpath) {
            // A filled disk alone is an ellipse too.
            Some(arc) if path.subpaths.len() == 1 => {
                put(svg, format_args!("<g{attributes}>\n"));
                write_ellipse(svg, &arc);
                svg.push_str("</g>\n");
            }
            _ => write_subpath(&mut data, subpath),
        }
    }
    if !data.is_empty() {
        // A subpath a line, for those who read or compare.
        put(svg, format_args!("<path{attributes} d=\"{}\"/>\n", data.trim_end()));
    }
}

/// Filled outlines of letters, of which there are many points: by steps from point to point, in whole micrometres, so that rounding
/// does not add up.
fn write_letters(svg: &mut String, path: &Path) {
    let Some(fill) = path.fill else { return };
    let mut data = String::new();
    for subpath in &path.subpaths {
        let micrometres = |p: [f64; 2]| p.map(|c| (c * 1000.0).round());
        let mut at = micrometres(subpath.start);
        put(&mut data, format_args!("M{} {}", number(at[0] / 1000.0), number(at[1] / 1000.0)));
        let mut step = |command: char, points: &[[f64; 2]]| {
            data.push(command);
            let mut last = at;
            for (index, p) in points.iter().enumerate() {
                last = micrometres(*p);
                let [x, y] = [0, 1].map(|k| number((last[k] - at[k]) / 1000.0));
                put(&mut data, format_args!("{}{x} {y}", if index > 0 { " " } else { "" }));
            }
            at = last;
        };
        for piece in subpath.without_arcs() {
            match piece {
                Piece::Cubic { first, second, to } => step('c', &[first, second, to]),
                other => step('l', &[other.end()]),
            }
        }
        data.push_str("z\n");
    }
    put(svg, format_args!("<path fill=\"{}\" d=\"{}\"/>\n", color(fill), data.trim_end()));
}

fn whole_ellipse(subpath: &Subpath) -> Option<Arc> {
    match subpath.pieces.as_slice() {
        [Piece::Arc(arc)] if arc.is_full() => Some(*arc),
        _ => None,
    }
}

fn write_ellipse(svg: &mut String, arc: &Arc) {
    let [cx, cy] = arc.center.map(number);
    let [rx, ry] = arc.radii.map(number);
    if rx == ry {
        put(svg, format_args!("<circle cx=\"{cx}\" cy=\"{cy}\" r=\"{rx}\"/>\n"));
        return;
    }
    let turn = number(snell_math::portable::degrees(arc.rotation));
    let transform = if turn == "0" { String::new() } else { format!(" transform=\"rotate({turn} {cx} {cy})\"") };
    put(svg, format_args!("<ellipse cx=\"{cx}\" cy=\"{cy}\" rx=\"{rx}\" ry=\"{ry}\"{transform}/>\n"));
}

fn write_subpath(data: &mut String, subpath: &Subpath) {
    let point = |p: [f64; 2]| {
        let [x, y] = p.map(number);
        format!("{x} {y}")
    };
    put(data, format_args!("M{}", point(subpath.start)));
    for piece in &subpath.pieces {
        match piece {
            Piece::Line { to } => put(data, format_args!("L{}", point(*to))),
            Piece::Cubic { first, second, to } => {
                put(data, format_args!("C{} {} {}", point(*first), point(*second), point(*to)));
            }
            Piece::Arc(arc) => write_arc(data, arc),
        }
    }
    data.push_str(if subpath.closed { "Z\n" } else { "\n" });
}

/// An arc by its ends. One of half a turn or more is written in parts: near half a turn the ends hardly tell where its middle is,
/// and of a whole turn they do not tell it at all.
fn write_arc(data: &mut String, arc: &Arc) {
    let swept = arc.end - arc.start;
    let [rx, ry] = arc.radii.map(number);
    let turn = number(snell_math::portable::degrees(arc.rotation));
    let sweep = u8::from(swept > 0.0);
    let parts = (swept.abs() / MOST_PER_ARC).ceil().max(1.0);
    let mut part = 1.0;
    while part <= parts {
        let end = if part == parts { arc.end } else { arc.start + swept * part / parts };
        let [x, y] = arc.point(end).map(number);
        put(data, format_args!("A{rx} {ry} {turn} 0 {sweep} {x} {y}"));
        part += 1.0;
    }
}

/// A number in millimetres or degrees: to a tenth of a micrometre, as short as it can be written.
fn number(x: f64) -> String {
    let text = format!("{x:.4}");
    let text = text.trim_end_matches('0').trim_end_matches('.');
    if text == "-0" { "0".to_owned() } else { text.to_owned() }
}

fn color([r, g, b]: [u8; 3]) -> String {
    format!("#{r:02x}{g:02x}{b:02x}")
}

/// Text for XML; what XML cannot have in it is left out.
fn escaped(text: &str) -> String {
    let mut out = String::with_capacity(text.len());
    for letter in text.chars() {
        match letter {
            '&' => out.push_str("&amp;"),
            '<' => out.push_str("&lt;"),
            '>' => out.push_str("&gt;"),
            '"' => out.push_str("&quot;"),
            '\u{fffe}' | '\u{ffff}' => {}
            letter if letter.is_control() => {}
            letter => out.push(letter),
        }
    }
    out
}

/// An id that is no other group's: the name with `-` for what an id should not have.
fn unique_id(name: &str, ids: &mut BTreeSet<String>) -> String {
    let mut id: String = name.chars().map(|letter| if letter.is_alphanumeric() { letter } else { '-' }).collect();
    id = id.trim_matches('-').to_owned();
    if !id.starts_with(char::is_alphabetic) {
        id.insert_str(0, "group-");
    }
    let id = id.trim_end_matches('-').to_owned();
    let mut candidate = id.clone();
    let mut count = 2;
    while !ids.insert(candidate.clone()) {
        candidate = format!("{id}-{count}");
        count += 1;
    }
    candidate
}
