#!/usr/bin/env bash
# Every check of the project, as CI runs it: formatting, shaders, clippy, documentation, tests, rooms. Safe to repeat.
set -euo pipefail
cd "$(dirname "$0")/.."
. tools/prepare.sh

[ $# = 0 ] || fail "usage: tools/test.sh"
say "checks of airglow: formatting, shaders, clippy, documentation, tests, rooms"
echo "Expect about 18 minutes on two cores from a clean clone, about 6 when everything is built."

require_toolchain
for component in fmt clippy; do
    cargo "$component" --version > /dev/null 2>&1 || fail "cargo $component is missing; rustup component add rustfmt clippy"
done
use_lavapipe
# On a machine that builds once, what is kept for the next build, and the lines of a backtrace, only cost time.
[ -z "${CI:-}" ] || export CARGO_INCREMENTAL=0 CARGO_PROFILE_DEV_DEBUG=false

summary=()
failures=0
step() {
    local name=$1 start=$SECONDS result=ok
    shift
    say "$name: $*"
    "$@" || result=FAILED
    [ $result = ok ] || failures=$((failures + 1))
    summary+=("$(printf '%-14s %-7s %4d s' "$name" $result $((SECONDS - start)))")
}

step formatting cargo fmt --all --check
# With the features of the whole workspace, so that its dependencies are those of the steps below.
step xtask cargo build --locked --workspace --bin xtask
step shaders "${CARGO_TARGET_DIR:-target}/debug/xtask" shaders --check
step header "${CARGO_TARGET_DIR:-target}/debug/xtask" header --check
step portability "${CARGO_TARGET_DIR:-target}/debug/xtask" portability --check
step clippy cargo clippy --locked --workspace --all-targets -- -D warnings
# The libraries for hosts in C hold nothing but what airglow-capi exports, and one shares its name with the umbrella.
step documentation env RUSTDOCFLAGS="-D warnings" cargo doc --locked --workspace --exclude airglow-c --exclude airglow-conform --lib --no-deps
step tests cargo test --locked --workspace --no-fail-fast
step rooms tools/rooms.sh

say "summary"
printf '%s\n' "${summary[@]}"
echo "total $SECONDS s"
[ $failures = 0 ] || fail "$failures of ${#summary[@]} steps failed"
