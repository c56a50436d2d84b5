#!/usr/bin/env bash
# SPDX-License-Identifier: MIT OR Apache-2.0
# Builds the engine of the live page: web/foveate.wasm from web/engine, and web/sources.sha256, which lists its sources. Both are
# committed, so that `cargo install` needs no target for WebAssembly. A test of web/engine fails if the sources have changed.
#
#   scripts/web.sh           builds
#   scripts/web.sh --test    compares the committed file with the native program, frame by frame, in Chromium
#
# The toolchain in use must have the target (`rustup target add wasm32-unknown-unknown`), or Debian's rustc-web is unpacked beside it
# and compiles the standard library as well. wasm-opt, of Binaryen, makes the file smaller.
#
# FOVEATE_WASM_TOOLS   folder where packages of Debian are unpacked (default: foveate-wasm-... in XDG_CACHE_HOME or ~/.cache)
# FOVEATE              with --test, an executable to use instead of the debug build
set -euo pipefail
cd "$(dirname "$0")/.."
target=wasm32-unknown-unknown
cache=${FOVEATE_WASM_TOOLS:-${XDG_CACHE_HOME:-$HOME/.cache}/foveate-wasm}

# Prints the crates of the engine, with their paths.
crates() {
    cargo tree --locked --package foveate-web --edges normal --prefix none --format '{p}' |
        sed -n 's/^foveate-[a-z]* v[^ ]* (\([^)]*\)).*/\1/p' | sort -u
}

# Prints the checksums of the engine's sources in the format of sha256sum.
sources() {
    local root folder
    root=$PWD
    for folder in $(crates); do
        folder=${folder#"$root"/}
        find "$folder/src" -name '*.rs'
        echo "$folder/Cargo.toml"
    done | LC_ALL=C sort | xargs sha256sum
}

# Prints a folder with unpacked packages of Debian, after unpacking them if needed. The arguments are its name, then packages.
unpacked() {
    local folder=$cache-$1 new version
    shift
    version=$(apt-cache show --no-all-versions "$@" | grep -E '^(Package|Version):')
    if [ "$(cat "$folder/version" 2>/dev/null)" != "$version" ]; then
        echo "unpacking $* in $folder" >&2
        mkdir -p "$(dirname "$cache")"
        new=$(mktemp -d "$folder.XXXXXX")
        (cd "$new" && apt-get download -o APT::Sandbox::User=root --quiet=2 "$@" >&2)
        for package in "$new"/*.deb; do
            dpkg -x "$package" "$new"
            rm "$package"
        done
        rm -r "${new:?}/usr/share"
        # Programs find their libraries in the folder next to them.
        cat >"$new/run" <<'RUN'
#!/bin/sh
here=$(dirname "$(readlink -f "$0")")
name=$(basename "$0")
LD_LIBRARY_PATH=$(echo "$here"/usr/lib/*-linux-gnu) exec "$here/usr/bin/$name" "$@"
RUN
        chmod +x "$new/run"
        for program in "$new"/usr/bin/*; do
            ln -s run "$new/${program##*/}"
        done
        echo "$version" >"$new/version"
        rm -rf "$folder"
        mv "$new" "$folder"
    fi
    echo "$folder"
}

# Prints the folder of Debian's compiler, with the source of the standard library.
compiler() {
    local folder more
    command -v apt-get >/dev/null ||
        { echo "the toolchain has no target $target; add it with: rustup target add $target" >&2; exit 3; }
    # The package of the library has the version in its name, and thus the version of LLVM that it is linked with.
    mapfile -t more < <(apt-cache depends --recurse --no-recommends --no-suggests --no-conflicts --no-breaks --no-replaces --no-enhances rustc-web |
        grep -E '^(libstd-rust-web-[0-9.]+|libllvm[0-9]+)$' | sort -u)
    folder=$(unpacked rust rustc-web libstd-rust-web-dev rust-web-src "${more[@]}")
    # A link is in the place where cargo looks for the source. It leads to more than is needed.
    if [ -L "$folder/usr/lib/rustlib/src/rust" ]; then
        rm "$folder/usr/lib/rustlib/src/rust"
        mkdir "$folder/usr/lib/rustlib/src/rust"
        mv "$folder"/usr/src/rustc-*/library "$folder/usr/lib/rustlib/src/rust/"
        rm -r "${folder:?}/usr/src"
    fi
    echo "$folder"
}

# Makes a file of WebAssembly a seventh smaller, at the same speed.
shrink() {
    local program features=(simd bulk-memory sign-ext nontrapping-float-to-int mutable-globals reference-types multivalue)
    program=$(command -v wasm-opt || { command -v apt-get >/dev/null && echo "$(unpacked binaryen binaryen)/wasm-opt"; }) ||
        { echo "wasm-opt is missing; install binaryen" >&2; exit 3; }
    "$program" -Oz "${features[@]/#/--enable-}" "$1" -o "$2"
}

# Prints the linker for WebAssembly: that of the toolchain in use, or that of the system.
linker() {
    local host own
    host=$(rustc -vV | sed -n 's/^host: //p')
    own=$(rustc --print sysroot)/lib/rustlib/$host/bin/rust-lld
    if [ -x "$own" ]; then
        echo "$own"
    else
        command -v wasm-ld || command -v rust-lld ||
            { echo "there is no linker for WebAssembly; on Debian: apt-get install lld" >&2; exit 3; }
    fi
}

build() {
    local flags=(-C target-feature=+simd128) std=() folder rust
    # The checksums are taken before the build, so that a file that changes meanwhile is found.
    sources >web/sources.sha256
    # Paths of this machine are kept out of the messages of the program.
    flags+=("--remap-path-prefix=$PWD=.")
    for folder in "${CARGO_HOME:-$HOME/.cargo}"/registry/src/*; do
        flags+=("--remap-path-prefix=$folder=crates")
    done
    if [ ! -d "$(rustc --print target-libdir --target $target)" ]; then
        rust=$(compiler)
        flags+=("--remap-path-prefix=$rust/usr=rust")
        CARGO_TARGET_WASM32_UNKNOWN_UNKNOWN_LINKER=$(linker)
        export RUSTC=$rust/rustc RUSTC_BOOTSTRAP=1 CARGO_TARGET_WASM32_UNKNOWN_UNKNOWN_LINKER
        # A fault traps without a message: nobody could read it, and the code for it is a fourth of the program.
        flags+=(-Z unstable-options -C panic=immediate-abort)
        std=(-Z "build-std=std,panic_abort" -Z build-std-features=)
    fi
    CARGO_TARGET_WASM32_UNKNOWN_UNKNOWN_RUSTFLAGS=${flags[*]} \
        cargo build --locked --package foveate-web --lib --profile web --target $target --target-dir target/wasm "${std[@]}"
    shrink "target/wasm/$target/web/foveate_web.wasm" web/foveate.wasm
    sha256sum web/foveate.wasm >>web/sources.sha256
    echo "web/foveate.wasm: $(stat -c %s web/foveate.wasm) bytes"
}

compare() {
    local tools
    tools=$(scripts/python_tools.sh --browser)
    FOVEATE=$(scripts/checks/foveate.sh)
    export FOVEATE
    scripts/install_tools.sh --browser
    "$tools/python" -m pytest --quiet -p no:cacheprovider web/tests "$@"
}

case ${1:-} in
'') build ;;
--test) compare "${@:2}" ;;
*) echo "web: unknown option $1; see the head of scripts/web.sh" >&2 && exit 2 ;;
esac
