//! A scene on the stage: rays shot through the very loop that renders pictures, and the pictures themselves.

use snell::camera::Camera;
use snell::compile::CompiledScene;
use snell::image::Image;
use snell::integrator::{Rules, Whitted};
use snell::math::lanes::InstructionSet;
use snell::math::sampling;
use snell::math::{Normal3, Point3, Ray, Rgb, Vector3};
use snell::observe::{RayTree, TracedRay};
use snell::render::{NoProgress, PathSettings, RenderSettings, Rendering, render, render_paths};
use snell::scene::Scene;
use snell::scene::scene::Antialiasing;
use snell::statistics::Statistics;
use snell::task::{RayKind, Term};
use snell::trace::{Scratch, Tracer};

use crate::files::scene_of_text;

/// A compiled scene with its settings.
pub struct Stage {
    pub scene: CompiledScene,
    pub settings: RenderSettings,
}

impl Stage {
    /// From the text of a scene file. One ray a pixel, unless changed afterwards.
    ///
    /// # Panics
    /// Where the text has mistakes.
    #[track_caller]
    pub fn new(text: &str) -> Self {
        Self::of(&scene_of_text("test.toml", text.as_bytes()))
    }

    /// From a scene. One ray a pixel, unless changed afterwards.
    #[track_caller]
    pub fn of(scene: &Scene) -> Self {
        let settings = RenderSettings { antialiasing: Antialiasing::None, ..RenderSettings::from(&scene.settings) };
        Self { scene: CompiledScene::build(scene).expect("the scene compiles"), settings }
    }

    /// With a picture of that size.
    #[must_use]
    pub fn sized(mut self, width: u32, height: u32) -> Self {
        (self.settings.width, self.settings.height) = (width, height);
        self
    }

    /// Renders the picture.
    pub fn render(&self) -> Rendering {
        render(&self.scene, &self.settings, &NoProgress).expect("a camera")
    }

    /// The picture's colours.
    pub fn picture(&self) -> Image<Rgb> {
        self.render().image
    }

    /// The picture's colours by path tracing.
    pub fn picture_by_paths(&self, paths: &PathSettings) -> Image<Rgb> {
        render_paths(&self.scene, &self.settings, paths, &NoProgress).expect("a camera").image
    }

    /// Every pixel, from the top left.
    pub fn pixels(&self) -> impl Iterator<Item = [u32; 2]> {
        let (width, height) = (self.settings.width, self.settings.height);
        (0..height).flat_map(move |y| (0..width).map(move |x| [x, y]))
    }

    /// The rays of every pixel's first sample, from the top left.
    pub fn trees(&self) -> impl Iterator<Item = ([u32; 2], RayTree)> {
        self.trees_every(1)
    }

    /// The same in every `step`th column and row.
    pub fn trees_every(&self, step: u32) -> impl Iterator<Item = ([u32; 2], RayTree)> {
        let watch = self.watch();
        let [dx, dy] = sampling::pixel_sample(0);
        let kept = move |[x, y]: &[u32; 2]| x % step == 0 && y % step == 0;
        self.pixels().filter(kept).map(move |[x, y]| {
            let ray = watch.camera.generate_ray(f64::from(x) + dx, f64::from(y) + dy);
            ([x, y], watch.shoot(ray).0)
        })
    }

    /// Shoots one ray as if it came from the camera; its tree and the counts.
    pub fn shoot(&self, ray: Ray) -> (RayTree, Statistics) {
        self.watch().shoot(ray)
    }

    fn watch(&self) -> Watch<'_> {
        let camera = self.settings.camera(&self.scene).expect("a camera");
        let integrator = Whitted::new(&self.scene, &camera, self.settings.bands);
        Watch { stage: self, camera, integrator }
    }

    /// Shoots a ray from a point in a direction of any length.
    pub fn ray(&self, origin: [f64; 3], direction: [f64; 3]) -> RayTree {
        self.shoot(Ray::new(Point3::from(origin), Vector3::from(direction).normalize())).0
    }

    /// The colour that a ray sees.
    pub fn color(&self, origin: [f64; 3], direction: [f64; 3]) -> Rgb {
        self.ray(origin, direction).sum()
    }
}

