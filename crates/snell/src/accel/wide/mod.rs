//! A hierarchy with eight children a node, for eight box tests at once.
//!
//! Made from a binary one by opening, again and again, the child with the largest surface until there are eight (Wald,
//! Benthin and Boulos, "Getting Rid of Packets", IEEE RT 2008). A part of the binary tree with at most eight primitives
//! becomes one leaf, whose primitives are tested side by side. Children stand in order of falling surface: a query for any
//! hit takes them as they come, and the largest is the likeliest to stop it (Nah and Manocha, "SATO: Surface Area Traversal
//! Order for Shadow Ray Tracing", CGF 33(6), 2014).
//!
//! `WideTree` knows boxes and the places of leaves in a list that someone else keeps; [`WideBvh`] keeps lists of
//! primitives known by number. Boxes are `f32`, rounded outward. Box tests in `f32` are a filter that never loses a hit (see
//! `probe.rs`); what a hit is remains the caller's to say, in `f64`.
//!
//! Units and spaces: as [`super::bvh`].

mod collapse;
mod group;
mod hulls;
mod memory;
mod path;
mod primitives;
mod probe;
mod probes;
mod shared;
mod slabs;
mod stack;
mod together;
mod traverse;
mod validate;

#[cfg(test)]
mod tests;

pub use hulls::Hull;
pub use memory::ask_for_large_pages;
pub use primitives::{Candidate, WideBvh};
pub use validate::WideDefect;

pub(crate) use group::{Finder, Seeker};
pub(crate) use memory::roomy;
pub(crate) use path::Path;
pub(crate) use probe::{Approach, BoxLine, BoxRay, EPSILON, Measure, Probe, splat, widened_measure};
pub(crate) use probes::{Probes, reciprocal, spread};
pub(crate) use shared::{NONE, Visited, number};
pub(crate) use slabs::Slabs;
pub(crate) use stack::Stack;
pub(crate) use together::{Group, PrimitiveFinder, PrimitiveSeeker};
pub(crate) use traverse::take_lane;

use snell_math::Bounds3;
use snell_math::lanes::WIDTH;

use super::bvh::MAX_DEPTH;
use super::bvh::box32::Box32;

/// A child that is a leaf: the other bits are its place in the list of leaves.
const LEAF: u32 = 1 << 31;

/// How many children wait on a traversal's stack at most: a level adds all but the one that is gone to.
const STACK: usize = (WIDTH - 1) * (MAX_DEPTH + 1) + 1;

/// Three cache lines and a half, since registers are half a line long. A lane without a child has an empty box, which no ray enters.
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(C, align(32))]
struct WideNode {
    /// For each axis, the smallest and the largest coordinates of the children.
    planes: [[[f32; WIDTH]; 2]; 3],
    /// Nodes by their place, or leaves.
    children: [u32; WIDTH],
}

const _: () = assert!(size_of::<WideNode>() == 224);

impl WideNode {
    const EMPTY: Self = {
        let empty = [[f32::INFINITY; WIDTH], [f32::NEG_INFINITY; WIDTH]];
        Self { planes: [empty; 3], children: [LEAF; WIDTH] }
    };

    fn bounds(&self, lane: usize) -> Box32 {
        let corner = |side: usize| [0, 1, 2].map(|axis| self.planes[axis][side][lane]);
        Box32 { corners: [corner(0), corner(1)] }
    }

    fn set(&mut self, lane: usize, bounds: &Box32) {
        for (axis, planes) in self.planes.iter_mut().enumerate() {
            for (side, plane) in planes.iter_mut().enumerate() {
                plane[lane] = bounds.corners[side][axis];
            }
        }
    }

    /// True where there is a child in the lane.
    fn has(&self, lane: usize) -> bool {
        self.planes[0][0][lane] <= self.planes[0][1][lane]
    }
}

/// The inner nodes, their boxes, and which leaf is where.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct WideTree {
    /// Depth first, the root first. Empty where there is no primitive.
    nodes: Vec<WideNode>,
    /// Around everything.
    bounds: Box32,
    /// The largest absolute coordinate of that box.
    extent: f64,
}

impl WideTree {
    /// The box around everything, rounded outward to `f32`; empty where there is nothing.
    pub fn bounds(&self) -> Bounds3 {
        self.bounds.to_bounds()
    }

    /// True where there is nothing.
    pub fn is_empty(&self) -> bool {
        self.nodes.is_empty()
    }

    /// The largest absolute coordinate of the box around everything.
    pub fn extent(&self) -> f64 {
        self.extent
    }

    /// The memory of the nodes, in bytes.
    pub fn bytes(&self) -> usize {
        size_of_val(self.nodes.as_slice())
    }
}
