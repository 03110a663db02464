#!/usr/bin/env bash
# Every check of the project, as CI runs it: formatting, shaders, clippy, documentation, tests, rooms. Safe to repeat.
set -euo pipefail
cd "$(dirname "$0")/.."
. tools/prepare.sh

[ $# = 0 ] || fail "usage: tools/test.sh"
say "checks of airglow: formatting, shaders, clippy, documentation, tests, rooms"
echo "Expect about 18 minutes on two cores from a clean clone, less when things are built."

require_toolchain
for component in fmt clippy; do
    cargo "$component" --version > /dev/null 2>&1 || fail "cargo $component is missing; rustup component add rustfmt clippy"
done
use_lavapipe
# On a machine that builds once, what is kept for the next build, and the lines of a backtrace, only cost time.
[ -z "${CI:-}" ] || export CARGO_INCREMENTAL=0 CARGO_PROFILE_DEV_DEBUG=false

logs=${CARGO_TARGET_DIR:-target}/checks
mkdir -p "$logs"
summary=()
failures=0
record() {
    [ "$2" = ok ] || failures=$((failures + 1))
    summary+=("$(printf '%-14s %-7s %4d s' "$@")")
}
step() {
    local name=$1 start=$SECONDS result=ok
    shift
    say "$name: $*"
    "$@" || result=FAILED
    record "$name" $result $((SECONDS - start))
}
# Starts a step beside those that follow, which leave a core idle; what it says is kept until it is joined.
beside() {
    local name=$1 start=$SECONDS result=ok
    shift
    say "$name, beside what follows: $*"
    {
        "$@" > "$logs/$name.log" 2>&1 || result=FAILED
        echo "$result $((SECONDS - start))" > "$logs/$name.result"
    } &
}
join() {
    local result
    wait
    read -r -a result < "$logs/$1.result"
    say "$1, as it went beside"
    cat "$logs/$1.log"
    record "$1" "${result[@]}"
}

step formatting cargo fmt --all --check
# With the features of the whole workspace, so that its dependencies are those of the steps below.
step xtask cargo build --locked --workspace --bin xtask
step clippy cargo clippy --locked --workspace --all-targets -- -D warnings
# The libraries for hosts in C hold nothing but what airglow-capi exports, and one shares its name with the umbrella.
beside documentation env RUSTDOCFLAGS="-D warnings" \
    cargo doc --locked --workspace --exclude airglow-c --exclude airglow-conform --lib --no-deps
step shaders "${CARGO_TARGET_DIR:-target}/debug/xtask" shaders --check
step header "${CARGO_TARGET_DIR:-target}/debug/xtask" header --check
step portability "${CARGO_TARGET_DIR:-target}/debug/xtask" portability --check
join documentation
step programs cargo test --locked --workspace --no-run --quiet
beside rooms tools/rooms.sh
step tests cargo test --locked --workspace --no-fail-fast
join rooms

say "summary"
printf '%s\n' "${summary[@]}"
echo "total $SECONDS s"
[ $failures = 0 ] || fail "$failures of ${#summary[@]} steps failed"
