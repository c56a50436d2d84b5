// SPDX-License-Identifier: MIT OR Apache-2.0
// Counts the places of a memory whose words are used in turn, again and again. place_o is the place of the word of
// step_i.
`default_nettype none

module raster_ring #(
    parameter WORDS = 30720,   // words of the memory, at least 2
    parameter PLACE_BITS = 15  // ceil(log2(WORDS))
) (
    input  wire                  clk_i,   // clock, rising edge
    input  wire                  rst_i,   // synchronous reset, active high
    input  wire                  step_i,  // a word is taken at this edge
    output reg  [PLACE_BITS-1:0] place_o  // place of that word
);

    // Limits: a value out of range stops elaboration at an instance of a module that does not exist.
    generate
        if (WORDS < 2) begin : g_words WORDS_must_be_2_or_more u_refused (); end
        if (PLACE_BITS != $clog2(WORDS)) begin : g_place_bits PLACE_BITS_must_be_clog2_of_WORDS u_refused (); end
    endgenerate

    localparam BEFORE_LAST = WORDS - 2;
    reg end_q;

    always @(posedge clk_i) begin
        if (step_i) begin
            place_o <= end_q ? {PLACE_BITS{1'b0}} : place_o + 1'b1;
            end_q   <= place_o == BEFORE_LAST[PLACE_BITS-1:0];
        end
        if (rst_i) begin
            place_o <= {PLACE_BITS{1'b0}};
            end_q   <= 1'b0;
        end
    end

endmodule

`default_nettype wire
