//! The rays of a figure: arrows in the colours of their kinds, numbers, normals and angles.

use snell_math::{Normal3, Point3, Vector3};

use super::Sheet;
use super::labels::{Labels, around, plain};
use crate::compile::CompiledScene;
use crate::drawing::object_bounds;
use crate::explain::words::degrees;
use crate::explain::{End, ExplainedRay, ExplainedSurface, Explanation, Kind};
use crate::vector::{Group, Item, Page, Path, Piece, Stroke, Subpath, arrow_head};

/// Of normals.
pub const NORMAL: [u8; 3] = [70, 70, 70];
/// Half the length of a drawn normal in millimetres.
const NORMAL_REACH: f64 = 9.0;
/// The radii of the arcs of incidence and of refraction, millimetres.
const ARCS: [f64; 2] = [5.0, 6.2];
/// In scenes of at most so many objects those that no ray meets are named too.
const MOST_NAMES: u32 = 12;
/// How far rays without end go, in sizes of what is seen.
const ENDLESS: f64 = 4.0;
/// How far shadow rays go that reach no point of the picture, in sizes of what is seen.
const SHADOW_REACH: f64 = 0.35;

/// A ray that is drawn, with the number that it has in the figure.
#[derive(Clone, Copy, Debug)]
pub struct Chosen {
    /// Its place in the explanation.
    pub ray: usize,
    /// From 1.
    pub number: usize,
}

/// The colour of a kind of ray.
pub fn color(kind: Kind) -> [u8; 3] {
    match kind {
        Kind::Camera => [0, 0, 0],
        Kind::Reflected => [196, 40, 28],
        Kind::Refracted => [24, 84, 184],
        Kind::Scattered => [20, 120, 60],
        Kind::Shadow => [200, 130, 0],
    }
}

/// Those of the first sample's rays that carry most, parents before children, at most `most`.
pub fn choose(told: &Explanation, least: f64, most: usize) -> Vec<Chosen> {
    let weight = |ray: &ExplainedRay| f64::from(ray.throughput.max_abs());
    let is_drawn = |ray: &ExplainedRay| {
        ray.sample == 0 && ray.kind != Kind::Shadow && ray.origin.is_some() && weight(ray) >= least
    };
    let mut rays: Vec<usize> = (0..told.rays.len()).filter(|&ray| is_drawn(&told.rays[ray])).collect();
    // A ray weighs no more than its parent, which comes before it: so the first of these are a tree.
    rays.sort_by(|&a, &b| weight(&told.rays[b]).total_cmp(&weight(&told.rays[a])).then(a.cmp(&b)));
    rays.truncate(most);
    rays.sort_unstable();
    rays.retain({
        let kept = rays.clone();
        move |&ray| told.rays[ray].parent.is_none_or(|parent| kept.contains(&parent))
    });
    // Numbered as the recursion goes: each ray, then all that follows from it.
    let mut ordered = Vec::new();
    let mut open: Vec<usize> = rays.iter().copied().filter(|&ray| told.rays[ray].parent.is_none()).rev().collect();
    while let Some(ray) = open.pop() {
        ordered.push(Chosen { ray, number: ordered.len() + 1 });
        open.extend(rays.iter().copied().filter(|&child| told.rays[child].parent == Some(ray)).rev());
    }
    ordered
}

