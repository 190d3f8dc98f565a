//! Statistical tests: random numbers, spectra, and sampling routines against the densities beside them. Every test has a twin with a
//! planted defect. In one program, since tests of this kind share the chi-square test of `snell_testkit`.

mod directions;
mod microfacet;
mod sampler;
mod spectra;
mod warp;
