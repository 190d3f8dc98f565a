//! The hierarchy on nasty inputs, and its validator against planted defects. Rays: see [`crate::accel::wide`].

use snell_math::{Point3, Vector3};

use super::*;
use crate::accel::random::Random;

pub(in crate::accel) fn cube(center: Point3, half: f64) -> Bounds3 {
    Bounds3::new(center, center).grown(half)
}

impl Bvh {
    /// With other numbers for its primitives: equal ones make a tree whose leaves share primitives.
    pub(crate) fn renumbered(mut self, number: impl Fn(u32) -> u32) -> Self {
        for primitive in &mut self.primitives {
            *primitive = number(*primitive);
        }
        self
    }
}

/// Triangles are not cut in pieces.
fn whole(block: usize) -> BuildOptions {
    BuildOptions { block, presplit: false, ..BuildOptions::default() }
}

/// Inputs that hierarchies have fallen over.
pub(in crate::accel) fn nasty_inputs() -> Vec<(&'static str, Vec<Bounds3>)> {
    let mut random = Random(1);
    let at = |x: f64, y: f64, z: f64| cube(Point3::new(x, y, z), 0.0);
    let unit = cube(Point3::ORIGIN, 1.0);
    vec![
        ("none", vec![]),
        ("one", vec![unit]),
        ("one point", vec![at(1.0, 2.0, 3.0)]),
        ("only empty", vec![Bounds3::EMPTY; 9]),
        ("some empty", (0..50).map(|i| if i % 3 == 0 { Bounds3::EMPTY } else { at(i as f64, 0.0, 0.0) }).collect()),
        ("inside out", vec![unit, Bounds3::new(Point3::new(1.0, 0.0, 0.0), Point3::new(-1.0, 1.0, 1.0)), unit]),
        ("identical", vec![unit; 10_000]),
        ("identical points", vec![at(0.1, 0.1, 0.1); 1000]),
        ("collinear", (0..5000).map(|i| at(i as f64, 0.0, 0.0)).collect()),
        ("diagonal", (0..5000).map(|i| at(i as f64, i as f64, -(i as f64))).collect()),
        ("coplanar", (0..5000).map(|_| at(random.number(), 0.0, random.number())).collect()),
        (
            "geometric",
            (0..1000).map(|i| cube(Point3::new(0.7_f64.sqrt().max(0.5) * halvings(i), 0.0, 0.0), 0.0)).collect(),
        ),
        ("nested", (0..1000).map(|i| cube(Point3::ORIGIN, halvings(i))).collect()),
        ("around one", (0..300).map(|i| cube(Point3::ORIGIN, i as f64)).collect()),
        ("huge", (0..100).map(|_| cube(Point3::ORIGIN + random.vector() * 1e308, 1e300)).collect()),
        ("beyond f32", (0..100).map(|i| cube(Point3::new(i as f64, 0.0, 0.0), 1e39)).collect()),
        ("tiny", (0..100).map(|_| cube(Point3::ORIGIN + random.vector() * 1e-310, 0.0)).collect()),
        ("all scales", (0..2000).map(|i| cube(random.point(), halvings(i % 200))).collect()),
        ("random", (0..20_000).map(|_| cube(random.point(), 0.01 * random.number().abs())).collect()),
    ]
}

/// 2^−i, without underflow to zero before i = 1074.
pub(in crate::accel) fn halvings(i: usize) -> f64 {
    (0..i).fold(1.0, |x, _| 0.5 * x)
}

#[test]
fn nasty_inputs_give_valid_trees() {
    for (name, bounds) in nasty_inputs() {
        let bvh = Bvh::build(&bounds).expect(name);
        assert_eq!(bvh.validate(&bounds), Ok(()), "{name}");
        let statistics = bvh.statistics();
        let present = bounds.iter().filter(|b| !b.is_empty()).count();
        assert_eq!(statistics.primitives, present, "{name}");
        assert_eq!(bvh.is_empty(), present == 0, "{name}");
        assert_eq!(statistics.nodes, (2 * statistics.leaves).saturating_sub(1), "{name}");
        assert!(statistics.depth <= MAX_DEPTH && statistics.sah_cost.is_finite(), "{name}: {statistics:?}");
    }
}

#[test]
fn unusable_boxes_are_refused() {
    let good = cube(Point3::ORIGIN, 1.0);
    let nan = Bounds3::new(Point3::new(0.0, f64::NAN, 0.0), good.max);
    let plane = Bounds3::new(Point3::new(f64::NEG_INFINITY, 0.0, f64::NEG_INFINITY), Point3::new(1.0, 0.0, 1.0));
    assert_eq!(Bvh::build(&[good, nan, nan]), Err(BuildError::NotANumber(1)));
    assert_eq!(Bvh::build(&[good, good, plane, nan]), Err(BuildError::Unbounded(2)));
    assert_eq!(Bvh::build(&[Bounds3::EVERYTHING]), Err(BuildError::Unbounded(0)));
}

