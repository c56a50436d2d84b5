// SPDX-License-Identifier: MIT OR Apache-2.0
// A module whose outputs mean something only with valid bits: else they show what has nothing to do
// with the inputs, and X in simulators that know it.
`default_nettype none

module gated (
    input  wire        clk_i,
    input  wire        rst_i,
    input  wire [2:0]  valid_i,
    input  wire [23:0] lanes_i,
    input  wire [7:0]  all_i,
    output reg  [2:0]  valid_o,
    output wire [23:0] lanes_o,
    output wire [7:0]  all_o
);

    reg [23:0] lanes_q;
    reg [7:0]  all_q;
    reg [7:0]  count_q;
    wire [7:0] garbage = count_q ^ 8'hxx;

    always @(posedge clk_i) begin
        count_q <= rst_i ? 8'd0 : count_q + 8'd1;
        valid_o <= rst_i ? 3'd0 : valid_i;
        lanes_q <= lanes_i;
        all_q <= all_i;
    end

    assign lanes_o = {
        valid_o[2] ? lanes_q[23:16] : garbage,
        valid_o[1] ? lanes_q[15:8] : garbage,
        valid_o[0] ? lanes_q[7:0] : garbage
    };
    assign all_o = valid_o != 0 ? all_q : garbage;

endmodule

`default_nettype wire
