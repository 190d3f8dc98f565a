//! What happens where a ray meets the scene: one `shade`, one file, one algorithm.

mod dispersion;
mod path;
mod scattering;
mod sink;
#[cfg(test)]
mod sink_tests;
mod whitted;

use snell_math::Ray;
use snell_math::lanes::{Bits, Lanes};

use crate::camera::{Camera, Projection, Window};
use crate::compile::CompiledScene;
use crate::differential::RayDifferential;
use crate::geometry::HitRows;
use crate::interaction::{SurfaceRows, Surroundings};
use crate::observe::Observer;
use crate::task::RayRows;
use crate::texture::{SeenAtOnce, ViewProjection};

pub use path::{Path, PathSample, PhotonMap, PhotonPasses, Purpose};
pub(crate) use sink::QUEUES;
pub use sink::{LaneQuestions, Rules, ShadedRays, Sink, Spawn};
pub use whitted::Whitted;

/// An algorithm over the loop of [`crate::trace`]: the one open door of the engine, chosen once for a picture.
pub trait Integrator: Sync {
    /// What it remembers of the samples being traced, beside their rays.
    type State;

    /// Shades rays side by side, those of `rays` from place `at` on that are `active`: adds their local terms to their samples,
    /// asks the lights, spawns rays; all through `out`. They belong to different samples. One code serves one ray at a time, as
    /// where somebody watches, and eight.
    ///
    /// `hits` are the nearest surfaces; `surfaces` is memory to work them out in, which the caller keeps; `state` is what
    /// the caller has given for these samples.
    #[expect(
        clippy::too_many_arguments,
        reason = "the parts of one step of the tracing loop, which is its only caller"
    )]
    fn shade<L: Lanes, O: Observer>(
        &self,
        scene: &CompiledScene,
        state: &mut Self::State,
        rays: &RayRows,
        at: usize,
        active: Bits,
        hits: &HitRows,
        surfaces: &mut SurfaceRows,
        out: &mut Sink<'_, O>,
    );
}

/// Works out what the neighbours of rays meet, those from place `at` on that `met` surfaces, where pictures are seen.
#[inline(always)]
fn look_around<O: Observer>(
    scene: &CompiledScene,
    rays: &RayRows,
    at: usize,
    met: Bits,
    hits: &HitRows,
    surfaces: &mut SurfaceRows,
    out: &Sink<'_, O>,
) {
    if scene.sees_pictures() {
        for lane in met.lanes().map(|lane| at + lane) {
            surfaces.around[lane] = surroundings(scene, rays, lane, hits, surfaces, out);
        }
    }
}

/// As above, of one of them.
#[inline(never)]
fn surroundings<O: Observer>(
    scene: &CompiledScene,
    rays: &RayRows,
    lane: usize,
    hits: &HitRows,
    surfaces: &SurfaceRows,
    out: &Sink<'_, O>,
) -> Surroundings {
    match (hits.hit(lane), out.differential(rays.notes[lane].id)) {
        (Some(hit), Some(differential)) => {
            let interaction = scene.geometry.interaction_of(hits, surfaces, lane);
            scene.surroundings(&rays.ray(lane), &hit, &interaction, &differential)
        }
        _ => Surroundings::NONE,
    }
}

/// What of the background a ray of the camera sees at once, at a position of the picture.
fn seen_at_once(camera: &Camera, ray: &Ray, position: [f64; 2], differential: RayDifferential) -> SeenAtOnce {
    let positions = differential.origin.map(|step| {
        let there = camera.picture_position(ray.origin + step);
        [there[0] - position[0], there[1] - position[1]]
    });
    SeenAtOnce { directions: differential.direction, positions }
}

/// What of the background any other ray sees at once.
fn seen_in_directions(differential: Option<RayDifferential>) -> SeenAtOnce {
    differential.map_or(SeenAtOnce::POINT, |RayDifferential { direction, .. }| SeenAtOnce {
        directions: direction,
        ..SeenAtOnce::POINT
    })
}

/// How a camera sees directions: what photographs in the background are looked up by.
fn view_of(camera: &Camera) -> ViewProjection {
    let [u, v, w] = camera.axes();
    let Window { left, right, bottom, top } = camera.window();
    match camera.projection() {
        Projection::Perspective => ViewProjection { u, v, w, left, right, bottom, top },
        Projection::Orthographic => ViewProjection::for_orthographic(u, v, w, (right - left) / (top - bottom)),
    }
}
