//! Scale, rotation and translation, of objects and of textures: scaled first, then rotated, then moved.

use snell_math::{Transform, Vector3, portable};

use super::Resolver;
use crate::document::model::{AxisAngle, Either, Located, Rotation, Scale, Triple};

impl Resolver<'_> {
    /// The map that scales, then rotates, then moves.
    pub(super) fn placement(
        &mut self,
        scale: Option<&Located<Scale>>,
        rotate: Option<&Located<Rotation>>,
        translate: Option<Triple>,
    ) -> Transform {
        if scale.is_none() && rotate.is_none() && translate.is_none() {
            return Transform::IDENTITY;
        }
        let scale = match scale {
            Some(scale) => self.scale(scale),
            None => Transform::IDENTITY,
        };
        let rotate = match rotate.map(|rotate| &rotate.value) {
            Some(Either::A(angles)) => euler(*angles),
            Some(Either::B(AxisAngle { axis, angle })) => {
                let axis = self.direction(axis, "the axis of the rotation", Vector3::Y);
                Transform::rotate(axis, portable::radians(*angle))
            }
            None => Transform::IDENTITY,
        };
        Transform::translate(translate.unwrap_or_default().into()) * rotate * scale
    }

    fn scale(&mut self, scale: &Located<Scale>) -> Transform {
        let factors = match scale.value {
            Either::A(factor) => [factor; 3],
            Either::B(factors) => factors,
        };
        if factors.iter().all(|factor| (1e-30..=1e30).contains(&factor.abs())) {
            return Transform::scale(factors.into());
        }
        self.error(&scale.span, "a scale of 0 leaves nothing", "must not be 0, nor as good as 0");
        Transform::IDENTITY
    }
}

/// Rotations about x, then y, then z, by degrees.
fn euler(degrees: Triple) -> Transform {
    let [x, y, z] = degrees.map(portable::radians);
    [(Vector3::X, x), (Vector3::Y, y), (Vector3::Z, z)]
        .into_iter()
        .filter(|(_, angle)| *angle != 0.0)
        .fold(Transform::IDENTITY, |map, (axis, angle)| Transform::rotate(axis, angle) * map)
}