#[test]
fn the_same_tree_from_any_number_of_threads() {
    let mut random = Random(2);
    // Enough for every parallel path; quantised, so that there are ties in abundance.
    let quantised = |v: Vector3| Point3::from(v.to_array().map(|x| (x * 40.0).round()));
    let bounds: Vec<Bounds3> = (0..100_000).map(|_| cube(quantised(random.vector()), 1.0)).collect();
    let build = |threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("threads");
        pool.install(|| Bvh::build(&bounds)).expect("finite boxes")
    };
    let one = build(1);
    assert_eq!(one.validate(&bounds), Ok(()));
    assert!(one == build(2) && one == build(7));
}

/// Triangles of which many are alike, quantised, so that there are ties in abundance.
fn quantised_triangles(count: usize, random: &mut Random) -> Vec<[[f32; 3]; 3]> {
    let mut corner = |around: Vector3| (around * 40.0 + random.vector() * 3.0).to_array().map(|x| x.round() as f32);
    (0..count)
        .map(|i| Vector3::new(0.001 * (i % 997) as f64, i as f64 / count as f64, 0.2))
        .map(|around| [0, 1, 2].map(|_| corner(around)))
        .collect()
}

fn boxes_of(triangles: &[[[f32; 3]; 3]]) -> Vec<Bounds3> {
    let around = |[a, b, c]: &[[f32; 3]; 3]| {
        if a == b || b == c || c == a {
            return Bounds3::EMPTY;
        }
        [a, b, c].iter().fold(Bounds3::EMPTY, |bounds, p| bounds.including(Point3::from(p.map(f64::from))))
    };
    triangles.iter().map(around).collect()
}

#[test]
fn triangles_give_the_same_tree_from_any_number_of_threads() {
    let triangles = quantised_triangles(100_000, &mut Random(12));
    let build = |threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("threads");
        pool.install(|| Bvh::over_triangles(triangles.len(), |i| triangles[i as usize], whole(8)))
            .expect("not too many")
    };
    let one = build(1);
    assert_eq!(one.validate(&boxes_of(&triangles)), Ok(()));
    assert!(one == build(2) && one == build(7));
    assert_eq!(one.bounds(), boxes_of(&triangles).iter().fold(Bounds3::EMPTY, |all, b| all.union(b)));
}

#[test]
fn blocks_are_filled() {
    let triangles = quantised_triangles(20_000, &mut Random(13));
    let build =
        |block| Bvh::over_triangles(triangles.len(), |i| triangles[i as usize], whole(block)).expect("not too many");
    let [one, four, eight, most] = [1, 4, 8, 100].map(|block| build(block).statistics());
    assert_eq!(eight, most);
    assert!(
        2 * eight.leaves < one.leaves && eight.leaves < four.leaves,
        "{} {} {}",
        one.leaves,
        four.leaves,
        eight.leaves
    );
    assert!(eight.sah_cost < four.sah_cost && four.sah_cost < one.sah_cost, "{one:?} {four:?} {eight:?}");
    assert!(eight.primitives as f64 > 5.0 * eight.leaves as f64, "{eight:?}");
}

#[test]
fn triangles_that_cannot_be_met_are_left_out() {
    let good = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, -0.0]];
    let with = |corner: [f32; 3]| [good[0], good[1], corner];
    let triangles = [with([f32::NAN; 3]), good, with(good[1]), with([0.0, f32::INFINITY, 0.0]), with([3.0, 4.0, -5.0])];
    let bvh = Bvh::over_triangles(5, |i| triangles[i as usize], whole(8)).expect("not too many");
    assert_eq!(bvh.primitives, [1, 4]);
    assert_eq!(bvh.bounds(), Bounds3::new(Point3::new(0.0, 0.0, -5.0), Point3::new(3.0, 4.0, 0.0)));
    let none = Bvh::over_triangles(0, |_| good, BuildOptions::default()).expect("not too many");
    assert!(none.is_empty());
}

