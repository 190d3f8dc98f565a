//! What happens where a ray meets the scene: one `shade`, one file, one algorithm.

mod dispersion;
mod scattering;
mod sink;
#[cfg(test)]
mod sink_tests;
mod whitted;

use crate::compile::CompiledScene;
use crate::geometry::Hit;
use crate::observe::Observer;
use crate::task::RayTask;

pub use sink::{Rules, Sink, Spawn};
pub use whitted::Whitted;

/// An algorithm over the loop of [`crate::trace`]: the one open door of the engine, chosen once for a picture.
pub trait Integrator: Sync {
    /// Shades a ray: adds its local terms to its sample, asks the lights, spawns rays; all through `out`.
    ///
    /// `hit` is the nearest surface; `None` where the ray leaves the scene.
    fn shade<O: Observer>(&self, scene: &CompiledScene, task: &RayTask, hit: Option<&Hit>, out: &mut Sink<'_, O>);
}
