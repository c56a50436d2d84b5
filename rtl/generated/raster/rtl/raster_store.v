// SPDX-License-Identifier: MIT OR Apache-2.0
// The frame store inside the core. References are read in the order of the frame. Words are written in the same order, or
// with RANDOM at given places. A reference comes one clock after its request, with DEEP two.
`default_nettype none

module raster_store #(
    parameter WORD_BITS = 8,      // bits of a word
    parameter WORDS = 2073600,    // words of a frame
    parameter ADDRESS_BITS = 21,  // ceil(log2(WORDS))
    parameter KIND = 0,           // 0: block RAM; 1: UltraRAM; 2: RAM of one port
    parameter RANDOM = 0,         // 1: words are written at place_i; 0: in the order of the frame
    parameter DEEP = 0,           // 0: a reference comes one clock after its request; 1: two clocks
    parameter BANK_BITS = 14,     // log2 of the words of a bank (GROUPS)
    parameter GROUP_BITS = 2,     // log2 of the banks of a group (GROUPS)
    parameter GROUPS = 0          // 0: one memory; more: so many groups of banks, and a reference comes GROUPS + 6 clocks after its request
) (
    input  wire                    clk_i,        // clock, rising edge
    input  wire                    rst_i,        // synchronous reset, active high
    input  wire                    read_i,       // the next reference is requested
    output wire [   WORD_BITS-1:0] reference_o,  // the requested reference
    input  wire                    write_i,      // a word is stored as a reference
    input  wire [ADDRESS_BITS-1:0] place_i,      // place of that word in the frame (RANDOM)
    input  wire [   WORD_BITS-1:0] word_i        // the word that is stored
);

    // Limits: a value out of range stops elaboration at an instance of a module that does not exist.
    generate
        if (KIND < 0 || KIND > 2) begin : g_kind KIND_must_be_0_to_2 u_refused (); end
        if (GROUPS > 0 && (RANDOM || KIND != 0)) begin : g_groups GROUPS_must_be_0_here u_refused (); end
        if (RANDOM && KIND == 2) begin : g_order KIND_must_have_two_ports_with_RANDOM u_refused (); end
    endgenerate

    generate
        if (KIND == 2) begin : g_pairs
            wire unused_place = |place_i;
            raster_pairs #(.WORD_BITS(WORD_BITS), .WORDS(WORDS), .DEEP(DEEP)) u_pairs (
                .clk_i(clk_i), .rst_i(rst_i), .read_i(read_i), .reference_o(reference_o), .write_i(write_i),
                .word_i(word_i)
            );
        end else begin : g_two_ports
            wire [ADDRESS_BITS-1:0] read_place, write_place;
            raster_ring #(.WORDS(WORDS), .PLACE_BITS(ADDRESS_BITS)) u_read (
                .clk_i(clk_i), .rst_i(rst_i), .step_i(read_i), .place_o(read_place)
            );

            if (RANDOM) begin : g_random
                assign write_place = place_i;
            end else begin : g_in_order
                wire unused_place = |place_i;
                raster_ring #(.WORDS(WORDS), .PLACE_BITS(ADDRESS_BITS)) u_write (
                    .clk_i(clk_i), .rst_i(rst_i), .step_i(write_i), .place_o(write_place)
                );
            end

            if (GROUPS > 0) begin : g_banks
                raster_banks #(
                    .WIDTH(WORD_BITS), .WORDS(WORDS), .ADDRESS_BITS(ADDRESS_BITS), .BANK_BITS(BANK_BITS),
                    .GROUP_BITS(GROUP_BITS), .GROUPS(GROUPS)
                ) u_words (
                    .clk_i(clk_i), .rst_i(rst_i), .write_i(write_i), .write_address_i(write_place), .data_i(word_i),
                    .read_address_i(read_place), .data_o(reference_o)
                );
            end else begin : g_one
                raster_memory #(
                    .WIDTH(WORD_BITS), .WORDS(WORDS), .ADDRESS_BITS(ADDRESS_BITS), .OUTPUT_STAGE(DEEP),
                    .STYLE(KIND == 1 ? "ultra" : "block")
                ) u_words (
                    .clk_i(clk_i), .write_i(write_i), .write_address_i(write_place), .data_i(word_i),
                    .read_i(1'b1), .read_address_i(read_place), .output_i(1'b1), .data_o(reference_o)
                );
            end
        end
    endgenerate

endmodule

`default_nettype wire
