// SPDX-License-Identifier: MIT OR Apache-2.0
// A part of the core that works on a word, so many clocks after the word reached the tail, has the class of the region of the word.
// The words come row by row, with gaps of any length; a word of every frame may be the first after a reset. The map stays as it
// is, because class_memory is proven by itself.
module properties #(
    parameter COLUMNS = 4, parameter ROWS = 2, parameter WORDS = 2, parameter SIDE = 2, parameter CENTER_CLOCKS = 1, parameter DEEP = 0
) (
    input wire clk_i, rst_i, step, leads
);
    `include "reset.vh"
    localparam STORE_CLOCKS = 2 + DEEP, HIT_CLOCKS = 4 + DEEP, REGIONS = COLUMNS * ROWS;
    localparam [2*REGIONS-1:0] CLASSES = {REGIONS{6'b110110}};

    // The place of the next word: in the row of its region, and the row, column and line of that.
    reg [1:0] word = 0, line = 0;
    reg [2:0] column = 0, row = 0;
    wire segment_end = word == WORDS - 1;
    wire row_end = segment_end && column == COLUMNS - 1;
    wire bottom = line == SIDE - 1;
    wire frame_end = row_end && bottom && row == ROWS - 1;
    always @(posedge clk_i) begin
        if (step) begin
            word <= segment_end ? 0 : word + 1;
            if (segment_end) column <= row_end ? 0 : column + 1;
            if (row_end) line <= bottom ? 0 : line + 1;
            if (row_end && bottom) row <= frame_end ? 0 : row + 1;
        end
        if (rst_i) {word, line, column, row} <= 0;
    end
    wire [2*REGIONS-1:0] shifted = CLASSES >> (2 * (row * COLUMNS + column));
    wire [1:0] region_class = shifted[1:0];

    wire pending;
    wire [1:0] corner, edge_class, change, summary, settled;
    raster_classes #(
        .COLUMNS(COLUMNS), .ROWS(ROWS), .REGION_BITS($clog2(REGIONS)), .ADDRESS_BITS(1), .CLASSES(CLASSES),
        .CENTER_CLOCKS(CENTER_CLOCKS), .STORE_CLOCKS(STORE_CLOCKS), .HIT_CLOCKS(HIT_CLOCKS), .SETTLED_CLOCKS(1), .DEEP(DEEP)
    ) dut (
        .clk_i(clk_i), .rst_i(rst_i), .write_i(1'b0), .address_i(1'b0), .word_i(32'd0), .commit_i(1'b0), .pending_o(pending),
        .advance_i(step || leads), .frame_ends_i(step && frame_end), .step_i(step), .segment_end_i(segment_end),
        .row_end_i(row_end), .region_bottom_i(bottom), .corner_class_o(corner), .edge_class_o(edge_class),
        .change_class_o(change), .summary_class_o(summary), .settled_class_o(settled)
    );

    // The class of the next word, of so many clocks ago.
    localparam LAST = CENTER_CLOCKS + HIT_CLOCKS + DEEP + 2 + 1;
    reg [2*LAST+1:0] earlier;
    reg [LAST:0] known = 0;  // no reset since then
    wire [2*LAST+1:0] classes = {earlier, region_class};
    wire [LAST:0] is_known = {known, started && !rst_i};
    always @(posedge clk_i) begin
        earlier <= classes;
        known <= rst_i ? 0 : is_known;
    end
    localparam CORNER = CENTER_CLOCKS > 0 ? CENTER_CLOCKS - 1 : 0;
    always @* if (started) begin
        assert(!pending);
        if (is_known[CORNER] && !rst_i) assert(corner == classes[2*CORNER+:2]);
        if (is_known[CENTER_CLOCKS+3]) assert(edge_class == classes[2*(CENTER_CLOCKS+3)+:2]);
        if (is_known[CENTER_CLOCKS+STORE_CLOCKS+1]) assert(change == classes[2*(CENTER_CLOCKS+STORE_CLOCKS+1)+:2]);
        if (is_known[CENTER_CLOCKS+STORE_CLOCKS+DEEP+3]) assert(summary == classes[2*(CENTER_CLOCKS+STORE_CLOCKS+DEEP+3)+:2]);
        if (is_known[LAST]) assert(settled == classes[2*LAST+:2]);
    end
endmodule
