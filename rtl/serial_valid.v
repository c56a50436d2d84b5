// SPDX-License-Identifier: MIT OR Apache-2.0
// One bit per region: it has a reference. Distributed RAM with a single port while it is small; above,
// block RAM, which is read a clock ahead. What is read ahead is not written in between.
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

    generate
        if (REGIONS <= 8192) begin : g_distributed
            wire unused_next = |next_i;
            frame_store #(
                .WIDTH(1), .PIXELS(REGIONS > 1 ? REGIONS : 2), .SLOT_BITS(REGION_BITS)
            ) u_store (
                .clk_i(clk_i), .write_i(write_i), .slot_i(region_i), .data_i(valid_i), .data_o(valid_o)
            );
        end else begin : g_block
            (* ram_style = "block" *)
            reg valid_q[0:REGIONS-1];
            reg read_q;

            always @(posedge clk_i) begin
                if (write_i) valid_q[region_i] <= valid_i;
                read_q <= valid_q[next_i];
            end

            assign valid_o = read_q;
        end
    endgenerate

endmodule

`default_nettype wire
