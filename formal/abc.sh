#!/usr/bin/env bash
# SPDX-License-Identifier: MIT OR Apache-2.0
# yosys-abc for SymbiYosys 0.70, without the switch of `pdr` that the ABC of Debian 12 does not know.
exec yosys-abc "${@/pdr -v -l/pdr -v}"
