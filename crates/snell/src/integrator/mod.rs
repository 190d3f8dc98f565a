//! What happens where a ray meets the scene: one `shade`, one file, one algorithm.

mod dispersion;
mod path;
mod scattering;
mod sink;
#[cfg(test)]
mod sink_tests;
mod whitted;

use snell_math::lanes::{Bits, Lanes};

use crate::camera::{Camera, Projection, Window};
use crate::compile::CompiledScene;
use crate::geometry::HitRows;
use crate::interaction::SurfaceRows;
use crate::observe::Observer;
use crate::task::RayRows;
use crate::texture::ViewProjection;

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

/// How a camera sees directions: what photographs in the background are looked up by.
fn view_of(camera: &Camera) -> ViewProjection {
    let [u, v, w] = camera.axes();
    let Window { left, right, bottom, top } = camera.window();
    match camera.projection() {
        Projection::Perspective => ViewProjection { u, v, w, left, right, bottom, top },
        Projection::Orthographic => ViewProjection::for_orthographic(u, v, w, (right - left) / (top - bottom)),
    }
}
