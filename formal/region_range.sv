// SPDX-License-Identifier: MIT OR Apache-2.0
// The range of a frame is the largest minus the smallest of its values, and stands until that of the next frame. A value is
// the largest or the smallest exactly if no other of the frame is beyond it, so both are followed in a count of values.
module properties #(parameter WIDTH = 2, parameter PIXELS = 4) (
    input wire clk_i, rst_i, step, input wire [WIDTH-1:0] value
);
    `include "reset.vh"
    wire last, done;
    wire [15:0] place, seen;
    frames #(.PIXELS(PIXELS)) u_frames (
        .clk_i(clk_i), .rst_i(rst_i), .step_i(step), .last_o(last), .done_o(done), .place_o(place), .seen_o(seen)
    );
    wire [WIDTH-1:0] range;
    region_range #(.WIDTH(WIDTH)) dut (
        .clk_i(clk_i), .rst_i(rst_i), .step_i(step), .last_i(last), .value_i(value), .range_o(range)
    );

    // A bit for each value that the frame has had.
    reg [(1<<WIDTH)-1:0] had = 0;
    reg [WIDTH-1:0] low, high, expected = 0;
    integer each;
    always @* begin
        low = 0;
        high = 0;
        for (each = 0; each < 1 << WIDTH; each = each + 1) if (had[each]) high = each;
        for (each = (1 << WIDTH) - 1; each >= 0; each = each - 1) if (had[each]) low = each;
    end
    always @(posedge clk_i) begin
        if (done) expected <= high - low;
        had <= (done ? 0 : had) | (step ? 1 << value : 0);
        if (rst_i) begin
            had <= 0;
            expected <= 0;
        end
    end
    always @* if (started) assert(range == expected);
endmodule
