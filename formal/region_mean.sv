// SPDX-License-Identifier: MIT OR Apache-2.0
// The mean of every sum that can occur is floor((2^f * sum + floor(n / 2)) / n): with the reciprocal and the widths of a
// generated design, mean * n <= dividend < (mean + 1) * n.
module properties (input wire clk_i, rst_i, done, input wire [`U_MEAN_SUM_BITS-1:0] sum);
    `include "reset.vh"
    localparam [63:0] MAX = (64'd1 << `P) - 64'd1;
    localparam [47:0] PIXELS = `N * `N;
    wire [`U_MEAN_MEAN_BITS-1:0] mean;
    region_mean #(`U_MEAN) dut (.clk_i(clk_i), .done_i(done), .sum_i(sum), .mean_o(mean));
    always @* assume(sum <= PIXELS * MAX);
    reg some = 1'b0;
    reg [`U_MEAN_SUM_BITS-1:0] of;
    always @(posedge clk_i) if (done) begin
        some <= 1'b1;
        of <= sum;
    end
    wire [47:0] dividend = (of << `U_MEAN_FRACTION) + PIXELS / 48'd2;
    wire [47:0] product = mean * PIXELS;
    always @* if (some) begin
        assert(product <= dividend);
        assert(dividend < product + PIXELS);
        assert(mean <= MAX << `U_MEAN_FRACTION);
    end
endmodule
