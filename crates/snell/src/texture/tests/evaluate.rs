//! Patterns on surfaces: spaces, mappings, borders, nesting, and coordinates that are no numbers.

use std::sync::Arc;

use proptest::prelude::*;
use snell_math::{Normal3, Point3, Rgb, Transform, Vector3};
use snell_scene::Id;
use snell_scene::scene::texture::NoiseKind;
use snell_scene::scene::{Pattern, Space};

use super::{Builder, NASTY, at};
use crate::texture::{Footprint, TextureCoordinates};

/// Colours seen on points of the plane with a normal and through a point, whose coordinates carry rounding errors.
fn colors_on_face(
    b: &Builder,
    texture: Id<snell_scene::scene::Texture>,
    world_from_object: &Transform,
    inset: bool,
) -> Vec<Rgb> {
    let textures = b.compile();
    let mut colors = Vec::new();
    // One cell of the checker, x in (4, 5) and z in (7, 8), on the face y = 3 of object space.
    for (i, j) in (1..40).flat_map(|i| (1..40).map(move |j| (i, j))) {
        let on_face = Point3::new(4.0 + f64::from(i) / 40.3, 3.0, 7.0 + f64::from(j) / 40.7);
        let world = world_from_object.point(on_face);
        let normal = world_from_object.normal(Normal3::new(0.0, 1.0, 0.0)).normalize();
        // A hit is off by a few roundings of its coordinates, up or down.
        let wobble = f64::from((i * 7 + j * 13) % 5 - 2) * 2e-16 * world.max_abs();
        let world = world + normal.as_vector() * wobble;
        let mut at = TextureCoordinates::new(world, normal, wobble.abs(), [0.0; 2], world_from_object);
        if !inset {
            at.object_inside = Vector3::ZERO;
        }
        colors.push(textures.evaluate(texture, &at));
    }
    colors
}

#[test]
fn a_face_on_the_border_of_cells_is_not_speckled() {
    let mut b = Builder::default();
    let board = b.checker(Space::Object);
    let mut speckled = 0;
    for world_from_object in [
        Transform::IDENTITY,
        Transform::rotate(Vector3::new(0.6, 0.0, 0.8), 0.7),
        Transform::translate(Vector3::new(1e5, -3e4, 77.7)) * Transform::rotate(Vector3::X, 2.0),
        Transform::rotate(Vector3::Y, 1.0) * Transform::scale(Vector3::new(1e-4, 3e-4, 2e-4)),
        Transform::scale(Vector3::new(1e6, -1e6, 1e6)) * Transform::rotate(Vector3::Z, 0.1),
    ] {
        let colors = colors_on_face(&b, board, &world_from_object, true);
        // Inside is below y = 3: the cell (4, 2, 7), odd.
        assert!(colors.iter().all(|color| *color == Rgb::WHITE), "{world_from_object:?}");
        // The twin: at the points themselves both cells are seen.
        let colors = colors_on_face(&b, board, &world_from_object, false);
        speckled += u32::from(colors.contains(&Rgb::WHITE) && colors.contains(&Rgb::BLACK));
    }
    assert!(speckled >= 4, "only {speckled} planted speckles were seen");
}

#[test]
fn borders_moved_by_a_mapping_are_not_speckled_either() {
    // The mapping's own rounding is far larger than the error of a point near the origin.
    let mut b = Builder::default();
    let cells = [Rgb::BLACK, Rgb::WHITE].map(|color| b.constant(color));
    let far = Transform::rotate(Vector3::X, 0.9) * Transform::translate(Vector3::new(1e6, 2e6, -3e6));
    let board = b.mapped(Space::World, far, Pattern::Checker(cells));
    let textures = b.compile();
    let normal = far.inverse().vector(Vector3::Y);
    let colors: Vec<Rgb> = (0..1000)
        .map(|i| {
            let point = far.inverse_point(Point3::new(1e6 + 0.001 * f64::from(i), 2.0, 0.5));
            let at = TextureCoordinates::new(point, Normal3::from(normal), 0.0, [0.0; 2], &Transform::IDENTITY);
            textures.evaluate(board, &at)
        })
        .collect();
    assert!(colors.iter().all(|color| *color == colors[0]));
}

