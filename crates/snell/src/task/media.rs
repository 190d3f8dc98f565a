//! Which transparent bodies a ray is in: the stack of nested dielectrics.
//!
//! Schmidt and Budge, "Simple Nested Dielectrics in Ray Traced Images", Journal of Graphics Tools 7(2), 2002: of the bodies a
//! ray is in, the one of the highest priority is there. Here, of equal ones, the one entered last, so that an air ball
//! modelled inside a glass ball is a bubble without a word about priorities.
//!
//! A stack is a place in an arena of linked cells, so a ray carries four bytes however deep bodies nest, and siblings share
//! what they have in common.

use crate::interaction::SolidId;

/// The bodies around a point: a place in [`MediumStacks`]. The default is the empty stack, outside of everything.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default, bytemuck::Pod, bytemuck::Zeroable)]
#[repr(transparent)]
pub struct MediumStack(u32);

/// One body of a stack.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Inside {
    /// Which body.
    pub solid: SolidId,
    /// Its material, as a place in the scene's list.
    pub material: u32,
    /// Its priority.
    pub priority: i32,
}

/// A ray's way through one boundary.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub struct Crossing {
    /// The body that is there before the boundary.
    pub before: Option<Inside>,
    /// The body that is there behind it.
    pub beyond: Option<Inside>,
    /// The stack behind it.
    pub after: MediumStack,
}

impl Crossing {
    /// True where the same body is there on both sides, because another one of higher priority covers the boundary.
    pub fn is_without_effect(&self) -> bool {
        self.before == self.beyond
    }
}

#[derive(Clone, Copy, Debug)]
struct Cell {
    inside: Inside,
    /// The body that is there, of this one and those below.
    current: Inside,
    below: MediumStack,
}

/// The arena of stacks of one tile.
#[derive(Clone, Debug, Default)]
pub struct MediumStacks {
    cells: Vec<Cell>,
}

impl MediumStack {
    /// Outside of everything.
    pub const EMPTY: Self = Self(0);
}

impl MediumStacks {
    /// Forgets all stacks but the empty one; no [`MediumStack`] from before may be used again.
    pub fn clear(&mut self) {
        self.cells.clear();
    }

    /// The stack with one more body on top.
    #[inline]
    pub fn enter(&mut self, stack: MediumStack, inside: Inside) -> MediumStack {
        // The same body is often entered from the same place by many rays of a tile, one after the other.
        if let Some(last) = self.cells.last()
            && last.inside == inside
            && last.below == stack
        {
            return MediumStack(self.cells.len() as u32);
        }
        let current = self.current(stack).filter(|below| below.priority > inside.priority).unwrap_or(inside);
        self.cells.push(Cell { inside, current, below: stack });
        MediumStack(self.cells.len() as u32)
    }

    /// The stack without the topmost entry of a body; the same stack where the body is not in it.
    #[inline]
    pub fn leave(&mut self, stack: MediumStack, solid: SolidId) -> MediumStack {
        match self.cell(stack) {
            None => stack,
            Some(cell) if cell.inside.solid == solid => cell.below,
            Some(_) if !self.contains(stack, solid) => stack,
            Some(_) => self.leave_below(stack, solid),
        }
    }

    /// The stack without the topmost entry of a body that is in it somewhere.
    fn leave_below(&mut self, stack: MediumStack, solid: SolidId) -> MediumStack {
        // Keep what is above it, in order.
        let mut above = Vec::new();
        let mut at = stack;
        while let Some(cell) = self.cell(at) {
            at = cell.below;
            if cell.inside.solid == solid {
                break;
            }
            above.push(cell.inside);
        }
        above.into_iter().rev().fold(at, |below, inside| self.enter(below, inside))
    }

    /// The body that is there: of the highest priority, and of those the one entered last; `None` outside of all.
    #[inline]
    pub fn current(&self, stack: MediumStack) -> Option<Inside> {
        self.cell(stack).map(|cell| cell.current)
    }

