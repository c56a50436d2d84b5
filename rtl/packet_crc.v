// SPDX-License-Identifier: MIT OR Apache-2.0
// Updates the CRC-32 of packets (docs/packets.md) with BITS bits at a time. Combinational.
`default_nettype none

module packet_crc #(
    parameter BITS = 16  // bits that are added at a time, the first in the lowest; 32 or fewer
) (
    input  wire [    31:0] crc_i,   // the sum so far, all ones at the start
    input  wire [BITS-1:0] data_i,  // the next bits
    output wire [    31:0] crc_o    // the sum with these bits; inverted, it is the CRC of all bits so far
);

    // Limits: a value out of range stops elaboration at an instance of a module that does not exist.
    generate
        if (BITS < 1 || BITS > 32) begin : g_bits BITS_must_be_1_to_32 u_refused (); end
    endgenerate

    // Returns the sum that follows BITS bits of 0 from a sum with only bit `place` set.
    function [31:0] moved(input integer place);
        integer step;
        begin
            moved = 32'd1 << place;
            for (step = 0; step < BITS; step = step + 1) moved = moved[0] ? (moved >> 1) ^ 32'hEDB88320 : moved >> 1;
        end
    endfunction

    // The sum is linear: each bit of the old sum and of the data contributes independently. So each bit of the new sum is
    // one flat exclusive or, which takes fewer LUTs than logic that follows the bits in turn.
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
