// SPDX-License-Identifier: MIT OR Apache-2.0
// Follows the place of each word of the frame in its block. A region has BLOCKS x BLOCKS blocks, numbered row by row. The
// outputs belong to the word of step_i.
`default_nettype none

module raster_blocks #(
    parameter LANES = 1,        // pixels of a word
    parameter SIDE = 8,         // rows of a region
    parameter BLOCKS = 2,       // blocks of a region's side
    parameter COLUMNS = 240,    // regions in a row of regions
    parameter REGIONS = 32400,  // regions of the frame
    parameter REGION_BITS = 15  // ceil(log2(REGIONS))
) (
    input  wire                   clk_i,       // clock, rising edge
    input  wire                   rst_i,       // synchronous reset, active high
    input  wire                   step_i,      // a word comes in
    input  wire                   row_end_i,   // the word is the last of its row of the frame
    output wire                   start_o,     // the word is the first of its row in the block
    output wire                   end_o,       // the word is the last of its row in the block
    output wire                   upper_o,     // the row is the first of its block
    output wire                   lower_o,     // the row is the last of its block
    output wire [            1:0] column_o,    // column of the block in the region
    output wire [            1:0] line_o,      // row of the block in the region
    output reg  [REGION_BITS-1:0] region_o,    // number of the region
    output reg  [            1:0] row_o,       // row of regions modulo 4, counted through all frames
    output wire                   frame_end_o  // the word is the last of the frame
);

    // Limits: a value out of range stops elaboration at an instance of a module that does not exist.
    generate
        if (SIDE % (BLOCKS * LANES) != 0) begin : g_words a_block_must_have_whole_words u_refused (); end
        if (REGION_BITS != $clog2(REGIONS)) begin : g_region_bits REGION_BITS_must_be_clog2_of_REGIONS u_refused (); end
    endgenerate

    localparam BEFORE_LAST = REGIONS - 2;
    localparam BACK = COLUMNS - 1;
    localparam LAST = BLOCKS - 1;

    raster_parts #(.PARTS(BLOCKS), .SIZE(SIDE / BLOCKS / LANES)) u_columns (
        .clk_i(clk_i), .rst_i(rst_i), .step_i(step_i), .first_o(start_o), .last_o(end_o), .part_o(column_o)
    );
    raster_parts #(.PARTS(BLOCKS), .SIZE(SIDE / BLOCKS)) u_lines (
        .clk_i(clk_i), .rst_i(rst_i), .step_i(step_i && row_end_i), .first_o(upper_o), .last_o(lower_o), .part_o(line_o)
    );

    // After a row of a region comes the next region; at the end of a row of the frame, the first region of the same row of
    // regions, unless the row of regions is complete.
    reg last_region_q;
    wire move = step_i && end_o && column_o == LAST[1:0];
    wire complete = lower_o && line_o == LAST[1:0];
    wire back = row_end_i && !complete;
    assign frame_end_o = move && last_region_q && complete;

    always @(posedge clk_i) begin
        if (move) begin
            region_o      <= back ? region_o - BACK[REGION_BITS-1:0] : region_o + 1'b1;
            last_region_q <= region_o == BEFORE_LAST[REGION_BITS-1:0];
            if (row_end_i && complete) row_o <= row_o + 1'b1;
        end
        if (rst_i || frame_end_o) region_o <= {REGION_BITS{1'b0}};
        if (rst_i) begin
            last_region_q <= 1'b0;
            row_o         <= 2'd0;
        end
    end

endmodule

`default_nettype wire
