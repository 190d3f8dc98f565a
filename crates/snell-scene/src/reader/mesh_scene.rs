//! A scene around a bare mesh: `snell render spot.obj` shows it without a word of description.
//!
//! The mesh stands on a plain checkered floor before a light sky, seen from the front, the right and above, with the key light
//! from the upper left, as photographers light a product. +y is up, but for STL files, whose custom is +z up: they are turned
//! about x. World units are those of the file.
//!
//! The camera is as near as the whole mesh allows in a square picture, with a margin; its field of view is vertical, so that
//! wider pictures only show more at the sides.

use rayon::prelude::*;
use snell_math::{Bounds3, Point3, Rgb, Transform, Vector3, portable};

use super::normals::{mesh_bounds, smooth_normals};
use super::{MeshFile, MeshFormat, read_mesh};
use crate::assets::Assets;
use crate::scene::{
    Background, Camera, Falloff, Frame, Light, LightKind, Mapping, Material, Mesh, Object, Pattern, Shape, Space,
    Texture,
};
use crate::{Diagnostics, Scene};

/// Edges sharper than this stay sharp in meshes without normals, in degrees.
const CREASE_ANGLE: f64 = 40.0;
/// The picture's vertical field of view, in degrees.
const FIELD_OF_VIEW: f64 = 30.0;
/// The share of half the picture that the mesh fills at most.
const FILL: f64 = 0.86;
/// From the mesh to the camera: to the right, up, to the front.
const TO_CAMERA: Vector3 = Vector3::new(0.55, 0.42, 1.0);
/// From the mesh to the key light and to the fill light.
const TO_KEY: Vector3 = Vector3::new(-0.55, 1.0, 0.75);
const TO_FILL: Vector3 = Vector3::new(1.0, 0.45, 0.5);

/// Reads a mesh and puts it into a scene of its own. `None` where the mesh has an error or no faces.
///
/// Meshes without normals get smooth ones by a crease angle of 40°.
pub fn mesh_scene(name: &str, bytes: &[u8], assets: &dyn Assets) -> (Option<Scene>, Diagnostics) {
    let mut diagnostics = Diagnostics::default();
    let file = read_mesh(name, bytes, assets, &mut diagnostics);
    let z_up = MeshFormat::from_name(name).or_else(|| MeshFormat::from_content(bytes)) == Some(MeshFormat::Stl);
    (file.map(|file| scene_around(file, z_up)), diagnostics)
}

fn scene_around(mut file: MeshFile, z_up: bool) -> Scene {
    if file.mesh.normals.is_empty() {
        smooth_normals(&mut file.mesh, portable::radians(CREASE_ANGLE));
    }
    let turn = if z_up { y_up_from_z_up() } else { Transform::IDENTITY };
    let bounds = turn.bounds(&mesh_bounds(&file.mesh));
    let size = match bounds.diagonal().length() {
        size if size > 0.0 => size,
        _ => 1.0,
    };
    let camera = frame(&file.mesh, &turn, &bounds, size);

    let mut scene = Scene { camera, ambient: Rgb::gray(0.2), ..Scene::default() };
    scene.background = Background::Gradient(vec![
        (-1.0, Rgb::new(0.55, 0.56, 0.58)),
        (0.0, Rgb::new(0.80, 0.84, 0.88)),
        (1.0, Rgb::new(0.36, 0.52, 0.78)),
    ]);
    for (name, to_light, strength) in [("key", TO_KEY, 0.75), ("fill", TO_FILL, 0.2)] {
        scene.lights.push(Light {
            name: Some(name.to_owned()),
            kind: LightKind::Directional { direction: -to_light, angle: 0.0 },
            intensity: Rgb::gray(strength),
            spectrum: None,
            falloff: Falloff::None,
        });
    }
    add_mesh(&mut scene, file, turn);
    add_floor(&mut scene, &bounds, size);
    scene
}

/// +z becomes +y, and +y becomes −z.
fn y_up_from_z_up() -> Transform {
    Transform::from_columns(Vector3::X, -Vector3::Z, Vector3::Y, Point3::ORIGIN).unwrap_or(Transform::IDENTITY)
}

/// The camera that sees all of the mesh.
fn frame(mesh: &Mesh, world_from_mesh: &Transform, bounds: &Bounds3, size: f64) -> Camera {
    let backward = TO_CAMERA.normalize();
    let right = Vector3::Y.cross(backward).normalize();
    let up = backward.cross(right);
    let center = bounds.center();
    let fov = portable::radians(FIELD_OF_VIEW);
    let slope = portable::tan(0.5 * fov) * FILL;
    // A point at (x, y) across and z towards the eye is inside where max(|x|, |y|) is at most slope · (distance − z).
    let needed = |distance: f64, &vertex: &u32| {
        let point = world_from_mesh.point(Point3::from(mesh.positions[vertex as usize].map(f64::from)));
        let from_center = point - center;
        let across = from_center.dot(right).abs().max(from_center.dot(up).abs());
        distance.max(across / slope + from_center.dot(backward))
    };
    // The largest of all, in whichever order they are looked at.
    let corners = mesh.triangles.as_flattened().par_chunks(1 << 16);
    let distance = corners.map(|corners| corners.iter().fold(0.0, needed)).reduce(|| 0.0, f64::max);
    // Never within the mesh, and in front of a mesh without any extent.
    let distance = distance.max(size);
    Camera {
        eye: center + backward * distance,
        gaze: -backward,
        up: Vector3::Y,
        frame: Frame::VerticalFov(fov),
        lens: None,
    }
}

