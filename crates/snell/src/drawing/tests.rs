//! Drawings against renderings of the same scenes, and against what is known of simple ones.

use std::path::Path;
use std::sync::Arc;

use snell_math::{Point3, Transform, Vector3, portable};
use snell_scene::assets::{AssetError, Assets};
use snell_scene::document::read_scene;
use snell_scene::scene::{Camera as CameraDescription, Frame, HiddenLines, Mesh, Object, Scene, Shape};

use super::{DrawingSettings, draw, lines, seen_lines};
use crate::camera::Camera;
use crate::compile::CompiledScene;
use crate::drawing::screen::Screen;
use crate::geometry::QueryScratch;
use crate::vector::{Item, Page, Piece, encode_svg};

fn object(name: &str, shape: Shape) -> Object {
    Object { name: Some(name.to_owned()), ..Object::shape(shape) }
}

fn ball(center: [f64; 3], radius: f64) -> Shape {
    Shape::Sphere { center: center.into(), radius }
}

/// A scene of objects, seen from a little above.
fn scene(objects: Vec<Object>) -> Scene {
    let mut scene = Scene { objects, ..Scene::default() };
    (scene.settings.width, scene.settings.height) = (320, 240);
    let eye = Point3::new(2.0, 3.0, 9.0);
    scene.camera = CameraDescription {
        eye,
        gaze: Point3::new(0.0, 0.5, 0.0) - eye,
        up: Vector3::Y,
        frame: Frame::HorizontalFov(portable::radians(40.0)),
        lens: None,
    };
    scene
}

fn drawn(scene: &Scene) -> Page {
    let compiled = CompiledScene::build(scene).expect("it compiles");
    draw(&compiled, &DrawingSettings::new(scene)).expect("it is drawn")
}

/// All pieces of a page's lines.
fn pieces(page: &Page) -> Vec<Piece> {
    let paths = page.groups.iter().flat_map(|group| &group.items).filter_map(|item| match item {
        Item::Path(path) => Some(path),
        Item::Text(_) => None,
    });
    paths.flat_map(|path| &path.subpaths).flat_map(|subpath| subpath.pieces.clone()).collect()
}

/// What the picture shows at each pixel's centre: whose surface, its point and its normal.
type Seen = Option<((u32, u64), Point3, Vector3)>;

/// Both ends of a straight piece, in the raster.
type Ends = [[f64; 2]; 2];

/// The places between pixels at which the rendering has an edge, each as the centres of both pixels; and those of them at which the
/// object changes.
fn edges(scene: &CompiledScene, camera: &Camera) -> (Vec<Ends>, Vec<Ends>) {
    let [width, height] = camera.pixels();
    let mut scratch = QueryScratch::default();
    let mut look = |x: u32, y: u32| -> Seen {
        let ray = camera.generate_ray(f64::from(x) + 0.5, f64::from(y) + 0.5);
        let hit = scene.geometry.intersect(&ray, camera.far_distance(&ray), &mut scratch)?;
        let at = scene.interaction(&ray, &hit);
        Some(((at.object, at.solid.0), at.point, at.geometric_normal.as_vector()))
    };
    let seen: Vec<Seen> = (0..height).flat_map(|y| (0..width).map(move |x| (x, y))).map(|(x, y)| look(x, y)).collect();
    let (mut all, mut of_objects) = (Vec::new(), Vec::new());
    for y in 0..height {
        for x in 0..width {
            for (nx, ny) in [(x + 1, y), (x, y + 1)] {
                if nx >= width || ny >= height {
                    continue;
                }
                let (a, b) = (&seen[(y * width + x) as usize], &seen[(ny * width + nx) as usize]);
                let (differs, other_object) = match (a, b) {
                    (None, None) => (false, false),
                    (Some((one, p, n)), Some((other, q, m))) => {
                        // A jump: neither point lies nearly in the plane of the other.
                        let gap = (*q - *p).dot(*n).abs().min((*p - *q).dot(*m).abs());
                        let jumps = gap > 0.25 * p.distance(*q) || n.dot(*m) < 0.94;
                        (one != other || jumps, one.0 != other.0)
                    }
                    _ => (true, true),
                };
                let place = [[x, y], [nx, ny]].map(|[x, y]| [f64::from(x) + 0.5, f64::from(y) + 0.5]);
                if differs {
                    all.push(place);
                }
                if other_object {
                    of_objects.push(place);
                }
            }
        }
    }
    (all, of_objects)
}

