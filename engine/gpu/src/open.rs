//! A device of its own, for command-line tools and tests: never for hosts.
