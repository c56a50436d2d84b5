// SPDX-License-Identifier: MIT OR Apache-2.0
// Computes PIXELS * (sum of squares) - sum^2, which is PIXELS^2 times the variance. The score comes three clocks after the
// sums.
`default_nettype none

module raster_variance #(
    parameter PIXELS = 64,           // pixels of a region
    parameter SUM_BITS = 14,         // bits of the sum
    parameter SQUARE_SUM_BITS = 22,  // bits of the sum of squares
    parameter PRODUCT_BITS = 28,     // bits of each product
    parameter SCORE_BITS = 26        // bits of the score
) (
    input  wire                       clk_i,         // clock, rising edge
    input  wire [       SUM_BITS-1:0] sum_i,         // sum of the pixels of a region
    input  wire [SQUARE_SUM_BITS-1:0] square_sum_i,  // sum of the squares of these pixels
    output reg  [     SCORE_BITS-1:0] score_o        // score of that region
);

    // Limits: a value out of range stops elaboration at an instance of a module that does not exist.
    generate
        if (PRODUCT_BITS < SUM_BITS || PRODUCT_BITS < SQUARE_SUM_BITS) begin : g_product_bits
            PRODUCT_BITS_must_hold_both_sums u_refused ();
        end
        if (SCORE_BITS < 1 || SCORE_BITS > PRODUCT_BITS) begin : g_score_bits
            SCORE_BITS_must_be_1_to_PRODUCT_BITS u_refused ();
        end
    endgenerate

    localparam FACTOR_BITS = $clog2(PIXELS + 1);
    wire [PRODUCT_BITS-1:0] factor = {{(PRODUCT_BITS - FACTOR_BITS) {1'b0}}, PIXELS[FACTOR_BITS-1:0]};

    wire [PRODUCT_BITS-1:0] sum = {{(PRODUCT_BITS - SUM_BITS) {1'b0}}, sum_i};
    wire [PRODUCT_BITS-1:0] square_sum = {{(PRODUCT_BITS - SQUARE_SUM_BITS) {1'b0}}, square_sum_i};
    reg  [PRODUCT_BITS-1:0] multiple_q, square_q;
    // The difference is smaller than each product.
    /* verilator lint_off UNUSEDSIGNAL */
    reg  [PRODUCT_BITS-1:0] difference_2q;
    /* verilator lint_on UNUSEDSIGNAL */

    always @(posedge clk_i) begin
        multiple_q    <= factor * square_sum;
        square_q      <= sum * sum;
        difference_2q <= multiple_q - square_q;
        score_o       <= difference_2q[SCORE_BITS-1:0];
    end

endmodule

`default_nettype wire
