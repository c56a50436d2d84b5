#!/usr/bin/env bash
# SPDX-License-Identifier: MIT OR Apache-2.0
# Runs yosys-abc for SymbiYosys 0.70, without the switch of `pdr` that the ABC of Debian 12 does not have.
exec yosys-abc "${@/pdr -v -l/pdr -v}"
