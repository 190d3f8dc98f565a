//! Geometry that must not spoil the picture: shadows a surface casts on itself by rounding, and light through closed walls.

mod closed;
mod grazing;
mod self_shadow;
mod touching;
