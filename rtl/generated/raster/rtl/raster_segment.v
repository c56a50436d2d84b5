// SPDX-License-Identifier: MIT OR Apache-2.0
// Counts the pixels of a region that lie more than level_i above its mean, and those that lie more than level_i below it. The
// smaller count is the score of `segment`. It comes two clocks after the step of the region's last word.
//
// The level has no fraction bits. So a pixel is above if it is greater than the whole part of the mean plus the level. It is
// below if it is less than the whole part of the mean minus the level, or equal to that while the mean has a fraction.
`default_nettype none

module raster_segment #(
    parameter WIDTH = 8,       // bits of a pixel
    parameter LANES = 1,       // pixels of a word
    parameter FRACTION = 0,    // fraction bits of the mean
    parameter MEAN_BITS = 8,   // bits of the mean: WIDTH + FRACTION
    parameter COUNT_BITS = 7,  // bits of a count
    parameter SCORE_BITS = 6,  // bits of the smaller count
    parameter MEAN_CLOCKS = 1  // clocks from mean_i to word_i, at least 1
) (
    input  wire                   clk_i,    // clock, rising edge
    input  wire [  MEAN_BITS-1:0] mean_i,   // mean of the region of the word that comes MEAN_CLOCKS later
    input  wire [      WIDTH-1:0] level_i,  // a pixel counts if it differs from the mean by more than this level
    input  wire [LANES*WIDTH-1:0] word_i,   // a word, which comes one clock before its step
    input  wire                   step_i,   // the word is counted at this edge
    input  wire                   first_i,  // the word is the first of its region
    output reg  [ SCORE_BITS-1:0] score_o   // score of the words of a region so far
);

    // Limits: a value out of range stops elaboration at an instance of a module that does not exist.
    generate
        if (MEAN_BITS != WIDTH + FRACTION) begin : g_mean_bits MEAN_BITS_must_be_WIDTH_and_FRACTION u_refused (); end
        if (SCORE_BITS < 1 || SCORE_BITS > COUNT_BITS) begin : g_score_bits
            SCORE_BITS_must_be_1_to_COUNT_BITS u_refused ();
        end
        if (MEAN_CLOCKS < 1) begin : g_mean_clocks MEAN_CLOCKS_must_be_1_or_more u_refused (); end
    endgenerate

    // The bounds, and whether the mean has a fraction. The upper bound may be too large for a pixel, and the lower one negative.
    wire [MEAN_BITS-1:0] truncated = mean_i >> FRACTION << FRACTION;
    wire [WIDTH:0] whole = {1'b0, mean_i[FRACTION+:WIDTH]};
    reg [WIDTH:0] high_q, low_q;
    reg fraction_q;
    always @(posedge clk_i) begin
        high_q     <= whole + {1'b0, level_i};
        low_q      <= whole - {1'b0, level_i};
        fraction_q <= mean_i != truncated;
    end
    wire [WIDTH:0] high, low;
    wire fraction;
    word_delay #(.WIDTH(2 * WIDTH + 3), .DEPTH(MEAN_CLOCKS - 1)) u_bounds (
        .clk_i(clk_i), .data_i({high_q, low_q, fraction_q}), .data_o({high, low, fraction})
    );

    // The pixels of a word beyond the bounds, and their number in the region.
    reg [LANES-1:0] above_q, below_q;
    reg [COUNT_BITS-1:0] above, below, above_count_q, below_count_q;
    integer lane, pixel;
    always @* begin
        above = first_i ? {COUNT_BITS{1'b0}} : above_count_q;
        below = first_i ? {COUNT_BITS{1'b0}} : below_count_q;
        for (lane = 0; lane < LANES; lane = lane + 1) begin
            above = above + {{(COUNT_BITS - 1) {1'b0}}, above_q[lane]};
            below = below + {{(COUNT_BITS - 1) {1'b0}}, below_q[lane]};
        end
    end

    // The larger count may need a bit more than the smaller one.
    /* verilator lint_off UNUSEDSIGNAL */
    wire [COUNT_BITS-1:0] smaller = above_count_q < below_count_q ? above_count_q : below_count_q;
    /* verilator lint_on UNUSEDSIGNAL */
    always @(posedge clk_i) begin
        for (pixel = 0; pixel < LANES; pixel = pixel + 1) begin
            above_q[pixel] <= !high[WIDTH] && word_i[pixel*WIDTH+:WIDTH] > high[WIDTH-1:0];
            below_q[pixel] <= !low[WIDTH] && {word_i[pixel*WIDTH+:WIDTH], 1'b0} < {low[WIDTH-1:0], fraction};
        end
        if (step_i) begin
            above_count_q <= above;
            below_count_q <= below;
        end
        score_o <= smaller[SCORE_BITS-1:0];
    end

endmodule

`default_nettype wire
