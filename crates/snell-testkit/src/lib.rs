//! Test helpers: golden pictures, brute force, degenerate values, planted defects.
