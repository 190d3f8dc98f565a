//! From uniform random numbers to places and directions, each routine with its density beside it.
//!
//! Every routine takes numbers `u` in [0, 1) and is continuous and monotonic in them where that can be, so that
//! well-spread numbers give well-spread places. A density is one per unit of what its name says: per steradian of
//! directions, per unit of area, of length, of an interval. Directions are unit vectors; those about an axis of their own
//! have +z for it (`Vector3::orthonormal_basis` leads elsewhere). The functions are pure.

mod disk;
mod distance;
mod phase;
mod piecewise;
mod piecewise_plane;
mod polygon;
mod rectangle;
mod sphere;
mod triangle;

pub use disk::{UNIFORM_DISK_DENSITY, uniform_disk};
pub use distance::{exponential, exponential_density, truncated_exponential, truncated_exponential_density};
pub use phase::{henyey_greenstein, henyey_greenstein_density};
pub use piecewise::{Piece, PiecewiseConstant};
pub use piecewise_plane::{PiecewiseConstantPlane, Spot};
pub use polygon::Aperture;
pub use rectangle::SphericalRectangle;
pub use sphere::{
    Cone, UNIFORM_SPHERE_DENSITY, cosine_hemisphere, cosine_hemisphere_density, uniform_cone, uniform_cone_density,
    uniform_sphere,
};
pub use triangle::{triangle, triangle_density};
