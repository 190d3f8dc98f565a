//! What scene files mean: the scenes that they become, number by number.

use snell_math::{Dispersion, Point3, Rgb, Vector3};
use snell_scene::Scene;
use snell_scene::assets::MemoryAssets;
use snell_scene::document::read_scene;
use snell_scene::scene::{
    Align, Antialiasing, AxesLength, AxisPlace, Background, CsgOperation, CurveKind, Drawing, Extent, Falloff, Frame,
    HiddenLines, LightKind, ObjectKind, Pattern, PlotFit, Shape, Space, Ticks,
};

fn read(text: &str) -> Scene {
    read_with(text, &[])
}

fn read_with(text: &str, sets: &[&str]) -> Scene {
    let assets = MemoryAssets::default().with("dir/wood.png", b"wood").with("dir/sky.hdr", b"sky");
    let sets: Vec<String> = sets.iter().map(|set| (*set).to_owned()).collect();
    let (scene, diagnostics) = read_scene("dir/scene.toml", text.as_bytes(), &assets, &sets);
    scene.unwrap_or_else(|| panic!("{:#?}", diagnostics.list))
}

fn kind(scene: &Scene) -> &ObjectKind {
    &scene.objects[0].kind
}

fn close(a: Point3, b: [f64; 3]) -> bool {
    a.distance(b.into()) < 1e-12
}

#[test]
fn the_example_of_the_design_is_a_scene() {
    let scene = read(
        r#"
        [image]
        width = 640
        height = 480
        [camera]
        eye = [0, 2, 7]
        look_at = [0, 1, 0]
        fov = 40
        [background]
        gradient = { horizon = [0.8, 0.9, 1.0], zenith = [0.2, 0.4, 0.8] }
        [[light]]
        name = "key"
        point = { position = [6, 9, 5], intensity = 1, falloff = "none" }
        [material.floor]
        diffuse = { checker = { colors = [0.9, 0.1], size = 1 } }
        [material.glass]
        dielectric = { ior = "N-BK7" }
        [[object]]
        plane = { y = 0 }
        material = "floor"
        [[object]]
        name = "bubble"
        material = "glass"
        difference = [
          { sphere = { radius = 1.0 } },
          { sphere = { radius = 0.9 } },
        ]
        translate = [0, 1, 0]
        "#,
    );
    assert_eq!(scene.camera.eye, Point3::new(0.0, 2.0, 7.0));
    assert_eq!(scene.camera.gaze, Vector3::new(0.0, -1.0, -7.0));
    let Frame::HorizontalFov(fov) = scene.camera.frame else { panic!() };
    assert!((fov - 40.0 * std::f64::consts::PI / 180.0).abs() < 1e-15);
    let Background::Gradient(stops) = &scene.background else { panic!() };
    assert_eq!(stops[2], (1.0, Rgb::new(0.2, 0.4, 0.8)));
    assert_eq!(scene.lights[0].falloff, Falloff::None);
    assert_eq!(scene.objects.len(), 2);
    assert_eq!(scene.materials[scene.objects[1].material.unwrap()].name.as_deref(), Some("glass"));
    let ObjectKind::Csg { operation: CsgOperation::Difference, parts } = &scene.objects[1].kind else { panic!() };
    assert_eq!(parts.len(), 2);
    assert!(parts.iter().all(|part| part.material.is_none()));
    assert!(close(scene.objects[1].parent_from_object.point(Point3::ORIGIN), [0.0, 1.0, 0.0]));
    assert_eq!(scene.settings, snell_scene::scene::Settings::default());
}

#[test]
fn an_empty_file_is_an_empty_scene() {
    let scene = read("");
    assert!(scene.objects.is_empty() && scene.lights.is_empty());
    assert_eq!(scene.background, Background::Color(Rgb::BLACK));
    let default = snell_scene::scene::Camera::default();
    assert_eq!((scene.camera.eye, scene.camera.frame), (default.eye, default.frame));
    assert_eq!(scene.camera.gaze.normalize(), default.gaze);
}

