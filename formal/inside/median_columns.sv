// SPDX-License-Identifier: MIT OR Apache-2.0
// The result is the fifth of the nine sorted pixels: for every threshold, it reaches the threshold if and only if at least five of
// the nine pixels do. With SWITCHING a center that is no extreme of its window is the result.
localparam F_LATE = DEEP;
`include "words.vh"
(* anyconst *) wire [WIDTH-1:0] f_threshold;
// The pixels of a column that reach the threshold.
function [2:0] f_reach(input [F_COLUMN-1:0] column);
    f_reach = {column[2*WIDTH+:WIDTH] >= f_threshold, column[WIDTH+:WIDTH] >= f_threshold, column[0+:WIDTH] >= f_threshold};
endfunction
function [WIDTH-1:0] f_larger(input [WIDTH-1:0] a, input [WIDTH-1:0] b);
    f_larger = a > b ? a : b;
endfunction
function [WIDTH-1:0] f_smaller(input [WIDTH-1:0] a, input [WIDTH-1:0] b);
    f_smaller = a < b ? a : b;
endfunction
// Tests that {high, mid, low} is the sorted column. SWITCHING compares pixels of sorted columns with each other, so for its induction
// the high and the low ones are those of the column at every threshold.
function f_sorted(input [F_COLUMN-1:0] sorted, input [F_COLUMN-1:0] column);
    reg [2:0] r, s;
    begin
        r = f_reach(column);
        s = f_reach(sorted);
        f_sorted = s[0] == &r && s[2] == |r && s[1] == ((r[0] && r[1]) || (r[0] && r[2]) || (r[1] && r[2]));
        if (SWITCHING) f_sorted = f_sorted
            && sorted[2*WIDTH+:WIDTH] == f_larger(f_larger(column[0+:WIDTH], column[WIDTH+:WIDTH]), column[2*WIDTH+:WIDTH])
            && sorted[0+:WIDTH] == f_smaller(f_smaller(column[0+:WIDTH], column[WIDTH+:WIDTH]), column[2*WIDTH+:WIDTH]);
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
// Tests that the center is the largest or the smallest pixel of its window.
function f_extreme(input [3*F_COLUMN-1:0] window);
    reg [WIDTH-1:0] center, pixel;
    reg largest, smallest;
    integer k;
    begin
        center = window[4*WIDTH+:WIDTH];
        largest = 1'b1;
        smallest = 1'b1;
        for (k = 0; k < 9; k = k + 1) begin
            pixel = window[k*WIDTH+:WIDTH];
            if (pixel > center) largest = 1'b0;
            if (pixel < center) smallest = 1'b0;
        end
        f_extreme = largest || smallest;
    end
endfunction
function f_result(input [3*F_COLUMN-1:0] window);
    f_result = SWITCHING && !f_extreme(window) ? window[4*WIDTH+:WIDTH] >= f_threshold : f_count(window) >= 4'd5;
endfunction
generate
    if (SWITCHING) begin : g_f_switching
        // The middle pixel of a column, and two bits that say if it is the largest and if it is the smallest of the three.
        function [WIDTH+1:0] f_own(input [F_COLUMN-1:0] column);
            f_own = {
                column[WIDTH+:WIDTH] >= column[0+:WIDTH] && column[WIDTH+:WIDTH] >= column[2*WIDTH+:WIDTH],
                column[WIDTH+:WIDTH] <= column[0+:WIDTH] && column[WIDTH+:WIDTH] <= column[2*WIDTH+:WIDTH],
                column[WIDTH+:WIDTH]
            };
        endfunction
        for (f_lane = 0; f_lane < LANES; f_lane = f_lane + 1) begin : g_f_own
            always @* begin
                if (f_words >= 2'd1)
                    assert(g_switching.newest_own_q[f_lane*(WIDTH+2)+:WIDTH+2] == f_own(f_newest[f_lane*F_COLUMN+:F_COLUMN]));
                if (f_words >= 2'd2)
                    assert(g_switching.center_own_q[f_lane*(WIDTH+2)+:WIDTH+2] == f_own(f_center[f_lane*F_COLUMN+:F_COLUMN]));
            end
        end
    end
    for (f_lane = 0; f_lane < LANES; f_lane = f_lane + 1) begin : g_f_median
        wire expected;
        word_delay #(.WIDTH(1), .DEPTH(2 + 2 * DEEP)) f_expected (
            .clk_i(clk_i), .data_i(f_result(f_window(f_lane))), .data_o(expected)
        );
        always @* if (f_age >= 2 + 2 * DEEP) assert((median_o[f_lane*WIDTH+:WIDTH] >= f_threshold) == expected);
    end
endgenerate
