//! Shapes but meshes and lenses.

use snell_math::{Point3, Vector3};

use super::Resolver;
use crate::diagnostic::Span;
use crate::document::model::{self, Either, Located};
use crate::scene::Shape;

/// The cosine up to which two edges count as perpendicular.
const PERPENDICULAR: f64 = 1e-6;

impl Resolver<'_> {
    /// The shape that an object is; the check of keys has left just one.
    pub(super) fn shape(&mut self, object: &model::Object, span: &Option<Span>) -> Shape {
        if let Some(plane) = &object.plane {
            self.plane(&plane.value)
        } else if let Some(disk) = &object.disk {
            self.disk(disk)
        } else if let Some(rectangle) = &object.rectangle {
            self.rectangle(rectangle)
        } else if let Some(axis_box) = &object.axis_box {
            self.axis_box(axis_box)
        } else if let Some(cylinder) = &object.cylinder {
            let model::Cylinder { base, top, radius, capped } = cylinder.value;
            let (base, top) = (Point3::from(base), Point3::from(top));
            if (top - base).try_normalize().is_none() {
                self.error(&cylinder.span, "the cylinder has no height: its `base` is its `top`", "no height");
            }
            Shape::Cylinder { base, top, radius, capped }
        } else if let Some(cone) = &object.cone {
            self.cone(cone)
        } else if let Some(torus) = &object.torus {
            self.torus(torus)
        } else {
            let model::Sphere { center, radius } = object.sphere.as_deref().cloned().unwrap_or_default();
            if object.sphere.is_none() {
                self.error(span, "this object is nothing", "no shape");
            }
            Shape::Sphere { center: center.into(), radius }
        }
    }

    fn plane(&mut self, plane: &model::Plane) -> Shape {
        let (point, normal) = match (plane.x, plane.y, plane.z, &plane.normal) {
            (Some(x), ..) => (Point3::new(x, 0.0, 0.0), Vector3::X),
            (_, Some(y), ..) => (Point3::new(0.0, y, 0.0), Vector3::Y),
            (_, _, Some(z), _) => (Point3::new(0.0, 0.0, z), Vector3::Z),
            (None, None, None, normal) => {
                let normal = match normal {
                    Some(normal) => self.direction(normal, "the plane's normal", Vector3::Y),
                    None => Vector3::Y,
                };
                (plane.point.map_or(Point3::ORIGIN, Point3::from), normal)
            }
        };
        Shape::Plane { point, normal }
    }

    fn disk(&mut self, disk: &model::Disk) -> Shape {
        let normal = self.direction(&disk.normal, "the disk's normal", Vector3::Y);
        let inner_radius = disk.inner_radius.value;
        if inner_radius >= disk.radius {
            let message =
                format!("the disk's hole of radius {inner_radius} leaves nothing of its radius {}", disk.radius);
            self.error(&disk.inner_radius.span, message, format!("must be below {}", disk.radius));
        }
        Shape::Disk { center: disk.center.into(), normal, radius: disk.radius, inner_radius }
    }

    fn rectangle(&mut self, rectangle: &model::Rectangle) -> Shape {
        let u = self.direction(&rectangle.edge_u, "the rectangle's `edge_u`", Vector3::X);
        let v = self.direction(&rectangle.edge_v, "the rectangle's `edge_v`", Vector3::Y);
        let both_said = rectangle.edge_u.value != [0.0; 3] && rectangle.edge_v.value != [0.0; 3];
        if both_said && u.dot(v).abs() > PERPENDICULAR {
            let span = rectangle.edge_v.span.as_ref().or(rectangle.edge_u.span.as_ref()).cloned();
            self.error(&span, "the rectangle's edges are not perpendicular", "must be at a right angle to the other");
        }
        // Exactly perpendicular from here on, by at most a millionth of the length.
        let (edge_u, edge_v) = (Vector3::from(rectangle.edge_u.value), Vector3::from(rectangle.edge_v.value));
        let edge_v = edge_v - u * edge_v.dot(u);
        Shape::Rectangle { corner: rectangle.corner.into(), edges: [edge_u, edge_v] }
    }

    fn axis_box(&mut self, located: &Located<model::AxisBox>) -> Shape {
        let given = &located.value;
        let (min, max) = match (&given.size, given.center) {
            (None, None) => (given.min.unwrap_or([-0.5; 3]), given.max.unwrap_or([0.5; 3])),
            (size, center) => {
                let center = center.unwrap_or_default();
                let half = match size.as_ref().map(|size| &size.value) {
                    Some(Either::A(size)) => [0.5 * size; 3],
                    Some(Either::B(sizes)) => sizes.map(|size| 0.5 * size),
                    None => [0.5; 3],
                };
                (std::array::from_fn(|i| center[i] - half[i]), std::array::from_fn(|i| center[i] + half[i]))
            }
        };
        for (i, axis) in ["x", "y", "z"].into_iter().enumerate() {
            if min[i] >= max[i] {
                let message = format!("the box has no extent along {axis}: it goes from {} to {}", min[i], max[i]);
                let span = given.size.as_ref().map_or(&located.span, |size| &size.span);
                self.error(span, message, "must be larger than 0 in every direction");
                break;
            }
        }
        Shape::Box { min: min.into(), max: max.into() }
    }

    fn cone(&mut self, cone: &Located<model::Cone>) -> Shape {
        let model::Cone { base, base_radius, top, top_radius, capped } = cone.value;
        let (base, top) = (Point3::from(base), Point3::from(top));
        if (top - base).try_normalize().is_none() {
            self.error(&cone.span, "the cone has no height: its `base` is its `top`", "no height");
        }
        if base_radius == top_radius {
            let message = if base_radius == 0.0 {
                "the cone is a mere line: both its radii are 0".to_owned()
            } else {
                format!("the cone has the radius {base_radius} at both ends: write it as a `cylinder`")
            };
            self.error(&cone.span, message, "the radii must differ");
        }
        Shape::Cone { base, base_radius, top, top_radius, capped }
    }

    fn torus(&mut self, torus: &model::Torus) -> Shape {
        let axis = self.direction(&torus.axis, "the torus's axis", Vector3::Y);
        let (major_radius, minor_radius) = (torus.major_radius, torus.minor_radius.value);
        if minor_radius > major_radius {
            let message = format!(
                "the torus's tube of radius {minor_radius} is thicker than its circle of radius {major_radius} allows"
            );
            self.error(&torus.minor_radius.span, message, format!("must be at most {major_radius}"));
        }
        Shape::Torus { center: torus.center.into(), axis, major_radius, minor_radius }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_box_by_size_is_centred() {
        let text = b"[[object]]\nbox = { size = [2, 4, 6], center = [1, 1, 1] }\n";
        let (scene, diagnostics) =
            crate::document::read_scene("a.toml", text, &crate::assets::MemoryAssets::default(), &[]);
        assert!(diagnostics.list.is_empty(), "{:?}", diagnostics.list);
        let crate::scene::ObjectKind::Shape(shape) = &scene.expect("a scene").objects[0].kind else { panic!() };
        assert_eq!(*shape, Shape::Box { min: Point3::new(0.0, -1.0, -2.0), max: Point3::new(2.0, 3.0, 4.0) });
    }
}
