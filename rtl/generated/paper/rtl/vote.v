// SPDX-License-Identifier: MIT OR Apache-2.0
// A score votes when it reaches its minimum.
`default_nettype none

module vote #(
    parameter WIDTH = 7  // bits of the score
) (
    input  wire [WIDTH-1:0] score_i,
    input  wire [WIDTH-1:0] minimum_i,
    output wire             vote_o
);

    assign vote_o = score_i >= minimum_i;

endmodule

`default_nettype wire
