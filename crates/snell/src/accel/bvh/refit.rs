//! Fitting a hierarchy to primitives that have moved: the tree stays, its boxes follow.
//!
//! That takes a fraction of the time of building, and is right whatever has moved where; but a tree whose primitives have
//! changed places is slow to trace. Its cost is told, for the caller to decide when it is time to build anew.

use snell_math::Bounds3;

use super::box32::Box32;
use super::build::refuse;
use super::{BuildError, Bvh};

impl Bvh {
    /// Takes over new boxes of the primitives, of which none may be gone or come new, and returns the expected cost of a
    /// line (see [`Statistics::sah_cost`](super::Statistics::sah_cost)). A primitive in pieces has its whole box in each
    /// of their leaves from then on.
    ///
    /// # Errors
    /// Where a box has a NaN or infinite corner, or is empty and was not, or was empty and is not. The hierarchy is then
    /// as it was.
    ///
    /// ```
    /// use snell::accel::Bvh;
    /// use snell_math::{Bounds3, Point3};
    ///
    /// let boxes_at = |x: f64| [0.0, 1.0].map(|y| Bounds3::new(Point3::new(x, y, 0.0), Point3::new(x + 1.0, y + 1.0, 1.0)));
    /// let mut bvh = Bvh::build(&boxes_at(0.0))?;
    /// bvh.refit(&boxes_at(5.0))?;
    /// assert_eq!(bvh.bounds().max, Point3::new(6.0, 2.0, 1.0));
    /// # Ok::<(), snell::accel::BuildError>(())
    /// ```
    pub fn refit(&mut self, bounds: &[Bounds3]) -> Result<f64, BuildError> {
        let mut in_tree = vec![false; bounds.len()];
        for &primitive in &self.primitives {
            *in_tree.get_mut(primitive as usize).ok_or(BuildError::Changed(primitive))? = true;
        }
        for (primitive, (bounds, in_tree)) in bounds.iter().zip(in_tree).enumerate() {
            if let Some(error) = refuse(primitive as u32, bounds) {
                return Err(error);
            }
            if bounds.is_empty() == in_tree {
                return Err(BuildError::Changed(primitive as u32));
            }
        }
        // Depth first, children come after their parent.
        for index in (0..self.nodes.len()).rev() {
            let node = self.nodes[index];
            self.nodes[index].bounds = if node.is_leaf() {
                let boxes = self.primitives[node.range()].iter().map(|&i| Box32::enclosing(&bounds[i as usize]));
                boxes.fold(Box32::EMPTY, |around, b| around.union(&b))
            } else {
                self.nodes[index + 1].bounds.union(&self.nodes[index + node.link as usize].bounds)
            };
        }
        self.extent = self.nodes.first().map_or(0.0, |root| root.bounds.max_abs());
        Ok(self.statistics().sah_cost)
    }
}

#[cfg(test)]
mod tests {
    use snell_math::{Point3, Ray, Vector3};

    use super::*;
    use crate::accel::random::Random;
    use crate::accel::{BuildOptions, WideBvh};

    fn boxes(count: usize, random: &mut Random) -> Vec<Bounds3> {
        let cube = |p: Point3| Bounds3::new(p, p).grown(0.02);
        (0..count).map(|i| if i % 50 == 7 { Bounds3::EMPTY } else { cube(random.point()) }).collect()
    }

    /// Whether a ray meets a box.
    fn meets(ray: &Ray, b: &Bounds3) -> bool {
        let (mut enter, mut leave) = (0.0_f64, f64::INFINITY);
        for axis in 0..3 {
            let at = |corner: Point3| (corner[axis] - ray.origin[axis]) / ray.direction[axis];
            let (one, other) = (at(b.min), at(b.max));
            (enter, leave) = (enter.max(one.min(other)), leave.min(one.max(other)));
        }
        enter <= leave
    }

