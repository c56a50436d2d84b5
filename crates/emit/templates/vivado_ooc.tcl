# SPDX-License-Identifier: MIT OR Apache-2.0
# {= banner =}
#
# Out-of-context synthesis of a generated core in Vivado; run it in the folder of the core:
#
{%- if on_axi %}
#     vivado -mode batch -source vivado_ooc.tcl                  ;# the core on AXI
#     vivado -mode batch -source vivado_ooc.tcl -tclargs rcm     ;# the array in it
{%- else %}
#     vivado -mode batch -source vivado_ooc.tcl                  ;# the RCM
{%- endif %}
{%- if has_rpu %}
#     vivado -mode batch -source vivado_ooc.tcl -tclargs rpu     ;# one RPU
{%- endif %}
#
# It writes reports to vivado/. The part is the VCU118's. The project's own tests do not run Vivado.
set which [expr {$argc > 0 ? [lindex $argv 0] : "{= whole =}"}]
if {$which ni { {%- if has_rpu %}rpu {% endif %}rcm{% if on_axi %} rcm_axi{% endif %}}} {
    error "the top is {% if has_rpu %}rpu or {% endif %}rcm{% if on_axi %} or rcm_axi{% endif %}, not '$which'"
}
set top {= before =}$which
{%- if on_axi %}
set clock [expr {$which eq "rcm" ? "constraints/rcm_ooc.xdc" : "constraints/ooc.xdc"}]
{%- else %}
set clock constraints/ooc.xdc
{%- endif %}

set list [open $top.f]
foreach file [split [string trim [read $list]] "\n"] {
    read_verilog $file
}
close $list
read_xdc -mode out_of_context $clock

# The hierarchy of the array is kept: flattening hundreds of equal units takes hours.
synth_design -top $top -part xcvu9p-flga2104-2L-e -mode out_of_context -flatten_hierarchy none

file mkdir vivado
report_utilization -hierarchical -file vivado/${top}_utilization.rpt
report_timing_summary -file vivado/${top}_timing.rpt
write_checkpoint -force vivado/$top.dcp
