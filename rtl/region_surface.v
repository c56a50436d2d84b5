// SPDX-License-Identifier: MIT OR Apache-2.0
// Computes the smallest of four sums over a frame, of the distances of each pixel from its right, its lower, its lower right and
// its lower left neighbor. score_o holds it two clocks after the last step; with DEEP, which puts a register between difference and
// sum, three clocks after it.
`default_nettype none

module region_surface #(
    parameter WIDTH = 8,        // bits of a pixel
    parameter SCORE_BITS = 14,  // bits of a sum
    parameter DEEP = 0          // 0: a distance is added in the clock of its step; 1: one clock later
) (
    input  wire                  clk_i,      // clock, rising edge
    input  wire                  rst_i,      // synchronous reset, active high
    input  wire                  advance_i,  // the window moves by one column at this edge
    input  wire                  step_i,     // the window is complete with the incoming column
    input  wire                  last_i,     // the center is the last of the frame
    input  wire                  left_i,     // the incoming column is the first of its row
    input  wire                  right_i,    // the center is the last of its row
    input  wire [     WIDTH-1:0] middle_i,   // middle pixel of the incoming column
    input  wire [     WIDTH-1:0] lower_i,    // lower pixel of the incoming column
    output reg  [SCORE_BITS-1:0] score_o     // smallest sum of the last whole frame
);

    // Limits: a value out of range stops elaboration at an instance of a module that does not exist.
    generate
        if (WIDTH < 1) begin : g_width WIDTH_must_be_1_or_more u_refused (); end
        if (SCORE_BITS < WIDTH) begin : g_score_bits SCORE_BITS_must_be_WIDTH_or_more u_refused (); end
        if (DEEP != 0 && DEEP != 1) begin : g_deep_range DEEP_must_be_0_or_1 u_refused (); end
    endgenerate

    function [SCORE_BITS-1:0] lesser(input [SCORE_BITS-1:0] a, input [SCORE_BITS-1:0] b);
        lesser = a < b ? a : b;
    endfunction

    reg [WIDTH-1:0] center_q, below_q;  // the center and the pixel below it
    reg [WIDTH-1:0] left_below_q;       // the pixel on the left of the one below

    always @(posedge clk_i) begin
        if (advance_i) begin
            center_q     <= middle_i;
            below_q      <= lower_i;
            left_below_q <= left_i ? lower_i : below_q;
        end
    end

    wire [  WIDTH-1:0] right = right_i ? center_q : middle_i;
    wire [  WIDTH-1:0] right_below = right_i ? below_q : lower_i;
    wire [4*WIDTH-1:0] neighbors = {left_below_q, right_below, below_q, right};

    // Steps of the sums. The sums of a whole frame are compared in the clock of its last step, and start anew in the next one.
    wire sum_step, sum_last;
    wire [4*SCORE_BITS-1:0] sums;  // with the distances of this step
    genvar i;

    generate
        if (DEEP) begin : g_deep
            reg step_q, last_q;
            always @(posedge clk_i) begin
                step_q <= step_i && !rst_i;
                last_q <= last_i;
            end
            assign sum_step = step_q;
            assign sum_last = last_q;
        end else begin : g_plain
            assign sum_step = step_i;
            assign sum_last = last_i;
        end

        for (i = 0; i < 4; i = i + 1) begin : g_neighbor
            wire [WIDTH:0] difference = {1'b0, center_q} - {1'b0, neighbors[i*WIDTH+:WIDTH]};
            wire [WIDTH:0] added;
            if (DEEP) begin : g_register
                reg [WIDTH:0] difference_q;
                always @(posedge clk_i) difference_q <= difference;
                assign added = difference_q;
            end else begin : g_wire
                assign added = difference;
            end

            // A negative difference is inverted, which gives one less than its magnitude. The carry adds the missing one.
            wire negative = added[WIDTH];
            wire [SCORE_BITS-1:0] inverted = {{(SCORE_BITS - WIDTH) {1'b0}}, added[WIDTH-1:0] ^ {WIDTH{negative}}};
            reg  [SCORE_BITS-1:0] sum_q;

            carry_adder #(.WIDTH(SCORE_BITS)) u_sum (
                .plain_i(sum_q), .other_i(inverted), .carry_i(negative), .sum_o(sums[i*SCORE_BITS+:SCORE_BITS])
            );

            always @(posedge clk_i) begin
                if (rst_i || (sum_step && sum_last)) sum_q <= {SCORE_BITS{1'b0}};
                else if (sum_step) sum_q <= sums[i*SCORE_BITS+:SCORE_BITS];
            end
        end
    endgenerate

    reg done_q;  // the two sums below are those of a whole frame
    reg [SCORE_BITS-1:0] straight_q;  // the smaller one of the sums of the right and the lower neighbors
    reg [SCORE_BITS-1:0] diagonal_q;  // the smaller one of the other two

    always @(posedge clk_i) begin
        straight_q <= lesser(sums[0+:SCORE_BITS], sums[SCORE_BITS+:SCORE_BITS]);
        diagonal_q <= lesser(sums[2*SCORE_BITS+:SCORE_BITS], sums[3*SCORE_BITS+:SCORE_BITS]);
        done_q <= sum_step && sum_last && !rst_i;
        if (rst_i) score_o <= {SCORE_BITS{1'b0}};
        else if (done_q) score_o <= lesser(straight_q, diagonal_q);
    end

endmodule

`default_nettype wire
