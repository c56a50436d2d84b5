// SPDX-License-Identifier: MIT OR Apache-2.0
// Takes the class of a region for a frame at the first step of the frame, and keeps it up to the last one. So class_i may
// change at any other time.
`default_nettype none

module region_class (
    input  wire       clk_i,    // clock, rising edge
    input  wire       rst_i,    // synchronous reset, active high
    input  wire       step_i,   // a pixel of the region leaves the last window
    input  wire       last_i,   // the pixel is the last of its frame
    input  wire [1:0] class_i,  // class of the next frame
    output wire [1:0] class_o,  // class of the frame of this step
    output wire [1:0] held_o    // class of the frame of the last step, in the clock after that step
);

    reg first_q;  // the next step is the first of its frame
    reg [1:0] class_q;

    assign class_o = first_q ? class_i : class_q;
    assign held_o = class_q;

    always @(posedge clk_i) begin
        if (rst_i) first_q <= 1'b1;
        else if (step_i) first_q <= last_i;
        if (first_q) class_q <= class_i;
    end

endmodule

`default_nettype wire
