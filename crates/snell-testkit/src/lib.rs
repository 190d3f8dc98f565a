//! Test helpers: golden pictures, chi-square tests of sampling routines, degenerate values, planted defects, random numbers
//! that are the same in every run.
//!
//! Development only; nothing that is shipped depends on it. Unlike the other libraries it may read files and the
//! environment, and panics: that is how a test speaks.

pub mod chi_square;
pub mod degenerate;
pub mod golden;
mod long;
mod rng;
mod sabotage;

pub use golden::assert_golden;
pub use long::long_tests;
pub use rng::TestRng;
pub use sabotage::must_fail;