#[test]
fn transforms_scale_then_rotate_about_x_y_z_then_move() {
    let scene = read("[[object]]\nsphere = {}\ntranslate = [1, 2, 3]\nrotate = [90, 0, 90]\nscale = [2, 3, 4]\n");
    let at = |p: [f64; 3]| scene.objects[0].parent_from_object.point(p.into());
    assert!(close(at([1.0, 0.0, 0.0]), [1.0, 4.0, 3.0]));
    // y: to 3 along y, about x to z, about z it stays.
    assert!(close(at([0.0, 1.0, 0.0]), [1.0, 2.0, 6.0]));
    // z: to 4 along z, about x to −y, about z to x.
    assert!(close(at([0.0, 0.0, 1.0]), [5.0, 2.0, 3.0]));
    let axis = read("[[object]]\nsphere = {}\nrotate = { axis = [1, 1, 1], angle = 120 }\n");
    assert!(close(axis.objects[0].parent_from_object.point(Point3::new(1.0, 0.0, 0.0)), [0.0, 1.0, 0.0]));
}

#[test]
fn cameras_have_all_their_frames() {
    let frame = |keys: &str| read(&format!("[camera]\n{keys}")).camera.frame;
    assert_eq!(frame("width = 3"), Frame::OrthographicWidth(3.0));
    assert_eq!(frame("projection = \"orthographic\""), Frame::OrthographicWidth(4.0));
    assert!(
        matches!(frame("vertical_fov = 90"), Frame::VerticalFov(a) if (a - std::f64::consts::FRAC_PI_2).abs() < 1e-15)
    );
    let window = "window = { left = -1, right = 2, bottom = -3, top = 4, near = -5, far = -6 }";
    let (left, right, bottom, top, near, far) = (-1.0, 2.0, -3.0, 4.0, -5.0, -6.0);
    assert_eq!(frame(window), Frame::PerspectiveWindow { left, right, bottom, top, near, far });
    let orthographic = format!("projection = \"orthographic\"\n{window}");
    assert_eq!(frame(&orthographic), Frame::OrthographicWindow { left, right, bottom, top, near, far });
}

#[test]
fn lights_have_colour_intensity_falloff_and_angles() {
    let scene = read(
        "[[light]]\nspot = { position = [0, 4, 0], look_at = [0, 0, 0], cone_angle = 45, color = [1, 0.5, 0], intensity = 2, falloff = { quadratic = 1 } }\n[[light]]\ndirectional = { direction = [0, -2, 0] }\n",
    );
    let spot = &scene.lights[0];
    assert_eq!(spot.intensity, Rgb::new(2.0, 1.0, 0.0));
    assert_eq!(spot.falloff, Falloff::Polynomial { constant: 1.0, linear: 0.0, quadratic: 1.0 });
    let LightKind::Spot { direction, cone_angle, full_angle, .. } = spot.kind else { panic!() };
    assert_eq!(direction, Vector3::new(0.0, -4.0, 0.0));
    assert!((cone_angle - std::f64::consts::FRAC_PI_4).abs() < 1e-15);
    assert!((full_angle - 0.8 * cone_angle).abs() < 1e-15);
    assert_eq!(scene.lights[1].kind, LightKind::Directional { direction: Vector3::new(0.0, -2.0, 0.0), angle: 0.0 });
}

#[test]
fn materials_have_their_media_and_indices() {
    let scene = read(
        r#"
        [material.a]
        dielectric = { ior = "Rock-Salt", absorption = { color = [0.5, 1, 0.25], distance = 2 }, scattering = { distance = 0.5, color = [1, 0.5, 0], anisotropy = 0.3 }, priority = -3 }
        [material.b]
        dielectric = { ior = { cauchy = [1.5, 0.004] }, fresnel = false, reflect = 0.1, transmit = [0.9, 0.8, 0.7] }
        [[object]]
        group = [{ sphere = {}, material = "a" }, { sphere = {}, material = "b" }]
        "#,
    );
    let mut materials = scene.materials.iter();
    let a = materials.next().unwrap().dielectric.clone().unwrap();
    assert_eq!(a.ior, Dispersion::Constant(1.516));
    // Half of the red light is left after a distance of 2: exp(−2 a) = 1/2.
    assert!((a.medium.absorption.r - 0.5 * std::f32::consts::LN_2).abs() < 1e-7);
    assert_eq!(a.medium.absorption.g, 0.0);
    assert!((a.medium.absorption.b - std::f32::consts::LN_2).abs() < 1e-7);
    assert_eq!(a.medium.scattering, Rgb::new(2.0, 1.0, 0.0));
    assert_eq!((a.medium.anisotropy, a.priority, a.fresnel), (0.3, -3, true));
    let b = materials.next().unwrap().dielectric.clone().unwrap();
    assert_eq!(b.ior, Dispersion::Cauchy(vec![1.5, 0.004]));
    assert_eq!(scene.textures[b.transmit].pattern, Pattern::Constant(Rgb::new(0.9, 0.8, 0.7)));
}

