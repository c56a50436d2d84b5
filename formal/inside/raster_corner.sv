// SPDX-License-Identifier: MIT OR Apache-2.0
// FAST 5/8 by its definition, for every window, border and level.
localparam F_LATE = 0;
`include "words.vh"
(* anyconst *) wire [WIDTH-1:0] f_level;
always @* assume(level_i == f_level);
function f_corner(input [3*F_COLUMN-1:0] window);
    reg [8*WIDTH-1:0] ring;  // the ring around the center: up on the left, along the top, down, and back
    reg [WIDTH:0] neighbor, center;
    reg all_brighter, all_darker;
    integer first, k;
    begin
        ring = {
            window[5*WIDTH+:WIDTH], window[8*WIDTH+:WIDTH], window[7*WIDTH+:WIDTH], window[6*WIDTH+:WIDTH],
            window[3*WIDTH+:WIDTH], window[0+:WIDTH], window[WIDTH+:WIDTH], window[2*WIDTH+:WIDTH]
        };
        center = {1'b0, window[4*WIDTH+:WIDTH]};
        f_corner = 1'b0;
        for (first = 0; first < 8; first = first + 1) begin
            all_brighter = 1'b1;
            all_darker = 1'b1;
            for (k = 0; k < 5; k = k + 1) begin
                neighbor = {1'b0, ring[((first+k)%8)*WIDTH+:WIDTH]};
                if (!(neighbor > center + {1'b0, f_level})) all_brighter = 1'b0;
                if (!(neighbor + {1'b0, f_level} < center)) all_darker = 1'b0;
            end
            if (all_brighter || all_darker) f_corner = 1'b1;
        end
    end
endfunction
generate
    for (f_lane = 0; f_lane < LANES; f_lane = f_lane + 1) begin : g_f_held
        wire [WIDTH:0] newest = {1'b0, f_newest[f_lane*F_COLUMN+WIDTH+:WIDTH]};
        wire [WIDTH:0] center = {1'b0, f_center[f_lane*F_COLUMN+WIDTH+:WIDTH]};
        always @* begin
            if (f_words >= 2'd1) begin
                assert(newest_q[f_lane*F_COLUMN+:F_COLUMN] == f_newest[f_lane*F_COLUMN+:F_COLUMN]);
                assert(newest_high_q[f_lane*BOUND+:BOUND] == newest + {1'b0, f_level});
                assert(newest_low_q[f_lane*BOUND+:BOUND] == newest - {1'b0, f_level});
            end
            if (f_words >= 2'd2) begin
                assert(center_q[f_lane*F_COLUMN+:F_COLUMN] == f_center[f_lane*F_COLUMN+:F_COLUMN]);
                assert(high_q[f_lane*BOUND+:BOUND] == center + {1'b0, f_level});
                assert(low_q[f_lane*BOUND+:BOUND] == center - {1'b0, f_level});
            end
        end
    end
endgenerate
always @* begin
    if (f_words >= 2'd2) assert({no_left_q, no_right_q} == {f_no_left, f_no_right});
    if (f_known) assert(left_q == f_before);
end
generate
    for (f_lane = 0; f_lane < LANES; f_lane = f_lane + 1) begin : g_f_hit
        wire expected;
        word_delay #(.WIDTH(1), .DEPTH(3 + DEEP)) f_expected (
            .clk_i(clk_i), .data_i(f_corner(f_window(f_lane))), .data_o(expected)
        );
        always @* if (f_age >= 3 + DEEP) assert(hit_o[f_lane] == expected);
    end
endgenerate
