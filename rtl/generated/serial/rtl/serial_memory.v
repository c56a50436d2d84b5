// SPDX-License-Identifier: MIT OR Apache-2.0
// The memory of a serial lane, with a single port: what is read is what a write at the same edge
// replaces. Distributed RAM answers in the same clock, block RAM in the next one.
`default_nettype none

module serial_memory #(
    parameter WIDTH = 8,         // bits of a pixel
    parameter WORDS = 128,
    parameter ADDRESS_BITS = 7,  // ceil(log2(WORDS))
    parameter BLOCK = 0          // 1: block RAM
) (
    input  wire                    clk_i,
    input  wire                    write_i,
    input  wire [ADDRESS_BITS-1:0] address_i,
    input  wire [       WIDTH-1:0] data_i,
    output wire [       WIDTH-1:0] data_o     // before the write
);

    generate
        if (BLOCK != 0) begin : g_block
            (* ram_style = "block" *)
            reg [WIDTH-1:0] pixels_q[0:WORDS-1];
            reg [WIDTH-1:0] data_q;

            always @(posedge clk_i) begin
                if (write_i) pixels_q[address_i] <= data_i;
                data_q <= pixels_q[address_i];
            end

            assign data_o = data_q;
        end else begin : g_distributed
            frame_store #(.WIDTH(WIDTH), .PIXELS(WORDS), .SLOT_BITS(ADDRESS_BITS)) u_store (
                .clk_i(clk_i), .write_i(write_i), .slot_i(address_i), .data_i(data_i),
                .data_o(data_o)
            );
        end
    endgenerate

endmodule

`default_nettype wire
