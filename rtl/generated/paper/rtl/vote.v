// SPDX-License-Identifier: MIT OR Apache-2.0
// Compares a score with its minimum: the feature votes if the score reaches it. Combinational.
`default_nettype none

module vote #(
    parameter WIDTH = 7  // bits of the score
) (
    input  wire [WIDTH-1:0] score_i,    // score of the feature
    input  wire [WIDTH-1:0] minimum_i,  // smallest score that votes
    output wire             vote_o      // the feature votes
);

    // Limits: a value out of range stops elaboration at an instance of a module that does not exist.
    generate
        if (WIDTH < 1) begin : g_width WIDTH_must_be_1_or_more u_refused (); end
    endgenerate

    assign vote_o = score_i >= minimum_i;

endmodule

`default_nettype wire
