// SPDX-License-Identifier: MIT OR Apache-2.0
// Second pass over the pixels of every region, whose mean is known now. It reads the region back once. With MAD it adds up
// |2^FRACTION * pixel - mean|, and with SEGMENT it counts the pixels that are far from the mean. done_o comes with the scores of
// a region.
//
// Regions wait in a queue together with their means and the bits of extra_i. One follows the other without a clock in
// between, so the queue never holds more than two rows of regions.
`default_nettype none

module raster_pass #(
    parameter WIDTH = 8,          // bits of a pixel
    parameter LANES = 1,          // pixels of a word
    parameter SIDE = 8,           // rows of a region
    parameter SEGMENT_WORDS = 8,  // words of a row of a region: SIDE / LANES
    parameter POSITION_BITS = 6,  // ceil(log2(SIDE * SIDE))
    parameter ROW_WORDS = 1920,   // words of a row of the frame
    parameter PLACE_BITS = 15,    // bits of a place in the buffer
    parameter FRACTION = 0,       // fraction bits of the mean
    parameter MEAN_BITS = 8,      // bits of the mean
    parameter MAD = 1,            // 1: deviations are added up
    parameter MAD_BITS = 14,      // bits of the sum of deviations
    parameter SEGMENT = 0,        // 1: pixels far from the mean are counted
    parameter SEGMENT_BITS = 1,   // bits of the score of `segment`
    parameter COUNT_BITS = 7,     // bits of a count, 0..SIDE * SIDE
    parameter EXTRA_BITS = 14,    // bits of extra_i
    parameter ZONES = 0,          // 1: the two highest bits of extra_i are the class of the region
    parameter QUEUE_BITS = 9,     // log2 of the regions that can wait
    parameter DEEP = 0            // 1: the scores come one clock later
) (
    input  wire                    clk_i,            // clock, rising edge
    input  wire                    rst_i,            // synchronous reset, active high
    input  wire [       WIDTH-1:0] segment_level_i,  // a pixel counts if it differs from the mean by more than this level (SEGMENT)
    input  wire [       WIDTH-1:0] keen_segment_level_i,  // segment_level_i of keen regions (SEGMENT, ZONES)
    input  wire                    enter_i,          // a region enters the queue
    input  wire [   MEAN_BITS-1:0] mean_i,           // mean of that region
    input  wire [  PLACE_BITS-1:0] start_i,          // place in the buffer of the region's first word
    input  wire [  EXTRA_BITS-1:0] extra_i,          // bits that stay with the region
    output wire                    read_o,           // a word is read at this edge
    output wire [  PLACE_BITS-1:0] place_o,          // place in the buffer of the word that is read
    input  wire [ LANES*WIDTH-1:0] word_i,           // the word that was read, one clock later (DEEP: two)
    output wire                    done_o,           // the scores are those of a whole region
    output wire [    MAD_BITS-1:0] mad_o,            // sum of the region's deviations (MAD)
    output wire [SEGMENT_BITS-1:0] segment_o,        // score of `segment` of that region (SEGMENT)
    output wire [  EXTRA_BITS-1:0] extra_o           // extra_i of that region
);

    localparam ENTRY_BITS = MEAN_BITS + PLACE_BITS + EXTRA_BITS;
    localparam READ_CLOCKS = 1 + DEEP;
    localparam TERM_BITS = MEAN_BITS + $clog2(LANES);

    // The queue of waiting regions.
    wire take;
    wire unused_queued;
    wire oldest_valid;
    wire [ENTRY_BITS-1:0] oldest;

    raster_queue #(.WIDTH(ENTRY_BITS), .BITS(QUEUE_BITS)) u_queue (
        .clk_i(clk_i), .rst_i(rst_i), .enter_i(enter_i), .entry_i({extra_i, start_i, mean_i}), .take_i(take),
        .valid_o(oldest_valid), .oldest_o(oldest), .waits_o(unused_queued)
    );

    // The region that is read back.
    reg reading_q;
    wire last, first;
    reg [MEAN_BITS-1:0] mean_q;
    reg [EXTRA_BITS-1:0] extra_q;

    assign take = oldest_valid && (!reading_q || last);

    always @(posedge clk_i) begin
        reading_q <= take || (reading_q && !last);
        if (take) begin
            mean_q  <= oldest[MEAN_BITS-1:0];
            extra_q <= oldest[MEAN_BITS+PLACE_BITS+:EXTRA_BITS];
        end
        if (rst_i) reading_q <= 1'b0;
    end

    wire [POSITION_BITS-1:0] unused_position;
    wire unused_segment_end, unused_mean;
    raster_walk #(
        .LANES(LANES), .SIDE(SIDE), .SEGMENT_WORDS(SEGMENT_WORDS), .POSITION_BITS(POSITION_BITS), .ROW_WORDS(ROW_WORDS),
        .PLACE_BITS(PLACE_BITS)
    ) u_walk (
        .clk_i(clk_i), .begin_i(take), .start_i(oldest[MEAN_BITS+:PLACE_BITS]), .step_i(reading_q),
        .means_i(1'b0), .mean_o(unused_mean), .place_o(place_o), .position_o(unused_position), .first_o(first), .segment_end_o(unused_segment_end),
        .last_o(last)
    );
    assign read_o = reading_q;

    // The flags of the word that was read, for its two steps: first the values of the word are made, then they are added to the region.
    wire word_valid, word_first, word_last;
    bit_delay #(.DEPTH(READ_CLOCKS)) u_word_valid (
        .clk_i(clk_i), .rst_i(rst_i), .bit_i(reading_q), .bit_o(word_valid)
    );
    word_delay #(.WIDTH(2), .DEPTH(READ_CLOCKS)) u_word_place (
        .clk_i(clk_i), .data_i({first, last}), .data_o({word_first, word_last})
    );
    reg valid_q, first_q, last_q, valid_2q, first_2q, last_2q, done_q;
    always @(posedge clk_i) begin
        {valid_q, first_q, last_q}    <= {word_valid && !rst_i, word_first, word_last};
        {valid_2q, first_2q, last_2q} <= {valid_q && !rst_i, first_q, last_q};
        done_q <= valid_2q && last_2q && !rst_i;
    end
    assign done_o = done_q;

    generate
        if (MAD) begin : g_mad
            wire [MEAN_BITS-1:0] mean;
            word_delay #(.WIDTH(MEAN_BITS), .DEPTH(READ_CLOCKS)) u_word_mean (
                .clk_i(clk_i), .data_i(mean_q), .data_o(mean)
            );

            // The deviations, their sum over a word, and their sum over the region.
            reg [LANES*MEAN_BITS-1:0] deviation_q;
            reg [TERM_BITS-1:0] term_q;
            reg [MAD_BITS-1:0] sum_q;
            integer lane;
            reg [LANES*MEAN_BITS-1:0] deviation;
            reg [MEAN_BITS-1:0] scaled;
            reg [TERM_BITS-1:0] term;
            always @* begin
                deviation = {LANES * MEAN_BITS{1'b0}};
                term = {TERM_BITS{1'b0}};
                for (lane = 0; lane < LANES; lane = lane + 1) begin
                    scaled = {{(MEAN_BITS - WIDTH) {1'b0}}, word_i[lane*WIDTH+:WIDTH]} << FRACTION;
                    deviation[lane*MEAN_BITS+:MEAN_BITS] = scaled < mean ? mean - scaled : scaled - mean;
                    term = term + {{(TERM_BITS - MEAN_BITS) {1'b0}}, deviation_q[lane*MEAN_BITS+:MEAN_BITS]};
                end
            end
            always @(posedge clk_i) begin
                deviation_q <= deviation;
                term_q      <= term;
                if (valid_2q)
                    sum_q <= (first_2q ? {MAD_BITS{1'b0}} : sum_q) + {{(MAD_BITS - TERM_BITS) {1'b0}}, term_q};
            end
            assign mad_o = sum_q;
        end else begin : g_no_mad
            wire unused_first = first_2q;
            assign mad_o = {MAD_BITS{1'b0}};
        end

        if (SEGMENT) begin : g_segment
            localparam [1:0] KEEN = 2'd2;
            wire keen = ZONES && extra_q[EXTRA_BITS-1:EXTRA_BITS-2] == KEEN;
            raster_segment #(
                .WIDTH(WIDTH), .LANES(LANES), .FRACTION(FRACTION), .MEAN_BITS(MEAN_BITS), .COUNT_BITS(COUNT_BITS),
                .SCORE_BITS(SEGMENT_BITS), .MEAN_CLOCKS(READ_CLOCKS)
            ) u_segment (
                .clk_i(clk_i), .mean_i(mean_q), .level_i(keen ? keen_segment_level_i : segment_level_i), .word_i(word_i), .step_i(valid_q),
                .first_i(first_q), .score_o(segment_o)
            );
        end else begin : g_no_segment
            wire unused_level = |segment_level_i || |keen_segment_level_i;
            assign segment_o = {SEGMENT_BITS{1'b0}};
        end
    endgenerate

    word_delay #(.WIDTH(EXTRA_BITS), .DEPTH(READ_CLOCKS + 3)) u_extra (
        .clk_i(clk_i), .data_i(extra_q), .data_o(extra_o)
    );

endmodule

`default_nettype wire
