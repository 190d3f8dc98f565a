//! The order in which named things that refer to each other can be made: each after all that it refers to.

use std::collections::BTreeMap;

use super::Resolver;
use crate::document::model::{Located, Named};

impl Resolver<'_> {
    /// For each of the named things, which others it needs by `references`, and an order in which each comes after all that
    /// it needs. Those that need themselves are told ("the `kind` … `fault`: a → b → a") and left out of the order.
    pub(super) fn in_order<T>(
        &mut self,
        named: &Named<T>,
        kind: &str,
        fault: &str,
        references: impl for<'a> Fn(&'a T, &mut Vec<&'a str>),
    ) -> (Vec<Vec<usize>>, Vec<usize>) {
        let name = |i: usize| -> &Located<_> { &named.0[i].0 };
        let indices: BTreeMap<&str, usize> = (0..named.0.len()).map(|i| (&*name(i).value, i)).collect();
        let needs: Vec<Vec<usize>> = named
            .0
            .iter()
            .map(|(_, thing)| {
                let mut names = Vec::new();
                references(&thing.value, &mut names);
                names.iter().filter_map(|name| indices.get(name).copied()).collect()
            })
            .collect();
        let (order, cycles) = order(&needs);
        for cycle in cycles {
            let first = name(cycle[0]);
            let way: Vec<&str> = cycle.iter().chain(&cycle[..1]).map(|i| &*name(*i).value).collect();
            let message = format!("the {kind} {:?} {fault}: {}", first.value, way.join(" → "));
            self.error(&first.span, message, "defined here");
        }
        (needs, order)
    }
}

/// An order in which every node comes after those it needs, and the cycles that stand in the way, each as the nodes along
/// it. Nodes on cycles are left out of the order, those that need them are not. Works off a list instead of recursing, for
/// chains of any length.
fn order(needs: &[Vec<usize>]) -> (Vec<usize>, Vec<Vec<usize>>) {
    #[derive(Clone, Copy, PartialEq)]
    enum State {
        New,
        Open,
        Done,
    }
    let mut states = vec![State::New; needs.len()];
    let mut on_cycle = vec![false; needs.len()];
    let (mut order, mut cycles) = (Vec::new(), Vec::new());
    for start in 0..needs.len() {
        if states[start] != State::New {
            continue;
        }
        // The way to here: a node, and how many of its needs have been looked at.
        let mut way = vec![(start, 0)];
        states[start] = State::Open;
        while let Some((node, looked)) = way.last_mut() {
            let node = *node;
            if let Some(&next) = needs[node].get(*looked) {
                *looked += 1;
                match states[next] {
                    State::New => {
                        states[next] = State::Open;
                        way.push((next, 0));
                    }
                    State::Open => {
                        let from = way.iter().position(|(n, _)| *n == next).unwrap_or(0);
                        let cycle: Vec<usize> = way[from..].iter().map(|(n, _)| *n).collect();
                        cycle.iter().for_each(|n| on_cycle[*n] = true);
                        cycles.push(cycle);
                    }
                    State::Done => {}
                }
            } else {
                states[node] = State::Done;
                order.push(node);
                way.pop();
            }
        }
    }
    order.retain(|node| !on_cycle[*node]);
    (order, cycles)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_needed_comes_first() {
        let needs = [vec![2], vec![0, 2], vec![], vec![1]];
        assert_eq!(order(&needs), (vec![2, 0, 1, 3], vec![]));
    }

    #[test]
    fn cycles_are_found() {
        let needs = [vec![1], vec![2], vec![1], vec![3], vec![]];
        let (order, cycles) = order(&needs);
        assert_eq!(order, vec![0, 4]);
        assert_eq!(cycles, vec![vec![1, 2], vec![3]]);
    }

    #[test]
    fn long_chains_do_not_recurse() {
        let needs: Vec<Vec<usize>> = (0..200_000).map(|i| if i == 199_999 { vec![] } else { vec![i + 1] }).collect();
        assert_eq!(order(&needs).0.len(), needs.len());
    }
}
