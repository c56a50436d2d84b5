// SPDX-License-Identifier: MIT OR Apache-2.0
// {= banner =}
//
// Makes the clock of the core, {= core_mhz =} MHz, from {= mhz =} MHz{= description =}.
`default_nettype none

module board_clock (
{%- if pair %}
    input  wire clk_p_i,  // the clock of the board
    input  wire clk_n_i,  // the inverted half of that differential clock
{%- else %}
    input  wire clk_i,    // the clock of the board
{%- endif %}
    output wire raw_o,    // the clock of the board, for the sensor
    output wire clk_o,    // the clock of the core
    output wire locked_o  // the clock of the core is stable
);

{= body =}

endmodule

`default_nettype wire
