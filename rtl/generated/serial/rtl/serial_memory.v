// SPDX-License-Identifier: MIT OR Apache-2.0
// The memory of a serial lane, with a single port: a read shows the word before a write at the same edge. Distributed RAM
// shows it in the clock of the address, block RAM in the next clock; with LATE it comes one clock later.
`default_nettype none

module serial_memory #(
    parameter WIDTH = 8,         // bits of a pixel
    parameter WORDS = 128,       // words of the memory, at least 2
    parameter ADDRESS_BITS = 7,  // ceil(log2(WORDS))
    parameter BLOCK = 0,         // 1: block RAM; 0: distributed RAM
    parameter LATE = 0           // 1: one more register behind the memory
) (
    input  wire                    clk_i,      // clock, rising edge
    input  wire                    write_i,    // write data_i at this edge
    input  wire [ADDRESS_BITS-1:0] address_i,  // address of the word, 0..WORDS-1
    input  wire [       WIDTH-1:0] data_i,     // the word that is written
    output wire [       WIDTH-1:0] data_o      // the stored word, before the write of this edge
);

    // Limits: a value out of range stops elaboration at an instance of a module that does not exist.
    generate
        if (WIDTH < 1) begin : g_width WIDTH_must_be_1_or_more u_refused (); end
        if (WORDS < 2) begin : g_words WORDS_must_be_2_or_more u_refused (); end
        if (ADDRESS_BITS != $clog2(WORDS)) begin : g_address_bits
            ADDRESS_BITS_must_be_clog2_of_WORDS u_refused ();
        end
        if (BLOCK != 0 && BLOCK != 1) begin : g_block_flag BLOCK_must_be_0_or_1 u_refused (); end
        if (LATE != 0 && LATE != 1) begin : g_late_flag LATE_must_be_0_or_1 u_refused (); end
    endgenerate

    wire [WIDTH-1:0] word;

    generate
        if (LATE != 0) begin : g_late
            reg [WIDTH-1:0] word_q;
            always @(posedge clk_i) word_q <= word;
            assign data_o = word_q;
        end else begin : g_not_late
            assign data_o = word;
        end

        if (BLOCK != 0) begin : g_block
            (* ram_style = "block" *)
            reg [WIDTH-1:0] pixels_q[0:WORDS-1];
            reg [WIDTH-1:0] data_q;

            always @(posedge clk_i) begin
                if (write_i) pixels_q[address_i] <= data_i;
                data_q <= pixels_q[address_i];
            end

            assign word = data_q;
        end else begin : g_distributed
            frame_store #(.WIDTH(WIDTH), .PIXELS(WORDS), .ADDRESS_BITS(ADDRESS_BITS)) u_store (
                .clk_i(clk_i), .write_i(write_i), .address_i(address_i), .data_i(data_i),
                .data_o(word)
            );
        end
    endgenerate

endmodule

`default_nettype wire
