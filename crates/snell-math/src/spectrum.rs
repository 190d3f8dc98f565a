//! Wavelengths, the standard observer and bands.
