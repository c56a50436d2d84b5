// SPDX-License-Identifier: MIT OR Apache-2.0
// One region of pixels in distributed RAM with a single port: what is read is what the same step
// overwrites, the pixel of one frame ago. It is reference, second pass and output buffer at once.
//
// Banks of 256 words, the largest single-port primitive that synthesis maps reliably; a last one of
// at most 128 words is made smaller.
`default_nettype none

module frame_store #(
    parameter WIDTH = 8,     // bits of a pixel
    parameter PIXELS = 64,   // pixels of a region
    parameter SLOT_BITS = 6  // ceil(log2(PIXELS))
) (
    input  wire                 clk_i,
    input  wire                 write_i,
    input  wire [SLOT_BITS-1:0] slot_i,
    input  wire [    WIDTH-1:0] data_i,
    output wire [    WIDTH-1:0] data_o   // before the write
);

    generate
        if (SLOT_BITS <= 8) begin : g_single
            (* ram_style = "distributed" *)
            reg [WIDTH-1:0] pixels_q[0:PIXELS-1];

            always @(posedge clk_i) begin
                if (write_i) pixels_q[slot_i] <= data_i;
            end

            assign data_o = pixels_q[slot_i];
        end else begin : g_banked
            localparam BANKS = (PIXELS + 255) / 256;
            localparam BANK_BITS = SLOT_BITS - 8;

            wire [BANK_BITS-1:0] bank = slot_i[SLOT_BITS-1:8];
            wire [WIDTH*BANKS-1:0] words;
            assign data_o = words[bank*WIDTH+:WIDTH];

            genvar i;
            for (i = 0; i < BANKS; i = i + 1) begin : g_bank
                localparam REST = PIXELS - 256 * i;
                localparam DEPTH = REST > 128 ? 256 : REST;
                localparam ADDRESS_BITS = $clog2(DEPTH);

                (* ram_style = "distributed" *)
                reg [WIDTH-1:0] pixels_q[0:DEPTH-1];
                wire [ADDRESS_BITS-1:0] address = slot_i[ADDRESS_BITS-1:0];

                always @(posedge clk_i) begin
                    if (write_i && bank == i) pixels_q[address] <= data_i;
                end

                assign words[i*WIDTH+:WIDTH] = pixels_q[address];
            end
        end
    endgenerate

endmodule

`default_nettype wire
