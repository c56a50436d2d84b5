# SPDX-License-Identifier: MIT OR Apache-2.0
# Out-of-context constraints of a Foveate core: the period of the clock in ns and nothing else. Pins, input
# and output delays belong to the design that instantiates the core. The period is what the tools are asked
# for, not what the design reaches: put that of your clock here. `foveate estimate` says what to expect.
create_clock -name clk_i -period 4.000 [get_ports clk_i]
