// SPDX-License-Identifier: MIT OR Apache-2.0
// The words of a frame in a memory of one port, read and written in the order of the frame. A word of the
// memory holds two: the pair is read when its first word will be asked for next, and written when its
// second one has come. A write waits a clock where a pair is read at the same edge.
`default_nettype none

module raster_pairs #(
    parameter WORD_BITS = 8,   // bits of a word
    parameter WORDS = 76800    // words of a frame, at least 4
) (
    input  wire                 clk_i,        // clock, rising edge
    input  wire                 rst_i,        // synchronous reset, active high
    input  wire                 read_i,       // the next word is asked for
    output reg  [WORD_BITS-1:0] reference_o,  // it, until the next one is asked for
    input  wire                 write_i,      // the next word to store is there
    input  wire [WORD_BITS-1:0] word_i        // it
);

    // Limits: out of them elaboration stops at a module that does not exist.
    generate
        if (WORDS < 4) begin : g_words WORDS_must_be_4_or_more u_refused (); end
    endgenerate

    localparam PAIRS = (WORDS + 1) / 2;
    localparam PAIR_BITS = $clog2(PAIRS);
    localparam LAST = WORDS - 1;
    localparam WORD_NUMBER_BITS = $clog2(WORDS);

    // The words that are asked for and that come next. Even ones are the first of their pair.
    reg [WORD_NUMBER_BITS-1:0] asked_q, come_q;
    reg asked_end_q, come_end_q;  // the last of the frame
    wire [WORD_NUMBER_BITS-1:0] next_asked = asked_end_q ? {WORD_NUMBER_BITS{1'b0}} : asked_q + 1'b1;
    wire [WORD_NUMBER_BITS-1:0] next_come = come_end_q ? {WORD_NUMBER_BITS{1'b0}} : come_q + 1'b1;
    wire come_whole = come_q[0] || come_end_q;  // no further word of the pair

    reg [2*WORD_BITS-1:0] pair_q;     // what was read
    reg [2*WORD_BITS-1:0] written_q;  // what waits to be written
    reg [PAIR_BITS-1:0] place_q;      // where
    reg waits_q;
    reg [WORD_BITS-1:0] first_q;      // the first word of the pair that is coming

    // A frame of an odd number of words ends with half a pair. Then the first pair of the next frame is read when no
    // write waits, because the pair before was read just now; the next frame is still far.
    reg again_q;
    wire again = again_q && !waits_q;
    wire read = (read_i && asked_q[0]) || again;
    wire write = waits_q && !read;
    wire [PAIR_BITS-1:0] next_pair = again_q ? {PAIR_BITS{1'b0}} : next_asked[WORD_NUMBER_BITS-1:WORD_NUMBER_BITS-PAIR_BITS];
    wire [PAIR_BITS-1:0] address = read ? next_pair : place_q;

    (* ram_style = "huge" *) reg [2*WORD_BITS-1:0] pairs_q[0:PAIRS-1];
    always @(posedge clk_i) begin
        if (write) pairs_q[address] <= written_q;
        else if (read) pair_q <= pairs_q[address];
    end

    always @(posedge clk_i) begin
        if (read_i) begin
            reference_o <= asked_q[0] ? pair_q[WORD_BITS+:WORD_BITS] : pair_q[0+:WORD_BITS];
            asked_q     <= next_asked;
            asked_end_q <= asked_q == LAST[WORD_NUMBER_BITS-1:0] - 1'b1;
        end
        if (again) again_q <= 1'b0;
        if (read_i && asked_end_q && !asked_q[0]) again_q <= 1'b1;
        if (write) waits_q <= 1'b0;
        if (write_i) begin
            come_q     <= next_come;
            come_end_q <= come_q == LAST[WORD_NUMBER_BITS-1:0] - 1'b1;
            if (!come_q[0]) first_q <= word_i;
            if (come_whole) begin
                waits_q   <= 1'b1;
                written_q <= {word_i, come_q[0] ? first_q : word_i};
                place_q   <= come_q[WORD_NUMBER_BITS-1:WORD_NUMBER_BITS-PAIR_BITS];
            end
        end
        if (rst_i) begin
            asked_q     <= {WORD_NUMBER_BITS{1'b0}};
            asked_end_q <= 1'b0;
            come_q      <= {WORD_NUMBER_BITS{1'b0}};
            come_end_q  <= 1'b0;
            waits_q     <= 1'b0;
            again_q     <= 1'b0;
        end
    end

endmodule

`default_nettype wire
