// SPDX-License-Identifier: MIT OR Apache-2.0
// Computes the largest minus the smallest value of a frame. range_o holds it after the second edge behind the last value.
`default_nettype none

module region_range #(
    parameter WIDTH = 8  // bits of a value
) (
    input  wire             clk_i,    // clock, rising edge
    input  wire             rst_i,    // synchronous reset, active high
    input  wire             step_i,   // a value comes in
    input  wire             last_i,   // the value is the last of the frame
    input  wire [WIDTH-1:0] value_i,  // the value of this step
    output reg  [WIDTH-1:0] range_o   // range of the last whole frame
);

    // Limits: a value out of range stops elaboration at an instance of a module that does not exist.
    generate
        if (WIDTH < 1) begin : g_width WIDTH_must_be_1_or_more u_refused (); end
    endgenerate

    reg fresh_q;  // the next value is the first of a frame
    reg done_q;   // the extremes are those of a whole frame
    reg [WIDTH-1:0] low_q, high_q;

    always @(posedge clk_i) begin
        if (step_i) begin
            fresh_q <= last_i;
            if (fresh_q || value_i < low_q) low_q <= value_i;
            if (fresh_q || value_i > high_q) high_q <= value_i;
        end
        done_q <= step_i && last_i && !rst_i;
        if (done_q) range_o <= high_q - low_q;
        if (rst_i) begin
            fresh_q <= 1'b1;
            range_o <= {WIDTH{1'b0}};
        end
    end

endmodule

`default_nettype wire