/// Draws chosen rays over the scene.
pub fn draw(scene: &CompiledScene, told: &Explanation, chosen: &[Chosen], sheet: &Sheet, size: f64, page: &mut Page) {
    let mut surfaces = Group { name: "normals".to_owned(), items: Vec::new() };
    let mut shadows = Group { name: "shadow rays".to_owned(), items: Vec::new() };
    let mut lines: Vec<[[f64; 2]; 2]> = Vec::new();
    let mut groups: Vec<Group> = Vec::new();
    let mut shadow_ends: Vec<(String, [f64; 2], [f64; 2])> = Vec::new();
    for one in chosen {
        let ray = &told.rays[one.ray];
        if let Some(surface) = &ray.surface
            && ray.end != End::NoEffect
        {
            surfaces.items.extend(normal(surface, sheet));
        }
        for asked in told.rays.iter().filter(|other| other.parent == Some(one.ray) && other.kind == Kind::Shadow) {
            let is_shown = told.terms.iter().any(|term| {
                let of_it = term.shadow_ray.is_some_and(|number| std::ptr::eq(&told.rays[number], asked));
                of_it && term.unblocked.is_some_and(|light| !light.is_black())
            });
            // Rays of milky bodies are too many.
            if is_shown && ray.surface.is_some() && asked.depth == ray.depth {
                shadows.items.extend(shadow(asked, sheet, size, &mut lines, &mut shadow_ends));
            }
        }
        if let Some((items, line)) = arrow(ray, sheet, size) {
            lines.push(line);
            groups.push(Group { name: format!("ray {}", one.number), items });
        }
    }
    let faint: Vec<[[f64; 2]; 2]> = page.groups.iter().flat_map(lines_of).collect();
    let mut labels = Labels::new(sheet.place, lines, faint);
    for one in chosen {
        let ray = &told.rays[one.ray];
        if let Some(surface) = &ray.surface
            && let Some(at) = sheet.at(surface.point)
        {
            labels.keep_free(at, 0.8);
        }
    }
    for one in chosen {
        number(one, &told.rays[one.ray], sheet, size, &mut labels);
    }
    let mut angles = Group { name: "angles".to_owned(), items: Vec::new() };
    for one in chosen {
        angles.items.extend(arcs(&told.rays[one.ray], sheet, &mut labels));
    }
    names(scene, told, chosen, sheet, &mut labels);
    for (light, tip, along) in shadow_ends {
        let at = |distance: f64| [tip[0] + along[0] * distance, tip[1] + along[1] * distance];
        let places: Vec<[f64; 2]> = [at(3.5), at(-4.0)].into_iter().chain(around(tip, &[4.0, 6.5])).collect();
        labels.text(&plain(&light), 2.8, color(Kind::Shadow), &places);
    }
    page.groups.extend([surfaces, shadows]);
    page.groups.extend(groups);
    page.groups.push(angles);
    page.groups.push(Group { name: "labels".to_owned(), items: labels.items() });
    page.groups.retain(|group| !group.items.is_empty());
}

/// Straight pieces near the lines of a group.
fn lines_of(group: &Group) -> Vec<[[f64; 2]; 2]> {
    let mut lines = Vec::new();
    for item in &group.items {
        let Item::Path(path) = item else { continue };
        for subpath in &path.subpaths {
            let mut at = subpath.start;
            for piece in &subpath.pieces {
                let ends: Vec<[f64; 2]> = match piece {
                    Piece::Arc(arc) => {
                        let steps = 24;
                        let share = |step: u32| f64::from(step) / f64::from(steps);
                        (1..=steps).map(|step| arc.point(arc.start + (arc.end - arc.start) * share(step))).collect()
                    }
                    Piece::Line { to } | Piece::Cubic { to, .. } => vec![*to],
                };
                for end in ends {
                    lines.push([at, end]);
                    at = end;
                }
            }
        }
    }
    lines
}

/// The ends of a ray in the world.
fn ends(ray: &ExplainedRay, size: f64) -> Option<[Point3; 2]> {
    let (origin, direction) = (ray.origin?, ray.direction?);
    let end = match &ray.surface {
        Some(surface) => surface.point,
        None => origin + direction * ray.distance.filter(|d| d.is_finite()).unwrap_or(ENDLESS * size),
    };
    Some([origin, end])
}

