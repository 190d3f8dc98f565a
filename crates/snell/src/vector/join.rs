//! Lines joined for a pen: what meets end to end becomes one line, nothing is drawn twice, and the order keeps the pen's way short.

use std::collections::BTreeMap;
use std::f64::consts::TAU;

use super::{Arc, Piece, Subpath};

/// Joins subpaths whose ends are nearer than `tolerance`; at a junction the straightest continuation goes on. Pieces without length
/// and pieces that are there already, also reversed, are left out; straight pieces in one line become one, and so do arcs of one
/// ellipse. The result is ordered so that each begins near the end of the one before. All in one unit.
///
/// ```
/// use snell::vector::{Piece, Subpath, join};
/// let lines = [[[1.0, 0.0], [2.0, 0.0]], [[1.0, 0.0], [0.0, 0.0]], [[2.0, 0.0], [2.0, 1.0]], [[2.0, 1.0], [2.0, 0.0]]];
/// let joined = join(lines.iter().map(|line| Subpath::polyline(line)).collect(), 1e-6);
/// assert_eq!(joined, [Subpath::polyline(&[[0.0, 0.0], [2.0, 0.0], [2.0, 1.0]])]);
/// ```
pub fn join(subpaths: Vec<Subpath>, tolerance: f64) -> Vec<Subpath> {
    let mut closed = Vec::new();
    let mut open = Vec::new();
    for subpath in subpaths {
        if subpath.pieces.is_empty() {
            continue;
        }
        if subpath.closed { closed.push(subpath) } else { open.push(subpath) }
    }
    let mut joined = chains(&without_doubles(open, tolerance), tolerance);
    joined.iter_mut().for_each(|chain| merge(chain, tolerance));
    joined.extend(closed);
    ordered(joined)
}

/// A node's number and its place.
type Node = (usize, [f64; 2]);

/// Places as numbers: those nearer than the tolerance are one.
struct Nodes {
    tolerance: f64,
    cells: BTreeMap<(i64, i64), Vec<Node>>,
    count: usize,
}

impl Nodes {
    fn new(tolerance: f64) -> Self {
        Self { tolerance: tolerance.max(1e-12), cells: BTreeMap::new(), count: 0 }
    }

    fn at(&mut self, p: [f64; 2]) -> usize {
        let cell = p.map(|c| (c / self.tolerance).floor() as i64);
        for dx in -1..=1 {
            for dy in -1..=1 {
                let near = self.cells.get(&(cell[0].saturating_add(dx), cell[1].saturating_add(dy)));
                let same = near.into_iter().flatten().find(|(_, q)| distance(p, *q) <= self.tolerance);
                if let Some((node, _)) = same {
                    return *node;
                }
            }
        }
        self.cells.entry((cell[0], cell[1])).or_default().push((self.count, p));
        self.count += 1;
        self.count - 1
    }
}

/// A subpath between two nodes.
struct Edge {
    path: Subpath,
    nodes: [usize; 2],
}

fn without_doubles(subpaths: Vec<Subpath>, tolerance: f64) -> Vec<Subpath> {
    let mut nodes = Nodes::new(tolerance);
    let mut known: BTreeMap<[usize; 3], Vec<usize>> = BTreeMap::new();
    let mut kept: Vec<Subpath> = Vec::new();
    for subpath in subpaths {
        if length(&subpath) <= tolerance {
            continue;
        }
        let (a, b) = (nodes.at(subpath.start), nodes.at(subpath.end()));
        // The same ends and the same middle: the same line.
        let middle = nodes.at(middle(&subpath));
        let key = [a.min(b), a.max(b), middle];
        let same = known.entry(key).or_default();
        if same.iter().any(|&index| kept[index].pieces.len() == subpath.pieces.len()) {
            continue;
        }
        same.push(kept.len());
        kept.push(subpath);
    }
    kept
}

fn chains(subpaths: &[Subpath], tolerance: f64) -> Vec<Subpath> {
    let mut nodes = Nodes::new(tolerance);
    let edges: Vec<Edge> = subpaths
        .iter()
        .map(|path| Edge { nodes: [nodes.at(path.start), nodes.at(path.end())], path: path.clone() })
        .collect();
    let mut at_node: Vec<Vec<usize>> = vec![Vec::new(); nodes.count];
    for (index, edge) in edges.iter().enumerate() {
        at_node[edge.nodes[0]].push(index);
        if edge.nodes[1] != edge.nodes[0] {
            at_node[edge.nodes[1]].push(index);
        }
    }
    let mut used = vec![false; edges.len()];
    let mut result = Vec::new();
    // Lines that end somewhere are begun at such an end, so that they are not begun in their middle.
    let ends_somewhere = |edge: &Edge| edge.nodes.iter().any(|&node| at_node[node].len() == 1);
    let first = edges.iter().enumerate().filter(|(_, edge)| ends_somewhere(edge)).map(|(index, _)| index);
    for index in first.chain(0..edges.len()).collect::<Vec<_>>() {
        if std::mem::replace(&mut used[index], true) {
            continue;
        }
        let edge = &edges[index];
        let backwards = at_node[edge.nodes[1]].len() == 1 && at_node[edge.nodes[0]].len() > 1;
        let mut chain = if backwards { edge.path.reversed() } else { edge.path.clone() };
        let [mut start, mut end] = if backwards { [edge.nodes[1], edge.nodes[0]] } else { edge.nodes };
        while let Some((next, path, node)) = straightest(&chain, end, &edges, &at_node, &used) {
            used[next] = true;
            chain.pieces.extend(path.pieces);
            end = node;
        }
        // And from its beginning on.
        let mut turned = chain.reversed();
        while let Some((next, path, node)) = straightest(&turned, start, &edges, &at_node, &used) {
            used[next] = true;
            turned.pieces.extend(path.pieces);
            start = node;
        }
        chain = turned.reversed();
        chain.closed = start == end && chain.pieces.len() > 1;
        result.push(chain);
    }
    result
}