/// What several rays are shot with.
struct Watch<'a> {
    stage: &'a Stage,
    camera: Camera,
    integrator: Whitted,
}

impl Watch<'_> {
    fn shoot(&self, ray: Ray) -> (RayTree, Statistics) {
        let RenderSettings { depth, min_weight, weightless_rays, shadows, .. } = self.stage.settings;
        let rules = Rules { depth, min_weight, weightless_rays, shadows };
        let tracer = Tracer {
            scene: &self.stage.scene,
            integrator: &self.integrator,
            rules,
            instructions: InstructionSet::best(),
        };
        let (mut tree, mut statistics) = (RayTree::default(), Statistics::default());
        tracer.trace([(ray, 0)].as_slice(), &mut Scratch::default(), &mut statistics, &mut tree, None);
        (tree, statistics)
    }
}

/// The rays of a tree that go straight through: the camera's, then the refracted one of each in turn.
pub fn refracted_path(tree: &RayTree) -> Vec<&TracedRay> {
    let mut path = vec![&tree.rays[0]];
    loop {
        let last = path[path.len() - 1].task.id;
        let next =
            |ray: &&TracedRay| ray.task.parent == last && ray.task.id != last && ray.task.kind == RayKind::Refracted;
        match tree.rays.iter().find(next) {
            Some(ray) => path.push(ray),
            None => return path,
        }
    }
}

/// The sum of a ray's shares of the kinds that `wanted` accepts.
pub fn share(tree: &RayTree, task: u32, wanted: impl Fn(Term) -> bool) -> Rgb {
    tree.shares_of(task).filter(|share| wanted(share.term)).fold(Rgb::BLACK, |sum, share| sum + share.value)
}

/// The children of a ray.
pub fn children(tree: &RayTree, task: u32) -> impl Iterator<Item = &TracedRay> {
    tree.rays.iter().filter(move |ray| ray.task.parent == task && ray.task.id != task)
}

/// Snell's law, written apart from the engine: the direction behind a boundary, by its normal on the ray's side; `None` under
/// total internal reflection.
pub fn snell(direction: Vector3, normal: Vector3, from: f64, to: f64) -> Option<Vector3> {
    let along = normal * direction.dot(normal);
    // The part along the surface is scaled by the ratio of the indices; what is left of the length goes on through.
    let tangent = (direction - along) * (from / to);
    let rest = 1.0 - tangent.length_squared();
    (rest >= 0.0).then(|| tangent - normal * rest.sqrt())
}

/// Fresnel's reflectance for unpolarised light from the cosines' textbook forms, written apart from the engine.
pub fn reflectance(cosine: f64, from: f64, to: f64) -> f64 {
    let sine = (1.0 - cosine * cosine).max(0.0).sqrt() * from / to;
    if sine >= 1.0 {
        return 1.0;
    }
    let beyond = (1.0 - sine * sine).sqrt();
    let s = (from * cosine - to * beyond) / (from * cosine + to * beyond);
    let p = (to * cosine - from * beyond) / (to * cosine + from * beyond);
    0.5 * (s * s + p * p)
}

/// A unit normal as a vector.
pub fn unit(normal: Normal3) -> Vector3 {
    normal.as_vector()
}

/// Asserts that two colours differ by no more than `tolerance` in any component.
#[track_caller]
pub fn assert_near(actual: Rgb, expected: Rgb, tolerance: f32, what: &str) {
    let difference = (actual - expected).max_abs();
    // So that NaN fails.
    assert!(difference <= tolerance, "{what}: {actual:?}, expected {expected:?}");
}

/// Asserts that two pictures differ by no more than `tolerance` in any component of any pixel.
#[track_caller]
pub fn assert_pictures(actual: &Image<Rgb>, expected: &Image<Rgb>, tolerance: f32) {
    assert_eq!(actual.size(), expected.size());
    for y in 0..actual.height() {
        for x in 0..actual.width() {
            let (Some(a), Some(b)) = (actual.get(x, y), expected.get(x, y)) else { continue };
            assert_near(*a, *b, tolerance, &format!("pixel {x}, {y}"));
        }
    }
}
