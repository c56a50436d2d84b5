// SPDX-License-Identifier: MIT OR Apache-2.0
// The values are sums of absolute differences, for every window and border. The module does not use the pixels above.
localparam F_LATE = 0;
wire top_i = 1'b1;
wire [LANES*WIDTH-1:0] upper_i = {LANES * WIDTH{1'b0}};
`include "words.vh"
function [WIDTH-1:0] f_difference(input [WIDTH-1:0] one, input [WIDTH-1:0] other);
    f_difference = one < other ? other - one : one - other;
endfunction
// The neighbor of each way in a window of the columns left, center and right, whose pixels are numbered down the columns.
function [WIDTH-1:0] f_neighbor(input [3*F_COLUMN-1:0] window, input integer way);
    f_neighbor = window[(way == 0 ? 7 : way == 1 ? 5 : way == 2 ? 8 : 2)*WIDTH+:WIDTH];
endfunction
generate
    for (f_lane = 0; f_lane < LANES; f_lane = f_lane + 1) begin : g_f_held
        always @* begin
            if (f_words >= 2'd1)
                assert(newest_q[f_lane*COLUMN+:COLUMN] == f_newest[f_lane*F_COLUMN+WIDTH+:COLUMN]);
            if (f_words >= 2'd2)
                assert(center_q[f_lane*COLUMN+:COLUMN] == f_center[f_lane*F_COLUMN+WIDTH+:COLUMN]);
        end
    end
endgenerate
always @* begin
    if (f_words >= 2'd2) assert({no_left_q, no_right_q} == {f_no_left, f_no_right});
    if (f_known) assert(left_q == f_before[2*WIDTH+:WIDTH]);
end
genvar f_way;
generate
    for (f_way = 0; f_way < 4; f_way = f_way + 1) begin : g_f_way
        wire [VALUE_BITS*(LANES+1)-1:0] sums;  // over the lanes so far
        assign sums[VALUE_BITS-1:0] = {VALUE_BITS{1'b0}};
        for (f_lane = 0; f_lane < LANES; f_lane = f_lane + 1) begin : g_f_lane
            wire [3*F_COLUMN-1:0] window = f_window(f_lane);
            assign sums[(f_lane+1)*VALUE_BITS+:VALUE_BITS] = sums[f_lane*VALUE_BITS+:VALUE_BITS]
                + f_difference(window[4*WIDTH+:WIDTH], f_neighbor(window, f_way));
        end
        wire [VALUE_BITS-1:0] expected;
        word_delay #(.WIDTH(VALUE_BITS), .DEPTH(3 + DEEP)) f_expected (
            .clk_i(clk_i), .data_i(sums[LANES*VALUE_BITS+:VALUE_BITS]), .data_o(expected)
        );
        always @* if (f_age >= 3 + DEEP) assert(values_o[f_way*VALUE_BITS+:VALUE_BITS] == expected);
    end
endgenerate
