# SPDX-License-Identifier: MIT OR Apache-2.0
# {= banner =}
#
# Loads {= bitstream =} into {= title =}:
#
#   vivado -mode batch -source program.tcl
#
# Not run in Vivado by the project's own tests.

cd [file dirname [file normalize [info script]]]
open_hw_manager
connect_hw_server
open_hw_target
set device [lindex [get_hw_devices] 0]
set_property PROGRAM.FILE {= bitstream =} $device
program_hw_devices $device
close_hw_manager
