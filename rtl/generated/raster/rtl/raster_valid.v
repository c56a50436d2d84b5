// SPDX-License-Identifier: MIT OR Apache-2.0
// Keeps one flag per region: it has a valid reference. Decisions and losses write the flag, perhaps at one edge, so
// each region has two bits with one writer each, and the reference is valid if they differ. valid_o comes one clock after
// region_i.
`default_nettype none

module raster_valid #(
    parameter REGIONS = 64,     // regions of the frame
    parameter REGION_BITS = 6,  // ceil(log2(REGIONS))
    parameter DEEP = 0          // clocks from valid_o to the decision of that region
) (
    input  wire                   clk_i,             // clock, rising edge
    input  wire                   rst_i,             // synchronous reset, active high
    input  wire                   none_i,            // no region has a valid reference
    input  wire [REGION_BITS-1:0] region_i,          // number of the region that is looked up
    output wire                   valid_o,           // the region that was looked up one clock ago has a valid reference
    input  wire                   decided_i,         // a region is decided
    input  wire [REGION_BITS-1:0] decided_region_i,  // number of that region, which valid_o showed DEEP clocks ago
    input  wire                   next_i,            // the region has a valid reference from now on
    output reg                    mark_o,            // the bit that a loss of this region must write, one clock later
    input  wire                   lost_i,            // a region is lost
    input  wire [REGION_BITS-1:0] lost_region_i,     // number of the lost region
    input  wire                   lost_mark_i        // mark_o of the lost region
);

    reg decided_bits_q[0:REGIONS-1];
    reg lost_bits_q[0:REGIONS-1];
    reg decided_bit_q, lost_bit_q;
    wire lost_bit;

    // Any initial bit is right, if it stays the same. A simulator with unknown values must choose one, and the choice is behind
    // the read, because a choice before the register would keep the memory out of block RAM.
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
