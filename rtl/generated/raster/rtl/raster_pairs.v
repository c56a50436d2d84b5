// SPDX-License-Identifier: MIT OR Apache-2.0
// Holds the words of a frame in a memory of one port, which are read and written in the order of the frame. A word of the
// memory holds a pair of them. A pair is read before its first word is requested, and written when its second word has
// come. A write waits one clock if a pair is read at the same edge. A word is there one clock after its request, with DEEP two.
`default_nettype none

module raster_pairs #(
    parameter WORD_BITS = 8,   // bits of a word
    parameter WORDS = 76800,   // words of a frame, at least 4
    parameter DEEP = 0         // 0: a word comes one clock after its request; 1: two clocks
) (
    input  wire                 clk_i,        // clock, rising edge
    input  wire                 rst_i,        // synchronous reset, active high
    input  wire                 read_i,       // the next word is requested
    output reg  [WORD_BITS-1:0] reference_o,  // the requested word, until the next one replaces it
    input  wire                 write_i,      // the next word to store is there
    input  wire [WORD_BITS-1:0] word_i        // the word to store
);

    // Limits: a value out of range stops elaboration at an instance of a module that does not exist.
    generate
        if (WORDS < 4) begin : g_words WORDS_must_be_4_or_more u_refused (); end
    endgenerate

    localparam PAIRS = (WORDS + 1) / 2;
    localparam PAIR_BITS = $clog2(PAIRS);
    localparam HALF = WORDS % 2 == 1;  // 1: the last pair of a frame has one word only
    localparam LAST_PAIR = PAIRS - 1;
    localparam BEFORE_LAST_PAIR = PAIRS - 2;

    // The requested word is the first or the second word of the pair that was read. The next pair is read together with the second
    // word. If the last pair of a frame has no second word, the next pair is read when no write waits, as after a reset.
    wire [PAIR_BITS-1:0] read_place;
    reg ask_second_q, last_pair_q, again_q;
    reg waits_q;  // a pair waits to be written
    wire ask_half = HALF && last_pair_q && !ask_second_q;
    wire again = again_q && !waits_q;
    wire read = (read_i && ask_second_q) || again;
    wire write = waits_q && !read;

    // The incoming word is the first or the second word of a pair.
    wire [PAIR_BITS-1:0] write_place;
    reg come_second_q;
    reg [WORD_BITS-1:0] first_q;      // the first word of the incoming pair
    reg [2*WORD_BITS-1:0] written_q;  // the pair that waits to be written
    wire come_half = HALF && !come_second_q && write_place == (waits_q ? BEFORE_LAST_PAIR[PAIR_BITS-1:0] : LAST_PAIR[PAIR_BITS-1:0]);
    wire come_whole = come_second_q || come_half;  // no further word of the pair comes

    raster_ring #(.WORDS(PAIRS), .PLACE_BITS(PAIR_BITS)) u_read_place (
        .clk_i(clk_i), .rst_i(rst_i), .step_i(read), .place_o(read_place)
    );
    raster_ring #(.WORDS(PAIRS), .PLACE_BITS(PAIR_BITS)) u_write_place (
        .clk_i(clk_i), .rst_i(rst_i), .step_i(write), .place_o(write_place)
    );

    always @(posedge clk_i) begin
        if (again) again_q <= 1'b0;
        if (read) last_pair_q <= read_place == LAST_PAIR[PAIR_BITS-1:0];
        if (read_i) begin
            ask_second_q <= !ask_second_q && !ask_half;
            if (ask_half) again_q <= 1'b1;
        end
        if (write) waits_q <= 1'b0;
        if (write_i) begin
            come_second_q <= !come_whole;
            if (!come_second_q) first_q <= word_i;
            if (come_whole) begin
                waits_q   <= 1'b1;
                written_q <= {word_i, come_second_q ? first_q : word_i};
            end
        end
        if (rst_i) begin
            ask_second_q  <= 1'b0;
            last_pair_q   <= 1'b0;
            come_second_q <= 1'b0;
            waits_q       <= 1'b0;
            again_q       <= 1'b1;
        end
    end

    // With DEEP a register is in front of the memory.
    wire memory_read, memory_write, show, show_second;
    wire [PAIR_BITS-1:0] memory_address;
    wire [2*WORD_BITS-1:0] memory_word;
    bit_delay #(.DEPTH(DEEP)) u_read (.clk_i(clk_i), .rst_i(rst_i), .bit_i(read), .bit_o(memory_read));
    bit_delay #(.DEPTH(DEEP)) u_write (.clk_i(clk_i), .rst_i(rst_i), .bit_i(write), .bit_o(memory_write));
    bit_delay #(.DEPTH(DEEP)) u_show (.clk_i(clk_i), .rst_i(rst_i), .bit_i(read_i), .bit_o(show));
    word_delay #(.WIDTH(PAIR_BITS + 2 * WORD_BITS + 1), .DEPTH(DEEP)) u_access (
        .clk_i(clk_i), .data_i({read ? read_place : write_place, written_q, ask_second_q}),
        .data_o({memory_address, memory_word, show_second})
    );

    (* ram_style = "huge" *) reg [2*WORD_BITS-1:0] pairs_q[0:PAIRS-1];
    reg [2*WORD_BITS-1:0] pair_q;  // the pair that was read
    always @(posedge clk_i) begin
        if (memory_write) pairs_q[memory_address] <= memory_word;
        else if (memory_read) pair_q <= pairs_q[memory_address];
        if (show) reference_o <= show_second ? pair_q[WORD_BITS+:WORD_BITS] : pair_q[0+:WORD_BITS];
    end

endmodule

`default_nettype wire
