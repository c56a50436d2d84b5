// SPDX-License-Identifier: MIT OR Apache-2.0
// Computes the medians of 3x3 windows for every pixel of a word at once: the fifth of the nine sorted pixels. With SWITCHING a
// center that is neither the largest nor the smallest pixel of its window is the result instead. The result comes three clocks
// after its step, with DEEP six.
//
// Each column is sorted once, when it comes in. The median of nine is the median of three values: the largest of the three
// low pixels, the median of the three middle pixels, and the smallest of the three high pixels. Three parallel comparisons
// and one LUT per result bit sort three pixels. Neighboring columns are compared once, although two windows use the result.
// A window that lacks a column at the border selects no pixels: the results of the comparisons are set to those that the
// center's column would give there.
`default_nettype none

module median_columns #(
    parameter WIDTH = 8,      // bits of a pixel
    parameter LANES = 1,      // pixels of a word
    parameter SWITCHING = 0,  // 1: centers that are no extremes of their windows stay as they are
    parameter DEEP = 0        // 0: the result comes three clocks after its step; 1: six clocks
) (
    input  wire                   clk_i,     // clock, rising edge
    input  wire                   step_i,    // columns come in; the centers are the columns of the step before
    input  wire                   left_i,    // the first center has nothing on its left
    input  wire                   right_i,   // the last center has nothing on its right
    input  wire                   top_i,     // the incoming columns have nothing at the top: upper_i may hold any word
    input  wire                   bottom_i,  // the incoming columns have nothing at the bottom: lower_i may hold any word
    input  wire [LANES*WIDTH-1:0] upper_i,   // upper pixels of the incoming columns
    input  wire [LANES*WIDTH-1:0] middle_i,  // middle pixels of the incoming columns
    input  wire [LANES*WIDTH-1:0] lower_i,   // lower pixels of the incoming columns
    output reg  [LANES*WIDTH-1:0] median_o   // medians of the centers (SWITCHING: or the centers), one per pixel of the word
);

    // Limits: a value out of range stops elaboration at an instance of a module that does not exist.
    generate
        if (WIDTH < 1) begin : g_width WIDTH_must_be_1_or_more u_refused (); end
        if (LANES < 1) begin : g_lanes LANES_must_be_1_or_more u_refused (); end
    endgenerate

    // These functions return one of three sorted pixels a, b, c. The comparisons are a > b, b > c and a > c.
    function [WIDTH-1:0] low_of(
        input ab, input bc, input ac, input [WIDTH-1:0] a, input [WIDTH-1:0] b, input [WIDTH-1:0] c
    );
        low_of = ab ? (bc ? c : b) : (ac ? c : a);
    endfunction

    function [WIDTH-1:0] mid_of(
        input ab, input bc, input ac, input [WIDTH-1:0] a, input [WIDTH-1:0] b, input [WIDTH-1:0] c
    );
        mid_of = ab ? (bc ? b : (ac ? c : a)) : (ac ? a : (bc ? c : b));
    endfunction

    function [WIDTH-1:0] high_of(
        input ab, input bc, input ac, input [WIDTH-1:0] a, input [WIDTH-1:0] b, input [WIDTH-1:0] c
    );
        high_of = ab ? (ac ? a : c) : (bc ? b : c);
    endfunction

    // Selects one of three pixels. A choice of 0 is a, 1 is b, 2 or 3 is c.
    function [WIDTH-1:0] chosen(
        input [1:0] choice, input [WIDTH-1:0] a, input [WIDTH-1:0] b, input [WIDTH-1:0] c
    );
        chosen = choice[1] ? c : choice[0] ? b : a;
    endfunction

    localparam COLUMN = 3 * WIDTH;

    // Sorted columns {high, mid, low}: the newest word, the centers, and the column on their left.
    reg  [LANES*COLUMN-1:0] newest_q;
    reg  [LANES*COLUMN-1:0] center_q;
    reg  [      COLUMN-1:0] left_q;
    reg  merge_left_q;   // the first center has nothing on its left
    reg  merge_right_q;  // the last center has nothing on its right
    wire sort_step, sort_left, sort_right;
    genvar lane, level;

    word_delay #(.WIDTH(3), .DEPTH(DEEP)) u_sort (
        .clk_i(clk_i), .data_i({step_i, left_i, right_i}), .data_o({sort_step, sort_left, sort_right})
    );

    generate
        for (lane = 0; lane < LANES; lane = lane + 1) begin : g_sort
            wire [WIDTH-1:0] a = upper_i[lane*WIDTH+:WIDTH];
            wire [WIDTH-1:0] b = middle_i[lane*WIDTH+:WIDTH];
            wire [WIDTH-1:0] c = lower_i[lane*WIDTH+:WIDTH];
            wire ab = a > b;
            wire bc = b > c;
            wire [COLUMN-1:0] sorted;  // {high, mid, low}
            if (DEEP) begin : g_deep
                // Without a row at the top, `a` is not chosen; without a row at the bottom, `c` is not chosen. In both cases `b` is
                // the middle pixel.
                reg [WIDTH-1:0] a_q, b_q, c_q;
                reg ab_q, bc_q, ac_q, top_q, bottom_q;
                always @(posedge clk_i) begin
                    {a_q, b_q, c_q} <= {a, b, c};
                    {ab_q, bc_q, ac_q} <= {ab, bc, a > c};
                    {top_q, bottom_q} <= {top_i, bottom_i};
                end
                wire [1:0] low = {!bottom_q && (top_q || ab_q ? bc_q : ac_q), top_q || ab_q};
                wire [1:0] mid = {!top_q && !bottom_q && ab_q != bc_q && ab_q == ac_q, top_q || bottom_q || ab_q == bc_q};
                wire [1:0] high = {!bottom_q && (!top_q && ab_q ? !ac_q : !bc_q), top_q || !ab_q};
                assign sorted = {chosen(high, a_q, b_q, c_q), chosen(mid, a_q, b_q, c_q), chosen(low, a_q, b_q, c_q)};
            end else begin : g_plain
                wire [WIDTH-1:0] top = top_i ? b : a;
                wire [WIDTH-1:0] bottom = bottom_i ? b : c;
                // Equal pixels may compare either way, so no selection is needed in front of this comparison.
                wire ac = top > bottom;
                assign sorted = {
                    high_of(ab, bc, ac, top, b, bottom), mid_of(ab, bc, ac, top, b, bottom),
                    low_of(ab, bc, ac, top, b, bottom)
                };
            end
            always @(posedge clk_i)
                if (sort_step) newest_q[lane*COLUMN+:COLUMN] <= sorted;
        end
    endgenerate

    always @(posedge clk_i) begin
        if (sort_step) begin
            center_q <= newest_q;
            left_q   <= center_q[(LANES-1)*COLUMN+:COLUMN];
            merge_left_q  <= sort_left;
            merge_right_q <= sort_right;
        end
    end

    // The columns of the windows side by side: the left column, the centers, the first column of the newest word.
    wire [(LANES+2)*COLUMN-1:0] columns = {newest_q[COLUMN-1:0], center_q, left_q};

    // Comparisons for the low, mid and high pixels: a > b, b > c and a > c of a column, the next one and the one after that.
    // At a border their results are set so that the missing column is never chosen. The column to the right of a border has
    // no left neighbor, so its entry in last_q is set one step earlier.
    wire [3*LANES-1:0] left_above;
    wire [3*LANES-1:0] next_above;
    wire [3*LANES-1:0] skip_above;
    reg  [2:0] last_q;  // b > c of the last column, of the step before

    always @(posedge clk_i) begin
        if (sort_step) begin
            last_q[0] <= next_above[3*LANES-3] && !merge_right_q;
            last_q[1] <= next_above[3*LANES-2] || merge_right_q;
            last_q[2] <= next_above[3*LANES-1] || merge_right_q;
        end
    end

    wire [(LANES+2)*COLUMN-1:0] merged;
    wire [3*LANES-1:0] row_ab, row_next, row_ac;
    wire row_left, row_right;  // merge_left_q and merge_right_q of this row

    generate
        for (lane = 0; lane < LANES; lane = lane + 1) begin : g_lane
            for (level = 0; level < 3; level = level + 1) begin : g_level
                wire [WIDTH-1:0] a = columns[lane*COLUMN+level*WIDTH+:WIDTH];
                wire [WIDTH-1:0] b = columns[(lane+1)*COLUMN+level*WIDTH+:WIDTH];
                wire [WIDTH-1:0] c = columns[(lane+2)*COLUMN+level*WIDTH+:WIDTH];
                wire no_right = lane == LANES - 1 && merge_right_q;
                wire earlier;
                if (lane == 0) begin : g_kept
                    assign earlier = last_q[level];
                end else begin : g_shared
                    assign earlier = next_above[3*(lane-1)+level];
                end
                assign left_above[3*lane+level] = earlier;
                if (level == 0) begin : g_low
                    assign next_above[3*lane+level] = {no_right, b} > {1'b0, c};
                    assign skip_above[3*lane+level] = {no_right, a} > {1'b0, c};
                end else if (level == 1) begin : g_mid
                    assign next_above[3*lane+level] = b > c;
                    assign skip_above[3*lane+level] = {1'b0, a} > {no_right, c};
                end else begin : g_high
                    assign next_above[3*lane+level] = {1'b0, b} > {no_right, c};
                    assign skip_above[3*lane+level] = {1'b0, a} > {no_right, c};
                end
            end
        end
    endgenerate

    word_delay #(.WIDTH((LANES + 2) * COLUMN + 9 * LANES + 2), .DEPTH(DEEP)) u_merge (
        .clk_i(clk_i), .data_i({columns, left_above, next_above, skip_above, merge_left_q, merge_right_q}),
        .data_o({merged, row_ab, row_next, row_ac, row_left, row_right})
    );

    // The centers, and whether each of them stays as it is: one clock after the columns are merged, with DEEP two.
    wire [LANES-1:0] stays;
    wire [LANES*WIDTH-1:0] own;
    generate
        if (SWITCHING) begin : g_switching
            // The middle pixel of each column, and two bits that say if it is the largest and if it is the smallest of the three.
            // Another pixel may have the same value.
            localparam OWN = WIDTH + 2;
            wire [LANES*OWN-1:0] incoming, merged_own;
            reg [LANES*OWN-1:0] newest_own_q, center_own_q;
            wire [LANES-1:0] low_equal;   // the lows of the left and the center column are equal
            wire [LANES-1:0] high_equal;  // the highs of the center and the right column are equal
            wire [LANES-1:0] row_low_equal, row_high_equal;
            always @(posedge clk_i) begin
                if (sort_step) begin
                    newest_own_q <= incoming;
                    center_own_q <= newest_own_q;
                end
            end
            word_delay #(.WIDTH(LANES * (OWN + 2)), .DEPTH(DEEP)) u_merge_own (
                .clk_i(clk_i), .data_i({center_own_q, low_equal, high_equal}),
                .data_o({merged_own, row_low_equal, row_high_equal})
            );
            for (lane = 0; lane < LANES; lane = lane + 1) begin : g_compared_lane
                wire [WIDTH-1:0] a = upper_i[lane*WIDTH+:WIDTH];
                wire [WIDTH-1:0] b = middle_i[lane*WIDTH+:WIDTH];
                wire [WIDTH-1:0] c = lower_i[lane*WIDTH+:WIDTH];
                wire ab, ab_equal, bc, bc_equal, no_top, no_bottom;
                wire [WIDTH-1:0] middle;
                word_delay #(.WIDTH(WIDTH + 6), .DEPTH(DEEP)) u_compared (
                    .clk_i(clk_i), .data_i({a > b, a == b, b > c, b == c, top_i, bottom_i, b}),
                    .data_o({ab, ab_equal, bc, bc_equal, no_top, no_bottom, middle})
                );
                wire column_largest = (no_top || !ab) && (no_bottom || bc || bc_equal);
                wire column_smallest = (no_top || ab || ab_equal) && (no_bottom || !bc);
                assign incoming[lane*OWN+:OWN] = {column_largest, column_smallest, middle};

                assign low_equal[lane] = columns[lane*COLUMN+:WIDTH] == columns[(lane+1)*COLUMN+:WIDTH];
                assign high_equal[lane] =
                    columns[(lane+1)*COLUMN+2*WIDTH+:WIDTH] == columns[(lane+2)*COLUMN+2*WIDTH+:WIDTH];

                // An extreme of its column is one of its window if no neighboring column has a pixel beyond it.
                wire no_left = lane == 0 && row_left;
                wire no_right = lane == LANES - 1 && row_right;
                wire largest = merged_own[lane*OWN+WIDTH+1] && (no_left || !row_ab[3*lane+2])
                               && (no_right || row_next[3*lane+2] || row_high_equal[lane]);
                wire smallest = merged_own[lane*OWN+WIDTH] && (no_left || row_ab[3*lane] || row_low_equal[lane])
                                && (no_right || !row_next[3*lane]);
                word_delay #(.WIDTH(WIDTH + 1), .DEPTH(1 + DEEP)) u_own (
                    .clk_i(clk_i), .data_i({!largest && !smallest, merged_own[lane*OWN+:WIDTH]}),
                    .data_o({stays[lane], own[lane*WIDTH+:WIDTH]})
                );
            end
        end else begin : g_median
            assign stays = {LANES{1'b0}};
            assign own = {LANES * WIDTH{1'b0}};
        end
    endgenerate

    generate
        for (lane = 0; lane < LANES; lane = lane + 1) begin : g_final
            wire [COLUMN-1:0] left = merged[lane*COLUMN+:COLUMN];
            wire [COLUMN-1:0] center = merged[(lane+1)*COLUMN+:COLUMN];
            wire [COLUMN-1:0] right = merged[(lane+2)*COLUMN+:COLUMN];
            // mid_of gives b if ab and bc are equal. At a border bc is set equal to ab, so that the center is chosen.
            wire mid_bc = (lane == 0 && row_left)
                          || (lane == LANES - 1 && row_right ? row_ab[3*lane+1] : row_next[3*lane+1]);
            reg [WIDTH-1:0] x_q, y_q, z_q;
            always @(posedge clk_i) begin
                x_q <= high_of(row_ab[3*lane], row_next[3*lane], row_ac[3*lane],
                               left[WIDTH-1:0], center[WIDTH-1:0], right[WIDTH-1:0]);
                y_q <= mid_of(row_ab[3*lane+1], mid_bc, row_ac[3*lane+1],
                              left[WIDTH+:WIDTH], center[WIDTH+:WIDTH], right[WIDTH+:WIDTH]);
                z_q <= low_of(row_ab[3*lane+2], row_next[3*lane+2], row_ac[3*lane+2],
                              left[2*WIDTH+:WIDTH], center[2*WIDTH+:WIDTH], right[2*WIDTH+:WIDTH]);
            end
            if (DEEP) begin : g_deep
                reg [WIDTH-1:0] x_2q, y_2q, z_2q;
                reg xy_q, yz_q, xz_q;
                always @(posedge clk_i) begin
                    {x_2q, y_2q, z_2q} <= {x_q, y_q, z_q};
                    {xy_q, yz_q, xz_q} <= {x_q > y_q, y_q > z_q, x_q > z_q};
                    median_o[lane*WIDTH+:WIDTH] <= stays[lane] ? own[lane*WIDTH+:WIDTH]
                                                   : mid_of(xy_q, yz_q, xz_q, x_2q, y_2q, z_2q);
                end
            end else begin : g_plain
                always @(posedge clk_i)
                    median_o[lane*WIDTH+:WIDTH] <= stays[lane] ? own[lane*WIDTH+:WIDTH]
                                                   : mid_of(x_q > y_q, y_q > z_q, x_q > z_q, x_q, y_q, z_q);
            end
        end
    endgenerate

endmodule

`default_nettype wire
