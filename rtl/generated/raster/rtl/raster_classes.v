// SPDX-License-Identifier: MIT OR Apache-2.0
// The classes of the regions of a `raster` core with zones, each at the clock at which a part of the core needs it. It follows
// the words that reach the tail, and reads the class of the next one from the memory of classes.
`default_nettype none

module raster_classes #(
    parameter COLUMNS = 28,          // regions in a row of regions
    parameter ROWS = 28,             // rows of regions
    parameter REGION_BITS = 10,      // ceil(log2(COLUMNS * ROWS))
    parameter ADDRESS_BITS = 6,      // bits of the number of a word of the map
    parameter [2*COLUMNS*ROWS-1:0] CLASSES = 0,  // the first map, region 0 in the lowest bits
    parameter CENTER_CLOCKS = 1,     // from a step of the tail to the center of its word
    parameter STORE_CLOCKS = 2,      // from the center to the word that is stored
    parameter HIT_CLOCKS = 4,        // from the center to its hits
    parameter SETTLED_CLOCKS = 0,    // from the counts of a region to its last score without a second pass
    parameter DEEP = 0               // 1: more registers, for a faster clock
) (
    input  wire                    clk_i,            // clock, rising edge
    input  wire                    rst_i,            // synchronous reset, active high
    input  wire                    write_i,          // a word of the map is written
    input  wire [ADDRESS_BITS-1:0] address_i,        // number of that word
    input  wire [            31:0] word_i,           // classes of 16 regions, the first one in the lowest bits
    input  wire                    commit_i,         // frames use the map that has been written
    output wire                    pending_o,        // the committed map is not in use yet
    input  wire                    advance_i,        // the core advances
    input  wire                    frame_ends_i,     // the core advances for the last time in this frame
    input  wire                    step_i,           // a word of the frame reaches the tail
    input  wire                    segment_end_i,    // the word is the last of a row of its region
    input  wire                    row_end_i,        // the word is the last of its row of the frame
    input  wire                    region_bottom_i,  // the word is in the last row of its region
    output wire [             1:0] corner_class_o,   // class of the word that the windows take as their newest
    output wire [             1:0] edge_class_o,     // class of the word whose gradients are compared with a level
    output wire [             1:0] change_class_o,   // class of the word that is compared with its reference
    output wire [             1:0] summary_class_o,  // class of the region whose mean is compared with the one that was sent
    output wire [             1:0] settled_class_o   // class of the region whose scores without a second pass are there
);

    localparam LAST_REGION = COLUMNS * ROWS - 1;
    localparam CORNER_CLOCKS = CENTER_CLOCKS > 0 ? CENTER_CLOCKS - 1 : 0;
    localparam EDGE_CLOCKS = CENTER_CLOCKS + 3;
    localparam CHANGE_CLOCKS = CENTER_CLOCKS + STORE_CLOCKS + 1;
    localparam SUMMARY_CLOCKS = CENTER_CLOCKS + STORE_CLOCKS + DEEP + 3;
    localparam SCORE_CLOCKS = CENTER_CLOCKS + HIT_CLOCKS + DEEP + 2 + SETTLED_CLOCKS;

    // A frame uses its map from its first advance to its last one.
    reg in_frame_q;
    wire in_frame = in_frame_q || advance_i;
    always @(posedge clk_i) in_frame_q <= in_frame && !frame_ends_i && !rst_i;

    // The region of the next word.
    reg [REGION_BITS-1:0] region_q, row_q;
    reg [REGION_BITS-1:0] region;
    wire rows_end = row_end_i && region_bottom_i;
    wire [REGION_BITS-1:0] following = region_q == LAST_REGION[REGION_BITS-1:0] ? {REGION_BITS{1'b0}} : region_q + 1'b1;
    always @* begin
        region = region_q;
        if (step_i && segment_end_i) region = row_end_i && !region_bottom_i ? row_q : following;
        if (rst_i) region = {REGION_BITS{1'b0}};
    end
    always @(posedge clk_i) begin
        region_q <= region;
        if (rst_i || (step_i && rows_end)) row_q <= region;
    end

    wire [1:0] next_class;
    class_memory #(
        .REGIONS(COLUMNS * ROWS), .REGION_BITS(REGION_BITS), .ADDRESS_BITS(ADDRESS_BITS), .CLASSES(CLASSES)
    ) u_memory (
        .clk_i(clk_i), .rst_i(rst_i), .write_i(write_i), .address_i(address_i), .word_i(word_i), .commit_i(commit_i),
        .pending_o(pending_o), .occupied_i(in_frame), .region_i(region), .class_o(next_class)
    );

    // While a word is the center of the windows, the word after it is their newest one, and next_class, delayed by CORNER_CLOCKS, is the
    // class of that word.
    word_delay #(.WIDTH(2), .DEPTH(CORNER_CLOCKS)) u_corner (
        .clk_i(clk_i), .data_i(next_class), .data_o(corner_class_o)
    );
    word_delay #(.WIDTH(2), .DEPTH(EDGE_CLOCKS - CORNER_CLOCKS)) u_edge (
        .clk_i(clk_i), .data_i(corner_class_o), .data_o(edge_class_o)
    );
    word_delay #(.WIDTH(2), .DEPTH(CHANGE_CLOCKS - EDGE_CLOCKS)) u_change (
        .clk_i(clk_i), .data_i(edge_class_o), .data_o(change_class_o)
    );
    word_delay #(.WIDTH(2), .DEPTH(SUMMARY_CLOCKS - CHANGE_CLOCKS)) u_summary (
        .clk_i(clk_i), .data_i(change_class_o), .data_o(summary_class_o)
    );
    word_delay #(.WIDTH(2), .DEPTH(SCORE_CLOCKS - SUMMARY_CLOCKS)) u_settled (
        .clk_i(clk_i), .data_i(summary_class_o), .data_o(settled_class_o)
    );

endmodule

`default_nettype wire
