//! Rough surfaces as many small mirrors: the distribution of Trowbridge and Reitz, known as GGX.
//!
//! Follows: Trowbridge and Reitz, "Average irregularity representation of a rough surface for ray reflection", JOSA 65(5), 1975;
//! Walter, Marschner, Li and Torrance, "Microfacet Models for Refraction through Rough Surfaces", EGSR 2007; Heitz, "Understanding
//! the Masking-Shadowing Function in Microfacet-Based BRDFs", JCGT 3(2), 2014 (the height-correlated form); Dupuy and Benyoub,
//! "Sampling Visible GGX Normals with Spherical Caps", Computer Graphics Forum 42(8) (HPG), 2023.
//!
//! All directions are unit vectors in the surface's frame, +z its normal, and leave the surface; `wo` has z > 0, so a surface
//! seen from behind is turned over first. η = η_o / η_i is the index on the side of `wo` over that on the other, as everywhere.
//! Densities and the functions of reflection and transmission are per steradian; the cosine with the normal is not in them, and
//! neither is Fresnel's share. Transmission is of power: radiance is multiplied by η² besides.

mod albedo;
mod compensation;

pub use compensation::{ConductorCompensation, DielectricCompensation};

use std::f64::consts::PI;

use crate::Vector3;
use crate::warp::uniform_cone;

/// A rough surface's small mirrors, stretched along x and y.
///
/// ```
/// use snell_math::{Vector3, microfacet::Ggx};
/// let brushed = Ggx::new([0.1, 0.4]);
/// let wo = Vector3::new(0.6, 0.0, 0.8);
/// let normal = brushed.sample_visible(wo, [0.3, 0.7]);
/// assert!(normal.z() > 0.0 && brushed.visible_density(wo, normal) > 0.0);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ggx {
    alpha: [f64; 2],
}

impl Ggx {
    /// The smallest width: below it, numbers lose their digits, and the surface is as good as smooth.
    pub const MIN_ALPHA: f64 = 1e-4;

    /// A surface of these widths along x and y; they are tangents of the mirrors' slopes. Widths below [`Self::MIN_ALPHA`], and NaN,
    /// count as that.
    #[inline]
    #[must_use]
    pub fn new(alpha: [f64; 2]) -> Self {
        Self { alpha: alpha.map(|alpha| if alpha > Self::MIN_ALPHA { alpha } else { Self::MIN_ALPHA }) }
    }

    /// The width of a roughness in [0, 1] as artists set it: its square (Burley, "Physically Based Shading at Disney", 2012).
    #[inline]
    #[must_use]
    pub fn from_roughness(roughness: f64) -> Self {
        Self::new([roughness * roughness; 2])
    }

    /// The widths along x and y.
    #[inline]
    #[must_use]
    pub const fn alpha(&self) -> [f64; 2] {
        self.alpha
    }

    /// D: the area of mirrors with a normal, per steradian and per area of the surface. Times cos θ it integrates to 1.
    #[inline]
    #[must_use]
    pub fn distribution(&self, normal: Vector3) -> f64 {
        let [ax, ay] = self.alpha;
        let (x, y, z) = (normal.x() / ax, normal.y() / ay, normal.z());
        let sum = x * x + y * y + z * z;
        if z > 0.0 { 1.0 / (PI * ax * ay * sum * sum) } else { 0.0 }
    }

    /// Λ: how many mirrors hide for each that is seen from a direction.
    #[inline]
    fn hidden(&self, v: Vector3) -> f64 {
        let (x, y) = (self.alpha[0] * v.x(), self.alpha[1] * v.y());
        let slope_squared = (x * x + y * y) / (v.z() * v.z());
        // ½ (√(1 + a²) − 1), of which the difference would lose small numbers.
        0.5 * slope_squared / (1.0 + (1.0 + slope_squared).sqrt())
    }

    /// G₁: the share of mirrors facing a direction that are seen from there.
    #[inline]
    #[must_use]
    pub fn masking(&self, v: Vector3) -> f64 {
        if v.z() == 0.0 { 0.0 } else { 1.0 / (1.0 + self.hidden(v)) }
    }

    /// G₂: the share seen from both directions, which are on one side (reflection) or not (transmission).
    #[inline]
    #[must_use]
    pub fn masking_shadowing(&self, wo: Vector3, wi: Vector3) -> f64 {
        if wo.z() == 0.0 || wi.z() == 0.0 { 0.0 } else { 1.0 / (1.0 + self.hidden(wo) + self.hidden(wi)) }
    }

