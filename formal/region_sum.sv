// SPDX-License-Identifier: MIT OR Apache-2.0
// Sums of pixels and of squares with the widths of a generated design never overflow.
module sum_properties #(parameter [63:0] MAX = 1, parameter WIDTH = 1, parameter SUM_BITS = 1) (
    input wire clk_i, rst_i, step, input wire [WIDTH-1:0] value
);
    `include "reset.vh"
    wire last, done, sum_done;
    wire [15:0] place, seen;
    frames #(.PIXELS(`N * `N)) u_frames (
        .clk_i(clk_i), .rst_i(rst_i), .step_i(step), .last_o(last), .done_o(done), .place_o(place), .seen_o(seen)
    );
    wire [SUM_BITS-1:0] sum;
    region_sum #(.WIDTH(WIDTH), .SUM_BITS(SUM_BITS)) dut (
        .clk_i(clk_i), .rst_i(rst_i), .step_i(step), .last_i(last), .value_i(value),
        .done_o(sum_done), .sum_o(sum)
    );
    always @* assume(value <= MAX);
    reg [63:0] exact;
    always @(posedge clk_i) begin
        if (rst_i) exact <= 64'd0;
        else exact <= (done ? 64'd0 : exact) + (step ? value : 64'd0);
    end
    always @* if (started) begin
        assert(exact <= seen * MAX);
        assert(sum == exact);
        assert(sum_done == done);
    end
endmodule

module properties (
    input wire clk_i, rst_i, step,
    input wire [`U_PIXEL_SUM_WIDTH-1:0] pixel, input wire [`U_SQUARE_SUM_WIDTH-1:0] square
);
    localparam [63:0] MAX = (64'd1 << `P) - 64'd1;
    sum_properties #(.MAX(MAX), .WIDTH(`U_PIXEL_SUM_WIDTH), .SUM_BITS(`U_PIXEL_SUM_SUM_BITS)) u_pixels (
        .clk_i(clk_i), .rst_i(rst_i), .step(step), .value(pixel)
    );
    sum_properties #(.MAX(MAX * MAX), .WIDTH(`U_SQUARE_SUM_WIDTH), .SUM_BITS(`U_SQUARE_SUM_SUM_BITS)) u_squares (
        .clk_i(clk_i), .rst_i(rst_i), .step(step), .value(square)
    );
endmodule
