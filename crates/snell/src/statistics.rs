//! What was counted while rendering. Every count is an integer, so that sums do not depend on their order.

use snell_math::Rgb;

/// Counts of one tile, or of a picture: [`Statistics::merge`] adds them.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Statistics {
    /// Rays from the camera.
    pub camera_rays: u64,
    /// Rays spawned by reflection.
    pub reflected_rays: u64,
    /// Rays spawned by refraction.
    pub refracted_rays: u64,
    /// Rays that paths took on by surfaces that are no mirrors, or in media that scatter.
    pub scattered_rays: u64,
    /// Rays towards lights: one for each light on the lit side of a point. They count also where nothing depends on the
    /// answer, because the surface would not send the light to the viewer, and none is traced.
    pub shadow_rays: u64,
    /// The depth of the deepest ray traced; 1 where there were only camera rays.
    pub max_depth: u32,
    /// How often light met total internal reflection.
    pub total_internal_reflections: u64,
    /// Samples in which NaN or an infinite value came up, and which count as black.
    pub nonfinite_samples: u64,
    /// The first of those, in the order of rows from the top.
    pub first_nonfinite: Option<SamplePlace>,
    /// The sum of the weights of rays that were not followed, in units of 2⁻³².
    cut_weight: u64,
}

/// One sample of a picture. Ordered by rows from the top, then from the left.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct SamplePlace {
    /// The pixel's row, from the top.
    pub y: u32,
    /// Its column, from the left.
    pub x: u32,
    /// The sample's number in the pixel's sequence.
    pub sample: u32,
}

impl Statistics {
    /// Counts a sample in which NaN or an infinite value came up.
    #[cold]
    pub fn add_nonfinite(&mut self, place: SamplePlace) {
        self.nonfinite_samples += 1;
        self.first_nonfinite = Some(self.first_nonfinite.map_or(place, |first| first.min(place)));
    }

    /// The weight of rays that were not followed, over all camera rays: the share of the picture that was lost, if all that
    /// they would have seen were white.
    pub fn cut_weight(&self) -> f64 {
        if self.camera_rays == 0 {
            return 0.0;
        }
        self.cut_weight as f64 / 4_294_967_296.0 / self.camera_rays as f64
    }

    /// Counts the throughput of a ray that is not followed, as the mean of its absolute components.
    pub fn add_cut_weight(&mut self, throughput: Rgb) {
        let weight = f64::from(throughput.map(f32::abs).mean());
        self.cut_weight = self.cut_weight.saturating_add((weight * 4_294_967_296.0) as u64);
    }

    /// All rays that were traced, towards lights included.
    pub fn rays(&self) -> u64 {
        self.camera_rays + self.reflected_rays + self.refracted_rays + self.scattered_rays + self.shadow_rays
    }

    /// Adds the counts of another part of the picture.
    pub fn merge(&mut self, other: &Self) {
        self.camera_rays += other.camera_rays;
        self.reflected_rays += other.reflected_rays;
        self.refracted_rays += other.refracted_rays;
        self.scattered_rays += other.scattered_rays;
        self.shadow_rays += other.shadow_rays;
        self.max_depth = self.max_depth.max(other.max_depth);
        self.total_internal_reflections += other.total_internal_reflections;
        self.nonfinite_samples += other.nonfinite_samples;
        self.first_nonfinite = match (self.first_nonfinite, other.first_nonfinite) {
            (Some(first), Some(other)) => Some(first.min(other)),
            (first, other) => first.or(other),
        };
        self.cut_weight = self.cut_weight.saturating_add(other.cut_weight);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_first_sample_that_is_no_number_is_kept_in_any_order() {
        let place = |y, x, sample| SamplePlace { y, x, sample };
        let of = |places: &[SamplePlace]| {
            let mut statistics = Statistics::default();
            places.iter().for_each(|place| statistics.add_nonfinite(*place));
            statistics
        };
        let (one, other) = (of(&[place(3, 1, 0), place(2, 9, 5), place(2, 9, 4)]), of(&[place(2, 10, 0)]));
        for (mut sum, part) in [(one, other), (other, one), (one, Statistics::default()), (Statistics::default(), one)]
        {
            sum.merge(&part);
            assert_eq!(sum.first_nonfinite, Some(place(2, 9, 4)));
        }
        assert_eq!(one.nonfinite_samples, 3);
    }
}
