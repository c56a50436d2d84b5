// SPDX-License-Identifier: MIT OR Apache-2.0
// Computes the scores of `mad` and `segment` of every region: its mean, then in a second pass the deviations of its pixels from the
// mean. A memory keeps the pixels for that. The other scores of the region wait in the same queue, and all scores come with
// judged_o.
`default_nettype none

module raster_deviation #(
    parameter WIDTH = 8,             // bits of a pixel
    parameter LANES = 1,             // pixels of a word
    parameter SIDE = 8,              // rows of a region
    parameter SEGMENT_WORDS = 8,     // words of a row of a region: SIDE / LANES
    parameter COLUMNS = 240,         // regions in a row of regions
    parameter ROWS = 135,            // rows of regions
    parameter ROW_WORDS = 1920,      // words of a row of the frame
    parameter BANKS = 3,             // rows of regions that the memory keeps
    parameter POSITION_BITS = 6,     // ceil(log2(SIDE * SIDE))
    parameter START_BITS = 16,       // ceil(log2(BANKS * SIDE * ROW_WORDS))
    parameter SUM_BITS = 14,         // bits of the sum of a region's pixels
    parameter FRACTION = 0,          // fraction bits of the mean
    parameter DIVIDEND_BITS = 14,    // bits of 2^FRACTION * sum plus half of the pixels
    parameter MEAN_BITS = 8,         // bits of the mean
    parameter FACTOR_BITS = 1,       // bits of FACTOR
    parameter [FACTOR_BITS-1:0] FACTOR = 1,  // (dividend * FACTOR) >> SHIFT is the dividend divided by the pixels of a region
    parameter SHIFT = 6,             // bits of the product that are dropped
    parameter MAD = 1,               // 1: the score of `mad` is computed
    parameter MAD_BITS = 14,         // bits of the score of `mad`
    parameter SEGMENT = 0,           // 1: the score of `segment` is computed
    parameter SEGMENT_BITS = 1,      // bits of the score of `segment`
    parameter COUNT_BITS = 7,        // bits of a count, 0..SIDE * SIDE
    parameter OTHER_BITS = 40,       // bits of the other scores
    parameter ZONES = 0,             // 1: the two highest bits of the other scores are the class of the region
    parameter OTHER_CLOCKS = 0,      // clocks by which the other scores come after the sum
    parameter DEEP = 0               // 1: more registers, for a faster clock
) (
    input  wire                    clk_i,            // clock, rising edge
    input  wire                    rst_i,            // synchronous reset, active high
    input  wire [       WIDTH-1:0] segment_level_i,  // a pixel counts if it differs from the mean by more than this level (SEGMENT)
    input  wire [       WIDTH-1:0] keen_segment_level_i,  // segment_level_i of keen regions (SEGMENT, ZONES)
    input  wire                    store_i,          // a word is stored at this edge
    input  wire [  START_BITS-1:0] store_place_i,    // place in the buffer of that word
    input  wire [ LANES*WIDTH-1:0] word_i,           // the word that is stored
    input  wire                    done_i,           // sum_i is that of a whole region
    input  wire [    SUM_BITS-1:0] sum_i,            // sum of the pixels of that region
    input  wire                    settled_i,        // the other scores of a region are there, OTHER_CLOCKS after its sum
    input  wire [  OTHER_BITS-1:0] other_i,          // the other scores
    output wire                    judged_o,         // all scores of a region are there
    output wire [    MAD_BITS-1:0] mad_o,            // score of `mad` of that region (MAD)
    output wire [SEGMENT_BITS-1:0] segment_o,        // score of `segment` of that region (SEGMENT)
    output wire [  OTHER_BITS-1:0] other_o           // the other scores of that region
);

    localparam HALF = SIDE * SIDE / 2;
    localparam QUEUE_BITS = $clog2(BANKS * COLUMNS);  // log2 of the regions that the memory keeps: all of them may wait

    wire [MEAN_BITS-1:0] mean, settled_mean;
    region_mean #(
        .SUM_BITS(SUM_BITS), .FRACTION(FRACTION), .DIVIDEND_BITS(DIVIDEND_BITS), .MEAN_BITS(MEAN_BITS),
        .FACTOR_BITS(FACTOR_BITS), .HALF(HALF[DIVIDEND_BITS-1:0]), .FACTOR(FACTOR), .SHIFT(SHIFT)
    ) u_mean (
        .clk_i(clk_i), .done_i(done_i), .sum_i(sum_i), .mean_o(mean)
    );
    word_delay #(.WIDTH(MEAN_BITS), .DEPTH(OTHER_CLOCKS)) u_settled_mean (
        .clk_i(clk_i), .data_i(mean), .data_o(settled_mean)
    );

    // The computation of the mean takes one clock.
    wire enter;
    wire [OTHER_BITS-1:0] entering;
    bit_delay #(.DEPTH(1)) u_enter (.clk_i(clk_i), .rst_i(rst_i), .bit_i(settled_i), .bit_o(enter));
    word_delay #(.WIDTH(OTHER_BITS), .DEPTH(1)) u_entering (.clk_i(clk_i), .data_i(other_i), .data_o(entering));

    wire [START_BITS-1:0] start;
    wire [2:0] unused_row;
    wire unused_place;
    raster_start #(
        .COLUMNS(COLUMNS), .ROWS(ROWS), .SEGMENT_WORDS(SEGMENT_WORDS), .SIDE(SIDE), .BANKS(BANKS), .START_BITS(START_BITS),
        .PLACE_BITS(1)
    ) u_start (
        .clk_i(clk_i), .rst_i(rst_i), .step_i(enter), .row_o(unused_row), .start_o(start), .place_o(unused_place)
    );

    wire read;
    wire [START_BITS-1:0] place;
    wire [LANES*WIDTH-1:0] word;
    raster_pass #(
        .WIDTH(WIDTH), .LANES(LANES), .SIDE(SIDE), .SEGMENT_WORDS(SEGMENT_WORDS), .POSITION_BITS(POSITION_BITS),
        .ROW_WORDS(ROW_WORDS), .PLACE_BITS(START_BITS), .FRACTION(FRACTION), .MEAN_BITS(MEAN_BITS),
        .MAD(MAD), .MAD_BITS(MAD_BITS), .SEGMENT(SEGMENT), .SEGMENT_BITS(SEGMENT_BITS), .COUNT_BITS(COUNT_BITS),
        .EXTRA_BITS(OTHER_BITS), .ZONES(ZONES), .QUEUE_BITS(QUEUE_BITS), .DEEP(DEEP)
    ) u_pass (
        .clk_i(clk_i), .rst_i(rst_i), .segment_level_i(segment_level_i), .keen_segment_level_i(keen_segment_level_i), .enter_i(enter), .mean_i(settled_mean),
        .start_i(start), .extra_i(entering), .read_o(read), .place_o(place), .word_i(word), .done_o(judged_o),
        .mad_o(mad_o), .segment_o(segment_o), .extra_o(other_o)
    );
    raster_memory #(
        .WIDTH(LANES * WIDTH), .WORDS(BANKS * SIDE * ROW_WORDS), .ADDRESS_BITS(START_BITS), .OUTPUT_STAGE(DEEP)
    ) u_copy (
        .clk_i(clk_i), .write_i(store_i), .write_address_i(store_place_i), .data_i(word_i), .read_i(read),
        .read_address_i(place), .output_i(1'b1), .data_o(word)
    );

endmodule

`default_nettype wire
