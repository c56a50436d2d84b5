// SPDX-License-Identifier: MIT OR Apache-2.0
// A board with an array, and signals that have no pins: the sum after each frame, and the frame that takes over the last
// written thresholds.
`default_nettype none

module array_bench (
    input  wire        clk_p_i,
    input  wire        clk_n_i,
    input  wire        rx_i,
    output wire        tx_o,
    output wire [ 3:0] led_o,
    output wire        done_o,
    output wire [31:0] sum_o,
    output reg  [31:0] from_o
);

    board u_board (
        .clk_p_i(clk_p_i), .clk_n_i(clk_n_i), .rx_i(rx_i), .tx_o(tx_o), .led_o(led_o)
    );
    assign done_o = u_board.frame_done;
    assign sum_o = u_board.sum;

    // Counts the frames that have begun, and follows a write that waits for one.
    reg [31:0] begun_q = 32'd0;
    reg waits_q = 1'b0;
    always @(posedge u_board.clk) begin
        if (u_board.soon) begun_q <= begun_q + 1'b1;
        if (u_board.taken && waits_q) from_o <= begun_q;
        waits_q <= u_board.wready || (waits_q && !u_board.taken);
    end

endmodule

`default_nettype wire
