// SPDX-License-Identifier: MIT OR Apache-2.0
// A whole unit of an isolated design is compared with the contract: frames wait in a queue from their last pixel until they are
// decided, and then every score, the decision and the pixels that leave must be those of the contract.
`include "reset.vh"
localparam F_N = `N;
localparam F_P = `P;
localparam F_PIXELS = F_N * F_N;
localparam F_FRAME = F_PIXELS * F_P;
localparam [31:0] F_MAX = (1 << F_P) - 1;

// Thresholds are constant.
reg [63:0] f_thresholds;
wire [63:0] f_thresholds_now = {
`ifdef HAS_EDGE_LEVEL_I
    edge_level_i, edge_min_i,
`endif
`ifdef HAS_CORNER_LEVEL_I
    corner_level_i, corner_min_i,
`endif
`ifdef HAS_MAD_MIN_I
    mad_min_i,
`endif
`ifdef HAS_VARIANCE_MIN_I
    variance_min_i,
`endif
`ifdef HAS_RANGE_MIN_I
    range_min_i,
`endif
`ifdef HAS_SURFACE_MIN_I
    surface_min_i,
`endif
`ifdef HAS_SEGMENT_LEVEL_I
    segment_level_i, segment_min_i,
`endif
    temporal_level_i, temporal_min_i
};
always @(posedge clk_i) f_thresholds <= f_thresholds_now;
always @* if (started) assume(f_thresholds == f_thresholds_now);

// Frames that were taken and are not decided; entry 0 is the oldest.
reg [F_FRAME-1:0] f_taking, f_queue0, f_queue1, f_queue2, f_queue3;
reg [7:0] f_place;
reg [2:0] f_waiting;
reg [1:0] f_decided;  // number of decisions since reset, up to 2
wire [F_FRAME-1:0] f_taken = (f_taking & ~({{(F_FRAME-F_P){1'b0}}, {F_P{1'b1}}} << (f_place * F_P)))
    | ({{(F_FRAME-F_P){1'b0}}, pixel_i} << (f_place * F_P));
wire f_whole = valid_i && f_place == F_PIXELS - 1;
always @(posedge clk_i) begin
    if (rst_i) begin
        f_place   <= 0;
        f_waiting <= 0;
        f_decided <= 0;
    end else begin
        if (valid_i) begin
            f_taking <= f_taken;
            f_place  <= f_whole ? 0 : f_place + 1;
        end
        f_waiting <= f_waiting + f_whole - decision_valid_o;
        if (decision_valid_o) begin
            f_queue0 <= f_queue1;
            f_queue1 <= f_queue2;
            f_queue2 <= f_queue3;
            if (f_decided != 2) f_decided <= f_decided + 1;
        end
        if (f_whole) case (f_waiting - decision_valid_o)
            0: f_queue0 <= f_taken;
            1: f_queue1 <= f_taken;
            2: f_queue2 <= f_taken;
            default: f_queue3 <= f_taken;
        endcase
    end
end

// The decided frame, by the contract.
function [F_P-1:0] f_at(input [F_FRAME-1:0] frame, input integer row, input integer column);
    integer y, x;
    begin
        y = row < 0 ? 0 : row >= F_N ? F_N - 1 : row;
        x = column < 0 ? 0 : column >= F_N ? F_N - 1 : column;
        f_at = frame[(y*F_N+x)*F_P+:F_P];
    end
endfunction
reg [F_FRAME-1:0] f_frame;
reg [9*F_P-1:0] f_around;
reg [3:0] f_smaller, f_not_larger;
reg f_stays;  // the center is no extreme of its window
integer f_y, f_x, f_k, f_l, f_weighted;
always @* begin
    f_frame = f_queue0;
`ifndef FILTER_NONE
    for (f_y = 0; f_y < F_N; f_y = f_y + 1) for (f_x = 0; f_x < F_N; f_x = f_x + 1) begin
        for (f_k = 0; f_k < 9; f_k = f_k + 1)
            f_around[f_k*F_P+:F_P] = f_at(f_queue0, f_y + f_k / 3 - 1, f_x + f_k % 3 - 1);
