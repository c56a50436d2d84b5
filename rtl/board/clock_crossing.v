// SPDX-License-Identifier: MIT OR Apache-2.0
// A queue between two clocks of any phase and rate. Both sides count in Gray code, so that a counter that is sampled while it
// changes is read as its old or its new value. Words are read from block RAM one clock ahead, and leave at up to one per clock.
//
// Only the read side has a reset, because the write clock may stand still. After a reset, words are discarded until the queue
// is empty. The counters continue from their values; they start from their initial values.
`default_nettype none

module clock_crossing #(
    parameter WIDTH = 10,     // bits of a word
    parameter DEPTH_BITS = 4  // log2 of the words that may wait; at least 2, and 3 for a word at every clock
) (
    input  wire             write_clk_i,  // clock of the write side, rising edge; it may stand still
    input  wire             write_i,      // a word comes; it is discarded if full_o is 1
    input  wire [WIDTH-1:0] data_i,       // the word that comes
    output wire             full_o,       // there is no room for a word
    input  wire             read_clk_i,   // clock of the read side, rising edge
    input  wire             rst_i,        // synchronous reset of the read side, active high
    output wire             valid_o,      // the oldest word is on the port
    output wire [WIDTH-1:0] data_o,       // the oldest word
    input  wire             take_i        // the oldest word is taken, if valid_o is 1
);

    // Limits: a value out of range stops elaboration at an instance of a module that does not exist.
    generate
        if (WIDTH < 1) begin : g_width WIDTH_must_be_1_or_more u_refused (); end
        if (DEPTH_BITS < 2) begin : g_depth_bits DEPTH_BITS_must_be_2_or_more u_refused (); end
    endgenerate

    // The highest bit distinguishes a full queue from an empty one.
    reg [DEPTH_BITS:0] write_q, write_gray_q, read_q, read_gray_q;
    (* ASYNC_REG = "TRUE" *) reg [DEPTH_BITS:0] read_first_q, read_seen_q;
    (* ASYNC_REG = "TRUE" *) reg [DEPTH_BITS:0] write_first_q, write_seen_q;
    reg there_q;  // the word at read_q is on the port
    reg flush_q;  // words are discarded
    initial begin
        write_q       = {(DEPTH_BITS + 1) {1'b0}};
        write_gray_q  = {(DEPTH_BITS + 1) {1'b0}};
        read_q        = {(DEPTH_BITS + 1) {1'b0}};
        read_gray_q   = {(DEPTH_BITS + 1) {1'b0}};
        read_first_q  = {(DEPTH_BITS + 1) {1'b0}};
        read_seen_q   = {(DEPTH_BITS + 1) {1'b0}};
        write_first_q = {(DEPTH_BITS + 1) {1'b0}};
        write_seen_q  = {(DEPTH_BITS + 1) {1'b0}};
        there_q       = 1'b0;
        flush_q       = 1'b1;
    end
    (* no_rw_check *) reg [WIDTH-1:0] words_q[0:(1<<DEPTH_BITS)-1];
    reg [WIDTH-1:0] word_q;

    // The queue is full if the counters are 2^DEPTH_BITS apart. In Gray code their two highest bits then differ.
    assign full_o = write_gray_q == {~read_seen_q[DEPTH_BITS-:2], read_seen_q[DEPTH_BITS-2:0]};
    wire write = write_i && !full_o;
    wire [DEPTH_BITS:0] next_write = write_q + {{DEPTH_BITS{1'b0}}, write};
    always @(posedge write_clk_i) begin
        write_q      <= next_write;
        write_gray_q <= next_write ^ next_write >> 1;
        read_first_q <= read_gray_q;
        read_seen_q  <= read_first_q;
        if (write) words_q[write_q[DEPTH_BITS-1:0]] <= data_i;
    end

    // A word is written at least two clocks before the read side sees its counter, so a read never comes too early.
    wire take = there_q && (take_i || flush_q);
    wire [DEPTH_BITS:0] next_read = read_q + {{DEPTH_BITS{1'b0}}, take};
    wire [DEPTH_BITS:0] next_gray = next_read ^ next_read >> 1;
    always @(posedge read_clk_i) begin
        read_q        <= next_read;
        read_gray_q   <= next_gray;
        write_first_q <= write_gray_q;
        write_seen_q  <= write_first_q;
        there_q       <= next_gray != write_seen_q;
        word_q        <= words_q[next_read[DEPTH_BITS-1:0]];
        flush_q       <= rst_i || (flush_q && there_q);
    end

    assign valid_o = there_q && !flush_q;
    assign data_o = word_q;

endmodule

`default_nettype wire
