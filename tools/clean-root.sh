#!/usr/bin/env bash
# Proves that a fresh machine is enough: makes a minimal Debian 12 root with only rustup's toolchain, git and gcc,
# clones the last commit into it, runs tools/demo.sh and tools/test.sh there and keeps the log in
# docs/clean-root.log. Needs root, about 12 GiB of disk and the network of this machine. Safe to repeat: the root is
# made anew each time.
#   tools/clean-root.sh [FOLDER]        FOLDER defaults to target/clean-root and must be empty or a former root
set -euo pipefail
cd "$(dirname "$0")/.."
. tools/prepare.sh

[ $# -le 1 ] || fail "usage: tools/clean-root.sh [FOLDER]"
[ "$(id -u)" = 0 ] || fail "a root file system can only be made, and entered, by root"
root=$(realpath -m "${1:-target/clean-root}")
marker=$root/.airglow-clean-root
clone=/root/airglow
log=docs/clean-root.log
full=$PWD/target/clean-root.full.log

# Folders of this machine that the root borrows while it runs.
borrowed=(dev proc)
leave() {
    local folder
    for folder in "${borrowed[@]}"; do
        ! mountpoint -q "$root/$folder" || umount --recursive "$root/$folder"
    done
}
trap leave EXIT

make_root() {
    leave
    if [ -d "$root" ] && [ ! -e "$marker" ] && [ -n "$(ls -A "$root")" ]; then
        fail "$root holds something that this script did not make; name another folder"
    fi
    rm -rf --one-file-system "$root"
    mkdir -p "$root"
    touch "$marker"
    # The mirror is the machine's own: the first one its apt sources name for this suite.
    local mirror=${DEBIAN_MIRROR:-$(apt-get indextargets --format '$(REPO_URI) $(RELEASE)' 'Created-By: Packages' |
        awk '$2 == "bookworm" {print $1; exit}')}
    [ -n "$mirror" ] || fail "this machine's apt sources name no mirror of Debian bookworm; set DEBIAN_MIRROR"
    # libc6-dev is what `apt install gcc` brings along.
    debootstrap --variant=minbase --include=ca-certificates,git,gcc,libc6-dev bookworm "$root" "$mirror"
    touch "$marker"
}

# How this machine reaches its package sources: names, apt's and cargo's settings, certificates.
copy_network() {
    local path
    for path in /etc/resolv.conf /etc/hosts /etc/ssl/certs/ca-certificates.crt "$HOME/.cargo/config.toml"; do
        [ ! -e "$path" ] || install -D -m 644 "$path" "$root$path"
    done
    rm -f "$root/etc/apt/sources.list"
    for path in sources.list sources.list.d apt.conf.d trusted.gpg.d keyrings auth.conf.d; do
        [ ! -e "/etc/apt/$path" ] || cp -a --dereference "/etc/apt/$path" "$root/etc/apt/"
    done
}

copy_toolchain() {
    local toolchain
    toolchain=$(rustup show active-toolchain | cut -d ' ' -f 1)
    mkdir -p "$root/root/.rustup/toolchains" "$root/root/.cargo"
    cp -a "$HOME/.rustup/settings.toml" "$root/root/.rustup/"
    cp -a "$HOME/.rustup/toolchains/$toolchain" "$root/root/.rustup/toolchains/"
    cp -a "$HOME/.cargo/bin" "$root/root/.cargo/"
}

# Runs a command of the clone inside the root, with nothing of this machine's environment but proxies and certificates.
inside() {
    local settings=() name
    for name in http_proxy https_proxy no_proxy HTTP_PROXY HTTPS_PROXY NO_PROXY \
        SSL_CERT_FILE SSL_CERT_DIR CURL_CA_BUNDLE RUSTUP_AUTO_INSTALL; do
        [ -z "${!name:-}" ] || settings+=("$name=${!name}")
    done
    chroot "$root" /usr/bin/env -i HOME=/root LANG=C.UTF-8 CI=true "${settings[@]}" \
        PATH=/root/.cargo/bin:/usr/local/sbin:/usr/local/bin:/usr/sbin:/usr/bin:/sbin:/bin \
        /bin/bash -c "cd $clone && $1"
}

# Runs one script; its start and end go into the kept log, everything into the full one.
run() {
    local start=$SECONDS status=0 output
    output=$(mktemp)
    say "in the root: $1"
    inside "$1" < /dev/null 2>&1 | tee "$output" || status=$?
    cat "$output" >> "$full"
    {
        echo "\$ $1"
        essence < "$output" | awk '{line[NR] = $0} END {for (i = 1; i <= NR; i++) {
            if (i <= 20 || i > NR - 40) print line[i]; else if (i == 21) print "[...]"}}'
        printf 'exit status %d after %d s\n\n' "$status" $((SECONDS - start))
    } >> "$log.partial"
    rm -f "$output"
    return "$status"
}

# Without terminal colours, the folder of the clone, and the progress of downloads, packages and compilers.
essence() {
    sed -E "s/\x1b\[[0-9;]*m//g; s#$clone/##g" |
        grep -vE '://|^ *(Get|Hit|Ign):|^ *(Updating|Downloading|Downloaded|Compiling|Checking|Documenting|Locking) ' |
        grep -vE '^(Selecting previously|Preparing to unpack|Unpacking|Setting up|Processing triggers|\(Reading database)'
}

install_packages debootstrap
say "a minimal Debian 12 root in $root"
make_root
copy_network
copy_toolchain
git clone --quiet "file://$PWD" "$root$clone"
mount --bind /dev "$root/dev"
mount -t proc proc "$root/proc"

mkdir -p docs
: > "$full"
{
    echo "tools/clean-root.sh, $(date --utc +%F), commit $(git rev-parse --short HEAD)"
    echo "Debian $(cat "$root/etc/debian_version") minbase with git $(chroot "$root" git --version | cut -d ' ' -f 3)," \
        "gcc $(chroot "$root" gcc -dumpfullversion), $(inside 'rustc --version'), $(nproc) cores," \
        "$(chroot "$root" dpkg-query -f '.' -W | wc -c) Debian packages"
    echo
} > "$log.partial"
failures=0
run tools/demo.sh || failures=$((failures + 1))
run tools/test.sh || failures=$((failures + 1))
mv "$log.partial" "$log"
say "$log keeps the start and end of both, $full everything"
[ $failures = 0 ] || fail "$failures of the two scripts failed in the clean root"
