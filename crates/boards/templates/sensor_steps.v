// SPDX-License-Identifier: MIT OR Apache-2.0
// {= banner =}
//
// What {= title =} is set up with: a bit for a pause, address, value of each step.
`default_nettype none

module sensor_steps (
    input  wire       clk_i,   // clock, rising edge
    input  wire [{= step_bits - 1 =}:0] step_i,  // number of a step
    output reg  [{= word_bits - 1 =}:0] word_o   // that step, a clock later
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
