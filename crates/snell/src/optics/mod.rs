//! What light does at a boundary between two media and inside them: pure functions of directions, indices and
//! distances.
//!
//! Conventions, those of the lecture: `wo` leaves the surface, against the incident ray; the normal is on the same side
//! as `wo`; all directions have unit length; η = η_i / η_t is the index of refraction on the side of the incident ray
//! over that on the other. Indices come from [`snell_math::Dispersion::index`], angles are radians, cosines are those
//! with the normal.

mod complex;
mod conductor;
mod fresnel;
mod medium;
mod metal;
mod reflection;
mod refraction;
mod thin_film;

pub use complex::ComplexIndex;
pub use conductor::{fresnel_conductor, fresnel_conductor_average, fresnel_conductor_polarized};
pub use fresnel::{
    FresnelAmplitudes, brewster_angle, fresnel_amplitudes, fresnel_dielectric, fresnel_dielectric_lanes,
    fresnel_dielectric_polarized,
};
pub(crate) use medium::Stretches;
pub use medium::{beer_lambert, henyey_greenstein};
pub use metal::Metal;
pub use reflection::{reflect, reflect_lanes};
pub use refraction::{cos_transmitted, critical_angle, refract, refract_lanes};
pub use thin_film::{FilmShares, ThinFilm, thin_film};

#[cfg(test)]
mod tests;
