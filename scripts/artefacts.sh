#!/usr/bin/env bash
# SPDX-License-Identifier: MIT OR Apache-2.0
# Makes the files that a release publishes, in target/artefacts, and publishes nothing: a .crate of each crate, an archive of
# the command for `cargo binstall`, a wheel and the source distribution of the Python package, and the checksums of all. Zig links
# the programs against glibc 2.17, so that they run with that or a newer glibc (wheels: manylinux2014). scripts/release.sh
# measures the same sources, built for this machine.
#
#   scripts/artefacts.sh                   all parts: crates archive python
#   scripts/artefacts.sh PART...           some of them
#   scripts/artefacts.sh --try [PART...]   also installs each part from an empty folder, without any other file of these sources
#   scripts/artefacts.sh --only-try [PART...]   installs parts that were made before
set -euo pipefail
cd "$(dirname "$0")/.."
target=x86_64-unknown-linux-gnu
glibc=2.17

version=$(scripts/checks/versions.py --print)
named=foveate-$version-$target
built=$(realpath -m "${CARGO_TARGET_DIR:-target}")
out=$built/artefacts

# Prints the newest glibc that a program needs.
asks_for() { objdump -T "$1" | grep -o 'GLIBC_[0-9.]*' | sort -Vu | tail -1; }
asks_for_no_newer() {
    local newest
    newest=$(asks_for "$1")
    echo "${1##*/} asks for $newest"
    [ "$(printf '%s\n' "$newest" "GLIBC_$glibc" | sort -V | tail -1)" = "GLIBC_$glibc" ] ||
        { echo "artefacts: ${1##*/} asks for $newest; it has to run with glibc $glibc" >&2 && return 1; }
}