`ifdef FILTER_BINOMIAL3X3
        f_weighted = 8;
        for (f_k = 0; f_k < 9; f_k = f_k + 1)
            f_weighted = f_weighted + f_around[f_k*F_P+:F_P] * (f_k % 2 ? 2 : f_k == 4 ? 4 : 1);
        f_frame[(f_y*F_N+f_x)*F_P+:F_P] = f_weighted / 16;
`else
        for (f_k = 0; f_k < 9; f_k = f_k + 1) begin
            f_smaller = 0;
            f_not_larger = 0;
            for (f_l = 0; f_l < 9; f_l = f_l + 1) begin
                f_smaller = f_smaller + (f_around[f_l*F_P+:F_P] < f_around[f_k*F_P+:F_P]);
                f_not_larger = f_not_larger + (f_around[f_l*F_P+:F_P] <= f_around[f_k*F_P+:F_P]);
            end
            if (f_smaller <= 4 && f_not_larger >= 5) f_frame[(f_y*F_N+f_x)*F_P+:F_P] = f_around[f_k*F_P+:F_P];
            if (f_k == 4) f_stays = f_smaller != 0 && f_not_larger != 9;
        end
`ifdef FILTER_SWITCHING3X3
        if (f_stays) f_frame[(f_y*F_N+f_x)*F_P+:F_P] = f_around[4*F_P+:F_P];
`endif
`endif
    end
`endif
end

integer f_row, f_column, f_gx, f_gy, f_start, f_run, f_c, f_pixel, f_mean;
integer f_edges, f_corners, f_sum, f_squares, f_deviation, f_low, f_high, f_changes;
integer f_right, f_down, f_down_right, f_down_left, f_surface, f_above, f_below, f_segment;
function integer f_distance(input integer a, input integer b);
    f_distance = a > b ? a - b : b - a;
endfunction
function integer f_lesser(input integer a, input integer b);
    f_lesser = a < b ? a : b;
endfunction
reg f_brighter, f_darker, f_hit;
reg [8*F_P-1:0] f_ring;
reg [F_FRAME-1:0] f_reference;
reg f_referenced;
always @* begin
    f_edges = 0;
    f_corners = 0;
    f_sum = 0;
    f_squares = 0;
    f_low = F_MAX;
    f_high = 0;
    f_changes = 0;
    f_right = 0;
    f_down = 0;
    f_down_right = 0;
    f_down_left = 0;
    for (f_row = 0; f_row < F_N; f_row = f_row + 1) for (f_column = 0; f_column < F_N; f_column = f_column + 1) begin
        f_c = f_at(f_frame, f_row, f_column);
        f_sum = f_sum + f_c;
        f_squares = f_squares + f_c * f_c;
        if (f_c < f_low) f_low = f_c;
        if (f_c > f_high) f_high = f_c;
        f_ring = {
            f_at(f_frame, f_row - 1, f_column - 1), f_at(f_frame, f_row - 1, f_column), f_at(f_frame, f_row - 1, f_column + 1),
            f_at(f_frame, f_row, f_column + 1), f_at(f_frame, f_row + 1, f_column + 1), f_at(f_frame, f_row + 1, f_column),
            f_at(f_frame, f_row + 1, f_column - 1), f_at(f_frame, f_row, f_column - 1)
        };
`ifdef HAS_EDGE_LEVEL_I
        f_gx = f_at(f_frame, f_row - 1, f_column + 1) + 2 * f_at(f_frame, f_row, f_column + 1) + f_at(f_frame, f_row + 1, f_column + 1)
             - f_at(f_frame, f_row - 1, f_column - 1) - 2 * f_at(f_frame, f_row, f_column - 1) - f_at(f_frame, f_row + 1, f_column - 1);
        f_gy = f_at(f_frame, f_row + 1, f_column - 1) + 2 * f_at(f_frame, f_row + 1, f_column) + f_at(f_frame, f_row + 1, f_column + 1)
             - f_at(f_frame, f_row - 1, f_column - 1) - 2 * f_at(f_frame, f_row - 1, f_column) - f_at(f_frame, f_row - 1, f_column + 1);
        if ((f_gx < 0 ? -f_gx : f_gx) + (f_gy < 0 ? -f_gy : f_gy) > edge_level_i) f_edges = f_edges + 1;
`endif
`ifdef HAS_CORNER_LEVEL_I
        f_hit = 0;
        for (f_start = 0; f_start < 8; f_start = f_start + 1) begin
            f_brighter = 1;
            f_darker = 1;
            for (f_run = 0; f_run < 5; f_run = f_run + 1) begin
                f_pixel = f_ring[((f_start+f_run)%8)*F_P+:F_P];
                if (!(f_pixel > f_c + corner_level_i)) f_brighter = 0;
                if (!(f_pixel + corner_level_i < f_c)) f_darker = 0;
            end
            if (f_brighter || f_darker) f_hit = 1;
        end
        if (f_hit) f_corners = f_corners + 1;
`endif
`ifdef HAS_SURFACE_MIN_I
        f_right      = f_right + f_distance(f_c, f_at(f_frame, f_row, f_column + 1));
        f_down       = f_down + f_distance(f_c, f_at(f_frame, f_row + 1, f_column));
        f_down_right = f_down_right + f_distance(f_c, f_at(f_frame, f_row + 1, f_column + 1));
        f_down_left  = f_down_left + f_distance(f_c, f_at(f_frame, f_row + 1, f_column - 1));
`endif
        f_pixel = f_at(f_reference, f_row, f_column);
        if (!f_referenced || (f_c > f_pixel ? f_c - f_pixel : f_pixel - f_c) > temporal_level_i) f_changes = f_changes + 1;
    end
    f_surface = f_lesser(f_lesser(f_right, f_down), f_lesser(f_down_right, f_down_left));
