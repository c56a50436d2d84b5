// SPDX-License-Identifier: MIT OR Apache-2.0
// FAST 5/8 by its definition, for every window and level.
`include "columns.vh"
wire [F_COLUMN-1:0] f_left = f_newest_first ? f_newest : f_before;
wire [F_COLUMN-1:0] f_right = right_i ? f_newest : f_incoming;
wire f_left_known = f_columns >= 2'd2 || (f_columns == 2'd1 && f_newest_first);
// The ring around the center: the left column upwards, then right along the top, down, and back. The registers are these columns,
// which is asserted below.
wire [8*WIDTH-1:0] f_ring = {
    center_q[2*WIDTH+:WIDTH], right[2*WIDTH+:WIDTH], right[WIDTH+:WIDTH], right[0+:WIDTH],
    center_q[0+:WIDTH], left_q[0+:WIDTH], left_q[WIDTH+:WIDTH], left_q[2*WIDTH+:WIDTH]
};
wire [WIDTH:0] f_center = {1'b0, center_q[WIDTH+:WIDTH]};
wire [WIDTH:0] f_level = {1'b0, level_i};
// The proof has two steps, each of which the solver decides at once: the comparisons, neighbor by neighbor, and the runs of their
// results. The ring of the module begins two neighbors later.
wire [7:0] f_brighter = {brighter[5:0], brighter[7:6]};
wire [7:0] f_darker = {darker[5:0], darker[7:6]};
reg f_corner, f_all_brighter, f_all_darker;
reg [WIDTH:0] f_neighbor;
integer f_start, f_k;
always @* begin
    for (f_k = 0; f_k < 8; f_k = f_k + 1) begin
        f_neighbor = {1'b0, f_ring[f_k*WIDTH+:WIDTH]};
        assert(f_brighter[f_k] == (f_neighbor > f_center + f_level));
        assert(f_darker[f_k] == (f_neighbor + f_level < f_center));
    end
    f_corner = 1'b0;
    for (f_start = 0; f_start < 8; f_start = f_start + 1) begin
        f_all_brighter = 1'b1;
        f_all_darker = 1'b1;
        for (f_k = 0; f_k < 5; f_k = f_k + 1) begin
            if (!f_brighter[(f_start+f_k)%8]) f_all_brighter = 1'b0;
            if (!f_darker[(f_start+f_k)%8]) f_all_darker = 1'b0;
        end
        if (f_all_brighter || f_all_darker) f_corner = 1'b1;
    end
end
always @* begin
    if (f_columns != 2'd0) begin
        assert(center_q == f_newest);
        assert(right == f_right);
    end
    if (f_left_known) assert(left_q == f_left);
    assert(hit_o == f_corner);
end
