// SPDX-License-Identifier: MIT OR Apache-2.0
// A sender with a receiver, and the line between them by its definition. A second receiver gets an arbitrary line.
module properties #(parameter DIVISOR = 4) (input wire clk_i, rst_i, valid, noise, input wire [7:0] value);
    `include "reset.vh"
    wire taken, line, received, noise_received;
    wire [7:0] found, noise_found;
    uart_sender #(.DIVISOR(DIVISOR)) sender (.clk_i(clk_i), .rst_i(rst_i), .valid_i(valid), .byte_i(value), .ready_o(taken), .tx_o(line));
    uart_receiver #(.DIVISOR(DIVISOR)) receiver (.clk_i(clk_i), .rst_i(rst_i), .rx_i(line), .valid_o(received), .byte_o(found));
    uart_receiver #(.DIVISOR(DIVISOR)) other (.clk_i(clk_i), .rst_i(rst_i), .rx_i(noise), .valid_o(noise_received), .byte_o(noise_found));

    // The sent byte takes 10 bits, and the next one may begin at once.
    reg [7:0] sent, sent_before;
    reg [6:0] left, left_before;  // clocks left of the byte
    wire [9:0] frame = {1'b1, sent, 1'b0};
    // After a reset the receiver needs the line at rest before a byte may come.
    reg [2:0] rested;
    always @(posedge clk_i) rested <= rst_i ? 0 : rested == 7 ? 7 : rested + 1;
    always @* assume(!valid || rested == 7);
    integer number;
    always @(posedge clk_i) begin
        if (left != 0) left <= left - 1;
        if (valid && taken) begin
            sent <= value;
            left <= 10 * DIVISOR;
        end
        {sent_before, left_before} <= {sent, left};
        if (rst_i) {left, left_before} <= 0;
    end

    // The second line as the receiver sees it, two clocks late, and the place of its last bit.
    reg first, second;
    always @(posedge clk_i) {second, first} <= {first, noise};
    reg was_second;
    always @(posedge clk_i) was_second <= second;

    always @* if (started) begin
        assert(taken == (left <= 1));
        if (left == 0) assert(line);
        for (number = 0; number < 10; number = number + 1)
            if (left > number * DIVISOR && left <= (number + 1) * DIVISOR) assert(line == frame[9-number]);
        // A byte is received once its stop bit has ended: two clocks late, and from the middle on.
        assert(received == (left_before == 1));
        if (received) assert(found == sent_before);
        // No byte comes of a line without its stop bit.
        if (noise_received) assert(was_second);
    end
endmodule
