//! Queues of rays and of questions to lights, laid out for eight at a time: what arithmetic looks at stands in rows of eight
//! numbers, see [`snell_math::lanes`].

use snell_math::lanes::{Bits, WIDTH};
use snell_math::{Point3, Ray, Rgb, Vector3};

use super::{Band, MediumStack, RayKind, RayTask, ShadowQuestion, Term};

/// Eight rays to be traced.
#[derive(Clone, Copy, Debug)]
pub struct RayRows {
    /// Their origins: the rows of x, y and z. World space.
    pub origin: [[f64; WIDTH]; 3],
    /// Their directions, unit length.
    pub direction: [[f64; WIDTH]; 3],
    /// See [`RayTask::throughput`]; the rows of red, green and blue.
    pub throughput: [[f32; WIDTH]; 3],
    /// See [`RayTask::sample`].
    pub sample: [u32; WIDTH],
    /// See [`RayTask::media`].
    pub media: [MediumStack; WIDTH],
    /// What most of shading passes on unseen.
    pub notes: [RayNotes; WIDTH],
}

/// What is known of a ray besides where it goes and what it carries. The fields are those of [`RayTask`].
#[derive(Clone, Copy, Debug)]
pub struct RayNotes {
    /// See [`RayTask::id`].
    pub id: u32,
    /// See [`RayTask::id`].
    pub parent: u32,
    /// See [`RayTask::split`].
    pub split: u32,
    /// See [`RayTask::depth`].
    pub depth: u16,
    /// See [`RayTask::passes`].
    pub passes: u16,
    /// See [`RayTask::band`].
    pub band: Option<Band>,
    /// See [`RayTask::kind`].
    pub kind: RayKind,
}

impl RayRows {
    const EMPTY: Self = Self {
        origin: [[0.0; WIDTH]; 3],
        direction: [[0.0; WIDTH]; 3],
        throughput: [[0.0; WIDTH]; 3],
        sample: [0; WIDTH],
        media: [MediumStack::EMPTY; WIDTH],
        notes: [RayNotes { id: 0, parent: 0, split: 0, depth: 0, passes: 0, band: None, kind: RayKind::Camera }; WIDTH],
    };

    /// The ray of one lane.
    #[inline]
    pub fn ray(&self, lane: usize) -> Ray {
        Ray::new(Point3::from(column(&self.origin, lane)), Vector3::from(column(&self.direction, lane)))
    }

    /// The task of one lane.
    #[inline]
    pub fn task(&self, lane: usize) -> RayTask {
        let RayNotes { id, parent, split, depth, passes, band, kind } = self.notes[lane];
        RayTask {
            ray: self.ray(lane),
            throughput: Rgb::from(column(&self.throughput, lane)),
            sample: self.sample[lane],
            id,
            parent,
            media: self.media[lane],
            depth,
            passes,
            kind,
            band,
            split,
        }
    }

    /// Puts a task into one lane.
    #[inline]
    pub fn set(&mut self, lane: usize, task: &RayTask) {
        set_column(&mut self.origin, lane, task.ray.origin.to_array());
        set_column(&mut self.direction, lane, task.ray.direction.to_array());
        set_column(&mut self.throughput, lane, task.throughput.to_array());
        self.sample[lane] = task.sample;
        self.media[lane] = task.media;
        let RayTask { id, parent, split, depth, passes, band, kind, .. } = *task;
        self.notes[lane] = RayNotes { id, parent, split, depth, passes, band, kind };
    }
}

/// Eight questions to lights.
#[derive(Clone, Copy, Debug)]
pub struct QuestionRows {
    /// The rays' origins. World space.
    pub origin: [[f64; WIDTH]; 3],
    /// The rays' directions, unit length.
    pub direction: [[f64; WIDTH]; 3],
    /// See [`ShadowQuestion::distance`].
    pub distance: [f64; WIDTH],
    /// What each term adds, see [`ShadowQuestion::terms`].
    pub shares: [[[f32; WIDTH]; 3]; 2],
    /// See [`ShadowQuestion::sample`].
    pub sample: [u32; WIDTH],
    /// See [`ShadowQuestion::media`].
    pub media: [MediumStack; WIDTH],
    /// What only some answers depend on.
    pub notes: [QuestionNotes; WIDTH],
}