/// A ray as an arrow, and the line that it takes on the page; a dot where it is seen end on.
fn arrow(ray: &ExplainedRay, sheet: &Sheet, size: f64) -> Option<(Vec<Item>, [[f64; 2]; 2])> {
    let [from, to] = ends(ray, size)?;
    let color = color(ray.kind);
    let [a, b] = sheet.line(from, to)?;
    let along = unit([b[0] - a[0], b[1] - a[1]]);
    let Some((along, length)) = along.filter(|(_, length)| *length > 0.6) else {
        let dot = Path { subpaths: vec![Subpath::ellipse(b, [0.9; 2], 0.0)], stroke: None, fill: Some(color) };
        return Some((vec![Item::Path(dot)], [a, b]));
    };
    let stroke = Stroke { color, width: 0.45, dashes: Vec::new() };
    let line = Path { subpaths: vec![Subpath::polyline(&[a, b])], stroke: Some(stroke), fill: None };
    // In the middle, where no other ray begins.
    let share = if length > 9.0 { 0.6 } else { 0.75 };
    let tip = [a[0] + (b[0] - a[0]) * share, a[1] + (b[1] - a[1]) * share];
    let head = arrow_head(tip, along, 2.3_f64.min(0.5 * length), color);
    Some((vec![Item::Path(line), Item::Path(head)], [a, b]))
}

/// A shadow ray: dashed, up to its light or to what blocks it.
fn shadow(
    ray: &ExplainedRay,
    sheet: &Sheet,
    size: f64,
    lines: &mut Vec<[[f64; 2]; 2]>,
    ends: &mut Vec<(String, [f64; 2], [f64; 2])>,
) -> Vec<Item> {
    let (Some(origin), Some(direction)) = (ray.origin, ray.direction) else { return Vec::new() };
    let color = color(Kind::Shadow);
    let reach = ray.distance.filter(|d| d.is_finite()).unwrap_or(f64::INFINITY);
    let through = ray.blockers.iter().map(|blocker| blocker.distance).fold(0.0, f64::max);
    let is_blocked = ray.end == End::Blocked;
    let shown = if is_blocked { reach } else { reach.min(through + SHADOW_REACH * size) };
    let Some([a, b]) = sheet.line(origin, origin + direction * shown) else { return Vec::new() };
    let Some((along, _)) = unit([b[0] - a[0], b[1] - a[1]]) else { return Vec::new() };
    lines.push([a, b]);
    let dashes = if is_blocked { vec![0.7, 0.9] } else { vec![1.8, 0.9] };
    let stroke = Stroke { color, width: 0.35, dashes };
    let line = Path { subpaths: vec![Subpath::polyline(&[a, b])], stroke: Some(stroke), fill: None };
    let mut items = vec![Item::Path(line)];
    if is_blocked {
        // A cross where it ends.
        let arm = 1.1;
        let cross = [[-arm, -arm, arm, arm], [-arm, arm, arm, -arm]]
            .map(|[x0, y0, x1, y1]| Subpath::polyline(&[[b[0] + x0, b[1] + y0], [b[0] + x1, b[1] + y1]]));
        let stroke = Stroke { color, width: 0.45, dashes: Vec::new() };
        items.push(Item::Path(Path { subpaths: cross.to_vec(), stroke: Some(stroke), fill: None }));
    } else {
        items.push(Item::Path(arrow_head(b, along, 2.0, color)));
    }
    let light = ray.light.as_deref().unwrap_or_default();
    let light = if is_blocked { format!("to {light}, blocked") } else { format!("to {light}") };
    if !ends.iter().any(|(name, at, _)| *name == light && (at[0] - b[0]).abs() + (at[1] - b[1]).abs() < 8.0) {
        ends.push((light, b, along));
    }
    items
}

/// The normal on both sides of a surface, and a little of the surface itself.
fn normal(surface: &ExplainedSurface, sheet: &Sheet) -> Vec<Item> {
    let Some(at) = sheet.at(surface.point) else { return Vec::new() };
    let Some(normal) = on_page(sheet, surface.point, surface.shading_normal.as_vector()) else { return Vec::new() };
    let mut items = Vec::new();
    let mut put = |[x, y]: [f64; 2], reach: [f64; 2], width: f64, dashes: Vec<f64>| {
        let ends = reach.map(|reach| [at[0] + x * reach, at[1] + y * reach]);
        if let Some(line) = sheet.place.clip(ends[0], ends[1]) {
            let stroke = Stroke { color: NORMAL, width, dashes };
            let subpaths = vec![Subpath::polyline(&line)];
            items.push(Item::Path(Path { subpaths, stroke: Some(stroke), fill: None }));
        }
    };
    put(normal, [-NORMAL_REACH, NORMAL_REACH], 0.25, vec![1.4, 1.0]);
    let across = [-normal[1], normal[0]];
    put(across, [-3.2, 3.2], 0.5, Vec::new());
    items
}

