// SPDX-License-Identifier: MIT OR Apache-2.0
// Adds up the values of a frame, one per step. In the clock after the last step, done_o is 1 and sum_o is the sum of the frame.
`default_nettype none

module region_sum #(
    parameter WIDTH = 8,     // bits of a value
    parameter SUM_BITS = 14  // bits of the sum
) (
    input  wire                clk_i,    // clock, rising edge
    input  wire                rst_i,    // synchronous reset, active high
    input  wire                step_i,   // a value comes in
    input  wire                last_i,   // the value is the last of the frame
    input  wire [   WIDTH-1:0] value_i,  // the value of this step
    output reg                 done_o,   // the sum is that of a whole frame
    output reg  [SUM_BITS-1:0] sum_o     // sum of the values so far
);

    // Limits: a value out of range stops elaboration at an instance of a module that does not exist.
    generate
        if (WIDTH < 1) begin : g_width WIDTH_must_be_1_or_more u_refused (); end
        if (SUM_BITS < WIDTH) begin : g_sum_bits SUM_BITS_must_be_WIDTH_or_more u_refused (); end
    endgenerate

    wire [SUM_BITS-1:0] value = {{(SUM_BITS - WIDTH) {1'b0}}, value_i};

    always @(posedge clk_i) begin
        if (rst_i) begin
            done_o <= 1'b0;
            sum_o  <= {SUM_BITS{1'b0}};
        end else begin
            done_o <= step_i && last_i;
            if (step_i) sum_o <= (done_o ? {SUM_BITS{1'b0}} : sum_o) + value;
            else if (done_o) sum_o <= {SUM_BITS{1'b0}};
        end
    end

endmodule

`default_nettype wire
