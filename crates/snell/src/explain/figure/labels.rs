//! Texts of a figure that keep out of each other's way: of several places for each, the one that covers least.

use crate::vector::{Horizontal, Item, Path, Subpath, Text, Vertical, measure};
use crate::viewing::Rectangle;

/// What texts should not cover.
#[derive(Debug)]
pub struct Labels {
    place: Rectangle,
    /// Left, top, right, bottom of what stands already.
    taken: Vec<[f64; 4]>,
    lines: Vec<[[f64; 2]; 2]>,
    faint: Vec<[[f64; 2]; 2]>,
    items: Vec<Item>,
}

impl Labels {
    /// In a picture's place, before any text is placed; `lines` are those of rays, `faint` ones the
    /// scene's.
    pub fn new(place: Rectangle, lines: Vec<[[f64; 2]; 2]>, faint: Vec<[[f64; 2]; 2]>) -> Self {
        Self { place, taken: Vec::new(), lines, faint, items: Vec::new() }
    }

    /// Keeps texts away from a place.
    pub fn keep_free(&mut self, at: [f64; 2], radius: f64) {
        self.taken.push([at[0] - radius, at[1] - radius, at[0] + radius, at[1] + radius]);
    }

    /// A text with its middle at the best of some places.
    pub fn text(&mut self, markup: &str, size: f64, color: [u8; 3], places: &[[f64; 2]]) {
        let measured = measure(markup, size);
        let half = [0.5 * measured.width + 0.4, 0.5 * measured.ascent + 0.5];
        let Some(at) = self.best(half, places) else { return };
        self.items.push(Item::Text(Text {
            markup: markup.to_owned(),
            at,
            size,
            color,
            horizontal: Horizontal::Center,
            vertical: Vertical::Middle,
            rotation: 0.0,
            halo: true,
        }));
    }

    /// A number in a disk.
    pub fn badge(&mut self, number: usize, color: [u8; 3], places: &[[f64; 2]]) {
        let Some(at) = self.best([2.2, 2.2], places) else { return };
        self.items.extend(badge(number, color, at));
    }

    /// What was placed, to be drawn over everything.
    pub fn items(self) -> Vec<Item> {
        self.items
    }

    /// The place that covers least, which is taken then; `None` where all are outside of the picture.
    fn best(&mut self, half: [f64; 2], places: &[[f64; 2]]) -> Option<[f64; 2]> {
        let cost = |at: &[f64; 2]| -> Option<f64> {
            let area = [at[0] - half[0], at[1] - half[1], at[0] + half[0], at[1] + half[1]];
            let Rectangle { left, right, bottom, top } = self.place;
            if area[0] < left || area[1] < top || area[2] > right || area[3] > bottom {
                return None;
            }
            let over_texts: f64 = self.taken.iter().map(|taken| overlap(&area, taken)).sum();
            let box_of_text = Rectangle { left: area[0], right: area[2], bottom: area[3], top: area[1] };
            let over = |lines: &[[[f64; 2]; 2]]| -> f64 {
                let covered = lines.iter().filter_map(|[a, b]| box_of_text.clip(*a, *b));
                covered.map(|[a, b]| ((a[0] - b[0]) * (a[0] - b[0]) + (a[1] - b[1]) * (a[1] - b[1])).sqrt()).sum()
            };
            Some(10.0 * over_texts + over(&self.lines) + 0.3 * over(&self.faint))
        };
        // The first of equals is the nearest.
        let mut best: Option<(f64, [f64; 2])> = None;
        for place in places {
            if let Some(cost) = cost(place)
                && best.is_none_or(|(least, _)| cost < least - 1e-9)
            {
                best = Some((cost, *place));
            }
        }
        let (_, at) = best?;
        self.taken.push([at[0] - half[0], at[1] - half[1], at[0] + half[0], at[1] + half[1]]);
        Some(at)
    }
}

/// A number in a disk.
pub fn badge(number: usize, color: [u8; 3], at: [f64; 2]) -> [Item; 2] {
    let disk = Path { subpaths: vec![Subpath::ellipse(at, [1.9; 2], 0.0)], stroke: None, fill: Some(color) };
    let text = Text {
        markup: number.to_string(),
        at,
        size: 2.9,
        color: [255; 3],
        horizontal: Horizontal::Center,
        vertical: Vertical::Middle,
        rotation: 0.0,
        halo: false,
    };
    [Item::Path(disk), Item::Text(text)]
}

/// The area that two boxes have in common.
fn overlap(a: &[f64; 4], b: &[f64; 4]) -> f64 {
    let width = a[2].min(b[2]) - a[0].max(b[0]);
    let height = a[3].min(b[3]) - a[1].max(b[1]);
    if width > 0.0 && height > 0.0 { width * height } else { 0.0 }
}

/// Letters that mark nothing: for names, which may have any.
pub fn plain(name: &str) -> String {
    name.chars().flat_map(|c| matches!(c, '*' | '_' | '^' | '\\').then_some('\\').into_iter().chain([c])).collect()
}

/// Places around a point, the nearest first.
pub fn around(at: [f64; 2], distances: &[f64]) -> Vec<[f64; 2]> {
    const DIRECTIONS: [[f64; 2]; 8] =
        [[0.0, -1.0], [0.7, -0.7], [1.0, 0.0], [0.7, 0.7], [0.0, 1.0], [-0.7, 0.7], [-1.0, 0.0], [-0.7, -0.7]];
    let ring = |&d: &f64| DIRECTIONS.map(|[x, y]| [at[0] + x * d, at[1] + y * d]);
    distances.iter().flat_map(ring).collect()
}