#[test]
fn textures_nest_and_are_placed() {
    let scene = read(
        r#"
        [texture.wood]
        image = { file = "wood.png" }
        [material.m]
        diffuse = { checker = { colors = [{ texture = "wood" }, "black"], size = 2 }, translate = [1, 0, 0] }
        [[object]]
        sphere = {}
        material = "m"
        "#,
    );
    let diffuse = &scene.textures[scene.materials[scene.objects[0].material.unwrap()].diffuse.unwrap()];
    let Pattern::Checker([wood, _]) = diffuse.pattern else { panic!() };
    let wood = &scene.textures[wood];
    assert_eq!((wood.mapping.space, diffuse.mapping.space), (Space::Uv, Space::Object));
    let Pattern::Image { image, repeat: true, smooth: true } = wood.pattern else { panic!() };
    assert_eq!((&*scene.images[image].bytes, &*scene.images[image].name), (&b"wood"[..], "dir/wood.png"));
    assert!(close(diffuse.mapping.texture_from_space.point(Point3::new(3.0, 0.0, 0.0)), [1.0, 0.0, 0.0]));
}

#[test]
fn objects_without_a_material_can_be_seen() {
    let scene = read(
        "[prototype.p]\nsphere = {}\n[[object]]\ngroup = [{ sphere = {} }, { instance = \"p\" }]\n[[object]]\nunion = [{ sphere = {} }]\n",
    );
    let ObjectKind::Group(parts) = kind(&scene) else { panic!() };
    let material = parts[0].material.unwrap();
    assert_eq!(parts[1].material, Some(material));
    assert_eq!(scene.objects[1].material, Some(material));
    let diffuse = scene.materials[material].diffuse.unwrap();
    assert_eq!(scene.textures[diffuse].pattern, Pattern::Constant(Rgb::gray(0.8)));
    assert!(scene.prototypes.iter().next().unwrap().objects[0].material.is_none());
}

#[test]
fn grids_and_instances_are_kept_as_they_are() {
    let scene = read(
        "[prototype.b]\ninstance = \"a\"\n[prototype.a]\nsphere = {}\n[[object]]\ngrid = { count = [3, 1, 2], step = { z = [0.5, 0, 1] }, of = { instance = \"b\" } }\n",
    );
    let names: Vec<&str> = scene.prototypes.iter().map(|prototype| &*prototype.name).collect();
    assert_eq!(names, ["a", "b"], "what is placed comes before what places it");
    let ObjectKind::Grid(grid) = kind(&scene) else { panic!() };
    assert_eq!(grid.count, [3, 1, 2]);
    assert_eq!(grid.step, [Vector3::X, Vector3::Y, Vector3::new(0.5, 0.0, 1.0)]);
}

#[test]
fn polygons_become_triangles_and_meshes_are_fitted() {
    let scene = read(
        "[[object]]\nmesh = { vertices = [[0, 0, 0], [4, 0, 0], [4, 2, 0], [0, 2, 0], [0, 0, 1]], faces = [[0, 1, 2, 3], [0, 1, 4]], fit = 1 }\n",
    );
    let ObjectKind::Shape(Shape::Mesh(mesh)) = kind(&scene) else { panic!() };
    assert_eq!(scene.meshes[*mesh].triangles, [[0, 1, 2], [0, 2, 3], [0, 1, 4]]);
    let at = |p: [f64; 3]| scene.objects[0].parent_from_object.point(p.into());
    assert!(close(at([0.0, 0.0, 0.0]), [-0.5, 0.0, -0.125]));
    assert!(close(at([4.0, 2.0, 1.0]), [0.5, 0.5, 0.125]));
}

