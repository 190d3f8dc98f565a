//! The matrices of the viewing pipeline, each with its inverse: canonical volume to pixels, boxes to the canonical volume,
//! arbitrary views, perspective, and the view that makes ray tracing simplest.
//!
//! World and eye space are right-handed, in world units. Shirley et al., *Fundamentals of Computer Graphics*, 3rd ed., sections
//! 7.1 to 7.3. All matrices map columns: M = M_o M_p M_v does M_v first.

use snell_math::{Matrix4, Point3, Vector3};

use super::{Rectangle, RectangleMap, ViewingError};

/// Below this sine of the angle between gaze and up, the right-hand direction is mere rounding noise.
const PARALLEL: f64 = 1e-9;

/// The box [l, r] × [b, t] × [f, n] of eye space that is seen: n > f, and in perspective 0 > n.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ViewVolume {
    /// [l, r] × [b, t]; in perspective, where it cuts the near plane.
    pub window: Rectangle,
    /// n, the z of the near plane.
    pub near: f64,
    /// f, the z of the far plane.
    pub far: f64,
}

impl ViewVolume {
    /// The canonical view volume [−1, 1]³.
    pub const CANONICAL: Self = Self { window: Rectangle::new(-1.0, 1.0, -1.0, 1.0), near: 1.0, far: -1.0 };

    fn check(&self) -> Result<(), ViewingError> {
        RectangleMap::new(&self.window, &Rectangle::UNIT)?;
        check_order(self.near, self.far)
    }
}

fn check_order(near: f64, far: f64) -> Result<(), ViewingError> {
    for (what, value) in [("the near plane", near), ("the far plane", far)] {
        if !value.is_finite() {
            return Err(ViewingError::NotFinite { what, value });
        }
    }
    if far >= near { Err(ViewingError::FarNotBeyondNear { near, far }) } else { Ok(()) }
}

fn check_finite(what: &'static str, v: Vector3) -> Result<(), ViewingError> {
    match v.to_array().into_iter().find(|c| !c.is_finite()) {
        Some(value) => Err(ViewingError::NotFinite { what, value }),
        None => Ok(()),
    }
}

/// M_pixel: the canonical volume [−1, 1]³ to nx × ny pixels whose centres are at integer coordinates, y up. z stays.
///
/// ```
/// use snell::math::Point3;
/// use snell::viewing::pixel_from_canonical;
/// let matrix = pixel_from_canonical(640.0, 480.0)?;
/// assert_eq!(matrix.rows()[0], [320.0, 0.0, 0.0, 319.5]); // nx/2, (nx − 1)/2
/// assert_eq!(matrix.rows()[1], [0.0, 240.0, 0.0, 239.5]);
/// // x: [−1, 1] → [−½, nx − ½]
/// assert_eq!(matrix.map(Point3::new(-1.0, -1.0, 0.5)).homogenize(), Ok(Point3::new(-0.5, -0.5, 0.5)));
/// assert_eq!(matrix.map(Point3::new(1.0, 1.0, 0.5)).homogenize(), Ok(Point3::new(639.5, 479.5, 0.5)));
/// # Ok::<(), snell::viewing::ViewingError>(())
/// ```
///
/// # Errors
/// Where there is no pixel.
pub fn pixel_from_canonical(nx: f64, ny: f64) -> Result<Matrix4, ViewingError> {
    if !(nx > 0.0 && ny > 0.0 && nx.is_finite() && ny.is_finite()) {
        return Err(ViewingError::NoPixels { width: nx, height: ny });
    }
    Ok(rectangle_from_canonical(&Rectangle::new(-0.5, nx - 0.5, -0.5, ny - 0.5)))
}

/// [−1, 1]² onto a rectangle, z kept.
pub(super) fn rectangle_from_canonical(to: &Rectangle) -> Matrix4 {
    Matrix4::from_rows([
        [0.5 * to.width(), 0.0, 0.0, 0.5 * (to.left + to.right)],
        [0.0, 0.5 * to.height(), 0.0, 0.5 * (to.bottom + to.top)],
        [0.0, 0.0, 1.0, 0.0],
        [0.0, 0.0, 0.0, 1.0],
    ])
}

