#!/usr/bin/env bash
# Proves that rooms come and go: in a copy of this tree, makes one from the template and runs all its checks, then
# removes each room in turn and checks that all that remains builds. Nothing outside target/ changes. Safe to repeat.
#   tools/rooms.sh [NAME]        NAME of the room that is made; defaults to sample
set -euo pipefail
cd "$(dirname "$0")/.."
. tools/prepare.sh

[ $# -le 1 ] || fail "usage: tools/rooms.sh [NAME]"
name=${1:-sample}
require_toolchain
use_lavapipe
export CARGO_TARGET_DIR=$PWD/target
tree=$PWD
copy=$PWD/target/rooms

# A copy of the working tree without what git ignores. Its crates have a version of their own, so that in the shared
# target folder they stand beside those of the tree, and only what comes from registries is shared.
fresh_copy() {
    rm -rf "$copy"
    mkdir -p "$copy"
    git -C "$tree" ls-files -z --cached --others --exclude-standard --deduplicate |
        while IFS= read -r -d '' file; do [ ! -e "$tree/$file" ] || printf '%s\0' "$file"; done |
        tar -C "$tree" --null --files-from=- -cf - | tar -C "$copy" --touch -xf -
    cd "$copy"
    sed -i '0,/^version = .*/s//version = "0.0.0"/' Cargo.toml
    cargo update --quiet --workspace --offline
}

# Built in the tree, with the features of the whole workspace as tools/test.sh does; it works on the folder it runs in.
cargo build --locked --quiet --workspace --bin xtask
xtask=$CARGO_TARGET_DIR/debug/xtask

say "a room made from the template: $name"
fresh_copy
"$xtask" room "$name"
cargo fmt -p "airglow-$name" -p airglow -- --check
cargo clippy --locked --quiet -p "airglow-$name" -p airglow --all-targets -- -D warnings
RUSTDOCFLAGS="-D warnings" cargo doc --locked --quiet -p "airglow-$name" -p airglow --lib --no-deps
cargo test --locked --quiet -p "airglow-$name"

for room in "$tree"/passes/*/Cargo.toml; do
    room=$(basename "$(dirname "$room")")
    say "without the room $room"
    fresh_copy
    "$xtask" room "$room" --remove
    cargo check --locked --quiet --workspace --all-targets
done

cd "$tree"
rm -rf "$copy"
say "rooms come and go: $SECONDS s"