`ifdef U_MEAN_FRACTION
    f_mean = ((f_sum << `U_MEAN_FRACTION) + F_PIXELS / 2) / F_PIXELS;
    f_deviation = 0;
    f_above = 0;
    f_below = 0;
    for (f_row = 0; f_row < F_PIXELS; f_row = f_row + 1) begin
        f_pixel = f_frame[f_row*F_P+:F_P] << `U_MEAN_FRACTION;
        f_deviation = f_deviation + f_distance(f_pixel, f_mean);
`ifdef HAS_SEGMENT_LEVEL_I
        if (f_pixel > f_mean + (segment_level_i << `U_MEAN_FRACTION)) f_above = f_above + 1;
        if (f_pixel + (segment_level_i << `U_MEAN_FRACTION) < f_mean) f_below = f_below + 1;
`endif
    end
    f_segment = f_lesser(f_above, f_below);
`endif
end
wire [6:0] f_votes_any = {
`ifdef HAS_EDGE_LEVEL_I
    f_edges >= edge_min_i,
`else
    1'b0,
`endif
`ifdef HAS_CORNER_LEVEL_I
    f_corners >= corner_min_i,
`else
    1'b0,
`endif
`ifdef HAS_MAD_MIN_I
    f_deviation >= mad_min_i,
`else
    1'b0,
`endif
`ifdef HAS_VARIANCE_MIN_I
    F_PIXELS * f_squares - f_sum * f_sum >= variance_min_i,
`else
    1'b0,
`endif
`ifdef HAS_RANGE_MIN_I
    f_high - f_low >= range_min_i,
`else
    1'b0,
`endif
`ifdef HAS_SURFACE_MIN_I
    f_surface >= surface_min_i,
`else
    1'b0,
`endif
`ifdef HAS_SEGMENT_LEVEL_I
    f_segment >= segment_min_i
`else
    1'b0
`endif
};
wire [6:0] f_voters = {
`ifdef HAS_EDGE_LEVEL_I
    1'b1,
`else
    1'b0,
`endif
`ifdef HAS_CORNER_LEVEL_I
    1'b1,
`else
    1'b0,
`endif
`ifdef HAS_MAD_MIN_I
    1'b1,
`else
    1'b0,
`endif
`ifdef HAS_VARIANCE_MIN_I
    1'b1,
`else
    1'b0,
`endif
`ifdef HAS_RANGE_MIN_I
    1'b1,
`else
    1'b0,
`endif
`ifdef HAS_SURFACE_MIN_I
    1'b1,
`else
    1'b0,
`endif
`ifdef HAS_SEGMENT_LEVEL_I
    1'b1
`else
    1'b0
`endif
};
`ifdef COMBINE_ALL
wire f_srs = f_votes_any == f_voters;
`else
wire f_srs = |f_votes_any;
`endif
wire f_trs = f_changes >= temporal_min_i;
always @(posedge clk_i) begin
    if (rst_i) f_referenced <= 0;
    else if (decision_valid_o) begin
`ifdef REFERENCE_PREVIOUS
        f_reference  <= f_frame;
        f_referenced <= 1;
