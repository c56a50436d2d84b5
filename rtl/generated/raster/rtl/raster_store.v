// SPDX-License-Identifier: MIT OR Apache-2.0
// The frame store: references, read in the order of the frame. What is written comes in the same order, or to
// places of its own.
`default_nettype none

module raster_store #(
    parameter WORD_BITS = 8,      // bits of a word
    parameter WORDS = 2073600,    // words of a frame
    parameter ADDRESS_BITS = 21,  // ceil(log2(WORDS))
    parameter KIND = 0,           // 0: block RAM; 1: UltraRAM; 2: RAM of one port
    parameter RANDOM = 0,         // 1: words are written where place_i says; 0: in the order of the frame
    parameter DEEP = 0            // 0: a reference one clock after it is asked for; 1: two
) (
    input  wire                    clk_i,        // clock, rising edge
    input  wire                    rst_i,        // synchronous reset, active high
    input  wire                    read_i,       // the next reference is asked for
    output wire [   WORD_BITS-1:0] reference_o,  // it
    input  wire                    write_i,      // a word becomes a reference
    input  wire [ADDRESS_BITS-1:0] place_i,      // where (RANDOM)
    input  wire [   WORD_BITS-1:0] word_i        // that word
);

    // Limits: out of them elaboration stops at a module that does not exist.
    generate
        if (KIND < 0 || KIND > 2) begin : g_kind KIND_must_be_0_to_2 u_refused (); end
        if (RANDOM && KIND == 2) begin : g_order KIND_must_have_two_ports_with_RANDOM u_refused (); end
    endgenerate

    localparam BEFORE_LAST = WORDS - 2;

    generate
        if (KIND == 2) begin : g_pairs
            wire [WORD_BITS-1:0] asked;
            wire unused_place = |place_i;
            raster_pairs #(.WORD_BITS(WORD_BITS), .WORDS(WORDS)) u_pairs (
                .clk_i(clk_i), .rst_i(rst_i), .read_i(read_i), .reference_o(asked), .write_i(write_i), .word_i(word_i)
            );
            raster_delay #(.WIDTH(WORD_BITS), .DEPTH(DEEP)) u_asked (
                .clk_i(clk_i), .data_i(asked), .data_o(reference_o)
            );
        end else begin : g_two_ports
            reg [ADDRESS_BITS-1:0] read_q;
            reg read_end_q;
            wire [ADDRESS_BITS-1:0] write_place;

            always @(posedge clk_i) begin
                if (read_i) begin
                    read_q     <= read_end_q ? {ADDRESS_BITS{1'b0}} : read_q + 1'b1;
                    read_end_q <= read_q == BEFORE_LAST[ADDRESS_BITS-1:0];
                end
                if (rst_i) begin
                    read_q     <= {ADDRESS_BITS{1'b0}};
                    read_end_q <= 1'b0;
                end
            end

            if (RANDOM) begin : g_random
                assign write_place = place_i;
            end else begin : g_in_order
                // The place is the one that was read a word ago.
                reg [ADDRESS_BITS-1:0] write_q;
                reg write_end_q;
                always @(posedge clk_i) begin
                    if (write_i) begin
                        write_q     <= write_end_q ? {ADDRESS_BITS{1'b0}} : write_q + 1'b1;
                        write_end_q <= write_q == BEFORE_LAST[ADDRESS_BITS-1:0];
                    end
                    if (rst_i) begin
                        write_q     <= {ADDRESS_BITS{1'b0}};
                        write_end_q <= 1'b0;
                    end
                end
                wire unused_place = |place_i;
                assign write_place = write_q;
            end

            raster_memory #(
                .WIDTH(WORD_BITS), .WORDS(WORDS), .ADDRESS_BITS(ADDRESS_BITS), .OUTPUT_STAGE(DEEP),
                .STYLE(KIND == 1 ? "ultra" : "block")
            ) u_words (
                .clk_i(clk_i), .write_i(write_i), .write_address_i(write_place), .data_i(word_i),
                .read_i(1'b1), .read_address_i(read_q), .data_o(reference_o)
            );
        end
    endgenerate

endmodule

`default_nettype wire
