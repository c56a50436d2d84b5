// SPDX-License-Identifier: MIT OR Apache-2.0
// A module with a port of every kind that the harness stores differently.
`default_nettype none

module tiny (
    input  wire         clk_i,
    input  wire         rst_i,
    input  wire [7:0]   a_i,
    input  wire [32:0]  b_i,
    input  wire [63:0]  c_i,
    input  wire [199:0] d_i,
    output wire         bit_o,
    output wire [11:0]  a_o,
    output reg  [32:0]  b_o,
    output reg  [63:0]  c_o,
    output reg  [199:0] d_o
);

    reg [11:0] count;
    wire unused = |a_i;

    always @(posedge clk_i) begin
        if (rst_i) begin
            count <= 12'd0;
            b_o <= 33'd0;
            c_o <= 64'd0;
            d_o <= 200'd0;
        end else begin
            count <= count + 12'd1;
            b_o <= ~b_i;
            c_o <= ~c_i;
            d_o <= ~d_i;
            // here
        end
    end

    assign bit_o = count[0];
    assign a_o = count;

endmodule

`default_nettype wire
