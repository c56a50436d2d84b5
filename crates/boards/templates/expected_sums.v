// SPDX-License-Identifier: MIT OR Apache-2.0
// {= banner =}
//
// Compares the sum behind each of the first {= sums.len() =} frames with what the model says.
`default_nettype none

module expected_sums (
    input  wire        clk_i,     // clock, rising edge
    input  wire        rst_i,     // synchronous reset, active high
    input  wire        done_i,    // the sum is that behind a frame
    input  wire [31:0] sum_i,     // that sum
    input  wire [31:0] frames_i,  // frames so far
    output reg         right_o,   // all sums have come, and were right
    output reg         wrong_o    // one was wrong
);

    reg [31:0] expected;
    always @*
        case (frames_i)
{%- for sum in sums %}
            32'd{= loop.index =}: expected = 32'h{= sum =};
{%- endfor %}
            default: expected = sum_i;
        endcase

    always @(posedge clk_i)
        if (rst_i) begin
            right_o <= 1'b0;
            wrong_o <= 1'b0;
        end else if (done_i) begin
            if (sum_i != expected) wrong_o <= 1'b1;
            if (frames_i == 32'd{= sums.len() =} && sum_i == expected && !wrong_o) right_o <= 1'b1;
        end

endmodule

`default_nettype wire
