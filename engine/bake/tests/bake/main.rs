//! The bake against closed forms, the reference and bad input; its cache.

mod cache;
mod closed_forms;
mod common;
mod inputs;
mod reference;
