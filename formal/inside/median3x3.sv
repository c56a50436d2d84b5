// SPDX-License-Identifier: MIT OR Apache-2.0
// The result is the fifth of the nine sorted pixels: at most four are smaller, and at least five are not
// larger. It is valid two clocks after the step.
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
reg [3:0] f_smaller, f_not_larger;
integer f_k;
always @* begin
    f_smaller = 4'd0;
    f_not_larger = 4'd0;
    for (f_k = 0; f_k < 9; f_k = f_k + 1) begin
        f_smaller = f_smaller + (f_window[f_k*WIDTH+:WIDTH] < median_o);
        f_not_larger = f_not_larger + (f_window[f_k*WIDTH+:WIDTH] <= median_o);
    end
end
// A column is sorted: the same three pixels, in order.
function f_sorted(input [F_COLUMN-1:0] column, input [WIDTH-1:0] low, input [WIDTH-1:0] mid, input [WIDTH-1:0] high);
    reg [WIDTH-1:0] a, b, c;
    begin
        {c, b, a} = column;
        f_sorted = low <= mid && mid <= high
            && ((low == a && mid == b && high == c) || (low == a && mid == c && high == b)
             || (low == b && mid == a && high == c) || (low == b && mid == c && high == a)
             || (low == c && mid == a && high == b) || (low == c && mid == b && high == a));
    end
endfunction
always @* begin
    if (f_columns >= 2'd1) begin
        assert(f_sorted(f_newest, right_low_q, right_mid_q, right_high_q));
        assert(row_start_q == f_newest_first && clamp_q == f_clamp);
    end
    if (f_columns >= 2'd2) assert(f_sorted(f_before, center_low_q, center_mid_q, center_high_q));
    if (f_known) assert(f_sorted(f_left, left_low_q, left_mid_q, left_high_q));
    if (f_window_known) assert(f_smaller <= 4'd4 && f_not_larger >= 4'd5);
end
reg f_started = 1'b0;
always @(posedge clk_i) f_started <= 1'b1;
always @* begin
    if (!f_started) assume(rst_i);
    else assert({valid_o, step_q} == f_steps);
end
