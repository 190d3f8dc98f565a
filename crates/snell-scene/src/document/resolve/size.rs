//! How much a scene stands for once its grids and instances are spelt out: bounded, so that a few lines cannot ask for more
//! memory than there is.

use crate::scene::{Object, ObjectKind};

/// The most shapes that a scene may stand for.
const MAX_SHAPES: u64 = 10_000_000;
/// How deep objects may stand within each other, through instances too.
const MAX_DEPTH: u32 = 256;

/// How much something stands for.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct Size {
    /// Shapes, every copy counted; the largest number where there are more.
    shapes: u64,
    /// Objects within each other.
    depth: u32,
}

impl Size {
    /// The size of an object, by the sizes of the prototypes before it.
    pub fn of(object: &Object, prototypes: &[Self]) -> Self {
        let inside = match &object.kind {
            ObjectKind::Shape(_) => Self { shapes: 1, depth: 0 },
            ObjectKind::Group(parts) | ObjectKind::Csg { parts, .. } => Self::of_all(parts, prototypes),
            ObjectKind::Instance(id) => prototypes.get(id.index()).copied().unwrap_or_default(),
            ObjectKind::Grid(grid) => {
                let of = Self::of(&grid.of, prototypes);
                let copies = grid.count.iter().fold(1_u64, |product, count| product.saturating_mul(u64::from(*count)));
                Self { shapes: of.shapes.max(1).saturating_mul(copies), depth: of.depth }
            }
        };
        Self { shapes: inside.shapes, depth: inside.depth.saturating_add(1) }
    }

    /// The size of several objects side by side.
    pub fn of_all(objects: &[Object], prototypes: &[Self]) -> Self {
        objects.iter().fold(Self::default(), |sum, object| sum.and(Self::of(object, prototypes)))
    }

    /// Both side by side.
    pub fn and(self, other: Self) -> Self {
        Self { shapes: self.shapes.saturating_add(other.shapes), depth: self.depth.max(other.depth) }
    }

    /// In words, what is too much.
    pub fn excess(self) -> Option<String> {
        if self.shapes > MAX_SHAPES {
            let shapes = match self.shapes {
                u64::MAX => "far more shapes than".to_owned(),
                shapes => format!("{shapes} shapes, more than"),
            };
            Some(format!("stands for {shapes} the limit of {MAX_SHAPES}"))
        } else if self.depth > MAX_DEPTH {
            Some(format!(
                "is made of objects {} deep within each other, more than the limit of {MAX_DEPTH}",
                self.depth
            ))
        } else {
            None
        }
    }
}