/// A direction at a point as it is seen on the page, unit length; `None` where it is seen end on.
fn on_page(sheet: &Sheet, point: Point3, direction: Vector3) -> Option<[f64; 2]> {
    let step = sheet.camera.eye().distance(point) * 1e-4 + 1e-9;
    let (a, b) = (sheet.at(point)?, sheet.at(point + direction * step)?);
    let seen = [b[0] - a[0], b[1] - a[1]];
    // Foreshortened to less than a fifth it would mislead.
    let full = {
        let right = sheet.at(point + sheet.camera.axes()[0] * step)?;
        ((right[0] - a[0]) * (right[0] - a[0]) + (right[1] - a[1]) * (right[1] - a[1])).sqrt()
    };
    unit(seen).filter(|(_, length)| *length > 0.2 * full).map(|(along, _)| along)
}

/// The angles of incidence and of refraction, as arcs with their degrees.
fn arcs(ray: &ExplainedRay, sheet: &Sheet, labels: &mut Labels) -> Vec<Item> {
    let (Some(surface), Some(direction)) = (&ray.surface, ray.direction) else { return Vec::new() };
    let Some(boundary) = surface.boundaries.first() else {
        if surface.mirror.is_black() {
            return Vec::new();
        }
        return arc(sheet, surface, -direction, surface.incidence, 0, labels);
    };
    let mut items = arc(sheet, surface, -direction, boundary.incidence, 0, labels);
    if let (Some(angle), [_]) = (boundary.refraction, surface.boundaries.as_slice()) {
        // In the plane of incidence, on the other side.
        let normal = facing(surface.shading_normal, -direction);
        let along = direction + normal * -direction.dot(normal);
        if let Some(along) = along.try_normalize() {
            use snell_math::portable::{cos, sin};
            let refracted = normal * -cos(angle) + along * sin(angle);
            items.extend(arc(sheet, surface, refracted, angle, 1, labels));
        }
    }
    items
}

/// One arc between the normal and a direction that leaves the surface.
fn arc(
    sheet: &Sheet,
    surface: &ExplainedSurface,
    direction: Vector3,
    angle: f64,
    radius: usize,
    labels: &mut Labels,
) -> Vec<Item> {
    use snell_math::portable::{atan2, cos, sin};
    let normal = facing(surface.shading_normal, direction);
    let at = sheet.at(surface.point);
    let (Some(at), Some(from), Some(to)) =
        (at, on_page(sheet, surface.point, normal), on_page(sheet, surface.point, direction))
    else {
        return Vec::new();
    };
    if angle < 0.02 {
        return Vec::new();
    }
    let start = atan2(from[1], from[0]);
    let turn = atan2(from[0] * to[1] - from[1] * to[0], from[0] * to[0] + from[1] * to[1]);
    let radius = ARCS[radius];
    let steps = 12;
    let points: Vec<[f64; 2]> = (0..=steps)
        .map(|step| start + turn * f64::from(step) / f64::from(steps))
        .map(|a| [at[0] + radius * cos(a), at[1] + radius * sin(a)])
        .collect();
    let middle = start + 0.5 * turn;
    let beside = |distance: f64, turned: f64| {
        let a = middle + turned;
        [at[0] + distance * cos(a), at[1] + distance * sin(a)]
    };
    let mut places = Vec::new();
    for distance in [radius + 3.2, radius + 5.5, radius + 8.5] {
        places.extend([0.0, 0.35, -0.35, 0.7, -0.7, 1.1, -1.1].map(|turned| beside(distance, turned)));
    }
    labels.text(&degrees(angle), 2.7, NORMAL, &places);
    let stroke = Stroke { color: NORMAL, width: 0.25, dashes: Vec::new() };
    vec![Item::Path(Path { subpaths: vec![Subpath::polyline(&points)], stroke: Some(stroke), fill: None })]
}

