// SPDX-License-Identifier: MIT OR Apache-2.0
// Delays a bit by DEPTH clocks. A reset clears the bits under way.
`default_nettype none

module bit_delay #(
    parameter DEPTH = 4  // clocks from bit_i to bit_o; 0 is a wire
) (
    input  wire clk_i,  // clock, rising edge
    input  wire rst_i,  // synchronous reset, active high
    input  wire bit_i,  // the bit that enters
    output wire bit_o   // bit_i of DEPTH clocks ago, 0 if a reset came since
);

    generate
        if (DEPTH == 0) begin : g_none
            wire unused_inputs = clk_i || rst_i;
            assign bit_o = bit_i;
        end else if (DEPTH == 1) begin : g_one
            reg bit_q;
            always @(posedge clk_i) bit_q <= bit_i && !rst_i;
            assign bit_o = bit_q;
        end else begin : g_some
            reg [DEPTH-1:0] bits_q;
            always @(posedge clk_i) bits_q <= rst_i ? {DEPTH{1'b0}} : {bits_q[DEPTH-2:0], bit_i};
            assign bit_o = bits_q[DEPTH-1];
        end
    endgenerate

endmodule

`default_nettype wire
