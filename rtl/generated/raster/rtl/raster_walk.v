// SPDX-License-Identifier: MIT OR Apache-2.0
// Walks through the words of a region in the buffer, row by row.
`default_nettype none

module raster_walk #(
    parameter LANES = 1,          // pixels of a word
    parameter SIDE = 8,           // rows of a region
    parameter SEGMENT = 8,        // words of a row of a region: SIDE / LANES
    parameter POSITION_BITS = 6,  // ceil(log2(SIDE * SIDE))
    parameter ROW_WORDS = 1920,   // words of a row of the frame
    parameter PLACE_BITS = 15     // bits of a place in the buffer
) (
    input  wire                     clk_i,          // clock, rising edge
    input  wire                     begin_i,        // the walk begins at this edge
    input  wire [   PLACE_BITS-1:0] start_i,        // where
    input  wire                     step_i,         // on to the next word
    output wire [   PLACE_BITS-1:0] place_o,        // where the word is
    output wire [POSITION_BITS-1:0] position_o,     // number in the region of its first pixel
    output wire                     first_o,        // the word is the first of the region
    output wire                     segment_end_o,  // the word is the last of a row of the region
    output wire                     last_o          // the word is the last of the region
);

    localparam SEGMENT_BITS = SEGMENT > 1 ? $clog2(SEGMENT) : 1;
    localparam LAST_POSITION = SIDE * SIDE - LANES;
    localparam LAST_IN_SEGMENT = SEGMENT - 1;
    localparam JUMP = ROW_WORDS - SEGMENT + 1;
    localparam NEXT = 1;

    reg [PLACE_BITS-1:0] place_q;
    reg [POSITION_BITS-1:0] position_q;
    reg [SEGMENT_BITS-1:0] in_segment_q;

    always @(posedge clk_i) begin
        if (begin_i) begin
            place_q      <= start_i;
            position_q   <= {POSITION_BITS{1'b0}};
            in_segment_q <= {SEGMENT_BITS{1'b0}};
        end else if (step_i) begin
            place_q      <= place_q + (segment_end_o ? JUMP[PLACE_BITS-1:0] : NEXT[PLACE_BITS-1:0]);
            position_q   <= position_q + LANES[POSITION_BITS-1:0];
            in_segment_q <= segment_end_o ? {SEGMENT_BITS{1'b0}} : in_segment_q + 1'b1;
        end
    end

    assign place_o = place_q;
    assign position_o = position_q;
    assign first_o = position_q == {POSITION_BITS{1'b0}};
    assign segment_end_o = SEGMENT == 1 || in_segment_q == LAST_IN_SEGMENT[SEGMENT_BITS-1:0];
    assign last_o = position_q == LAST_POSITION[POSITION_BITS-1:0];

endmodule

`default_nettype wire