/// A ray's number, beside its line.
fn number(one: &Chosen, ray: &ExplainedRay, sheet: &Sheet, size: f64, labels: &mut Labels) {
    let Some([from, to]) = ends(ray, size) else { return };
    let Some([a, b]) = sheet.line(from, to) else { return };
    let along = unit([b[0] - a[0], b[1] - a[1]]).map_or([1.0, 0.0], |(along, _)| along);
    let across = [-along[1], along[0]];
    let mut places = Vec::new();
    for distance in [2.9, -2.9, 4.4, -4.4] {
        for share in [0.45, 0.35, 0.6, 0.25, 0.75, 0.15] {
            let on = [0, 1].map(|k: usize| a[k] + (b[k] - a[k]) * share + across[k] * distance);
            places.push(on);
        }
    }
    places.extend(around(b, &[3.5, 5.5]));
    labels.badge(one.number, color(ray.kind), &places);
}

/// The names of the objects that rays meet, each once, and of others that are seen as a whole.
fn names(scene: &CompiledScene, told: &Explanation, chosen: &[Chosen], sheet: &Sheet, labels: &mut Labels) {
    let mut objects: Vec<(u32, Option<Point3>)> = Vec::new();
    for surface in chosen.iter().filter_map(|one| told.rays[one.ray].surface.as_ref()) {
        if !objects.iter().any(|(number, _)| *number == surface.object_number) {
            objects.push((surface.object_number, Some(surface.point)));
        }
    }
    let count = scene.object_names.len() as u32;
    if count <= MOST_NAMES {
        for number in 0..count {
            if !objects.iter().any(|(other, _)| *other == number) {
                objects.push((number, None));
            }
        }
    }
    for (number, met) in objects {
        let mut places = Vec::new();
        // Within what is seen as a whole, or else above or below it; or beside the point.
        if let Some(bounds) = object_bounds(scene, number) {
            let corners: Vec<[f64; 2]> = (0..8).filter_map(|corner| sheet.at(bounds.corner(corner))).collect();
            let is_whole = corners.len() == 8 && corners.iter().all(|corner| sheet.place.contains(*corner));
            // What is not seen as a whole is named where it is met, or else where its middle is seen.
            let is_named_within = is_whole || met.is_none();
            let center = sheet.at(bounds.center()).filter(|at| is_named_within && sheet.place.contains(*at));
            if let Some([x, y]) = center {
                let low = corners.iter().map(|corner| corner[1]).fold(f64::NEG_INFINITY, f64::max);
                let high = corners.iter().map(|corner| corner[1]).fold(f64::INFINITY, f64::min);
                let height = low - high;
                places.extend([-0.2, 0.2, 0.0, -0.3, 0.3].map(|share| [x, y + share * height]));
                places.extend([[x, high - 2.5], [x, low + 2.5]]);
            }
        }
        if let Some(at) = met.and_then(|met| sheet.at(met)) {
            places.extend(around(at, &[6.0, 9.0, 13.0, 18.0]));
        }
        let name = scene.object_names.get(number).unwrap_or_default();
        labels.text(&format!("*{}*", plain(&name)), 3.0, [90; 3], &places);
    }
}

/// A normal on the side of a direction.
fn facing(normal: Normal3, direction: Vector3) -> Vector3 {
    let normal = normal.as_vector();
    if normal.dot(direction) < 0.0 { -normal } else { normal }
}

/// A direction on the page and its length.
fn unit([x, y]: [f64; 2]) -> Option<([f64; 2], f64)> {
    let length = (x * x + y * y).sqrt();
    (length > 1e-12).then(|| ([x / length, y / length], length))
}
