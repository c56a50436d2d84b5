// SPDX-License-Identifier: MIT OR Apache-2.0
// One bit per region: it has a reference. Read a clock ahead; what is read is not written in between.
`default_nettype none

module serial_valid #(
    parameter REGIONS = 784,    // empty slots included
    parameter REGION_BITS = 10  // at least 1
) (
    input  wire                   clk_i,
    input  wire [REGION_BITS-1:0] next_i,    // the region of the next clock
    output wire                   valid_o,   // of the region of this clock
    input  wire                   write_i,
    input  wire [REGION_BITS-1:0] region_i,  // of this clock
    input  wire                   valid_i
);

    reg valid_q[0:REGIONS-1];
    reg read_q;

    always @(posedge clk_i) begin
        if (write_i) valid_q[region_i] <= valid_i;
        read_q <= valid_q[next_i];
    end

    assign valid_o = read_q;

endmodule

`default_nettype wire
