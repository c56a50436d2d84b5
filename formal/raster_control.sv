// SPDX-License-Identifier: MIT OR Apache-2.0
// The advances of a frame by docs/raster.md: which of them takes a word, when the core is ready, and the flags of each. Gaps of
// any length, frames without end, and a core that is busy for any time between frames.
module properties #(
    parameter WINDOWS = 2, parameter ISOLATED = 0, parameter TAKEN_WORDS = 3, parameter TAKEN_ROWS = 3
) (
    input wire clk_i, rst_i, valid, busy
);
    `include "reset.vh"
    localparam SIDE = 2, SEGMENT_WORDS = SIDE, ROW_WORDS = 4, ROWS = 4, SETTLE = 3;
    localparam WORDS = ROW_WORDS * ROWS, LAG = ROW_WORDS + 1, LAST = WORDS + WINDOWS * LAG - 1;
    wire ready, step, pad, taken_end, repeated, tail, segment_end, row_end, region_top, region_bottom, over;
    wire [1:0] left, right, top, bottom;
    raster_control #(
        .ROW_WORDS(ROW_WORDS), .TAKEN_WORDS(TAKEN_WORDS), .ROWS(ROWS), .TAKEN_ROWS(TAKEN_ROWS), .WORD_BITS(2), .ROW_BITS(2),
        .SIDE(SIDE), .SIDE_BITS(1), .SEGMENT_WORDS(SEGMENT_WORDS), .SEGMENT_BITS(1), .ISOLATED(ISOLATED), .WINDOWS(WINDOWS),
        .SETTLE(SETTLE), .SETTLE_BITS(2)
    ) dut (
        .clk_i(clk_i), .rst_i(rst_i), .valid_i(valid), .busy_i(busy), .ready_o(ready), .step_o(step), .pad_o(pad),
        .taken_end_o(taken_end), .repeat_o(repeated), .left_o(left), .right_o(right), .top_o(top), .bottom_o(bottom),
        .tail_o(tail), .segment_end_o(segment_end), .row_end_o(row_end), .region_top_o(region_top),
        .region_bottom_o(region_bottom), .frame_over_o(over)
    );

    // The number of the next advance; after the last one, the number of clocks since then.
    reg [4:0] advance = 5'd0;
    reg settles = 1'b0;
    reg [2:0] settled;
    wire is_word, is_tail;  // the advance brings a word of the frame; the advance brings a word to the tail
    wire [1:0] column, row, tail_column, tail_row;
    place #(.LAG(0)) here (.advance(advance), .is_word(is_word), .column(column), .row(row));
    place #(.LAG(WINDOWS * LAG)) in_tail (.advance(advance), .is_word(is_tail), .column(tail_column), .row(tail_row));

    wire takes = is_word && column < TAKEN_WORDS && row < TAKEN_ROWS;
    always @(posedge clk_i) begin
        if (step) begin
            advance <= advance == LAST ? 5'd0 : advance + 5'd1;
            if (advance == LAST) begin
                settles <= 1'b1;
                settled <= 3'd0;
            end
        end
        if (settles && settled != SETTLE - 1) settled <= settled + 3'd1;
        if (over) settles <= 1'b0;
        if (rst_i) begin
            advance <= 5'd0;
            settles <= 1'b0;
        end
    end

    always @* if (started && !rst_i) begin
        assert(ready == (!settles && takes));
        assert(step == (!settles && (!takes || valid)));
        assert(over == (settles && settled == SETTLE - 1 && !busy));
        if (step && is_word) begin
            assert(pad == !takes);
            assert(repeated == (row >= TAKEN_ROWS));
            if (takes) assert(taken_end == (column == TAKEN_WORDS - 1));
        end
        assert(tail == (step && is_tail));
        if (tail) begin
            assert(segment_end == (tail_column % SEGMENT_WORDS == SEGMENT_WORDS - 1));
            assert(row_end == (tail_column == ROW_WORDS - 1));
            assert(region_top == (tail_row % SIDE == 0));
            assert(region_bottom == (tail_row % SIDE == SIDE - 1));
        end
    end

    // The center of a window is one row and one word before the word that enters it, and the column of the next word is beside the
    // center. A border is that of the region or of the frame.
    genvar window;
    generate
        for (window = 0; window < WINDOWS; window = window + 1) begin : g_window
            wire has_center, has_next;
            wire [1:0] center_column, center_row, next_column, next_row;
            place #(.LAG((window + 1) * LAG)) center (
                .advance(advance), .is_word(has_center), .column(center_column), .row(center_row)
            );
            place #(.LAG((window + 1) * LAG - 1)) after (
                .advance(advance), .is_word(has_next), .column(next_column), .row(next_row)
            );
            always @* if (started && !rst_i && step) begin
                if (has_center) begin
                    assert(left[window] == (ISOLATED ? center_column % SEGMENT_WORDS == 0 : center_column == 0));
                    assert(right[window] == (ISOLATED ? center_column % SEGMENT_WORDS == SEGMENT_WORDS - 1 : center_column == ROW_WORDS - 1));
                end
                if (has_next) begin
                    assert(top[window] == (ISOLATED ? next_row % SIDE == 0 : next_row == 0));
                    assert(bottom[window] == (ISOLATED ? next_row % SIDE == SIDE - 1 : next_row == ROWS - 1));
                end
            end
        end
    endgenerate
endmodule

// Returns whether the word of a number of advances before is one of the frame, and its place.
module place #(parameter LAG = 0) (
    input wire [4:0] advance, output wire is_word, output wire [1:0] column, row
);
    localparam ROW_WORDS = 4, ROWS = 4;
    wire [4:0] number = advance - LAG;
    assign is_word = advance >= LAG && number < ROW_WORDS * ROWS;
    assign column = number % ROW_WORDS;
    assign row = number / ROW_WORDS;
endmodule