/// The inverse of M_pixel: pixels to the canonical volume.
///
/// # Errors
/// Where there is no pixel.
pub fn canonical_from_pixel(nx: f64, ny: f64) -> Result<Matrix4, ViewingError> {
    pixel_from_canonical(nx, ny)?;
    Ok(Matrix4::from_rows([
        [2.0 / nx, 0.0, 0.0, (1.0 - nx) / nx],
        [0.0, 2.0 / ny, 0.0, (1.0 - ny) / ny],
        [0.0, 0.0, 1.0, 0.0],
        [0.0, 0.0, 0.0, 1.0],
    ]))
}

/// The box [l, r] × [b, t] × [f, n] to the canonical volume: moves its middle to the origin, then scales. n goes to +1, f to −1.
///
/// ```
/// use snell::math::Point3;
/// use snell::viewing::{Rectangle, ViewVolume, canonical_from_volume};
/// let volume = ViewVolume { window: Rectangle::new(-2.0, 4.0, 0.0, 2.0), near: -1.0, far: -9.0 };
/// let matrix = canonical_from_volume(&volume)?;
/// assert_eq!(matrix.map(Point3::new(4.0, 2.0, -1.0)).homogenize(), Ok(Point3::new(1.0, 1.0, 1.0)));
/// assert_eq!(matrix.map(Point3::new(-2.0, 0.0, -9.0)).homogenize(), Ok(Point3::new(-1.0, -1.0, -1.0)));
/// # Ok::<(), snell::viewing::ViewingError>(())
/// ```
///
/// # Errors
/// Where the box is empty, turned over or not finite.
pub fn canonical_from_volume(volume: &ViewVolume) -> Result<Matrix4, ViewingError> {
    volume.check()?;
    let ViewVolume { window: w, near: n, far: f } = *volume;
    let to_middle = Vector3::new(0.5 * (w.left + w.right), 0.5 * (w.bottom + w.top), 0.5 * (n + f));
    let scale = Matrix4::scaling(2.0 / w.width(), 2.0 / w.height(), 2.0 / (n - f));
    Ok(scale * Matrix4::translation(-to_middle))
}

/// The inverse: the canonical volume to the box.
///
/// # Errors
/// As [`canonical_from_volume`].
pub fn volume_from_canonical(volume: &ViewVolume) -> Result<Matrix4, ViewingError> {
    volume.check()?;
    let ViewVolume { window: w, near: n, far: f } = *volume;
    let to_middle = Vector3::new(0.5 * (w.left + w.right), 0.5 * (w.bottom + w.top), 0.5 * (n + f));
    let scale = Matrix4::scaling(0.5 * w.width(), 0.5 * w.height(), 0.5 * (n - f));
    Ok(Matrix4::translation(to_middle) * scale)
}

/// M_o: the box [l, r] × [b, t] × [f, n] of eye space to nx × ny pixels: `M_pixel · scale · translate`.
///
/// ```
/// use snell::math::Point3;
/// use snell::viewing::{ViewVolume, Rectangle, orthographic};
/// let volume = ViewVolume { window: Rectangle::new(0.0, 8.0, 0.0, 6.0), near: -1.0, far: -3.0 };
/// let matrix = orthographic(&volume, 800.0, 600.0)?;
/// assert_eq!(matrix.map(Point3::new(4.0, 3.0, -2.0)).homogenize(), Ok(Point3::new(399.5, 299.5, 0.0)));
/// # Ok::<(), snell::viewing::ViewingError>(())
/// ```
///
/// # Errors
/// As [`canonical_from_volume`] and [`pixel_from_canonical`].
pub fn orthographic(volume: &ViewVolume, nx: f64, ny: f64) -> Result<Matrix4, ViewingError> {
    Ok(pixel_from_canonical(nx, ny)? * canonical_from_volume(volume)?)
}