/// The unused edge at the end of a chain that turns least, directed away from there, with the node where it ends.
fn straightest(
    chain: &Subpath,
    node: usize,
    edges: &[Edge],
    at_node: &[Vec<usize>],
    used: &[bool],
) -> Option<(usize, Subpath, usize)> {
    let along = end_direction(chain);
    let candidates = at_node[node].iter().filter(|index| !used[**index]).map(|&index| {
        let edge = &edges[index];
        let forward = edge.nodes[0] == node;
        let path = if forward { edge.path.clone() } else { edge.path.reversed() };
        let away = start_direction(&path);
        (along[0] * away[0] + along[1] * away[1], index, path, edge.nodes[usize::from(forward)])
    });
    let best = candidates.max_by(|a, b| a.0.total_cmp(&b.0).then(b.1.cmp(&a.1)));
    best.map(|(_, index, path, node)| (index, path, node))
}

/// Makes one of straight pieces in one line, and of arcs of one ellipse.
fn merge(chain: &mut Subpath, tolerance: f64) {
    let mut merged: Vec<Piece> = Vec::with_capacity(chain.pieces.len());
    let mut starts = vec![chain.start];
    for piece in chain.pieces.drain(..) {
        let together = match (merged.last(), starts.len().checked_sub(2).map(|index| starts[index])) {
            (Some(last), Some(start)) => united(start, last, &piece, tolerance),
            _ => None,
        };
        match together {
            Some(one) => {
                merged.pop();
                starts.pop();
                starts.push(one.end());
                merged.push(one);
            }
            None => {
                starts.push(piece.end());
                merged.push(piece);
            }
        }
    }
    chain.pieces = merged;
    if let [Piece::Arc(arc)] = chain.pieces.as_mut_slice()
        && (arc.end - arc.start).abs() > TAU - 1e-6
    {
        arc.end = arc.start + TAU.copysign(arc.end - arc.start);
        chain.closed = true;
    }
}

/// Two pieces as one, where they are.
fn united(start: [f64; 2], first: &Piece, second: &Piece, tolerance: f64) -> Option<Piece> {
    match (first, second) {
        (Piece::Line { to: middle }, Piece::Line { to: end }) => {
            let (dx, dy) = (end[0] - start[0], end[1] - start[1]);
            let (mx, my) = (middle[0] - start[0], middle[1] - start[1]);
            let long = (dx * dx + dy * dy).sqrt();
            // Onwards, and not beside the line by more than a small part of what is one.
            let onwards = mx * dx + my * dy > 0.0 && mx * mx + my * my < long * long;
            (onwards && (mx * dy - my * dx).abs() < 0.05 * tolerance * long).then_some(Piece::Line { to: *end })
        }
        (Piece::Arc(a), Piece::Arc(b)) => {
            let near = |x: f64, y: f64| (x - y).abs() <= 1e-6 * a.radii[0].max(1e-9);
            let same = near(a.center[0], b.center[0])
                && near(a.center[1], b.center[1])
                && near(a.radii[0], b.radii[0])
                && near(a.radii[1], b.radii[1])
                && (a.rotation - b.rotation).abs() < 1e-9;
            let (sa, sb) = (a.end - a.start, b.end - b.start);
            let whole = (sa + sb).abs() <= TAU + 1e-6;
            (same && sa * sb > 0.0 && whole).then_some(Piece::Arc(Arc { end: a.end + sb, ..*a }))
        }
        _ => None,
    }
}

