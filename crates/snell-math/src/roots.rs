//! Real roots of polynomials of low degree.
