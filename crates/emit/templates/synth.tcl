# SPDX-License-Identifier: MIT OR Apache-2.0
# {= banner =}
#
# The synthesis of synth/{= script =}.sh for Edalize, which FuseSoC calls: the core first, then the registers at its ports.
yosys -import
source edalize_yosys_procs.tcl
{= before_reading =}read_files
hierarchy -top {= before =}rcm
procs
{= before_synthesis =}setattr -mod -unset keep_hierarchy *
{= devices[0].synthesis =} -top {= before =}rcm
read_verilog {= before =}rcm_ports.v {= script =}_registers.v
hierarchy -check -top {= before =}rcm_ports
flatten
write_json $name.json
