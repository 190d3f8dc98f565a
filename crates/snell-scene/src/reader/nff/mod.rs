//! NFF, Eric Haines's Neutral File Format, in which the Standard Procedural Databases (SPD) come.
//!
//! After NFF.TXT version 3.9 (1996) and the SPD's Readme 3.14. Everything is in world space, right-handed. The format is of
//! a time when numbers went to the screen as they were, so the colours of fills and of the background are taken as
//! display values (sRGB) and decoded: they look as their author saw them. Shares and lights are linear.
//!
//! - `f` r g b Kd Ks Shine T index: diffuse is Kd · rgb; where Ks > 0 the surface mirrors and has Phong's highlight, both
//!   with the plain share Ks (white, as in Haines's pictures); where T > 0 it transmits T · rgb (his gears tint what
//!   is seen through them), by Snell's law with fixed shares instead of Fresnel's. Opaque surfaces have one side.
//! - Polygons of one fill become one mesh, patches another, with their normals; equal corners are shared. Cylinders and cones
//!   are open.
//! - Lights do not fall off. Without a colour, each of n has the intensity √n / 2n that the Readme suggests; ambient light
//!   has that in any case.
//! - `angle` reaches from the middle of the top row of pixels to that of the bottom row, as NFF.TXT defines it, so the field of
//!   view is a row wider; the rows are those of `resolution`. `hither` is checked and not used, as a ray needs no near plane.
//! - A negative radius shows a surface's inside, which is rendered as a surface with two sides.

mod builder;
mod parser;

use crate::diagnostic::{Diagnostic, Diagnostics};
use crate::reader::report::Report;
use crate::reader::text::text_start;
use crate::scene::{Antialiasing, ObjectKind, PixelGrid, Shape};
use crate::table::Table;
use crate::{Id, Scene};

/// Reads a scene. `None` where anything is wrong with it; warnings may come with a scene.
///
/// ```
/// use snell_scene::reader::nff;
/// let text = b"v\nfrom 0 0 5\nat 0 0 0\nup 0 1 0\nangle 45\nhither 1\nresolution 64 64\nl 5 5 5\n\
///     f 1 0.5 0.2 0.8 0.2 10 0 1\ns 0 0 0 1\n";
/// let (scene, diagnostics) = nff::read("ball.nff", text);
/// assert!(diagnostics.list.is_empty());
/// assert_eq!(scene.unwrap().objects.len(), 1);
/// ```
pub fn read(name: &str, bytes: &[u8]) -> (Option<Scene>, Diagnostics) {
    let mut diagnostics = Diagnostics::default();
    let mut report = Report::new(name, bytes, &mut diagnostics);
    let scene = match text_start(bytes) {
        Ok(start) => parser::parse(&mut report, start),
        Err(encoding) => {
            let help = "save it as plain ASCII";
            report.whole("encodings", || Diagnostic::error(format!("this file is text in {encoding}")).help(help));
            None
        }
    };
    let good = report.finish();
    (scene.filter(|_| good), diagnostics)
}

/// Settings by the rules of the SPD: a ray at every corner of 512 × 512 pixels, hence 513 × 513 rays and no further ones;
/// depth 5, no ray cut for its small weight, not even for none; the teapot, the only one with patches, has two sides.
pub fn spd_rules(scene: &mut Scene) {
    scene.settings.width = 513;
    scene.settings.height = 513;
    scene.settings.pixel_grid = PixelGrid::Corners;
    scene.settings.antialiasing = Antialiasing::None;
    scene.settings.depth = 5;
    scene.settings.min_weight = 0.0;
    scene.settings.weightless_rays = true;

    let mut patches = vec![false; scene.materials.len()];
    for object in &scene.objects {
        if let (ObjectKind::Shape(Shape::Mesh(mesh)), Some(material)) = (&object.kind, object.material) {
            patches[material.index()] |= !scene.meshes[*mesh].normals.is_empty();
        }
    }
    let mut materials = Table::default();
    for (material, patch) in scene.materials.iter().zip(patches) {
        let mut material = material.clone();
        material.one_sided &= !patch;
        // Ids stay good, as the order does.
        let _: Id<_> = materials.push(material);
    }
    scene.materials = materials;
}

#[cfg(test)]
mod tests;
