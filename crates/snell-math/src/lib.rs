//! The mathematics of Snell: the leaf crate that every other one stands on.
//!
//! Conventions, here and everywhere in the project:
//! - right-handed coordinates, +y up, a camera looks down −z;
//! - angles are radians (scene files say degrees where the key says so);
//! - geometry is `f64`, colours are `f32` and scene-linear with sRGB/Rec. 709 primaries;
//! - a transform is named destination-from-source: `world_from_object`;
//! - `sin`, `exp`, `pow` and friends come from [`portable`], never from `std`, so that a picture has the same bits on
//!   every machine; no fused multiply-add for the same reason.

pub mod bounds;
pub mod color;
pub mod dispersion;
pub mod homogeneous;
pub mod lanes;
pub mod microfacet;
pub mod portable;
pub mod ray;
pub mod roots;
pub mod sampler;
pub mod sampling;
pub mod spectrum;
pub mod transform;
pub mod vector;
pub mod warp;

pub use bounds::Bounds3;
pub use color::Rgb;
pub use dispersion::Dispersion;
pub use homogeneous::{Homogeneous2, Homogeneous3, HomogenizeError, Matrix4};
pub use ray::Ray;
pub use transform::Transform;
pub use vector::{Normal3, Point3, Vector3};
