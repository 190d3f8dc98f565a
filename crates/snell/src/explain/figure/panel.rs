//! What stands beside the picture of rays: the pixel, the legend, and the rays in words with their shares.

use super::labels::{badge, plain};
use super::rays::{Chosen, NORMAL, color};
use super::shown;
use crate::explain::words::{arrival, sentence};
use crate::explain::{ExplainedTerm, Explanation, Kind, Subject, TermKind};
use crate::vector::{Group, Horizontal, Item, Page, Path, Piece, Stroke, Subpath, Text, Vertical, measure};
use crate::viewing::Rectangle;

/// The width of the list in millimetres.
const WIDTH: f64 = 92.0;
/// Between the picture and the list.
const GAP: f64 = 6.0;
/// To the right of the list.
const MARGIN: f64 = 2.5;
const SIZE: f64 = 3.1;
const SMALL: f64 = 2.7;
const LINE: f64 = 4.1;
const BLACK: [u8; 3] = [0; 3];
const GRAY: [u8; 3] = [96; 3];

/// A thin border around the picture.
pub fn border(place: &Rectangle, page: &mut Page) {
    let (inset, r) = (0.15, place);
    let corners = [[r.right, r.top], [r.right, r.bottom], [r.left, r.bottom], [r.left, r.top]];
    let middle = [0.5 * (r.left + r.right), 0.5 * (r.top + r.bottom)];
    let corners = corners.map(|corner| [0, 1].map(|k: usize| corner[k] - inset * (corner[k] - middle[k]).signum()));
    let pieces = corners[..3].iter().map(|to| Piece::Line { to: *to }).collect();
    let outline = Subpath { start: corners[3], pieces, closed: true };
    let stroke = Stroke { color: [170; 3], width: 0.25, dashes: Vec::new() };
    let path = Path { subpaths: vec![outline], stroke: Some(stroke), fill: None };
    page.groups.push(Group { name: "border".to_owned(), items: vec![Item::Path(path)] });
}

/// A title above everything, which makes the page higher.
pub fn title(markup: &str, page: &mut Page) {
    let height = 9.0;
    for group in &mut page.groups {
        group.shift([0.0, height]);
    }
    page.height += height;
    let at = [0.5 * page.width, 6.0];
    let text = Text { horizontal: Horizontal::Center, ..line(markup, at, 4.6, BLACK) };
    page.groups.push(Group { name: "title".to_owned(), items: vec![Item::Text(text)] });
    page.title = Some(markup.to_owned());
}

/// The list, to the right of the picture.
pub fn list(told: &Explanation, chosen: &[Chosen], least: f64, page: &mut Page) {
    let left = page.width + GAP;
    page.width = left + WIDTH + MARGIN;
    let mut list = List { items: Vec::new(), left, y: 4.0 };
    list.heading(told);
    list.legend(told, chosen);
    for one in chosen {
        list.ray(told, chosen, one, least);
    }
    let drawn: Vec<usize> = chosen.iter().map(|one| one.ray).collect();
    let others = told
        .rays
        .iter()
        .enumerate()
        .filter(|(number, ray)| ray.sample == 0 && ray.kind != Kind::Shadow && !drawn.contains(number));
    let others = others.count();
    if others > 0 {
        let what = if others == 1 { "1 ray more carries".to_owned() } else { format!("{others} rays more carry") };
        list.text(&format!("{what} less, and {} not drawn.", if others == 1 { "is" } else { "are" }), 0.0, SMALL, GRAY);
    }
    page.height = page.height.max(list.y + 1.0);
    page.groups.push(Group { name: "list".to_owned(), items: list.items });
}

/// A list in the making.
struct List {
    items: Vec<Item>,
    left: f64,
    /// The middle of the next line.
    y: f64,
}

impl List {
    fn heading(&mut self, told: &Explanation) {
        let what = match told.subject {
            Subject::Pixel([x, y]) => format!("Pixel {x}, {y}"),
            Subject::Sample([x, y], sample) => format!("Sample {sample} of pixel {x}, {y}"),
            Subject::Ray(..) => "A ray".to_owned(),
        };
        let square = [[0.0, -1.8], [3.6, -1.8], [3.6, 1.8], [0.0, 1.8]].map(|[x, y]| [self.left + x, self.y + y]);
        let pieces = square[1..].iter().map(|to| Piece::Line { to: *to }).collect();
        let outline = Subpath { start: square[0], pieces, closed: true };
        let stroke = Stroke { color: [120; 3], width: 0.2, dashes: Vec::new() };
        let path = Path { subpaths: vec![outline], stroke: Some(stroke), fill: Some(shown(told.pixel)) };
        self.items.push(Item::Path(path));
        let [r, g, b] = told.pixel.to_array();
        let of = if told.samples.len() > 1 { format!(", sample 1 of {}", told.samples.len()) } else { String::new() };
        self.text(&format!("{what}: ({r:.3}, {g:.3}, {b:.3}){of}"), 5.2, SIZE, BLACK);
        self.y += 0.8;
    }

