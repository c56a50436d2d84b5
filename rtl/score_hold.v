// SPDX-License-Identifier: MIT OR Apache-2.0
// Keeps the score of a frame until a slower feature has its own.
`default_nettype none

module score_hold #(
    parameter WIDTH = 7  // bits of the score
) (
    input  wire             clk_i,
    input  wire             rst_i,
    input  wire             load_i,
    input  wire [WIDTH-1:0] score_i,
    output reg  [WIDTH-1:0] score_o
);

    always @(posedge clk_i) begin
        if (rst_i) score_o <= {WIDTH{1'b0}};
        else if (load_i) score_o <= score_i;
    end

endmodule

`default_nettype wire
