//! Acceleration structures: which primitives a ray may meet, without testing them all.
//!
//! A hierarchy knows boxes and the places of primitives in the caller's list, nothing of shapes: a closure tests the
//! primitive, so that every caller gets its own monomorphic inner loop. It is built as a binary tree ([`bvh`]) and collapsed to
//! one of eight children a node ([`wide`]), which is what rays are traced through.

pub mod bvh;
#[cfg(test)]
pub(crate) mod random;
pub mod wide;

pub use bvh::{BuildError, BuildOptions, BuildQuality, Bvh, Defect, Statistics};
pub use wide::{Candidate, Hull, WideBvh, WideDefect, ask_for_large_pages};
