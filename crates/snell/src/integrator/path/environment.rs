//! The background as a light: directions in which it is bright are chosen more often.
//!
//! Directions are laid out on the unit square by their height and their angle about +y, which keeps areas (Lambert's cylindrical
//! projection): a density there is one per steradian times 4π.

use std::f64::consts::{PI, TAU};

use snell_math::warp::PiecewiseConstantPlane;
use snell_math::{Vector3, portable};

use crate::texture::{Background, SeenAtOnce, ViewProjection};

/// A background that is not black.
#[derive(Clone, Debug)]
pub struct Environment {
    choice: PiecewiseConstantPlane,
    view: ViewProjection,
}

impl Environment {
    /// `None` for a black one.
    pub fn new(background: &Background, view: &ViewProjection) -> Option<Self> {
        let [width, height] = if background.constant().is_some() { [1, 1] } else { background.detail() };
        // Brightness at the corners of cells and in their middles, so that no cell counts as dark that is bright somewhere.
        let at = |x: f64, y: f64| {
            let color = background.evaluate(direction([x / width as f64, y / height as f64]), &SeenAtOnce::POINT, view);
            f64::from(color.map(|component| component.max(0.0)).mean())
        };
        let row = |y: f64, offset: f64| -> Vec<f64> { (0..=width).map(|x| at(x as f64 + offset, y)).collect() };
        let mut weights = Vec::with_capacity(width * height);
        let mut above = row(0.0, 0.0);
        for y in 0..height {
            let (below, middle) = (row((y + 1) as f64, 0.0), row(y as f64 + 0.5, 0.5));
            for x in 0..width {
                let corners = above[x] + above[x + 1] + below[x] + below[x + 1];
                weights.push(0.5 * middle[x] + 0.125 * corners);
            }
            above = below;
        }
        Some(Self { choice: PiecewiseConstantPlane::new(width, &weights)?, view: *view })
    }

    /// The camera's view, which a photograph depends on.
    #[inline]
    pub fn view(&self) -> &ViewProjection {
        &self.view
    }

    /// The mean radiance over all directions.
    #[inline]
    pub fn mean(&self) -> f64 {
        self.choice.integral()
    }

    /// A direction, towards the background, with its density per steradian.
    pub fn sample(&self, u: [f64; 2]) -> Option<(Vector3, f64)> {
        let spot = self.choice.sample(u);
        (spot.density > 0.0).then(|| (direction(spot.place), spot.density / (4.0 * PI)))
    }

    /// The density of that choice.
    pub fn density(&self, direction: Vector3) -> f64 {
        self.choice.density(place(direction)) / (4.0 * PI)
    }
}

/// The unit vector at a place of the square: angles grow with the first coordinate, height falls with the second.
fn direction([x, y]: [f64; 2]) -> Vector3 {
    let height = 1.0 - 2.0 * y;
    let radius = ((1.0 - height) * (1.0 + height)).max(0.0).sqrt();
    let angle = TAU * x;
    Vector3::new(radius * portable::cos(angle), height, radius * portable::sin(angle))
}

/// The place of a unit vector.
fn place(direction: Vector3) -> [f64; 2] {
    let turn = portable::atan2(direction.z(), direction.x()) / TAU;
    let x = if turn < 0.0 { turn + 1.0 } else { turn };
    [x.min(1.0_f64.next_down()), (0.5 - 0.5 * direction.y()).clamp(0.0, 1.0_f64.next_down())]
}
