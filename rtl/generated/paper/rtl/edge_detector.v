// SPDX-License-Identifier: MIT OR Apache-2.0
// Detects edges by the 3x3 Sobel operator: a hit if |Gx| + |Gy| > level_i. hit_o comes in the clock of the step that
// completes the window; with DEEP it comes two clocks later, because there are registers before and behind the comparison.
//
// |Gx| + |Gy| is the larger of |Gx + Gy| and |Gx - Gy|. Both have kernels whose weights are 2 and -2 only:
//
//     (Gx + Gy) / 2 = -(upper + middle) of the left column + (lower - upper) of the center column
//                     + (middle + lower) of the right column
//     (Gy - Gx) / 2 = (middle + lower) of the left column + (lower - upper) of the center column
//                     - (upper + middle) of the right column
//
// So each is compared with floor(level_i / 2). The terms of the left and center columns are added before the right column
// comes, and every selection at a border is in front of an operand of one of these adders.
`default_nettype none

module edge_detector #(
    parameter WIDTH = 8,       // bits of a pixel
    parameter LEVEL_BITS = 11, // bits of the level, at most WIDTH + 3
    parameter DEEP = 0         // 0: hit_o comes in the clock of its step; 1: two clocks later
) (
    input  wire                  clk_i,      // clock, rising edge
    input  wire                  advance_i,  // the window moves by one column at this edge
    input  wire                  left_i,     // the incoming column is the first of its row
    input  wire                  right_i,    // the center is the last of its row
    input  wire [     WIDTH-1:0] upper_i,    // upper pixel of the incoming column
    input  wire [     WIDTH-1:0] middle_i,   // middle pixel of the incoming column
    input  wire [     WIDTH-1:0] lower_i,    // lower pixel of the incoming column
    input  wire [LEVEL_BITS-1:0] level_i,    // a magnitude above this level is a hit
    output wire                  hit_o       // hit of the center, which has the incoming column on its right
);

    // Limits: a value out of range stops elaboration at an instance of a module that does not exist.
    generate
        if (WIDTH < 1) begin : g_width WIDTH_must_be_1_or_more u_refused (); end
        if (LEVEL_BITS < 2 || LEVEL_BITS > WIDTH + 3) begin : g_level_bits
            LEVEL_BITS_must_be_2_to_WIDTH_and_3 u_refused ();
        end
        if (DEEP != 0 && DEEP != 1) begin : g_deep_range DEEP_must_be_0_or_1 u_refused (); end
    endgenerate

    localparam SUM_BITS = WIDTH + 3;  // bits of a signed sum, -3 * (2^WIDTH - 1) .. 3 * (2^WIDTH - 1)

    // Sums of pairs of pixels of the incoming column, and the difference of its outer pixels.
    wire [WIDTH:0] upper_pair;
    wire [WIDTH:0] lower_pair;
    wire [SUM_BITS-1:0] slope;  // lower - upper

    adder #(.WIDTH(WIDTH + 1)) u_upper_pair (
        .plain_i({1'b0, middle_i}), .other_i({1'b0, upper_i}), .sum_o(upper_pair)
    );

    adder #(.WIDTH(WIDTH + 1)) u_lower_pair (
        .plain_i({1'b0, middle_i}), .other_i({1'b0, lower_i}), .sum_o(lower_pair)
    );

    // A difference of pairs needs no selection at a border. A difference of pixels does not wait for the sums of pairs, which
    // makes a shorter path.
    generate
        if (DEEP) begin : g_of_pixels
            assign slope = {3'b0, lower_i} - {3'b0, upper_i};
        end else begin : g_of_pairs
            assign slope = {2'b0, lower_pair} - {2'b0, upper_pair};
        end
    endgenerate

    // The terms of the left and the center column.
    reg  [WIDTH:0] upper_pair_q;
    reg  [WIDTH:0] lower_pair_q;
    reg  [SUM_BITS-1:0] sum_q;   // terms of (Gx + Gy) / 2
    reg  [SUM_BITS-1:0] diff_q;  // terms of (Gy - Gx) / 2
    wire [SUM_BITS-1:0] diff_next;
    wire [WIDTH:0] left_upper_pair = left_i ? upper_pair : upper_pair_q;
    wire [WIDTH:0] left_lower_pair = left_i ? lower_pair : lower_pair_q;

    adder #(.WIDTH(SUM_BITS)) u_diff_next (
        .plain_i(slope), .other_i({2'b0, left_lower_pair}), .sum_o(diff_next)
    );

    always @(posedge clk_i) begin
        if (advance_i) begin
            upper_pair_q <= upper_pair;
            lower_pair_q <= lower_pair;
            sum_q        <= slope - {2'b0, left_upper_pair};
            diff_q       <= diff_next;
        end
    end

    // The term of the right column is added.
    wire [WIDTH:0] right_upper_pair = right_i ? upper_pair_q : upper_pair;
    wire [WIDTH:0] right_lower_pair = right_i ? lower_pair_q : lower_pair;
    wire [SUM_BITS-1:0] sum;
    wire [SUM_BITS-1:0] diff = diff_q - {2'b0, right_upper_pair};

    adder #(.WIDTH(SUM_BITS)) u_sum (
        .plain_i(sum_q), .other_i({2'b0, right_lower_pair}), .sum_o(sum)
    );

    // Twice a sum is even, so the lowest bit of the level makes no difference.
    wire [WIDTH+1:0] half_level = {{(WIDTH + 3 - LEVEL_BITS) {1'b0}}, level_i[LEVEL_BITS-1:1]};
    wire unused_level_bit = level_i[0];

    wire [SUM_BITS-1:0] compared_sum;
    wire [SUM_BITS-1:0] compared_diff;
    wire [   WIDTH+1:0] compared_level;
    wire sum_above;
    wire diff_above;

    magnitude_above #(.WIDTH(SUM_BITS)) u_sum_above (
        .value_i(compared_sum), .level_i(compared_level), .above_o(sum_above)
    );

    magnitude_above #(.WIDTH(SUM_BITS)) u_diff_above (
        .value_i(compared_diff), .level_i(compared_level), .above_o(diff_above)
    );

    generate
        if (DEEP) begin : g_deep
            reg [SUM_BITS-1:0] compared_sum_q;
            reg [SUM_BITS-1:0] compared_diff_q;
            reg [   WIDTH+1:0] compared_level_q;
            reg hit_q;
            always @(posedge clk_i) begin
                compared_sum_q   <= sum;
                compared_diff_q  <= diff;
                compared_level_q <= half_level;
                hit_q            <= sum_above || diff_above;
            end
            assign compared_sum   = compared_sum_q;
            assign compared_diff  = compared_diff_q;
            assign compared_level = compared_level_q;
            assign hit_o          = hit_q;
        end else begin : g_plain
            assign compared_sum   = sum;
            assign compared_diff  = diff;
            assign compared_level = half_level;
            assign hit_o          = sum_above || diff_above;
        end
    endgenerate

endmodule

`default_nettype wire
