//! What the machine could do at best: bytes a second from memory, the time of one dependent load from each level of the caches, and
//! operations a second; and from them, what a ray could take, for the hierarchies that rays walk.
//!
//! After Williams, Waterman and Patterson, "Roofline: An Insightful Visual Performance Model", CACM 52(4), 2009.

use std::fmt::Write;

use super::Bench;
use super::report::Section;
use super::roofline_loops::{bandwidth, latency, operations};

/// What memory must bring for a visited node of eight boxes, and for a visited leaf; bytes.
const NODE: f64 = 256.0;
const LEAF: f64 = 320.0;
/// Operations for a node: eight boxes, three axes, two planes, a subtraction, a multiplication and a comparison each; and for a leaf of
/// eight triangles, about fifty each (Möller and Trumbore 1997).
const NODE_OPERATIONS: f64 = 8.0 * 3.0 * 2.0 * 3.0;
const LEAF_OPERATIONS: f64 = 8.0 * 50.0;
/// Nodes and leaves that a ray visits in a good hierarchy of a scan; the kernels' report tells them where the program counts them.
const NODES: f64 = 12.0;
const LEAVES: f64 = 3.0;

/// Sizes of memory that dependent loads wander through, KiB.
const SIZES: &[u32] = &[16, 256, 4096, 16_384, 262_144];

/// Measures the machine.
pub fn run(_: &Bench) -> Result<Section, String> {
    let mut section = Section::default();
    let text = &mut section.text;
    *text += "| what | at best |\n|---|---|\n";
    let mut stream = 0.0;
    for threads in [1, 2] {
        stream = bandwidth(threads);
        let _ = writeln!(text, "| reading memory in a row, {threads} threads | {stream:.1} GB/s |");
    }
    let mut loads = Vec::new();
    for &kibibytes in SIZES {
        let nanoseconds = latency(kibibytes);
        loads.push(nanoseconds);
        let _ =
            writeln!(text, "| a load that waits for the one before, within {kibibytes} KiB | {nanoseconds:.1} ns |");
    }
    let mut best = 0.0_f64;
    for (name, rate) in operations() {
        best = best.max(rate);
        let _ =
            writeln!(text, "| multiplications and additions of `f32`, {name}, 1 thread | {rate:.0} billion a second |");
    }
    let bytes = NODES * NODE + LEAVES * LEAF;
    let count = NODES * NODE_OPERATIONS + LEAVES * LEAF_OPERATIONS;
    let steps = NODES + LEAVES;
    let _ = write!(
        text,
        "\nA ray that visits {NODES} nodes and {LEAVES} leaves reads {bytes:.0} bytes and needs {count:.0} operations. So no more than \
         these million rays a second and thread are possible: {:.0} by operations, {:.1} where all comes from memory in a row, and \
         one ray at a time, waiting for each step, {:.1} from the second-level cache and {:.2} from memory. What is above the last \
         figure on large scenes is due to rays whose waiting overlaps.\n",
        best * 1e3 / count,
        stream / 2.0 * 1e3 / bytes,
        1e3 / (steps * loads[1]),
        1e3 / (steps * loads[loads.len() - 1]),
    );
    Ok(section)
}