/// Points along all seen lines, less than half a pixel apart, those that are mere parameter lines left out.
fn points(scene: &CompiledScene, settings: &DrawingSettings, camera: &Camera) -> Vec<[f64; 2]> {
    let bounds = lines::finite_bounds(&scene.geometry);
    let screen = Screen::new(camera, &bounds).expect("a screen");
    let seen = seen_lines(scene, &screen, &settings.drawing, &[]);
    let mut points = Vec::new();
    for line in &seen {
        let curve = &line.line.feature.curve;
        for part in line.parts.iter().filter(|part| part.visible) {
            let track = screen.track(curve, [part.from, part.to]);
            for pair in track.windows(2) {
                let (dx, dy) = (pair[1].at[0] - pair[0].at[0], pair[1].at[1] - pair[0].at[1]);
                let steps = ((dx * dx + dy * dy).sqrt() / 0.4).ceil().max(1.0);
                let mut step = 0.0;
                while step <= steps {
                    points.push([pair[0].at[0] + dx * step / steps, pair[0].at[1] + dy * step / steps]);
                    step += 1.0;
                }
            }
        }
    }
    points
}

/// The distance of a point from a segment.
fn distance(p: [f64; 2], [a, b]: [[f64; 2]; 2]) -> f64 {
    let d = [b[0] - a[0], b[1] - a[1]];
    let squared = d[0] * d[0] + d[1] * d[1];
    let t = if squared > 0.0 { (((p[0] - a[0]) * d[0] + (p[1] - a[1]) * d[1]) / squared).clamp(0.0, 1.0) } else { 0.0 };
    let (x, y) = (a[0] + d[0] * t - p[0], a[1] + d[1] * t - p[1]);
    (x * x + y * y).sqrt()
}

/// The share of `these` farther than a pixel from all of `those`; both within the picture.
fn far_share<T: Copy>(these: &[T], those: &[[[f64; 2]; 2]], place: impl Fn(T) -> [[f64; 2]; 2], size: [u32; 2]) -> f64 {
    let cells = size.map(|n| n as usize / 4 + 3);
    let cell = |p: [f64; 2]| [0, 1].map(|k| ((p[k] / 4.0).floor() + 1.0).clamp(0.0, cells[k] as f64 - 1.0) as usize);
    let mut grid = vec![Vec::new(); cells[0] * cells[1]];
    for that in those {
        let [x, y] = cell([0.5 * (that[0][0] + that[1][0]), 0.5 * (that[0][1] + that[1][1])]);
        grid[y * cells[0] + x].push(*that);
    }
    let mut far = 0;
    for &this in these {
        let ends = place(this);
        let middle = [0.5 * (ends[0][0] + ends[1][0]), 0.5 * (ends[0][1] + ends[1][1])];
        let [x, y] = cell(middle);
        let near = (y.saturating_sub(1)..=(y + 1).min(cells[1] - 1))
            .flat_map(|y| (x.saturating_sub(1)..=(x + 1).min(cells[0] - 1)).map(move |x| (x, y)))
            .flat_map(|(x, y)| &grid[y * cells[0] + x])
            .any(|that| distance(middle, *that) <= 1.0);
        far += usize::from(!near);
    }
    far as f64 / these.len().max(1) as f64
}

/// The share of lines far from any edge of the picture, and the share of edges between objects far from any line.
fn disagreement(scene: &Scene, moved: f64) -> (f64, f64) {
    let compiled = CompiledScene::build(scene).expect("it compiles");
    let settings = DrawingSettings::new(scene);
    let camera = Camera::new(&compiled.camera, settings.width, settings.height, settings.pixel_grid).expect("a camera");
    let (all, of_objects) = edges(&compiled, &camera);
    let size = camera.pixels();
    // The picture's own border is no edge of it.
    let inside = |p: &[f64; 2]| (0..2).all(|k| p[k] > 1.5 && p[k] < f64::from(size[k]) - 1.5);
    let mut points = points(&compiled, &settings, &camera);
    points.iter_mut().for_each(|p| p[0] += moved);
    points.retain(inside);
    let lines: Vec<[[f64; 2]; 2]> = points.iter().map(|p| [*p, *p]).collect();
    let of_objects: Vec<[[f64; 2]; 2]> = of_objects.into_iter().filter(|[a, b]| inside(a) && inside(b)).collect();
    (far_share(&points, &all, |p| [p, p], size), far_share(&of_objects, &lines, |edge| edge, size))
}