    /// The boxes that rays meet, by the tree and by brute force: how many rays have another answer.
    fn wrong_answers(bvh: &Bvh, bounds: &[Bounds3]) -> usize {
        let bvh = WideBvh::from_binary(bvh);
        let mut random = Random(22);
        (0..500)
            .filter(|_| {
                let ray = Ray::new(random.point(), random.vector());
                let mut met = Vec::new();
                bvh.all(&ray, f64::INFINITY, |i| met.extend(Some(i as usize).filter(|i| meets(&ray, &bounds[*i]))));
                met.sort_unstable();
                let all = (0..bounds.len()).filter(|i| !bounds[*i].is_empty() && meets(&ray, &bounds[*i]));
                !all.eq(met)
            })
            .count()
    }

    #[test]
    fn follows_what_has_moved() {
        let mut random = Random(21);
        let before = boxes(1000, &mut random);
        let mut bvh = Bvh::build(&before).expect("finite boxes");
        let built = bvh.statistics().sah_cost;
        assert_eq!(bvh.refit(&before), Ok(built));
        // A little, all in one direction, and then anywhere.
        let shift = Vector3::new(0.5, -2.0, 0.25);
        let shifted: Vec<Bounds3> = before.iter().map(|b| Bounds3::new(b.min + shift, b.max + shift)).collect();
        let cost = bvh.refit(&shifted).expect("finite boxes");
        assert_eq!(bvh.validate(&shifted), Ok(()));
        assert!((cost - built).abs() < 1e-3 * built, "{cost} {built}");
        let elsewhere = boxes(1000, &mut random);
        assert!(wrong_answers(&bvh, &elsewhere) > 100, "the twin: boxes that do not follow give wrong answers");
        let cost = bvh.refit(&elsewhere).expect("finite boxes");
        assert_eq!((bvh.validate(&elsewhere), wrong_answers(&bvh, &elsewhere)), (Ok(()), 0));
        assert!(cost > 3.0 * built, "worse, and told so: {cost} {built}");
        assert_eq!(cost, bvh.statistics().sah_cost);
    }

    #[test]
    fn pieces_become_whole() {
        let mut random = Random(23);
        let triangles: Vec<[[f32; 3]; 3]> = (0..200)
            .map(|_| [0, 1, 2].map(|i| (random.vector() * [1.0, 1.0, 0.01][i]).to_array().map(|x| x as f32)))
            .collect();
        let build = Bvh::over_triangles(200, |i| triangles[i as usize], BuildOptions::default());
        let mut bvh = build.expect("not too many");
        assert!(bvh.primitives.len() > 200);
        let bounds: Vec<Bounds3> = triangles.iter().map(|corners| Box32::around(corners).to_bounds()).collect();
        bvh.refit(&bounds).expect("finite boxes");
        assert_eq!(wrong_answers(&bvh, &bounds), 0);
        assert_eq!(bvh.validate_triangles(200, |i| triangles[i as usize]), Ok(()));
    }

    #[test]
    fn another_set_is_refused() {
        let before = boxes(100, &mut Random(24));
        let mut bvh = Bvh::build(&before).expect("finite boxes");
        let good = bvh.clone();
        let mut with = |place: usize, b: Bounds3| {
            let mut after = before.clone();
            after[place] = b;
            bvh.refit(&after)
        };
        assert_eq!(with(3, Bounds3::EMPTY), Err(BuildError::Changed(3)));
        assert_eq!(with(7, before[8]), Err(BuildError::Changed(7)));
        assert_eq!(with(5, Bounds3::EVERYTHING), Err(BuildError::Unbounded(5)));
        assert_eq!(
            with(5, Bounds3::new(Point3::new(f64::NAN, 0.0, 0.0), Point3::ORIGIN)),
            Err(BuildError::NotANumber(5))
        );
        assert_eq!(bvh.refit(&before[..99]), Err(BuildError::Changed(99)));
        assert!(bvh == good);
        let mut nothing = Bvh::build(&[]).expect("no boxes");
        assert_eq!(nothing.refit(&[]), Ok(0.0));
    }
}
