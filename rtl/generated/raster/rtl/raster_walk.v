// SPDX-License-Identifier: MIT OR Apache-2.0
// Walks through the words of a region in the buffer, row by row, or with means_i through its means, block by block. The
// outputs belong to the word of this step.
`default_nettype none

module raster_walk #(
    parameter LANES = 1,          // pixels of a word
    parameter SIDE = 8,           // rows of a region
    parameter SEGMENT_WORDS = 8,  // words of a row of a region: SIDE / LANES
    parameter POSITION_BITS = 6,  // ceil(log2(SIDE * SIDE))
    parameter ROW_WORDS = 1920,   // words of a row of the frame
    parameter PLACE_BITS = 15,    // bits of a place in the buffer
    parameter BLOCKS = 0,         // blocks of a region's side; 0: there are no means
    parameter MEAN_BITS = 1       // ceil(log2(BLOCKS * BLOCKS)), at least 1
) (
    input  wire                     clk_i,          // clock, rising edge
    input  wire                     begin_i,        // the walk begins at this edge
    input  wire [   PLACE_BITS-1:0] start_i,        // place in the buffer of the region's first word
    input  wire                     step_i,         // moves on to the next word
    input  wire                     means_i,        // the walk goes through means (BLOCKS)
    output wire [   PLACE_BITS-1:0] place_o,        // place in the buffer of the word
    output wire [    MEAN_BITS-1:0] mean_o,         // number of the block of the mean (BLOCKS)
    output wire [POSITION_BITS-1:0] position_o,     // position in the region of the first pixel of the word, or of the block
    output wire                     first_o,        // the word is the first of the region
    output wire                     segment_end_o,  // the word is the last of a row of the region
    output wire                     last_o          // the word is the last of the region
);

    localparam SEGMENT_BITS = SEGMENT_WORDS > 1 ? $clog2(SEGMENT_WORDS) : 1;
    localparam LAST_POSITION = SIDE * SIDE - LANES;
    localparam LAST_IN_SEGMENT = SEGMENT_WORDS - 1;
    localparam JUMP = ROW_WORDS - SEGMENT_WORDS + 1;
    localparam NEXT = 1;

    reg [PLACE_BITS-1:0] place_q;
    reg [POSITION_BITS-1:0] position_q;
    reg [SEGMENT_BITS-1:0] in_segment_q;

    wire [POSITION_BITS-1:0] stride;

    always @(posedge clk_i) begin
        if (begin_i) begin
            place_q      <= start_i;
            position_q   <= {POSITION_BITS{1'b0}};
            in_segment_q <= {SEGMENT_BITS{1'b0}};
        end else if (step_i) begin
            place_q      <= place_q + (segment_end_o ? JUMP[PLACE_BITS-1:0] : NEXT[PLACE_BITS-1:0]);
            position_q   <= position_q + stride;
            in_segment_q <= segment_end_o ? {SEGMENT_BITS{1'b0}} : in_segment_q + 1'b1;
        end
    end

    wire last_mean, mean_line_end;
    generate
        if (BLOCKS > 0) begin : g_means
            localparam BLOCK = SIDE / BLOCKS;
            localparam LAST_BLOCK = (SIDE - BLOCK) * (SIDE + 1);
            localparam LAST_IN_LINE = BLOCKS - 1;
            localparam NEXT_LINE = BLOCK * SIDE - (BLOCKS - 1) * BLOCK;
            assign stride = !means_i ? LANES[POSITION_BITS-1:0] : segment_end_o ? NEXT_LINE[POSITION_BITS-1:0] : BLOCK[POSITION_BITS-1:0];
            assign mean_line_end = BLOCKS == 1 || in_segment_q == LAST_IN_LINE[SEGMENT_BITS-1:0];
            assign last_mean = position_q == LAST_BLOCK[POSITION_BITS-1:0];
            if (BLOCKS == 1) begin : g_one
                assign mean_o = 1'b0;
            end else begin : g_number
                reg [MEAN_BITS-1:0] mean_q;
                always @(posedge clk_i) begin
                    if (begin_i) mean_q <= {MEAN_BITS{1'b0}};
                    else if (step_i) mean_q <= mean_q + 1'b1;
                end
                assign mean_o = mean_q;
            end
        end else begin : g_pixels
            wire unused_means = means_i;
            assign stride = LANES[POSITION_BITS-1:0];
            assign mean_line_end = 1'b0;
            assign last_mean = 1'b0;
            assign mean_o = {MEAN_BITS{1'b0}};
        end
    endgenerate
    wire means = BLOCKS > 0 && means_i;

    assign place_o = place_q;
    assign position_o = position_q;
    assign first_o = position_q == {POSITION_BITS{1'b0}};
    assign segment_end_o = means ? mean_line_end : SEGMENT_WORDS == 1 || in_segment_q == LAST_IN_SEGMENT[SEGMENT_BITS-1:0];
    assign last_o = means ? last_mean : position_q == LAST_POSITION[POSITION_BITS-1:0];

endmodule

`default_nettype wire
