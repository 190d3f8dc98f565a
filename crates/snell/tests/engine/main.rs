//! The engine as a whole against what is known: closed forms, exact models and its own promises.
//!
//! Every comparison has a twin with a planted defect, which must be caught.

#[path = "../support/files.rs"]
mod files;
mod stage;

mod agreement;
mod catalogue;
mod compile;
mod determinism;
mod explain;
mod films;
mod footprints;
mod lens;
mod lighting;
mod optics;
mod paths;
mod robust;
mod seven_rays;
mod spd;
mod spectra;
mod viewing;