    fn legend(&mut self, told: &Explanation, chosen: &[Chosen]) {
        let mut x = self.left;
        let has = |kind: Kind| match kind {
            Kind::Shadow => told.rays.iter().any(|ray| ray.kind == kind),
            _ => chosen.iter().any(|one| told.rays[one.ray].kind == kind),
        };
        let kinds = [
            (Kind::Camera, "from the eye"),
            (Kind::Reflected, "reflected"),
            (Kind::Refracted, "refracted"),
            (Kind::Scattered, "scattered"),
            (Kind::Shadow, "to a light"),
        ];
        let mut entries: Vec<([u8; 3], &str, Vec<f64>)> = kinds
            .into_iter()
            .filter(|(kind, _)| has(*kind))
            .map(|(kind, name)| (color(kind), name, if kind == Kind::Shadow { vec![1.8, 0.9] } else { Vec::new() }))
            .collect();
        entries.push((NORMAL, "normal", vec![1.4, 1.0]));
        for (color, name, dashes) in entries {
            let stroke = Stroke { color, width: 0.45, dashes };
            let sample = Subpath::polyline(&[[x, self.y], [x + 4.0, self.y]]);
            self.items.push(Item::Path(Path { subpaths: vec![sample], stroke: Some(stroke), fill: None }));
            self.items.push(Item::Text(line(name, [x + 4.8, self.y], SMALL, GRAY)));
            x += 7.4 + measure(name, SMALL).width;
        }
        self.y += LINE + 1.5;
    }

    /// A ray with its number, what happened to it, and what it brought.
    fn ray(&mut self, told: &Explanation, chosen: &[Chosen], one: &Chosen, least: f64) {
        let ray = &told.rays[one.ray];
        let indent = 3.0 * (ray.depth.saturating_sub(1) as f64).min(6.0);
        self.items.extend(badge(one.number, color(ray.kind), [self.left + indent + 1.9, self.y]));
        let name = match ray.kind {
            Kind::Camera => "from the eye",
            Kind::Reflected => "reflected",
            Kind::Refracted => "refracted",
            Kind::Scattered => "scattered",
            Kind::Shadow => "to a light",
        };
        let parent = ray.parent.and_then(|parent| chosen.iter().find(|other| other.ray == parent));
        let of = match parent {
            Some(parent) if ray.kind != Kind::Camera => format!(" at the end of {}", parent.number),
            _ => String::new(),
        };
        let band = ray.wavelength_nm.map_or(String::new(), |nm| format!(", {nm:.0} nm"));
        let share = told.portion(ray.share).map_or(String::new(), |share| format!("{:.1} %", 100.0 * share));
        let at = [self.left + WIDTH, self.y];
        self.items.push(Item::Text(Text { horizontal: Horizontal::Right, ..line(&share, at, SIZE, BLACK) }));
        self.text(&format!("{name}{of}{band}"), indent + 5.0, SIZE, color(ray.kind));
        self.text(&plain(&sentence(ray)), indent + 5.0, SMALL, BLACK);
        for term in told.terms_of(one.ray).filter(|term| term.kind != TermKind::Scattering) {
            let portion = told.portion(term.share).unwrap_or(0.0);
            let is_blocked = term.unblocked.is_some() && term.value.is_black();
            if portion.abs() < least && !is_blocked {
                continue;
            }
            self.term(told, term, indent + 5.0, portion);
        }
        self.y += 0.9;
    }

    fn term(&mut self, told: &Explanation, term: &ExplainedTerm, indent: f64, portion: f64) {
        let light = term.light.as_deref().unwrap_or("a light");
        let what = match term.kind {
            TermKind::Background => "background".to_owned(),
            TermKind::Emission => "own light".to_owned(),
            TermKind::Ambient => "ambient".to_owned(),
            TermKind::Photons => "photons".to_owned(),
            TermKind::Diffuse => format!("diffuse, {light}"),
            TermKind::Specular => format!("highlight, {light}"),
            TermKind::Scattering | TermKind::Rounding => return,
        };
        let arrives = term.shadow_ray.map_or(String::new(), |ray| format!(": {}", arrival(&told.rays[ray])));
        let share = format!("{:.1} %", 100.0 * portion);
        let at = [self.left + WIDTH - 14.0, self.y];
        self.items.push(Item::Text(Text { horizontal: Horizontal::Right, ..line(&share, at, SMALL, GRAY) }));
        let text = format!("{what}{arrives}");
        self.wrapped(&plain(&text), indent, SMALL, GRAY, WIDTH - 26.0);
    }

    fn text(&mut self, markup: &str, indent: f64, size: f64, color: [u8; 3]) {
        self.wrapped(markup, indent, size, color, WIDTH - 13.0);
    }

    /// A text, in as many lines as it takes to end before `right`.
    fn wrapped(&mut self, markup: &str, indent: f64, size: f64, color: [u8; 3], right: f64) {
        let mut put = |text: &str| {
            self.items.push(Item::Text(line(text, [self.left + indent, self.y], size, color)));
            self.y += if size < SIZE { LINE - 0.5 } else { LINE };
        };
        let mut current = String::new();
        // A number stays with its percent sign.
        for word in markup.replace(" %", "\u{1}").split(' ').map(|word| word.replace('\u{1}', " %")) {
            let longer = if current.is_empty() { word.clone() } else { format!("{current} {word}") };
            if !current.is_empty() && measure(&longer, size).width > right - indent {
                put(&current);
                current = word;
            } else {
                current = longer;
            }
        }
        put(&current);
    }
}

fn line(markup: &str, at: [f64; 2], size: f64, color: [u8; 3]) -> Text {
    Text {
        markup: markup.to_owned(),
        at,
        size,
        color,
        horizontal: Horizontal::Left,
        vertical: Vertical::Middle,
        rotation: 0.0,
        halo: false,
    }
}
