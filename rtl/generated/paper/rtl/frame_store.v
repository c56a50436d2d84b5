// SPDX-License-Identifier: MIT OR Apache-2.0
// Stores the pixels of one region in distributed RAM with a single port. A read is combinational and shows the word before
// the write of the same edge: the pixel of the frame before. The store is reference, input of the second pass and output
// buffer at once.
//
// It has banks of 256 words, the largest single-port primitive that synthesis maps reliably. A last bank of at most 128
// words is made smaller.
`default_nettype none

module frame_store #(
    parameter WIDTH = 8,        // bits of a pixel
    parameter PIXELS = 64,      // pixels of a region
    parameter ADDRESS_BITS = 6  // ceil(log2(PIXELS))
) (
    input  wire                    clk_i,      // clock, rising edge
    input  wire                    write_i,    // write data_i at this edge
    input  wire [ADDRESS_BITS-1:0] address_i,  // address of the word, 0..PIXELS-1
    input  wire [       WIDTH-1:0] data_i,     // the word that is written
    output wire [       WIDTH-1:0] data_o      // the stored word, before the write of this edge
);

    // Limits: a value out of range stops elaboration at an instance of a module that does not exist.
    generate
        if (WIDTH < 1) begin : g_width WIDTH_must_be_1_or_more u_refused (); end
        if (PIXELS < 2) begin : g_pixels PIXELS_must_be_2_or_more u_refused (); end
        if (ADDRESS_BITS != $clog2(PIXELS)) begin : g_address_bits
            ADDRESS_BITS_must_be_clog2_of_PIXELS u_refused ();
        end
    endgenerate

    generate
        if (ADDRESS_BITS <= 8) begin : g_single
            (* ram_style = "distributed" *)
            reg [WIDTH-1:0] pixels_q[0:PIXELS-1];

            always @(posedge clk_i) begin
                if (write_i) pixels_q[address_i] <= data_i;
            end

            assign data_o = pixels_q[address_i];
        end else begin : g_banked
            localparam BANKS = (PIXELS + 255) / 256;
            localparam BANK_BITS = ADDRESS_BITS - 8;

            wire [BANK_BITS-1:0] bank = address_i[ADDRESS_BITS-1:8];
            wire [WIDTH*BANKS-1:0] words;
            assign data_o = words[bank*WIDTH+:WIDTH];

            genvar i;
            for (i = 0; i < BANKS; i = i + 1) begin : g_bank
                localparam REST = PIXELS - 256 * i;
                localparam DEPTH = REST > 128 ? 256 : REST;
                localparam LOWER_BITS = $clog2(DEPTH);

                (* ram_style = "distributed" *)
                reg [WIDTH-1:0] pixels_q[0:DEPTH-1];
                wire [LOWER_BITS-1:0] lower = address_i[LOWER_BITS-1:0];

                always @(posedge clk_i) begin
                    if (write_i && bank == i) pixels_q[lower] <= data_i;
                end

                assign words[i*WIDTH+:WIDTH] = pixels_q[lower];
            end
        end
    endgenerate

endmodule

`default_nettype wire
