//! Plots: formulas are compiled, numbers that are formulas computed.

use super::Resolver;
use crate::diagnostic::{Diagnostic, Span};
use crate::document::check::number::show;
use crate::document::model::{self, Either, Located, Quantity};
use crate::scene::{self, AxisPlace, CurveKind, Expression, Extent, Plot, Ticks};

/// The largest number, as for numbers that are written out.
const LARGEST: f64 = 1e30;

impl Resolver<'_> {
    /// All plots; no two have the same name.
    pub(super) fn plots(&mut self, plots: &[Located<model::Plot>]) -> Vec<Plot> {
        plots.iter().map(|plot| self.plot(&plot.value)).collect()
    }

    fn plot(&mut self, plot: &model::Plot) -> Plot {
        let name = plot.name.as_ref().map(|name| name.value.clone());
        let what = |part: &str| match &name {
            Some(name) => format!("the {part} of the plot {name:?}"),
            None => format!("the plot's {part}"),
        };
        let sides = [0, 1, 2, 3].map(|i| self.quantity(&plot.window[i]));
        let between = |first: &Option<Span>, last: &Option<Span>| match (first, last) {
            (Some(a), Some(b)) if a.source == b.source && a.range.start <= b.range.end => {
                Some(Span { source: a.source, range: a.range.start..b.range.end })
            }
            _ => last.clone(),
        };
        let span = between(&plot.window[0].span, &plot.window[3].span);
        let window = match sides {
            [Some(left), Some(right), Some(bottom), Some(top)] => {
                Some(self.extent([left, right, bottom, top], &span, &what("window")))
            }
            _ => None,
        };
        let viewport = self.extent(plot.viewport.value, &plot.viewport.span, &what("viewport"));
        Plot {
            title: plot.title.clone(),
            window: window.unwrap_or_default(),
            viewport,
            fit: match plot.fit {
                model::PlotFit::Stretch => scene::PlotFit::Stretch,
                model::PlotFit::Keep => scene::PlotFit::Keep,
            },
            x: self.axis(&plot.x),
            y: self.axis(&plot.y),
            grid: plot.grid,
            frame: plot.frame,
            curves: plot.curve.iter().filter_map(|curve| self.curve(curve, window)).collect(),
            labels: plot.label.iter().filter_map(|label| self.plot_label(label)).collect(),
            name,
        }
    }

    fn axis(&mut self, axis: &model::Axis) -> scene::Axis {
        let ticks = match (&axis.every, &axis.ticks) {
            (Some(every), _) => match self.quantity(every) {
                Some(step) if step > 0.0 => Ticks::Every(step),
                Some(step) => {
                    let message = format!("the distance from tick to tick is {}, but must be above 0", show(step));
                    self.error(&every.span, message, "no step forward");
                    Ticks::Auto
                }
                None => Ticks::Auto,
            },
            (None, Either::A(model::TicksWord::Auto)) => Ticks::Auto,
            (None, Either::A(model::TicksWord::None)) => Ticks::None,
            (None, Either::B(list)) => Ticks::At(list.iter().filter_map(|tick| self.tick(tick)).collect()),
        };
        let at = match axis.at {
            Either::A(model::AxisWord::Border) => AxisPlace::Border,
            Either::B(at) => AxisPlace::At(at),
        };
        scene::Axis { show: axis.show, label: axis.label.clone(), ticks, pi: axis.pi, at, arrow: axis.arrow }
    }

    fn tick(&mut self, tick: &Located<Either<model::Tick, Quantity>>) -> Option<(f64, Option<String>)> {
        match &tick.value {
            Either::A(tick) => Some((self.quantity(&tick.at)?, tick.label.clone())),
            Either::B(at) => {
                let at = Located { value: at.clone(), span: tick.span.clone() };
                Some((self.quantity(&at)?, None))
            }
        }
    }

    fn curve(&mut self, curve: &model::PlotCurve, window: Option<Extent>) -> Option<scene::PlotCurve> {
        let kind = if let Some(function) = &curve.function {
            let model::PlotFunction { y, from, to } = &function.value;
            let y = self.expression(&y.value.0, &y.span, Some("x"));
            let from_value = from.as_ref().map_or(window.map(|window| window.left), |from| self.quantity(from));
            let to_value = to.as_ref().map_or(window.map(|window| window.right), |to| self.quantity(to));
            let end = [to, from].into_iter().flatten().next().map_or(&function.span, |end| &end.span);
            let (from, to) = self.range(from_value?, to_value?, end)?;
            CurveKind::Function { y: y?, from, to }
        } else if let Some(parametric) = &curve.parametric {
            let model::PlotParametric { x, y, from, to } = &parametric.value;
            let x = self.expression(&x.value.0, &x.span, Some("t"));
            let y = self.expression(&y.value.0, &y.span, Some("t"));
            let (from_value, to_value) = (self.quantity(from), self.quantity(to));
            let end = if to.span.is_some() { &to.span } else { &from.span };
            let (from, to) = self.range(from_value?, to_value?, end)?;
            CurveKind::Parametric { x: x?, y: y?, from, to }
        } else {
            let model::PlotData { points, closed, line, marks } = curve.data.as_ref()?;
            let numbers = points.iter().map(|[x, y]| Some([self.quantity(x)?, self.quantity(y)?]));
            let points = numbers.collect::<Option<Vec<[f64; 2]>>>()?;
            CurveKind::Data { points, closed: *closed, line: *line, marks: *marks }
        };
        Some(scene::PlotCurve {
            kind,
            label: curve.label.clone(),
            label_at: curve.label_at,
            offset: curve.offset,
            color: curve.color.0,
            width: curve.width,
            dashed: curve.dashed,
            fill: curve.fill.map(|fill| fill.0),
            arrow: curve.arrow,
        })
    }

    fn range(&mut self, from: f64, to: f64, span: &Option<Span>) -> Option<(f64, f64)> {
        if from >= to {
            self.error(
                span,
                format!("the curve goes from {} to {}, which is nowhere", show(from), show(to)),
                "`to` must be above `from`",
            );
            return None;
        }
        Some((from, to))
    }

    fn plot_label(&mut self, label: &model::PlotLabel) -> Option<scene::PlotLabel> {
        let [x, y] = [0, 1].map(|i| self.quantity(&label.at[i]));
        Some(scene::PlotLabel {
            at: [x?, y?],
            text: label.text.clone(),
            size: label.size,
            offset: label.offset,
            align: match label.align {
                model::Align::Left => scene::Align::Left,
                model::Align::Center => scene::Align::Center,
                model::Align::Right => scene::Align::Right,
            },
            color: label.color.0,
        })
    }

    /// A number, or the value of a formula without a variable.
    fn quantity(&mut self, quantity: &Located<Quantity>) -> Option<f64> {
        let text = match &quantity.value.0 {
            Either::A(number) => return Some(*number),
            Either::B(text) => text,
        };
        let number = self.expression(text, &quantity.span, None)?.evaluate(0.0);
        if !number.is_finite() || number.abs() > LARGEST {
            let message = if number.is_finite() {
                format!("the formula {text:?} is {number:e}, but must be at most 1e30 in magnitude")
            } else {
                format!("the formula {text:?} has no finite value")
            };
            self.error(&quantity.span, message, "expected a number");
            return None;
        }
        Some(number)
    }

    fn expression(&mut self, text: &str, span: &Option<Span>, variable: Option<&str>) -> Option<Expression> {
        match Expression::parse(text, variable) {
            Ok(expression) => Some(expression),
            Err(mistake) => {
                let place = span.as_ref().map(|span| self.inside(span, text, mistake.range.clone()));
                let diagnostic = Diagnostic::error(mistake.message).at_optional(place, mistake.label);
                self.diagnostics.push(match mistake.help {
                    Some(help) => diagnostic.help(help),
                    None => diagnostic,
                });
                None
            }
        }
    }

    /// A place within a text of the file, where the file has it letter by letter; else all of it.
    fn inside(&self, span: &Span, text: &str, range: std::ops::Range<usize>) -> Span {
        let source = &self.diagnostics.sources.get(span.source).text;
        let begin = [1, 0, 3].map(|quotes| span.range.start + quotes).into_iter().find(|begin| {
            *begin + text.len() <= span.range.end && source.get(*begin..*begin + text.len()) == Some(text)
        });
        match begin {
            Some(begin) => Span { source: span.source, range: begin + range.start..begin + range.end },
            None => span.clone(),
        }
    }
}
