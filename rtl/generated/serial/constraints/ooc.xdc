# SPDX-License-Identifier: MIT OR Apache-2.0
# Out-of-context constraints of a Foveate core: only the period of the clock, in ns. Pins and delays of inputs and outputs
# belong to the design that instantiates the core. The period is a request to the tools, not what the design reaches:
# put the period of your clock here. `foveate estimate` says which clock to expect.
create_clock -name clk_i -period 4.000 [get_ports clk_i]
