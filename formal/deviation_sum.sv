// SPDX-License-Identifier: MIT OR Apache-2.0
// The second pass adds up |2^f * x - mu| of every pixel, modulo its width. deviation_bound proves that the width is
// enough.
module properties (
    input wire clk_i, rst_i, step, enable,
    input wire [`P-1:0] pixel, input wire [`U_DEVIATION_MEAN_BITS-1:0] mean
);
    `include "reset.vh"
    localparam [63:0] TOP = ((64'd1 << `P) - 64'd1) << `U_DEVIATION_FRACTION;
    wire last, done;
    wire [15:0] place, seen;
    frames #(.PIXELS(`N * `N)) u_frames (
        .clk_i(clk_i), .rst_i(rst_i), .step_i(step), .last_o(last), .done_o(done), .place_o(place), .seen_o(seen)
    );
    wire [`U_DEVIATION_SUM_BITS-1:0] sum;
    deviation_sum #(`U_DEVIATION) dut (
        .clk_i(clk_i), .rst_i(rst_i), .enable_i(enable), .restart_i(done), .step_i(step),
        .pixel_i(pixel), .mean_i(mean), .sum_o(sum)
    );
    always @* assume(mean <= TOP);  // proven in region_mean
    wire [63:0] scaled = pixel << `U_DEVIATION_FRACTION;
    wire [63:0] deviation = scaled > mean ? scaled - mean : mean - scaled;
    reg [63:0] exact;
    always @(posedge clk_i) begin
        if (rst_i || !enable) exact <= 64'd0;
        else exact <= (done ? 64'd0 : exact) + (step ? deviation : 64'd0);
    end
    always @* if (started) begin
        assert(exact <= seen * TOP);
        assert(sum == exact[`U_DEVIATION_SUM_BITS-1:0]);
    end
endmodule
