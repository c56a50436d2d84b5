// SPDX-License-Identifier: MIT OR Apache-2.0
// Adds plain_i and other_i. Combinational. The sum is written so that synthesis keeps plain_i on the direct
// input of the carry chain.
//
// A selection or inversion in front of other_i then costs nothing, because it fits into the LUT that adds. If it
// were written as a plain sum, synthesis could swap the operands and would build that logic a second time for the
// direct input. A difference is not commutative: {a, 0} - {~b, 1} is 2 * (a + b) + 1.
`default_nettype none

module adder #(
    parameter WIDTH = 8  // bits of both operands and of the sum
) (
    input  wire [WIDTH-1:0] plain_i,  // operand on the direct input of the carry chain
    input  wire [WIDTH-1:0] other_i,  // operand behind the LUT
    output wire [WIDTH-1:0] sum_o     // plain_i + other_i, modulo 2^WIDTH
);

    // Limits: a value out of range stops elaboration at an instance of a module that does not exist.
    generate
        if (WIDTH < 1) begin : g_width WIDTH_must_be_1_or_more u_refused (); end
    endgenerate

    wire unused_one;

    assign {sum_o, unused_one} = {plain_i, 1'b0} - {~other_i, 1'b1};

endmodule

`default_nettype wire
