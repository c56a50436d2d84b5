// SPDX-License-Identifier: MIT OR Apache-2.0
// CRC-32 of packets (docs/packets.md), BITS bits at a time: which sum follows from the sum so far and the next bits.
`default_nettype none

module packet_crc #(
    parameter BITS = 16  // bits that are added, the first in the lowest; 32 or fewer
) (
    input  wire [    31:0] crc_i,   // the sum so far, all ones at the start
    input  wire [BITS-1:0] data_i,  // the next bits
    output wire [    31:0] crc_o    // the sum with them; inverted it is the CRC of all bits so far
);

    // Limits: out of them elaboration stops at a module that does not exist.
    generate
        if (BITS < 1 || BITS > 32) begin : g_bits BITS_must_be_1_to_32 u_refused (); end
    endgenerate

    // What a sum with only bit `place` becomes after BITS bits of 0.
    function [31:0] moved(input integer place);
        integer step;
        begin
            moved = 32'd1 << place;
            for (step = 0; step < BITS; step = step + 1) moved = moved[0] ? (moved >> 1) ^ 32'hEDB88320 : moved >> 1;
        end
    endfunction

    // The sum is linear: every bit of it and of the data moves on its own. So each bit is one flat exclusive or, which takes fewer
    // LUTs than one that follows the bits in turn.
    wire [31:0] sum = crc_i ^ {{(32 - BITS) {1'b0}}, data_i};
    wire [31:0] columns[0:31];
    genvar from, to;
    generate
        for (from = 0; from < 32; from = from + 1) begin : g_from
            localparam [31:0] COLUMN = moved(from);
            assign columns[from] = COLUMN;
        end
        for (to = 0; to < 32; to = to + 1) begin : g_to
            wire [31:0] mask;
            for (from = 0; from < 32; from = from + 1) begin : g_mask
                assign mask[from] = columns[from][to];
            end
            assign crc_o[to] = ^(sum & mask);
        end
    endgenerate

endmodule

`default_nettype wire
