//! What objects are called: as their author named them, or else after what they are and their number.

use std::borrow::Cow;

/// The names of a scene's objects, by number. Those after a kind and a number are made when they are asked for: scenes of very
/// many objects name hardly any.
///
/// ```
/// use snell::{compile::CompiledScene, math::Point3, scene::scene::{Object, Scene, Shape}};
/// let ball = || Object::shape(Shape::Sphere { center: Point3::ORIGIN, radius: 1.0 });
/// let objects = vec![ball(), Object { name: Some("moon".to_owned()), ..ball() }];
/// let compiled = CompiledScene::build(&Scene { objects, ..Scene::default() })?;
/// assert_eq!(compiled.object_names.get(0).as_deref(), Some("sphere 1"));
/// assert_eq!(compiled.object_names.get(1).as_deref(), Some("moon"));
/// # Ok::<(), snell::compile::CompileError>(())
/// ```
#[derive(Clone, Debug, Default)]
pub struct ObjectNames {
    names: Vec<ObjectName>,
}

#[derive(Clone, Debug)]
enum ObjectName {
    Given(Box<str>),
    Kind(Cow<'static, str>),
}

impl ObjectNames {
    /// The name of an object: "left wall", or of the third object in the scene, a nameless ball, "sphere 3".
    pub fn get(&self, object: u32) -> Option<Cow<'_, str>> {
        Some(match self.names.get(object as usize)? {
            ObjectName::Given(name) => Cow::Borrowed(&**name),
            ObjectName::Kind(kind) => Cow::Owned(format!("{kind} {}", u64::from(object) + 1)),
        })
    }

    /// How many objects there are.
    pub fn len(&self) -> usize {
        self.names.len()
    }

    /// True where there are none.
    pub fn is_empty(&self) -> bool {
        self.names.is_empty()
    }

    /// Adds the next object, by its own name or else after its kind.
    pub(super) fn push(&mut self, name: Option<&str>, kind: impl FnOnce() -> Cow<'static, str>) {
        self.names.push(match name {
            Some(name) => ObjectName::Given(name.into()),
            None => ObjectName::Kind(kind()),
        });
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn objects_are_called_by_their_names_or_by_kind_and_number() {
        let mut names = ObjectNames::default();
        assert!(names.is_empty());
        names.push(Some("left wall"), || unreachable!("it has a name"));
        names.push(None, || "sphere".into());
        let name = |object| names.get(object).map(Cow::into_owned);
        assert_eq!(name(0).as_deref(), Some("left wall"));
        assert_eq!(name(1).as_deref(), Some("sphere 2"));
        assert_eq!((name(2), names.len()), (None, 2));
    }
}
