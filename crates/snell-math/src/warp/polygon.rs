//! Places of a camera's aperture: a regular polygon, as blades make it.
//!
//! Follows: Kolb, Mitchell and Hanrahan, "A Realistic Camera Model for Computer Graphics", SIGGRAPH 1995, for what the
//! aperture does; a regular polygon is equal triangles about its centre, and each is sampled by Heitz's map.

use std::f64::consts::PI;

use super::{UNIFORM_DISK_DENSITY, triangle, uniform_disk};
use crate::portable;

/// The shape of an aperture, of circumscribed radius 1.
///
/// ```
/// use snell_math::warp::Aperture;
/// let hexagon = Aperture::new(6, 0.0);
/// let [x, y] = hexagon.sample([0.1, 0.2]);
/// assert!(x * x + y * y <= 1.0);
/// assert!((1.0 / hexagon.density() - 1.5 * 3.0_f64.sqrt()).abs() < 1e-14);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Aperture {
    blades: u32,
    /// Of the first vertex from +x, counter-clockwise, in radians.
    rotation: f64,
}

impl Aperture {
    /// The polygon with so many vertices, the first turned counter-clockwise from +x by `rotation` radians; a circle where
    /// `blades` is less than 3.
    #[must_use]
    pub const fn new(blades: u32, rotation: f64) -> Self {
        Self { blades, rotation }
    }

    /// A place (x, y) of the aperture, each as likely as the others.
    #[must_use]
    pub fn sample(&self, [u, v]: [f64; 2]) -> [f64; 2] {
        if self.blades < 3 {
            return uniform_disk([u, v]);
        }
        let blades = f64::from(self.blades);
        let sector = (u * blades).floor().min(blades - 1.0);
        let [first, second] = triangle([u * blades - sector, v]);
        let vertex = |number: f64| {
            let angle = self.rotation + 2.0 * PI * number / blades;
            [portable::cos(angle), portable::sin(angle)]
        };
        let (a, b) = (vertex(sector), vertex(sector + 1.0));
        [a[0] * first + b[0] * second, a[1] * first + b[1] * second]
    }

    /// The density of [`Self::sample`] inside, per unit of area: one over the area.
    #[must_use]
    pub fn density(&self) -> f64 {
        if self.blades < 3 {
            return UNIFORM_DISK_DENSITY;
        }
        let blades = f64::from(self.blades);
        2.0 / (blades * portable::sin(2.0 * PI / blades))
    }
}
