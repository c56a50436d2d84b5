// SPDX-License-Identifier: MIT OR Apache-2.0
// Second pass of the mean absolute deviation: adds up |2^FRACTION * pixel - mean| over a frame that is read back from the
// store while the next frame enters it. sum_o includes a pixel after the edge of its step. DEEP puts a register between
// the difference and the sum, so that a pixel comes one clock before its step.
`default_nettype none

module deviation_sum #(
    parameter WIDTH = 8,      // bits of a pixel
    parameter FRACTION = 0,   // fraction bits of the mean
    parameter MEAN_BITS = 8,  // bits of the mean
    parameter SUM_BITS = 14,  // bits of the sum
    parameter DEEP = 0        // 0: pixel_i and mean_i come with step_i; 1: one clock earlier
) (
    input  wire                 clk_i,      // clock, rising edge
    input  wire                 rst_i,      // synchronous reset, active high
    input  wire                 enable_i,   // the store holds a whole frame; otherwise the sum stays 0
    input  wire                 restart_i,  // the sum is that of a whole frame and starts anew
    input  wire                 step_i,     // a pixel of the stored frame is read
    input  wire [    WIDTH-1:0] pixel_i,    // pixel of the stored frame
    input  wire [MEAN_BITS-1:0] mean_i,     // mean of the stored frame
    output reg  [ SUM_BITS-1:0] sum_o       // sum of the deviations so far
);

    // Limits: a value out of range stops elaboration at an instance of a module that does not exist.
    generate
        if (WIDTH < 1) begin : g_width WIDTH_must_be_1_or_more u_refused (); end
        if (FRACTION < 0 || FRACTION > 12) begin : g_fraction FRACTION_must_be_0_to_12 u_refused (); end
        if (MEAN_BITS < WIDTH + FRACTION) begin : g_mean_bits
            MEAN_BITS_must_be_WIDTH_and_FRACTION_or_more u_refused ();
        end
        if (SUM_BITS < MEAN_BITS) begin : g_sum_bits
            SUM_BITS_must_be_MEAN_BITS_or_more u_refused ();
        end
        if (DEEP != 0 && DEEP != 1) begin : g_deep_range DEEP_must_be_0_or_1 u_refused (); end
    endgenerate

    wire [MEAN_BITS-1:0] scaled = {{(MEAN_BITS - WIDTH) {1'b0}}, pixel_i} << FRACTION;
    wire [ SUM_BITS-1:0] start = restart_i ? {SUM_BITS{1'b0}} : sum_o;
    wire [ SUM_BITS-1:0] next;

    generate
        if (DEEP) begin : g_deep
            // A negative difference is inverted, which gives one less than its magnitude. A carry from below the lowest bit adds
            // the missing one.
            reg [MEAN_BITS:0] difference_q;
            wire negative = difference_q[MEAN_BITS];
            wire unused_low;
            wire [MEAN_BITS-1:0] inverted = difference_q[MEAN_BITS-1:0] ^ {MEAN_BITS{negative}};
            always @(posedge clk_i) difference_q <= {1'b0, scaled} - {1'b0, mean_i};

            assign {next, unused_low} = {start, 1'b1} + {{(SUM_BITS - MEAN_BITS) {1'b0}}, inverted, negative};
        end else begin : g_plain
            wire [MEAN_BITS-1:0] deviation = scaled < mean_i ? mean_i - scaled : scaled - mean_i;
            assign next = start + {{(SUM_BITS - MEAN_BITS) {1'b0}}, deviation};
        end
    endgenerate

    always @(posedge clk_i) begin
        if (rst_i || !enable_i) sum_o <= {SUM_BITS{1'b0}};
        else if (step_i) sum_o <= next;
        else if (restart_i) sum_o <= {SUM_BITS{1'b0}};
    end

endmodule

`default_nettype wire
