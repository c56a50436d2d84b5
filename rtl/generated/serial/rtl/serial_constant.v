// SPDX-License-Identifier: MIT OR Apache-2.0
// Makes the constant of each step of the serial array: a level, or a number that is shifted from step to step until all of
// its bits have been used. constant_o belongs to the step of the same clock.
`default_nettype none

module serial_constant #(
    parameter WIDTH = 8,       // bits of a pixel
    parameter SIDE = 8,        // pixels of a side of a region
    parameter FILTER = 1,      // 0: none; 1: `median3x3`; 2: `switching3x3`; 3: `binomial3x3`
    parameter MAD = 0,         // 1: the design has the feature `mad`
    parameter VARIANCE = 0,    // 1: the design has the feature `variance`
    parameter RANGE = 0,       // 1: the design has the feature `range`
    parameter SURFACE = 0,     // 1: the design has the feature `surface`
    parameter SEGMENT = 0,     // 1: the design has the feature `segment`
    parameter FLOW = 0,        // 1: the design has the feature `flow`
    parameter WEIGHT_BITS = 1, // `flow`: bits of a weight
    parameter LEAST_BITS = 1,  // `flow`: bits of a sum times its weight
    parameter DISPLACEMENT_BITS = 1,  // `flow`: bits of a displacement
    parameter FRACTION = 0,    // fraction bits of the mean of `mad` and `segment`
    parameter BLOCK = 1,       // pixels of a block whose mean is sent; 1 without summaries
    parameter SUM_BITS = 14,   // bits of the sum of a region
    parameter COUNT_BITS = 7,  // bits of the number of pixels of a region
    parameter SCALE_BITS = 8,  // bits of the shifted number
    parameter ACC_BITS = 11    // bits of the accumulator
) (
    input  wire                clk_i,             // clock, rising edge
    input  wire [        50:0] step_i,            // the step: one bit for each action, in the order of serial_states
    input  wire                last_center_i,     // the center is the last of its square
    input  wire                ranges_i,          // the feature under way is `range`
    input  wire                squares_i,         // the feature under way is `variance`
    input  wire                surfaces_i,        // the feature under way is `surface`
    input  wire                segments_i,        // the feature under way is `segment`
    input  wire                flows_i,           // the feature under way is `flow`
    input  wire [         2:0] stage_i,           // stage of the pass of `flow`, see serial_states
    input  wire [WEIGHT_BITS-1:0] weight_i,       // `flow`: weight of the displacement
    input  wire [DISPLACEMENT_BITS-1:0] preceding_i, // `flow`: the displacement that was compared last
    input  wire [   WIDTH-1:0] temporal_level_i,  // a pixel has changed above this difference
    input  wire [   WIDTH+1:0] edge_half_i,       // half the level of `edge`, rounded down
    input  wire [   WIDTH-1:0] corner_level_i,    // level of `corner`
    input  wire [   WIDTH-1:0] segment_level_i,   // level of `segment`
    input  wire [   WIDTH-1:0] keen_temporal_level_i,  // temporal_level_i of keen regions
    input  wire [   WIDTH+1:0] keen_edge_half_i,       // edge_half_i of keen regions
    input  wire [   WIDTH-1:0] keen_corner_level_i,    // corner_level_i of keen regions
    input  wire [   WIDTH-1:0] keen_segment_level_i,   // segment_level_i of keen regions
    output wire [ACC_BITS-1:0] constant_o,        // the constant
    output wire [ACC_BITS-1:0] keen_constant_o,   // the constant of keen regions
    output wire                spent_o,           // the shifted number has no bits left
    output wire                divided_o,         // the division has found all bits of the quotient
    output wire                last_place_o,      // the shifted number is at its last place
    output wire                corrects_o,        // `variance`: the square of the sum has a bit at this place
    output wire                any_pairs_o,       // `variance`: the squares of words have pairs of bits at this place
    output wire                more_pairs_o       // `variance`: another pair of bits follows at this place
);

    localparam PIXELS = SIDE * SIDE;
    localparam BLENDS = FILTER == 3;  // 1: windows are summed
    localparam PLACES = WIDTH + COUNT_BITS;  // number of bit places of the sum of `variance`
    localparam SUMS = MAD || VARIANCE || RANGE || SURFACE || SEGMENT || FLOW;
    /* verilator lint_off WIDTH */
    localparam [ACC_BITS-1:0] HALF_PIXELS = PIXELS / 2;
    localparam [ACC_BITS-1:0] HALF_BLOCK = BLOCK / 2;
    // `segment` compares whole numbers with the mean, so the division is by n alone and gives the mean without its fraction. Half
    // of n is in units of the fraction. The fraction is not 0 if the remainder is above LARGEST_WHOLE.
    localparam [ACC_BITS-1:0] WHOLE_HALF = (PIXELS / 2) >> FRACTION;
    localparam [ACC_BITS-1:0] LARGEST_WHOLE = (PIXELS - PIXELS / 2 - 1) / (1 << FRACTION) + ((PIXELS / 2) >> FRACTION);
    localparam [ACC_BITS-1:0] HALF_WINDOW = 8;
    localparam [SCALE_BITS-1:0] UNIT = 1;
    localparam [SCALE_BITS-1:0] DIVISOR = PIXELS;
    localparam [COUNT_BITS-1:0] FACTOR = PIXELS;
    /* verilator lint_on WIDTH */

    // The bits of the step.
    wire loading, draining, rotating, unloading, shifting, denoising, bordering, temporal, copying;
    wire starting, searching, adjusting, probing, choosing, blending, reading, writing, relating, testing;
    wire gradient, gradient_test, ring, ring_test, ring_last;
    wire summing, doubling, halving, dividing, clearing, deviating, squaring, correcting, keeping, ranging, spreading;
    wire recalling, retrieving, removing, counting, spanning, leveling, below, rounding, shrinking;
    wire matching, lessening, noting;
    wire averaging, returning, storing, showing;
    assign {
        loading, draining, rotating, unloading, shifting,
        denoising, bordering, temporal, copying,
        starting, searching, adjusting, probing, choosing, blending, reading, writing, relating, testing,
        gradient, gradient_test, ring, ring_test, ring_last,
        summing, doubling, halving, dividing, clearing, deviating, squaring, correcting, keeping, ranging, spreading,
        recalling, retrieving, removing, counting, spanning, leveling, below, rounding, shrinking,
        matching, lessening, noting,
        averaging, returning, storing, showing
    } = step_i;
    wire unused_step = draining || denoising || bordering || temporal || copying || searching || probing || choosing || reading
        || writing || relating || gradient_test || ring_test || ring_last || deviating || keeping
        || spreading || removing || counting || spanning || below || shrinking || lessening || storing || showing;

    // The squares of `variance`: the bits of the result from the highest on, and for each of them all pairs of bits of n and of
    // a word that contribute to it. `zip_q` has a 1 at each bit of a word that meets a 1 of n.
    reg [SCALE_BITS-1:0] scale_q;
    wire [WIDTH-1:0] lowest;
    wire             place_ends;

    generate
        if (VARIANCE) begin : g_pairs
            reg  [PLACES-1:0] zip_q;
            reg  [ WIDTH-1:0] pairs_q;
            wire [ WIDTH-1:0] others = pairs_q & (pairs_q - 1'b1);
            wire [COUNT_BITS-1:0] mirrored;

            genvar i;
            for (i = 0; i < COUNT_BITS; i = i + 1) begin : g_mirror
                assign mirrored[i] = FACTOR[COUNT_BITS-1-i];
            end

            assign lowest = pairs_q & ~others;
            assign more_pairs_o = |others;
            assign any_pairs_o = |zip_q[WIDTH-1:0];
            assign corrects_o = SUM_BITS == PLACES || !scale_q[PLACES-1];
            assign place_ends = squares_i
                && (correcting
                    || (!corrects_o && ((doubling && !any_pairs_o)
                        || (squaring && last_center_i && !more_pairs_o))));

            always @(posedge clk_i) begin
                if (clearing) zip_q <= {mirrored, {WIDTH{1'b0}}};
                else if (place_ends) zip_q <= zip_q >> 1;
                if (doubling) pairs_q <= zip_q[WIDTH-1:0];
                else if (squaring && last_center_i) pairs_q <= others;
            end
        end else begin : g_no_pairs
            wire unused_pairs = last_center_i || doubling || correcting;
            assign corrects_o = 1'b0;
            assign lowest = {WIDTH{1'b0}};
            assign more_pairs_o = 1'b0;
            assign any_pairs_o = 1'b0;
            assign place_ends = 1'b0;
        end
    endgenerate

    // The shifted number.
    // A division ends when the divisor is back at its own places. `mad` and `segment` divide by the pixels of a region; `variance`,
    // `range` and `surface` divide by 1; `flow` divides by 1 or by the weight of a displacement.
    assign spent_o = scale_q == 0;
    wire flow_ends;  // `flow`: the shifted number is at its last place
    wire [SCALE_BITS-1:0] flow_start;  // `flow`: the shifted number that comes next
    wire flow_starts;                  // `flow`: flow_start becomes the shifted number at this edge

    generate
        if (FLOW) begin : g_flow
            // Stages with an odd number shift the weight, the others a 1. The next number is set in the last step of a stage, or in
            // the steps between two stages.
            wire [SCALE_BITS-1:0] weight = {{(SCALE_BITS - WEIGHT_BITS) {1'b0}}, weight_i};
            wire ends = flow_ends && (dividing || retrieving);
            wire [2:0] stage = stage_i + {2'b00, ends};
            assign flow_ends = scale_q == (stage_i[0] ? weight : UNIT);
            assign flow_starts = flows_i && (ends || matching || noting || clearing);
            assign flow_start = stage[0] ? weight << (SUM_BITS - 1)
                : stage == 3'd2 || stage == 3'd4 ? UNIT << (LEAST_BITS - 1) : UNIT << (SUM_BITS - 1);
        end else begin : g_no_flow
            wire unused_flow = flows_i || |stage_i || |weight_i || |preceding_i || matching || noting;
            assign flow_ends = 1'b0;
            assign flow_starts = 1'b0;
            assign flow_start = UNIT;
        end
    endgenerate

    assign divided_o = FLOW && flows_i ? flow_ends : scale_q == (squares_i || ranges_i || surfaces_i ? UNIT : MAD || SEGMENT ? DIVISOR : UNIT);
    assign last_place_o = FLOW && flows_i ? flow_ends : scale_q[0];

    always @(posedge clk_i) begin
        // It is set in the states before it is needed, so that it does not depend on the next state. While means leave, it is
        // already set for the medians of the next slot.
        if ((FILTER == 1 || FILTER == 2) && (loading || testing || unloading || shifting)) scale_q <= UNIT << (WIDTH - 1);
        else if (FLOW && flow_starts) scale_q <= flow_start;
        else if (SUMS && summing) begin
            scale_q <= squares_i ? UNIT << (SUM_BITS - 1)
                : SEGMENT && segments_i ? DIVISOR << (WIDTH - 1) : DIVISOR << (WIDTH + FRACTION - 1);
        end
        else if (RANGE && ranging) scale_q <= UNIT << (WIDTH - 1);
        else if (SURFACE && ((rotating && !returning) || (surfaces_i && (retrieving || dividing) && last_place_o))) begin
            scale_q <= UNIT << (SUM_BITS - 1);
        end else if (SEGMENT && clearing && segments_i) scale_q <= UNIT << (WIDTH - 1);
        else if (VARIANCE && clearing) scale_q <= UNIT << (PLACES - 1);
        else if (starting || adjusting || dividing || place_ends || recalling || retrieving) scale_q <= scale_q >> 1;
    end

    // The constant.
    reg [ACC_BITS-1:0] constant;
    wire [ACC_BITS+SCALE_BITS-1:0] wide_scale = {{ACC_BITS{1'b0}}, scale_q};
    wire [ACC_BITS+WIDTH-1:0] wide_temporal = {{ACC_BITS{1'b0}}, temporal_level_i};
    wire [ACC_BITS+WIDTH-1:0] wide_corner = {{ACC_BITS{1'b0}}, corner_level_i};
    wire [ACC_BITS+WIDTH-1:0] wide_segment = {{ACC_BITS{1'b0}}, segment_level_i};
    wire [ACC_BITS+WIDTH+1:0] wide_half = {{ACC_BITS{1'b0}}, edge_half_i};
    wire [ACC_BITS+WIDTH-1:0] wide_lowest = {{ACC_BITS{1'b0}}, lowest};
    wire [ACC_BITS+DISPLACEMENT_BITS-1:0] wide_preceding = {{ACC_BITS{1'b0}}, preceding_i};
    // `binomial3x3`: a pixel has changed if the sum of the window, less 16 times the reference, is 16 times the level plus 8 or
    // more, or below the negative of that, because halves are rounded up.
    wire [ACC_BITS+WIDTH+3:0] blend_level = {{ACC_BITS{1'b0}}, temporal_level_i, 4'd8};
    wire unused_wide = |blend_level || |wide_scale || |wide_temporal || |wide_corner || |wide_segment || |wide_half || |wide_lowest || |wide_preceding;

    always @* begin
        constant = {ACC_BITS{1'b0}};
        if (testing) constant = BLENDS ? blend_level[ACC_BITS-1:0] : wide_temporal[ACC_BITS-1:0];
        else if (blending) constant = HALF_WINDOW;
        else if (gradient) constant = wide_half[ACC_BITS-1:0];
        else if (ring) constant = wide_corner[ACC_BITS-1:0];
        else if (halving) constant = averaging ? HALF_BLOCK : SEGMENT && segments_i ? WHOLE_HALF : HALF_PIXELS;
        else if (leveling) constant = wide_segment[ACC_BITS-1:0];
        else if (rounding) constant = LARGEST_WHOLE;
        else if (squaring) constant = wide_lowest[ACC_BITS-1:0];
        else if (FLOW && noting) constant = wide_preceding[ACC_BITS-1:0];
        else if (FILTER == 1 || FILTER == 2 || SUMS) constant = wide_scale[ACC_BITS-1:0];
    end

    assign constant_o = constant;

    // The constant of keen regions differs only if it is a level.
    reg [ACC_BITS-1:0] keen_constant;
    wire [ACC_BITS+WIDTH-1:0] wide_keen_temporal = {{ACC_BITS{1'b0}}, keen_temporal_level_i};
    wire [ACC_BITS+WIDTH-1:0] wide_keen_corner = {{ACC_BITS{1'b0}}, keen_corner_level_i};
    wire [ACC_BITS+WIDTH-1:0] wide_keen_segment = {{ACC_BITS{1'b0}}, keen_segment_level_i};
    wire [ACC_BITS+WIDTH+1:0] wide_keen_half = {{ACC_BITS{1'b0}}, keen_edge_half_i};
    wire [ACC_BITS+WIDTH+3:0] keen_blend_level = {{ACC_BITS{1'b0}}, keen_temporal_level_i, 4'd8};
    wire unused_keen = |keen_blend_level || |wide_keen_temporal || |wide_keen_corner || |wide_keen_segment || |wide_keen_half;

    always @* begin
        keen_constant = constant;
        if (testing) keen_constant = BLENDS ? keen_blend_level[ACC_BITS-1:0] : wide_keen_temporal[ACC_BITS-1:0];
        else if (gradient) keen_constant = wide_keen_half[ACC_BITS-1:0];
        else if (ring) keen_constant = wide_keen_corner[ACC_BITS-1:0];
        else if (leveling) keen_constant = wide_keen_segment[ACC_BITS-1:0];
    end

    assign keen_constant_o = keen_constant;

endmodule

`default_nettype wire
