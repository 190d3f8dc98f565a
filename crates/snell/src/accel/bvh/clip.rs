//! Pieces of a triangle: a polygon that planes across the axes cut in two, and the box of each piece.
//!
//! What rounding does to it. Every corner of a piece is a mean a + (b − a) s of two corners of the piece before, with s in
//! [0, 1]. Think of the triangle as a flat one that is cut at just these s: its pieces are convex and share the points of
//! each cut, so they cover it without a gap, whatever s is and on whichever side of the plane rounding has put a corner.
//! (A point beside the hulls of both pieces would lie on a line that one of them does not meet; the line's two ends in
//! the border would be in the other, which is convex, and so would the point.) The mean is computed with an error of less
//! than 8 u M, u = 2⁻⁵³ and M the largest coordinate, and a mean of two corners carries on no more than the larger of
//! their errors. After [`MAX_CUTS`] cuts that is 512 u M; by twice as much every box is grown, before it is rounded
//! outward. So every point of the triangle is in the box of one of its pieces, and all that is said of boxes and of
//! margins in [`super::traverse`] holds for these as it does for the box of a whole triangle, whose test finds hits within
//! its own rounding of a point of the triangle.

use smallvec::SmallVec;
use snell_math::{Bounds3, Point3};

use super::box32::Box32;

/// A piece is cut no more often than this.
pub(super) const MAX_CUTS: u32 = 64;

/// A convex polygon, left over of a triangle.
#[derive(Clone, Debug)]
pub(super) struct Piece {
    corners: SmallVec<[[f64; 3]; 10]>,
    cuts: u32,
}

impl Piece {
    pub(super) fn whole(triangle: &[[f32; 3]; 3]) -> Self {
        Self { corners: triangle.iter().map(|corner| corner.map(f64::from)).collect(), cuts: 0 }
    }

    pub(super) fn may_be_cut(&self) -> bool {
        self.cuts < MAX_CUTS
    }

    /// The smallest and the largest coordinates of its corners, as computed.
    pub(super) fn corners_of_box(&self) -> [[f64; 3]; 2] {
        let mut corners = [[f64::INFINITY; 3], [f64::NEG_INFINITY; 3]];
        for corner in &self.corners {
            for axis in 0..3 {
                corners[0][axis] = corners[0][axis].min(corner[axis]);
                corners[1][axis] = corners[1][axis].max(corner[axis]);
            }
        }
        corners
    }

    /// A box around the piece; `whole` is that of the triangle.
    pub(super) fn bounds(&self, whole: &Box32) -> Box32 {
        // 2⁻⁴³ is 1024 u.
        let margin = whole.max_abs() / (1_u64 << 43) as f64;
        let [low, high] = self.corners_of_box().map(Point3::from);
        Box32::enclosing(&Bounds3::new(low, high).grown(margin)).common(whole)
    }

    /// The parts below and above a plane across an axis; one of them has no corners where the plane does not meet the piece.
    pub(super) fn cut(&self, axis: usize, plane: f64) -> [Self; 2] {
        let part = || Self { corners: SmallVec::new(), cuts: self.cuts + 1 };
        let [mut below, mut above] = [part(), part()];
        let Some(mut a) = self.corners.last() else { return [below, above] };
        for b in &self.corners {
            if a[axis] < plane && plane < b[axis] || b[axis] < plane && plane < a[axis] {
                let s = (plane - a[axis]) / (b[axis] - a[axis]);
                let mut corner = [0, 1, 2].map(|axis| a[axis] + (b[axis] - a[axis]) * s);
                corner[axis] = plane;
                below.corners.push(corner);
                above.corners.push(corner);
            }
            if b[axis] <= plane {
                below.corners.push(*b);
            }
            if b[axis] >= plane {
                above.corners.push(*b);
            }
            a = b;
        }
        [below, above]
    }

    pub(super) fn is_empty(&self) -> bool {
        self.corners.is_empty()
    }
}
