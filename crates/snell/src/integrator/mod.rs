//! What happens where a ray meets the scene: one `shade`, one file, one algorithm.

mod dispersion;
mod scattering;
mod sink;
#[cfg(test)]
mod sink_tests;
mod whitted;

use snell_math::lanes::{Bits, Lanes};

use crate::compile::CompiledScene;
use crate::geometry::HitRows;
use crate::interaction::SurfaceRows;
use crate::observe::Observer;
use crate::task::RayRows;

pub(crate) use sink::QUEUES;
pub use sink::{LaneQuestions, Rules, ShadedRays, Sink, Spawn};
pub use whitted::Whitted;

/// An algorithm over the loop of [`crate::trace`]: the one open door of the engine, chosen once for a picture.
pub trait Integrator: Sync {
    /// Shades rays side by side, those of `rays` from place `at` on that are `active`: adds their local terms to their samples,
    /// asks the lights, spawns rays; all through `out`. They belong to different samples. One code serves one ray at a time, as
    /// where somebody watches, and eight.
    ///
    /// `hits` are the nearest surfaces; `surfaces` is memory to work them out in, which the caller keeps.
    #[expect(
        clippy::too_many_arguments,
        reason = "the parts of one step of the tracing loop, which is its only caller"
    )]
    fn shade<L: Lanes, O: Observer>(
        &self,
        scene: &CompiledScene,
        rays: &RayRows,
        at: usize,
        active: Bits,
        hits: &HitRows,
        surfaces: &mut SurfaceRows,
        out: &mut Sink<'_, O>,
    );
}
