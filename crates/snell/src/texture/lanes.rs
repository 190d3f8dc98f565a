//! Textures side by side: what floors and balls most often have, evaluated for eight points at once.
//!
//! Every operation is that of [`Textures::evaluate`], in the same order, so that the colours are the same to the bit.

use snell_math::Rgb;
use snell_math::lanes::{Bits, LaneColor, LaneVector, Lanes};
use snell_scene::Id;
use snell_scene::scene::{Space, Texture};

use super::compile::{Node, Textures};
use super::coordinates::RELATIVE_INSET;
use super::placement::Placement;

/// Points of surfaces whose objects stand in the world as they are, as textures see them; see [`super::TextureCoordinates`].
#[derive(Clone, Copy, Debug)]
pub struct LaneCoordinates<L> {
    /// The points, in the world and in the spaces of their objects, which are the same.
    pub point: LaneVector<L>,
    /// Short displacements into the solids.
    pub inside: LaneVector<L>,
}

/// A checker of two constant colours, in the space of the object or of the world.
#[derive(Clone, Copy, Debug)]
pub struct PlainChecker<'a> {
    placement: &'a Placement,
    colors: [Rgb; 2],
}

impl Textures {
    /// A texture that can be evaluated side by side; `None` for all that cannot, or need not since they are constant.
    ///
    /// # Panics
    /// Where the id is not one of the table that was compiled.
    #[inline]
    #[must_use]
    pub fn plain_checker(&self, id: Id<Texture>) -> Option<PlainChecker<'_>> {
        let Node::Checker { placement, cells } = self.nodes[id.index()] else { return None };
        let placement = &self.placements[placement as usize];
        match cells.map(|cell| self.nodes[cell as usize]) {
            [Node::Constant(even), Node::Constant(odd)] if placement.space() != Space::Uv => {
                Some(PlainChecker { placement, colors: [even, odd] })
            }
            _ => None,
        }
    }
}

impl PlainChecker<'_> {
    /// The colours at some points, as [`Textures::evaluate`].
    #[inline(always)]
    pub fn evaluate<L: Lanes>(&self, at: &LaneCoordinates<L>) -> LaneColor<L::Floats> {
        let point = self.placement.locate_lanes(at);
        let odd = is_odd(point.x).0 ^ is_odd(point.y).0 ^ is_odd(point.z).0;
        LaneColor::splat(self.colors[1]).or_where_not(Bits(odd), LaneColor::splat(self.colors[0]))
    }
}

/// Where the number rounded down is odd. Of finite numbers.
#[inline(always)]
fn is_odd<L: Lanes>(number: L) -> Bits {
    let two = L::splat(2.0);
    // Halving and doubling are exact; beyond 2⁵³ every number is even, and so is this one.
    let even = (number * L::splat(0.5)).floor() * two;
    L::all().without(number.floor().same(even))
}

impl Placement {
    /// The points to evaluate a pattern at, as [`Placement::locate`].
    #[inline(always)]
    fn locate_lanes<L: Lanes>(&self, at: &LaneCoordinates<L>) -> LaneVector<L> {
        let LaneCoordinates { point, inside } = *at;
        let (placed, inside) = if self.is_identity {
            (point, inside)
        } else {
            (LaneVector::splat(self.origin.to_array()) + self.linear_lanes(point), self.linear_lanes(inside))
        };
        let length = inside.max_abs();
        let rounding =
            L::splat(RELATIVE_INSET) * (L::splat(self.growth) * point.max_abs() + L::splat(self.origin.max_abs()));
        let inset = placed + inside * L::splat(1.0).larger(rounding / length);
        let says_something = length.gt(L::splat(0.0)) & length.lt(L::splat(f64::INFINITY));
        let placed = inset.or_where_not(says_something, placed);
        let finite = |number: L| number.abs().lt(L::splat(f64::INFINITY));
        let is_finite = finite(placed.x) & finite(placed.y) & finite(placed.z);
        placed.or_where_not(is_finite, LaneVector::splat([0.0; 3]))
    }

    #[inline(always)]
    fn linear_lanes<L: Lanes>(&self, v: LaneVector<L>) -> LaneVector<L> {
        let [x, y, z] = self.columns.map(|column| LaneVector::splat(column.to_array()));
        x * v.x + y * v.y + z * v.z
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;
    use snell_math::lanes::{InstructionSet, WIDTH, Work, dispatch};
    use snell_math::{Normal3, Point3, Transform, Vector3};
    use snell_scene::Table;
    use snell_scene::scene::{Mapping, Pattern};

    use super::*;
    use crate::texture::TextureCoordinates;

    struct Colors<'a>(PlainChecker<'a>, &'a [[f64; WIDTH]; 3], &'a [[f64; WIDTH]; 3]);