`else
        if (f_srs && f_trs) begin
            f_reference  <= f_frame;
            f_referenced <= 1;
        end
`ifdef IRRELEVANT_ZERO
        else if (!f_srs) f_referenced <= 0;
`endif
`endif
    end
end

// The output: the pixels of the active frame decided last, in order.
reg [F_FRAME-1:0] f_leaving;
reg f_active;
reg [7:0] f_left;  // number of pixels of the frame decided last that have left
wire f_active_now = decision_valid_o ? f_srs && f_trs : f_active;
always @(posedge clk_i) begin
    if (rst_i) begin
        f_active <= 0;
        f_left   <= 0;
    end else begin
        f_active <= f_active_now;
        if (decision_valid_o) f_leaving <= f_frame;
        f_left <= decision_valid_o ? tail_step : f_left + tail_step;
    end
end
reg f_leaves;
reg [F_P-1:0] f_leaving_pixel;
always @(posedge clk_i) begin
    f_leaves <= !rst_i && tail_step && f_active_now;
    f_leaving_pixel <= decision_valid_o ? f_at(f_frame, 0, 0) : f_leaving[f_left*F_P+:F_P];
end

reg [7:0] f_steps;  // number of tail steps of the frame
`ifdef PIPELINING_DEEP
wire f_tail_step = count_step;
`else
wire f_tail_step = tail_step;
`endif
always @(posedge clk_i) begin
    if (rst_i) f_steps <= 0;
    else if (f_tail_step) f_steps <= f_steps == F_PIXELS - 1 ? 0 : f_steps + 1;
end
reg f_second_last;
always @(posedge clk_i) f_second_last <= !rst_i && f_tail_step && f_steps == F_PIXELS - 1;

// Pixels leave at every step after an active decision, and at no other time.
reg f_told, f_forwards;
wire f_told_now = decision_valid_o ? active_o : f_told;
always @(posedge clk_i) begin
    f_told     <= !rst_i && f_told_now;
    f_forwards <= !rst_i && f_tail_step && f_told_now;
end

// Properties that are proven without a bound.
always @* if (started) begin
    assert(f_steps < F_PIXELS);
    if (tail_step) assert(tail_address < F_PIXELS);  // no word outside of the region is written
    assert(done == f_second_last);                // so there are n steps between two decisions
    if (decision_valid_o) assert(done);
    assert(temporal_count_o <= F_PIXELS);
    assert(active_o == (srs_o && trs_o));
    if (!decision_valid_o) assert(!srs_o && !trs_o);
    if (!forward_valid_o) assert(forward_pixel_o == 0);
    assert(forward_valid_o == f_forwards);
    assert(trs_o == (decision_valid_o && temporal_count_o >= temporal_min_i));
    if (decision_valid_o && f_decided == 0) begin
        assert(temporal_count_o == F_PIXELS);     // the first frame since reset has no reference
        if (temporal_min_i <= F_PIXELS) assert(trs_o);
    end
`ifdef HAS_EDGE_LEVEL_I
    assert(edge_score_o <= F_PIXELS);
`endif
`ifdef HAS_CORNER_LEVEL_I
    assert(corner_score_o <= F_PIXELS);
`endif
`ifdef EXACT
    assert(f_waiting <= 4);
    if (decision_valid_o) begin
        assert(f_waiting != 0);
        assert(srs_o == f_srs);
        assert(trs_o == f_trs);
        assert(temporal_count_o == f_changes);
`ifdef HAS_EDGE_LEVEL_I
        assert(edge_score_o == f_edges);
`endif
`ifdef HAS_CORNER_LEVEL_I
        assert(corner_score_o == f_corners);
`endif
`ifdef HAS_MAD_MIN_I
        assert(mad_score_o == f_deviation);
`endif
`ifdef HAS_VARIANCE_MIN_I
        assert(variance_score_o == F_PIXELS * f_squares - f_sum * f_sum);
`endif
`ifdef HAS_RANGE_MIN_I
        assert(range_score_o == f_high - f_low);
`endif
`ifdef HAS_SURFACE_MIN_I
        assert(surface_score_o == f_surface);
`endif
`ifdef HAS_SEGMENT_LEVEL_I
        assert(segment_score_o == f_segment);
`endif
    end
    assert(forward_valid_o == f_leaves);
    if (f_leaves) assert(forward_pixel_o == f_leaving_pixel);
`endif
end
