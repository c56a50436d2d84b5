// SPDX-License-Identifier: MIT OR Apache-2.0
// Sends bytes on a serial line: 8 bits, the lowest first, no parity, one stop bit. Bytes may follow each other without a pause.
`default_nettype none

module uart_sender #(
    parameter DIVISOR = 4  // clocks of a bit, at least 2
) (
    input  wire       clk_i,    // clock, rising edge
    input  wire       rst_i,    // synchronous reset, active high
    input  wire       valid_i,  // a byte is offered
    input  wire [7:0] byte_i,   // the offered byte
    output wire       ready_o,  // the offered byte is taken
    output wire       tx_o      // the serial line
);

    // Limits: a value out of range stops elaboration at an instance of a module that does not exist.
    generate
        if (DIVISOR < 2) begin : g_divisor DIVISOR_must_be_2_or_more u_refused (); end
    endgenerate

    localparam TIME_BITS = $clog2(DIVISOR);
    localparam LAST = DIVISOR - 1;
    reg [TIME_BITS-1:0] time_q;  // clocks left of the bit
    reg [9:0] bits_q;            // bits left of the byte; the highest 1 is the stop bit
    initial bits_q = 10'd1;      // the line rests at 1
    wire bit_ends = time_q == {TIME_BITS{1'b0}};
    wire stop = bits_q[9:1] == 9'd0;

    always @(posedge clk_i) begin
        if (!bit_ends) time_q <= time_q - 1'b1;
        else if (!stop || valid_i) time_q <= LAST[TIME_BITS-1:0];
        if (bit_ends) begin
            if (!stop) bits_q <= bits_q >> 1;
            else if (valid_i) bits_q <= {1'b1, byte_i, 1'b0};
        end
        if (rst_i) begin
            time_q <= {TIME_BITS{1'b0}};
            bits_q <= 10'd1;
        end
    end

    assign ready_o = bit_ends && stop;
    assign tx_o = bits_q[0];

endmodule

`default_nettype wire
