// SPDX-License-Identifier: MIT OR Apache-2.0
// plain_i + other_i, written so that synthesis keeps plain_i on the direct input of the carry chain.
//
// A selection or inversion in front of other_i then costs nothing, as it fits into the LUT that adds.
// Written as a sum the operands may be swapped, and the logic is built a second time for the direct
// input. A difference is not commutative: {a, 0} - {~b, 1} is 2 * (a + b) + 1.
`default_nettype none

module adder #(
    parameter WIDTH = 8  // bits of both operands and of the sum
) (
    input  wire [WIDTH-1:0] plain_i,  // operand on the direct input of the carry chain
    input  wire [WIDTH-1:0] other_i,  // operand behind the LUT
    output wire [WIDTH-1:0] sum_o     // modulo 2^WIDTH
);

    // Limits: out of them elaboration stops at a module that does not exist.
    generate
        if (WIDTH < 1) begin : g_width WIDTH_must_be_1_or_more u_refused (); end
    endgenerate

    wire unused_one;

    assign {sum_o, unused_one} = {plain_i, 1'b0} - {~other_i, 1'b1};

endmodule

`default_nettype wire
