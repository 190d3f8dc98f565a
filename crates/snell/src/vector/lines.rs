//! What lines and curves are made of: polylines, ellipses, arrow heads; arcs as Bézier curves; boxes, shifts, checks.

use std::f64::consts::TAU;

use snell_math::portable;

use super::{Arc, Group, Item, Page, Path, Piece, Subpath, VectorError};

/// The largest part of an ellipse that one Bézier curve stands for, in radians: it is off by less than 1e-7 of the radius.
const MOST_PER_CUBIC: f64 = TAU / 32.0;

impl Arc {
    /// Cubic Bézier curves that are this arc but for 1e-7 of its larger radius: for each both control points and the end.
    pub fn cubics(&self) -> Vec<[[f64; 2]; 3]> {
        let swept = self.end - self.start;
        let count = (swept.abs() / MOST_PER_CUBIC).ceil().clamp(1.0, 64.0);
        let step = swept / count;
        // Both ends and tangents agree, and the middle: Riškus, Information Technology and Control 35(4), 2006.
        let reach = 4.0 / 3.0 * portable::tan(0.25 * step);
        let mut cubics = Vec::new();
        let mut index = 0.0;
        while index < count {
            let (from, to) = (self.start + step * index, self.start + step * (index + 1.0));
            let (a, b) = (self.point(from), self.point(to));
            let (da, db) = (self.tangent(from), self.tangent(to));
            cubics.push([
                [a[0] + reach * da[0], a[1] + reach * da[1]],
                [b[0] - reach * db[0], b[1] - reach * db[1]],
                b,
            ]);
            index += 1.0;
        }
        cubics
    }

    /// The derivative of [`Arc::point`].
    fn tangent(&self, angle: f64) -> [f64; 2] {
        let (x, y) = (-self.radii[0] * portable::sin(angle), self.radii[1] * portable::cos(angle));
        let (c, s) = (portable::cos(self.rotation), portable::sin(self.rotation));
        [c * x - s * y, s * x + c * y]
    }
}

impl Piece {
    /// Where it ends.
    pub fn end(&self) -> [f64; 2] {
        match self {
            Self::Line { to } | Self::Cubic { to, .. } => *to,
            Self::Arc(arc) => arc.point(arc.end),
        }
    }

    /// The same piece run through from its end to its start, which has to be given.
    #[must_use]
    pub fn reversed(&self, start: [f64; 2]) -> Self {
        match *self {
            Self::Line { .. } => Self::Line { to: start },
            Self::Cubic { first, second, .. } => Self::Cubic { first: second, second: first, to: start },
            Self::Arc(arc) => Self::Arc(Arc { start: arc.end, end: arc.start, ..arc }),
        }
    }

    fn shift(&mut self, by: [f64; 2]) {
        let moved = |p: &mut [f64; 2]| *p = [p[0] + by[0], p[1] + by[1]];
        match self {
            Self::Line { to } => moved(to),
            Self::Cubic { first, second, to } => [first, second, to].into_iter().for_each(moved),
            Self::Arc(arc) => moved(&mut arc.center),
        }
    }

    fn is_finite(&self) -> bool {
        let finite = |p: &[f64; 2]| p.iter().all(|c| c.is_finite());
        match self {
            Self::Line { to } => finite(to),
            Self::Cubic { first, second, to } => finite(first) && finite(second) && finite(to),
            Self::Arc(arc) => {
                finite(&arc.center) && finite(&arc.radii) && finite(&[arc.start, arc.end]) && arc.rotation.is_finite()
            }
        }
    }
}

impl Subpath {
    /// Straight from point to point; nothing where there is none.
    pub fn polyline(points: &[[f64; 2]]) -> Self {
        let pieces = points.iter().skip(1).map(|p| Piece::Line { to: *p }).collect();
        Self { start: points.first().copied().unwrap_or_default(), pieces, closed: false }
    }

