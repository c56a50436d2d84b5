// SPDX-License-Identifier: MIT OR Apache-2.0
// Where the words of the frame are in blocks: a region has BLOCKS x BLOCKS of them, numbered row by row.
`default_nettype none

module raster_blocks #(
    parameter LANES = 1,         // pixels of a word
    parameter SIDE = 8,          // rows of a region
    parameter BLOCKS = 2,        // blocks of a region's side
    parameter COLUMNS = 240,     // regions side by side
    parameter REGIONS = 32400,   // regions of the frame
    parameter REGION_BITS = 15,  // ceil(log2(REGIONS))
    parameter COLUMN_BITS = 9    // ceil(log2(COLUMNS * BLOCKS))
) (
    input  wire                   clk_i,      // clock, rising edge
    input  wire                   rst_i,      // synchronous reset, active high
    input  wire                   step_i,     // a word comes in
    input  wire                   row_end_i,  // the word is the last of its row
    output wire                   start_o,    // the word is the first of a row of its block
    output wire                   end_o,      // ... the last
    output wire                   upper_o,    // that row is the first of its block
    output wire                   lower_o,    // ... the last
    output wire [            1:0] line_o,     // row of blocks of this block in its region
    output reg  [COLUMN_BITS-1:0] column_o,   // column of blocks of this block in the frame
    output reg  [REGION_BITS-1:0] region_o,   // its region, with the last word of a block
    output reg  [            1:0] row_o,      // row of regions, modulo 4, counted through all frames
    output wire                   frame_end_o // the word is the last of the frame
);

    // Limits: out of them elaboration stops at a module that does not exist.
    generate
        if (BLOCKS != 1 && BLOCKS != 2 && BLOCKS != 4) begin : g_blocks_limit BLOCKS_must_be_1_2_or_4 u_refused (); end
        if (SIDE % (BLOCKS * LANES) != 0) begin : g_words_limit a_block_must_have_whole_words u_refused (); end
        if (COLUMN_BITS != $clog2(COLUMNS * BLOCKS)) begin : g_column_bits_limit
            COLUMN_BITS_must_be_clog2_of_the_blocks_of_a_row u_refused ();
        end
    endgenerate

    localparam BLOCK = SIDE / BLOCKS;
    localparam WORDS = BLOCK / LANES;  // words of a row of a block
    localparam BEFORE_LAST = REGIONS - 2;
    localparam BACK = COLUMNS - 1;

    generate
        if (WORDS == 1) begin : g_word
            assign start_o = 1'b1;
            assign end_o = 1'b1;
        end else begin : g_words
            localparam BITS = $clog2(WORDS);
            localparam LAST = WORDS - 1;
            reg [BITS-1:0] word_q;
            always @(posedge clk_i) if (rst_i || (step_i && end_o)) word_q <= {BITS{1'b0}};
                else if (step_i) word_q <= word_q + 1'b1;
            assign start_o = ~|word_q;
            assign end_o = word_q == LAST[BITS-1:0];
        end

        if (BLOCK == 1) begin : g_row
            assign upper_o = 1'b1;
            assign lower_o = 1'b1;
        end else begin : g_rows
            localparam BITS = $clog2(BLOCK);
            localparam LAST = BLOCK - 1;
            reg [BITS-1:0] row_q;
            always @(posedge clk_i) if (rst_i || (step_i && row_end_i && lower_o)) row_q <= {BITS{1'b0}};
                else if (step_i && row_end_i) row_q <= row_q + 1'b1;
            assign upper_o = ~|row_q;
            assign lower_o = row_q == LAST[BITS-1:0];
        end
    endgenerate

    // The row of blocks; a region of one block has one.
    wire last_line, last_in_region;
    generate
        if (BLOCKS == 1) begin : g_line
            assign line_o = 2'd0;
            assign last_line = 1'b1;
            assign last_in_region = 1'b1;
        end else begin : g_lines
            localparam LAST = BLOCKS - 1;
            localparam BITS = $clog2(BLOCKS);
            reg [BITS-1:0] line_q;
            always @(posedge clk_i) if (rst_i) line_q <= {BITS{1'b0}};
                else if (step_i && row_end_i && lower_o) line_q <= line_q + 1'b1;
            assign line_o = {{(2 - BITS) {1'b0}}, line_q};
            assign last_line = &line_q;
            assign last_in_region = column_o[BITS-1:0] == LAST[BITS-1:0];
        end
    endgenerate

    // Behind the last word of a block: the next region, or back to the first of the row of regions.
    reg last_region_q;
    wire move = step_i && end_o && lower_o && last_in_region;
    wire back = row_end_i && !last_line;
    assign frame_end_o = move && !back && last_region_q;

    always @(posedge clk_i) begin
        if (step_i && end_o) column_o <= row_end_i ? {COLUMN_BITS{1'b0}} : column_o + 1'b1;
        if (move) begin
            region_o      <= back ? region_o - BACK[REGION_BITS-1:0] : region_o + 1'b1;
            last_region_q <= region_o == BEFORE_LAST[REGION_BITS-1:0];
            if (row_end_i && last_line) row_o <= row_o + 1'b1;
        end
        if (rst_i || frame_end_o) region_o <= {REGION_BITS{1'b0}};
        if (rst_i) begin
            column_o      <= {COLUMN_BITS{1'b0}};
            last_region_q <= 1'b0;
            row_o         <= 2'd0;
        end
    end

endmodule

`default_nettype wire
