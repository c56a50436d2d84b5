// SPDX-License-Identifier: MIT OR Apache-2.0
// 3x3 Sobel: hit when |Gx| + |Gy| > level.
//
// |Gx| + |Gy| is the larger of |Gx + Gy| and |Gx - Gy|, and both have kernels of weight +-2 only:
//
//     (Gx + Gy) / 2 = -(upper + middle) of the left column + (lower - upper) of the center column
//                     + (middle + lower) of the right column
//     (Gy - Gx) / 2 = (middle + lower) of the left + (lower - upper) of the center
//                     - (upper + middle) of the right
//
// so each is compared with floor(level / 2). What left and center contribute is added up before the
// right column comes, and every clamp is an operand of one of these adders.
`default_nettype none

module edge_detector #(
    parameter WIDTH = 8,       // bits of a pixel
    parameter LEVEL_BITS = 11  // bits of the level, at most WIDTH + 3
) (
    input  wire             clk_i,
    input  wire             advance_i,
    input  wire             left_i,    // the incoming column is the first of its row
    input  wire             right_i,   // the center is the last of its row
    input  wire [WIDTH-1:0] upper_i,   // the incoming column
    input  wire [WIDTH-1:0] middle_i,
    input  wire [WIDTH-1:0] lower_i,
    input  wire [LEVEL_BITS-1:0] level_i,
    output wire             hit_o      // of the center, with the incoming column on its right
);

    wire [WIDTH:0] upper_pair = upper_i + middle_i;
    wire [WIDTH:0] lower_pair = lower_i + middle_i;
    wire signed [WIDTH+2:0] slope = $signed({3'b0, lower_i}) - $signed({3'b0, upper_i});

    reg [WIDTH:0] upper_pair_q;
    reg [WIDTH:0] lower_pair_q;
    reg signed [WIDTH+2:0] sum_q;   // left and center part of (Gx + Gy) / 2
    reg signed [WIDTH+2:0] diff_q;  // left and center part of (Gy - Gx) / 2

    always @(posedge clk_i) begin
        if (advance_i) begin
            upper_pair_q <= upper_pair;
            lower_pair_q <= lower_pair;
            sum_q  <= slope - $signed({2'b0, left_i ? upper_pair : upper_pair_q});
            diff_q <= slope + $signed({2'b0, left_i ? lower_pair : lower_pair_q});
        end
    end

    wire signed [WIDTH+2:0] sum = sum_q + $signed({2'b0, right_i ? lower_pair_q : lower_pair});
    wire signed [WIDTH+2:0] diff = diff_q - $signed({2'b0, right_i ? upper_pair_q : upper_pair});

    // Doubled sums are even, so the lowest bit of the level decides nothing.
    wire [WIDTH+1:0] half_level = {{(WIDTH + 3 - LEVEL_BITS) {1'b0}}, level_i[LEVEL_BITS-1:1]};
    wire unused_level_bit = level_i[0];

    wire sum_above;
    wire diff_above;

    magnitude_above #(.WIDTH(WIDTH + 3)) u_sum (
        .value_i(sum), .level_i(half_level), .above_o(sum_above)
    );

    magnitude_above #(.WIDTH(WIDTH + 3)) u_diff (
        .value_i(diff), .level_i(half_level), .above_o(diff_above)
    );

    assign hit_o = sum_above || diff_above;

endmodule

`default_nettype wire