/// The inverse of M_o: pixels to eye space.
///
/// # Errors
/// As [`orthographic`].
pub fn orthographic_inverse(volume: &ViewVolume, nx: f64, ny: f64) -> Result<Matrix4, ViewingError> {
    Ok(volume_from_canonical(volume)? * canonical_from_pixel(nx, ny)?)
}

/// The axes of eye space in the world, u (right), v (up), w (back): w = −g/|g|, u = (t × w)/|t × w|, v = w × u, for a gaze g and
/// a view-up vector t of any length.
///
/// ```
/// use snell::math::Vector3;
/// use snell::viewing::view_axes;
/// let [u, v, w] = view_axes(Vector3::new(0.0, 0.0, -7.0), Vector3::new(0.0, 2.0, 1.0))?;
/// assert_eq!([u, v, w], [Vector3::X, Vector3::Y, Vector3::Z]);
/// let along_up = view_axes(Vector3::Y, Vector3::Y).unwrap_err();
/// assert_eq!(along_up.to_string(), "the gaze (0, 1, 0) is parallel to the up vector (0, 1, 0)");
/// # Ok::<(), snell::viewing::ViewingError>(())
/// ```
///
/// # Errors
/// Where one has no direction, or both have the same or opposite ones.
pub fn view_axes(gaze: Vector3, up: Vector3) -> Result<[Vector3; 3], ViewingError> {
    let unit = |what: &'static str, v: Vector3| {
        check_finite(what, v)?;
        let [x, y, z] = v.to_array();
        v.try_normalize().ok_or(ViewingError::NoDirection { what, x, y, z })
    };
    let back = -unit("the gaze", gaze)?;
    let right = unit("the up vector", up)?.cross(back);
    if right.length() < PARALLEL {
        return Err(ViewingError::Parallel { gaze: gaze.to_array(), up: up.to_array() });
    }
    let right = right.normalize();
    Ok([right, back.cross(right), back])
}

/// M_v: world to eye space, for a camera at the eye e looking along the gaze g with view-up t: rows u, v, w, after a
/// translation by −e.
///
/// ```
/// use snell::math::{Point3, Vector3};
/// use snell::viewing::view;
/// let eye = Point3::new(3.0, 0.0, 0.0);
/// let matrix = view(eye, Vector3::new(-1.0, 0.0, 0.0), Vector3::Y)?;
/// assert_eq!(matrix.map(eye).homogenize(), Ok(Point3::ORIGIN));
/// assert_eq!(matrix.map(Point3::ORIGIN).homogenize(), Ok(Point3::new(0.0, 0.0, -3.0)));
/// # Ok::<(), snell::viewing::ViewingError>(())
/// ```
///
/// # Errors
/// As [`view_axes`], and where the eye is not finite.
pub fn view(eye: Point3, gaze: Vector3, up: Vector3) -> Result<Matrix4, ViewingError> {
    check_finite("the eye", eye.to_vector())?;
    Ok(view_from_axes(eye, view_axes(gaze, up)?))
}

pub(super) fn view_from_axes(eye: Point3, axes: [Vector3; 3]) -> Matrix4 {
    let [u, v, w] = axes.map(|axis| [axis.x(), axis.y(), axis.z(), 0.0]);
    let turn = Matrix4::from_rows([u, v, w, [0.0, 0.0, 0.0, 1.0]]);
    turn * Matrix4::translation(-eye.to_vector())
}

/// The inverse of M_v: eye space to the world.
///
/// # Errors
/// As [`view`].
pub fn view_inverse(eye: Point3, gaze: Vector3, up: Vector3) -> Result<Matrix4, ViewingError> {
    check_finite("the eye", eye.to_vector())?;
    let [u, v, w] = view_axes(gaze, up)?.map(Vector3::to_array);
    let row = |axis: usize| [u[axis], v[axis], w[axis], eye[axis]];
    Ok(Matrix4::from_rows([row(0), row(1), row(2), [0.0, 0.0, 0.0, 1.0]]))
}