#[test]
fn each_space_has_its_own_point() {
    let mut b = Builder::default();
    let boards = [Space::Object, Space::World, Space::Uv].map(|space| b.checker(space));
    let textures = b.compile();
    let world_from_object = Transform::translate(Vector3::new(1.0, 0.0, 0.0));
    // World (2.5, .5, .5) is even; object (1.5, .5, .5) odd; uv (5.5, 5.5) even, whatever z would be.
    let up = Normal3::new(0.0, 1.0, 0.0);
    let at = TextureCoordinates::new(Point3::new(2.5, 0.5, 0.5), up, 0.0, [5.5, 5.5], &world_from_object);
    let colors = boards.map(|board| textures.evaluate(board, &at));
    assert_eq!(colors, [Rgb::WHITE, Rgb::BLACK, Rgb::BLACK]);
}

#[test]
fn flat_checkers_ignore_z_and_solid_ones_do_not() {
    let mut b = Builder::default();
    let cells = [Rgb::BLACK, Rgb::WHITE].map(|color| b.constant(color));
    let lift = Transform::translate(Vector3::new(0.0, 0.0, 1.5));
    let [flat, solid] = [Space::Uv, Space::World].map(|space| b.mapped(space, lift, Pattern::Checker(cells)));
    let textures = b.compile();
    assert_eq!(textures.evaluate(flat, &at(0.5, 0.5, 0.0)), Rgb::BLACK);
    assert_eq!(textures.evaluate(solid, &at(0.5, 0.5, 0.0)), Rgb::WHITE);
}

#[test]
fn pictures_stand_upright() {
    let mut b = Builder::default();
    let image = b.image(4, 3);
    let id = Id::from_index(0);
    for (repeat, smooth) in [(false, false), (false, true), (true, false), (true, true)] {
        let texture = b.pattern(Space::Uv, Pattern::Image { image: id, repeat, smooth });
        let textures = b.compile();
        for (x, y) in (0..3).flat_map(|y| (0..4).map(move |x| (x, y))) {
            // Row 0 is the top one: the largest v.
            let at = at((f64::from(x) + 0.5) / 4.0, 1.0 - (f64::from(y) + 0.5) / 3.0, 0.0);
            assert_eq!(textures.evaluate(texture, &at), image.pixel(x, y));
        }
    }
}

#[test]
fn footprints_grow_with_their_mapping() {
    let mut b = Builder::default();
    b.images.push(Arc::new(super::picture(8, 8).with_levels()));
    let pattern = || Pattern::Image { image: Id::from_index(0), repeat: true, smooth: true };
    let plain = b.pattern(Space::World, pattern());
    let scaled = b.mapped(Space::World, Transform::scale(Vector3::new(0.5, 0.5, 0.5)), pattern());
    let textures = b.compile();
    let square = |side: f64| [Vector3::X * side, Vector3::Y * side];
    let seen = |texture, place: f64, footprint: f64| {
        let footprint = Footprint { world: square(footprint), ..Footprint::SHARP };
        textures.evaluate(texture, &TextureCoordinates { footprint, ..at(place, place, 0.0) })
    };
    // A point and a footprint twice as large are the same under half the scale.
    assert_eq!(seen(plain, 0.2, 0.3), seen(scaled, 0.4, 0.6));
    assert_ne!(seen(plain, 0.2, 0.3), seen(scaled, 0.4, 0.3));
    assert_eq!(seen(plain, 0.2, f64::NAN), seen(plain, 0.2, 0.0));
    // Other spaces have their own.
    let other = TextureCoordinates {
        footprint: Footprint { object: square(9.0), uv: [[9.0; 2]; 2], ..Footprint::SHARP },
        ..at(0.2, 0.2, 0.0)
    };
    assert_eq!(textures.evaluate(plain, &other), seen(plain, 0.2, 0.0));
}

#[test]
fn a_gradient_runs_along_its_axis() {
    let mut b = Builder::default();
    let stops = vec![(0.0, Rgb::BLACK), (1.0, Rgb::WHITE)];
    let axis = Vector3::new(0.0, 3.0, 4.0);
    let [once, again] =
        [false, true].map(|repeat| b.pattern(Space::World, Pattern::Gradient { axis, stops: stops.clone(), repeat }));
    let textures = b.compile();
    for i in 0..10 {
        // Along the axis, and anywhere across it.
        let t = f64::from(i) / 10.0;
        let point = axis * t + Vector3::new(7.7, 0.0, 0.0) + Vector3::new(0.0, 4.0, -3.0) * 0.3;
        let [x, y, z] = point.to_array();
        assert!((f64::from(textures.evaluate(once, &at(x, y, z)).r) - t).abs() < 1e-6);
        let [x, y, z] = (point + axis * 6.001).to_array();
        assert!((f64::from(textures.evaluate(again, &at(x, y, z)).r) - t - 0.001).abs() < 1e-6);
        assert_eq!(textures.evaluate(once, &at(x, y, z)), Rgb::WHITE);
    }
}

