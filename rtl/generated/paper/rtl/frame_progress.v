// SPDX-License-Identifier: MIT OR Apache-2.0
// Follows the frames that pass the tail since reset. All outputs are registers, valid after the edge of the step they
// follow from.
`default_nettype none

module frame_progress (
    input  wire clk_i,     // clock, rising edge
    input  wire rst_i,     // synchronous reset, active high
    input  wire step_i,    // a pixel enters the store
    input  wire last_i,    // the pixel is the last of the frame
    output reg  done_o,    // the counts are those of a whole frame, for one clock
    output reg  stored_o,  // the store holds a whole frame
    output reg  second_o   // with done_o: the frame is not the first since reset
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
