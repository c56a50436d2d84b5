// SPDX-License-Identifier: MIT OR Apache-2.0
// Keeps the outputs of one RPU of an array for one frame (docs/boards.md): decision, scores, and the pixels or means that it
// forwards. The RPU is selected in two steps, first in each row of regions, then among the rows, with a register after each.
`default_nettype none

module array_snapshot #(
    parameter COLUMNS = 4,      // regions in a row of regions
    parameter ROWS = 3,         // rows of regions
    parameter COLUMN_BITS = 2,  // bits of the number of a column of regions
    parameter ROW_BITS = 2,     // bits of the number of a row of regions
    parameter HEAD_BYTES = 3,   // bytes of a decision with its scores
    parameter PIXELS = 64,      // pixels of a region, 4 to 2048
    parameter COUNT_BITS = 7    // ceil(log2(PIXELS + 1))
) (
    input  wire                                 clk_i,            // clock, rising edge
    input  wire                                 rst_i,            // synchronous reset, active high
    input  wire                                 decided_i,        // decisions and scores of a frame are on head_i
    input  wire [COLUMNS*ROWS*HEAD_BYTES*8-1:0] head_i,           // decisions and scores; element i is of region i
    input  wire [             COLUMNS*ROWS-1:0] forward_valid_i,  // one bit per region: a pixel or a mean of it leaves
    input  wire [           COLUMNS*ROWS*8-1:0] forward_pixel_i,  // that pixel or mean; element i is of region i
    input  wire [              COLUMN_BITS-1:0] column_i,         // column of the region that is kept
    input  wire [                 ROW_BITS-1:0] row_i,            // row of the region that is kept
    input  wire [                          6:0] frame_i,          // number of the frame that is kept, modulo 128
    input  wire                                 start_i,          // the next frame with this number is kept
    output wire                                 captured_o,       // a whole frame of the region is kept
    output wire [                         31:0] number_o,         // number of the kept frame, from 0 on
    output wire [             HEAD_BYTES*8-1:0] head_o,           // decision and scores of the kept frame
    output wire [               COUNT_BITS-1:0] count_o,          // number of pixels or means that were forwarded of the kept frame
    input  wire [                          8:0] place_i,          // number of four pixels or means to be read
    output wire [                         31:0] word_o            // these four, one clock later, the first in the lowest bits
);

    // Limits: a value out of range stops elaboration at an instance of a module that does not exist.
    generate
        if (COLUMNS < 1) begin : g_columns COLUMNS_must_be_1_or_more u_refused (); end
        if (ROWS < 1) begin : g_rows ROWS_must_be_1_or_more u_refused (); end
        if (COLUMN_BITS < $clog2(COLUMNS) || COLUMN_BITS < 1) begin : g_column_bits COLUMN_BITS_must_hold_COLUMNS u_refused (); end
        if (ROW_BITS < $clog2(ROWS) || ROW_BITS < 1) begin : g_row_bits ROW_BITS_must_hold_ROWS u_refused (); end
        if (HEAD_BYTES < 1) begin : g_head HEAD_BYTES_must_be_1_or_more u_refused (); end
        if (PIXELS < 4 || PIXELS > 2048) begin : g_pixels PIXELS_must_be_4_to_2048 u_refused (); end
        if (COUNT_BITS != $clog2(PIXELS + 1)) begin : g_bits COUNT_BITS_must_be_clog2_of_PIXELS_plus_1 u_refused (); end
    endgenerate

    localparam HEAD_BITS = HEAD_BYTES * 8;
    localparam BITS = HEAD_BITS + 9;

    // The region that the host has chosen, and its outputs. A region that does not exist gives zeros.
    reg [COLUMNS-1:0] in_column_q;
    reg [ROWS-1:0] in_row_q;
    wire [BITS*ROWS-1:0] of_rows;
    genvar row, column;
    generate
        for (column = 0; column < COLUMNS; column = column + 1) begin : g_in_column
            always @(posedge clk_i) in_column_q[column] <= column_i == column[COLUMN_BITS-1:0];
        end
        for (row = 0; row < ROWS; row = row + 1) begin : g_in_row
            always @(posedge clk_i) in_row_q[row] <= row_i == row[ROW_BITS-1:0];
            integer at;
            reg [BITS-1:0] found, of_row_q;
            always @* begin
                found = {BITS{1'b0}};
                for (at = 0; at < COLUMNS; at = at + 1)
                if (in_column_q[at])
                    found = found | {forward_valid_i[row*COLUMNS+at], forward_pixel_i[(row*COLUMNS+at)*8+:8], head_i[(row*COLUMNS+at)*HEAD_BITS+:HEAD_BITS]};
            end
            always @(posedge clk_i) of_row_q <= found;
            assign of_rows[row*BITS+:BITS] = of_row_q;
        end
    endgenerate
    integer at_row;
    reg [BITS-1:0] chosen, chosen_q;
    always @* begin
        chosen = {BITS{1'b0}};
        for (at_row = 0; at_row < ROWS; at_row = at_row + 1) if (in_row_q[at_row]) chosen = chosen | of_rows[at_row*BITS+:BITS];
    end
    reg decided_first_q, decided_q;
    always @(posedge clk_i) begin
        chosen_q        <= chosen;
        decided_first_q <= decided_i && !rst_i;
        decided_q       <= decided_first_q && !rst_i;
    end
    wire leaves = chosen_q[BITS-1];
    wire [7:0] pixel = chosen_q[HEAD_BITS+:8];

    // Pixels and means come after their decision, the last of them with the next decision.
    reg waits_q, keeps_q, captured_q;
    reg [31:0] next_q, number_q;  // number of the next frame; number of the kept frame
    reg [HEAD_BITS-1:0] head_q;
    reg [COUNT_BITS-1:0] count_q;
    wire hit = decided_q && waits_q && next_q[6:0] == frame_i;
    wire keep = keeps_q && leaves;
    always @(posedge clk_i) begin
        if (decided_q) next_q <= next_q + 1'b1;
        if (keep) count_q <= count_q + 1'b1;
        if (keeps_q && decided_q) begin
            keeps_q    <= 1'b0;
            captured_q <= 1'b1;
        end
        if (hit) begin
            waits_q  <= 1'b0;
            keeps_q  <= 1'b1;
            head_q   <= chosen_q[HEAD_BITS-1:0];
            number_q <= next_q;
            count_q  <= {COUNT_BITS{1'b0}};
        end
        if (start_i) begin
            waits_q    <= 1'b1;
            keeps_q    <= 1'b0;
            captured_q <= 1'b0;
        end
        if (rst_i) begin
            waits_q    <= 1'b0;
            keeps_q    <= 1'b0;
            captured_q <= 1'b0;
            next_q     <= 32'd0;
            number_q   <= 32'd0;
            head_q     <= {HEAD_BITS{1'b0}};
            count_q    <= {COUNT_BITS{1'b0}};
        end
    end
    assign captured_o = captured_q;
    assign number_o = number_q;
    assign head_o = head_q;
    assign count_o = count_q;

    // A word is written with each of its pixels, so that the last word is written even if it is not full.
    localparam WORDS = (PIXELS + 3) / 4;
    localparam INDEX_BITS = WORDS > 1 ? $clog2(WORDS) : 1;
    reg [31:0] words_q[0:WORDS-1];
    reg [31:0] part_q, word_q;
    reg there_q;
    wire [31:0] part = count_q[1:0] == 2'd0 ? {24'd0, pixel} : part_q | ({24'd0, pixel} << {count_q[1:0], 3'd0});
    always @(posedge clk_i) begin
        if (keep) begin
            part_q                         <= part;
            words_q[count_q[INDEX_BITS+1:2]] <= part;
        end
        word_q  <= words_q[place_i[INDEX_BITS-1:0]];
        there_q <= {23'd0, place_i} < WORDS[31:0];
    end
    assign word_o = there_q ? word_q : 32'd0;

endmodule

`default_nettype wire
