// SPDX-License-Identifier: MIT OR Apache-2.0
// {= banner =}
//
// The clock of the core, {= core_mhz =} MHz, from {= mhz =} MHz{= how =}.
`default_nettype none

module board_clock (
{%- if pair %}
    input  wire clk_p_i,  // the clock of the board
    input  wire clk_n_i,  // its other half
{%- else %}
    input  wire clk_i,    // the clock of the board
{%- endif %}
    output wire raw_o,    // the same, for the sensor
    output wire clk_o,    // the clock of the core
    output wire locked_o  // it is there
);

{= body =}

endmodule

`default_nettype wire
