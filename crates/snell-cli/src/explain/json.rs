//! An explanation for programs: the object that `docs/explain.schema.json` describes.
//!
//! Numbers are written so that reading them as `f64` gives the same bits again.

use serde_json::{Value, json};
use snell::explain::{
    Blocker, Boundary, End, ExplainedMedium, ExplainedRay, ExplainedSurface, ExplainedTerm, Explanation, Kind,
    PathShare, StepKind, Subject, TermKind,
};
use snell::math::{Point3, Rgb, Vector3};

use super::Picture;

/// The version of what is written; it rises with every change that a reader could notice other than additions.
pub const VERSION: u32 = 1;

/// The whole object.
pub fn json(picture: &Picture<'_>, told: &Explanation) -> Value {
    let sample = |sample: &snell::explain::ExplainedSample| {
        json!({
            "number": sample.number,
            "place": sample.place,
            "color": color(sample.color),
            "wavelengths_nm": sample.wavelengths_nm,
            "camera_ray": sample.camera_ray,
        })
    };
    json!({
        "version": VERSION,
        "scene": picture.name,
        "size": [picture.watch.settings.width, picture.watch.settings.height],
        "subject": subject(told.subject),
        "pixel": color(told.pixel),
        "samples": told.samples.iter().map(sample).collect::<Vec<_>>(),
        "rays": told.rays.iter().enumerate().map(|(id, one)| ray(id, one)).collect::<Vec<_>>(),
        "terms": told.terms.iter().map(|one| term(told, one)).collect::<Vec<_>>(),
        "paths": told.paths.iter().map(|one| path(told, one)).collect::<Vec<_>>(),
    })
}

fn subject(subject: Subject) -> Value {
    match subject {
        Subject::Pixel(pixel) => json!({ "pixel": pixel }),
        Subject::Sample(pixel, sample) => json!({ "pixel": pixel, "sample": sample }),
        Subject::Ray(ray, sample) => {
            json!({ "origin": point(ray.origin), "direction": vector(ray.direction), "sample": sample })
        }
    }
}

fn ray(id: usize, ray: &ExplainedRay) -> Value {
    json!({
        "id": id,
        "sample": ray.sample,
        "parent": ray.parent,
        "kind": kind(ray.kind),
        "light": ray.light,
        "depth": ray.depth,
        "wavelength_nm": ray.wavelength_nm,
        "origin": ray.origin.map(point),
        "direction": ray.direction.map(vector),
        "end": end(ray.end),
        "distance": ray.distance.filter(|distance| distance.is_finite()),
        "throughput": color(ray.throughput),
        "medium": medium(&ray.medium),
        "absorption": color(ray.absorption),
        "surface": ray.surface.as_ref().map(surface),
        "blockers": ray.blockers.iter().map(blocker).collect::<Vec<_>>(),
        "transmittance": ray.transmittance.map(color),
        "share": ray.share,
    })
}

fn surface(surface: &ExplainedSurface) -> Value {
    json!({
        "point": point(surface.point),
        "object": surface.object,
        "material": surface.material,
        "normal": vector(surface.normal.as_vector()),
        "shading_normal": vector(surface.shading_normal.as_vector()),
        "incidence": surface.incidence,
        "mirror": color(surface.mirror),
        "boundaries": surface.boundaries.iter().map(boundary).collect::<Vec<_>>(),
    })
}

fn boundary(boundary: &Boundary) -> Value {
    json!({
        "media": boundary.media.iter().map(medium).collect::<Vec<_>>(),
        "wavelength_nm": boundary.wavelength_nm,
        "part": color(boundary.part),
        "incidence": boundary.incidence,
        "refraction": boundary.refraction,
        "critical": boundary.critical,
        "reflectance": boundary.reflectance,
        "transmittance": boundary.transmittance,
        "total_internal_reflection": boundary.is_total(),
        "fresnel": boundary.fresnel,
        "reflected_weight": color(boundary.reflected_weight),
        "refracted_weight": color(boundary.refracted_weight),
    })
}

fn blocker(blocker: &Blocker) -> Value {
    json!({
        "point": point(blocker.point),
        "object": blocker.object,
        "material": blocker.material,
        "distance": blocker.distance,
        "absorption": color(blocker.absorption),
        "reflectance": blocker.reflectance,
        "transmittance": color(blocker.transmittance),
    })
}

fn medium(medium: &ExplainedMedium) -> Value {
    json!({ "material": medium.material, "index": medium.index })
}

fn term(told: &Explanation, term: &ExplainedTerm) -> Value {
    json!({
        "ray": term.ray,
        "kind": term_kind(term.kind),
        "light": term.light,
        "shadow_ray": term.shadow_ray,
        "unblocked": term.unblocked.map(color),
        "value": color(term.value),
        "share": term.share,
        "portion": told.portion(term.share),
    })
}

fn path(told: &Explanation, path: &PathShare) -> Value {
    let step = |kind: StepKind| match kind {
        StepKind::Camera => "camera",
        StepKind::Reflected => "reflected",
        StepKind::Refracted => "refracted",
        StepKind::Scattered => "scattered",
    };
    json!({
        "label": path.label(),
        "kinds": path.steps.iter().map(|one| step(one.kind)).collect::<Vec<_>>(),
        "objects": path.steps.iter().map(|step| step.object.as_deref()).collect::<Vec<_>>(),
        "mean": path.mean,
        "portion": told.portion(path.mean),
        "variance": path.variance,
        "samples": path.samples,
    })
}

fn kind(kind: Kind) -> &'static str {
    match kind {
        Kind::Camera => "camera",
        Kind::Reflected => "reflected",
        Kind::Refracted => "refracted",
        Kind::Scattered => "scattered",
        Kind::Shadow => "shadow",
    }
}

fn end(end: End) -> &'static str {
    match end {
        End::Surface => "surface",
        End::Light => "light",
        End::Background => "background",
        End::NoEffect => "no-effect",
        End::Scattered => "scattered",
        End::Blocked => "blocked",
        End::DepthLimit => "depth-limit",
        End::TooLittleWeight => "too-little-weight",
        End::TooManyRays => "too-many-rays",
        End::Chance => "chance",
    }
}

fn term_kind(kind: TermKind) -> &'static str {
    match kind {
        TermKind::Background => "background",
        TermKind::Emission => "emission",
        TermKind::Ambient => "ambient",
        TermKind::Diffuse => "diffuse",
        TermKind::Specular => "specular",
        TermKind::Scattering => "scattering",
        TermKind::Photons => "photons",
        TermKind::Rounding => "rounding",
    }
}

/// Components as `f64`, which hold every bit; what is no number is `null`.
fn color(color: Rgb) -> Value {
    json!(color.to_array().map(f64::from))
}

fn point(point: Point3) -> Value {
    json!(point.to_array())
}

fn vector(vector: Vector3) -> Value {
    json!(vector.to_array())
}
