// SPDX-License-Identifier: MIT OR Apache-2.0
// Receives bytes from a serial line: 8 bits, the lowest first, no parity, one stop bit. A byte without its stop bit is left
// out. valid_o is 1 for one clock, about the middle of the stop bit.
`default_nettype none

module uart_receiver #(
    parameter DIVISOR = 4  // clocks of a bit, at least 4
) (
    input  wire       clk_i,    // clock, rising edge
    input  wire       rst_i,    // synchronous reset, active high
    input  wire       rx_i,     // the line, asynchronous
    output wire       valid_o,  // a byte has come, for one clock
    output wire [7:0] byte_o    // the byte, in the clock of valid_o
);

    // Limits: a value out of range stops elaboration at an instance of a module that does not exist.
    generate
        if (DIVISOR < 4) begin : g_divisor DIVISOR_must_be_4_or_more u_refused (); end
    endgenerate

    // The line is seen up to one clock late, so the middle of a bit is rounded down.
    localparam TIME_BITS = $clog2(DIVISOR);
    localparam LAST = DIVISOR - 1;
    localparam HALF = (DIVISOR - 1) / 2 - 1;
    (* ASYNC_REG = "TRUE" *) reg first_q, rx_q;
    reg before_q;                // the line one clock ago
    reg busy_q, start_q;         // a byte comes; its start bit is next
    reg valid_q;
    reg [TIME_BITS-1:0] time_q;  // clocks until the middle of the next bit
    reg [8:0] bits_q;            // the bits that have come; the start bit is the lowest when all have come
    wire middle = busy_q && time_q == {TIME_BITS{1'b0}};

    always @(posedge clk_i) begin
        first_q  <= rx_i;
        rx_q     <= first_q;
        before_q <= rx_q;
        valid_q  <= 1'b0;
        time_q   <= middle ? LAST[TIME_BITS-1:0] : time_q - 1'b1;
        if (middle) begin
            start_q <= 1'b0;
            if (!bits_q[0] || (start_q && rx_q)) busy_q <= 1'b0;
            valid_q <= !bits_q[0] && rx_q;
            if (bits_q[0]) bits_q <= {rx_q, bits_q[8:1]};
        end
        if (!busy_q && before_q && !rx_q) begin
            busy_q  <= 1'b1;
            start_q <= 1'b1;
            time_q  <= HALF[TIME_BITS-1:0];
            bits_q  <= 9'h1FF;
        end
        if (rst_i) begin
            // No byte begins before the line has been at rest.
            before_q <= 1'b0;
            busy_q   <= 1'b0;
            valid_q  <= 1'b0;
        end
    end

    assign valid_o = valid_q;
    assign byte_o = bits_q[8:1];

endmodule

`default_nettype wire
