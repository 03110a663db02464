#!/usr/bin/env bash
# Every check of the project, as CI runs it: formatting, shaders, clippy, documentation, tests, rooms. Safe to repeat.
set -euo pipefail
cd "$(dirname "$0")/.."
. tools/prepare.sh

[ $# = 0 ] || fail "usage: tools/test.sh"
say "checks of airglow: formatting, shaders, clippy, documentation, tests, rooms"
echo "Expect 15 to 35 minutes on two cores from a clean clone, less when things are built."

require_toolchain
for component in fmt clippy; do
    cargo "$component" --version > /dev/null 2>&1 || fail "cargo $component is missing; rustup component add rustfmt clippy"
done
use_lavapipe
# On a machine that builds once, what is kept for the next build, and the lines of a backtrace, only cost time.
[ -z "${CI:-}" ] || export CARGO_INCREMENTAL=0 CARGO_PROFILE_DEV_DEBUG=false

logs=$build_folder/checks
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
# Starts a step beside those that follow, which leave a core idle; what it says is kept until it is joined. Its seconds
# hold those in which it waits for another step that has its target folder.
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
    local name result
    wait
    for name in "$@"; do
        read -r -a result < "$logs/$name.result"
        say "$name, as it went beside"
        cat "$logs/$name.log"
        record "$name" "${result[@]}"
    done
}

step formatting cargo fmt --all --check
beside clippy check_cargo clippy --locked --workspace --all-targets -- -D warnings
# The libraries for hosts in C hold nothing but what airglow-capi exports, and one shares its name with the umbrella.
RUSTDOCFLAGS="-D warnings" beside documentation \
    check_cargo doc --locked --workspace --exclude airglow-c --exclude airglow-conform --lib --no-deps
# With the features of the whole workspace, so that its dependencies are those of the programs below.
step xtask cargo build --locked --workspace --bin xtask
export XTASK=$build_folder/debug/xtask
step shaders "$XTASK" shaders --check
step header "$XTASK" header --check
step portability "$XTASK" portability --check
join clippy documentation
beside rooms tools/rooms.sh
# Clippy has checked the examples, which are programs to measure with; no test runs them.
step programs cargo test --locked --workspace --tests --no-run --quiet
step tests cargo test --locked --workspace --tests --no-fail-fast
step doctests cargo test --locked --workspace --doc --no-fail-fast
join rooms

say "summary"
printf '%s\n' "${summary[@]}"
# What the processors worked tells a busy machine from a long run.
times > "$logs/times"
echo "total $SECONDS s, $(awk -F '[ms ]+' 'NR == 2 {printf "%d", 60 * ($1 + $3) + $2 + $4}' "$logs/times") s of processors' time"
[ $failures = 0 ] || fail "$failures of ${#summary[@]} steps failed"
