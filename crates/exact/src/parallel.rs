//! The same work on many things, on all threads. What hands the work out is compiled here, once, and not again for every function that
//! is given.

use rayon::prelude::*;
use std::sync::Mutex;

/// What `of` makes of each item, in their order, on all threads.
pub fn map<T: Sync, R: Send>(items: &[T], of: impl Fn(&T) -> R + Sync) -> Vec<R> {
    numbered(items.len(), |index| of(&items[index]))
}

/// What `of` makes of each number below `count`, in their order, on all threads.
pub fn numbered<R: Send>(count: usize, of: impl Fn(usize) -> R + Sync) -> Vec<R> {
    let made: Vec<Mutex<Option<R>>> = (0..count).map(|_| Mutex::new(None)).collect();
    run(count, &|index| {
        let result = of(index);
        *made[index].lock().expect("nothing panics while it is held") = Some(result);
    });
    // Had `of` panicked, `run` would have gone on with that.
    made.into_iter().map(|made| made.into_inner().ok().flatten().expect("each number was worked on")).collect()
}

fn run(count: usize, work: &(dyn Fn(usize) + Sync)) {
    (0..count).into_par_iter().for_each(work);
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn results_stand_in_the_order_of_the_items() {
        let items: Vec<u64> = (0..1000).map(|i| i * 7 % 1000).collect();
        assert_eq!(map(&items, |item| item + 1), items.iter().map(|item| item + 1).collect::<Vec<_>>());
        assert_eq!(numbered(5, |index| index * index), [0, 1, 4, 9, 16]);
        assert!(map(&[] as &[u64], |item| *item).is_empty());
    }

    /// Within itself too, on the same threads.
    #[test]
    fn work_may_be_handed_out_within_work() {
        let sums = numbered(20, |i| numbered(20, |j| i * j).into_iter().sum::<usize>());
        assert_eq!(sums, (0..20).map(|i| 190 * i).collect::<Vec<_>>());
    }
}
