// SPDX-License-Identifier: MIT OR Apache-2.0
// plain_i + other_i + carry_i, with plain_i on the direct input of the carry chain (see adder.v) and
// the carry entering below its lowest bit: {a, 0} - {~b, ~c} is 2 * (a + b) + 1 + c.
`default_nettype none

module carry_adder #(
    parameter WIDTH = 8
) (
    input  wire [WIDTH-1:0] plain_i,
    input  wire [WIDTH-1:0] other_i,
    input  wire             carry_i,
    output wire [WIDTH-1:0] sum_o     // modulo 2^WIDTH
);

    wire unused_low;

    assign {sum_o, unused_low} = {plain_i, 1'b0} - {~other_i, ~carry_i};

endmodule

`default_nettype wire
