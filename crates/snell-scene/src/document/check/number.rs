//! Numbers: finite, of a size that can be computed with, whole where they must be, and in their range.

use super::super::schema::Part;
use super::super::tree::{Node, Value};
use super::rules::NumberRule;
use super::{Checker, say};
use crate::diagnostic::Diagnostic;

/// The largest number of a scene: squares and products of a few still fit into `f64`, and any one into `f32`.
const LARGEST: f64 = 1e30;
/// The smallest number above 0 where 0 itself is not possible.
pub(in crate::document) const SMALLEST: f64 = 1e-30;

impl Checker<'_, '_> {
    /// A number.
    pub(super) fn number(&mut self, node: &Node<'_>, rule: &NumberRule<'_>) -> bool {
        let Some(number) = node.number() else { return false };
        let &NumberRule { part, form, ref range, whole } = rule;
        let wrong = if !number.is_finite() {
            "must be a finite number".to_owned()
        } else if whole && !matches!(node.value, Value::Integer(_)) {
            "must be a whole number".to_owned()
        } else if let Some(rule) = range.broken_by(number) {
            format!("must be {rule}")
        } else if number.abs() > LARGEST {
            format!("must be at most {} in magnitude", show(LARGEST))
        } else if range.above == Some(0.0) && number < SMALLEST {
            format!("must be at least {}", show(SMALLEST))
        } else {
            return true;
        };
        let message = format!("{} is {}, but {wrong}", self.place(), show(number));
        self.tell(Diagnostic::error(message).at(node.place.span(), format!("expected {}", say::number(part, form))));
        false
    }
}

/// The numbers that are allowed.
pub(super) struct Range {
    least: Option<f64>,
    most: Option<f64>,
    above: Option<f64>,
    below: Option<f64>,
}

impl Range {
    /// The range that a part of the schema and the form of it that takes numbers say.
    pub fn of(part: Part<'_>, form: Part<'_>) -> Self {
        let word = |key| part.number(key).or_else(|| form.number(key));
        let (least, most) = match form.text("format") {
            Some("uint32") => (Some(0.0), Some(f64::from(u32::MAX))),
            Some("int32") => (Some(f64::from(i32::MIN)), Some(f64::from(i32::MAX))),
            _ => (None, None),
        };
        let most = word("maximum").or(most);
        Self {
            least: word("minimum").or(least),
            most,
            above: word("exclusiveMinimum"),
            below: word("exclusiveMaximum"),
        }
    }

    fn broken_by(&self, number: f64) -> Option<String> {
        let inside = self.least.is_none_or(|least| number >= least)
            && self.most.is_none_or(|most| number <= most)
            && self.above.is_none_or(|above| number > above)
            && self.below.is_none_or(|below| number < below);
        if inside { None } else { Some(self.in_words()) }
    }

    /// The range in words: "from 0 to 1", "above 0"; empty where there is none.
    pub fn in_words(&self) -> String {
        let most = self.most.filter(|most| *most < f64::from(i32::MAX));
        match (self.least, most, self.above, self.below) {
            (Some(least), Some(most), ..) => format!("from {} to {}", show(least), show(most)),
            (Some(least), ..) => format!("at least {}", show(least)),
            (None, None, Some(above), Some(below)) => format!("above {} and below {}", show(above), show(below)),
            (None, None, Some(above), None) => format!("above {}", show(above)),
            (None, Some(most), Some(above), _) => format!("above {} and at most {}", show(above), show(most)),
            (None, Some(most), ..) => format!("at most {}", show(most)),
            (None, None, None, Some(below)) => format!("below {}", show(below)),
            (None, None, None, None) => String::new(),
        }
    }
}

/// A number in a message: as people write it.
pub(in crate::document) fn show(number: f64) -> String {
    if number != 0.0 && number.is_finite() && !(1e-4..1e16).contains(&number.abs()) {
        format!("{number:e}")
    } else {
        format!("{number}")
    }
}