/// What is known of a question besides its ray and what depends on the answer. The fields are those of [`ShadowQuestion`].
#[derive(Clone, Copy, Debug)]
pub struct QuestionNotes {
    /// Which terms.
    pub terms: [Term; 2],
    /// See [`ShadowQuestion::task`].
    pub task: u32,
    /// See [`ShadowQuestion::extinction_scale`].
    pub extinction_scale: f32,
}

impl QuestionRows {
    const EMPTY: Self = Self {
        origin: [[0.0; WIDTH]; 3],
        direction: [[0.0; WIDTH]; 3],
        distance: [0.0; WIDTH],
        shares: [[[0.0; WIDTH]; 3]; 2],
        sample: [0; WIDTH],
        media: [MediumStack::EMPTY; WIDTH],
        notes: [QuestionNotes { terms: [Term::Background; 2], task: 0, extinction_scale: 1.0 }; WIDTH],
    };

    /// The ray of one lane.
    #[inline]
    pub fn ray(&self, lane: usize) -> Ray {
        Ray::new(Point3::from(column(&self.origin, lane)), Vector3::from(column(&self.direction, lane)))
    }

    /// The question of one lane.
    #[inline]
    pub fn question(&self, lane: usize) -> ShadowQuestion {
        let QuestionNotes { terms, task, extinction_scale } = self.notes[lane];
        let share = |number: usize| (terms[number], Rgb::from(column(&self.shares[number], lane)));
        ShadowQuestion {
            ray: self.ray(lane),
            distance: self.distance[lane],
            terms: [share(0), share(1)],
            sample: self.sample[lane],
            task,
            media: self.media[lane],
            extinction_scale,
        }
    }

    #[inline]
    fn set(&mut self, lane: usize, question: &ShadowQuestion) {
        set_column(&mut self.origin, lane, question.ray.origin.to_array());
        set_column(&mut self.direction, lane, question.ray.direction.to_array());
        self.distance[lane] = question.distance;
        for (rows, (_, share)) in self.shares.iter_mut().zip(question.terms) {
            set_column(rows, lane, share.to_array());
        }
        self.sample[lane] = question.sample;
        self.media[lane] = question.media;
        let ShadowQuestion { terms: [(first, _), (second, _)], task, extinction_scale, .. } = *question;
        self.notes[lane] = QuestionNotes { terms: [first, second], task, extinction_scale };
    }
}

/// Something that stands in rows of eight.
pub trait Rows: Copy {
    /// One of the eight, taken out.
    type Item: Copy;
    /// Rows with nothing in them yet.
    const NOTHING: Self;
    /// Puts one in.
    fn put(&mut self, lane: usize, item: &Self::Item);
}

impl Rows for RayRows {
    type Item = RayTask;
    const NOTHING: Self = Self::EMPTY;
    #[inline]
    fn put(&mut self, lane: usize, item: &RayTask) {
        self.set(lane, item);
    }
}

impl Rows for QuestionRows {
    type Item = ShadowQuestion;
    const NOTHING: Self = Self::EMPTY;
    #[inline]
    fn put(&mut self, lane: usize, item: &ShadowQuestion) {
        self.set(lane, item);
    }
}

/// A queue in rows of eight. Its memory is kept from use to use.
#[derive(Clone, Debug)]
pub struct Queue<R> {
    rows: Vec<R>,
    count: usize,
}

/// Rays to be traced.
pub type RayQueue = Queue<RayRows>;
/// Questions to be answered.
pub type QuestionQueue = Queue<QuestionRows>;

impl<R> Default for Queue<R> {
    fn default() -> Self {
        Self { rows: Vec::new(), count: 0 }
    }
}

impl<R: Rows> Queue<R> {
    /// Takes everything out.
    pub fn clear(&mut self) {
        self.count = 0;
    }

    /// How many are in it.
    #[inline]
    pub fn len(&self) -> usize {
        self.count
    }

    /// True where none is in it.
    #[inline]
    pub fn is_empty(&self) -> bool {
        self.count == 0
    }

    /// Puts one at the end.
    #[inline]
    pub fn push(&mut self, item: &R::Item) {
        let (rows, lane) = self.next_place();
        rows.put(lane, item);
    }

