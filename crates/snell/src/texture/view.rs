//! Where in a camera's picture a direction is seen: what a photograph in the background is looked up by.

use snell_math::{Vector3, portable};

/// The projection of directions into a camera's picture. The basis is in world space, right-handed and orthonormal; the
/// window is the picture's rectangle on the plane z = −1 of eye space, so its borders are tangents of angles.
///
/// ```
/// use snell::math::Vector3;
/// use snell::texture::ViewProjection;
/// let view = ViewProjection { u: Vector3::X, v: Vector3::Y, w: Vector3::Z, left: -0.5, right: 0.5, bottom: -0.25, top: 0.25 };
/// assert_eq!(view.position(Vector3::new(0.0, 0.0, -1.0)), [0.5, 0.5]);
/// assert_eq!(view.position(Vector3::new(-0.5, 0.25, -1.0)), [0.0, 0.0]); // the corner at the top left
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ViewProjection {
    /// To the right in the picture.
    pub u: Vector3,
    /// Up in the picture.
    pub v: Vector3,
    /// From the picture to the viewer: against the gaze.
    pub w: Vector3,
    /// The window's left border, where it meets z = −1.
    pub left: f64,
    /// Its right border, above `left`.
    pub right: f64,
    /// Its bottom border.
    pub bottom: f64,
    /// Its top border, above `bottom`.
    pub top: f64,
}

impl ViewProjection {
    /// A stand-in for an orthographic camera, whose rays all have one direction. Its own rays see a photograph by their place
    /// in the picture ([`super::Background::evaluate_at_pixel`]); for rays that surfaces turn aside, the photograph surrounds
    /// the scene as it would for a perspective camera of the same basis with 40° between the left and right borders. `aspect`
    /// is the picture's width over its height.
    #[must_use]
    pub fn for_orthographic(u: Vector3, v: Vector3, w: Vector3, aspect: f64) -> Self {
        let right = portable::tan(portable::radians(20.0));
        let top = right / aspect;
        Self { u, v, w, left: -right, right, bottom: -top, top }
    }

    /// Where a direction of any length is seen: x to the right and y down, the picture being [0, 1]².
    ///
    /// A direction outside the picture has the nearest position on its border; one pointing behind the camera is mirrored
    /// to its front. Where there is no direction the middle is seen.
    #[must_use]
    pub fn position(&self, direction: Vector3) -> [f64; 2] {
        let depth = direction.dot(self.w).abs();
        let x = direction.dot(self.u) / depth;
        let y = direction.dot(self.v) / depth;
        [part(x - self.left, self.right - self.left), part(self.top - y, self.top - self.bottom)]
    }
}

/// `length / whole`, within [0, 1]; a half where that is no number.
fn part(length: f64, whole: f64) -> f64 {
    let part = length / whole;
    if part.is_nan() { 0.5 } else { part.clamp(0.0, 1.0) }
}
