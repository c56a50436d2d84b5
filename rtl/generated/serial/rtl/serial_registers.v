// SPDX-License-Identifier: MIT OR Apache-2.0
// Control registers of a group of lanes: those bits of a bundle that the design uses.
`default_nettype none

module serial_registers #(
    parameter WIDTH = 2,
    parameter [WIDTH-1:0] USED = 2'b11  // other bits are 0
) (
    input  wire             clk_i,
    input  wire             rst_i,
    input  wire [WIDTH-1:0] bits_i,
    output wire [WIDTH-1:0] bits_o
);

    wire unused_clock = clk_i && rst_i;  // where no bit is used

    genvar i;
    generate
        for (i = 0; i < WIDTH; i = i + 1) begin : g_bit
            if (USED[i]) begin : g_used
                reg bit_q;
                always @(posedge clk_i) begin
                    if (rst_i) bit_q <= 1'b0;
                    else bit_q <= bits_i[i];
                end
                assign bits_o[i] = bit_q;
            end else begin : g_unused
                wire unused_bit = bits_i[i];
                assign bits_o[i] = 1'b0;
            end
        end
    endgenerate

endmodule

`default_nettype wire
