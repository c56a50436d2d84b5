// SPDX-License-Identifier: MIT OR Apache-2.0
// Detects edges by the 3x3 Sobel operator for every pixel of a word at once: a hit if |Gx| + |Gy| > level_i. hit_o comes
// four clocks after its step, with DEEP five.
//
// |Gx| + |Gy| is the larger of |Gx + Gy| and |Gx - Gy|. With the sums upper = top + middle and lower = middle + bottom of
// the columns left, center and right,
//
//     (Gx + Gy) / 2 = (lower of center + lower of right) - (upper of left + upper of center)
//     (Gx - Gy) / 2 = (upper of center + upper of right) - (lower of left + lower of center)
//
// So the sums of two neighboring columns serve the windows on both sides of them. Each magnitude is compared with
// floor(level_i / 2).
`default_nettype none

module raster_edge #(
    parameter WIDTH = 8,       // bits of a pixel
    parameter LANES = 1,       // pixels of a word
    parameter LEVEL_BITS = 11, // bits of the level, at most WIDTH + 3
    parameter DEEP = 0         // 0: hit_o comes four clocks after its step; 1: five clocks
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
    input  wire [ LEVEL_BITS-1:0] level_i,   // a magnitude above this level is a hit
    output wire [      LANES-1:0] hit_o      // hits of the centers, one per pixel of the word
);

    // Limits: a value out of range stops elaboration at an instance of a module that does not exist.
    generate
        if (WIDTH < 1) begin : g_width WIDTH_must_be_1_or_more u_refused (); end
        if (LANES < 1) begin : g_lanes LANES_must_be_1_or_more u_refused (); end
        if (LEVEL_BITS < 2 || LEVEL_BITS > WIDTH + 3) begin : g_level_bits
            LEVEL_BITS_must_be_2_to_WIDTH_and_3 u_refused ();
        end
    endgenerate

    localparam PAIR = WIDTH + 1;  // bits of the sum of two pixels
    localparam FOUR = WIDTH + 2;  // bits of the sum of four pixels
    localparam SUM = WIDTH + 3;   // bits of the difference of two such sums, signed

    // The first edge: the columns of the newest word and of the centers.
    reg [LANES*PAIR-1:0] newest_upper_q, newest_lower_q;
    reg [LANES*PAIR-1:0] center_upper_q, center_lower_q;
    reg step_q, left_q, right_q;

    // The second edge: sums of neighboring columns. Element 0 is the first center with its left column, element j + 1 center j
    // with its right column. At a border the center's own column is used in place of the missing one.
    reg [(LANES+1)*FOUR-1:0] upper_2q, lower_2q;
    reg [PAIR-1:0] first_upper_2q, first_lower_2q;
    reg left_2q;

    genvar lane;
    generate
        for (lane = 0; lane < LANES; lane = lane + 1) begin : g_lane
            wire [WIDTH-1:0] top = upper_i[lane*WIDTH+:WIDTH];
            wire [WIDTH-1:0] middle = middle_i[lane*WIDTH+:WIDTH];
            wire [WIDTH-1:0] bottom = lower_i[lane*WIDTH+:WIDTH];
            wire [PAIR-1:0] upper;
            wire [PAIR-1:0] lower;

            adder #(.WIDTH(PAIR)) u_upper (
                .plain_i({1'b0, middle}), .other_i({1'b0, top_i ? middle : top}), .sum_o(upper)
            );
            adder #(.WIDTH(PAIR)) u_lower (
                .plain_i({1'b0, middle}), .other_i({1'b0, bottom_i ? middle : bottom}), .sum_o(lower)
            );

            always @(posedge clk_i) begin
                if (step_i) begin
                    newest_upper_q[lane*PAIR+:PAIR] <= upper;
                    newest_lower_q[lane*PAIR+:PAIR] <= lower;
                    center_upper_q[lane*PAIR+:PAIR] <= newest_upper_q[lane*PAIR+:PAIR];
                    center_lower_q[lane*PAIR+:PAIR] <= newest_lower_q[lane*PAIR+:PAIR];
                end
            end

            wire [PAIR-1:0] upper_own = center_upper_q[lane*PAIR+:PAIR];
            wire [PAIR-1:0] lower_own = center_lower_q[lane*PAIR+:PAIR];
            wire [PAIR-1:0] upper_right;
            wire [PAIR-1:0] lower_right;
            if (lane == LANES - 1) begin : g_border
                assign upper_right = right_q ? upper_own : newest_upper_q[PAIR-1:0];
                assign lower_right = right_q ? lower_own : newest_lower_q[PAIR-1:0];
            end else begin : g_inner
                assign upper_right = center_upper_q[(lane+1)*PAIR+:PAIR];
                assign lower_right = center_lower_q[(lane+1)*PAIR+:PAIR];
            end

            wire [FOUR-1:0] upper_pair;
            wire [FOUR-1:0] lower_pair;
            adder #(.WIDTH(FOUR)) u_upper_pair (
                .plain_i({1'b0, upper_own}), .other_i({1'b0, upper_right}), .sum_o(upper_pair)
            );
            adder #(.WIDTH(FOUR)) u_lower_pair (
                .plain_i({1'b0, lower_own}), .other_i({1'b0, lower_right}), .sum_o(lower_pair)
            );

            always @(posedge clk_i) begin
                if (step_q) begin
                    upper_2q[(lane+1)*FOUR+:FOUR] <= upper_pair;
                    lower_2q[(lane+1)*FOUR+:FOUR] <= lower_pair;
                end
            end

            wire [FOUR-1:0] upper_before;
            wire [FOUR-1:0] lower_before;
            if (lane == 0) begin : g_first
                assign upper_before = left_2q ? {first_upper_2q, 1'b0} : upper_2q[FOUR-1:0];
                assign lower_before = left_2q ? {first_lower_2q, 1'b0} : lower_2q[FOUR-1:0];
            end else begin : g_next
                assign upper_before = upper_2q[lane*FOUR+:FOUR];
                assign lower_before = lower_2q[lane*FOUR+:FOUR];
            end

            // Twice a sum is even, so the lowest bit of the level makes no difference.
            reg  [SUM-1:0] sum_3q;   // (Gx + Gy) / 2
            reg  [SUM-1:0] diff_3q;  // (Gx - Gy) / 2
            wire sum_above, diff_above;
            wire [WIDTH+1:0] half_level = {{(WIDTH + 3 - LEVEL_BITS) {1'b0}}, level_i[LEVEL_BITS-1:1]};

            magnitude_above #(.WIDTH(SUM), .BORROW(DEEP)) u_sum_above (
                .value_i(sum_3q), .level_i(half_level), .above_o(sum_above)
            );
            magnitude_above #(.WIDTH(SUM), .BORROW(DEEP)) u_diff_above (
                .value_i(diff_3q), .level_i(half_level), .above_o(diff_above)
            );
            always @(posedge clk_i) begin
                sum_3q  <= {1'b0, lower_2q[(lane+1)*FOUR+:FOUR]} - {1'b0, upper_before};
                diff_3q <= {1'b0, upper_2q[(lane+1)*FOUR+:FOUR]} - {1'b0, lower_before};
            end

            reg hit_q;
            if (DEEP) begin : g_deep
                reg sum_above_4q, diff_above_4q;
                always @(posedge clk_i) begin
                    sum_above_4q  <= sum_above;
                    diff_above_4q <= diff_above;
                    hit_q         <= sum_above_4q || diff_above_4q;
                end
            end else begin : g_plain
                always @(posedge clk_i) hit_q <= sum_above || diff_above;
            end
            assign hit_o[lane] = hit_q;
        end
    endgenerate

    wire unused_level_bit = level_i[0];

    always @(posedge clk_i) begin
        step_q <= step_i;
        if (step_i) begin
            left_q  <= left_i;
            right_q <= right_i;
        end
        if (step_q) begin
            upper_2q[FOUR-1:0] <= upper_2q[LANES*FOUR+:FOUR];
            lower_2q[FOUR-1:0] <= lower_2q[LANES*FOUR+:FOUR];
            first_upper_2q <= center_upper_q[PAIR-1:0];
            first_lower_2q <= center_lower_q[PAIR-1:0];
            left_2q <= left_q;
        end
    end

endmodule

`default_nettype wire
