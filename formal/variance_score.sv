// SPDX-License-Identifier: MIT OR Apache-2.0
// n * (sum of squares) - sum^2 without overflow, for all sums that pixels can have: x^2 <= max * x for each pixel, and
// sum^2 <= n * (sum of squares).
module properties (
    input wire clk_i, rst_i, done,
    input wire [`U_VARIANCE_SUM_BITS-1:0] sum, input wire [`U_VARIANCE_SQUARE_SUM_BITS-1:0] squares
);
    `include "reset.vh"
    localparam WIDE = `U_VARIANCE_PRODUCT_BITS + 2;
    localparam [WIDE-1:0] MAX = (1 << `P) - 1;
    localparam [WIDE-1:0] PIXELS = `N * `N;
    wire [`U_VARIANCE_SCORE_BITS-1:0] score;
    variance_score #(`U_VARIANCE) dut (
        .clk_i(clk_i), .rst_i(rst_i), .done_i(done), .sum_i(sum), .square_sum_i(squares), .score_o(score)
    );
    wire [WIDE-1:0] wide_sum = sum;
    wire [WIDE-1:0] wide_squares = squares;
    wire [WIDE-1:0] square = wide_sum * wide_sum;
    wire [WIDE-1:0] product = PIXELS * wide_squares;
    always @* begin
        assume(sum <= PIXELS * MAX);
        assume(wide_squares <= MAX * wide_sum);
        assume(square <= product);
    end
    reg [WIDE-1:0] exact;
    always @(posedge clk_i) begin
        if (rst_i) exact <= 0;
        else if (done) exact <= product - square;
    end
    always @* if (started) assert(score == exact);
endmodule