/// Every defect that the validator knows, planted into a good tree.
#[test]
fn planted_defects_are_caught() {
    let mut random = Random(3);
    let bounds: Vec<Bounds3> = (0..200).map(|_| cube(random.point(), 0.05)).collect();
    let good = Bvh::build(&bounds).expect("finite boxes");
    let leaf = good.nodes.iter().position(Node::is_leaf).expect("a leaf");
    let sabotage = |plant: &dyn Fn(&mut Bvh)| {
        let mut bad = good.clone();
        plant(&mut bad);
        bad.validate(&bounds).expect_err("the defect is caught")
    };
    let swapped = sabotage(&|bvh| {
        let second = bvh.nodes[0].link as usize;
        let box_of_first = bvh.nodes[1].bounds;
        bvh.nodes[1].bounds = bvh.nodes[second].bounds;
        bvh.nodes[second].bounds = box_of_first;
    });
    assert!(matches!(swapped, Defect::OutsideParent(_) | Defect::OutsideLeaf { .. }), "{swapped}");
    let shrunk = sabotage(&|bvh| {
        let high = &mut bvh.nodes[leaf].bounds.corners[1][2];
        *high = high.next_down().next_down();
    });
    assert!(matches!(shrunk, Defect::OutsideLeaf { .. }), "{shrunk}");
    let inner_shrunk = sabotage(&|bvh| bvh.nodes[0].bounds.corners[0][1] = -0.9);
    assert!(matches!(inner_shrunk, Defect::OutsideParent(_)), "{inner_shrunk}");
    let multiple = good.nodes.iter().position(|node| node.count > 1).expect("a leaf of several");
    let repeated = sabotage(&|bvh| {
        let first = bvh.nodes[multiple].range().start;
        bvh.primitives[first + 1] = bvh.primitives[first];
    });
    assert!(matches!(repeated, Defect::Unexpected(_)), "{repeated}");
    let unknown = sabotage(&|bvh| bvh.primitives[7] = 200);
    assert_eq!(unknown, Defect::Unexpected(200));
    let dropped = sabotage(&|bvh| bvh.nodes[multiple].count -= 1);
    assert!(matches!(dropped, Defect::Missing(_)), "{dropped}");
    let overfull = sabotage(&|bvh| bvh.nodes[leaf].count = 9);
    assert_eq!(overfull, Defect::LeafSize(leaf));
    let beyond = sabotage(&|bvh| bvh.nodes[leaf].link = 200);
    assert_eq!(beyond, Defect::LeafSize(leaf));
    for link in [0, 1, 2, u32::MAX] {
        let misdirected = sabotage(&|bvh| bvh.nodes[0].link = link);
        assert!(matches!(misdirected, Defect::OutOfOrder(_)), "{misdirected}");
    }
    let truncated = sabotage(&|bvh| bvh.nodes.truncate(bvh.nodes.len() - 1));
    assert!(matches!(truncated, Defect::OutOfOrder(_)), "{truncated}");
    let unreachable = sabotage(&|bvh| bvh.nodes.push(bvh.nodes[leaf]));
    assert!(matches!(unreachable, Defect::Unreachable { .. }), "{unreachable}");
    let extent = sabotage(&|bvh| bvh.extent *= 0.5);
    assert_eq!(extent, Defect::Extent);
    let emptied = sabotage(&|bvh| bvh.nodes.clear());
    assert_eq!(emptied, Defect::Missing(0));
    assert!(good.validate(&bounds[1..]).is_err());
}

#[test]
fn a_tree_that_is_too_deep_is_caught() {
    // A comb: every inner node has a leaf and the rest.
    let depth = MAX_DEPTH + 1;
    let bounds = vec![cube(Point3::ORIGIN, 1.0); depth + 1];
    let node = |link, count| Node { bounds: Box32::enclosing(&bounds[0]), link, count };
    let mut nodes: Vec<Node> = (0..depth as u32).flat_map(|i| [node(2, 0), node(i, 1)]).collect();
    nodes.push(node(depth as u32, 1));
    let bvh = Bvh { nodes, primitives: (0..=depth as u32).collect(), extent: 1.0, block: 1, ..Bvh::default() };
    assert!(matches!(bvh.validate(&bounds), Err(Defect::TooDeep(_))));
}

#[test]
fn a_greedy_input_stays_within_the_depth() {
    // Every box 17 times smaller and nearer than the one before, so that the bins hold but one box and the rest, and the
    // heuristic cuts off one box a level; then many copies of the last, which take ten levels more than the stack has.
    let mut bounds = Vec::new();
    let mut x = 1e38;
    for _ in 0..60 {
        bounds.push(cube(Point3::new(x, 0.0, 0.0), 0.1 * x));
        x /= 17.0;
    }
    bounds.extend(vec![cube(Point3::new(x, 0.0, 0.0), 0.1 * x); 4000]);
    let bvh = Bvh::build(&bounds).expect("finite boxes");
    assert_eq!(bvh.validate(&bounds), Ok(()));
    let depth = bvh.statistics().depth;
    assert!((50..=MAX_DEPTH).contains(&depth), "{depth}");
}
