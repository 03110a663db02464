#!/usr/bin/env bash
# From a clone to a lit picture, its error/time plot, its timings and its plan. Safe to repeat.
#   tools/demo.sh [--device NAME|INDEX|KIND]
set -euo pipefail
cd "$(dirname "$0")/.."
. tools/prepare.sh

device=()
while [ $# -gt 0 ]; do
    case $1 in
        --device)
            [ $# -ge 2 ] || fail "--device needs a name, an index or a kind"
            device=(--device "$2")
            shift 2
            ;;
        --device=*)
            device=(--device "${1#--device=}")
            shift
            ;;
        *) fail "usage: tools/demo.sh [--device NAME|INDEX|KIND]" ;;
    esac
done

say "demo of airglow: build, bake, draw, measure"
echo "Expect 10 to 20 minutes on two cores the first time, half of it building."

require_toolchain
packages=(libvulkan1)
# A driver of the machine's own is used; without any, Mesa's brings the software renderer.
if [ -z "$(drivers '*.json')" ]; then
    packages+=(mesa-vulkan-drivers)
fi
install_packages "${packages[@]}"

say "building"
cargo build --locked --release -p airglow-cli

scene=assets/scenes/demo.toml
airglow=target/release/airglow
mkdir -p out
say "the device"
"$airglow" devices
say "baking and drawing $scene"
size=(--size 640x360)
"$airglow" render "$scene" "${device[@]}" "${size[@]}" --frames 5 -o out/demo.png --stat out/demo.json
bare=(--without relight --without radiance --without shadow --without normals --without fog)
"$airglow" render "$scene" "${device[@]}" "${size[@]}" --frames 1 "${bare[@]}" --split=diagonal -o out/demo-split.png --quiet > /dev/null
say "a film of it: the lamp goes along its rope, the figures walk, the camera follows"
"$airglow" film "$scene" "${device[@]}" --size 320x180 --frames 12 --step 0.16 --fly 0.4,0.1,1.2 --strip 4 -o out/film --quiet > /dev/null
if [ -n "$(command -v convert)" ]; then
    convert -delay 12 -loop 0 out/film/frame-*.png -layers optimize out/film/film.gif
fi
street=assets/scenes/street.toml
say "drawing $street"
"$airglow" render "$street" "${device[@]}" -o out/street.png --frames 5 --stat out/street.json
"$airglow" render "$street" "${device[@]}" --compare-fog --size 640x480 --frames 1 -o out/street-airs.png --quiet > /dev/null
say "the plan"
"$airglow" plan "$scene" "${device[@]}" | tee out/plan.txt
say "measuring error against time"
"$airglow" report relight --scene assets/scenes/cloister.toml "${device[@]}" -o out/report --quick

say "done in $SECONDS s"
echo "picture          $PWD/out/demo.png (out/demo-split.png: left of the diagonal without the passes)"
echo "film             $PWD/out/film (film.gif too, where ImageMagick is)"
echo "picture          $PWD/out/street.png (out/street-airs.png: in clear air, in depth fog, in fog)"
echo "timings          $PWD/out/demo.json, $PWD/out/street.json"
echo "plan             $PWD/out/plan.txt"
find "$PWD/out/report" -name '*.html' -printf 'error/time plot  %p\n'
