// SPDX-License-Identifier: MIT OR Apache-2.0
// Which regions have a valid reference. Decisions and losses write it, perhaps at one edge, so there are two
// bits for each region, each with one writer: the reference is valid if they differ.
`default_nettype none

module raster_valid #(
    parameter REGIONS = 64,     // regions of the frame
    parameter REGION_BITS = 6,  // ceil(log2(REGIONS))
    parameter DEEP = 0          // clocks from valid_o to the decision
) (
    input  wire                   clk_i,             // clock, rising edge
    input  wire                   rst_i,             // synchronous reset, active high
    input  wire                   none_i,            // no region has a reference
    input  wire [REGION_BITS-1:0] region_i,          // the region that is asked for next
    output wire                   valid_o,           // the one asked for a clock ago has a reference
    input  wire                   decided_i,         // a region is decided
    input  wire [REGION_BITS-1:0] decided_region_i,  // which: the one of valid_o, DEEP clocks ago
    input  wire                   next_i,            // from now on it has a valid reference
    output reg                    mark_o,            // the bit that a loss of the region writes, a clock later
    input  wire                   lost_i,            // a region is lost
    input  wire [REGION_BITS-1:0] lost_region_i,     // which
    input  wire                   lost_mark_i        // its mark
);

    reg decided_bits_q[0:REGIONS-1];
    reg lost_bits_q[0:REGIONS-1];
    reg decided_bit_q, lost_bit_q;
    wire lost_bit;

    // Any bit will do to begin with, if it stays the same; a simulator that knows of unknown ones must choose. It
    // chooses behind the read: a choice before the register keeps the memory out of block RAM.
    wire read_lost_bit = lost_bit_q === 1'b1;

    always @(posedge clk_i) begin
        decided_bit_q <= decided_bits_q[region_i];
        lost_bit_q    <= lost_bits_q[region_i];
        if (decided_i) decided_bits_q[decided_region_i] <= next_i ^ lost_bit;
        if (lost_i) lost_bits_q[lost_region_i] <= lost_mark_i;
        mark_o <= next_i ^ lost_bit;
    end

    word_delay #(.WIDTH(1), .DEPTH(DEEP)) u_lost_bit (.clk_i(clk_i), .data_i(read_lost_bit), .data_o(lost_bit));

    assign valid_o = (decided_bit_q ^ read_lost_bit) && !none_i;
    wire unused_reset = rst_i;

endmodule

`default_nettype wire