/// M_p: (x, y, z, 1) → (n x, n y, (n + f) z − f n, z), which is (n x/z, n y/z, n + f − f n/z): lines go to lines, the near and the
/// far plane stay where they are, and order in z is kept between them.
///
/// h is z, negative before the eye: the same point as with all four signs turned, see [`super::clip_segment`].
///
/// ```
/// use snell::math::Point3;
/// use snell::viewing::perspective;
/// let matrix = perspective(-1.0, -5.0)?;
/// assert_eq!(matrix.map(Point3::new(6.0, 14.0, -2.0)).to_array(), [-6.0, -14.0, 7.0, -2.0]);
/// // p(n) = n, p(f) = f
/// assert_eq!(matrix.map(Point3::new(2.0, 3.0, -1.0)).homogenize(), Ok(Point3::new(2.0, 3.0, -1.0)));
/// assert_eq!(matrix.map(Point3::new(0.0, 5.0, -5.0)).homogenize(), Ok(Point3::new(0.0, 1.0, -5.0)));
/// // A point in the eye's plane has no image.
/// assert!(matrix.map(Point3::new(1.0, 0.0, 0.0)).homogenize().is_err());
/// # Ok::<(), snell::viewing::ViewingError>(())
/// ```
///
/// # Errors
/// Where n is not negative, or f not below n.
pub fn perspective(near: f64, far: f64) -> Result<Matrix4, ViewingError> {
    check_order(near, far)?;
    if near >= 0.0 {
        return Err(ViewingError::NearNotBeforeEye { near });
    }
    let (n, f) = (near, far);
    Ok(Matrix4::from_rows([[n, 0.0, 0.0, 0.0], [0.0, n, 0.0, 0.0], [0.0, 0.0, n + f, -f * n], [0.0, 0.0, 1.0, 0.0]]))
}

/// The inverse of M_p, up to a factor f n, which homogeneous coordinates do not see.
///
/// ```
/// use snell::math::Point3;
/// use snell::viewing::{perspective, perspective_inverse};
/// let p = Point3::new(0.3, -2.0, -4.0);
/// let back = perspective_inverse(-1.0, -5.0)?.map(perspective(-1.0, -5.0)?.map(p)).homogenize();
/// assert_eq!(back, Ok(p));
/// # Ok::<(), snell::viewing::ViewingError>(())
/// ```
///
/// # Errors
/// As [`perspective`].
pub fn perspective_inverse(near: f64, far: f64) -> Result<Matrix4, ViewingError> {
    perspective(near, far)?;
    let (n, f) = (near, far);
    Ok(Matrix4::from_rows([[f, 0.0, 0.0, 0.0], [0.0, f, 0.0, 0.0], [0.0, 0.0, 0.0, f * n], [0.0, 0.0, -1.0, n + f]]))
}

/// The view that makes ray tracing simplest: the image plane is z = 0, pixel (i, j) is the world point (i, j, 0), and the eye is
/// at (w/2, h/2, n). This rigid motion takes any camera there: the eye e to (w/2, h/2, n), the gaze, at length n, to −n k, and
/// an up vector p across it to |p| j. Of an up vector that is not perpendicular to the gaze, it is the perpendicular part that
/// becomes j.
///
/// ```
/// use snell::math::{Homogeneous3, Point3, Vector3};
/// use snell::viewing::ray_view;
/// let eye = Point3::new(0.0, 5.0, 0.0);
/// let matrix = ray_view(eye, Vector3::new(1.0, 0.0, 0.0), Vector3::new(0.0, 2.0, 0.0), 640.0, 480.0, 500.0)?;
/// assert_eq!(matrix.map(eye).homogenize(), Ok(Point3::new(320.0, 240.0, 500.0)));
/// // The gaze, at length n, goes to −n k, and so the middle of the image plane to (w/2, h/2, 0).
/// let gaze = Homogeneous3::direction(Vector3::new(500.0, 0.0, 0.0));
/// assert_eq!(matrix.map(gaze).vector(), Vector3::new(0.0, 0.0, -500.0));
/// let up = Homogeneous3::direction(Vector3::new(0.0, 2.0, 0.0));
/// assert_eq!(matrix.map(up).vector(), Vector3::new(0.0, 2.0, 0.0));
/// # Ok::<(), snell::viewing::ViewingError>(())
/// ```
///
/// # Errors
/// As [`view`]; and where w, h or n is not positive.
pub fn ray_view(eye: Point3, gaze: Vector3, up: Vector3, w: f64, h: f64, n: f64) -> Result<Matrix4, ViewingError> {
    Ok(Matrix4::translation(ray_view_eye(w, h, n)?) * view(eye, gaze, up)?)
}

