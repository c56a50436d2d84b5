// SPDX-License-Identifier: MIT OR Apache-2.0
// Second pass of the mean absolute deviation: adds up |2^FRACTION * pixel - mean| over a frame that
// is read back from the store while the next one enters it.
`default_nettype none

module deviation_sum #(
    parameter WIDTH = 8,      // bits of a pixel
    parameter FRACTION = 0,   // fraction bits of the mean
    parameter MEAN_BITS = 8,  // bits of the mean
    parameter SUM_BITS = 14   // bits of the sum
) (
    input  wire                 clk_i,
    input  wire                 rst_i,
    input  wire                 enable_i,   // there is a stored frame; without one the sum stays 0
    input  wire                 restart_i,  // the sum is that of a whole frame
    input  wire                 step_i,
    input  wire [    WIDTH-1:0] pixel_i,    // of the stored frame
    input  wire [MEAN_BITS-1:0] mean_i,     // of the stored frame
    output reg  [ SUM_BITS-1:0] sum_o
);

    wire [MEAN_BITS-1:0] scaled = {{(MEAN_BITS - WIDTH) {1'b0}}, pixel_i} << FRACTION;
    wire [MEAN_BITS-1:0] deviation = scaled < mean_i ? mean_i - scaled : scaled - mean_i;
    wire [ SUM_BITS-1:0] term = {{(SUM_BITS - MEAN_BITS) {1'b0}}, deviation};

    always @(posedge clk_i) begin
        if (rst_i || !enable_i) sum_o <= {SUM_BITS{1'b0}};
        else if (step_i) sum_o <= (restart_i ? {SUM_BITS{1'b0}} : sum_o) + term;
        else if (restart_i) sum_o <= {SUM_BITS{1'b0}};
    end

endmodule

`default_nettype wire