/// Two squares that meet at a right angle.
fn corner(smooth: f64) -> Scene {
    read(&format!(
        "[[object]]\nmesh = {{ vertices = [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0], [0, 0, 1], [1, 0, 1]], faces = [[0, 1, 2, 3], [0, 4, 5, 1]], smooth = {smooth} }}\n"
    ))
}

#[test]
fn smoothing_keeps_sharp_edges() {
    let sharp = corner(60.0);
    let mesh = sharp.meshes.iter().next().unwrap();
    assert_eq!(mesh.positions.len(), 8, "the two vertices of the edge are doubled");
    assert!(mesh.normals.iter().all(|n| *n == [0.0, 0.0, 1.0] || *n == [0.0, 1.0, 0.0]), "{:?}", mesh.normals);
    let round = corner(120.0);
    let mesh = round.meshes.iter().next().unwrap();
    assert_eq!(mesh.positions.len(), 6);
    let edge = mesh.positions.iter().position(|p| *p == [0.0; 3]).unwrap();
    let half = std::f32::consts::FRAC_1_SQRT_2;
    let [x, y, z] = mesh.normals[edge];
    assert!(x.abs() < 1e-6 && (y - half).abs() < 1e-6 && (z - half).abs() < 1e-6, "the mean by angles: {x} {y} {z}");
}

#[test]
fn values_are_set_from_outside() {
    let text = "[[light]]\nname = \"key\"\npoint = { position = [0, 1, 0] }\n[[object]]\nname = \"ball\"\nsphere = {}\n[material.\"my clay\"]\ndiffuse = 1\n[[object]]\nsphere = {}\nmaterial = \"my clay\"\n";
    let scene = read_with(
        text,
        &[
            "camera.fov = 90",
            "light.key.point.intensity=3",
            "object.0.sphere.radius=2.5",
            "object.ball.translate=[0, 1, 0]",
            "object.ball.translate.0=4",
            "material.\"my clay\".diffuse=tomato",
            "render.antialiasing=16",
            "background.color=#fff",
            "ambient=0.5",
        ],
    );
    assert!(matches!(scene.camera.frame, Frame::HorizontalFov(a) if (a - std::f64::consts::FRAC_PI_2).abs() < 1e-15));
    assert_eq!(scene.lights[0].intensity, Rgb::gray(3.0));
    assert!(matches!(kind(&scene), ObjectKind::Shape(Shape::Sphere { radius, .. }) if *radius == 2.5));
    assert!(close(scene.objects[0].parent_from_object.point(Point3::ORIGIN), [4.0, 1.0, 0.0]));
    assert_eq!(scene.settings.antialiasing, Antialiasing::Samples(16));
    assert_eq!(scene.background, Background::Color(Rgb::WHITE));
    assert_eq!(scene.ambient, Rgb::gray(0.5));
}

#[test]
fn json_says_the_same() {
    let toml = read("ambient = 0.5\n[[object]]\nname = \"ä\\\"\"\nsphere = { radius = 2e0 }\nscale = -1\n");
    let json = br#"{ "$schema": "scene.schema.json", "ambient": 0.5,
        "object": [ { "name": "\u00e4\"", "sphere": { "radius": 2e0 }, "scale": -1 } ] }"#;
    let (json, diagnostics) = read_scene("a.json", json, &MemoryAssets::default(), &[]);
    let json = json.unwrap_or_else(|| panic!("{:#?}", diagnostics.list));
    let without_span = |scene: &Scene| {
        let object = &scene.objects[0];
        format!("{:?} {:?} {:?} {:?}", scene.ambient, object.name, object.kind, object.parent_from_object)
    };
    assert_eq!(without_span(&toml), without_span(&json));
}

