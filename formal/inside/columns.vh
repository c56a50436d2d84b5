// SPDX-License-Identifier: MIT OR Apache-2.0
// The pixels of a window as they came in, kept next to a detector. With the incoming column on the right, `newest` is the center
// and `before` its left neighbor.
localparam F_COLUMN = 3 * WIDTH;
wire [F_COLUMN-1:0] f_incoming = {lower_i, middle_i, upper_i};
reg [F_COLUMN-1:0] f_newest, f_before, f_oldest;
reg f_newest_first, f_before_first;  // the column is the first of its row
reg f_clamp;                         // right_i at the last advance
reg [1:0] f_columns = 2'd0;          // number of columns that came, up to 3
always @(posedge clk_i) if (advance_i) begin
    f_newest       <= f_incoming;
    f_before       <= f_newest;
    f_oldest       <= f_before;
    f_newest_first <= left_i;
    f_before_first <= f_newest_first;
    f_clamp        <= right_i;
    if (f_columns != 2'd3) f_columns <= f_columns + 2'd1;
end
