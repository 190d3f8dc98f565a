//! Tables addressed by typed ids, so that a material's number is never taken for a mesh's.

use std::fmt;
use std::marker::PhantomData;
use std::ops::Index;

/// The place of one entry in a [`Table`] of `T`.
pub struct Id<T> {
    index: u32,
    kind: PhantomData<fn() -> T>,
}

impl<T> Id<T> {
    /// From a place known to exist in the table it is used with.
    pub const fn from_index(index: u32) -> Self {
        Self { index, kind: PhantomData }
    }

    /// The place, from 0.
    pub const fn index(self) -> usize {
        self.index as usize
    }
}

// Derived implementations would ask the same of T.
impl<T> Clone for Id<T> {
    fn clone(&self) -> Self {
        *self
    }
}
impl<T> Copy for Id<T> {}
impl<T> PartialEq for Id<T> {
    fn eq(&self, other: &Self) -> bool {
        self.index == other.index
    }
}
impl<T> Eq for Id<T> {}
impl<T> fmt::Debug for Id<T> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "#{}", self.index)
    }
}

/// Entries in the order in which they were added; none is ever removed, so an [`Id`] stays good.
#[derive(Clone, Debug, PartialEq)]
pub struct Table<T> {
    entries: Vec<T>,
}

impl<T> Default for Table<T> {
    fn default() -> Self {
        Self { entries: Vec::new() }
    }
}

impl<T> Table<T> {
    /// Adds an entry and says where it went.
    ///
    /// # Panics
    /// Beyond 2³² entries.
    pub fn push(&mut self, entry: T) -> Id<T> {
        let index = u32::try_from(self.entries.len()).expect("fewer than 2^32 entries");
        self.entries.push(entry);
        Id::from_index(index)
    }

    /// How many there are.
    pub fn len(&self) -> usize {
        self.entries.len()
    }

    /// True where there are none.
    pub fn is_empty(&self) -> bool {
        self.entries.is_empty()
    }

    /// The entries in order.
    pub fn iter(&self) -> std::slice::Iter<'_, T> {
        self.entries.iter()
    }

    /// The ids with their entries in order.
    pub fn enumerate(&self) -> impl Iterator<Item = (Id<T>, &T)> {
        self.entries.iter().enumerate().map(|(i, e)| (Id::from_index(i as u32), e))
    }
}

impl<T> Index<Id<T>> for Table<T> {
    type Output = T;
    fn index(&self, id: Id<T>) -> &T {
        &self.entries[id.index()]
    }
}
