//! The differentials of a generation's rays, beside their queues: so that rays of scenes without pictures carry none.

use crate::differential::RayDifferential;

/// Those of the rays of one generation and of the next, by the rays' numbers, see [`super::RayTask::id`].
#[derive(Debug, Default)]
pub struct Differentials {
    is_wanted: bool,
    current: Vec<RayDifferential>,
    /// The number of the first ray of the generation.
    first: u32,
    next: Vec<RayDifferential>,
    /// And of the next one.
    first_next: u32,
}

impl Differentials {
    /// Begins with the camera's rays, which are numbered from 0; with nothing where there are no pictures to be blurred.
    pub fn begin(&mut self, camera_rays: Option<impl Iterator<Item = RayDifferential>>) {
        self.is_wanted = camera_rays.is_some();
        self.current.clear();
        self.current.extend(camera_rays.into_iter().flatten());
        self.next.clear();
        self.first = 0;
        self.first_next = self.current.len() as u32;
    }

    /// True where they are kept.
    #[inline(always)]
    pub fn are_wanted(&self) -> bool {
        self.is_wanted
    }

    /// That of a ray of this generation.
    #[inline]
    pub fn of(&self, id: u32) -> RayDifferential {
        self.current.get(id.wrapping_sub(self.first) as usize).copied().unwrap_or_default()
    }

    /// Keeps that of a ray of the next generation.
    pub fn set(&mut self, id: u32, differential: RayDifferential) {
        let place = id.wrapping_sub(self.first_next) as usize;
        if place >= self.next.len() {
            self.next.resize(place + 1, RayDifferential::NONE);
        }
        self.next[place] = differential;
    }

    /// Makes the next generation this one; `next_id` is the number of the first ray of the one after it.
    #[inline]
    pub fn advance(&mut self, next_id: u32) {
        if self.is_wanted {
            std::mem::swap(&mut self.current, &mut self.next);
            self.next.clear();
            self.first = self.first_next;
            self.first_next = next_id;
        }
    }
}

#[cfg(test)]
mod tests {
    use snell_math::Vector3;

    use super::*;

    fn numbered(number: u32) -> RayDifferential {
        RayDifferential { origin: [Vector3::X * f64::from(number); 2], ..RayDifferential::NONE }
    }

    #[test]
    fn each_generation_finds_its_own() {
        let mut all = Differentials::default();
        all.begin(Some((0..3).map(numbered)));
        assert!(all.are_wanted());
        assert_eq!((0..3).map(|id| all.of(id)).collect::<Vec<_>>(), (0..3).map(numbered).collect::<Vec<_>>());
        // In any order, and not of every ray.
        all.set(5, numbered(5));
        all.set(3, numbered(3));
        all.advance(6);
        assert_eq!([3, 4, 5, 6].map(|id| all.of(id)), [numbered(3), numbered(0), numbered(5), numbered(0)]);
        assert_eq!(all.of(2), RayDifferential::NONE, "of the generation before");
        all.advance(6);
        assert_eq!(all.of(5), RayDifferential::NONE);
        all.begin(None::<std::iter::Empty<RayDifferential>>);
        assert!(!all.are_wanted());
    }
}
