//! What compilation refuses and folds.

use std::sync::Arc;

use snell_math::{Rgb, Vector3};
use snell_scene::Id;
use snell_scene::scene::texture::NoiseKind;
use snell_scene::scene::{Pattern, Space, Texture};

use super::{Builder, NASTY, at};
use crate::texture::{Background, RampError, TextureError, TextureImage, Textures, ViewProjection};

fn id(index: u32) -> Id<Texture> {
    Id::from_index(index)
}

fn noise(colors: [Id<Texture>; 2], octaves: u32) -> Pattern {
    Pattern::Noise { colors, octaves, kind: NoiseKind::Smooth, seed: 0 }
}

fn error(builder: &Builder) -> TextureError {
    Textures::compile(&builder.table, &builder.images).unwrap_err()
}

#[test]
fn compiled_textures_are_shared_by_threads() {
    fn shared<T: Send + Sync>() {}
    shared::<Textures>();
    shared::<Background>();
    shared::<ViewProjection>();
}

#[test]
fn cycles_are_refused_with_their_way_round() {
    let mut b = Builder::default();
    let a = b.constant(Rgb::WHITE);
    b.pattern(Space::Uv, Pattern::Checker([a, id(2)]));
    b.pattern(Space::Uv, noise([id(3), a], 1));
    b.pattern(Space::Uv, Pattern::Checker([id(2), a]));
    let cycle = error(&b);
    assert_eq!(cycle, TextureError::Cycle { path: vec![id(2), id(3)] });
    assert_eq!(cycle.to_string(), "texture #2 is made of itself: #2 → #3 → #2");
    assert_eq!(cycle.texture(), id(2));

    let mut b = Builder::default();
    b.pattern(Space::Uv, Pattern::Checker([id(0), id(0)]));
    assert_eq!(error(&b).to_string(), "texture #0 is made of itself: #0 → #0");

    // A long way round is found without deep recursion and told in short.
    let mut b = Builder::default();
    let count = 200_000;
    for i in 0..count {
        b.pattern(Space::Uv, Pattern::Checker([id((i + 1) % count); 2]));
    }
    assert!(error(&b).to_string().ends_with("#6 → #7 → … → #0"));
}

#[test]
fn later_entries_may_be_referred_to() {
    let mut b = Builder::default();
    let board = b.pattern(Space::Uv, Pattern::Checker([id(1), id(2)]));
    b.constant(Rgb::BLACK);
    b.constant(Rgb::WHITE);
    let textures = b.compile();
    assert_eq!(textures.evaluate(board, &at(0.5, 0.5, 0.0)), Rgb::BLACK);
    assert_eq!(textures.evaluate(board, &at(1.5, 0.5, 0.0)), Rgb::WHITE);
}

#[test]
fn nesting_is_limited() {
    let mut b = Builder::default();
    let (black, mut last) = (b.constant(Rgb::BLACK), b.constant(Rgb::WHITE));
    for _ in 1..32 {
        last = b.pattern(Space::Uv, Pattern::Checker([black, last]));
    }
    let textures = b.compile();
    assert_eq!(textures.evaluate(last, &at(1.5, 0.5, 0.0)), Rgb::WHITE);
    last = b.pattern(Space::Uv, Pattern::Checker([last, black]));
    assert_eq!(error(&b), TextureError::TooDeep { texture: last, depth: 33 });
}

#[test]
fn work_that_doubles_with_every_link_is_refused() {
    // Each evaluates both before it, so the k-th needs 2^k times the work of the first.
    let mut b = Builder::default();
    let mut pair = [b.constant(Rgb::BLACK), b.constant(Rgb::WHITE)];
    for _ in 0..30 {
        pair = [b.pattern(Space::Uv, noise(pair, 1)), b.pattern(Space::World, noise(pair, 1))];
    }
    assert!(matches!(error(&b), TextureError::TooCostly { cost, .. } if cost <= 2 * 1024 + 1));
    // Checkers evaluate one of two parts, so as many of them are no problem.
    let mut b = Builder::default();
    let mut pair = [b.constant(Rgb::BLACK), b.constant(Rgb::WHITE)];
    for _ in 0..30 {
        pair = [Space::Uv, Space::World].map(|space| b.pattern(space, Pattern::Checker(pair)));
    }
    assert!(b.compile().evaluate(pair[0], &at(0.5, 0.5, 0.5)).is_finite());
}

