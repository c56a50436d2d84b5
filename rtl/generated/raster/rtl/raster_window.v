// SPDX-License-Identifier: MIT OR Apache-2.0
// Makes the columns of 3x3 windows from a stream of words: each word with the words one and two rows above it, and flags
// for rows that do not exist. A column comes one clock after its word, with DEEP three. The module that takes a column uses
// the middle word in place of a missing one, because there this often costs no logic.
//
// One memory holds both rows: a word is read together with the one above it, and written back one row further down.
`default_nettype none

module raster_window #(
    parameter WORD_BITS = 8,    // bits of a word
    parameter ROW_WORDS = 240,  // words of a row, at least 8
    parameter ADDRESS_BITS = 8, // ceil(log2(ROW_WORDS))
    parameter REPEATS = 0,      // 1: rows may be repeated
    parameter DEEP = 0          // 0: a column comes one clock after its word; 1: three clocks
) (
    input  wire                 clk_i,     // clock, rising edge
    input  wire                 rst_i,     // synchronous reset, active high
    input  wire                 step_i,    // a word comes in
    input  wire [WORD_BITS-1:0] word_i,    // the word that comes in
    input  wire                 top_i,     // there is no row above the middle
    input  wire                 bottom_i,  // there is no row below the middle
    input  wire                 repeat_i,  // the word above comes in again, instead of word_i (REPEATS)
    output wire                 step_o,    // a column comes out
    output wire                 top_o,     // there is no row above the middle of this column
    output wire                 bottom_o,  // there is no row below the middle of this column
    output wire [WORD_BITS-1:0] upper_o,   // upper word of the column; any word with top_o
    output wire [WORD_BITS-1:0] middle_o,  // middle word of the column
    output wire [WORD_BITS-1:0] lower_o    // lower word of the column; any word with bottom_o
);

    // Limits: a value out of range stops elaboration at an instance of a module that does not exist.
    generate
        if (ROW_WORDS < 8) begin : g_row_words ROW_WORDS_must_be_8_or_more u_refused (); end
    endgenerate

    localparam BEFORE_LAST = ROW_WORDS - 2;

    // The place in the row. Any initial place is right, because words of an earlier frame are never used.
    reg [ADDRESS_BITS-1:0] place_q = {ADDRESS_BITS{1'b0}};
    reg at_end_q = 1'b0;

    always @(posedge clk_i) begin
        if (step_i) begin
            place_q  <= at_end_q ? {ADDRESS_BITS{1'b0}} : place_q + 1'b1;
            at_end_q <= place_q == BEFORE_LAST[ADDRESS_BITS-1:0];
        end
        if (rst_i) begin
            place_q  <= {ADDRESS_BITS{1'b0}};
            at_end_q <= 1'b0;
        end
    end

    wire [WORD_BITS-1:0] middle;
    wire [WORD_BITS-1:0] above;
    wire                 write;
    wire [ADDRESS_BITS-1:0] write_place;
    wire [WORD_BITS-1:0] incoming;

    raster_memory #(
        .WIDTH(2 * WORD_BITS), .WORDS(ROW_WORDS), .ADDRESS_BITS(ADDRESS_BITS), .OUTPUT_STAGE(DEEP)
    ) u_rows (
        .clk_i(clk_i), .write_i(write), .write_address_i(write_place), .data_i({middle, incoming}),
        .read_i(step_i), .read_address_i(place_q), .output_i(1'b1), .data_o({above, middle})
    );

    reg                    step_q;
    reg [WORD_BITS-1:0]    word_q;
    reg [ADDRESS_BITS-1:0] old_place_q;
    reg                    top_q, bottom_q, repeat_q;
    always @(posedge clk_i) begin
        step_q      <= step_i && !rst_i;
        word_q      <= word_i;
        old_place_q <= place_q;
        top_q       <= top_i;
        bottom_q    <= bottom_i;
        repeat_q    <= repeat_i;
    end

    generate
        if (DEEP) begin : g_deep
            reg                    step_2q;
            reg [WORD_BITS-1:0]    word_2q;
            reg [ADDRESS_BITS-1:0] old_place_2q;
            reg                    top_2q, bottom_2q, repeat_2q;
            reg                    step_3q, top_3q, bottom_3q;
            reg [WORD_BITS-1:0]    upper_q, middle_q, lower_q;
            always @(posedge clk_i) begin
                step_2q      <= step_q && !rst_i;
                word_2q      <= word_q;
                old_place_2q <= old_place_q;
                top_2q       <= top_q;
                bottom_2q    <= bottom_q;
                repeat_2q    <= repeat_q;
                step_3q      <= step_2q && !rst_i;
                top_3q       <= top_2q;
                bottom_3q    <= bottom_2q;
                upper_q      <= above;
                middle_q     <= middle;
                lower_q      <= incoming;
            end
            assign incoming = REPEATS && repeat_2q ? middle : word_2q;
            assign write = step_2q;
            assign write_place = old_place_2q;
            assign step_o = step_3q;
            assign top_o = top_3q;
            assign bottom_o = bottom_3q;
            assign upper_o = upper_q;
            assign middle_o = middle_q;
            assign lower_o = lower_q;
        end else begin : g_plain
            assign incoming = REPEATS && repeat_q ? middle : word_q;
            assign write = step_q;
            assign write_place = old_place_q;
            assign step_o = step_q;
            assign top_o = top_q;
            assign bottom_o = bottom_q;
            assign upper_o = above;
            assign middle_o = middle;
            assign lower_o = incoming;
        end
    endgenerate

endmodule

`default_nettype wire
