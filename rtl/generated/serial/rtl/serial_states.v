// SPDX-License-Identifier: MIT OR Apache-2.0
// The sequencer's states: which step follows which in the serial array, one step per clock, the same for all lanes. In some
// states a step does a part of a pixel's work: `tap` says which neighbor is read, `part` which half of the work is done.
//
// step_o has one bit for each action of the step. docs/serial.md defines the steps. serial_addresses, serial_constant and
// serial_controls take step_o apart by the same list of names, and serial_sequencer takes the first and the last of them.
`default_nettype none

module serial_states #(
    parameter FILTER = 1,     // 0: none; 1: `median3x3`; 2: `switching3x3`; 3: `binomial3x3`
    parameter BORDERS = 0,    // 1: sides on the frame's border are repeated
    parameter COPIES = 0,     // not 0: the reference is copied after the last score; 0: it is overwritten pixel by pixel
    parameter RASTER = 0,     // 1: pixels leave through the chain of scores
    parameter LATE = 0,       // clocks from an address to the accumulator, 0 to 3
    parameter DEEP = 0,       // 1: a score is whole one clock after its last step
    parameter EDGE = 1,       // 1: the design has the feature `edge`
    parameter CORNER = 0,     // 1: the design has the feature `corner`
    parameter MAD = 0,        // 1: the design has the feature `mad`
    parameter VARIANCE = 0,   // 1: the design has the feature `variance`
    parameter RANGE = 0,      // 1: the design has the feature `range`
    parameter SURFACE = 0,    // 1: the design has the feature `surface`
    parameter SEGMENT = 0,    // 1: the design has the feature `segment`
    parameter FLOW = 0,       // 1: the design has the feature `flow`
    parameter FRACTION = 0,   // fraction bits of the mean of `mad`
    parameter SUMMARIES = 0,  // 1: irrelevant regions send the means of their blocks
    parameter ZONES = 0       // 1: regions have classes
) (
    input  wire        clk_i,          // clock, rising edge
    input  wire        rst_i,          // synchronous reset, active high
    input  wire        start_i,        // a frame is complete
    // Flags of the last step of each kind.
    input  wire        last_column_i,  // the center of the step is the last of its row
    input  wire        last_center_i,  // the center of the step is the last of its square
    input  wire        last_lane_i,    // the score of the last lane passes
    input  wire        first_score_i,  // this score is the first of the slot
    input  wire        last_score_i,   // this score is the last of the slot
    input  wire        last_block_i,   // the block is the last of the region
    input  wire        last_slot_i,    // the slot is the last of the frame
    input  wire        next_edge_i,    // the feature that comes next is `edge`
    input  wire        next_corner_i,  // the feature that comes next is `corner`
    input  wire        next_range_i,   // the feature that comes next is `range`
    input  wire        next_surface_i, // the feature that comes next is `surface`
    input  wire        next_flow_i,    // the feature that comes next is `flow`
    input  wire        ranges_i,       // the feature under way is `range`
    input  wire        squares_i,      // the feature under way is `variance`
    input  wire        surfaces_i,     // the feature under way is `surface`
    input  wire        segments_i,     // the feature under way is `segment`
    input  wire        flows_i,        // the feature under way is `flow`
    input  wire        last_displacement_i,  // `flow`: the displacement is the last one
    // State of the constant.
    input  wire        spent_i,        // the shifted number has no bits left
    input  wire        divided_i,      // the division has found all bits of the quotient
    input  wire        last_place_i,   // the shifted number is at its last place
    input  wire        corrects_i,     // `variance`: the square of the sum has a bit at this place
    input  wire        any_pairs_i,    // `variance`: the squares of words have pairs of bits at this place
    input  wire        more_pairs_i,   // `variance`: another pair of bits follows at this place
    // The step.
    output wire [50:0] step_o,         // the step: one bit for each action
    output wire [ 3:0] tap_o,          // number of the neighbor that is read
    output wire [ 1:0] part_o,         // half of a gradient or of a pair of steps, part of a filter or of a ring's step, or side of the border
    output wire        walks_o,        // the next step works on the next center
    output wire        block_ends_o,   // the next step works on the next block, for its sum or its mean
    output wire        slot_ends_o,    // the next step works on the next slot
    output wire        classing_o,     // the classes of regions pass; the step has no other action
    output wire [ 2:0] stage_o,        // stage of the pass of `flow`
    output wire        compared_o      // `flow`: the displacement has been compared
);

    localparam [5:0] LOAD = 6'd0;      // a frame enters
    localparam [5:0] DRAIN = 6'd1;     // one clock for the last step
    localparam [5:0] START = 6'd2;     // median: the first candidate
    localparam [5:0] SEARCH = 6'd3;    // median: nine comparisons and one adjustment per bit
    localparam [5:0] READ = 6'd4;      // reads a word that is compared, or written to another place
    localparam [5:0] IDLE = 6'd5;      // the accumulator is one step behind
    localparam [5:0] WRITE = 6'd6;
    localparam [5:0] REFERENCE = 6'd7;
    localparam [5:0] TEST = 6'd8;      // tests whether a pixel has changed
    localparam [5:0] ROTATE = 6'd9;
    localparam [5:0] GRADIENT = 6'd10;
    localparam [5:0] RING = 6'd11;
    localparam [5:0] SUM = 6'd12;
    localparam [5:0] DOUBLE = 6'd13;
    localparam [5:0] HALF = 6'd14;     // adds half of the divisor
    localparam [5:0] DIVIDE = 6'd15;   // finds a bit of a quotient; a division by 1 moves the accumulator to `aux`, or compares a product of `flow` with the smallest
    localparam [5:0] CLEAR = 6'd16;    // ends a sum or a comparison: `surface` and `flow` keep the smaller value, `segment` keeps the mean
    localparam [5:0] DEVIATE = 6'd17;
    localparam [5:0] SQUARE = 6'd18;   // adds words whose bit is set
    localparam [5:0] CORRECT = 6'd19;  // subtracts the square of the sum
    localparam [5:0] KEEP = 6'd20;
    localparam [5:0] UNLOAD = 6'd21;
    localparam [5:0] SHIFT = 6'd22;
    localparam [5:0] WAIT = 6'd23;     // the accumulator is two steps behind
    localparam [5:0] LONGER = 6'd24;   // the accumulator is three steps behind
    localparam [5:0] SETTLE = 6'd25;   // one clock until the score is whole
    localparam [5:0] STORE = 6'd26;    // writes a mean that has come back
    localparam [5:0] SHOW = 6'd27;     // a mean leaves
    localparam [5:0] RANGE_STEP = 6'd28;  // keeps the larger of the accumulator and a word, or its distance from the largest
    localparam [5:0] RECALL = 6'd29;   // adds the mean or a sum, or subtracts it, bit by bit; `flow` multiplies its sum by a weight, and subtracts its smallest product
    localparam [5:0] WALK = 6'd30;     // `segment`: counts a word; `surface` and `flow`: adds the distance of a word from another
    localparam [5:0] FILTER_STEP = 6'd31;  // a step of `switching3x3` or `binomial3x3`
    localparam [5:0] PASS = 6'd32;     // the classes of the regions of the slot pass
    localparam [5:0] FIRST = FILTER == 1 ? START : FILTER == 3 ? FILTER_STEP : READ;
    localparam [5:0] BEGIN = ZONES ? PASS : FIRST;  // the first step of a slot
    localparam [5:0] BEHIND = LATE == 0 ? WRITE : LATE == 1 ? IDLE : LATE == 2 ? WAIT : LONGER;
    localparam [5:0] RETURNED = LATE == 0 ? STORE : BEHIND;
    localparam [5:0] SCORED = DEEP != 0 ? SETTLE : ROTATE;

    localparam [1:0] TEMPORAL = 2'b00;
    localparam [1:0] BORDER = 2'b01;
    localparam [1:0] COPY = 2'b10;

    localparam SEARCHES = FILTER == 1 || FILTER == 2;  // 1: medians are searched
    localparam SWITCHES = FILTER == 2;                 // 1: a pixel is kept unless it is the largest or smallest of its window
    localparam BLENDS = FILTER == 3;                   // 1: windows are summed
    localparam SUMS = MAD || VARIANCE || RANGE || SURFACE || SEGMENT || FLOW;  // 1: a feature divides, and its score takes the accumulator
    /* verilator lint_off WIDTH */
    localparam [3:0] LAST_DOUBLE = FRACTION - 1;
    /* verilator lint_on WIDTH */

    reg [5:0] state_q;
    reg [5:0] state;
    reg [1:0] job_q;  // the purpose of the walk over pixels
    reg [1:0] job;
    reg [3:0] tap_q;
    reg [1:0] part_q;
    reg averaging;
    reg returning;

    // Steps of a frame.
    wire loading = state_q == LOAD;
    wire draining = state_q == DRAIN;
    wire rotating = state_q == ROTATE;
    wire unloading = state_q == UNLOAD;
    wire shifting = RASTER != 0 && state_q == SHIFT;

    // Steps of a pixel.
    wire starting = state_q == START;
    wire searching = SEARCHES && state_q == SEARCH;
    wire adjusting = searching && tap_q[3] && tap_q[0];
    // `switching3x3`: parts 0 and 1 compare the center with its neighbors, and parts 2 and 3 take it instead of the median.
    // `binomial3x3`: part 0 subtracts the reference, part 1 adds the window, part 2 adds it again for the result, part 3 rounds.
    wire probing = SWITCHES && state_q == FILTER_STEP && !part_q[1];
    wire choosing = SWITCHES && state_q == FILTER_STEP && part_q[1];
    wire blending = BLENDS && state_q == FILTER_STEP;
    wire part_ends = SWITCHES ? part_q[1] || tap_q[2:0] == 3'd7 : part_q == 2'd3 || tap_q == 4'd15;
    wire reading = state_q == READ;
    wire writing = state_q == WRITE;
    wire relating = COPIES != 0 && state_q == REFERENCE;
    wire testing = state_q == TEST;
    wire gradient = EDGE && state_q == GRADIENT;
    wire gradient_test = gradient && tap_q[2:0] == 3'd7;
    wire ring = CORNER && state_q == RING;
    wire ring_test = ring && part_q[1];
    wire ring_last = tap_q == 4'd11;

    // The purpose of the walk.
    wire bordering = BORDERS && job_q[0];
    wire copying = COPIES != 0 && job_q[1];
    wire temporal = !bordering && !copying;
    wire denoising = FILTER != 0 && job_q == TEMPORAL && !loading;
    wire border_ends = bordering && writing && last_column_i && part_q == 2'd3;

    // Steps of `segment`. Round 0 makes the mean. Round 1 counts the words above it, and round 2 adds those that are not below it: the
    // count then says which side is smaller. Round 3 counts that side alone.
    wire [1:0] round;
    wire recalling = SEGMENT && state_q == RECALL && segments_i;  // adds the mean
    wire leveling = SEGMENT && state_q == HALF && segments_i && round != 2'd0;  // makes a bound of the mean and the level
    wire below = leveling && round == 2'd2;                       // the bound is the lower one, in every lane
    wire counting = SEGMENT && state_q == WALK && segments_i;     // a word is compared with the bound
    wire rounding = SEGMENT && state_q == CLEAR && segments_i && round == 2'd0;  // the remainder is compared

    // Steps of `surface`. A round is for one displacement.
    wire second;     // the smallest sum so far is added again

    // Steps of `flow`. For each displacement: 0: a sum of distances is made, and moved to `aux`; 1: it is multiplied by its weight;
    // 2: the smallest product is kept. Then 3: the sum of the last displacement, 0, is multiplied again; 4: the smallest product is
    // subtracted; 5: the difference is divided by the weight; 6: the quotient is the score.
    wire [2:0] stage;
    wire matching = FLOW && state_q == WALK && flows_i;           // a word is held, or its distance from the reference added
    wire noting = FLOW && state_q == CLEAR && flows_i && stage != 3'd6;  // keeps the displacement if it was the best so far
    wire lessening = FLOW && (state_q == RECALL || state_q == DIVIDE) && flows_i
        && (stage == 3'd2 || stage == 3'd4);                      // on the smallest product so far

    // Steps of `surface` and `flow`.
    wire retrieving = (SURFACE || FLOW) && state_q == RECALL && (surfaces_i || flows_i);  // adds a sum in `aux`, or subtracts it
    wire removing = retrieving && (FLOW && flows_i ? stage == 3'd4 : !second);  // subtracts it
    wire spanning = matching || (SURFACE && state_q == WALK && surfaces_i);  // a word is held, or its distance from another added
    wire shrinking = SURFACE && state_q == CLEAR && surfaces_i && round != 2'd0;  // keeps the smaller of two sums

    // Steps of a sum.
    wire summing = (SUMS || SUMMARIES) && state_q == SUM;
    wire doubling = SUMS && state_q == DOUBLE;
    wire halving = (MAD || SEGMENT || SUMMARIES) && state_q == HALF && !leveling;
    wire dividing = SUMS && state_q == DIVIDE;
    wire clearing = SUMS && state_q == CLEAR && !(SURFACE && surfaces_i) && !noting;
    wire deviating = MAD && state_q == DEVIATE;
    wire squaring = VARIANCE && state_q == SQUARE;
    wire correcting = VARIANCE && state_q == CORRECT;
    wire keeping = (SUMS || SUMMARIES) && state_q == KEEP;
    wire ranging = RANGE && state_q == RANGE_STEP;
    wire spreading;  // second pass of `range`: the distances from the largest pixel are compared, not the pixels

    // Steps of a mean.
    wire is_averaging;  // blocks are summed, and their sums pass
    wire is_returning;  // means leave
    wire storing = SUMMARIES && RASTER == 0 && state_q == STORE;
    wire showing = SUMMARIES && RASTER == 0 && state_q == SHOW;

    assign step_o = {
        loading, draining, rotating, unloading, shifting,
        denoising, bordering, temporal, copying,
        starting, searching, adjusting, probing, choosing, blending, reading, writing, relating, testing,
        gradient, gradient_test, ring, ring_test, ring_last,
        summing, doubling, halving, dividing, clearing, deviating, squaring, correcting, keeping, ranging, spreading,
        recalling, retrieving, removing, counting, spanning, leveling, below, rounding, shrinking,
        matching, lessening, noting,
        is_averaging, is_returning, storing, showing
    };
    assign classing_o = ZONES && state_q == PASS;
    assign tap_o = spanning ? {2'b00, round} + 4'd3 : tap_q;  // the neighbors at the right, and those below from right to left
    assign part_o = part_q;
    assign stage_o = stage;

    assign walks_o = (testing && !(BLENDS && denoising)) || (writing && (!temporal || BLENDS))
        || (gradient_test && part_q[0]) || (ring_test && ring_last)
        || summing || deviating || squaring || ((ranging || spanning) && part_q[0]) || counting
        || (unloading && RASTER == 0) || (shifting && last_lane_i && !is_returning);
    wire denoised = FILTER != 0 && last_center_i && (BLENDS ? writing && temporal : testing);  // the last pixel of the square is done
    wire pass_ends = walks_o && last_center_i;
    wire unloaded = pass_ends && (unloading || shifting);
    wire returned = is_returning && (showing || (shifting && last_lane_i));
    assign block_ends_o = returned || (is_averaging && rotating && last_lane_i);
    assign slot_ends_o = SUMMARIES ? returned && last_block_i : unloaded;

    // The next step.
    always @* begin
        state = state_q;
        job = job_q;
        averaging = is_averaging;
        returning = is_returning;
        case (state_q)
            LOAD: if (start_i) begin
                state = BEGIN;
                job = TEMPORAL;
            end
            DRAIN: state = LOAD;
            PASS: if (!ZONES) state = LOAD;
            else if (last_lane_i) state = FIRST;
            START: state = SEARCH;
            SEARCH: if (adjusting && spent_i) state = SWITCHES ? FILTER_STEP : BEHIND;
            FILTER_STEP: begin
                if (!SWITCHES && !BLENDS) state = LOAD;
                else if (part_ends) case (part_q)
                    2'd0: state = FILTER_STEP;
                    2'd1: state = SWITCHES ? START : TEST;
                    2'd2: state = FILTER_STEP;
                    default: state = BEHIND;
                endcase
            end
            READ: begin
                if (SWITCHES && temporal) state = FILTER_STEP;
                else if (COPIES != 0 && FILTER == 0 && temporal) state = REFERENCE;
                else state = BEHIND;
            end
            LONGER: state = WAIT;
            WAIT: state = IDLE;
            IDLE: state = is_returning ? STORE : WRITE;
            SETTLE: state = ROTATE;
            WRITE: begin
                if (temporal) state = BLENDS ? FIRST : COPIES != 0 ? REFERENCE : TEST;
                else if (bordering) state = border_ends ? SCORED : READ;
                else state = last_center_i ? UNLOAD : READ;
            end
            REFERENCE: state = TEST;
            TEST: begin
                state = last_center_i ? SCORED : FIRST;
                if (BLENDS) state = FILTER_STEP;
            end
            ROTATE: if (last_lane_i) begin
                job = COPY;
                averaging = SUMMARIES && (is_averaging ? !last_block_i : first_score_i);
                if (is_returning) state = RETURNED;
                else if (averaging) state = HALF;
                else if (last_score_i) state = COPIES != 0 ? READ : UNLOAD;
                else if (EDGE && next_edge_i) state = GRADIENT;
                else if (CORNER && next_corner_i) state = RING;
                else if (RANGE && next_range_i) state = RANGE_STEP;
                else if (SURFACE && next_surface_i) state = RECALL;
                else if (FLOW && next_flow_i) state = CLEAR;
                else state = SUM;
            end
            GRADIENT, RING: if (pass_ends) state = SCORED;
            SUM: if (pass_ends) begin
                state = is_averaging ? KEEP : squares_i ? DIVIDE : FRACTION != 0 && !(SEGMENT && segments_i) ? DOUBLE : HALF;
            end
            DOUBLE: begin
                if (squares_i) state = any_pairs_i ? SQUARE : corrects_i ? CORRECT : DOUBLE;
                else if (tap_q == LAST_DOUBLE) state = HALF;
            end
            HALF: state = is_averaging ? SUM : leveling ? WALK : DIVIDE;
            DIVIDE: if (divided_i) state = (SURFACE && surfaces_i) || (FLOW && flows_i && stage == 3'd0) ? RECALL : CLEAR;
            CLEAR: begin
                state = squares_i ? DOUBLE : ranges_i ? RANGE_STEP : DEVIATE;
                if (SURFACE && surfaces_i) state = RECALL;
                if (SEGMENT && segments_i) state = round == 2'd2 ? KEEP : round == 2'd3 ? SCORED : RECALL;
                if (FLOW && flows_i) state = stage == 3'd0 ? WALK : RECALL;
            end
            RECALL: begin
                if (!SURFACE && !SEGMENT && !FLOW) state = LOAD;
                else if (FLOW && flows_i) begin
                    if (last_place_i) state = stage == 3'd6 ? KEEP : stage == 3'd3 ? RECALL : DIVIDE;
                end else if (last_place_i) state = recalling ? HALF : removing ? WALK : round == 2'd3 ? KEEP : DIVIDE;
            end
            WALK: begin
                if (!SURFACE && !SEGMENT && !FLOW) state = LOAD;
                else if (pass_ends) state = matching ? DIVIDE : CLEAR;
            end
            DEVIATE: if (pass_ends) state = KEEP;
            SQUARE: if (last_center_i && !more_pairs_i) state = corrects_i ? CORRECT : DOUBLE;
            CORRECT: state = last_place_i ? KEEP : DOUBLE;
            RANGE_STEP: if (pass_ends) state = spreading ? KEEP : DIVIDE;
            KEEP: state = SEGMENT && segments_i && !is_averaging ? RECALL : SCORED;
            UNLOAD: begin
                if (RASTER != 0) state = SHIFT;
                else if (SUMMARIES && last_center_i) state = ROTATE;
            end
            SHIFT: if (last_lane_i) state = UNLOAD;
            STORE: state = SUMMARIES ? SHOW : LOAD;
            SHOW: state = ROTATE;
            default: state = LOAD;
        endcase
        if (BORDERS && denoised) begin
            state = READ;
            job = BORDER;
        end
        if (BLENDS && denoised && !BORDERS) state = SCORED;
        if (SUMMARIES && unloaded) returning = 1'b1;
        if (slot_ends_o) begin
            state = last_slot_i ? DRAIN : BEGIN;
            job = TEMPORAL;
            returning = 1'b0;
        end
    end

    always @(posedge clk_i) begin
        if (rst_i) begin
            state_q <= LOAD;
            job_q   <= TEMPORAL;
        end else begin
            state_q <= state;
            job_q   <= job;
        end
    end

    generate
        if (SUMMARIES != 0) begin : g_summaries
            reg averaging_q;
            reg returning_q;
            assign is_averaging = averaging_q;
            assign is_returning = returning_q;

            always @(posedge clk_i) begin
                if (rst_i) begin
                    averaging_q <= 1'b0;
                    returning_q <= 1'b0;
                end else begin
                    averaging_q <= averaging;
                    returning_q <= returning;
                end
            end
        end else begin : g_no_summaries
            wire unused_phases = averaging || returning;
            assign is_averaging = 1'b0;
            assign is_returning = 1'b0;
        end
    endgenerate

    generate
        if (RANGE) begin : g_range
            reg spreading_q;
            assign spreading = spreading_q;

            always @(posedge clk_i) begin
                if (rotating) spreading_q <= 1'b0;
                else if (clearing) spreading_q <= 1'b1;
            end
        end else begin : g_no_range
            assign spreading = 1'b0;
        end
    endgenerate

    generate
        if (SURFACE || SEGMENT) begin : g_rounds
            reg [1:0] round_q;
            reg second_q;
            assign round = round_q;
            assign second = second_q;

            always @(posedge clk_i) begin
                if (rotating) round_q <= 2'd0;
                else if (segments_i ? clearing : dividing && divided_i) round_q <= round_q + 2'd1;
                if (rotating || dividing) second_q <= 1'b0;
                else if (state_q == CLEAR) second_q <= 1'b1;
            end
        end else begin : g_no_rounds
            wire unused_kinds = next_surface_i || surfaces_i || segments_i;
            assign round = 2'd0;
            assign second = 1'b0;
        end
    endgenerate

    generate
        if (FLOW) begin : g_stages
            reg [2:0] stage_q;
            assign stage = stage_q;
            assign compared_o = dividing && divided_i && lessening;

            always @(posedge clk_i) begin
                if (rotating || (compared_o && !last_displacement_i)) stage_q <= 3'd0;
                else if (flows_i && ((dividing && divided_i) || (retrieving && last_place_i))) stage_q <= stage_q + 3'd1;
            end
        end else begin : g_no_stages
            wire unused_flow = next_flow_i || flows_i || last_displacement_i;
            assign stage = 3'd0;
            assign compared_o = 1'b0;
        end
    endgenerate

    // Steps inside the work of a pixel.
    always @(posedge clk_i) begin
        if (gradient) begin
            tap_q <= tap_q == 4'd2 ? 4'd4 : tap_q + 4'd1;  // the taps are 0, 1, 2, 4, 5, 6, and 7, which compares
            if (gradient_test) begin
                tap_q <= 4'd0;
                part_q[0] <= !part_q[0];
            end
        end else if (ring) begin
            part_q <= ring_test ? 2'd0 : part_q + 2'd1;
            if (ring_test) tap_q <= ring_last ? 4'd0 : tap_q + 4'd1;
        end else if (ranging || spanning) begin
            part_q <= {1'b0, !part_q[0]};
            tap_q <= 4'd0;
        end else if (probing || choosing || blending) begin
            tap_q <= part_ends ? 4'd0 : tap_q + 4'd1;
            if (part_ends) part_q <= part_q + 2'd1;
        end else if (bordering) begin
            tap_q <= 4'd0;
            if (writing && last_column_i) part_q <= part_q + 2'd1;
        end else begin
            tap_q <= (searching || (doubling && !squares_i)) && !adjusting ? tap_q + 4'd1 : 4'd0;
            part_q <= (SWITCHES && adjusting && spent_i) || (BLENDS && testing && denoising) ? 2'd2 : 2'd0;
        end
    end

endmodule

`default_nettype wire
