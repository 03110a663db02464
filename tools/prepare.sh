# Functions that the scripts beside this file share; sourced, not run.

# Where cargo puts what it builds, whatever folder it is called from later.
build_folder=$(realpath -m "${CARGO_TARGET_DIR:-target}")

say() { printf '\n== %s\n' "$*"; }

fail() {
    printf 'error: %s\n' "$*" >&2
    exit 1
}

as_root() {
    if [ "$(id -u)" = 0 ]; then
        "$@"
    elif command -v sudo > /dev/null; then
        sudo "$@"
    else
        fail "'$*' needs root; run this script as root or install sudo"
    fi
}

# Installs the Debian packages named that are not there; does nothing, and asks for no root, when all are.
install_packages() {
    local missing=() package
    for package in "$@"; do
        dpkg-query -W -f '${db:Status-Status}' "$package" 2> /dev/null | grep -qx installed || missing+=("$package")
    done
    if [ ${#missing[@]} = 0 ]; then
        return
    fi
    command -v apt-get > /dev/null || fail "this machine has no apt-get; install what matches: ${missing[*]}"
    say "installing ${missing[*]}"
    as_root apt-get update -qq
    as_root env DEBIAN_FRONTEND=noninteractive apt-get install -y -qq --no-install-recommends "${missing[@]}"
}

# Stops with the mend when the Rust toolchain or the linker it calls is not there.
require_toolchain() {
    command -v cargo > /dev/null || PATH="$HOME/.cargo/bin:$PATH" # where rustup puts it
    command -v cargo > /dev/null || fail "cargo is not on the PATH; install a Rust toolchain with rustup"
    command -v cc > /dev/null || install_packages gcc libc6-dev
}

# Cargo for what only reads code (clippy, check, doc), with a command and its arguments: in a target folder of its own, so
# that it goes on beside what builds, and without the C++ of the shader compiler, as nothing is linked there.
check_cargo() {
    local host
    host=$(rustc --version --verbose | sed -n 's/^host: //p')
    cargo --config "target.$host.glslang.rustc-link-lib = ['glslang']" "$1" --target-dir "$build_folder/checks" "${@:2}"
}

# Vulkan drivers of this machine whose file name matches; none is not an error.
drivers() {
    local folder
    for folder in /usr/share/vulkan/icd.d /etc/vulkan/icd.d /usr/local/share/vulkan/icd.d; do
        [ ! -d "$folder" ] || find "$folder" -name "$1"
    done
}

# Makes tests run on lavapipe, on two threads, whatever the machine has, with its compiled shaders kept between runs.
use_lavapipe() {
    # The software renderer and the layers that tests run under; a C++ compiler for the shader compiler of tools/xtask,
    # and with Vulkan's headers for the host of passes/capi;
    # a display without a screen for the test of the window, and what winit opens on X11.
    install_packages libvulkan1 libvulkan-dev mesa-vulkan-drivers vulkan-validationlayers g++ \
        xvfb libx11-6 libx11-xcb1 libxcursor1 libxi6 libxkbcommon-x11-0
    local driver
    driver=$(drivers 'lvp_icd*.json' | head -n 1)
    [ -n "$driver" ] || fail "no lvp_icd*.json under /usr/share/vulkan/icd.d; mesa-vulkan-drivers should have put it there"
    export VK_DRIVER_FILES=$driver VK_ICD_FILENAMES=$driver # the second name is that of older loaders
    export LP_NUM_THREADS=2
    export MESA_SHADER_CACHE_DIR=$PWD/target/mesa-shader-cache
    mkdir -p "$MESA_SHADER_CACHE_DIR"
}
