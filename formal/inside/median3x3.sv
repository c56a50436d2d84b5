// SPDX-License-Identifier: MIT OR Apache-2.0
// The result is the fifth of the nine sorted pixels: for every threshold, it reaches the threshold if and only if at least five of the
// nine pixels do. With SWITCHING it is the center, unless this is the largest or the smallest pixel. It is valid two clocks after the
// step.
`include "columns.vh"
wire [F_COLUMN-1:0] f_left = f_before_first ? f_before : f_oldest;
wire [F_COLUMN-1:0] f_right = f_clamp ? f_before : f_newest;
wire f_known = f_columns == 2'd3 || (f_columns == 2'd2 && f_before_first);
reg [9*WIDTH-1:0] f_window;
reg f_window_known = 1'b0;
reg [1:0] f_steps = 2'b00;
always @(posedge clk_i) begin
    f_window <= {f_left, f_before, f_right};
    f_window_known <= f_known;
    f_steps <= rst_i ? 2'b00 : {f_steps[0], step_i};
end
(* anyconst *) wire [WIDTH-1:0] f_threshold;
// The pixels of a column that reach the threshold.
function [2:0] f_reach(input [F_COLUMN-1:0] column);
    f_reach = {column[2*WIDTH+:WIDTH] >= f_threshold, column[WIDTH+:WIDTH] >= f_threshold, column[0+:WIDTH] >= f_threshold};
endfunction
// A sorted column: its lowest pixel reaches the threshold if all do, its middle one if two do, its highest one if any does.
function f_sorted(input [F_COLUMN-1:0] column, input [WIDTH-1:0] low, input [WIDTH-1:0] mid, input [WIDTH-1:0] high);
    reg [2:0] r;
    begin
        r = f_reach(column);
        f_sorted = (low >= f_threshold) == &r && (high >= f_threshold) == |r
            && (mid >= f_threshold) == ((r[0] && r[1]) || (r[0] && r[2]) || (r[1] && r[2]));
    end
endfunction
function [WIDTH-1:0] f_extreme(input [F_COLUMN-1:0] column, input highest);
    reg [WIDTH-1:0] x, y, z;
    begin
        {x, y, z} = column;
        if ((y > x) == highest) x = y;
        if ((z > x) == highest) x = z;
        f_extreme = x;
    end
endfunction
wire [WIDTH-1:0] f_center = f_window[F_COLUMN+WIDTH+:WIDTH];
reg f_largest, f_smallest;
integer f_place;
always @* begin
    f_largest = 1'b1;
    f_smallest = 1'b1;
    for (f_place = 0; f_place < 9; f_place = f_place + 1) begin
        if (f_window[f_place*WIDTH+:WIDTH] > f_center) f_largest = 1'b0;
        if (f_window[f_place*WIDTH+:WIDTH] < f_center) f_smallest = 1'b0;
    end
end
wire [8:0] f_reached = {f_reach(f_window[2*F_COLUMN+:F_COLUMN]), f_reach(f_window[F_COLUMN+:F_COLUMN]), f_reach(f_window[0+:F_COLUMN])};
wire [3:0] f_count = f_reached[0] + f_reached[1] + f_reached[2] + f_reached[3] + f_reached[4]
    + f_reached[5] + f_reached[6] + f_reached[7] + f_reached[8];
always @* begin
    if (f_columns >= 2'd1) begin
        assert(f_sorted(f_newest, right_low_q, right_mid_q, right_high_q));
        assert(row_start_q == f_newest_first && clamp_q == f_clamp);
    end
    if (f_columns >= 2'd2) assert(f_sorted(f_before, center_low_q, center_mid_q, center_high_q));
    if (f_known) assert(f_sorted(f_left, left_low_q, left_mid_q, left_high_q));
    if (f_window_known) begin
        if (SWITCHING && !f_largest && !f_smallest) assert(median_o == f_center);
        else assert((median_o >= f_threshold) == (f_count >= 4'd5));
    end
end
generate
    if (SWITCHING) begin : g_f_switching
        always @* begin
            if (f_columns >= 2'd1) begin
                assert(g_switching.right_pixel_q == f_newest[WIDTH+:WIDTH]);
                assert(g_switching.right_largest_q == (g_switching.right_pixel_q == right_high_q));
                assert(g_switching.right_smallest_q == (g_switching.right_pixel_q == right_low_q));
                assert(right_low_q == f_extreme(f_newest, 1'b0) && right_high_q == f_extreme(f_newest, 1'b1));
            end
            if (f_columns >= 2'd2) begin
                assert(g_switching.center_pixel_q == f_before[WIDTH+:WIDTH]);
                assert(g_switching.center_largest_q == (g_switching.center_pixel_q == center_high_q));
                assert(g_switching.center_smallest_q == (g_switching.center_pixel_q == center_low_q));
                assert(center_low_q == f_extreme(f_before, 1'b0) && center_high_q == f_extreme(f_before, 1'b1));
            end
            if (f_known) assert(left_low_q == f_extreme(f_left, 1'b0) && left_high_q == f_extreme(f_left, 1'b1));
        end
    end
endgenerate
reg f_started = 1'b0;
always @(posedge clk_i) f_started <= 1'b1;
always @* begin
    if (!f_started) assume(rst_i);
    else assert({valid_o, step_q} == f_steps);
end
