// SPDX-License-Identifier: MIT OR Apache-2.0
// Half of Gx + Gy or of Gx - Gy is above floor(level / 2), for every window, border and level. edge_rule proves that this is
// |Gx| + |Gy| > level.
localparam F_LATE = 0;
`include "words.vh"
(* anyconst *) wire [LEVEL_BITS-1:0] f_level;
always @* assume(level_i == f_level);
function [PAIR-1:0] f_upper(input [F_COLUMN-1:0] column);
    f_upper = {1'b0, column[0+:WIDTH]} + {1'b0, column[WIDTH+:WIDTH]};
endfunction
function [PAIR-1:0] f_lower(input [F_COLUMN-1:0] column);
    f_lower = {1'b0, column[2*WIDTH+:WIDTH]} + {1'b0, column[WIDTH+:WIDTH]};
endfunction
function f_hit(input [3*F_COLUMN-1:0] window);
    reg signed [WIDTH+3:0] half_sum, half_diff, half_level;
    begin
        half_sum = f_lower(window[F_COLUMN+:F_COLUMN]) + f_lower(window[2*F_COLUMN+:F_COLUMN])
            - f_upper(window[0+:F_COLUMN]) - f_upper(window[F_COLUMN+:F_COLUMN]);
        half_diff = f_upper(window[F_COLUMN+:F_COLUMN]) + f_upper(window[2*F_COLUMN+:F_COLUMN])
            - f_lower(window[0+:F_COLUMN]) - f_lower(window[F_COLUMN+:F_COLUMN]);
        half_level = $signed({1'b0, f_level >> 1});
        f_hit = half_sum > half_level || -half_sum > half_level || half_diff > half_level || -half_diff > half_level;
    end
endfunction

// The second edge, one clock later: the pixels of the pairs.
reg [LANES*F_COLUMN-1:0] f_center_2, f_newest_2;
reg f_no_left_2, f_no_right_2;
reg [1:0] f_words_2 = 2'd0;
reg f_stepped = 1'b0;
reg [LANES*3*F_COLUMN-1:0] f_windows_2;
wire [LANES*3*F_COLUMN-1:0] f_windows;
always @(posedge clk_i) begin
    f_stepped <= step_i && f_clocks == 2'd3;
    if (f_stepped) begin
        {f_center_2, f_newest_2, f_no_left_2, f_no_right_2} <= {f_center, f_newest, f_no_left, f_no_right};
        f_words_2 <= f_words;
        f_windows_2 <= f_windows;
    end
end
always @* begin
    if (f_clocks == 2'd3) assert(step_q == f_stepped || f_words == 2'd0);
    if (f_words >= 2'd2) assert({left_q, right_q} == {f_no_left, f_no_right});
    if (!f_stepped) begin
        assert(f_words_2 == f_words);
        if (f_words >= 2'd1) assert(f_newest_2 == f_newest);
        if (f_words >= 2'd2) assert({f_center_2, f_no_left_2, f_no_right_2} == {f_center, f_no_left, f_no_right});
        if (f_words >= 2'd2) assert(f_windows_2 == f_windows);
    end else begin
        assert(f_words == f_words_2 + 2'd1 || (f_words == 2'd3 && f_words_2 == 2'd3));
        if (f_words_2 >= 2'd1) assert(f_center == f_newest_2);
        if (f_words_2 >= 2'd2) assert(f_before == f_center_2[(LANES-1)*F_COLUMN+:F_COLUMN]);
        if (f_words_2 >= 2'd2) assert(f_no_left == f_no_right_2);
    end
    if (f_words_2 == 2'd3) begin
        assert(left_2q == f_no_left_2);
        if (f_no_left_2) assert({first_upper_2q, first_lower_2q} == {f_upper(f_center_2[F_COLUMN-1:0]), f_lower(f_center_2[F_COLUMN-1:0])});
        else begin
            assert(upper_2q[0+:FOUR] == f_upper(f_windows_2[0+:F_COLUMN]) + f_upper(f_windows_2[F_COLUMN+:F_COLUMN]));
            assert(lower_2q[0+:FOUR] == f_lower(f_windows_2[0+:F_COLUMN]) + f_lower(f_windows_2[F_COLUMN+:F_COLUMN]));
        end
    end
end
generate
    for (f_lane = 0; f_lane < LANES; f_lane = f_lane + 1) begin : g_f_held
        wire [F_COLUMN-1:0] newest = f_newest[f_lane*F_COLUMN+:F_COLUMN];
        wire [F_COLUMN-1:0] center = f_center[f_lane*F_COLUMN+:F_COLUMN];
        wire [3*F_COLUMN-1:0] window_2 = f_windows_2[f_lane*3*F_COLUMN+:3*F_COLUMN];
        wire [FOUR-1:0] upper = f_upper(window_2[F_COLUMN+:F_COLUMN]) + f_upper(window_2[2*F_COLUMN+:F_COLUMN]);
        wire [FOUR-1:0] lower = f_lower(window_2[F_COLUMN+:F_COLUMN]) + f_lower(window_2[2*F_COLUMN+:F_COLUMN]);
        assign f_windows[f_lane*3*F_COLUMN+:3*F_COLUMN] = f_window(f_lane);
        always @* begin
            if (f_words >= 2'd1) begin
                assert(newest_upper_q[f_lane*PAIR+:PAIR] == f_upper(newest));
                assert(newest_lower_q[f_lane*PAIR+:PAIR] == f_lower(newest));
            end
            if (f_words >= 2'd2) begin
                assert(center_upper_q[f_lane*PAIR+:PAIR] == f_upper(center));
                assert(center_lower_q[f_lane*PAIR+:PAIR] == f_lower(center));
            end
            if (f_words_2 >= 2'd2) begin
                assert(upper_2q[(f_lane+1)*FOUR+:FOUR] == upper);
                assert(lower_2q[(f_lane+1)*FOUR+:FOUR] == lower);
            end
        end
        wire expected;
        word_delay #(.WIDTH(1), .DEPTH(2 + DEEP)) f_expected (
            .clk_i(clk_i), .data_i(f_hit(window_2)), .data_o(expected)
        );
        always @* if (f_age >= 3 + DEEP) assert(hit_o[f_lane] == expected);
    end
endgenerate
