// SPDX-License-Identifier: MIT OR Apache-2.0
// Adds plain_i, other_i and carry_i. Combinational. plain_i is on the direct input of the carry chain (see adder.v), and
// the carry enters below its lowest bit: {a, 0} - {~b, ~c} is 2 * (a + b) + 1 + c.
`default_nettype none

module carry_adder #(
    parameter WIDTH = 8  // bits of both operands and of the sum
) (
    input  wire [WIDTH-1:0] plain_i,  // operand on the direct input of the carry chain
    input  wire [WIDTH-1:0] other_i,  // operand behind the LUT
    input  wire             carry_i,  // 1: adds one
    output wire [WIDTH-1:0] sum_o     // plain_i + other_i + carry_i, modulo 2^WIDTH
);

    // Limits: a value out of range stops elaboration at an instance of a module that does not exist.
    generate
        if (WIDTH < 1) begin : g_width WIDTH_must_be_1_or_more u_refused (); end
    endgenerate

    wire unused_low;

    assign {sum_o, unused_low} = {plain_i, 1'b0} - {~other_i, ~carry_i};

endmodule

`default_nettype wire
