// SPDX-License-Identifier: MIT OR Apache-2.0
// The registers hold the terms of the left and the center column of half of Gx + Gy and Gy - Gx, and a hit says that one of these
// is above floor(level / 2). edge_rule proves that this is |Gx| + |Gy| > level.
`include "columns.vh"
wire [F_COLUMN-1:0] f_left = f_newest_first ? f_newest : f_before;
wire f_left_known = f_columns >= 2'd2 || (f_columns == 2'd1 && f_newest_first);
wire [WIDTH:0] f_upper_pair = f_newest[0+:WIDTH] + f_newest[WIDTH+:WIDTH];
wire [WIDTH:0] f_lower_pair = f_newest[2*WIDTH+:WIDTH] + f_newest[WIDTH+:WIDTH];
wire [WIDTH:0] f_left_upper_pair = f_left[0+:WIDTH] + f_left[WIDTH+:WIDTH];
wire [WIDTH:0] f_left_lower_pair = f_left[2*WIDTH+:WIDTH] + f_left[WIDTH+:WIDTH];
wire [SUM_BITS-1:0] f_slope = {2'b0, f_lower_pair} - {2'b0, f_upper_pair};
// The right column, or the center's column at the end of a row.
wire [WIDTH:0] f_right_upper_pair = right_i ? upper_pair_q : upper_i + middle_i;
wire [WIDTH:0] f_right_lower_pair = right_i ? lower_pair_q : lower_i + middle_i;
wire signed [SUM_BITS:0] f_half_sum = $signed(sum_q) + $signed({3'b0, f_right_lower_pair});
wire signed [SUM_BITS:0] f_half_diff = $signed(diff_q) - $signed({3'b0, f_right_upper_pair});
wire signed [SUM_BITS:0] f_half_level = $signed({2'b0, level_i} >> 1);
wire f_in_range = $signed(sum_q) >= -3 * ((1 << WIDTH) - 1) && $signed(sum_q) <= (1 << WIDTH) - 1
    && $signed(diff_q) <= 3 * ((1 << WIDTH) - 1) && $signed(diff_q) >= -((1 << WIDTH) - 1);
always @* begin
    if (f_columns != 2'd0) begin
        assert(upper_pair_q == f_upper_pair);
        assert(lower_pair_q == f_lower_pair);
    end
    if (f_left_known) begin
        assert(sum_q == f_slope - {2'b0, f_left_upper_pair});
        assert(diff_q == f_slope + {2'b0, f_left_lower_pair});
        assert(f_in_range);
        assert(hit_o == (f_half_sum > f_half_level || -f_half_sum > f_half_level
                         || f_half_diff > f_half_level || -f_half_diff > f_half_level));
    end
end
