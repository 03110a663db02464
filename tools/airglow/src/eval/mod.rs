//! A pass's own code on rows of parameters: a table in, the same table with result columns out.

pub mod number;
pub mod table;
