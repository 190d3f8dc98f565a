//! Where the pictures of curves cross: the only places at which one of them can disappear behind what another one bounds.
//!
//! Appel, "The notion of quantitative invisibility and the machine rendering of solids", ACM National Conference 1967: along a
//! line, visibility changes where it passes the outline of something, or goes through a surface. All positions are raster
//! coordinates.

/// A straight piece of an outline's picture.
#[derive(Clone, Copy, Debug)]
struct Piece {
    a: [f64; 2],
    b: [f64; 2],
}

/// The outlines of a picture, to be asked which of them a segment crosses: a grid of cells that know the pieces in them.
#[derive(Debug)]
pub struct Crossings {
    pieces: Vec<Piece>,
    columns: usize,
    rows: usize,
    cell: f64,
    /// For each cell, where its pieces begin in `members`; and the end of the last.
    starts: Vec<u32>,
    members: Vec<u32>,
}

/// The smallest edge of a cell, in pixels.
const CELL: f64 = 8.0;
/// At most so many cells along an edge of the picture.
const MOST_CELLS: usize = 512;

impl Crossings {
    /// Of the pieces of all outlines, for a picture of that many pixels. Pieces outside of it count for nothing.
    pub fn new(size: [f64; 2], pieces: impl IntoIterator<Item = [[f64; 2]; 2]>) -> Self {
        let cell = CELL.max(size[0].max(size[1]) / MOST_CELLS as f64);
        let count = |length: f64| ((length / cell).ceil() as usize).clamp(1, MOST_CELLS + 1);
        let (columns, rows) = (count(size[0]), count(size[1]));
        let is_finite = |piece: &Piece| piece.a.iter().chain(&piece.b).all(|c| c.is_finite());
        let pieces: Vec<Piece> = pieces.into_iter().map(|[a, b]| Piece { a, b }).filter(is_finite).collect();
        let mut grid = Self { pieces, columns, rows, cell, starts: vec![0; columns * rows + 1], members: Vec::new() };
        // Counted first, then put in place.
        let mut counts = vec![0_u32; columns * rows + 1];
        for piece in &grid.pieces {
            grid.visit_cells(piece.a, piece.b, |cell| counts[cell + 1] += 1);
        }
        for cell in 1..counts.len() {
            counts[cell] += counts[cell - 1];
        }
        let mut members = vec![0_u32; counts[columns * rows] as usize];
        let mut next = counts.clone();
        for (index, piece) in grid.pieces.iter().enumerate() {
            grid.visit_cells(piece.a, piece.b, |cell| {
                members[next[cell] as usize] = index as u32;
                next[cell] += 1;
            });
        }
        (grid.starts, grid.members) = (counts, members);
        grid
    }

    /// Calls with every cell that a segment passes: row by row the columns between which it runs there.
    fn visit_cells(&self, a: [f64; 2], b: [f64; 2], mut visit: impl FnMut(usize)) {
        let (low, high) = if a[1] <= b[1] { (a, b) } else { (b, a) };
        let row_of = |y: f64| (y / self.cell).floor();
        let (first, last) = (row_of(low[1]).max(0.0), row_of(high[1]).min(self.rows as f64 - 1.0));
        if first > last {
            return;
        }
        for row in first as usize..=last as usize {
            let (y0, y1) = (row as f64 * self.cell, (row as f64 + 1.0) * self.cell);
            let x_at = |y: f64| {
                let height = high[1] - low[1];
                if height > 0.0 {
                    low[0] + (high[0] - low[0]) * ((y - low[1]) / height).clamp(0.0, 1.0)
                } else {
                    low[0]
                }
            };
            // A level segment has both ends in its one row.
            let (xa, xb) = if high[1] - low[1] > 0.0 { (x_at(y0), x_at(y1)) } else { (low[0], high[0]) };
            let margin = 1e-9 * self.cell;
            let (from, to) = ((xa.min(xb) - margin) / self.cell, (xa.max(xb) + margin) / self.cell);
            let (from, to) = (from.floor().max(0.0), to.floor().min(self.columns as f64 - 1.0));
            if from <= to {
                (from as usize..=to as usize).for_each(|column| visit(row * self.columns + column));
            }
        }
    }

