// SPDX-License-Identifier: MIT OR Apache-2.0
// Four sums of distances in words that are wide enough for any frame, and the smallest of them when the frame is done. The score
// stands until that of the next frame.
localparam F_PIXELS = `N * `N;
localparam [63:0] F_MAX = (64'd1 << WIDTH) - 64'd1;
wire [WIDTH-1:0] upper_i = {WIDTH{1'b0}};  // this feature does not see the upper row
`include "columns.vh"
wire [F_COLUMN-1:0] f_left = f_newest_first ? f_newest : f_before;
wire [F_COLUMN-1:0] f_right = right_i ? f_newest : f_incoming;
wire [WIDTH-1:0] f_center = f_newest[WIDTH+:WIDTH];
function [63:0] f_distance(input [WIDTH-1:0] a, input [WIDTH-1:0] b);
    f_distance = a > b ? a - b : b - a;
endfunction
wire [255:0] f_distances = {
    f_distance(f_center, f_left[2*WIDTH+:WIDTH]), f_distance(f_center, f_right[2*WIDTH+:WIDTH]),
    f_distance(f_center, f_newest[2*WIDTH+:WIDTH]), f_distance(f_center, f_right[WIDTH+:WIDTH])
};
wire f_known = f_columns >= 2'd2 || (f_columns == 2'd1 && f_newest_first);
// The step and its distances, when they are added.
wire [255:0] f_added;
wire f_step, f_last;
reg f_reset_seen = 1'b0;
generate
    if (DEEP) begin : g_f_deep
        reg [255:0] f_distances_q;
        reg f_step_q, f_last_q;
        always @(posedge clk_i) begin
            f_distances_q <= f_distances;
            f_step_q <= step_i && !rst_i;
            f_last_q <= last_i;
        end
        assign {f_added, f_step, f_last} = {f_distances_q, f_step_q, f_last_q};
        always @* if (f_reset_seen) assert({sum_step, sum_last} == {f_step, f_last});
        genvar f_place;
        for (f_place = 0; f_place < 4; f_place = f_place + 1) begin : g_f_place
            wire signed [WIDTH:0] f_difference = g_neighbor[f_place].added;
            wire signed [64:0] f_wide = f_difference;
            always @* if (f_reset_seen && f_step)
                assert(f_distances_q[64*f_place+:64] == (f_wide < 0 ? -f_wide : f_wide));
        end
    end else begin : g_f_plain
        assign {f_added, f_step, f_last} = {f_distances, step_i, last_i};
    end
endgenerate
reg [63:0] f_sum0, f_sum1, f_sum2, f_sum3, f_least, f_expected;
reg [15:0] f_seen;  // number of steps of the frame
reg f_done;
wire [63:0] f_next0 = f_sum0 + f_added[0+:64];
wire [63:0] f_next1 = f_sum1 + f_added[64+:64];
wire [63:0] f_next2 = f_sum2 + f_added[128+:64];
wire [63:0] f_next3 = f_sum3 + f_added[192+:64];
wire [63:0] f_least01 = f_next0 < f_next1 ? f_next0 : f_next1;
wire [63:0] f_least23 = f_next2 < f_next3 ? f_next2 : f_next3;
always @(posedge clk_i) begin
    if (rst_i) f_reset_seen <= 1'b1;
    if (f_step) begin
        f_sum0 <= f_last ? 0 : f_next0;
        f_sum1 <= f_last ? 0 : f_next1;
        f_sum2 <= f_last ? 0 : f_next2;
        f_sum3 <= f_last ? 0 : f_next3;
        f_seen <= f_last ? 0 : f_seen + 1;
    end
    f_done  <= f_step && f_last;
    f_least <= f_least01 < f_least23 ? f_least01 : f_least23;
    if (f_done) f_expected <= f_least;
    if (rst_i) begin
        {f_sum0, f_sum1, f_sum2, f_sum3} <= 0;
        f_seen <= 0;
        f_done <= 0;
        f_expected <= 0;
    end
end
always @* begin
    // A window steps when it has all its columns, and a frame has at most PIXELS steps.
    if (step_i) assume(f_known);
    if (f_seen == F_PIXELS - 1 && f_step) assume(f_last);
    if (f_columns != 2'd0) begin
        assert(center_q == f_newest[WIDTH+:WIDTH]);
        assert(below_q == f_newest[2*WIDTH+:WIDTH]);
    end
    if (f_known) assert(left_below_q == f_left[2*WIDTH+:WIDTH]);
    if (f_reset_seen) begin
        assert(f_seen < F_PIXELS);
        assert(done_q == f_done);
        assert(f_sum0 <= f_seen * F_MAX && g_neighbor[0].sum_q == f_sum0);
        assert(f_sum1 <= f_seen * F_MAX && g_neighbor[1].sum_q == f_sum1);
        assert(f_sum2 <= f_seen * F_MAX && g_neighbor[2].sum_q == f_sum2);
        assert(f_sum3 <= f_seen * F_MAX && g_neighbor[3].sum_q == f_sum3);
        if (f_done) assert((straight_q < diagonal_q ? straight_q : diagonal_q) == f_least);
        assert(score_o == f_expected);
    end
end
