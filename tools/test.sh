#!/usr/bin/env bash
# Every check of the project, as CI runs it: formatting, shaders, clippy, documentation, tests. Safe to repeat.
set -euo pipefail
cd "$(dirname "$0")/.."
. tools/prepare.sh

[ $# = 0 ] || fail "usage: tools/test.sh (it takes no arguments)"
say "checks of airglow: formatting, shaders, clippy, documentation, tests"
echo "Expect 10 to 15 minutes on two cores from a clean clone, about 2 when everything is built."

require_toolchain
for component in fmt clippy; do
    cargo "$component" --version > /dev/null 2>&1 || fail "cargo $component is missing; rustup component add rustfmt clippy"
done
# The software renderer and the layers that tests run under; a C++ compiler for the shader compiler of tools/xtask.
install_packages libvulkan1 mesa-vulkan-drivers vulkan-validationlayers g++

# All machines test on the same device: lavapipe, on two threads, its compiled shaders kept between runs.
driver=$(find /usr/share/vulkan/icd.d /etc/vulkan/icd.d -name 'lvp_icd*.json' 2> /dev/null | head -n 1)
[ -n "$driver" ] || fail "no lvp_icd*.json under /usr/share/vulkan/icd.d; mesa-vulkan-drivers should have put it there"
export VK_DRIVER_FILES=$driver VK_ICD_FILENAMES=$driver # the second name is that of older loaders
export LP_NUM_THREADS=2
export MESA_SHADER_CACHE_DIR=$PWD/target/mesa-shader-cache
mkdir -p "$MESA_SHADER_CACHE_DIR"

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
step shaders cargo run --locked --quiet -p xtask -- shaders --check
step portability cargo run --locked --quiet -p xtask -- portability --check
step clippy cargo clippy --locked --workspace --all-targets -- -D warnings
step documentation env RUSTDOCFLAGS="-D warnings" cargo doc --locked --workspace --lib --no-deps
step tests cargo test --locked --workspace --no-fail-fast

say "summary"
printf '%s\n' "${summary[@]}"
echo "total $SECONDS s"
[ $failures = 0 ] || fail "$failures of ${#summary[@]} steps failed"
