// SPDX-License-Identifier: MIT OR Apache-2.0
// Second pass of `segment`: counts the pixels that are above the mean by more than level_i, and those that are below it by more,
// over a frame that is read back from the store while the next frame enters it. score_o is the smaller count. It includes a
// pixel after the edge of its step. DEEP puts a register between the difference and its comparison, so that a pixel comes one
// clock before its step.
//
// The larger count is not kept. The smaller one grows with a pixel on the side that has had fewer pixels, and the surplus of
// pixels above says which side that is.
`default_nettype none

module segment_score #(
    parameter WIDTH = 8,       // bits of a pixel
    parameter FRACTION = 0,    // fraction bits of the mean
    parameter MEAN_BITS = 8,   // bits of the mean
    parameter PIXELS = 64,     // pixels of a region
    parameter SCORE_BITS = 6,  // bits of the score
    parameter DEEP = 0         // 0: pixel_i and mean_i come with step_i; 1: one clock earlier
) (
    input  wire                  clk_i,      // clock, rising edge
    input  wire                  rst_i,      // synchronous reset, active high
    input  wire                  enable_i,   // the store holds a whole frame; otherwise the score stays 0
    input  wire                  restart_i,  // the score is that of a whole frame and starts anew
    input  wire                  step_i,     // a pixel of the stored frame is read
    input  wire [     WIDTH-1:0] pixel_i,    // pixel of the stored frame
    input  wire [ MEAN_BITS-1:0] mean_i,     // mean of the stored frame
    input  wire [     WIDTH-1:0] level_i,    // a pixel counts if its distance from the mean is above this level
    output reg  [SCORE_BITS-1:0] score_o     // the smaller count so far
);

    // Limits: a value out of range stops elaboration at an instance of a module that does not exist.
    generate
        if (WIDTH < 1) begin : g_width WIDTH_must_be_1_or_more u_refused (); end
        if (FRACTION < 0 || FRACTION > 12) begin : g_fraction FRACTION_must_be_0_to_12 u_refused (); end
        if (MEAN_BITS < WIDTH + FRACTION) begin : g_mean_bits
            MEAN_BITS_must_be_WIDTH_and_FRACTION_or_more u_refused ();
        end
        if (PIXELS < 2) begin : g_pixels PIXELS_must_be_2_or_more u_refused (); end
        if (SCORE_BITS < $clog2(PIXELS / 2 + 1)) begin : g_score_bits
            SCORE_BITS_must_hold_half_of_PIXELS u_refused ();
        end
        if (DEEP != 0 && DEEP != 1) begin : g_deep_range DEEP_must_be_0_or_1 u_refused (); end
    endgenerate

    // The surplus is last used with the last pixel of a frame. Then it counts the pixels before that one, so it is below PIXELS.
    localparam SURPLUS_BITS = $clog2(PIXELS) + 1;

    wire [MEAN_BITS-1:0] scaled = {{(MEAN_BITS - WIDTH) {1'b0}}, pixel_i} << FRACTION;
    wire [MEAN_BITS-1:0] level = {{(MEAN_BITS - WIDTH) {1'b0}}, level_i} << FRACTION;
    wire [  MEAN_BITS:0] difference;
    wire far;

    generate
        if (DEEP) begin : g_deep
            reg [MEAN_BITS:0] difference_q;
            always @(posedge clk_i) difference_q <= {1'b0, scaled} - {1'b0, mean_i};
            assign difference = difference_q;
        end else begin : g_plain
            assign difference = {1'b0, scaled} - {1'b0, mean_i};
        end
    endgenerate

    magnitude_above #(.WIDTH(MEAN_BITS + 1)) u_far (
        .value_i(difference), .level_i(level), .above_o(far)
    );

    reg [SURPLUS_BITS-1:0] surplus_q;  // pixels above minus pixels below, signed

    wire counts = step_i && far;
    wire below = difference[MEAN_BITS];
    wire more_below = surplus_q[SURPLUS_BITS-1];
    wire more_above = !more_below && surplus_q != {SURPLUS_BITS{1'b0}};
    wire [SURPLUS_BITS-1:0] one = {{(SURPLUS_BITS - 1) {below}}, 1'b1};  // 1, or -1 for a pixel below

    always @(posedge clk_i) begin
        if (rst_i || !enable_i || restart_i) score_o <= {SCORE_BITS{1'b0}};
        else if (counts && (below ? more_above : more_below)) score_o <= score_o + 1'b1;

        if (rst_i || !enable_i) surplus_q <= {SURPLUS_BITS{1'b0}};
        else if (restart_i) surplus_q <= counts ? one : {SURPLUS_BITS{1'b0}};
        else if (counts) surplus_q <= surplus_q + one;
    end

endmodule

`default_nettype wire
