// SPDX-License-Identifier: MIT OR Apache-2.0
// {= banner =}
//
// Registers of {= family =} without enable and reset, which synthesis leaves as they are. For synth/ only.
`default_nettype none

module {= before =}ports_register #(
    parameter WIDTH = 1  // bits
) (
    input  wire             clk_i,  // clock, rising edge
    input  wire [WIDTH-1:0] d_i,    // what is kept
    output wire [WIDTH-1:0] q_o     // that of the clock before
);
    genvar i;
    generate
        for (i = 0; i < WIDTH; i = i + 1) begin : g_bit
            {= cell =}
        end
    endgenerate

endmodule

`default_nettype wire
