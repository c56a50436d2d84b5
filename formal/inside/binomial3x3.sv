// SPDX-License-Identifier: MIT OR Apache-2.0
// The result is the sum of the nine pixels with the weights 1, 2, 1 in both directions, plus 8, divided by 16 and rounded down. It
// is valid two clocks after the step.
`include "columns.vh"
wire [F_COLUMN-1:0] f_left = f_before_first ? f_before : f_oldest;
wire [F_COLUMN-1:0] f_right = f_clamp ? f_before : f_newest;
wire f_known = f_columns == 2'd3 || (f_columns == 2'd2 && f_before_first);
reg [3*F_COLUMN-1:0] f_window;
reg f_window_known = 1'b0;
reg [1:0] f_steps = 2'b00;
always @(posedge clk_i) begin
    f_window <= {f_left, f_before, f_right};
    f_window_known <= f_known;
    f_steps <= rst_i ? 2'b00 : {f_steps[0], step_i};
end
// A column with the weights 1, 2, 1.
function [31:0] f_weighted(input [F_COLUMN-1:0] column);
    f_weighted = column[2*WIDTH+:WIDTH] + 2 * column[WIDTH+:WIDTH] + column[0+:WIDTH];
endfunction
wire [31:0] f_sum = f_weighted(f_window[2*F_COLUMN+:F_COLUMN]) + 2 * f_weighted(f_window[F_COLUMN+:F_COLUMN])
    + f_weighted(f_window[0+:F_COLUMN]);
always @* begin
    if (f_columns >= 2'd1) begin
        assert(right_q == f_weighted(f_newest) + 2);
        assert(row_start_q == f_newest_first && clamp_q == f_clamp);
    end
    if (f_columns >= 2'd2) assert(center_q == f_weighted(f_before) + 2);
    if (f_known) assert(left_q == f_weighted(f_left) + 2);
    if (f_window_known) assert(mean_o == (f_sum + 8) / 16);
end
reg f_started = 1'b0;
always @(posedge clk_i) f_started <= 1'b1;
always @* begin
    if (!f_started) assume(rst_i);
    else assert({valid_o, step_q} == f_steps);
end
