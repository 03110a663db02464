#!/usr/bin/env bash
# Proves that rooms come and go: in a copy of this tree, removes each room in turn and checks that all that names it
# builds without a warning; builds the command and the umbrella with each room alone, and with none; makes a room from the
# template and runs its checks. Nothing outside target/ changes. Safe to repeat.
#   tools/rooms.sh [ROOM...]        ROOM: remove only this one; defaults to all below passes/
set -euo pipefail
cd "$(dirname "$0")/.."
. tools/prepare.sh

require_toolchain
use_lavapipe
tree=$PWD
copy=$tree/target/rooms
export CARGO_TARGET_DIR=$build_folder

# Built in the tree, with the features of the whole workspace as tools/test.sh does, which names the one it has; it works
# on the folder it runs in.
[ -n "${XTASK:-}" ] || cargo build --locked --quiet --workspace --bin xtask
xtask=${XTASK:-$build_folder/debug/xtask}

# A copy of the working tree without what git ignores. Its crates have a version of their own, so that in the shared
# target folder they stand beside those of the tree, and only what comes from registries is shared. Warnings are errors.
rm -rf "$copy"
mkdir -p "$copy"
git ls-files -z --cached --others --exclude-standard --deduplicate |
    while IFS= read -r -d '' file; do [ ! -e "$file" ] || printf '%s\0' "$file"; done |
    tar --null --files-from=- -cf - | tar -C "$copy" --touch -xf -
cd "$copy"
mapfile -t rooms < <(cd passes && ls -d -- */Cargo.toml | xargs --max-args=1 dirname)
sed -i '0,/^version = .*/s//version = "0.0.0"/' Cargo.toml
sed -i 's/^\[workspace\.lints\.rust\]$/&\nwarnings = "deny"/' Cargo.toml
# As removing a room has it, which then changes nothing that all crates depend on.
known=$(printf ', "%s"' "${rooms[@]}")
sed -i "s/^warnings = .*/&\nunexpected_cfgs = { level = \"warn\", check-cfg = ['cfg(feature, values(${known:2}))'] }/" Cargo.toml
cargo update --quiet --workspace --offline
git init --quiet
git add --all

# The copy as it was; the room's own files keep their times, so that they are not built again.
restore() {
    git checkout --quiet -- .
    git clean --quiet --force -d
    git ls-files -z -- "passes/$1" | xargs --null --no-run-if-empty touch --reference .git/config
}

# With these beside it, a package is built with the dependencies of the whole workspace, and not once more with fewer.
many=(--package airglow-cli --package xtask)

# Runs what follows the title; says how long it took.
step() {
    local title=$1 start=$SECONDS
    shift
    "$@"
    echo "$title: $((SECONDS - start)) s"
}

without() {
    "$xtask" room "$1" --remove > /dev/null
    check_cargo check --locked --quiet --workspace --all-targets
    restore "$1"
}

alone() {
    check_cargo check --locked --quiet --package airglow "${many[@]}" --all-targets --no-default-features --features "$1"
}

from_template() {
    local packages=(--package airglow-sample --package airglow)
    "$xtask" room sample > /dev/null
    cargo fmt "${packages[@]}" -- --check
    check_cargo clippy --locked --quiet "${packages[@]}" "${many[@]}" --all-targets -- -D warnings
    RUSTDOCFLAGS="-D warnings" check_cargo doc --locked --quiet "${packages[@]}" "${many[@]}" --lib --no-deps
    # Not optimised: here it is building that takes time.
    CARGO_PROFILE_DEV_OPT_LEVEL=0 cargo test --locked --quiet --package airglow-sample "${many[@]}" --lib --test plan --test gpu
}

[ $# = 0 ] || rooms=("$@")
for room in "${rooms[@]}"; do
    step "without $room" without "$room"
done
step "no room" alone ""
for room in "${rooms[@]}"; do
    # Not every room is a feature of the umbrella.
    ! grep --quiet "^$room = \[" passes/Cargo.toml || step "$room alone" alone "$room"
done
step "a room from the template" from_template
cd "$tree"
rm -rf "$copy"
say "rooms come and go: $SECONDS s"
