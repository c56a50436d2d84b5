// SPDX-License-Identifier: MIT OR Apache-2.0
// Computes the sum of the pixels of every region, and with VARIANCE their variance, three clocks after the sum.
`default_nettype none

module raster_moments #(
    parameter WIDTH = 8,             // bits of a pixel
    parameter LANES = 1,             // pixels of a word
    parameter SIDE = 8,              // rows of a region
    parameter COLUMNS = 240,         // regions in a row of regions
    parameter VARIANCE = 0,          // 1: the variance is computed
    parameter SUM_BITS = 14,         // bits of the sum of a region's pixels
    parameter SQUARE_SUM_BITS = 22,  // bits of the sum of squares (VARIANCE)
    parameter PRODUCT_BITS = 28,     // bits of the products of the variance
    parameter VARIANCE_BITS = 26,    // bits of the variance
    parameter DEEP = 0               // 1: sums come one clock later
) (
    input  wire                     clk_i,            // clock, rising edge
    input  wire                     rst_i,            // synchronous reset, active high
    input  wire [  LANES*WIDTH-1:0] word_i,           // a word, which comes two clocks before its step
    input  wire                     step_i,           // the word is added at this edge
    input  wire                     segment_end_i,    // the word ends a row of a region
    input  wire                     row_end_i,        // the word is the last of its row of the frame
    input  wire                     region_top_i,     // the word is in the first row of its region
    output wire [     SUM_BITS-1:0] sum_o,            // sum of a region, if the word was the last of that region
    output wire [VARIANCE_BITS-1:0] variance_o        // variance of that region, three clocks later (VARIANCE)
);

    localparam WORD_SUM_BITS = WIDTH + $clog2(LANES);
    localparam SQUARE_BITS = 2 * WIDTH;
    localparam WORD_SQUARE_BITS = SQUARE_BITS + $clog2(LANES);
    integer lane;

    reg [WORD_SUM_BITS-1:0] word_sum, word_sum_q, word_sum_2q;
    always @* begin
        word_sum = {WORD_SUM_BITS{1'b0}};
        for (lane = 0; lane < LANES; lane = lane + 1)
            word_sum = word_sum + {{(WORD_SUM_BITS - WIDTH) {1'b0}}, word_i[lane*WIDTH+:WIDTH]};
    end
    always @(posedge clk_i) begin
        word_sum_q  <= word_sum;
        word_sum_2q <= word_sum_q;
    end

    raster_sums #(
        .VALUE_BITS(WORD_SUM_BITS), .SUM_BITS(SUM_BITS), .COLUMNS(COLUMNS), .COLUMN_BITS($clog2(COLUMNS)), .DEEP(DEEP)
    ) u_sum (
        .clk_i(clk_i), .rst_i(rst_i), .step_i(step_i), .values_i(word_sum_2q), .segment_end_i(segment_end_i),
        .row_end_i(row_end_i), .region_top_i(region_top_i), .sums_o(sum_o)
    );

    generate
        if (VARIANCE) begin : g_variance
            reg [LANES*SQUARE_BITS-1:0] squares_q;
            reg [WORD_SQUARE_BITS-1:0] word_square, word_square_2q;
            wire [SQUARE_SUM_BITS-1:0] square_sum;
            integer square, pixel;
            always @* begin
                word_square = {WORD_SQUARE_BITS{1'b0}};
                for (square = 0; square < LANES; square = square + 1)
                    word_square = word_square + {{(WORD_SQUARE_BITS - SQUARE_BITS) {1'b0}}, squares_q[square*SQUARE_BITS+:SQUARE_BITS]};
            end
            always @(posedge clk_i) begin
                for (pixel = 0; pixel < LANES; pixel = pixel + 1)
                    squares_q[pixel*SQUARE_BITS+:SQUARE_BITS] <= word_i[pixel*WIDTH+:WIDTH] * word_i[pixel*WIDTH+:WIDTH];
                word_square_2q <= word_square;
            end
            raster_sums #(
                .VALUE_BITS(WORD_SQUARE_BITS), .SUM_BITS(SQUARE_SUM_BITS), .COLUMNS(COLUMNS),
                .COLUMN_BITS($clog2(COLUMNS)), .DEEP(DEEP)
            ) u_square_sum (
                .clk_i(clk_i), .rst_i(rst_i), .step_i(step_i), .values_i(word_square_2q),
                .segment_end_i(segment_end_i), .row_end_i(row_end_i), .region_top_i(region_top_i), .sums_o(square_sum)
            );
            raster_variance #(
                .PIXELS(SIDE * SIDE), .SUM_BITS(SUM_BITS), .SQUARE_SUM_BITS(SQUARE_SUM_BITS),
                .PRODUCT_BITS(PRODUCT_BITS), .SCORE_BITS(VARIANCE_BITS)
            ) u_variance (
                .clk_i(clk_i), .sum_i(sum_o), .square_sum_i(square_sum), .score_o(variance_o)
            );
        end else begin : g_no_variance
            assign variance_o = {VARIANCE_BITS{1'b0}};
        end
    endgenerate

endmodule

`default_nettype wire