/// The inverse of [`ray_view`]: from where pixel (i, j) is (i, j, 0) to the world.
///
/// # Errors
/// As [`ray_view`].
pub fn ray_view_inverse(
    eye: Point3,
    gaze: Vector3,
    up: Vector3,
    w: f64,
    h: f64,
    n: f64,
) -> Result<Matrix4, ViewingError> {
    Ok(view_inverse(eye, gaze, up)? * Matrix4::translation(-ray_view_eye(w, h, n)?))
}

fn ray_view_eye(w: f64, h: f64, n: f64) -> Result<Vector3, ViewingError> {
    if !(w > 0.0 && h > 0.0 && w.is_finite() && h.is_finite()) {
        return Err(ViewingError::NoPixels { width: w, height: h });
    }
    if !(n > 0.0 && n.is_finite()) {
        return Err(ViewingError::EyeNotBeforePlane { distance: n });
    }
    Ok(Vector3::new(0.5 * w, 0.5 * h, n))
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    fn planes() -> impl Strategy<Value = (f64, f64)> {
        (1e-3..10.0f64, 1e-2..100.0f64).prop_map(|(n, depth)| (-n, -n - depth))
    }

    fn vectors() -> impl Strategy<Value = Vector3> {
        [-1.0..1.0f64, -1.0..1.0, -1.0..1.0].prop_map(Vector3::from)
    }

    /// The largest difference of the matrices' entries, each divided by its matrix's last entry that is not 0.
    fn projective_distance(a: &Matrix4, b: &Matrix4) -> f64 {
        let scaled = |m: &Matrix4| {
            let rows = m.rows();
            let entries = rows.as_flattened().to_vec();
            let largest = entries.iter().copied().fold(0.0_f64, |l, e| if e.abs() > l.abs() { e } else { l });
            entries.into_iter().map(|e| e / largest).collect::<Vec<_>>()
        };
        scaled(a).iter().zip(scaled(b)).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max)
    }

    proptest! {
        #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::default() })]
        #[test]
        fn planes_stay_and_order_is_kept((n, f) in planes(), a in 0.0..1.0f64, b in 0.0..1.0f64, x in -5.0..5.0f64) {
            let matrix = perspective(n, f).expect("in order");
            let depth = |z: f64| matrix.map(Point3::new(x, -x, z)).homogenize().expect("before the eye").z();
            let rounding = 1e-12 * (1.0 + f.abs()) * (1.0 + f / n);
            prop_assert!((depth(n) - n).abs() < rounding && (depth(f) - f).abs() < rounding);
            let (za, zb) = (n + (f - n) * a, n + (f - n) * b);
            prop_assume!((za - zb).abs() > 1e-9);
            prop_assert_eq!(za < zb, depth(za) < depth(zb), "p({}) and p({})", za, zb);
        }

        #[test]
        fn lines_go_to_lines((n, f) in planes(), p in vectors(), q in vectors(), t in 0.0..1.0f64) {
            let into = |v: Vector3| Point3::new(v.x(), v.y(), n + (f - n) * (0.5 + 0.5 * v.z()));
            let (a, b) = (into(p), into(q));
            let matrix = perspective(n, f).expect("in order");
            let [ia, ib, im] = [a, b, a.lerp(b, t)].map(|p| matrix.map(p).homogenize().expect("before the eye"));
            let (along, to) = (ib - ia, im - ia);
            let size = ia.to_vector().max_abs().max(ib.to_vector().max_abs());
            prop_assert!(along.cross(to).length() <= 1e-9 * (1.0 + size * size), "{:?} {:?}", along, to);
            // Between the ends, too: no point of a line before the eye leaves the image of the segment.
            prop_assert!(to.length() <= along.length() * (1.0 + 1e-9) + 1e-9 * size);
        }

        #[test]
        fn inverses_lead_back(
            (n, f) in planes(), gaze in vectors(), up in vectors(), eye in vectors(), w in 1.0..999.0f64, h in 1.0..999.0f64,
        ) {
            prop_assume!(gaze.cross(up).length() > 1e-3);
            let eye = Point3::ORIGIN + eye * 10.0;
            let volume = ViewVolume { window: Rectangle::new(-0.5 * w, w, -h, 0.25 * h), near: n, far: f };
            let pairs = [
                (perspective(n, f), perspective_inverse(n, f)),
                (pixel_from_canonical(w, h), canonical_from_pixel(w, h)),
                (canonical_from_volume(&volume), volume_from_canonical(&volume)),
                (orthographic(&volume, w, h), orthographic_inverse(&volume, w, h)),
                (view(eye, gaze, up), view_inverse(eye, gaze, up)),
                (ray_view(eye, gaze, up, w, h, -n), ray_view_inverse(eye, gaze, up, w, h, -n)),
            ];
            for (index, (forth, back)) in pairs.into_iter().enumerate() {
                let (forth, back) = (forth.expect("not degenerate"), back.expect("not degenerate"));
                let product = projective_distance(&(back * forth), &Matrix4::IDENTITY);
                prop_assert!(product < 1e-9, "pair {}: {}", index, product);
                let general = forth.inverse().expect("not singular");
                prop_assert!(projective_distance(&general, &back) < 1e-7, "pair {}", index);
                // The twin: the matrix itself is no inverse of its own but by chance.
                prop_assert!(projective_distance(&(forth * forth), &Matrix4::IDENTITY) > 1e-7, "pair {}", index);
            }
        }
    }

    #[test]
    fn degenerate_input_is_told_by_its_value() {
        let message = |error: ViewingError| error.to_string();
        let volume = ViewVolume { window: Rectangle::UNIT, near: -2.0, far: -1.0 };
        assert_eq!(
            canonical_from_volume(&volume).map_err(message),
            Err("the far plane z = -1 is not beyond the near plane z = -2: it must be below it, as the camera looks along −z".to_owned())
        );
        assert!(perspective(-1.0, -1.0).is_err() && perspective(f64::NAN, -1.0).is_err());
        assert_eq!(
            perspective(0.0, -1.0).map_err(message),
            Err("the near plane z = 0 is not before the eye: it must be negative, as the camera looks along −z"
                .to_owned())
        );
        assert_eq!(
            view(Point3::ORIGIN, Vector3::ZERO, Vector3::Y).map_err(message),
            Err("the gaze is (0, 0, 0), which has no direction".to_owned())
        );
        assert_eq!(
            view(Point3::new(0.0, f64::INFINITY, 0.0), Vector3::X, Vector3::Y).map_err(message),
            Err("the eye is inf, which is no finite number".to_owned())
        );
        assert_eq!(pixel_from_canonical(0.0, 3.0).map_err(message), Err("the picture has 0 × 3 pixels".to_owned()));
        assert!(ray_view(Point3::ORIGIN, Vector3::X, Vector3::Y, 2.0, 2.0, 0.0).is_err());
        assert!(ray_view(Point3::ORIGIN, Vector3::X, Vector3::Y, -2.0, 2.0, 1.0).is_err());
    }
}
