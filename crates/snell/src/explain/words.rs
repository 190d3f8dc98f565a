//! What happened to a ray, in words: short sentences for texts and drawings.

use snell_math::{Point3, Rgb, Vector3};

use super::{Blocker, Boundary, End, ExplainedMedium, ExplainedRay, ExplainedSurface};

/// What happened to a ray, in a sentence without its subject.
pub fn sentence(ray: &ExplainedRay) -> String {
    let milky = if ray.absorption == Rgb::WHITE {
        String::new()
    } else {
        format!(
            "goes {} through {}, which leaves {} of its light; ",
            length(ray.distance),
            medium(&ray.medium),
            percents(ray.absorption)
        )
    };
    let end = match (&ray.surface, ray.end) {
        (_, End::DepthLimit) => "is not followed: it would be deeper than allowed".to_owned(),
        (_, End::TooLittleWeight) => {
            format!("is not followed: {} of its sample is too little", percents(ray.throughput))
        }
        (_, End::Chance) => {
            format!("is not followed, by chance: of many that carry {} some go on, with more", percents(ray.throughput))
        }
        (_, End::TooManyRays) => "is not followed: its sample has too many rays".to_owned(),
        (None, End::Blocked | End::Light) => arrival(ray),
        (None, End::Scattered) => {
            format!("is scattered inside {} after {}", medium(&ray.medium), length(ray.distance))
        }
        (None, _) => "leaves the scene".to_owned(),
        (Some(surface), End::NoEffect) => {
            format!("goes straight on through {}, whose boundary does nothing there", named(surface))
        }
        (Some(surface), _) => met(surface),
    };
    format!("{milky}{end}")
}

/// What happened at the surface that a ray met.
fn met(surface: &ExplainedSurface) -> String {
    let angle = degrees(surface.incidence);
    let Some(first) = surface.boundaries.first() else {
        let mirror = if surface.mirror.is_black() {
            String::new()
        } else {
            format!(", which mirrors {}", percents(surface.mirror))
        };
        return format!("meets {} at {angle}{mirror}", named(surface));
    };
    let angle = degrees(first.incidence);
    let object = &surface.object;
    let way = match (&first.media[0].material, &first.media[1].material) {
        (None, Some(beyond)) => format!("enters {object} ({beyond})"),
        (Some(before), None) => format!("leaves {object} ({before})"),
        (Some(before), Some(beyond)) => format!("goes from {before} into {beyond} at {object}"),
        (None, None) => format!("goes through {object}"),
    };
    if surface.boundaries.len() > 1 {
        return split(&way, &angle, &surface.boundaries);
    }
    if first.is_total() {
        let inside = first.media[0].material.as_deref().unwrap_or(object);
        let critical =
            first.critical.map_or(String::new(), |c| format!(", beyond the critical angle of {}", degrees(c)));
        return format!("meets {object} from inside {inside} at {angle}{critical}: total internal reflection");
    }
    let bent = first.refraction.map_or(String::new(), |to| format!(", bends to {}", degrees(to)));
    let reflected = if first.fresnel {
        format!("{} is reflected", share(first.reflectance))
    } else {
        format!("{} is reflected and {} goes on", percents(first.reflected_weight), percents(first.refracted_weight))
    };
    format!("{way} at {angle}{bent}; {reflected}")
}

/// White light that splits.
fn split(way: &str, angle: &str, bands: &[Boundary]) -> String {
    let bent: Vec<f64> = bands.iter().filter_map(|band| band.refraction).collect();
    let total = bands.len() - bent.len();
    let to = match (bent.first(), bent.last()) {
        (Some(first), Some(last)) => format!(", which bend to {:.2} to {}", first.to_degrees(), degrees_fine(*last)),
        _ => String::new(),
    };
    let total = if total > 0 { format!("; {total} of them meet total internal reflection") } else { String::new() };
    format!("{way} at {angle}, splits into {} bands{to}{total}", bands.len())
}

