// SPDX-License-Identifier: MIT OR Apache-2.0
// Decides when the `raster` core advances, and follows its place in the frame (docs/raster.md).
//
// The flags of a word leave with its advance. The flags of the windows and of the tail belong to earlier words: they are
// delayed by as many advances and rows as the windows lag behind.
`default_nettype none

module raster_control #(
    parameter ROW_WORDS = 240,    // words of a row of the padded frame
    parameter TAKEN_WORDS = 240,  // words of a row that are taken, at most ROW_WORDS
    parameter ROWS = 1080,        // rows of the padded frame
    parameter TAKEN_ROWS = 1080,  // rows that are taken, at most ROWS
    parameter WORD_BITS = 8,      // ceil(log2(ROW_WORDS))
    parameter ROW_BITS = 11,      // ceil(log2(ROWS))
    parameter SIDE = 8,           // rows of a region
    parameter SIDE_BITS = 3,      // ceil(log2(SIDE))
    parameter SEGMENT_WORDS = 8,  // words of a row of a region
    parameter SEGMENT_BITS = 3,   // ceil(log2(SEGMENT_WORDS)), at least 1
    parameter ISOLATED = 0,       // 1: windows end at the borders of regions; 0: at those of the frame
    parameter WINDOWS = 2,        // number of windows, one behind the other, 0 to 2
    parameter SETTLE = 20,        // clocks from the last advance of a frame until the next may begin
    parameter SETTLE_BITS = 5     // ceil(log2(SETTLE))
) (
    input  wire clk_i,            // clock, rising edge
    input  wire rst_i,            // synchronous reset, active high
    input  wire valid_i,          // a word is offered
    input  wire busy_i,           // the next frame may not begin yet
    output reg  ready_o,          // the offered word is taken
    output wire step_o,           // the core advances at this edge; the ports below belong to this advance
    output wire pad_o,            // the advance takes no word; right of the frame, the word is a copy of the last pixel of its row
    output wire taken_end_o,      // the word is the last that is taken of its row
    output wire repeat_o,         // the word is a copy of the word above it
    output wire [1:0] left_o,     // one bit per window: the center has nothing on its left
    output wire [1:0] right_o,    // one bit per window: the center has nothing on its right
    output wire [1:0] top_o,      // one bit per window: the center has nothing above it
    output wire [1:0] bottom_o,   // one bit per window: the center has nothing below it
    output wire tail_o,           // a word of the frame reaches the tail
    output wire segment_end_o,    // the word is the last of a row of its region
    output wire row_end_o,        // the word is the last of its row of the frame
    output wire region_top_o,     // the word is in the first row of its region
    output wire region_bottom_o,  // the word is in the last row of its region
    output wire frame_ends_o,     // the advance is the last of the frame
    output wire frame_over_o      // a frame is over at this edge, and the next may begin
);

    localparam LAST_SETTLE = SETTLE - 1;
    localparam BEFORE_LAST_WORD = ROW_WORDS - 2;
    localparam BEFORE_LAST_TAKEN = TAKEN_WORDS - 2;
    localparam BEFORE_LAST_ROW = ROWS - 2;
    localparam BEFORE_LAST_TAKEN_ROW = TAKEN_ROWS - 2;
    localparam BEFORE_LAST_SIDE = SIDE - 2;
    localparam BEFORE_LAST_IN_SEGMENT = SEGMENT_WORDS - 2;

    // The word of the next advance: its place, and flags of its being a last one.
    reg [WORD_BITS-1:0] word_q;
    reg [ROW_BITS-1:0]  row_q;
    reg [SIDE_BITS-1:0] side_q;
    reg                 row_end_q, bottom_row_q, region_bottom_q, top_row_q, region_top_q, real_q;
    reg                 taken_end_q, taken_bottom_q, taken_row_q;
    wire                segment_end;

    reg own_q;  // the core advances without a word from outside
    reg settling_q;                     // the last advance of the frame is done, and the next frame waits
    reg [SETTLE_BITS-1:0] settle_q;     // number of clocks that it still waits
    reg settled_q;                      // this number is 0; a register, so that no comparison is in front of ready_o

    wire step = own_q || (ready_o && valid_i);
    wire next_row = step && row_end_q;

    // Flags of earlier words and rows.
    reg [3:1] unit_end_q, old_segment_end_q, old_row_end_q;
    reg [2:1] old_top_q, old_bottom_q, old_real_q, old_region_top_q, old_region_bottom_q;
    wire frame_last;  // the next advance would be the last of the frame
    wire frame_ends;  // the last advance of the frame happens at this edge
    wire unused_late = old_segment_end_q[3] || old_row_end_q[3] || old_top_q[2] || old_bottom_q[2] || old_real_q[2]
                       || old_region_top_q[2] || old_region_bottom_q[2];
    wire unit_end = (ISOLATED ? segment_end : row_end_q) || frame_last;
    wire top = ISOLATED ? region_top_q : top_row_q;
    wire bottom = ISOLATED ? region_bottom_q : bottom_row_q;

    generate
        if (SEGMENT_WORDS > 1) begin : g_segment
            reg [SEGMENT_BITS-1:0] segment_q;
            reg segment_end_q;
            always @(posedge clk_i) begin
                if (step) begin
                    segment_q     <= segment_end_q ? {SEGMENT_BITS{1'b0}} : segment_q + 1'b1;
                    segment_end_q <= segment_q == BEFORE_LAST_IN_SEGMENT[SEGMENT_BITS-1:0];
                end
                if (rst_i || frame_ends) begin
                    segment_q     <= {SEGMENT_BITS{1'b0}};
                    segment_end_q <= 1'b0;
                end
            end
            assign segment_end = segment_end_q;
        end else begin : g_word
            assign segment_end = 1'b1;
        end

        if (WINDOWS == 0) begin : g_no_window
            assign frame_last = row_end_q && bottom_row_q;
            assign frame_ends = step && frame_last;
        end else begin : g_windows
            // Behind the last row the core advances at every clock, without words from outside.
            assign frame_last = !real_q && !old_real_q[WINDOWS] && old_row_end_q[WINDOWS];
            assign frame_ends = frame_last;
        end
    endgenerate

    always @(posedge clk_i) begin
        if (step) begin
            word_q    <= row_end_q ? {WORD_BITS{1'b0}} : word_q + 1'b1;
            row_end_q <= word_q == BEFORE_LAST_WORD[WORD_BITS-1:0];
            taken_end_q <= word_q == BEFORE_LAST_TAKEN[WORD_BITS-1:0];
            unit_end_q        <= {unit_end_q[2:1], unit_end};
            old_segment_end_q <= {old_segment_end_q[2:1], segment_end};
            old_row_end_q     <= {old_row_end_q[2:1], row_end_q};
        end
        if (next_row) begin
            row_q           <= row_q + 1'b1;
            top_row_q       <= 1'b0;
            bottom_row_q    <= row_q == BEFORE_LAST_ROW[ROW_BITS-1:0];
            taken_bottom_q  <= row_q == BEFORE_LAST_TAKEN_ROW[ROW_BITS-1:0];
            side_q          <= region_bottom_q ? {SIDE_BITS{1'b0}} : side_q + 1'b1;
            region_top_q    <= region_bottom_q;
            region_bottom_q <= side_q == BEFORE_LAST_SIDE[SIDE_BITS-1:0];
            if (bottom_row_q) real_q <= 1'b0;
            if (taken_bottom_q) taken_row_q <= 1'b0;
            old_top_q           <= {old_top_q[1], top};
            old_bottom_q        <= {old_bottom_q[1], bottom};
            old_real_q          <= {old_real_q[1], real_q};
            old_region_top_q    <= {old_region_top_q[1], region_top_q};
            old_region_bottom_q <= {old_region_bottom_q[1], region_bottom_q};
        end
        if (rst_i || frame_ends) begin
            word_q          <= {WORD_BITS{1'b0}};
            row_q           <= {ROW_BITS{1'b0}};
            side_q          <= {SIDE_BITS{1'b0}};
            row_end_q       <= 1'b0;
            taken_end_q     <= TAKEN_WORDS == 1;
            top_row_q       <= 1'b1;
            bottom_row_q    <= ROWS == 1;
            taken_bottom_q  <= TAKEN_ROWS == 1;
            region_top_q    <= 1'b1;
            region_bottom_q <= 1'b0;
            real_q          <= 1'b1;
            taken_row_q     <= 1'b1;
        end
        if (rst_i) begin
            unit_end_q <= 3'b111;
            old_real_q <= 2'b00;
        end
    end

    // Decides whether the next advance takes a word or happens without one.
    wire last_taken = TAKEN_WORDS == ROW_WORDS ? row_end_q && taken_bottom_q : taken_end_q;
    always @(posedge clk_i) begin
        if (ready_o && valid_i && last_taken) begin
            ready_o <= 1'b0;
            own_q   <= 1'b1;
        end
        if (TAKEN_WORDS != ROW_WORDS && own_q && row_end_q && taken_row_q && !taken_bottom_q) begin
            ready_o <= 1'b1;
            own_q   <= 1'b0;
        end
        if (frame_ends) begin
            ready_o    <= 1'b0;
            own_q      <= 1'b0;
            settling_q <= 1'b1;
            settle_q   <= LAST_SETTLE[SETTLE_BITS-1:0];
            settled_q  <= LAST_SETTLE == 0;
        end else if (settling_q) begin
            settle_q <= settle_q - 1'b1;
            if (settle_q == {{(SETTLE_BITS - 1) {1'b0}}, 1'b1}) settled_q <= 1'b1;
            if (frame_over_o) begin
                settling_q <= 1'b0;
                ready_o    <= 1'b1;
            end
        end
        if (rst_i) begin
            ready_o    <= 1'b1;
            own_q      <= 1'b0;
            settling_q <= 1'b0;
        end
    end

    assign step_o = step;
    assign frame_ends_o = frame_ends;
    assign frame_over_o = settling_q && settled_q && !busy_i;
    assign pad_o = own_q;
    assign taken_end_o = taken_end_q;
    assign repeat_o = !taken_row_q;
    assign right_o = unit_end_q[2:1];
    assign left_o = unit_end_q[3:2];

    generate
        if (WINDOWS < 2) begin : g_one
            assign top_o = {1'b0, old_top_q[1]};
            assign bottom_o = {1'b0, old_bottom_q[1]};
        end else begin : g_two
            reg top_2q, bottom_2q;
            always @(posedge clk_i) if (step) {top_2q, bottom_2q} <= {old_top_q[2], old_bottom_q[2]};
            assign top_o = {top_2q, old_top_q[1]};
            assign bottom_o = {bottom_2q, old_bottom_q[1]};
        end
        if (WINDOWS == 0) begin : g_tail_direct
            assign tail_o = step;
            assign segment_end_o = segment_end;
            assign row_end_o = row_end_q;
            assign region_top_o = region_top_q;
            assign region_bottom_o = region_bottom_q;
        end else begin : g_tail_late
            // The flags are delayed by as many advances as there are windows.
            reg [2:0] held_q, held_2q;
            wire [2:0] held = WINDOWS == 1 ? held_q : held_2q;
            always @(posedge clk_i) begin
                if (step) begin
                    held_q  <= {old_real_q[WINDOWS], old_region_top_q[WINDOWS], old_region_bottom_q[WINDOWS]};
                    held_2q <= held_q;
                end
                if (rst_i) begin
                    held_q  <= 3'b000;
                    held_2q <= 3'b000;
                end
            end
            assign tail_o = step && held[2];
            assign region_top_o = held[1];
            assign region_bottom_o = held[0];
            assign segment_end_o = old_segment_end_q[WINDOWS];
            assign row_end_o = old_row_end_q[WINDOWS];
        end
    endgenerate

endmodule

`default_nettype wire