    /// A ray that travels in `stack` goes through the boundary of `inside`, into it or out of it.
    ///
    /// A ray that leaves a body which it is not known to be in, such as one that began inside an open surface, counts as having
    /// been in it. But where it does so `at_origin`, where it begins, rounding has put its beginning on the wrong side of the
    /// boundary, which then has no effect; and so it is where it enters there a body that it is in already.
    #[inline]
    pub fn cross(&mut self, stack: MediumStack, inside: Inside, leaving: bool, at_origin: bool) -> Crossing {
        if at_origin && leaving != self.contains(stack, inside.solid) {
            let current = self.current(stack);
            Crossing { before: current, beyond: current, after: stack }
        } else if leaving {
            let within = if self.contains(stack, inside.solid) { stack } else { self.enter(stack, inside) };
            let after = self.leave(within, inside.solid);
            Crossing { before: self.current(within), beyond: self.current(after), after }
        } else {
            let after = self.enter(stack, inside);
            Crossing { before: self.current(stack), beyond: self.current(after), after }
        }
    }

    /// True where the body is in the stack.
    #[inline]
    pub fn contains(&self, stack: MediumStack, solid: SolidId) -> bool {
        let mut at = stack;
        while let Some(cell) = self.cell(at) {
            if cell.inside.solid == solid {
                return true;
            }
            at = cell.below;
        }
        false
    }

    #[inline]
    fn cell(&self, stack: MediumStack) -> Option<&Cell> {
        // Stack 0 is the empty one; stack n is the cell n − 1.
        (stack.0 as usize).checked_sub(1).map(|index| &self.cells[index])
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn inside(solid: u64, priority: i32) -> Inside {
        Inside { solid: SolidId(solid), material: solid as u32, priority }
    }

    #[test]
    fn the_last_entered_of_equals_is_there() {
        let mut stacks = MediumStacks::default();
        let glass = stacks.enter(MediumStack::default(), inside(1, 0));
        let bubble = stacks.enter(glass, inside(2, 0));
        assert_eq!(stacks.current(bubble), Some(inside(2, 0)));
        assert_eq!(stacks.leave(bubble, SolidId(2)), glass);
        let odd = stacks.leave(bubble, SolidId(1));
        assert_eq!(stacks.current(odd), Some(inside(2, 0)));
        assert_eq!(stacks.leave(odd, SolidId(2)), MediumStack::default());
    }

    #[test]
    fn priority_goes_before_order() {
        let mut stacks = MediumStacks::default();
        let glass = stacks.enter(MediumStack::default(), inside(1, 5));
        let water_in_glass = stacks.enter(glass, inside(2, 0));
        assert_eq!(stacks.current(water_in_glass), Some(inside(1, 5)));
        let water = stacks.leave(water_in_glass, SolidId(1));
        assert_eq!(stacks.current(water), Some(inside(2, 0)));
    }

    #[test]
    fn leaving_what_was_never_entered_changes_nothing() {
        let mut stacks = MediumStacks::default();
        let glass = stacks.enter(MediumStack::default(), inside(1, 0));
        assert_eq!(stacks.leave(glass, SolidId(9)), glass);
        assert_eq!(stacks.leave(MediumStack::default(), SolidId(9)), MediumStack::default());
    }

    #[test]
    fn a_boundary_on_the_wrong_side_of_a_rays_beginning_has_no_effect() {
        let mut stacks = MediumStacks::default();
        let (body, outside) = (inside(1, 0), MediumStack::default());
        let within = stacks.enter(outside, body);
        // It is in the body, and seems to enter it; it is outside, and seems to leave it.
        for (stack, leaving) in [(within, false), (outside, true)] {
            let crossing = stacks.cross(stack, body, leaving, true);
            assert!(crossing.is_without_effect() && crossing.after == stack);
            assert!(!(leaving && stacks.cross(stack, body, leaving, false).is_without_effect()));
        }
        // What is really crossed there is crossed.
        assert_eq!(stacks.cross(within, body, true, true).after, outside);
        assert_eq!(stacks.cross(outside, body, false, true).beyond, Some(body));
    }

    #[test]
    fn any_number_of_bodies_nests() {
        let mut stacks = MediumStacks::default();
        let mut stack = MediumStack::default();
        for n in 0..1000 {
            stack = stacks.enter(stack, inside(n, 0));
        }
        for n in 0..1000 {
            stack = stacks.leave(stack, SolidId(n));
        }
        assert_eq!(stack, MediumStack::default());
    }
}