/// How much of a light arrives, and what is in its way.
pub fn arrival(shadow: &ExplainedRay) -> String {
    let names = |blockers: &[Blocker]| {
        let mut names: Vec<&str> = Vec::new();
        for blocker in blockers {
            if !names.contains(&blocker.object.as_str()) {
                names.push(&blocker.object);
            }
        }
        names.join(", ")
    };
    let arrives = shadow.transmittance.unwrap_or(Rgb::WHITE);
    match shadow.end {
        End::Blocked => match shadow.blockers.last() {
            Some(blocker) => format!("blocked by {}", blocker.object),
            None => "blocked".to_owned(),
        },
        _ if shadow.blockers.is_empty() && arrives == Rgb::WHITE => "nothing blocks it".to_owned(),
        _ if shadow.blockers.is_empty() => format!("{} arrives through {}", percents(arrives), medium(&shadow.medium)),
        _ => format!("{} arrives through {}", percents(arrives), names(&shadow.blockers)),
    }
}

/// Where a ray begins and ends, and the numbers of what it met.
pub fn details(ray: &ExplainedRay) -> Vec<String> {
    let (Some(origin), Some(direction)) = (ray.origin, ray.direction) else { return Vec::new() };
    let within = if ray.medium.index == 1.0 { String::new() } else { format!(" in {}", medium(&ray.medium)) };
    let mut lines = vec![format!(
        "depth {}, from {} along {}, {}{within}, carrying {}",
        ray.depth,
        point(origin),
        vector(direction),
        length(ray.distance),
        percents(ray.throughput)
    )];
    if let Some(surface) = &ray.surface {
        lines.push(format!("to {}, normal {}", point(surface.point), vector(surface.normal.as_vector())));
        for boundary in &surface.boundaries {
            let [before, beyond] = [&boundary.media[0], &boundary.media[1]].map(|medium| medium.index);
            let band = boundary.wavelength_nm.map_or(String::new(), |nm| format!("{nm:.1} nm: "));
            let critical = boundary.critical.map_or(String::new(), |c| format!(", critical angle {}", degrees(c)));
            let (r, t) = (boundary.reflectance, boundary.transmittance);
            lines.push(format!("{band}index {before:.5} to {beyond:.5}{critical}, R {r:.6}, T {t:.6}"));
        }
    }
    lines
}

/// `board (board)`, or one of both where they are alike.
fn named(surface: &ExplainedSurface) -> String {
    let ExplainedSurface { object, material, .. } = surface;
    if object == material { object.clone() } else { format!("{object} ({material})") }
}

fn medium(medium: &ExplainedMedium) -> &str {
    medium.material.as_deref().unwrap_or("air")
}

/// A number between 0 and 1 as percent.
pub fn share(x: f64) -> String {
    let percent = x * 100.0;
    match percent.abs() {
        0.0 => "0 %".to_owned(),
        small if small < 0.000_95 => "less than 0.001 %".to_owned(),
        small if small < 0.009_5 => format!("{percent:.3} %"),
        small if small < 0.095 => format!("{percent:.2} %"),
        _ => format!("{percent:.1} %"),
    }
}

/// A colour as percent, once where its components look alike.
fn percents(color: Rgb) -> String {
    let [r, g, b] = color.to_array().map(|component| share(f64::from(component)));
    if r == g && g == b { r } else { format!("{}/{}/{b}", r.trim_end_matches(" %"), g.trim_end_matches(" %")) }
}

/// `41.2°`.
pub fn degrees(radians: f64) -> String {
    format!("{:.1}°", radians.to_degrees())
}

fn degrees_fine(radians: f64) -> String {
    format!("{:.2}°", radians.to_degrees())
}

fn length(distance: Option<f64>) -> String {
    match distance {
        Some(distance) if distance.is_finite() => number(distance),
        _ => "without end".to_owned(),
    }
}

/// `(1, 2.5, -3)`.
pub fn point(p: Point3) -> String {
    triple(p.to_array())
}

/// `(1, 2.5, -3)`.
pub fn vector(v: Vector3) -> String {
    triple(v.to_array())
}

fn triple(numbers: [f64; 3]) -> String {
    let [x, y, z] = numbers.map(number);
    format!("({x}, {y}, {z})")
}

/// A number to five digits, without what is mere rounding.
fn number(x: f64) -> String {
    if x.abs() < 1e-9 {
        return "0".to_owned();
    }
    if !(1e-3..1e6).contains(&x.abs()) {
        return format!("{x:.3e}");
    }
    let text = format!("{x:.4}");
    text.trim_end_matches('0').trim_end_matches('.').to_owned()
}