/// Of lines and of edges, the share that may be without a counterpart: where surfaces are seen edge on, pixels miss what lines show.
const STATED_SHARE: f64 = 0.01;

fn check(name: &str, scene: &Scene) {
    let (lines, edges) = disagreement(scene, 0.0);
    assert!(lines <= STATED_SHARE, "{name}: {lines} of the lines are far from any edge");
    assert!(edges <= STATED_SHARE, "{name}: {edges} of the edges are far from any line");
    // The twin: lines that are moved by three pixels are told.
    let (lines, edges) = disagreement(scene, 3.0);
    assert!(lines > STATED_SHARE && edges > STATED_SHARE, "{name}: {lines}, {edges}");
}

fn shapes() -> Vec<(&'static str, Shape)> {
    vec![
        ("ball", ball([0.0, 1.0, 0.0], 1.0)),
        ("box", Shape::Box { min: [-1.0, 0.0, -1.0].into(), max: [0.6, 1.5, 0.8].into() }),
        (
            "cylinder",
            Shape::Cylinder { base: [0.0, 0.0, 0.0].into(), top: [0.3, 2.0, 0.4].into(), radius: 0.8, capped: true },
        ),
        (
            "tube",
            Shape::Cylinder { base: [-1.0, 0.5, 0.0].into(), top: [1.0, 0.6, 1.0].into(), radius: 0.6, capped: false },
        ),
        (
            "cone",
            Shape::Cone {
                base: [0.0; 3].into(),
                base_radius: 1.2,
                top: [0.0, 2.0, 0.0].into(),
                top_radius: 0.0,
                capped: true,
            },
        ),
        (
            "frustum",
            Shape::Cone {
                base: [0.0; 3].into(),
                base_radius: 0.4,
                top: [0.0, 1.5, 0.5].into(),
                top_radius: 1.0,
                capped: true,
            },
        ),
        (
            "torus",
            Shape::Torus {
                center: [0.0, 0.8, 0.0].into(),
                axis: Vector3::new(0.2, 1.0, 0.3).normalize(),
                major_radius: 1.2,
                minor_radius: 0.4,
            },
        ),
        ("disk", Shape::Disk { center: [0.0, 0.5, 0.0].into(), normal: Vector3::Y, radius: 1.5, inner_radius: 0.5 }),
        (
            "rectangle",
            Shape::Rectangle { corner: [-1.0, 0.0, 0.0].into(), edges: [Vector3::X * 2.0, Vector3::Y * 1.5] },
        ),
    ]
}

#[test]
fn every_shape_is_drawn_where_it_is_rendered() {
    for (name, shape) in shapes() {
        let mut objects = vec![object(name, shape.clone())];
        check(name, &scene(objects.clone()));
        // Squeezed and turned, it is no longer of its kind.
        let squeeze = Transform::rotate(Vector3::Z, 0.5) * Transform::scale(Vector3::new(1.2, 0.6, 0.9));
        objects[0].parent_from_object = squeeze;
        check(&format!("{name}, squeezed"), &scene(objects.clone()));
        // Behind and before others, over a floor.
        objects[0].parent_from_object = Transform::IDENTITY;
        let floor = Shape::Plane { point: [0.0, -0.2, 0.0].into(), normal: Vector3::Y };
        objects.extend([
            object("floor", floor),
            object("left", ball([-1.3, 0.3, 1.5], 0.5)),
            object("post", Shape::Box { min: [0.4, -0.2, 2.0].into(), max: [0.6, 1.8, 2.2].into() }),
        ]);
        check(&format!("{name}, among others"), &scene(objects));
    }
}

