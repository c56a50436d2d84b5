// SPDX-License-Identifier: MIT OR Apache-2.0
// Memory with a port to write and a port to read. A word that is written and read at one edge is read
// as it was before.
`default_nettype none

module raster_memory #(
    parameter WIDTH = 16,         // bits of a word
    parameter WORDS = 240,        // words, at least 2
    parameter ADDRESS_BITS = 8,   // ceil(log2(WORDS))
    parameter OUTPUT_STAGE = 0,   // 1: a word is on data_o two edges after its address, not one
    parameter STYLE = "block"     // of what it is built: "block" or "ultra" RAM
) (
    input  wire                    clk_i,            // clock, rising edge
    input  wire                    write_i,          // write at this edge
    input  wire [ADDRESS_BITS-1:0] write_address_i,  // where
    input  wire [       WIDTH-1:0] data_i,           // what
    input  wire                    read_i,           // read at this edge; otherwise the memory's register stays
    input  wire [ADDRESS_BITS-1:0] read_address_i,   // where
    output wire [       WIDTH-1:0] data_o            // what was read
);

    // Limits: out of them elaboration stops at a module that does not exist.
    generate
        if (WORDS < 2) begin : g_words WORDS_must_be_2_or_more u_refused (); end
        if (ADDRESS_BITS != $clog2(WORDS)) begin : g_address_bits
            ADDRESS_BITS_must_be_clog2_of_WORDS u_refused ();
        end
        if (OUTPUT_STAGE != 0 && OUTPUT_STAGE != 1) begin : g_output_stage
            OUTPUT_STAGE_must_be_0_or_1 u_refused ();
        end
        if (STYLE != "block" && STYLE != "ultra") begin : g_style STYLE_must_be_block_or_ultra u_refused (); end
    endgenerate

    (* ram_style = STYLE, no_rw_check *) reg [WIDTH-1:0] words_q[0:WORDS-1];
    reg [WIDTH-1:0] read_q;

    always @(posedge clk_i) begin
        if (write_i) words_q[write_address_i] <= data_i;
        if (read_i) read_q <= words_q[read_address_i];
    end

    generate
        if (OUTPUT_STAGE) begin : g_stage
            reg [WIDTH-1:0] output_q;
            always @(posedge clk_i) output_q <= read_q;
            assign data_o = output_q;
        end else begin : g_direct
            assign data_o = read_q;
        end
    endgenerate

endmodule

`default_nettype wire
