//! Lenses of cameras: thin ones, and real ones as stacks of spherical surfaces with their paraxial optics.
//!
//! Follows: Smith, "Modern Optical Engineering", 4th edition, 2008, chapters 2 and 3 (paraxial rays, cardinal points, pupils), for
//! rays near the axis; Kolb, Mitchell and Hanrahan, "A Realistic Camera Model for Computer Graphics", SIGGRAPH 1995, for the list of
//! surfaces. Lengths of a prescription are millimetres. Light comes from the world, and distances along the axis grow the way it
//! travels: from the front surface to the film.

use snell_math::Dispersion;
use snell_math::dispersion::fraunhofer::HELIUM_D;

/// The lens of a perspective camera.
#[derive(Clone, Debug, PartialEq)]
pub enum CameraLens {
    /// One without thickness or faults: all rays of a place of the film meet at one distance.
    Thin(ThinLens),
    /// A real one.
    System(Box<LensSystem>),
}

/// A thin lens in front of a perspective camera.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ThinLens {
    /// The radius of its aperture, world units, positive.
    pub radius: f64,
    /// How far in front of the eye, along the gaze, is what is sharp; positive.
    pub focus: f64,
    /// How many blades its aperture has; 0 for a round one.
    pub blades: u32,
}

/// A real lens, stopped down and focused, before a film. The camera's eye is the middle of its entrance pupil.
#[derive(Clone, Debug, PartialEq)]
pub struct LensSystem {
    /// Its surfaces.
    pub prescription: LensPrescription,
    /// The radius to which its stop is closed, in millimetres; at most that of the surface.
    pub stop_radius: f64,
    /// How many blades its stop has; 0 for a round one.
    pub blades: u32,
    /// How wide the film is, in millimetres.
    pub film_width: f64,
    /// How far the film is behind the last surface, in millimetres.
    pub film_distance: f64,
    /// How many millimetres a world unit is long.
    pub unit_mm: f64,
}

/// One surface of a lens.
#[derive(Clone, Debug, PartialEq)]
pub struct LensSurface {
    /// The radius of curvature, in millimetres: positive where the centre lies behind the surface, infinite for a flat one.
    pub radius: f64,
    /// How far the next surface is behind it, in millimetres. That of the last one is not used.
    pub thickness: f64,
    /// The index of refraction of what is behind it.
    pub behind: Dispersion,
    /// How far from the axis light passes, in millimetres.
    pub clear_radius: f64,
}

/// A lens as opticians write it down: its surfaces from the front, which is towards the world, to the film.
#[derive(Clone, Debug, PartialEq)]
pub struct LensPrescription {
    /// The surfaces; at least one.
    pub surfaces: Vec<LensSurface>,
    /// Which of them is the stop, which bounds the light of the middle of the picture.
    pub stop: usize,
}

/// A lens for rays close to its axis, at one wavelength, in air.
///
/// ```
/// use snell_math::Dispersion;
/// use snell_scene::scene::{LensPrescription, LensSurface};
/// let surface = |radius, thickness, index| LensSurface {
///     radius,
///     thickness,
///     behind: Dispersion::Constant(index),
///     clear_radius: 5.0,
/// };
/// let lens = LensPrescription { surfaces: vec![surface(50.0, 3.0, 1.5), surface(-50.0, 0.0, 1.0)], stop: 0 };
/// // The lensmaker's equation: 1/f = (n − 1) (1/R₁ − 1/R₂ + (n − 1) d / (n R₁ R₂)).
/// let power = 0.5 * (1.0 / 50.0 + 1.0 / 50.0 - 0.5 * 3.0 / (1.5 * 50.0 * 50.0));
/// assert!((lens.paraxial(550.0).focal_length() * power - 1.0).abs() < 1e-14);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Paraxial {
    /// What becomes of height and of index times slope from the front surface to behind the last one.
    whole: Matrix,
    /// And from the front surface to before the stop.
    to_stop: Matrix,
}

/// Where a lens makes the image of something.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ParaxialImage {
    /// How far behind the last surface; negative for an image that is before it.
    pub distance: f64,
    /// The height of the image over that of the thing; negative where it stands upside down.
    pub magnification: f64,
}

/// Rows of a matrix of two by two.
type Matrix = [[f64; 2]; 2];

const IDENTITY: Matrix = [[1.0, 0.0], [0.0, 1.0]];

fn product(a: Matrix, b: Matrix) -> Matrix {
    let entry = |row: usize, column: usize| a[row][0] * b[0][column] + a[row][1] * b[1][column];
    [[entry(0, 0), entry(0, 1)], [entry(1, 0), entry(1, 1)]]
}

impl LensPrescription {
    /// The lens for rays close to its axis, at a wavelength in nanometres.
    pub fn paraxial(&self, wavelength_nm: f64) -> Paraxial {
        let (mut whole, mut to_stop, mut before) = (IDENTITY, IDENTITY, 1.0);
        for (number, surface) in self.surfaces.iter().enumerate() {
            if number == self.stop {
                to_stop = whole;
            }
            let behind = surface.behind.index(wavelength_nm);
            whole = product([[1.0, 0.0], [(before - behind) / surface.radius, 1.0]], whole);
            if number + 1 < self.surfaces.len() {
                whole = product([[1.0, surface.thickness / behind], [0.0, 1.0]], whole);
            }
            before = behind;
        }
        Paraxial { whole, to_stop }
    }

    /// The lens for rays close to its axis at the helium d line, for which focal lengths and f-numbers are stated.
    pub fn paraxial_d(&self) -> Paraxial {
        self.paraxial(HELIUM_D)
    }

