//! Lights.

use snell_math::{Point3, Vector3, portable};

use super::Resolver;
use crate::document::model::{self, Either, FalloffLaw, Located};
use crate::scene::{Falloff, Light, LightKind};

impl Resolver<'_> {
    pub(super) fn light(&mut self, located: &Located<model::Light>) -> Light {
        let light = &located.value;
        let name = light.name.as_ref().map(|name| name.value.clone());
        if let Some(spot) = &light.spot {
            let kind = self.spot(spot);
            let (intensity, spectrum) = self.light_color(&spot.color, spot.intensity);
            return Light { name, kind, intensity, spectrum, falloff: self.falloff(&spot.falloff) };
        }
        if let Some(directional) = &light.directional {
            self.direction(&directional.direction, "the light's direction", Vector3::Y);
            let kind = LightKind::Directional {
                direction: directional.direction.value.into(),
                angle: portable::radians(directional.angle),
            };
            let (intensity, spectrum) = self.light_color(&directional.color, directional.intensity);
            return Light { name, kind, intensity, spectrum, falloff: Falloff::None };
        }
        let (position, (intensity, spectrum), falloff) = match &light.point {
            Some(point) => {
                (point.position, self.light_color(&point.color, point.intensity), self.falloff(&point.falloff))
            }
            None => ([0.0; 3], (snell_math::Rgb::BLACK, None), Falloff::None),
        };
        Light { name, kind: LightKind::Point { position: position.into() }, intensity, spectrum, falloff }
    }

    fn spot(&mut self, spot: &model::SpotLight) -> LightKind {
        let position = Point3::from(spot.position);
        let direction = match (&spot.direction, &spot.look_at) {
            (Some(direction), _) => {
                self.direction(direction, "the light's direction", Vector3::Y);
                direction.value.into()
            }
            (None, Some(look_at)) => {
                let direction = Point3::from(look_at.value) - position;
                if direction.try_normalize().is_none() {
                    let message = "the light looks at the very point where it is";
                    self.error(&look_at.span, message, "is its `position`");
                }
                direction
            }
            (None, None) => -Vector3::Y,
        };
        let cone = spot.cone_angle.value;
        let full = spot.full_angle.as_ref().map_or(0.8 * cone, |full| full.value);
        if let Some(full_angle) = &spot.full_angle
            && full > cone
        {
            let message = format!("the light's `full_angle` {full} is larger than its `cone_angle` {cone}");
            self.error(&full_angle.span, message, format!("must be at most {cone}, in degrees"));
        }
        LightKind::Spot {
            position,
            direction,
            cone_angle: portable::radians(cone),
            full_angle: portable::radians(full),
        }
    }

    fn falloff(&mut self, falloff: &Located<model::Falloff>) -> Falloff {
        match &falloff.value {
            Either::A(FalloffLaw::None) => Falloff::None,
            Either::A(FalloffLaw::Linear) => Falloff::Linear,
            Either::A(FalloffLaw::InverseSquare) => Falloff::InverseSquare,
            Either::B(model::PolynomialFalloff { constant, linear, quadratic }) => {
                let (constant, linear, quadratic) = (*constant, *linear, *quadratic);
                if constant + linear + quadratic == 0.0 {
                    self.error(&falloff.span, "a falloff by 1 / 0", "one of the three must be above 0");
                }
                Falloff::Polynomial { constant, linear, quadratic }
            }
        }
    }
}
