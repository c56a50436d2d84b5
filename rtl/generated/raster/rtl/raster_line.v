// SPDX-License-Identifier: MIT OR Apache-2.0
// Delays words by one row and one word: word_o is the word of ROW_WORDS + 1 steps ago. A memory
// holds one row of words.
`default_nettype none

module raster_line #(
    parameter WORD_BITS = 8,    // bits of a word
    parameter ROW_WORDS = 240,  // words of a row, at least 8
    parameter ADDRESS_BITS = 8  // ceil(log2(ROW_WORDS))
) (
    input  wire                 clk_i,   // clock, rising edge
    input  wire                 rst_i,   // synchronous reset, active high
    input  wire                 step_i,  // a word comes in
    input  wire [WORD_BITS-1:0] word_i,  // the word that comes in
    output wire [WORD_BITS-1:0] word_o   // the word of ROW_WORDS + 1 steps ago
);

    // Limits: a value out of range stops elaboration at an instance of a module that does not exist.
    generate
        if (ROW_WORDS < 8) begin : g_row_words ROW_WORDS_must_be_8_or_more u_refused (); end
    endgenerate

    wire [ADDRESS_BITS-1:0] place;
    reg [ADDRESS_BITS-1:0] old_place_q;
    reg step_q;
    reg [WORD_BITS-1:0] word_q;

    raster_ring #(.WORDS(ROW_WORDS), .PLACE_BITS(ADDRESS_BITS)) u_place (
        .clk_i(clk_i), .rst_i(rst_i), .step_i(step_i), .place_o(place)
    );

    always @(posedge clk_i) begin
        step_q      <= step_i && !rst_i;
        word_q      <= word_i;
        old_place_q <= place;
    end

    raster_memory #(.WIDTH(WORD_BITS), .WORDS(ROW_WORDS), .ADDRESS_BITS(ADDRESS_BITS)) u_words (
        .clk_i(clk_i), .write_i(step_q), .write_address_i(old_place_q), .data_i(word_q),
        .read_i(step_i), .read_address_i(place), .output_i(1'b1), .data_o(word_o)
    );

endmodule

`default_nettype wire
