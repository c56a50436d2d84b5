# SPDX-License-Identifier: MIT OR Apache-2.0
# {= banner =}
#
# The synthesis of synth/{= script =}.sh for Edalize, which FuseSoC calls: the core first, then the registers at its ports.
yosys -import
source edalize_yosys_procs.tcl
{= before_reading =}read_files
hierarchy -top {= top =}
procs
{= before_synthesis =}setattr -mod -unset keep_hierarchy *
{= devices[0].synthesis =} -top {= top =}
read_verilog {= top =}_ports.v {= script =}_registers.v
hierarchy -check -top {= top =}_ports
flatten
write_json $name.json