    /// The f-number with the stop wide open.
    pub fn widest_f_number(&self) -> f64 {
        let paraxial = self.paraxial_d();
        paraxial.f_number(self.surfaces[self.stop].clear_radius)
    }
}

impl Paraxial {
    /// The focal length; negative for a lens that spreads light, infinite for one without power.
    pub fn focal_length(&self) -> f64 {
        -1.0 / self.whole[1][0]
    }

    /// How far the focus is behind the last surface.
    pub fn back_focal_distance(&self) -> f64 {
        -self.whole[0][0] / self.whole[1][0]
    }

    /// How far the focus of light from behind is before the front surface.
    pub fn front_focal_distance(&self) -> f64 {
        -self.whole[1][1] / self.whole[1][0]
    }

    /// The image of what is at a distance before the front surface.
    pub fn image(&self, distance: f64) -> ParaxialImage {
        let [[a, b], [c, d]] = self.whole;
        let slope = c * distance + d;
        ParaxialImage { distance: -(a * distance + b) / slope, magnification: 1.0 / slope }
    }

    /// How far the entrance pupil, which is the stop as it is seen from the front, is behind the front surface; infinite where the
    /// stop is in the focus of what is before it.
    pub fn entrance_pupil(&self) -> f64 {
        self.to_stop[0][1] / self.to_stop[0][0]
    }

    /// The f-number with a radius of the stop: the focal length over the diameter of the entrance pupil.
    pub fn f_number(&self, stop_radius: f64) -> f64 {
        self.focal_length() * self.to_stop[0][0].abs() / (2.0 * stop_radius)
    }

    /// The radius of the stop that gives an f-number.
    pub fn stop_radius(&self, f_number: f64) -> f64 {
        self.f_number(1.0) / f_number
    }
}

#[cfg(test)]
mod tests {
    use snell_math::dispersion::fraunhofer::{HYDROGEN_C, HYDROGEN_F};
    use snell_testkit::must_fail;

    use super::*;
    use crate::catalogue;

    fn surface(radius: f64, thickness: f64, behind: Dispersion) -> LensSurface {
        LensSurface { radius, thickness, behind, clear_radius: 10.0 }
    }

    fn air() -> Dispersion {
        Dispersion::Constant(1.0)
    }

    #[track_caller]
    fn assert_close(found: f64, expected: f64, tolerance: f64) {
        assert!((found - expected).abs() <= tolerance * expected.abs(), "{found}, not {expected}");
    }

    #[test]
    fn conjugates_keep_newtons_equation() {
        // x x' = −f f' = f² with distances from both foci, and m = f / x.
        let glass = || Dispersion::Constant(1.6);
        let lens = LensPrescription {
            surfaces: vec![
                surface(40.0, 8.0, glass()),
                surface(f64::INFINITY, 5.0, air()),
                surface(-90.0, 3.0, glass()),
                surface(-30.0, 0.0, air()),
            ],
            stop: 1,
        };
        let paraxial = lens.paraxial_d();
        let f = paraxial.focal_length();
        for distance in [50.0, 100.0, 1e4] {
            let x = distance - paraxial.front_focal_distance();
            let image = paraxial.image(distance);
            assert_close((image.distance - paraxial.back_focal_distance()) * x, f * f, 1e-9);
            assert_close(image.magnification, -f / x, 1e-12);
            must_fail("the image of another distance", || {
                assert_close(paraxial.image(1.01 * distance).magnification, -f / x, 1e-3)
            });
        }
    }

    #[test]
    fn a_thin_singlets_focus_moves_with_colour_by_its_abbe_number() {
        let glass = catalogue::lookup("N-BK7").expect("known").dispersion();
        let abbe = glass.abbe_number().expect("dispersive");
        let lens =
            LensPrescription { surfaces: vec![surface(100.0, 0.0, glass), surface(-100.0, 0.0, air())], stop: 0 };
        let f = |nm| lens.paraxial(nm).focal_length();
        // f / V, where f² is the product of those of red and blue over that of yellow.
        let shift = f(HYDROGEN_C) * f(HYDROGEN_F) / (f(HELIUM_D) * abbe);
        assert_close(f(HYDROGEN_C) - f(HYDROGEN_F), shift, 1e-9);
        assert_close(shift, f(HELIUM_D) / abbe, 0.01);
        must_fail("another glass", || assert_close(f(HYDROGEN_C) - f(HYDROGEN_F), f(HELIUM_D) / 30.0, 5e-3));
    }

    #[test]
    fn the_entrance_pupil_is_the_image_of_the_stop() {
        // A stop behind a thin lens of power 1/f at distance d: 1/s' = 1/d − 1/f, and magnified by s'/d.
        let glass = || Dispersion::Constant(1.5);
        let lens = LensPrescription {
            surfaces: vec![
                surface(50.0, 0.0, glass()),
                surface(-50.0, 10.0, air()),
                surface(f64::INFINITY, 0.0, air()),
            ],
            stop: 2,
        };
        let paraxial = lens.paraxial_d();
        let position = 1.0 / (1.0 / 10.0 - 1.0 / 50.0);
        assert_close(paraxial.entrance_pupil(), position, 1e-12);
        assert_close(paraxial.f_number(2.0), 50.0 / (2.0 * 2.0 * position / 10.0), 1e-12);
        assert_close(paraxial.stop_radius(paraxial.f_number(2.0)), 2.0, 1e-12);
        must_fail("the stop itself", || assert_close(paraxial.entrance_pupil(), 10.0, 1e-3));
    }
}