    /// Appends the shares of the segment from `a` to `b`, each in [0, 1], at which it crosses an outline; not in order, and some more
    /// than once.
    pub fn along(&self, a: [f64; 2], b: [f64; 2], shares: &mut Vec<f64>) {
        self.visit_cells(a, b, |cell| {
            let members = &self.members[self.starts[cell] as usize..self.starts[cell + 1] as usize];
            shares.extend(members.iter().filter_map(|&index| share(a, b, &self.pieces[index as usize])));
        });
    }
}

/// The share of the way from `a` to `b` at which a piece is crossed or touched; `None` where it is not, or both are parallel.
fn share(a: [f64; 2], b: [f64; 2], piece: &Piece) -> Option<f64> {
    let (d, e) = ([b[0] - a[0], b[1] - a[1]], [piece.b[0] - piece.a[0], piece.b[1] - piece.a[1]]);
    let between = [piece.a[0] - a[0], piece.a[1] - a[1]];
    let cross = |p: [f64; 2], q: [f64; 2]| p[0] * q[1] - p[1] * q[0];
    let denominator = cross(d, e);
    let (s, t) = (cross(between, e) / denominator, cross(between, d) / denominator);
    // A little beyond the piece's ends, so that none is missed where two pieces meet.
    let reach = 1e-9;
    ((0.0..=1.0).contains(&s) && (-reach..=1.0 + reach).contains(&t)).then_some(s)
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    fn points() -> impl Strategy<Value = [f64; 2]> {
        [-30.0..130.0f64, -30.0..90.0f64]
    }

    fn sorted(mut shares: Vec<f64>) -> Vec<f64> {
        shares.sort_by(f64::total_cmp);
        shares.dedup();
        shares
    }

    proptest! {
        #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::default() })]
        #[test]
        fn no_crossing_inside_the_picture_is_missed(
            outlines in prop::collection::vec([points(), points()], 0..40), a in points(), b in points(),
        ) {
            let size = [100.0, 60.0];
            let inside = |share: f64| {
                let p = [a[0] + (b[0] - a[0]) * share, a[1] + (b[1] - a[1]) * share];
                p[0] > 0.0 && p[0] < size[0] && p[1] > 0.0 && p[1] < size[1]
            };
            let brute = outlines.iter().filter_map(|[p, q]| share(a, b, &Piece { a: *p, b: *q }));
            let brute = sorted(brute.filter(|share| inside(*share)).collect());
            let mut found = Vec::new();
            Crossings::new(size, outlines.clone()).along(a, b, &mut found);
            let found = sorted(found.into_iter().filter(|share| inside(*share)).collect());
            prop_assert_eq!(&found, &brute);
            // The twin: an outline less gives another answer wherever it was crossed.
            if let Some((first, rest)) = outlines.split_first() {
                let mut without = Vec::new();
                Crossings::new(size, rest.to_vec()).along(a, b, &mut without);
                let was_crossed = share(a, b, &Piece { a: first[0], b: first[1] }).is_some_and(inside);
                let without = sorted(without.into_iter().filter(|share| inside(*share)).collect());
                prop_assert_eq!(without != found, was_crossed);
            }
        }
    }

    #[test]
    fn level_upright_and_broken_pieces() {
        let grid = Crossings::new(
            [100.0, 60.0],
            [[[10.0, 8.0], [90.0, 8.0]], [[40.0, 0.0], [40.0, 60.0]], [[f64::NAN, 0.0], [9.0, 9.0]]],
        );
        let mut shares = Vec::new();
        grid.along([20.0, 0.0], [20.0, 16.0], &mut shares);
        assert_eq!(sorted(std::mem::take(&mut shares)), [0.5]);
        grid.along([0.0, 20.0], [80.0, 20.0], &mut shares);
        assert_eq!(sorted(std::mem::take(&mut shares)), [0.5]);
        grid.along([40.0, 20.0], [40.0, 30.0], &mut shares);
        assert!(shares.is_empty(), "parallel ones do not cross");
    }
}
