//! Acceleration structures: which primitives a ray may meet, without testing them all.
//!
//! A hierarchy knows boxes and the places of primitives in the caller's list, nothing of shapes: a closure tests the
//! primitive, so that every caller gets its own monomorphic inner loop. The layout of the tree is private; a wide layout
//! can take the place of the binary one without a change to any caller.

pub mod bvh;
#[cfg(test)]
pub(crate) mod random;

pub use bvh::{BuildError, BuildOptions, Bvh, Candidate, Defect, Statistics};
