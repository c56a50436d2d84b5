// SPDX-License-Identifier: MIT OR Apache-2.0
// The result is floor((s + 8) / 16) for the sum s of the pixels with the weights 1, 2, 1 in both directions, for every window and
// border.
localparam F_LATE = DEEP;
`include "words.vh"
// The sum of a column with the weights 1, 2, 1.
function [COLUMN-1:0] f_sum(input [F_COLUMN-1:0] column);
    f_sum = column[0+:WIDTH] + 2 * column[WIDTH+:WIDTH] + column[2*WIDTH+:WIDTH];
endfunction
function [TOTAL-1:0] f_rounded(input [3*F_COLUMN-1:0] window);
    f_rounded = f_sum(window[0+:F_COLUMN]) + 2 * f_sum(window[F_COLUMN+:F_COLUMN]) + f_sum(window[2*F_COLUMN+:F_COLUMN]) + 8;
endfunction
generate
    for (f_lane = 0; f_lane < LANES; f_lane = f_lane + 1) begin : g_f_held
        wire [COLUMN-1:0] newest = f_sum(f_newest[f_lane*F_COLUMN+:F_COLUMN]) + 2;
        wire [COLUMN-1:0] center = f_sum(f_center[f_lane*F_COLUMN+:F_COLUMN]) + 2;
        always @* begin
            if (f_words >= 2'd1) assert(newest_q[f_lane*COLUMN+:COLUMN] == newest);
            if (f_words >= 2'd2) assert(center_q[f_lane*COLUMN+:COLUMN] == center);
        end
    end
endgenerate
wire [COLUMN-1:0] f_left = f_sum(f_before) + 2;
always @* begin
    if (f_words >= 2'd2) assert({no_left_q, no_right_q} == {f_no_left, f_no_right});
    if (f_known) assert(left_q == f_left);
end
generate
    for (f_lane = 0; f_lane < LANES; f_lane = f_lane + 1) begin : g_f_mean
        wire [TOTAL-1:0] rounded = f_rounded(f_window(f_lane));
        wire [WIDTH-1:0] expected;
        word_delay #(.WIDTH(WIDTH), .DEPTH(2 + 2 * DEEP)) f_expected (
            .clk_i(clk_i), .data_i(rounded[4+:WIDTH]), .data_o(expected)
        );
        always @* if (f_age >= 2 + 2 * DEEP) assert(mean_o[f_lane*WIDTH+:WIDTH] == expected);
    end
endgenerate
