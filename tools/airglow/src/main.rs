//! The airglow command.
fn main() {}