# ---- The parts: the making and the trial of each
make_crates() {
    # Cargo builds each crate from its .crate alone, and the crates below it from theirs.
    CARGO_PROFILE_DEV_DEBUG=0 cargo package --workspace --exclude foveate-python --locked --quiet
    rm -rf "$out/crates"
    mkdir "$out/crates"
    cp "$built"/package/*-"$version".crate "$out/crates"
    echo "$(find "$out/crates" -name '*.crate' | wc -l) crates, $(du -ch "$out"/crates/*.crate | tail -1 | cut -f 1)"
}
# Installs as from crates.io: a folder in its place holds the .crate files and the other crates of Cargo.lock.
try_crates() {
    cargo vendor --locked --versioned-dirs --quiet "$clean/crates.io" >/dev/null
    local file folder
    for file in "$out"/crates/*.crate; do
        tar xzf "$file" --directory "$clean/crates.io"
        folder=$clean/crates.io/$(basename "$file" .crate)
        printf '{"files":{},"package":"%s"}' "$(sha256sum <"$file" | cut -d ' ' -f 1)" >"$folder/.cargo-checksum.json"
    done
    mkdir "$clean/home"
    printf '[source.crates-io]\nreplace-with = "these"\n[source.these]\ndirectory = "%s"\n' "$clean/crates.io" >"$clean/home/config.toml"
    (cd "$clean" && CARGO_HOME=$clean/home CARGO_TARGET_DIR=$clean/target CARGO_PROFILE_DEV_DEBUG=0 \
        cargo install foveate --version "=$version" --locked --offline --quiet --debug --root "$clean/installed")
    rm -rf "$clean/target"
    try_command "$clean/installed/bin/foveate"
}

make_archive() {
    "$tools/cargo-zigbuild" zigbuild --release --locked --quiet --package foveate --target "$target.$glibc"
    local root=$out/$named
    rm -rf "$root"
    mkdir -p "$root"/{bin,share/man/man1,share/bash-completion/completions,share/zsh/site-functions,share/fish/vendor_completions.d}
    cp "$built/$target/release/foveate" "$root/bin"
    strip "$root/bin/foveate"
    asks_for_no_newer "$root/bin/foveate"
    "$root/bin/foveate" man --output "$root/share/man/man1"
    "$root/bin/foveate" completions bash >"$root/share/bash-completion/completions/foveate"
    "$root/bin/foveate" completions zsh >"$root/share/zsh/site-functions/_foveate"
    "$root/bin/foveate" completions fish >"$root/share/fish/vendor_completions.d/foveate.fish"
    scripts/checks/notices.py "$target" >"$root/THIRD-PARTY.txt"
    cp LICENSE-APACHE LICENSE-MIT README.md CHANGELOG.md CITATION.cff "$root"
    # The same sources give the same bytes.
    tar --create --directory "$out" --sort=name --owner=0 --group=0 --numeric-owner --mtime="@$(git log -1 --format=%ct)" "$named" |
        gzip --no-name --best >"$out/$named.tar.gz"
    rm -r "$root"
    du -h "$out/$named.tar.gz" | cut -f 1
}
# The manifest names the file that `cargo binstall` requests.
try_archive() {
    local asked
    asked=$(python3 -c '
import sys, tomllib
told = tomllib.load(open("crates/cli/Cargo.toml", "rb"))["package"]["metadata"]["binstall"]
for text in (told["pkg-url"], told["bin-dir"]):
    for name, value in zip(("version", "target", "bin"), sys.argv[1:]):
        text = text.replace("{ " + name + " }", value)
    print(text)' "$version" "$target" foveate)
    [ "$(head -1 <<<"$asked")" = "{ repo }/releases/download/v$version/$named.tar.gz" ] ||
        { echo "artefacts: cargo binstall would ask for ${asked%%$'\n'*}, and there is $named.tar.gz" >&2 && return 1; }
    tar xzf "$out/$named.tar.gz" --directory "$clean"
    try_command "$clean/$(tail -1 <<<"$asked")"
    local page
    for page in "$clean/$named"/share/man/man1/*.1; do
        [ -s "$page" ] || { echo "artefacts: $page is empty" >&2 && return 1; }
    done
    bash -c "source '$clean/$named/share/bash-completion/completions/foveate' && complete -p foveate" >/dev/null
}

make_python() {
    rm -f "$out"/*.whl "$out/foveate-$version.tar.gz"
    "$tools/maturin" build --release --locked --zig --target "$target" --compatibility "manylinux_${glibc/./_}" --quiet --out "$out"
    "$tools/maturin" sdist --out "$out" 2>&1 | tail -1
    "$tools/twine" check --strict "$out"/*.whl "$out/foveate-$version.tar.gz"
    # The tag in the name of the wheel is checked against its symbols.
    local judged
    judged=$("$tools/auditwheel" show "$out"/*.whl)
    grep -q "is consistent with the following platform tag: \"manylinux_${glibc/./_}_x86_64\"" <<<"${judged//$'\n'/ }" ||
        { echo "artefacts: the wheel is no manylinux_${glibc/./_}: $judged" >&2 && return 1; }
}
try_python() {
    try_package wheel "$out"/*.whl
    try_package sources "$out/foveate-$version.tar.gz"
}
# The sources are built without optimization, because the test is only that all of them are there.
try_package() {
    local environment=$clean/$1
    python3 -m venv "$environment"
    (cd "$clean" && TMPDIR=$clean CARGO_PROFILE_RELEASE_OPT_LEVEL=0 CARGO_PROFILE_RELEASE_LTO=off "$environment/bin/pip" install --quiet --disable-pip-version-check --no-cache-dir "$2")
    (cd "$clean" && "$environment/bin/python" -c '
import foveate as fv
for outcome in fv.simulate("scene:street", "paper", max_frames=20):
    pass
assert outcome.rendered.shape == (224, 224), outcome.rendered.shape
print(outcome, len(outcome._repr_html_()))
')
    try_command "$environment/bin/foveate"
}

# Runs a command by its path, in an empty folder and without this environment. The files that it writes from embedded files, and
# those of a simulation, are equal for every build.
try_command() {
    local folder said
    folder=$(mktemp -d "$clean/run.XXXXXX")
    local command=(env --ignore-environment --chdir="$folder" PATH=/usr/bin:/bin HOME="$folder" "$1")
    said=$("${command[@]}" --version)
    [ "$said" = "foveate $version" ] || { echo "artefacts: $1 is $said; it has to be foveate $version" >&2 && return 1; }
    "${command[@]}" presets
    "${command[@]}" generate --preset raster --set frame.width=64 --set frame.height=48 --output core
    "${command[@]}" build --board icebreaker --project --output board --quiet
    "${command[@]}" simulate scene:street --max-frames 10 --output out
    (cd "$folder" && find core board out -type f ! -name summary.json -print0 | sort -z | xargs -0 sha256sum) >"$clean/written"
    [ ! -e "$written" ] || diff "$written" "$clean/written" >&2 ||
        { echo "artefacts: $1 writes other files than the command tried before it" >&2 && return 1; }
    cp "$clean/written" "$written"
}

# ---- The requested parts
making=true trying=false
case ${1:-} in
-h | --help) sed -n '3,11s/^# \{0,1\}//p' "$0" && exit 0 ;;
--try) trying=true && shift ;;
--only-try) trying=true making=false && shift ;;
esac
parts=("$@")
[ $# -gt 0 ] || parts=(crates archive python)
for part in "${parts[@]}"; do
    declare -F "make_$part" >/dev/null || { echo "artefacts: there is no part $part; there are crates, archive and python" >&2; exit 2; }
done
if $making; then
    [ -z "$(git status --porcelain)" ] || { echo "artefacts: commit first; what is published belongs to a commit" >&2; exit 2; }
    scripts/checks/versions.py
    tools=$(scripts/python_tools.sh --artefacts)
    # Zig is one of these tools.
    PATH=$tools:$PATH
    [ $# -gt 0 ] || rm -rf "$out"
    mkdir -p "$out"
    for part in "${parts[@]}"; do
        echo "== $part"
        "make_$part"
    done
    # Checksums of the files that are downloaded; Cargo makes the crates again when it publishes them.
    (cd "$out" && find . -maxdepth 1 \( -name '*.tar.gz' -o -name '*.whl' \) -printf '%P\0' | sort -z | xargs -0r sha256sum >SHA256SUMS)
fi
if $trying; then
    (cd "$out" && sha256sum --check --quiet SHA256SUMS)
    trial=$(mktemp -d)
    trap 'rm -rf "$trial"' EXIT
    written=$trial/written
    for part in "${parts[@]}"; do
        echo "== $part, from an empty folder"
        clean=$trial/$part
        mkdir "$clean"
        "try_$part"
        rm -rf "$clean"
    done
fi
echo "artefacts: $out"
