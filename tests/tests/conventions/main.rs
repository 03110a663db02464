//! The conventions of the project: those that CONVENTIONS.md states, and those that ARCHITECTURE.md sets for the code.

mod lengths;
mod modules;
mod stated;
