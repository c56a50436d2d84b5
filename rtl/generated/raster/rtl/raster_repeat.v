// SPDX-License-Identifier: MIT OR Apache-2.0
// Passes a word, or repeats the word above it. It makes the rows beyond the lower border of a frame for cores in which no
// window keeps a row of the frame. word_o belongs to the same step.
`default_nettype none

module raster_repeat #(
    parameter WORD_BITS = 8,    // bits of a word
    parameter ROW_WORDS = 240,  // words of a row, at least 8
    parameter ADDRESS_BITS = 8  // ceil(log2(ROW_WORDS))
) (
    input  wire                 clk_i,     // clock, rising edge
    input  wire                 rst_i,     // synchronous reset, active high
    input  wire                 step_i,    // a word comes in
    input  wire                 repeat_i,  // the word is to be a copy of the word above it
    input  wire [WORD_BITS-1:0] word_i,    // the word that comes in, without repeat_i
    output wire [WORD_BITS-1:0] word_o     // the word of the padded frame
);

    // Limits: a value out of range stops elaboration at an instance of a module that does not exist.
    generate
        if (ROW_WORDS < 8) begin : g_row_words ROW_WORDS_must_be_8_or_more u_refused (); end
    endgenerate

    localparam LAST = ROW_WORDS - 1;

    reg [ADDRESS_BITS-1:0] place_q;
    wire [ADDRESS_BITS-1:0] next = place_q == LAST[ADDRESS_BITS-1:0] ? {ADDRESS_BITS{1'b0}} : place_q + 1'b1;
    wire [WORD_BITS-1:0] above;

    always @(posedge clk_i) begin
        if (rst_i) place_q <= {ADDRESS_BITS{1'b0}};
        else if (step_i) place_q <= next;
    end

    // The word above is read one word ahead.
    raster_memory #(.WIDTH(WORD_BITS), .WORDS(ROW_WORDS), .ADDRESS_BITS(ADDRESS_BITS)) u_row (
        .clk_i(clk_i), .write_i(step_i), .write_address_i(place_q), .data_i(word_o),
        .read_i(1'b1), .read_address_i(step_i ? next : place_q), .output_i(1'b1), .data_o(above)
    );

    assign word_o = repeat_i ? above : word_i;

endmodule

`default_nettype wire
