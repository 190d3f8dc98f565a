//! The pipeline of one camera, M = M_o M_p M_v, and what becomes of points and segments on the way.

use snell_math::{Homogeneous3, HomogenizeError, Matrix4, Point3, Vector3};

use super::matrices::{rectangle_from_canonical, view_from_axes};
use super::{Clipped, Rectangle, Side, ViewVolume, ViewingError, canonical_from_volume, clip_segment, outside};
use super::{perspective, pixel_from_canonical};

/// How points reach the window's plane.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Projection {
    /// Along lines through the eye.
    Perspective,
    /// Along lines parallel to the gaze.
    Orthographic,
}

/// The matrices of a view, from the world to pixels.
///
/// ```
/// use snell::math::{Point3, Vector3};
/// use snell::viewing::{Pipeline, Projection, Rectangle, ViewVolume, view_axes};
/// let volume = ViewVolume { window: Rectangle::new(-1.0, 1.0, -1.0, 1.0), near: -1.0, far: -9.0 };
/// let axes = view_axes(-Vector3::Z, Vector3::Y)?;
/// let pipeline = Pipeline::new(Point3::new(0.0, 0.0, 5.0), axes, Projection::Perspective, &volume, [100, 100])?;
/// let stages = pipeline.follow(Point3::new(1.0, 2.0, 1.0));
/// assert_eq!(stages.eye, Point3::new(1.0, 2.0, -4.0));
/// assert_eq!(stages.canonical.unwrap().to_array(), [0.25, 0.5, -0.6875]);
/// assert_eq!(stages.pixel.unwrap().to_array()[..2], [62.0, 74.5]); // 50 x + 49.5, 50 y + 49.5
/// assert!(stages.outside.is_empty());
/// # Ok::<(), snell::viewing::ViewingError>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Pipeline {
    /// Perspective or orthographic.
    pub projection: Projection,
    /// What is seen, in eye space.
    pub volume: ViewVolume,
    /// Pixels in x and in y.
    pub pixels: [u32; 2],
    /// M_v, world to eye space.
    pub view: Matrix4,
    /// M_p; the identity for an orthographic view.
    pub perspective: Matrix4,
    /// The first half of M_o: the volume to the canonical volume.
    pub canonical: Matrix4,
    /// The second half: M_pixel.
    pub pixel: Matrix4,
}

/// A world point at every stage of a pipeline.
#[derive(Clone, Debug, PartialEq)]
pub struct PointStages {
    /// In the world.
    pub world: Point3,
    /// In eye space, M_v p.
    pub eye: Point3,
    /// After M_p M_v, homogeneous: h is the eye-space z in perspective, negative before the eye.
    pub projected: Homogeneous3,
    /// What is clipped: in the canonical volume but not divided yet, with the sign by which h > 0 before the eye.
    pub clip: Homogeneous3,
    /// Divided: in the canonical volume where all three are in [−1, 1].
    pub canonical: Result<Point3, HomogenizeError>,
    /// The pixel, centres at integers, y up, and z as in the canonical volume.
    pub pixel: Result<Point3, HomogenizeError>,
    /// The sides of the volume that it is outside of.
    pub outside: Vec<Side>,
}

/// A segment of the world at every stage.
#[derive(Clone, Debug, PartialEq)]
pub struct SegmentStages {
    /// Its ends.
    pub ends: [PointStages; 2],
    /// What is left of it.
    pub clipped: Option<Clipped>,
    /// The ends of what is left.
    pub visible: Option<[PointStages; 2]>,
}

impl Pipeline {
    /// From where the camera is, how it is turned (see [`super::view_axes`]), what it sees and the picture's pixels.
    ///
    /// # Errors
    /// [`ViewingError`] where the volume is empty, or in perspective not before the eye, or where there is no pixel.
    pub fn new(
        eye: Point3,
        axes: [Vector3; 3],
        projection: Projection,
        volume: &ViewVolume,
        pixels: [u32; 2],
    ) -> Result<Self, ViewingError> {
        let [nx, ny] = pixels.map(f64::from);
        let pixel = pixel_from_canonical(nx, ny)?;
        // First, since a window that was measured on a wrong plane is wrong too.
        let perspective = match projection {
            Projection::Perspective => perspective(volume.near, volume.far)?,
            Projection::Orthographic => Matrix4::IDENTITY,
        };
        let canonical = canonical_from_volume(volume)?;
        let view = view_from_axes(eye, axes);
        Ok(Self { projection, volume: *volume, pixels, view, perspective, canonical, pixel })
    }

    /// The same view with other pixel coordinates for the corners of the window.
    #[must_use]
    pub fn onto(mut self, pixels: &Rectangle) -> Self {
        self.pixel = rectangle_from_canonical(pixels);
        self
    }

    /// M_o = M_pixel · scale · translate.
    pub fn orthographic(&self) -> Matrix4 {
        self.pixel * self.canonical
    }

    /// M = M_o M_p M_v.
    pub fn all(&self) -> Matrix4 {
        self.orthographic() * self.perspective * self.view
    }

    /// Into what is clipped: the canonical volume before the division, with the sign by which h > 0 before the eye.
    pub fn clip_from_world(&self) -> Matrix4 {
        self.canonical * self.signed(self.perspective) * self.view
    }

    /// From the canonical volume back to the world, up to a factor.
    pub fn world_from_canonical(&self) -> Option<Matrix4> {
        self.clip_from_world().inverse()
    }

    /// (x, y, z, h) and (−x, −y, −z, −h) are the same point; clipping needs the one of h > 0.
    fn signed(&self, matrix: Matrix4) -> Matrix4 {
        match self.projection {
            Projection::Perspective => Matrix4(-matrix.0),
            Projection::Orthographic => matrix,
        }
    }

    /// A point through all stages.
    pub fn follow(&self, world: Point3) -> PointStages {
        let in_eye_space = self.view.map(world);
        let projected = self.perspective.map(in_eye_space);
        let clip = self.canonical.map(self.signed(self.perspective).map(in_eye_space));
        let canonical = clip.homogenize();
        let pixel = self.pixel.map(clip).homogenize();
        let eye = Point3::new(in_eye_space.x(), in_eye_space.y(), in_eye_space.z());
        PointStages { world, eye, projected, clip, canonical, pixel, outside: outside(clip).collect() }
    }

    /// A segment through all stages: clipped before the division.
    pub fn follow_segment(&self, a: Point3, b: Point3) -> SegmentStages {
        let ends = [a, b].map(|p| self.follow(p));
        let clipped = clip_segment(ends[0].clip, ends[1].clip);
        // The map from world to what is clipped is linear, so parameters mean the same in both.
        let visible = clipped.map(|part| [part.from, part.to].map(|t| self.follow(a.lerp(b, t))));
        SegmentStages { ends, clipped, visible }
    }
}