    /// The density, per steradian, of normals among the mirrors that are seen from `wo`; that of [`Self::sample_visible`].
    #[inline]
    #[must_use]
    pub fn visible_density(&self, wo: Vector3, normal: Vector3) -> f64 {
        let facing = wo.dot(normal);
        if facing > 0.0 && wo.z() > 0.0 { self.masking(wo) * facing * self.distribution(normal) / wo.z() } else { 0.0 }
    }

    /// The normal of a mirror that is seen from `wo`, by two numbers in [0, 1).
    #[inline]
    #[must_use]
    pub fn sample_visible(&self, wo: Vector3, u: [f64; 2]) -> Vector3 {
        let [ax, ay] = self.alpha;
        // Stretched, the mirrors are a hemisphere; what it reflects towards `wo` comes from a cap of the sphere.
        let wo = Vector3::new(ax * wo.x(), ay * wo.y(), wo.z()).normalize();
        let cap = uniform_cone(u, 1.0 + wo.z());
        let half = cap + wo;
        // A mirror edge-on, which is seen from nowhere, may have no direction at all.
        Vector3::new(ax * half.x(), ay * half.y(), half.z().max(0.0)).try_normalize().unwrap_or(Vector3::Z)
    }

    /// The function of reflection, D G₂ / (4 cos θ_o cos θ_i); 0 where the directions are on different sides.
    #[inline]
    #[must_use]
    pub fn reflection(&self, wo: Vector3, wi: Vector3) -> f64 {
        if wo.z() <= 0.0 || wi.z() <= 0.0 {
            return 0.0;
        }
        let normal = (wo + wi).normalize();
        self.distribution(normal) * self.masking_shadowing(wo, wi) / (4.0 * wo.z() * wi.z())
    }

    /// The density, per steradian, of the direction in which a mirror seen from `wo` reflects.
    #[inline]
    #[must_use]
    pub fn reflection_density(&self, wo: Vector3, wi: Vector3) -> f64 {
        let normal = (wo + wi).normalize();
        let facing = wo.dot(normal);
        if facing > 0.0 { self.visible_density(wo, normal) / (4.0 * facing) } else { 0.0 }
    }

    /// The normal, on the side of `wo`, of the mirror that refracts `wo` to `wi`; `None` where none does. The indices must
    /// differ.
    #[inline]
    #[must_use]
    pub fn refracting_normal(wo: Vector3, wi: Vector3, eta: f64) -> Option<Vector3> {
        // Snell's law: the tangential parts of η_o wo and η_i wi cancel.
        let sum = wo * eta + wi;
        let normal = sum.try_normalize()?;
        let normal = if normal.z() < 0.0 { -normal } else { normal };
        (wo.z() > 0.0 && wi.z() < 0.0 && wo.dot(normal) > 0.0 && wi.dot(normal) < 0.0).then_some(normal)
    }

    /// The function of transmission, of power: D G₂ |wo·m| |wi·m| / (cos θ_o cos θ_i (wi·m + η wo·m)²); 0 where no mirror
    /// refracts one to the other.
    #[inline]
    #[must_use]
    pub fn transmission(&self, wo: Vector3, wi: Vector3, eta: f64) -> f64 {
        let Some(normal) = Self::refracting_normal(wo, wi, eta) else { return 0.0 };
        let (facing_o, facing_i) = (wo.dot(normal), -wi.dot(normal));
        let denominator = eta * facing_o - facing_i;
        self.distribution(normal) * self.masking_shadowing(wo, wi) * facing_o * facing_i
            / (wo.z() * -wi.z() * denominator * denominator)
    }

    /// The density, per steradian, of the direction to which a mirror seen from `wo` refracts.
    #[inline]
    #[must_use]
    pub fn transmission_density(&self, wo: Vector3, wi: Vector3, eta: f64) -> f64 {
        let Some(normal) = Self::refracting_normal(wo, wi, eta) else { return 0.0 };
        let (facing_o, facing_i) = (wo.dot(normal), -wi.dot(normal));
        let denominator = eta * facing_o - facing_i;
        self.visible_density(wo, normal) * facing_i / (denominator * denominator)
    }
}
