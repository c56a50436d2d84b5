// SPDX-License-Identifier: MIT OR Apache-2.0
// Keeps the score of a frame until a slower feature has its score. score_o holds score_i after the edge of load_i.
`default_nettype none

module score_hold #(
    parameter WIDTH = 7  // bits of the score
) (
    input  wire             clk_i,    // clock, rising edge
    input  wire             rst_i,    // synchronous reset, active high
    input  wire             load_i,   // take score_i at this edge
    input  wire [WIDTH-1:0] score_i,  // the score of a frame
    output reg  [WIDTH-1:0] score_o   // score that was taken last
);

    // Limits: a value out of range stops elaboration at an instance of a module that does not exist.
    generate
        if (WIDTH < 1) begin : g_width WIDTH_must_be_1_or_more u_refused (); end
    endgenerate

    always @(posedge clk_i) begin
        if (rst_i) score_o <= {WIDTH{1'b0}};
        else if (load_i) score_o <= score_i;
    end

endmodule

`default_nettype wire
