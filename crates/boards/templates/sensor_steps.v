// SPDX-License-Identifier: MIT OR Apache-2.0
// {= banner =}
//
// The set-up of {= title =}: for each step one bit that makes it a pause, then the address and the value.
`default_nettype none

module sensor_steps (
    input  wire       clk_i,   // clock, rising edge
    input  wire [{= step_bits - 1 =}:0] step_i,  // number of a step
    output reg  [{= word_bits - 1 =}:0] word_o   // the step with this number, one clock later
);

    always @(posedge clk_i)
        case (step_i)
{%- for word in words %}
            {= step_bits =}'d{= loop.index0 =}: word_o <= {= word_bits =}'h{= word =};
{%- endfor %}
            default: word_o <= {= word_bits =}'h0;
        endcase

endmodule

`default_nettype wire