#[test]
fn drawings_have_their_marks() {
    let scene = read_with(
        r#"
        [image]
        width = 300
        height = 200
        [drawing]
        axes = true
        crease_angle = 180
        ground_grid = { spacing = 0.5 }
        viewport = [0.25, 0.75, 0.5, 1]
        [[drawing.point]]
        label = "*P*"
        position = [1, 2, 3]
        [[drawing.line]]
        points = [[0, 0, 0], [1, 0, 0], [1, 1, 0]]
        project_to = "second"
        [[drawing.grid]]
        corner = [0, 0, 0]
        edges = [[4, 0, 0], [0, 3, 0]]
        count = [8, 6]
        [[drawing.camera]]
        view = { eye = [0, 0, 8] }
        [[drawing.camera]]
        name = "second"
        view = { gaze = [0, 0, -1], projection = "orthographic", window = { left = -2, right = 2, bottom = -1, top = 1, near = -3 } }
        [[drawing.camera]]
        view = { gaze = [0, 0, -1] }
        near = -5
        pixels = [4, 3]
        "#,
        &["drawing.hidden=dashed", "drawing.camera.second.frustum=false"],
    );
    let drawing = scene.drawing;
    assert_eq!((drawing.hidden, drawing.axes), (HiddenLines::Dashed, Some(AxesLength::Fitting)));
    assert_eq!(drawing.crease_angle, std::f64::consts::PI);
    assert_eq!(drawing.viewport, Extent { left: 0.25, right: 0.75, bottom: 0.5, top: 1.0 });
    assert_eq!(drawing.points[0].position, Point3::new(1.0, 2.0, 3.0));
    assert_eq!((drawing.lines[0].points.len(), drawing.lines[0].project_to), (3, Some(1)));
    assert_eq!((drawing.grids[0].count, drawing.grids[0].edges[1]), ([8, 6], Vector3::new(0.0, 3.0, 0.0)));
    let volumes: Vec<_> = drawing.cameras.iter().map(|camera| (camera.aspect, camera.near, camera.far)).collect();
    assert_eq!(volumes, [(1.5, -2.0, -12.0), (2.0, -3.0, -6.0), (4.0 / 3.0, -5.0, -10.0)]);
    let frusta: Vec<bool> = drawing.cameras.iter().map(|camera| camera.frustum).collect();
    assert_eq!(frusta, [true, false, true]);
    assert_eq!(read("").drawing, Drawing::default());
    let length = read_with("", &["drawing.axes=2.5"]).drawing.axes;
    assert_eq!(length, Some(AxesLength::Length(2.5)));
}

#[test]
fn plots_have_windows_axes_and_curves() {
    let scene = read_with(
        r#"
        [[plot]]
        name = "wave"
        window = [0, "2*pi", -1, 1]
        x = { pi = true, ticks = ["pi/2", { at = "pi", label = "half" }], arrow = true }
        y = { every = "1/2", at = "border" }
        [[plot.curve]]
        function = { y = "cos(x)" }
        [[plot.curve]]
        parametric = { x = "cos(t)", y = "sin(t)", to = "2*pi" }
        fill = "white"
        [[plot.curve]]
        data = { points = [[0, 1], [2, 3]], line = false, marks = true }
        [[plot.label]]
        at = ["pi", 0.5]
        text = "*M*_v"
        align = "left"
        "#,
        &["plot.wave.fit=keep"],
    );
    use std::f64::consts::{FRAC_PI_2, PI, TAU};
    let [plot] = scene.plots.as_slice() else { panic!() };
    assert_eq!(plot.window, Extent { left: 0.0, right: TAU, bottom: -1.0, top: 1.0 });
    assert_eq!((plot.viewport, plot.fit), (Extent::UNIT, PlotFit::Keep));
    assert_eq!(plot.x.ticks, Ticks::At(vec![(FRAC_PI_2, None), (PI, Some("half".to_owned()))]));
    assert_eq!((&plot.y.ticks, plot.y.at, plot.x.at), (&Ticks::Every(0.5), AxisPlace::Border, AxisPlace::At(0.0)));
    assert!(plot.x.pi && plot.x.arrow && !plot.y.pi && plot.y.show);
    let CurveKind::Function { y, from: 0.0, to: TAU } = &plot.curves[0].kind else { panic!() };
    assert_eq!(y.evaluate(0.0), 1.0);
    let CurveKind::Parametric { x, y, from: 0.0, to: TAU } = &plot.curves[1].kind else { panic!() };
    assert_eq!((x.evaluate(0.0), y.evaluate(0.0), plot.curves[1].fill), (1.0, 0.0, Some(Rgb::WHITE)));
    let CurveKind::Data { points, closed: false, line: false, marks: true } = &plot.curves[2].kind else { panic!() };
    assert_eq!(points, &[[0.0, 1.0], [2.0, 3.0]]);
    assert_eq!((plot.labels[0].at, plot.labels[0].align), ([PI, 0.5], Align::Left));
}