#[test]
fn what_is_not_there_is_named() {
    let mut b = Builder::default();
    let black = b.constant(Rgb::BLACK);
    b.pattern(Space::Uv, Pattern::Checker([black, id(9)]));
    assert_eq!(error(&b), TextureError::UnknownTexture { texture: id(1), refers_to: id(9), count: 2 });

    let mut b = Builder::default();
    b.image(2, 2);
    let image = Id::from_index(1);
    b.pattern(Space::Uv, Pattern::Image { image, repeat: true, smooth: true });
    assert_eq!(error(&b).to_string(), "texture #0 refers to picture #1, but the scene has 1");
}

#[test]
fn bad_numbers_are_refused() {
    let refused = |pattern: Pattern| {
        let mut b = Builder::default();
        b.constant(Rgb::BLACK);
        b.constant(Rgb::WHITE);
        b.pattern(Space::Object, pattern);
        error(&b)
    };
    let gradient = |axis, stops| Pattern::Gradient { axis, stops, repeat: false };
    let stops = vec![(0.0, Rgb::BLACK), (1.0, Rgb::WHITE)];
    assert_eq!(refused(Pattern::Constant(Rgb::gray(f32::INFINITY))), TextureError::BadColor { texture: id(2) });
    for length in [0.0, 1e-170, 1e170, f64::NAN, f64::INFINITY] {
        let axis = Vector3::new(0.0, length, 0.0);
        assert_eq!(refused(gradient(axis, stops.clone())), TextureError::BadAxis { texture: id(2) }, "{length}");
    }
    let reason = RampError::Empty;
    assert_eq!(refused(gradient(Vector3::X, vec![])), TextureError::BadGradient { texture: id(2), reason });
    for octaves in [0, 17, u32::MAX] {
        let expected = TextureError::BadOctaves { texture: id(2), octaves };
        assert_eq!(refused(noise([id(0), id(1)], octaves)), expected);
    }
}

/// Whatever is folded to a constant gives that constant everywhere, and has to: by the definition of the pattern.
#[test]
fn what_folds_is_constant_and_what_varies_does_not_fold() {
    let color = Rgb::new(0.1, 0.7, 0.3);
    let mut b = Builder::default();
    b.images.push(Arc::new(TextureImage::new(3, 2, vec![color; 6]).unwrap()));
    b.image(2, 2);
    let image = |index| Pattern::Image { image: Id::from_index(index), repeat: true, smooth: true };
    let gradient = |end| Pattern::Gradient { axis: Vector3::X, stops: vec![(0.0, color), (1.0, end)], repeat: false };
    let [one, same, other] = [color, color, Rgb::WHITE].map(|color| b.constant(color));
    let folding = [
        one,
        b.pattern(Space::World, Pattern::Checker([one, same])),
        b.pattern(Space::World, noise([one, same], 3)),
        b.pattern(Space::Uv, image(0)),
        b.pattern(Space::Object, gradient(color)),
    ];
    // Folds reach through what has been folded.
    let nested = b.pattern(Space::Object, Pattern::Checker([folding[1], folding[2]]));
    let varying = [
        b.pattern(Space::World, Pattern::Checker([one, other])),
        b.pattern(Space::World, noise([one, other], 3)),
        b.pattern(Space::Uv, image(1)),
        b.pattern(Space::Object, gradient(Rgb::WHITE)),
    ];
    // Of one varying part twice, the pattern around it vanishes.
    let twice = b.pattern(Space::Object, Pattern::Checker([varying[1], varying[1]]));
    let textures = b.compile();
    assert_eq!((textures.len(), textures.is_empty()), (b.table.len(), false));
    for id in folding.into_iter().chain([nested]) {
        assert!(textures.is_constant(id));
        assert_eq!(textures.constant(id), Some(color));
        for (x, y) in NASTY.iter().flat_map(|x| NASTY.iter().map(move |y| (*x, *y))) {
            assert_eq!(textures.evaluate(id, &at(x, y, 0.3)), color);
        }
    }
    for id in varying {
        assert_eq!(textures.constant(id), None);
        let first = textures.evaluate(id, &at(0.1, 0.2, 0.3));
        assert!((1..20).any(|i| textures.evaluate(id, &at(0.1 + 0.37 * f64::from(i), 0.2, 0.3)) != first), "{id:?}");
    }
    for i in 0..20 {
        let at = at(0.3 * f64::from(i), 1.0, 0.0);
        assert_eq!(textures.evaluate(twice, &at), textures.evaluate(varying[1], &at));
    }
}
