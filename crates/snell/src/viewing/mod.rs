//! The viewing pipeline's mathematics: rectangles onto rectangles, canonical volumes, projections, clipping.
//!
//! The lecture's order: world → eye (M_v) → perspective (M_p) → canonical volume [−1, 1]³ → pixels (M_o), and in 2D world
//! coordinates → window → viewport → device. Shirley et al., *Fundamentals of Computer Graphics*, 3rd ed., chapter 7. Eye space
//! is right-handed, x to the right, y up, looking along −z, so that n and f are negative and n > f. Pixel coordinates here are
//! the lecture's: centres at integers, y up; a device says how its own run.

mod clip;
mod matrices;
mod pipeline;
mod rectangle;

pub use clip::{Clipped, Side, clip_segment, clip_segment_to, outside};
pub use matrices::{
    ViewVolume, canonical_from_pixel, canonical_from_volume, orthographic, orthographic_inverse, perspective,
    perspective_inverse, pixel_from_canonical, ray_view, ray_view_inverse, view, view_axes, view_inverse,
    volume_from_canonical,
};
pub use pipeline::{Pipeline, PointStages, Projection, SegmentStages};
pub use rectangle::{Device, Fit, Rectangle, RectangleMap, Viewing2, ViewingError};
