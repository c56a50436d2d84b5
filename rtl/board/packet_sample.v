// SPDX-License-Identifier: MIT OR Apache-2.0
// Copies some of the packets that pass to a slow line (docs/boards.md). A packet that begins while no packet waits here is
// kept whole; other packets are not copied.
`default_nettype none

module packet_sample #(
    parameter WORDS = 64,      // words of the longest packet, at least 2
    parameter WORD_BITS = 6    // ceil(log2(WORDS))
) (
    input  wire        clk_i,    // clock, rising edge
    input  wire        rst_i,    // synchronous reset, active high
    input  wire [63:0] data_i,   // a word of a packet that passes
    input  wire        valid_i,  // a word of a packet is on data_i, and is taken
    input  wire        last_i,   // the word is the last of its packet
    output wire [63:0] data_o,   // a word of the kept packet
    output wire        valid_o,  // a word is on data_o, until it is taken
    output wire        last_o,   // the word is the last of the kept packet
    input  wire        ready_i   // the sink takes the word
);

    // Limits: a value out of range stops elaboration at an instance of a module that does not exist.
    generate
        if (WORDS < 2) begin : g_words WORDS_must_be_2_or_more u_refused (); end
        if (WORD_BITS != $clog2(WORDS)) begin : g_word_bits WORD_BITS_must_be_clog2_of_WORDS u_refused (); end
    endgenerate

    reg [63:0] words_q[0:WORDS-1];
    reg inside_q;                  // the passing packet is between its first and last word
    reg keeps_q;                   // the passing packet is kept
    reg full_q;                    // a kept packet waits
    reg fetched_q;                 // the next word of the kept packet has been read
    reg [WORD_BITS-1:0] last_q;    // place of the last word of the kept packet
    reg [WORD_BITS-1:0] place_q;   // place of the next word, written or read
    reg [63:0] word_q;

    wire first = !inside_q;
    wire keep = first ? !full_q : keeps_q;
    wire put = valid_i && keep;
    wire take = valid_o && ready_i;
    assign data_o = word_q;
    assign valid_o = full_q && fetched_q;
    assign last_o = place_q == last_q;

    wire [WORD_BITS-1:0] next = put ? place_q : take ? place_q + 1'b1 : place_q;
    always @(posedge clk_i) begin
        if (put) words_q[place_q] <= data_i;
        word_q <= words_q[next];
    end

    always @(posedge clk_i) begin
        if (valid_i) begin
            inside_q <= !last_i;
            keeps_q  <= keep;
        end
        if (put) begin
            place_q <= last_i ? {WORD_BITS{1'b0}} : place_q + 1'b1;
            if (last_i) begin
                full_q    <= 1'b1;
                fetched_q <= 1'b0;
                last_q    <= place_q;
            end
        end
        if (full_q) fetched_q <= 1'b1;
        if (take) begin
            place_q <= last_o ? {WORD_BITS{1'b0}} : place_q + 1'b1;
            if (last_o) full_q <= 1'b0;
        end
        if (rst_i) begin
            inside_q  <= 1'b0;
            full_q    <= 1'b0;
            fetched_q <= 1'b0;
            place_q   <= {WORD_BITS{1'b0}};
        end
    end

endmodule

`default_nettype wire
