//! Work on all of the host's threads, with results in the order of what they are made of, whatever the number of threads.

use std::num::NonZero;
use std::thread;

/// `make` of every item.
pub(super) fn map<T: Sync, R: Send>(items: &[T], make: impl Fn(&T) -> R + Sync) -> Vec<R> {
    let threads = thread::available_parallelism().map_or(1, NonZero::get).min(items.len());
    if threads < 2 {
        return items.iter().map(make).collect();
    }
    let make = &make;
    thread::scope(|scope| {
        let part = |items| scope.spawn(move || Vec::from_iter(<[T]>::iter(items).map(make)));
        let parts: Vec<_> = items.chunks(items.len().div_ceil(threads)).map(part).collect();
        let joined = |part: thread::ScopedJoinHandle<'_, Vec<R>>| {
            part.join().unwrap_or_else(|panic| std::panic::resume_unwind(panic))
        };
        parts.into_iter().flat_map(joined).collect()
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn results_are_in_the_order_of_the_items() {
        for count in [0, 1, 2, 1001] {
            let items: Vec<usize> = (0..count).collect();
            assert_eq!(map(&items, |item| 3 * item), items.iter().map(|item| 3 * item).collect::<Vec<_>>());
        }
    }
}