#[test]
fn noise_mixes_textures_with_mappings_of_their_own() {
    let mut b = Builder::default();
    let [red, board] = [b.constant(Rgb::new(1.0, 0.0, 0.0)), b.checker(Space::Uv)];
    let pattern = |colors| Pattern::Noise { colors, octaves: 3, kind: NoiseKind::Turbulence, seed: 4 };
    let mixed = b.pattern(Space::World, pattern([red, board]));
    let gray = [Rgb::BLACK, Rgb::WHITE].map(|color| b.constant(color));
    let weight = b.pattern(Space::World, pattern(gray));
    let textures = b.compile();
    for i in 0..200 {
        let at = at(0.13 * f64::from(i), 0.7, -0.2);
        let [weight, board, mixed] = [weight, board, mixed].map(|texture| textures.evaluate(texture, &at));
        assert!((Rgb::new(1.0, 0.0, 0.0).lerp(board, weight.r) - mixed).max_abs() < 1e-6);
    }
}

/// A texture of every pattern, in a space.
fn zoo(b: &mut Builder, space: Space, map: Transform) -> Vec<Id<snell_scene::scene::Texture>> {
    let board = b.checker(space);
    let white = b.constant(Rgb::WHITE);
    b.image(3, 5);
    let mut patterns = vec![
        Pattern::Checker([board, white]),
        Pattern::Gradient { axis: Vector3::X, stops: vec![(0.0, Rgb::BLACK), (1.0, Rgb::WHITE)], repeat: true },
    ];
    for (repeat, smooth) in [(false, false), (false, true), (true, false), (true, true)] {
        patterns.push(Pattern::Image { image: Id::from_index(0), repeat, smooth });
    }
    for kind in [NoiseKind::Smooth, NoiseKind::Turbulence, NoiseKind::Marble, NoiseKind::Wood] {
        patterns.push(Pattern::Noise { colors: [board, white], octaves: 4, kind, seed: 1 });
    }
    patterns.into_iter().map(|pattern| b.mapped(space, map, pattern)).collect()
}

#[test]
fn nasty_coordinates_give_finite_colours() {
    let huge = Transform::scale(Vector3::new(1e150, 1e150, 1e150)) * Transform::translate(Vector3::new(0.1, 0.2, 0.3));
    let tiny = Transform::scale(Vector3::new(1e-90, 1e-90, 1e-90));
    let mut b = Builder::default();
    let mut ids = Vec::new();
    for (space, map) in [Space::Object, Space::World, Space::Uv].into_iter().flat_map(|s| [huge, tiny].map(|m| (s, m)))
    {
        ids.extend(zoo(&mut b, space, map));
    }
    let textures = b.compile();
    for (i, (x, y)) in NASTY.iter().flat_map(|x| NASTY.iter().map(move |y| (*x, *y))).enumerate() {
        let z = NASTY[i % NASTY.len()];
        let mut at = TextureCoordinates::new(Point3::new(x, y, z), Normal3::new(y, z, x), x, [y, z], &huge);
        let sides = [Vector3::new(x, y, z), Vector3::new(z, x, y)];
        at.footprint = Footprint { object: sides, world: sides, uv: [[x, y], [z, x]] };
        for id in &ids {
            assert!(textures.evaluate(*id, &at).is_finite(), "{id:?} at {at:?}");
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::default() })]

    /// A point moved together with its object keeps its colour in object space: but for rounding, so cells' middles are asked.
    #[test]
    fn patterns_move_with_their_object(x in -50..50i32, y in -50..50i32, z in -50..50i32, turn in -3.0..3.0f64, shift in -9.0..9.0f64) {
        let mut b = Builder::default();
        let board = b.checker(Space::Object);
        let textures = b.compile();
        let point = Point3::new(f64::from(x) + 0.5, f64::from(y) + 0.5, f64::from(z) + 0.5);
        let map = Transform::translate(Vector3::new(shift, 2.0, -shift)) * Transform::rotate(Vector3::Y, turn);
        let up = Normal3::new(0.0, 1.0, 0.0);
        let moved = TextureCoordinates::new(map.point(point), map.normal(up), 1e-15, [0.0; 2], &map);
        let expected = if (x + y + z).rem_euclid(2) == 0 { Rgb::BLACK } else { Rgb::WHITE };
        prop_assert_eq!(textures.evaluate(board, &moved), expected);
    }
}
