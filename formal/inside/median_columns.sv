// SPDX-License-Identifier: MIT OR Apache-2.0
// The result is the fifth of the nine sorted pixels: for every threshold, it reaches the threshold if and only if at least five of
// the nine pixels do.
localparam F_LATE = DEEP;
`include "words.vh"
(* anyconst *) wire [WIDTH-1:0] f_threshold;
// The pixels of a column that reach the threshold.
function [2:0] f_reach(input [F_COLUMN-1:0] column);
    f_reach = {column[2*WIDTH+:WIDTH] >= f_threshold, column[WIDTH+:WIDTH] >= f_threshold, column[0+:WIDTH] >= f_threshold};
endfunction
// Tests that {high, mid, low} is the sorted column.
function f_sorted(input [F_COLUMN-1:0] sorted, input [F_COLUMN-1:0] column);
    reg [2:0] r, s;
    begin
        r = f_reach(column);
        s = f_reach(sorted);
        f_sorted = s[0] == &r && s[2] == |r && s[1] == ((r[0] && r[1]) || (r[0] && r[2]) || (r[1] && r[2]));
    end
endfunction
function [3:0] f_count(input [3*F_COLUMN-1:0] window);
    reg [8:0] r;
    begin
        r = {f_reach(window[2*F_COLUMN+:F_COLUMN]), f_reach(window[F_COLUMN+:F_COLUMN]), f_reach(window[0+:F_COLUMN])};
        f_count = r[0] + r[1] + r[2] + r[3] + r[4] + r[5] + r[6] + r[7] + r[8];
    end
endfunction
// The words in the registers, which are sorted at one edge with f_newest.
generate
    for (f_lane = 0; f_lane < LANES; f_lane = f_lane + 1) begin : g_f_held
        always @* begin
            if (f_words >= 2'd1)
                assert(f_sorted(newest_q[f_lane*F_COLUMN+:F_COLUMN], f_newest[f_lane*F_COLUMN+:F_COLUMN]));
            if (f_words >= 2'd2)
                assert(f_sorted(center_q[f_lane*F_COLUMN+:F_COLUMN], f_center[f_lane*F_COLUMN+:F_COLUMN]));
        end
    end
endgenerate
always @* begin
    if (f_words >= 2'd2) assert({merge_left_q, merge_right_q} == {f_no_left, f_no_right});
    if (f_known) begin
        assert(f_sorted(left_q, f_before));
        if (f_no_left) assert(last_q == 3'b110);
        else assert(last_q == {
            left_q[2*WIDTH+:WIDTH] > center_q[2*WIDTH+:WIDTH], left_q[WIDTH+:WIDTH] > center_q[WIDTH+:WIDTH],
            left_q[0+:WIDTH] > center_q[0+:WIDTH]
        });
    end
end
generate
    for (f_lane = 0; f_lane < LANES; f_lane = f_lane + 1) begin : g_f_median
        wire expected;
        word_delay #(.WIDTH(1), .DEPTH(2 + 2 * DEEP)) f_expected (
            .clk_i(clk_i), .data_i(f_count(f_window(f_lane)) >= 4'd5), .data_o(expected)
        );
        always @* if (f_age >= 2 + 2 * DEEP) assert((median_o[f_lane*WIDTH+:WIDTH] >= f_threshold) == expected);
    end
endgenerate
