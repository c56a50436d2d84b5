// SPDX-License-Identifier: MIT OR Apache-2.0
// The classes of all regions in two banks: one that frames use, and one that is written. A commit exchanges them, and the
// next frame takes the other bank. docs/zones.md defines when.
//
// A commit is pending until no frame uses the other bank. Until then writes and commits are ignored, and do not wait.
`default_nettype none

module class_memory #(
    parameter REGIONS = 784,                // regions of the frame
    parameter REGION_BITS = 10,             // bits of region_i; a number that is no region gives any class
    parameter ADDRESS_BITS = 6,             // bits of the number of a word, at least 1
    parameter [2*REGIONS-1:0] CLASSES = 0   // the first map, region 0 in the lowest bits
) (
    input  wire                    clk_i,       // clock, rising edge
    input  wire                    rst_i,       // synchronous reset, active high
    input  wire                    write_i,     // a word is written
    input  wire [ADDRESS_BITS-1:0] address_i,   // number of that word
    input  wire [            31:0] word_i,      // classes of 16 regions, the first one in the lowest bits
    input  wire                    commit_i,    // frames use the map that has been written
    output wire                    pending_o,   // the committed map is not in use yet
    input  wire                    occupied_i,  // a frame uses the map at this edge
    input  wire [ REGION_BITS-1:0] region_i,    // a region
    output wire [             1:0] class_o      // its class in the map in use, one clock later
);

    // Limits: a value out of range stops elaboration at an instance of a module that does not exist.
    generate
        if (REGIONS < 1) begin : g_regions REGIONS_must_be_1_or_more u_refused (); end
        if (ADDRESS_BITS < 1 || (1 << ADDRESS_BITS) * 16 < REGIONS) begin : g_address_bits
            ADDRESS_BITS_must_number_the_words u_refused ();
        end
    endgenerate

    localparam WORDS = 1 << ADDRESS_BITS;
    localparam SPARE_BITS = 32 * WORDS > 2 * REGIONS ? 32 * WORDS - 2 * REGIONS : 0;  // bits behind the last region
    localparam [32*WORDS-1:0] FIRST = {{SPARE_BITS{1'b0}}, CLASSES};

    // Without a reset, because a reset keeps the map.
    reg committed_q = 1'b0;  // the bank that was committed last
    reg used_q = 1'b0;       // the bank of the frame, or of the next one
    wire bank = occupied_i && !rst_i ? used_q : committed_q;
    wire free = committed_q == used_q && !rst_i;
    assign pending_o = committed_q != used_q;

    always @(posedge clk_i) begin
        used_q <= bank;
        if (commit_i && free) committed_q <= !committed_q;
    end

    // The word of a region, and the place of the region in it.
    wire [REGION_BITS+3:0] number = {4'd0, region_i};
    wire [ADDRESS_BITS+REGION_BITS-1:0] wide_place = {{ADDRESS_BITS{1'b0}}, number[REGION_BITS+3:4]};
    wire unused_place = |wide_place;
    reg [31:0] words_q[0:2*WORDS-1];
    reg [31:0] word_q;
    reg [3:0] place_q;

    integer i;
    initial begin
        for (i = 0; i < WORDS; i = i + 1) begin
            words_q[i] = FIRST[32*i+:32];
            words_q[WORDS+i] = FIRST[32*i+:32];
        end
    end

    always @(posedge clk_i) begin
        if (write_i && free) words_q[{!committed_q, address_i}] <= word_i;
        word_q  <= words_q[{bank, wide_place[ADDRESS_BITS-1:0]}];
        place_q <= number[3:0];
    end

    assign class_o = word_q[{place_q, 1'b0}+:2];

endmodule

`default_nettype wire
