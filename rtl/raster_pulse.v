// SPDX-License-Identifier: MIT OR Apache-2.0
// A bit, DEPTH clocks later; forgotten by a reset.
`default_nettype none

module raster_pulse #(
    parameter DEPTH = 4  // clocks
) (
    input  wire clk_i,  // clock, rising edge
    input  wire rst_i,  // synchronous reset, active high
    input  wire bit_i,  // comes in
    output wire bit_o   // and out
);

    generate
        if (DEPTH == 0) begin : g_none
            assign bit_o = bit_i;
        end else begin : g_some
            reg [DEPTH:1] bits_q;
            wire [DEPTH:0] bits = {bits_q, bit_i};
            always @(posedge clk_i) bits_q <= rst_i ? {DEPTH{1'b0}} : bits[DEPTH-1:0];
            assign bit_o = bits_q[DEPTH];
        end
    endgenerate

endmodule

`default_nettype wire
