// SPDX-License-Identifier: MIT OR Apache-2.0
// An instance as in a generated design, with any inputs.
module properties (
    input wire clk_i, rst_i, enable, restart, step,
    input wire [`P-1:0] pixel, input wire [`U_SEGMENT_MEAN_BITS-1:0] mean, input wire [`P-1:0] level
);
    `include "reset.vh"
    localparam [63:0] TOP = ((64'd1 << `P) - 64'd1) << `U_SEGMENT_FRACTION;
    wire [`U_SEGMENT_SCORE_BITS-1:0] score;
    segment_score #(`U_SEGMENT) dut (
        .clk_i(clk_i), .rst_i(rst_i), .enable_i(enable), .restart_i(restart), .step_i(step),
        .pixel_i(pixel), .mean_i(mean), .level_i(level), .score_o(score)
    );
    always @* assume(mean <= TOP);  // proven in region_mean
endmodule