    /// Makes place for one at the end: rows and a lane in them, to be written to.
    #[inline(always)]
    pub fn next_place(&mut self) -> (&mut R, usize) {
        let (row, lane) = (self.count / WIDTH, self.count % WIDTH);
        if row == self.rows.len() {
            self.grow();
        }
        self.count += 1;
        (&mut self.rows[row], lane)
    }

    /// Makes place for up to eight at the end: the rows where the first of them goes, at the place that is told, and those that follow.
    #[inline(always)]
    pub fn extend(&mut self, count: usize) -> ([&mut R; 2], usize) {
        let (row, lane) = (self.count / WIDTH, self.count % WIDTH);
        while self.rows.len() < row + 2 {
            self.grow();
        }
        self.count += count;
        let (first, rest) = self.rows[row..].split_at_mut(1);
        ([&mut first[0], &mut rest[0]], lane)
    }

    #[cold]
    fn grow(&mut self) {
        self.rows.push(R::NOTHING);
    }

    /// Makes it hold so many, of which nothing is known yet: see [`Queue::rows_mut`].
    pub fn fill(&mut self, count: usize) {
        self.count = count;
        while self.rows.len() < count.div_ceil(WIDTH) {
            self.grow();
        }
    }

    /// The rows in use.
    pub fn rows_mut(&mut self) -> &mut [R] {
        &mut self.rows[..self.count.div_ceil(WIDTH)]
    }

    /// The rows in use, with which of their lanes are.
    #[inline]
    pub fn rows(&self) -> impl ExactSizeIterator<Item = (&R, Bits)> {
        let count = self.count;
        self.rows[..count.div_ceil(WIDTH)]
            .iter()
            .enumerate()
            .map(move |(row, rows)| (rows, Bits::first((count - row * WIDTH).min(WIDTH))))
    }
}

/// One lane of several rows.
#[inline(always)]
pub fn column<T: Copy, const N: usize>(rows: &[[T; WIDTH]; N], lane: usize) -> [T; N] {
    std::array::from_fn(|row| rows[row][lane])
}

/// Sets one lane of several rows.
#[inline(always)]
pub fn set_column<T, const N: usize>(rows: &mut [[T; WIDTH]; N], lane: usize, values: [T; N]) {
    for (row, value) in rows.iter_mut().zip(values) {
        row[lane] = value;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn task(number: u32) -> RayTask {
        let at = f64::from(number);
        RayTask {
            ray: Ray::new(Point3::new(at, at + 0.25, at + 0.5), Vector3::new(-at, 1.0, 2.0 * at)),
            throughput: Rgb::new(0.25, 0.5, number as f32),
            sample: number,
            id: number + 1,
            parent: number + 2,
            media: MediumStack::EMPTY,
            depth: number as u16,
            passes: 3,
            kind: RayKind::Refracted,
            band: Some(Band(number as u16)),
            split: 7,
        }
    }

    #[test]
    fn what_is_put_into_a_queue_comes_out_of_its_rows() {
        let mut queue = RayQueue::default();
        for round in [19, 8, 0, 3] {
            queue.clear();
            (0..round).for_each(|number| queue.push(&task(number)));
            assert_eq!((queue.len(), queue.is_empty()), (round as usize, round == 0));
            let mut found = 0;
            for (rows, active) in queue.rows() {
                for lane in active.lanes() {
                    assert_eq!(format!("{:?}", rows.task(lane)), format!("{:?}", task(found)));
                    found += 1;
                }
            }
            assert_eq!(found, round);
        }
    }

    #[test]
    fn questions_come_out_as_they_were() {
        let mut queue = QuestionQueue::default();
        let question = |number: u32| ShadowQuestion {
            ray: task(number).ray,
            distance: f64::from(number),
            terms: [(Term::Diffuse(number), Rgb::gray(0.5)), (Term::Specular(number), Rgb::new(0.0, 1.0, 2.0))],
            sample: number,
            task: 2 * number,
            media: MediumStack::EMPTY,
            extinction_scale: 0.25,
        };
        (0..11).for_each(|number| queue.push(&question(number)));
        let found: Vec<ShadowQuestion> =
            queue.rows().flat_map(|(rows, active)| active.lanes().map(|lane| rows.question(lane))).collect();
        assert_eq!(found.len(), 11);
        for (number, found) in (0..).zip(&found) {
            assert_eq!(format!("{found:?}"), format!("{:?}", question(number)));
        }
    }
}