#[test]
fn parallel_views_and_windows_beside_the_middle_agree_too() {
    let objects: Vec<Object> = shapes().into_iter().take(3).map(|(name, shape)| object(name, shape)).collect();
    let mut parallel = scene(objects);
    parallel.camera.frame = Frame::OrthographicWidth(6.0);
    check("parallel", &parallel);
    parallel.camera.frame =
        Frame::PerspectiveWindow { left: -0.1, right: 0.5, bottom: -0.25, top: 0.2, near: -1.0, far: -40.0 };
    check("beside the middle", &parallel);
    // A near plane that cuts things open, and a far plane through others.
    parallel.camera.frame =
        Frame::OrthographicWindow { left: -3.0, right: 3.0, bottom: -2.0, top: 2.0, near: -2.0, far: -30.0 };
    check("near and far", &parallel);
}

/// The repository's files.
struct Repository;

impl Assets for Repository {
    fn read(&self, resolved: &str) -> Result<Arc<[u8]>, AssetError> {
        let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..").join(resolved);
        std::fs::read(path).map(Into::into).map_err(|_| AssetError::NotFound)
    }
}

#[test]
fn every_rendered_scene_of_the_gallery_agrees_with_its_drawing() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenes");
    let entries = std::fs::read_dir(folder).expect("the scenes");
    let mut names: Vec<String> =
        entries.map(|entry| entry.expect("a file").file_name().into_string().expect("a name")).collect();
    names.retain(|name| name.ends_with(".toml"));
    names.sort();
    let mut checked = 0;
    for name in names {
        let path = format!("scenes/{name}");
        let text = Repository.read(&path).expect("it is there");
        let (scene, _) = read_scene(&path, &text, &Repository, &[]);
        let mut scene = scene.expect("it has no mistakes");
        if scene.lights.is_empty() {
            continue;
        }
        let height = 400.0 * f64::from(scene.settings.height) / f64::from(scene.settings.width);
        (scene.settings.width, scene.settings.height) = (400, height as u32);
        // Under water everything is seen in the one surface: there is no edge, and no line.
        let (lines, edges) = disagreement(&scene, 0.0);
        if name != "total-internal-reflection.toml" {
            check(&name, &scene);
        }
        assert_eq!((lines, edges), (0.0, 0.0), "{name}");
        checked += 1;
    }
    assert!(checked >= 15, "{checked} scenes");
}

#[test]
fn a_mesh_of_many_triangles_agrees_with_its_drawing() {
    let mut mesh = Mesh { name: "bumps".to_owned(), ..Mesh::default() };
    let (rows, columns) = (120_u32, 120_u32);
    for i in 0..=rows {
        for j in 0..columns {
            let (a, b) = (
                std::f64::consts::PI * f64::from(i) / f64::from(rows),
                std::f64::consts::TAU * f64::from(j) / f64::from(columns),
            );
            let bump = 1.0 + 0.12 * portable::sin(7.0 * a) * portable::sin(6.0 * b);
            let (ring, height) = (portable::sin(a) * bump, portable::cos(a) * bump);
            mesh.positions.push([ring * portable::cos(b), height, ring * portable::sin(b)].map(|c| c as f32));
        }
    }
    for i in 0..rows {
        for j in 0..columns {
            let at = |i: u32, j: u32| i * columns + j % columns;
            mesh.triangles.push([at(i, j), at(i, j + 1), at(i + 1, j)]);
            mesh.triangles.push([at(i, j + 1), at(i + 1, j + 1), at(i + 1, j)]);
        }
    }
    let mut scene = scene(Vec::new());
    let id = scene.meshes.push(mesh);
    scene.objects.push(object("bumps", Shape::Mesh(id)));
    check("bumps", &scene);
    // Sunk into a floor, and with a ball sunk into it.
    scene.objects.push(object("floor", Shape::Plane { point: [0.0, -0.5, 0.0].into(), normal: Vector3::Y }));
    scene.objects.push(object("ball", ball([0.3, 0.6, 0.9], 0.5)));
    check("bumps among others", &scene);
}

