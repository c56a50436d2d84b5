// SPDX-License-Identifier: MIT OR Apache-2.0
// A score votes when it reaches its minimum.
`default_nettype none

module vote #(
    parameter WIDTH = 7  // bits of the score
) (
    input  wire [WIDTH-1:0] score_i,    // of the feature
    input  wire [WIDTH-1:0] minimum_i,  // the feature votes from this score on
    output wire             vote_o      // the feature votes
);

    // Limits: out of them elaboration stops at a module that does not exist.
    generate
        if (WIDTH < 1) begin : g_width WIDTH_must_be_1_or_more u_refused (); end
    endgenerate

    assign vote_o = score_i >= minimum_i;

endmodule

`default_nettype wire