/// Each next one begins near the end of the one before: of all that are left the nearest, found in a grid of their ends.
fn ordered(paths: Vec<Subpath>) -> Vec<Subpath> {
    if paths.len() < 3 {
        return paths;
    }
    let ends: Vec<[[f64; 2]; 2]> = paths.iter().map(|path| [path.start, path.end()]).collect();
    let mut low = [f64::INFINITY; 2];
    let mut high = [f64::NEG_INFINITY; 2];
    for p in ends.iter().flatten() {
        for k in 0..2 {
            (low[k], high[k]) = (low[k].min(p[k]), high[k].max(p[k]));
        }
    }
    let side = ((paths.len() as f64).sqrt().ceil() as usize).clamp(1, 1024);
    let size = (high[0] - low[0]).max(high[1] - low[1]).max(1e-9) / side as f64;
    let cell = |p: [f64; 2]| [0, 1].map(|k| (((p[k] - low[k]) / size) as usize).min(side - 1));
    let mut grid: Vec<Vec<(usize, usize)>> = vec![Vec::new(); side * side];
    for (index, ends) in ends.iter().enumerate() {
        for (which, p) in ends.iter().enumerate() {
            let [x, y] = cell(*p);
            grid[y * side + x].push((index, which));
        }
    }
    let mut left: Vec<Option<Subpath>> = paths.into_iter().map(Some).collect();
    let mut result = Vec::with_capacity(left.len());
    let mut at = low;
    let mut from = 0;
    while result.len() < left.len() {
        let [x, y] = cell(at);
        let mut best: Option<(f64, usize, usize)> = None;
        // A few rings of cells around; beyond them the next one in order is as good.
        for ring in 0..4_usize {
            for cy in y.saturating_sub(ring)..=(y + ring).min(side - 1) {
                for cx in x.saturating_sub(ring)..=(x + ring).min(side - 1) {
                    if cx.abs_diff(x).max(cy.abs_diff(y)) != ring {
                        continue;
                    }
                    let members = &mut grid[cy * side + cx];
                    members.retain(|(index, _)| left[*index].is_some());
                    for &(index, which) in members.iter() {
                        let candidate = (distance(at, ends[index][which]), index, which);
                        if best.is_none_or(|best| candidate < best) {
                            best = Some(candidate);
                        }
                    }
                }
            }
            if best.is_some_and(|(d, ..)| d <= ring as f64 * size) {
                break;
            }
        }
        let (index, which) = match best {
            Some((_, index, which)) => (index, which),
            None => {
                while left[from].is_none() {
                    from += 1;
                }
                (from, 0)
            }
        };
        let Some(path) = left[index].take() else { continue };
        let path = if which == 1 && !path.closed { path.reversed() } else { path };
        at = path.end();
        result.push(path);
    }
    result
}

fn distance(a: [f64; 2], b: [f64; 2]) -> f64 {
    let (x, y) = (a[0] - b[0], a[1] - b[1]);
    (x * x + y * y).sqrt()
}

/// The length of a subpath, or a little less.
fn length(path: &Subpath) -> f64 {
    let mut at = path.start;
    let mut sum = 0.0;
    for piece in &path.pieces {
        if let Piece::Arc(arc) = piece {
            sum += (arc.end - arc.start).abs() * arc.radii[0].min(arc.radii[1]);
        }
        sum += distance(at, piece.end());
        at = piece.end();
    }
    sum
}

/// A point in the middle of a subpath, the same from either end.
fn middle(path: &Subpath) -> [f64; 2] {
    let count = path.pieces.len();
    let start_of = |index: usize| if index == 0 { path.start } else { path.pieces[index - 1].end() };
    if count.is_multiple_of(2) {
        return start_of(count / 2);
    }
    let (start, piece) = (start_of(count / 2), &path.pieces[count / 2]);
    let end = piece.end();
    match piece {
        Piece::Line { .. } => [0.5 * (start[0] + end[0]), 0.5 * (start[1] + end[1])],
        Piece::Arc(arc) => arc.point(0.5 * (arc.start + arc.end)),
        Piece::Cubic { first, second, .. } => {
            [0, 1].map(|k| 0.125 * (start[k] + end[k]) + 0.375 * (first[k] + second[k]))
        }
    }
}

fn end_direction(path: &Subpath) -> [f64; 2] {
    // Of the last piece alone: chains may be long, and are asked at each of their pieces.
    let Some((last, before)) = path.pieces.split_last() else { return [0.0; 2] };
    let start = before.last().map_or(path.start, Piece::end);
    let turned = Subpath { start, pieces: vec![*last], closed: false }.reversed();
    let [x, y] = start_direction(&turned);
    [-x, -y]
}

/// The unit vector along which a subpath begins.
fn start_direction(path: &Subpath) -> [f64; 2] {
    let Some(piece) = path.pieces.first() else { return [0.0; 2] };
    let towards = match piece {
        Piece::Line { to } => *to,
        Piece::Arc(arc) => arc.point(arc.start + (arc.end - arc.start).clamp(-1e-3, 1e-3)),
        Piece::Cubic { first, second, to } => {
            let far = |p: &[f64; 2]| distance(*p, path.start) > 1e-12;
            [first, second].into_iter().copied().find(far).unwrap_or(*to)
        }
    };
    let long = distance(path.start, towards);
    if long > 0.0 { [0, 1].map(|k| (towards[k] - path.start[k]) / long) } else { [0.0; 2] }
}
