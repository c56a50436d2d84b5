// SPDX-License-Identifier: MIT OR Apache-2.0
// Computes pixels * (sum of squares) - sum^2, which is pixels^2 times the variance. score_o holds it after the edge of
// done_i. With DEEP the squares come one clock after the pixels, so that the square of the sum is in a register.
`default_nettype none

module variance_score #(
    parameter PIXELS = 64,           // pixels of a region
    parameter SUM_BITS = 14,         // bits of the sum
    parameter SQUARE_SUM_BITS = 22,  // bits of the sum of squares
    parameter PRODUCT_BITS = 28,     // bits of pixels * (sum of squares)
    parameter SCORE_BITS = 26,       // bits of the score
    parameter DEEP = 0               // 1: sum_i comes one clock before done_i
) (
    input  wire                       clk_i,         // clock, rising edge
    input  wire                       rst_i,         // synchronous reset, active high
    input  wire                       done_i,        // the sum of squares is that of a whole frame
    input  wire [       SUM_BITS-1:0] sum_i,         // sum of the pixels of that frame
    input  wire [SQUARE_SUM_BITS-1:0] square_sum_i,  // sum of the squares of these pixels
    output reg  [     SCORE_BITS-1:0] score_o        // score of the last whole frame
);

    // Limits: a value out of range stops elaboration at an instance of a module that does not exist.
    generate
        if (PRODUCT_BITS < SUM_BITS) begin : g_product_bits
            PRODUCT_BITS_must_be_SUM_BITS_or_more u_refused ();
        end
        if (PRODUCT_BITS < SQUARE_SUM_BITS) begin : g_product_bits_2
            PRODUCT_BITS_must_be_SQUARE_SUM_BITS_or_more u_refused ();
        end
        if (SCORE_BITS < 1 || SCORE_BITS > PRODUCT_BITS) begin : g_score_bits
            SCORE_BITS_must_be_1_to_PRODUCT_BITS u_refused ();
        end
        if (DEEP != 0 && DEEP != 1) begin : g_deep_range DEEP_must_be_0_or_1 u_refused (); end
    endgenerate

    localparam [PRODUCT_BITS-1:0] FACTOR = PIXELS;

    wire [PRODUCT_BITS-1:0] sum = {{(PRODUCT_BITS - SUM_BITS) {1'b0}}, sum_i};
    wire [PRODUCT_BITS-1:0] square_sum = {{(PRODUCT_BITS - SQUARE_SUM_BITS) {1'b0}}, square_sum_i};
    wire [PRODUCT_BITS-1:0] larger = FACTOR * square_sum;
    wire [PRODUCT_BITS-1:0] smaller;
    // The difference is smaller than each product.
    /* verilator lint_off UNUSEDSIGNAL */
    wire [PRODUCT_BITS-1:0] score = larger - smaller;
    /* verilator lint_on UNUSEDSIGNAL */

    generate
        if (DEEP) begin : g_deep
            reg [PRODUCT_BITS-1:0] smaller_q;
            always @(posedge clk_i) smaller_q <= sum * sum;
            assign smaller = smaller_q;
        end else begin : g_plain
            assign smaller = sum * sum;
        end
    endgenerate

    always @(posedge clk_i) begin
        if (rst_i) score_o <= {SCORE_BITS{1'b0}};
        else if (done_i) score_o <= score[SCORE_BITS-1:0];
    end

endmodule

`default_nettype wire
