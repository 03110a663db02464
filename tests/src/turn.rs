//! One test at a time on Vulkan in a process: the validation layers of 1.3.239 look up an instance or a device in a table
//! that they do not lock while another thread makes or destroys one, and crash, once in some hundred runs.

use std::cell::RefCell;
use std::marker::PhantomData;
use std::sync::{Mutex, MutexGuard, PoisonError};

static TURN: Mutex<()> = Mutex::new(());

thread_local! {
    /// How many turns this thread has taken and not given back, and what they hold.
    static HELD: RefCell<(usize, Option<MutexGuard<'static, ()>>)> = const { RefCell::new((0, None)) };
}

/// The turn of this thread, held until the last one that it took is dropped.
#[must_use]
pub struct Turn {
    /// Given back on the thread that took it.
    thread: PhantomData<*const ()>,
}

impl Turn {
    /// Waits until no other thread has the turn.
    pub fn take() -> Self {
        HELD.with_borrow_mut(|(count, held)| {
            // What a failed test leaves behind is no one else's.
            held.get_or_insert_with(|| TURN.lock().unwrap_or_else(PoisonError::into_inner));
            *count += 1;
        });
        Self { thread: PhantomData }
    }
}

impl Drop for Turn {
    fn drop(&mut self) {
        HELD.with_borrow_mut(|(count, held)| {
            *count -= 1;
            if *count == 0 {
                *held = None;
            }
        });
    }
}