    impl Work for Colors<'_> {
        type Output = [f32; WIDTH];
        #[inline(always)]
        fn run<L: Lanes>(self) -> [f32; WIDTH] {
            let mut colors = [[0.0; WIDTH]; 3];
            for at in (0..WIDTH).step_by(L::COUNT) {
                let (point, inside) = (LaneVector::<L>::load(self.1, at), LaneVector::load(self.2, at));
                self.0.evaluate(&LaneCoordinates { point, inside }).store(&mut colors, at);
            }
            colors[0]
        }
    }

    fn number() -> impl Strategy<Value = f64> {
        let nasty = vec![0.0, -0.0, -5e-324, 1.0, 9_007_199_254_740_991.0, 1e300, f64::INFINITY, f64::NAN];
        prop_oneof![-1e3..1e3f64, (-20..20).prop_map(f64::from), -1e17..1e17f64, prop::sample::select(nasty)]
    }

    fn board(mapping: Mapping) -> (Textures, Id<Texture>) {
        let mut table = Table::default();
        let cells = [Rgb::BLACK, Rgb::WHITE].map(|color| table.push(Texture::constant(color)));
        let board = table.push(Texture { pattern: Pattern::Checker(cells), mapping });
        (Textures::compile(&table, &[]).expect("a good texture"), board)
    }

    proptest! {
        #![proptest_config(ProptestConfig { failure_persistence: None, cases: 2048, ..ProptestConfig::default() })]
        #[test]
        fn colors_side_by_side_are_those_of_one_point(
            numbers in prop::collection::vec(number(), 3 * WIDTH),
            depth in prop_oneof![Just(0.0), 1e-18..1e-3f64, Just(f64::INFINITY)],
            scale in prop_oneof![Just(1.0), 0.01..100.0f64],
            shift in prop_oneof![Just(0.0), -1e3..1e3f64],
        ) {
            let map = Transform::translate(Vector3::new(shift, 0.0, -shift)) * Transform::scale(Vector3::new(scale, 1.0, scale));
            for space in [Space::Object, Space::World] {
                let (textures, board) = board(Mapping { space, texture_from_space: map });
                let checker = textures.plain_checker(board).expect("of constant colours");
                let points: [[f64; WIDTH]; 3] = std::array::from_fn(|axis| std::array::from_fn(|i| numbers[3 * i + axis]));
                let mut insides = [[0.0; WIDTH]; 3];
                let mut expected = [0.0; WIDTH];
                let normal = Normal3::new(0.0, 1.0, 0.0);
                for lane in 0..WIDTH {
                    let point = Point3::new(points[0][lane], points[1][lane], points[2][lane]);
                    let at = TextureCoordinates::new(point, normal, depth, [0.0; 2], &Transform::IDENTITY);
                    (0..3).for_each(|axis| insides[axis][lane] = at.world_inside[axis]);
                    let at = TextureCoordinates { object_inside: at.world_inside, object_point: point, ..at };
                    expected[lane] = textures.evaluate(board, &at).r;
                }
                for set in InstructionSet::available() {
                    prop_assert_eq!(dispatch(set, Colors(checker, &points, &insides)), expected, "{:?}", set);
                }
            }
        }
    }

    #[test]
    fn what_is_not_plain_is_left_to_others() {
        let (textures, on_surface) = board(Mapping { space: Space::Uv, texture_from_space: Transform::IDENTITY });
        assert!(textures.plain_checker(on_surface).is_none());
        let mut table = Table::default();
        let [black, white] = [Rgb::BLACK, Rgb::WHITE].map(|color| table.push(Texture::constant(color)));
        let inner = table.push(Texture { pattern: Pattern::Checker([black, white]), ..Texture::constant(Rgb::BLACK) });
        let outer = table.push(Texture { pattern: Pattern::Checker([inner, white]), ..Texture::constant(Rgb::BLACK) });
        let textures = Textures::compile(&table, &[]).expect("good textures");
        assert!(textures.plain_checker(inner).is_some());
        assert!(textures.plain_checker(outer).is_none() && textures.plain_checker(black).is_none());
    }
}
