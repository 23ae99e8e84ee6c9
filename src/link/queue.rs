//! Requests in flight: when each is due, and which one is answered next.

use std::collections::VecDeque;

use rand_xoshiro::Xoshiro256PlusPlus;

use super::direction::{Direction, Order, Shape};
use super::regulator::{chance, up_to};

/// The requests of one direction that have no response yet.
#[derive(Clone, Debug)]
pub(super) struct Queue<T> {
    direction: Direction,
    order: Order,
    waiting: VecDeque<(u64, T)>,
    /// Scratch: positions of the requests that are due.
    due: Vec<usize>,
}

impl<T> Queue<T> {
    pub(super) fn new(direction: Direction, order: Order) -> Self {
        Self { direction, order, waiting: VecDeque::new(), due: Vec::new() }
    }

    /// Adds a request that was accepted in cycle `now`.
    pub(super) fn push(&mut self, now: u64, item: T, random: &mut Xoshiro256PlusPlus) {
        let Direction { latency, tail, shape, stragglers, .. } = self.direction;
        let late = if chance(random, stragglers.share) { stragglers.cycles } else { 0 };
        let beyond = match shape {
            Shape::Even => up_to(random, tail),
            Shape::Geometric(_) => {
                let another = shape.chance_of_another();
                (0..tail).find(|_| !chance(random, another)).unwrap_or(tail)
            }
        };
        let due = now + u64::from(latency) + u64::from(beyond) + u64::from(late);
        self.waiting.push_back((due, item));
    }

    /// Takes the request that is answered in cycle `now`, if one is due and `may_leave`.
    pub(super) fn pop(
        &mut self,
        now: u64,
        random: &mut Xoshiro256PlusPlus,
        may_leave: impl Fn(&T) -> bool,
    ) -> Option<T> {
        let ready = |(due, item): &(u64, T)| *due <= now && may_leave(item);
        let index = match self.order {
            Order::InOrder => self.waiting.front().is_some_and(ready).then_some(0)?,
            Order::Shuffled => {
                self.due.clear();
                self.due.extend((0..self.waiting.len()).filter(|&i| ready(&self.waiting[i])));
                let last = u32::try_from(self.due.len().checked_sub(1)?).unwrap_or(u32::MAX);
                self.due[up_to(random, last) as usize]
            }
        };
        self.waiting.remove(index).map(|(_, item)| item)
    }

    pub(super) fn iter_mut(&mut self) -> impl Iterator<Item = &mut T> {
        self.waiting.iter_mut().map(|(_, item)| item)
    }

    /// True if the link accepts another request.
    pub(super) fn has_room(&self) -> bool {
        self.waiting.len() < self.direction.in_flight as usize
    }

    pub(super) fn len(&self) -> usize {
        self.waiting.len()
    }
}
