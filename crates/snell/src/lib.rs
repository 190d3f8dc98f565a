//! The engine of Snell: recursive ray tracing with reflection and refraction, as a library.

pub mod accel;
pub mod camera;
pub mod compile;
pub mod csg;
pub mod differential;
pub mod drawing;
pub mod explain;
pub mod film;
pub mod geometry;
pub mod integrator;
pub mod interaction;
pub mod light;
pub mod material;
pub mod observe;
pub mod optics;
pub mod outline;
pub mod plot;
pub mod render;
pub mod shape;
pub mod statistics;
pub mod task;
pub mod texture;
pub mod trace;
pub mod vector;
pub mod viewing;

pub use snell_image as image;
pub use snell_math as math;
pub use snell_scene as scene;
