// SPDX-License-Identifier: MIT OR Apache-2.0
// Tells where the tail is in the sequence of frames since reset.
`default_nettype none

module frame_progress (
    input  wire clk_i,     // clock, rising edge
    input  wire rst_i,     // synchronous reset, active high
    input  wire step_i,    // a pixel enters the store
    input  wire last_i,    // the pixel is the last of the frame
    output reg  done_o,    // for one clock: the counts are those of a whole frame
    output reg  stored_o,  // the store holds a whole frame
    output reg  second_o   // with done_o: it is not the first frame
);

    always @(posedge clk_i) begin
        if (rst_i) begin
            done_o   <= 1'b0;
            stored_o <= 1'b0;
            second_o <= 1'b0;
        end else begin
            done_o <= step_i && last_i;
            if (step_i && last_i) begin
                stored_o <= 1'b1;
                second_o <= stored_o;
            end
        end
    end

endmodule

`default_nettype wire
