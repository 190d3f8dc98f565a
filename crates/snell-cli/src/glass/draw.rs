//! A material's index over the wavelength, drawn: the curve where the formula was fitted, dots at the Fraunhofer lines.

use snell::math::Rgb;
use snell::math::dispersion::fraunhofer;
use snell::plot::plot_groups;
use snell::scene::Diagnostic;
use snell::scene::catalogue::Glass;
use snell::scene::scene::{Align, Axis, AxisPlace, CurveKind, Extent, Plot, PlotCurve, PlotFit, PlotLabel, Ticks};
use snell::vector::{Page, encode_svg};

use super::medium_name;
use crate::failure::Failure;

/// The page in millimetres.
const PAGE: [f64; 2] = [160.0, 100.0];
/// What is drawn of the spectrum, in nanometres.
const SEEN_NM: [f64; 2] = [360.0, 830.0];
/// Points of the curve.
const POINTS: u32 = 236;

/// The drawing, as SVG.
pub fn svg(glass: &Glass) -> Result<String, Failure> {
    let wrong = |error: String| Failure::input(Diagnostic::error(error));
    let plot = plot(glass);
    let groups = plot_groups(&plot, PAGE[0], PAGE[1]).map_err(|error| wrong(error.to_string()))?;
    let title = Some(format!("The index of refraction of {}", glass.name));
    let page = Page { width: PAGE[0], height: PAGE[1], title, backdrop: None, groups };
    encode_svg(&page).map_err(|error| wrong(error.to_string()))
}

fn plot(glass: &Glass) -> Plot {
    // Nothing beyond the range is drawn, but of what lies beyond altogether.
    let [low, high] = glass.valid_nm.unwrap_or(SEEN_NM);
    let seen = [low.max(SEEN_NM[0]), high.min(SEEN_NM[1])];
    let [from, to] = if seen[0] < seen[1] { seen } else { SEEN_NM };
    let index = |nm: f64| glass.dispersion.index(nm);
    let points: Vec<[f64; 2]> =
        (0..=POINTS).map(|i| from + (to - from) * f64::from(i) / f64::from(POINTS)).map(|nm| [nm, index(nm)]).collect();
    // Those that catalogues give first; the others are too near to them.
    let is_drawn =
        |(name, nm, _): &(&str, f64, &str)| !name.ends_with('\'') && *name != "D" && (from..=to).contains(nm);
    let lines: Vec<_> = fraunhofer::LINES.into_iter().filter(is_drawn).collect();
    let (least, most) = points.iter().fold((f64::INFINITY, 0.0_f64), |(a, b), [_, n]| (a.min(*n), b.max(*n)));
    let margin = (0.08 * (most - least)).max(0.002);
    let curve = |points, line, marks, color| PlotCurve {
        kind: CurveKind::Data { points, closed: false, line, marks },
        label: None,
        label_at: 0.5,
        offset: [0.0; 2],
        color,
        width: 0.5,
        dashed: false,
        fill: None,
        arrow: false,
    };
    let dots = lines.iter().map(|(_, nm, _)| [*nm, index(*nm)]).collect();
    let window = Extent { left: SEEN_NM[0], right: SEEN_NM[1], bottom: least - margin, top: most + margin };
    let label =
        |at, text: String, offset, align| PlotLabel { at, text, size: 3.0, offset, align, color: Rgb::gray(0.1) };
    let names = lines.iter().map(|(name, nm, _)| label([*nm, index(*nm)], (*name).to_owned(), [1.8, 2.0], Align::Left));
    let below = [0.5 * (window.left + window.right), window.bottom];
    let medium = format!("wavelength in {}", medium_name(glass.reference));
    let labels = names.chain([label(below, medium, [0.0, -10.0], Align::Center)]).collect();
    let axis =
        |label: String| Axis { label: Some(label), ticks: Ticks::Auto, at: AxisPlace::Border, ..Axis::default() };
    Plot {
        name: Some("index".to_owned()),
        title: Some(glass.name.clone()),
        window,
        viewport: Extent { left: 0.13, right: 0.95, bottom: 0.15, top: 0.85 },
        fit: PlotFit::Stretch,
        x: axis("nm".to_owned()),
        y: axis("n".to_owned()),
        grid: true,
        frame: true,
        curves: vec![
            curve(points, true, false, Rgb::new(0.02, 0.1, 0.5)),
            curve(dots, false, true, Rgb::new(0.5, 0.02, 0.02)),
        ],
        labels,
    }
}
