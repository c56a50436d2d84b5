# SPDX-License-Identifier: MIT OR Apache-2.0
# Out-of-context constraints of a Foveate core: a clock of 250 MHz and nothing else. Pins, input and
# output delays belong to the design that instantiates the core.
create_clock -name clk_i -period 4.000 [get_ports clk_i]
