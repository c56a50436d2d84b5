// SPDX-License-Identifier: MIT OR Apache-2.0
// Every step of a frame has the class of class_i at the first step of the frame. In the clock after a step, held_o is the class
// of that step.
module properties #(parameter PIXELS = 4) (
    input wire clk_i, rst_i, step, input wire [1:0] class_i
);
    `include "reset.vh"
    wire last, done;
    wire [15:0] place, seen;
    frames #(.PIXELS(PIXELS)) u_frames (
        .clk_i(clk_i), .rst_i(rst_i), .step_i(step), .last_o(last), .done_o(done), .place_o(place), .seen_o(seen)
    );
    wire [1:0] class_o, held;
    region_class dut (
        .clk_i(clk_i), .rst_i(rst_i), .step_i(step), .last_i(last), .class_i(class_i), .class_o(class_o), .held_o(held)
    );

    reg [1:0] first = 0, stepped = 0;  // the class of the first step of the frame, and that of the last step
    reg has_stepped = 0;
    wire [1:0] expected = place == 0 ? class_i : first;
    always @(posedge clk_i) begin
        has_stepped <= step && !rst_i;
        if (step) begin
            first <= expected;
            stepped <= expected;
        end
    end
    always @* begin
        if (started && step) assert(class_o == expected);
        if (started && has_stepped) assert(held == stepped);
    end
endmodule
