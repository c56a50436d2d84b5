// SPDX-License-Identifier: MIT OR Apache-2.0
// Computes the places where the first word of a region is: in the buffer, and with FRAME in the frame. Regions come in
// order. The outputs belong to the region that is next, and change at the edge of step_i.
`default_nettype none

module raster_start #(
    parameter COLUMNS = 240,      // regions in a row of regions
    parameter ROWS = 135,         // rows of regions
    parameter SEGMENT_WORDS = 8,  // words of a row of a region
    parameter SIDE = 8,           // rows of a region
    parameter BANKS = 2,          // rows of regions in the buffer
    parameter START_BITS = 15,    // ceil(log2(BANKS * SIDE * COLUMNS * SEGMENT_WORDS))
    parameter FRAME = 0,          // 1: place_o is used
    parameter PLACE_BITS = 21     // ceil(log2(ROWS * SIDE * COLUMNS * SEGMENT_WORDS)) (FRAME)
) (
    input  wire                  clk_i,    // clock, rising edge
    input  wire                  rst_i,    // synchronous reset, active high
    input  wire                  step_i,   // moves on to the next region
    output reg  [           2:0] row_o,    // row of regions of this region, modulo 8, counted through all frames
    output reg  [START_BITS-1:0] start_o,  // place in the buffer of the region's first word
    output wire [PLACE_BITS-1:0] place_o   // place in the frame of the region's first word (FRAME)
);

    localparam COLUMN_BITS = $clog2(COLUMNS);
    localparam BEFORE_LAST = COLUMNS - 2;
    localparam ROW_WORDS = COLUMNS * SEGMENT_WORDS;
    localparam LAST_START = (BANKS - 1) * SIDE * ROW_WORDS + (COLUMNS - 1) * SEGMENT_WORDS;
    localparam NEXT = SEGMENT_WORDS;
    localparam NEXT_ROW = SEGMENT_WORDS + (SIDE - 1) * ROW_WORDS;

    reg [COLUMN_BITS-1:0] column_q;
    reg last_column_q;

    always @(posedge clk_i) begin
        if (step_i) begin
            column_q      <= last_column_q ? {COLUMN_BITS{1'b0}} : column_q + 1'b1;
            last_column_q <= column_q == BEFORE_LAST[COLUMN_BITS-1:0];
            row_o         <= row_o + {2'd0, last_column_q};
            start_o       <= start_o == LAST_START[START_BITS-1:0] ? {START_BITS{1'b0}} : start_o + (last_column_q ? NEXT_ROW[START_BITS-1:0] : NEXT[START_BITS-1:0]);
        end
        if (rst_i) begin
            column_q      <= {COLUMN_BITS{1'b0}};
            last_column_q <= 1'b0;
            row_o         <= 3'd0;
            start_o       <= {START_BITS{1'b0}};
        end
    end

    generate
        if (FRAME) begin : g_frame
            localparam LAST_PLACE = (ROWS - 1) * SIDE * ROW_WORDS + (COLUMNS - 1) * SEGMENT_WORDS;
            localparam STEP = SEGMENT_WORDS;
            localparam ROW_STEP = SEGMENT_WORDS + (SIDE - 1) * ROW_WORDS;
            reg [PLACE_BITS-1:0] place_q;
            always @(posedge clk_i) begin
                if (rst_i) place_q <= {PLACE_BITS{1'b0}};
                else if (step_i)
                    place_q <= place_q == LAST_PLACE[PLACE_BITS-1:0] ? {PLACE_BITS{1'b0}} : place_q + (last_column_q ? ROW_STEP[PLACE_BITS-1:0] : STEP[PLACE_BITS-1:0]);
            end
            assign place_o = place_q;
        end else begin : g_none
            assign place_o = {PLACE_BITS{1'b0}};
        end
    endgenerate

endmodule

`default_nettype wire