fn add_mesh(scene: &mut Scene, file: MeshFile, turn: Transform) {
    let name = file.mesh.name.clone();
    let own_material = file.materials.is_empty().then(|| {
        // Vertex colours multiply the diffuse colour, so they need a light one.
        let gray = if file.mesh.colors.is_empty() { 0.7 } else { 0.9 };
        let diffuse = Some(scene.textures.push(Texture::constant(Rgb::gray(gray))));
        let specular = Some(scene.textures.push(Texture::constant(Rgb::gray(0.12))));
        scene.materials.push(Material { diffuse, specular, shininess: 40.0, ..Material::default() })
    });
    let mesh = file.add_to(scene);
    scene.objects.push(Object {
        name: Some(name),
        material: own_material,
        parent_from_object: turn,
        ..Object::shape(Shape::Mesh(mesh))
    });
}

/// A floor just under the mesh, so that faces of the mesh that lie flat on it are still in front.
fn add_floor(scene: &mut Scene, bounds: &Bounds3, size: f64) {
    let height = bounds.min.y() - 1e-4 * size;
    let center = bounds.center();
    let tile = 0.25 * size;
    let colors = [0.58, 0.66].map(|gray| scene.textures.push(Texture::constant(Rgb::gray(gray))));
    // The floor lies in the middle of a layer of the pattern's cubes, where rounding cannot change the cube.
    let origin = Point3::new(-center.x() / tile, 0.5 - height / tile, -center.z() / tile);
    let [x, y, z] = [Vector3::X, Vector3::Y, Vector3::Z].map(|axis| axis * (1.0 / tile));
    let texture_from_space = Transform::from_columns(x, y, z, origin).unwrap_or(Transform::IDENTITY);
    let diffuse = scene.textures.push(Texture {
        pattern: Pattern::Checker(colors),
        mapping: Mapping { space: Space::World, texture_from_space },
    });
    let material = scene.materials.push(Material {
        name: Some("floor".to_owned()),
        diffuse: Some(diffuse),
        ..Material::default()
    });
    let point = Point3::new(center.x(), height, center.z());
    scene.objects.push(Object {
        name: Some("floor".to_owned()),
        material: Some(material),
        ..Object::shape(Shape::Plane { point, normal: Vector3::Y })
    });
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::assets::MemoryAssets;

    /// Where a point is in the picture: (x, y) in [−1, 1] is inside a square one.
    fn project(camera: &Camera, point: Point3) -> (f64, f64) {
        let Frame::VerticalFov(fov) = camera.frame else { panic!("{:?}", camera.frame) };
        let backward = (-camera.gaze).normalize();
        let right = camera.up.cross(backward).normalize();
        let up = backward.cross(right);
        let (v, depth) = (point - camera.eye, -(point - camera.eye).dot(backward));
        assert!(depth > 0.0, "behind the eye");
        let half = depth * portable::tan(0.5 * fov);
        (v.dot(right) / half, v.dot(up) / half)
    }

    fn check_framed(name: &str, bytes: &[u8]) -> Scene {
        let (scene, diagnostics) = mesh_scene(name, bytes, &MemoryAssets::default());
        assert!(diagnostics.list.is_empty(), "{:?}", diagnostics.list);
        let scene = scene.unwrap();
        let mesh = scene.meshes.iter().next().unwrap();
        let mut reach = 0.0f64;
        for &p in &mesh.positions {
            let world = scene.objects[0].parent_from_object.point(Point3::from(p.map(f64::from)));
            let (x, y) = project(&scene.camera, world);
            reach = reach.max(x.abs()).max(y.abs());
        }
        assert!(reach < 0.9, "{reach}");
        assert!(reach > 0.3, "{reach}");
        scene
    }

    const FLAT: &[u8] = b"v 0 0 0\nv 10 0 0\nv 10 0.1 0\nv 0 0.1 0\nf 1 2 3 4\n";
    const TALL: &[u8] = b"v 0 0 0\nv 1e-3 0 0\nv 0 5 0\nf 1 2 3\n";
    const HUGE: &[u8] = b"v 0 0 0\nv 3e38 0 0\nv 0 3e38 0\nv 0 0 3e38\nf 1 2 3\nf 1 3 4\n";
    const TINY: &[u8] = b"v 1 1 1\nv 1.0000001 1 1\nv 1 1.0000002 1\nf 1 2 3\n";

    #[test]
    fn the_whole_mesh_is_in_the_picture_and_not_small() {
        for bytes in [FLAT, TALL, HUGE, TINY] {
            check_framed("a.obj", bytes);
        }
    }

    #[test]
    fn stl_files_stand_upright() {
        let text = b"solid\nfacet normal 0 0 0\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 0 7\nendloop\nendfacet\nendsolid\n";
        let scene = check_framed("a.stl", text);
        let up = scene.objects[0].parent_from_object.point(Point3::new(0.0, 0.0, 7.0));
        assert_eq!(up, Point3::new(0.0, 7.0, 0.0));
        let Shape::Plane { point, .. } = (match &scene.objects[1].kind {
            crate::scene::ObjectKind::Shape(shape) => shape,
            other => panic!("{other:?}"),
        }) else {
            panic!("no floor")
        };
        assert!(point.y() < 0.0 && point.y() > -0.01);
    }

    #[test]
    fn a_mesh_at_one_point_has_a_camera_too() {
        let (scene, _) = mesh_scene("a.obj", b"v 1 1 1\nf 1 1 1\n", &MemoryAssets::default());
        assert!(scene.unwrap().camera.eye.is_finite());
    }

    #[test]
    fn an_empty_mesh_is_refused_in_words() {
        let (scene, diagnostics) = mesh_scene("a.obj", b"v 1 1 1\n", &MemoryAssets::default());
        assert!(scene.is_none());
        assert!(diagnostics.list[0].message.contains("no faces"), "{:?}", diagnostics.list);
    }
}
