//! Two-dimensional pictures of functions and data: world coordinates → window → viewport → device.
//!
//! What a window shows of the world is clipped to it and drawn in its viewport on the page; axes, ticks, their labels and the title
//! stand around it. World coordinates are the plot's; page coordinates are millimetres from the upper left corner, y down. The
//! look is that of textbooks: thin axes, round numbers, true minus signs, names in italics.

mod axis;
mod curve;
mod pen;
mod sample;
mod ticks;

#[cfg(test)]
mod tests;

use snell_scene::scene::{Align, Extent, Plot, PlotFit};

use crate::vector::{Group, Horizontal, Item, Vertical};
use crate::viewing::{Device, Fit, Rectangle, Viewing2, ViewingError};
use pen::{INK, LETTERS, color, rectangle, stroke, text};

/// Height of the letters of a title, mm.
const TITLE: f64 = 4.0;
/// The colour of frames.
const FRAME: [u8; 3] = [110; 3];

/// How many points of all curves of a plot are computed at most, so that no formula takes forever.
const MOST_EVALUATIONS: usize = 400_000;
/// How many of each may be computed, whatever the number of curves.
const LEAST_EVALUATIONS: usize = 4000;

/// A plot and its place on the page.
struct Sheet<'a> {
    plot: &'a Plot,
    viewing: Viewing2,
    /// What the window fills of the page: its left, right, bottom and top there, so that `bottom` is the larger number.
    place: Rectangle,
    /// The lines of each curve, in world coordinates.
    lines: Vec<Vec<Vec<[f64; 2]>>>,
}

/// A plot as it appears on a page of this size in millimetres: groups of lines, fills and texts, from the back to the front. They
/// are named by the plot's name or title: "wave grid", "wave curves", "wave frame", "wave axes" and "wave labels"; those with
/// nothing in them are left out.
///
/// Curves lie in the window, are true to 0.02 mm, and have gaps where functions have poles or no value.
///
/// ```
/// use snell::plot::plot_groups;
/// use snell::scene::{assets::MemoryAssets, document::read_scene};
/// let text = b"[[plot]]\nname = \"wave\"\nwindow = [0, \"2*pi\", -1, 1]\n[[plot.curve]]\nfunction = { y = \"cos(x)\" }\n";
/// let (scene, _) = read_scene("wave.toml", text, &MemoryAssets::default(), &[]);
/// let groups = plot_groups(&scene.unwrap().plots[0], 160.0, 90.0)?;
/// assert_eq!(groups.iter().map(|group| &*group.name).collect::<Vec<_>>(), ["wave curves", "wave axes"]);
/// # Ok::<(), snell::viewing::ViewingError>(())
/// ```
///
/// # Errors
/// [`ViewingError`] where window, viewport or page are empty or not finite.
pub fn plot_groups(plot: &Plot, page_width: f64, page_height: f64) -> Result<Vec<Group>, ViewingError> {
    let device = Device { width: page_width, height: page_height, y_down: true };
    let fit = match plot.fit {
        PlotFit::Stretch => Fit::Stretch,
        PlotFit::Keep => Fit::Keep,
    };
    let viewing = Viewing2::new(&sides(plot.window), &sides(plot.viewport), &device, fit)?;
    let [left, bottom] = viewing.point([plot.window.left, plot.window.bottom]);
    let [right, top] = viewing.point([plot.window.right, plot.window.top]);
    let place = Rectangle { left, right, bottom, top };
    let evaluations = (MOST_EVALUATIONS / plot.curves.len().max(1)).max(LEAST_EVALUATIONS);
    let lines = plot.curves.iter().map(|curve| curve::world_lines(curve, &viewing, evaluations)).collect();
    let sheet = Sheet { plot, viewing, place, lines };
    let name = plot.name.as_ref().or(plot.title.as_ref()).map_or("plot", |name| name);
    let parts = [
        ("grid", sheet.grid()),
        ("curves", sheet.curves()),
        // Over the curves, which reach into it with half of their width.
        ("frame", sheet.frame()),
        ("axes", sheet.axes()),
        ("labels", sheet.labels()),
    ];
    let groups = parts.into_iter().filter(|(_, items)| !items.is_empty());
    Ok(groups.map(|(part, items)| Group { name: format!("{name} {part}"), items }).collect())
}

fn sides(extent: Extent) -> Rectangle {
    Rectangle::new(extent.left, extent.right, extent.bottom, extent.top)
}

impl Sheet<'_> {
    fn frame(&self) -> Vec<Item> {
        if !self.plot.frame {
            return Vec::new();
        }
        vec![rectangle(&self.place, stroke(FRAME, 0.2))]
    }

    /// Title, labels of curves, and texts.
    fn labels(&self) -> Vec<Item> {
        let mut items = self.curve_labels();
        for label in &self.plot.labels {
            let [x, y] = self.viewing.point(label.at);
            let at = [x + label.offset[0], y - label.offset[1]];
            let horizontal = match label.align {
                Align::Left => Horizontal::Left,
                Align::Center => Horizontal::Center,
                Align::Right => Horizontal::Right,
            };
            items.extend(
                self.near(at)
                    .then(|| text(&label.text, at, label.size, color(label.color), (horizontal, Vertical::Middle))),
            );
        }
        if let Some(title) = &self.plot.title {
            let middle = 0.5 * (self.place.left + self.place.right);
            // The name of the y axis may stand above the window, too.
            let named = self.plot.y.show && self.plot.y.label.is_some();
            let above = if named { self.name_above() + 1.8 * LETTERS } else { 2.5 };
            let at = [middle, self.place.top - above];
            items.push(text(title, at, TITLE, INK, (Horizontal::Center, Vertical::Baseline)));
        }
        items
    }

    /// True within a few pages: farther away nothing is seen, and programs have trouble.
    fn near(&self, [x, y]: [f64; 2]) -> bool {
        x.abs() < 1e5 && y.abs() < 1e5
    }
}
