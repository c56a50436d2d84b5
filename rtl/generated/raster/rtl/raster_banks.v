// SPDX-License-Identifier: MIT OR Apache-2.0
// A large memory for a fast clock, with a write port and a read port. Its banks form groups, one behind the other.
// Addresses and words travel from group to group, one clock each, and a word that was read travels with them, so that no
// wire crosses the whole memory. A word is on data_o GROUPS + 6 clocks after its address.
`default_nettype none

module raster_banks #(
    parameter WIDTH = 8,          // bits of a word
    parameter WORDS = 307200,     // words of the memory, more than a bank has (otherwise u_slot is refused)
    parameter ADDRESS_BITS = 19,  // ceil(log2(WORDS))
    parameter BANK_BITS = 14,     // log2 of the words of a bank
    parameter GROUP_BITS = 2,     // log2 of the banks of a group
    parameter GROUPS = 5          // number of groups that WORDS need
) (
    input  wire                    clk_i,            // clock, rising edge
    input  wire                    rst_i,            // synchronous reset, active high
    input  wire                    write_i,          // write at this edge
    input  wire [ADDRESS_BITS-1:0] write_address_i,  // address of the word that is written
    input  wire [       WIDTH-1:0] data_i,           // the word that is written
    input  wire [ADDRESS_BITS-1:0] read_address_i,   // address of the word that is read
    output wire [       WIDTH-1:0] data_o            // the word at read_address_i of GROUPS + 6 clocks ago
);

    localparam GROUP_WORD_BITS = BANK_BITS + GROUP_BITS;

    // Limits: a value out of range stops elaboration at an instance of a module that does not exist.
    generate
        if (ADDRESS_BITS != $clog2(WORDS)) begin : g_address_bits
            ADDRESS_BITS_must_be_clog2_of_WORDS u_refused ();
        end
        if (GROUPS != (WORDS + (1 << GROUP_WORD_BITS) - 1) >> GROUP_WORD_BITS) begin : g_groups
            GROUPS_must_be_as_many_as_WORDS_need u_refused ();
        end
    endgenerate

    // The addresses and words at the entry of the first group and at the exit of each group.
    localparam SLOT_BITS = ADDRESS_BITS - BANK_BITS;  // bits of the number of a bank
    wire [ADDRESS_BITS-1:0] read_place[0:GROUPS];
    wire [ADDRESS_BITS-1:0] write_place[0:GROUPS];
    wire [WIDTH-1:0] word[0:GROUPS];
    wire write[0:GROUPS];
    wire [WIDTH-1:0] found[0:GROUPS];
    assign read_place[0] = read_address_i;
    assign write_place[0] = write_address_i;
    assign word[0] = data_i;
    assign write[0] = write_i;
    assign found[0] = {WIDTH{1'b0}};

    genvar group, bank;
    generate
        for (group = 0; group < GROUPS; group = group + 1) begin : g_group
            localparam FIRST = group << GROUP_BITS;  // number of the first bank of this group
            localparam LEFT = WORDS - (FIRST << BANK_BITS);  // number of words from that bank on
            localparam NEEDED = (LEFT + (1 << BANK_BITS) - 1) >> BANK_BITS;
            localparam BANKS = NEEDED < 1 << GROUP_BITS ? NEEDED : 1 << GROUP_BITS;

            reg [ADDRESS_BITS-1:0] read_q, write_q;
            reg [WIDTH-1:0] word_q, found_q;
            always @(posedge clk_i) begin
                read_q  <= read_place[group];
                write_q <= write_place[group];
                word_q  <= word[group];
            end
            bit_delay #(.DEPTH(1)) u_write (.clk_i(clk_i), .rst_i(rst_i), .bit_i(write[group]), .bit_o(write[group+1]));
            assign read_place[group+1] = read_q;
            assign write_place[group+1] = write_q;
            assign word[group+1] = word_q;

            // Each bank has registers of its own, so that the wire to its blocks is short. They change only when the bank is
            // addressed. So they differ from those of other banks, and synthesis does not merge them. All banks are read, and the
            // word of a bank that was not addressed is 0.
            wire [BANKS*WIDTH-1:0] bank_words;
            reg [BANKS*WIDTH-1:0] bank_words_q;
            for (bank = 0; bank < BANKS; bank = bank + 1) begin : g_bank
                localparam [SLOT_BITS-1:0] OWN = FIRST + bank;
                reg asked_q, given_q, own_q;  // this bank is read; is written; is written at the next edge
                reg [BANK_BITS-1:0] own_read_q, own_write_q;
                reg [WIDTH-1:0] own_word_q;
                wire comes;  // a word of this bank was read and comes out
                always @(posedge clk_i) begin
                    asked_q <= read_place[group][BANK_BITS+:SLOT_BITS] == OWN;
                    given_q <= write[group] && write_place[group][BANK_BITS+:SLOT_BITS] == OWN;
                    own_q   <= given_q;
                    if (asked_q) own_read_q <= read_q[BANK_BITS-1:0];
                    if (given_q) begin
                        own_write_q <= write_q[BANK_BITS-1:0];
                        own_word_q  <= word_q;
                    end
                end
                raster_memory #(.WIDTH(WIDTH), .WORDS(1 << BANK_BITS), .ADDRESS_BITS(BANK_BITS), .OUTPUT_STAGE(1)) u_words (
                    .clk_i(clk_i), .write_i(own_q), .write_address_i(own_write_q), .data_i(own_word_q),
                    .read_i(1'b1), .read_address_i(own_read_q), .output_i(1'b1), .data_o(bank_words[bank*WIDTH+:WIDTH])
                );
                // A register halfway, because the blocks of a bank may lie far apart.
                reg [WIDTH-1:0] bank_word_q;
                word_delay #(.WIDTH(1), .DEPTH(4)) u_comes (.clk_i(clk_i), .data_i(asked_q), .data_o(comes));
                always @(posedge clk_i) begin
                    bank_word_q <= bank_words[bank*WIDTH+:WIDTH];
                    if (comes) bank_words_q[bank*WIDTH+:WIDTH] <= bank_word_q;
                    else bank_words_q[bank*WIDTH+:WIDTH] <= {WIDTH{1'b0}};
                end
            end

            integer number;
            wire [WIDTH-1:0] earlier = found[group];
            reg [WIDTH-1:0] any;  // the word of an earlier group, or of a bank of this group
            always @* begin
                any = earlier;
                for (number = 0; number < BANKS; number = number + 1) any = any | bank_words_q[number*WIDTH+:WIDTH];
            end
            always @(posedge clk_i) found_q <= any;
            assign found[group+1] = found_q;
        end
    endgenerate

    assign data_o = found[GROUPS];
    wire unused_ends = write[GROUPS] || |write_place[GROUPS] || |read_place[GROUPS] || |word[GROUPS];

endmodule

`default_nettype wire
