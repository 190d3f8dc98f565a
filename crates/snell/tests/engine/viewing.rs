//! The viewing pipeline against points that another library has projected.
//!
//! The table is by OpenGL's convention, whose canonical z is −1 at the near plane and 1 at the far one: ours has the other sign.
//! Its library has kept the four numbers of each projection in single precision, so the volumes here are those that the rounded
//! numbers stand for; that they are no more than rounded is checked too.

use snell::camera::Camera;
use snell::math::{Point3, portable};
use snell::scene::scene::{self, Frame, PixelGrid};
use snell::viewing::{Pipeline, PointStages, Projection, Rectangle, ViewVolume, view_axes};

/// A line of the table.
struct Row {
    camera: u32,
    eye: Point3,
    look_at: Point3,
    up: [f64; 3],
    fov: f64,
    aspect: f64,
    planes: [f64; 2],
    world: Point3,
    in_eye_space: [f64; 3],
    clip: [f64; 4],
    canonical: [f64; 3],
    raster: [f64; 2],
    size: [u32; 2],
    inside: bool,
}

fn rows(table: &str) -> Vec<Row> {
    let row = |line: &str| {
        let mut words = line.split(',');
        let mut next = || words.next().expect(line);
        let mut numbers = [0.0; 31];
        numbers.iter_mut().for_each(|number| *number = next().parse().expect(line));
        let [camera, rest @ ..] = numbers;
        let at = |k: usize| Point3::new(rest[k], rest[k + 1], rest[k + 2]);
        Row {
            camera: camera as u32,
            eye: at(0),
            look_at: at(3),
            up: at(6).to_array(),
            fov: portable::radians(rest[9]),
            aspect: rest[10],
            planes: [-rest[11], -rest[12]],
            world: at(13),
            in_eye_space: at(16).to_array(),
            clip: [rest[19], rest[20], -rest[21], rest[22]],
            canonical: [rest[23], rest[24], -rest[25]],
            raster: [rest[26], rest[27]],
            size: [rest[28] as u32, rest[29] as u32],
            inside: next() == "True",
        }
    };
    table.lines().skip(2).map(row).collect()
}

/// A number to single precision and back.
fn single(x: f64) -> f64 {
    f64::from(x as f32)
}

/// What the table's library has taken for the cotangents of half the angles of view in x and y: read off the point of the camera
/// that shows it best.
fn cotangents(rows: &[Row], camera: u32) -> [f64; 2] {
    [0, 1].map(|axis| {
        let of_camera = rows.iter().filter(|row| row.camera == camera);
        let best = of_camera.max_by(|a, b| a.in_eye_space[axis].abs().total_cmp(&b.in_eye_space[axis].abs()));
        let row = best.expect("the camera has points");
        let seen = single(row.clip[axis] / row.in_eye_space[axis]);
        let exact = 1.0 / portable::tan(0.5 * row.fov) / if axis == 0 { row.aspect } else { 1.0 };
        assert!((seen / exact - 1.0).abs() < 2.0 * f64::from(f32::EPSILON), "{seen} is more than rounded: {exact}");
        seen
    })
}

fn pipeline(row: &Row, [x, y]: [f64; 2], shift: f64) -> Pipeline {
    let [n, f] = row.planes;
    let (a, b) = (single((f + n) / (n - f)), single(2.0 * f * n / (f - n)));
    let (near, far) = (-b / (a - 1.0), -b / (a + 1.0));
    assert!((near / n - 1.0).abs() < 1e-4 && (far / f - 1.0).abs() < 1e-2, "{near} {far}");
    let (right, top) = (-near / x, -near / y);
    let volume = ViewVolume { window: Rectangle::new(-right, right, -top, top), near, far };
    let eye = Point3::new(row.eye.x() + shift, row.eye.y(), row.eye.z());
    let axes = view_axes(row.look_at - row.eye, row.up.into()).expect("not degenerate");
    Pipeline::new(eye, axes, Projection::Perspective, &volume, row.size).expect("in order")
}

/// The largest difference between the table and our stages, relative to sizes above 1.
fn difference(row: &Row, stages: &PointStages) -> f64 {
    let mut pairs: Vec<(f64, f64)> = stages.eye.to_array().into_iter().zip(row.in_eye_space).collect();
    // Their h is the depth, ours n times as much: the same point.
    let scale = row.clip[3] / stages.clip.h();
    pairs.extend(stages.clip.to_array().into_iter().map(|c| c * scale).zip(row.clip));
    if let (Ok(canonical), Ok(pixel)) = (&stages.canonical, &stages.pixel) {
        pairs.extend(canonical.to_array().into_iter().zip(row.canonical));
        let height = f64::from(row.size[1]);
        pairs.extend([pixel.x() + 0.5, height - 0.5 - pixel.y()].into_iter().zip(row.raster));
    }
    pairs.into_iter().map(|(ours, theirs)| (ours - theirs).abs() / theirs.abs().max(1.0)).fold(0.0, f64::max)
}

#[test]
fn every_point_of_the_reference_table() {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/../../../shared/reference/viewing_points.csv");
    let Ok(table) = std::fs::read_to_string(path) else {
        println!("skipped: {path} is absent");
        return;
    };
    let rows = rows(&table);
    assert!(rows.len() > 30, "{} points", rows.len());
    for row in &rows {
        let cotangents = cotangents(&rows, row.camera);
        let stages = pipeline(row, cotangents, 0.0).follow(row.world);
        let off = difference(row, &stages);
        assert!(off < 1e-9, "{off} at {:?}", row.world);
        assert_eq!(stages.outside.is_empty(), row.inside, "{:?}", row.world);
        // The twin: a camera that stands a little beside.
        assert!(difference(row, &pipeline(row, cotangents, 1e-6).follow(row.world)) > 1e-9, "{:?}", row.world);

        // The tracer's camera is the same one, as far as single precision goes.
        let description = scene::Camera {
            eye: row.eye,
            gaze: row.look_at - row.eye,
            up: row.up.into(),
            frame: Frame::VerticalFov(row.fov),
            lens: None,
        };
        let camera = Camera::new(&description, row.size[0], row.size[1], PixelGrid::Centers).expect("not degenerate");
        if let Some(drawn) = camera.project(row.world) {
            let far = row.raster.into_iter().map(f64::abs).fold(1e3, f64::max);
            assert!((drawn.x - row.raster[0]).abs().max((drawn.y - row.raster[1]).abs()) < 1e-6 * far, "{drawn:?}");
        }
    }
}
