# SPDX-License-Identifier: MIT OR Apache-2.0
# {= banner =}
#
# Makes {= bitstream =} of {= title =}:
#
#   vivado -mode batch -source build.tcl
#
# Not run in Vivado by the project's own tests: a Tcl interpreter with stubs of its commands checks that it executes.

cd [file dirname [file normalize [info script]]]
file mkdir build
create_project -in_memory -part {= part =}
foreach source {
{%- for source in sources %}
    {= source =}
{%- endfor %}
} {
    read_verilog $source
}
read_xdc board.xdc
synth_design -top board -part {= part =}
opt_design
place_design
phys_opt_design
route_design
report_utilization -file build/utilization.txt
report_timing_summary -file build/timing.txt
if {[get_property SLACK [get_timing_paths -max_paths 1 -setup]] < 0} {
    puts stderr "too slow: {= bitstream =} may not work; see build/timing.txt"
}
write_bitstream -force {= bitstream =}