    /// A whole ellipse.
    pub fn ellipse(center: [f64; 2], radii: [f64; 2], rotation: f64) -> Self {
        let arc = Arc { center, radii, rotation, start: 0.0, end: TAU };
        Self { start: arc.point(0.0), pieces: vec![Piece::Arc(arc)], closed: true }
    }

    /// Where it ends.
    pub fn end(&self) -> [f64; 2] {
        self.pieces.last().map_or(self.start, Piece::end)
    }

    /// The same line from its end to its start.
    #[must_use]
    pub fn reversed(&self) -> Self {
        let mut starts = vec![self.start];
        starts.extend(self.pieces.iter().map(Piece::end));
        let pieces = self.pieces.iter().zip(&starts).rev().map(|(piece, start)| piece.reversed(*start)).collect();
        Self { start: self.end(), pieces, closed: self.closed }
    }

    /// Straight and Bézier pieces alone, each with where it starts: arcs become curves.
    pub fn without_arcs(&self) -> Vec<Piece> {
        let cubic = |[first, second, to]: [[f64; 2]; 3]| Piece::Cubic { first, second, to };
        let plain = |piece: &Piece| match piece {
            Piece::Arc(arc) => arc.cubics().into_iter().map(cubic).collect(),
            other => vec![*other],
        };
        self.pieces.iter().flat_map(plain).collect()
    }
}

impl Group {
    /// Moves all of it, millimetres.
    pub fn shift(&mut self, by: [f64; 2]) {
        let moved = |p: &mut [f64; 2]| *p = [p[0] + by[0], p[1] + by[1]];
        for item in &mut self.items {
            match item {
                Item::Text(text) => moved(&mut text.at),
                Item::Path(path) => {
                    for subpath in &mut path.subpaths {
                        moved(&mut subpath.start);
                        subpath.pieces.iter_mut().for_each(|piece| piece.shift(by));
                    }
                }
            }
        }
    }
}

impl Page {
    /// That all of it can be written.
    pub(super) fn check(&self) -> Result<(), VectorError> {
        let (width, height) = (self.width, self.height);
        let is_page = |length: f64| length > 0.0 && length < 1e6;
        if !(is_page(width) && is_page(height)) {
            return Err(VectorError::Page { width, height });
        }
        let is_finite = |item: &Item| match item {
            Item::Text(text) => [text.at[0], text.at[1], text.size, text.rotation].iter().all(|n| n.is_finite()),
            Item::Path(path) => {
                let stroke = path.stroke.iter().flat_map(|stroke| stroke.dashes.iter().chain([&stroke.width]));
                stroke.into_iter().all(|length| length.is_finite())
                    && path.subpaths.iter().all(|subpath| {
                        subpath.start.iter().all(|c| c.is_finite()) && subpath.pieces.iter().all(Piece::is_finite)
                    })
            }
        };
        if self.backdrop.as_ref().is_some_and(|backdrop| !backdrop.place.iter().all(|c| c.is_finite())) {
            return Err(VectorError::NotFinite { group: "backdrop".to_owned() });
        }
        match self.groups.iter().find(|group| !group.items.iter().all(is_finite)) {
            Some(group) => Err(VectorError::NotFinite { group: group.name.clone() }),
            None => Ok(()),
        }
    }
}

/// A filled arrow head with its tip at a point, along a direction of any length, `size` millimetres long.
pub fn arrow_head(tip: [f64; 2], direction: [f64; 2], size: f64, color: [u8; 3]) -> Path {
    let length = (direction[0] * direction[0] + direction[1] * direction[1]).sqrt();
    if !(length > 0.0 && length.is_finite()) {
        return Path::default();
    }
    let (x, y) = (direction[0] / length, direction[1] / length);
    let at =
        |along: f64, across: f64| [tip[0] + size * (along * x - across * y), tip[1] + size * (along * y + across * x)];
    // A little hollow at the back, as they are printed.
    let mut head = Subpath::polyline(&[tip, at(-1.0, 0.34), at(-0.8, 0.0), at(-1.0, -0.34)]);
    head.closed = true;
    Path { subpaths: vec![head], stroke: None, fill: Some(color) }
}
