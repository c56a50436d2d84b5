#!/usr/bin/env bash
# SPDX-License-Identifier: MIT OR Apache-2.0
# Installs what is missing of the external tools, on Debian or Ubuntu: verilator, yosys, iverilog, a C++ compiler, ffmpeg, Python.
set -euo pipefail

missing=()
command -v verilator >/dev/null || missing+=(verilator)
command -v yosys >/dev/null || missing+=(yosys)
command -v iverilog >/dev/null || missing+=(iverilog)
command -v g++ >/dev/null || missing+=(g++)
{ command -v ffmpeg && command -v ffprobe; } >/dev/null || missing+=(ffmpeg)
# FST waves of a Verilator model need zlib's header.
[ -e /usr/include/zlib.h ] || missing+=(zlib1g-dev)
# For what comes from PyPI, scripts/python_tools.sh.
python3 -c 'import ensurepip, venv' 2>/dev/null || missing+=(python3-venv)
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
