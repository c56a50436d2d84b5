# SPDX-License-Identifier: MIT OR Apache-2.0
# Commands of Vivado and of Yosys as far as the scripts of a core need them to synthesize it. Run it in the folder of a core, or where
# FuseSoC has put the files of a target: tclsh flow_stub.tcl SCRIPT TOP [WORD...]
#
# TOP is what FuseSoC calls the top level, and words are those of the script. Files and modules must be there when they are named, and a
# clock must be an input of the module that is synthesized. At the end it says what was synthesized, and what the clock of that is.
set modules [dict create]  ;# their text
set synthesized {}
set written {}
set clocks {}
set constraints {}

proc fail {text} { error "stub: $text" }
proc module {name} {
    if {![dict exists $::modules $name]} { fail "no module $name" }
    return [dict get $::modules $name]
}
# The names of the inputs in the header of a module.
proc inputs {name} {
    regexp {^.*?\n\);} [module $name] header
    set found {}
    foreach {- port} [regexp -all -inline {\n *input +wire +(?:\[[^\]]*\] *)?(\w+)} $header] { lappend found $port }
    return $found
}
# Every module below one must be there, but those that parameters choose, which stand further in.
proc below {name} {
    foreach {- instance} [regexp -all -inline -line {^ {4}(\w+) (?:#\(|u_\w+ \()} [module $name]] { below $instance }
}
proc read_verilog {args} {
    foreach file $args {
        set handle [open $file]
        set text [read $handle]
        close $handle
        foreach {- name rest} [regexp -all -inline {\nmodule (\w+)(.*?\nendmodule)} $text] { dict set ::modules $name $rest }
    }
}
proc synthesize {name} {
    below $name
    set ::synthesized $name
}

# Vivado.
proc read_xdc {args} {
    if {[lrange $args 0 1] ne "-mode out_of_context"} { fail "constraints of a whole chip" }
    lappend ::constraints [lindex $args 2]
}
proc get_ports {name} {
    if {$name ni [inputs $::synthesized]} { fail "$::synthesized has no input $name" }
    return $name
}
proc create_clock {dash name period ns port} {
    if {"$dash $period" ne "-name -period" || $ns <= 0} { fail "no clock: $dash $name $period $ns" }
    lappend ::clocks $port
}
proc synth_design {args} {
    foreach option {-top -part -mode} { if {![dict exists $args $option]} { fail "no $option" } }
    if {[dict get $args -mode] ne "out_of_context"} { fail "a whole chip" }
    synthesize [dict get $args -top]
    foreach file $::constraints { uplevel #0 source $file }
}
proc report_utilization {- - file} { lappend ::written $file }
proc report_timing_summary {- file} { lappend ::written $file }
proc write_checkpoint {- file} { lappend ::written $file }

# Yosys, and what Edalize defines beside it.
proc yosys {args} { if {$args ne "-import"} { fail "yosys $args" } }
proc verilog_defines {define} {}
proc read_files {} { foreach file [glob rtl/*.v] { read_verilog $file } }
proc hierarchy {args} {
    set ::highest [lindex $args end]
    if {[lindex $args 0] eq "-check"} { below $::highest } else { module $::highest }
}
proc procs {} {}
proc setattr {args} {}
proc synth_ecp5 {args} { synthesize [lindex $args end] }
proc synth_ice40 {args} { synthesize [lindex $args end] }
proc flatten {} {}
proc write_json {file} {
    lappend ::written $file
    if {$::highest ne $::top} { fail "FuseSoC asks for $::top, and gets $::highest" }
    # Its one input is the clock, which the core has under a name of its own.
    if {[inputs $::top] ne "clk_i"} { fail "inputs of $::top" }
    if {![regexp "\n    $::synthesized u_core \\(" [module $::top]]} { fail "no $::synthesized in $::top" }
    if {![regexp {\n        \.(\w+)\(clk_i\)\n    \);} [module $::top] -> clock] || $clock ni [inputs $::synthesized]} { fail "no clock" }
    lappend ::clocks $clock
}
rename source plain_source
proc source {file} { if {$file ne "edalize_yosys_procs.tcl"} { uplevel plain_source $file } }

set argv [lassign $argv script top]
set argc [llength $argv]
set name netlist
source $script
if {[llength $written] == 0} { fail "nothing is written" }
puts "$synthesized with the clock [join $clocks]"
