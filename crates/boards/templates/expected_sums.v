// SPDX-License-Identifier: MIT OR Apache-2.0
// {= banner =}
//
// Compares the sum after each of the first {= sums.len() =} frames with that of the model.
`default_nettype none

module expected_sums (
    input  wire        clk_i,     // clock, rising edge
    input  wire        rst_i,     // synchronous reset, active high
    input  wire        done_i,    // a frame is over, and sum_i is the sum after it
    input  wire [31:0] sum_i,     // the sum
    input  wire [31:0] frames_i,  // number of frames so far
    output reg         right_o,   // all sums have come and were right
    output reg         wrong_o    // at least one sum was wrong
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
