#!/usr/bin/env bash
# SPDX-License-Identifier: MIT OR Apache-2.0
# Installs missing external tools on Debian or Ubuntu: verilator, yosys, nextpnr-ice40, icepack, iverilog, opensta with a library of
# cells, a C++ compiler (also for 32 bits), make, ffmpeg, shellcheck, Tcl, Python. With --browser, installs only Chromium, for
# scripts/web.sh --test.
# It supports Debian 12 and Ubuntu 24.04 or later: Verilator 5 is needed, and Ubuntu 22.04 has 4. On other systems it prints what to
# install.
set -euo pipefail

# The scripts use bash 4 and GNU tools, and measure with /proc.
[ "$(uname -s)" = Linux ] || { echo "these scripts need Linux; on $(uname -s) run them in a container of Debian 12" >&2; exit 3; }
# shellcheck source=/dev/null
if [ "$(. /etc/os-release 2>/dev/null && echo "${ID:-}${VERSION_ID:-}")" = ubuntu22.04 ]; then
    echo "Ubuntu 22.04 has Verilator 4, and 5 is needed: use Ubuntu 24.04 or Debian 12, or put Verilator 5 in PATH" >&2
    command -v verilator >/dev/null && verilator --version | grep -q 'Verilator 5' || exit 3
fi

missing=()
if [ "${1:-}" = --browser ]; then
    { command -v chromium || command -v chromium-browser || command -v google-chrome || command -v chrome; } >/dev/null || missing+=(chromium)
else
    command -v verilator >/dev/null || missing+=(verilator)
    command -v yosys >/dev/null || missing+=(yosys)
    command -v nextpnr-ice40 >/dev/null || missing+=(nextpnr-ice40)
    command -v icepack >/dev/null || missing+=(fpga-icestorm)
    command -v iverilog >/dev/null || missing+=(iverilog)
    { command -v sta || command -v opensta; } >/dev/null || missing+=(opensta)
    [ -e /usr/share/qflow/tech/osu018/osu018_stdcells.lib ] || missing+=(qflow-tech-osu018)
    command -v g++ >/dev/null || missing+=(g++)
    # Verilator's own makefile needs make; the benches of a core use it.
    command -v make >/dev/null || missing+=(make)
    { command -v ffmpeg && command -v ffprobe; } >/dev/null || missing+=(ffmpeg)
    command -v shellcheck >/dev/null || missing+=(shellcheck)
    # FST waves of a Verilator model need the header of zlib.
    [ -e /usr/include/zlib.h ] || missing+=(zlib1g-dev)
    command -v tclsh >/dev/null || missing+=(tcl)
    # The C driver of cores is also tested on processors of 32 bits.
    [ "$(uname -m)" != x86_64 ] || dpkg -s gcc-multilib >/dev/null 2>&1 || missing+=(gcc-multilib)
    # scripts/python_tools.sh needs these for tools from PyPI.
    python3 -c 'import ensurepip, venv' 2>/dev/null || missing+=(python3-venv)
fi
[ ${#missing[@]} -eq 0 ] && exit 0

if ! command -v apt-get >/dev/null; then
    echo "install ${missing[*]} with this system's package manager, then run this again" >&2
    exit 3
fi
as_root=()
[ "$(id -u)" -eq 0 ] || as_root=(sudo)
echo "installing ${missing[*]}"
"${as_root[@]}" apt-get update -qq
DEBIAN_FRONTEND=noninteractive "${as_root[@]}" apt-get install -y -qq --no-install-recommends "${missing[@]}"
