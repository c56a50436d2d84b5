// SPDX-License-Identifier: MIT OR Apache-2.0
// An instance as in a generated design, with any inputs.
module properties (
    input wire clk_i, rst_i, advance, step, last, left, right, input wire [`P-1:0] middle, lower
);
    `include "reset.vh"
    wire [`U_SURFACE_SCORE_BITS-1:0] score;
    region_surface #(`U_SURFACE) dut (
        .clk_i(clk_i), .rst_i(rst_i), .advance_i(advance), .step_i(step), .last_i(last), .left_i(left), .right_i(right),
        .middle_i(middle), .lower_i(lower), .score_o(score)
    );
endmodule