#[test]
fn a_ball_is_one_ellipse() {
    let page = drawn(&scene(vec![object("ball", ball([0.7, 0.2, 1.0], 1.0))]));
    let [Piece::Arc(arc)] = pieces(&page)[..] else { panic!("{:?}", pieces(&page)) };
    assert!(arc.is_full() && arc.radii[0] > arc.radii[1] * 1.001, "{arc:?}");
    let svg = encode_svg(&page).expect("an SVG");
    assert_eq!((svg.matches("<ellipse").count(), svg.contains("id=\"ball\"")), (1, true), "{svg}");
    // A part of it behind another one is an arc of the same ellipse.
    let two =
        drawn(&scene(vec![object("ball", ball([0.7, 0.2, 1.0], 1.0)), object("small", ball([1.6, 0.6, 2.4], 0.5))]));
    let arcs: Vec<Piece> = pieces(&two);
    let Some(Piece::Arc(part)) = arcs.iter().find(|piece| matches!(piece, Piece::Arc(arc) if !arc.is_full())) else {
        panic!("{arcs:?}")
    };
    assert!((part.radii[0] - arc.radii[0]).abs() < 1e-9 && (part.center[0] - arc.center[0]).abs() < 1e-9);
}

#[test]
fn a_box_shows_nine_edges_and_hides_three() {
    let mut scene =
        scene(vec![object("box", Shape::Box { min: [-1.0, 0.0, -1.0].into(), max: [1.0, 1.5, 1.0].into() })]);
    let straight = |page: &Page| pieces(page).into_iter().filter(|piece| matches!(piece, Piece::Line { .. })).count();
    assert_eq!(straight(&drawn(&scene)), 9);
    scene.drawing.hidden = HiddenLines::Dashed;
    assert_eq!(straight(&drawn(&scene)), 12);
}

#[test]
fn the_same_line_is_drawn_once() {
    // Two boxes side by side share a face, whose edges both have; what is left of either is nowhere on the other.
    let cube = |x: f64| Shape::Box { min: [x, 0.0, 0.0].into(), max: [x + 1.0, 1.0, 1.0].into() };
    let page = drawn(&scene(vec![object("a", cube(-1.0)), object("b", cube(0.0))]));
    let paths = page.groups.iter().flat_map(|group| &group.items).filter_map(|item| match item {
        Item::Path(path) => Some(path),
        Item::Text(_) => None,
    });
    let mut segments = Vec::new();
    for subpath in paths.flat_map(|path| &path.subpaths) {
        let mut at = subpath.start;
        for piece in &subpath.pieces {
            let Piece::Line { to } = *piece else { continue };
            segments.push([at, to]);
            at = to;
        }
    }
    for (index, one) in segments.iter().enumerate() {
        let middle = [0.5 * (one[0][0] + one[1][0]), 0.5 * (one[0][1] + one[1][1])];
        let others = segments.iter().enumerate().filter(|(other, _)| *other != index);
        assert!(others.map(|(_, other)| distance(middle, *other)).all(|d| d > 0.01), "{one:?} is drawn twice");
    }
}

#[test]
fn the_same_bytes_from_any_number_of_threads() {
    let objects: Vec<Object> = shapes().into_iter().map(|(name, shape)| object(name, shape)).collect();
    let scene = scene(objects);
    let with = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("a pool");
        pool.install(|| encode_svg(&drawn(&scene)).expect("an SVG"))
    };
    let one = with(1);
    assert!(one == with(2) && one == with(7));
}

#[test]
fn degenerate_scenes_are_drawn_or_told() {
    let mut empty = scene(Vec::new());
    assert!(drawn(&empty).groups.is_empty());
    empty.camera.up = empty.camera.gaze;
    let compiled = CompiledScene::build(&empty).expect("it compiles");
    let error = draw(&compiled, &DrawingSettings::new(&empty)).expect_err("no upright");
    assert!(error.to_string().contains("parallel"), "{error}");
    // The eye in a corner, on a surface, inside, in the plane of an edge: something is drawn, and it is finite.
    let cube = Shape::Box { min: [-1.0; 3].into(), max: [1.0; 3].into() };
    for eye in [[1.0, 1.0, 1.0], [0.0, 1.0, 0.0], [0.1, 0.2, 0.3], [1.0, 1.0, 5.0], [0.0, 0.0, 1e6]] {
        for shape in [cube.clone(), ball([0.0; 3], 1.0), shapes().swap_remove(6).1] {
            let mut scene = scene(vec![object("thing", shape)]);
            scene.camera.eye = eye.into();
            scene.camera.gaze = Point3::new(0.01, 0.0, 0.02) - scene.camera.eye;
            encode_svg(&drawn(&scene)).expect("finite");
        }
    }
}
