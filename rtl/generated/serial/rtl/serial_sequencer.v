// SPDX-License-Identifier: MIT OR Apache-2.0
// The order of things in the serial array: one step per clock, the same for all lanes. What leaves
// here is registered once before it reaches a lane. What works on the word read, or on the operand, is registered
// again where that comes later than the address.
//
// A pass walks over the centers of a square inside a larger square: `center_q` is the address of
// the center, neighbors lie at a constant distance from it. Where a window must not leave the square
// the distance is cut.
`default_nettype none

module serial_sequencer #(
    parameter WIDTH = 8,            // bits of a pixel
    parameter SIDE = 8,             // of a region
    parameter RAW_SIDE = 8,         // of the square that is loaded
    parameter DENOISED_SIDE = 8,    // of the square that is denoised
    parameter MEDIAN = 1,           // 1: pixels are denoised
    parameter CLAMPS = 1,           // 1: a window repeats the border of its square
    parameter LAST_SENT = 0,        // 1: the reference is `last-sent`, else `previous`
    parameter RAW_PAYLOAD = 0,      // 1: raw pixels leave, not those that are scored
    parameter RASTER = 0,           // 1: pixels leave by the chain of scores
    parameter LATE = 0,             // clocks from an address to the accumulator, 0 to 3
    parameter DEEP = 0,             // 1: a score is whole a clock after its last step
    parameter FOLD = 1,             // regions per lane
    parameter LANES = 784,          // lanes of the array
    parameter FEATURES = 1,         // spatial features, 1 to 4
    parameter [7:0] KINDS = 8'd0,   // two bits for each, the first lowest: edge, corner, mad, variance
    parameter EDGE = 1,             // 1: `edge` is one of them
    parameter CORNER = 0,           // ... `corner`
    parameter MAD = 0,              // ... `mad`
    parameter VARIANCE = 0,         // ... `variance`
    parameter FRACTION = 0,         // fraction bits of the mean of `mad`
    parameter SUM_BITS = 14,        // of the sum of a region
    parameter COUNT_BITS = 7,       // of the pixels of a region
    parameter DENOISED_BASE = 64,   // where the denoised square starts in a slot
    parameter REFERENCE_BASE = 64,  // where the reference starts
    parameter WORD_BITS = 7,        // of an address inside a slot
    parameter SLOT_BITS = 1,        // of the number of a slot, at least 1
    parameter REGION_BITS = 10,     // of the number of a region, empty slots included
    parameter POSITION_BITS = 6,    // of the number of a pixel in the larger square of centers
    parameter INDEX_BITS = 1,       // of the number of a score
    parameter SCALE_BITS = 8,       // of the constant that is shifted from step to step
    parameter ACC_BITS = 11         // of the accumulator
) (
    input  wire                     clk_i,             // clock, rising edge
    input  wire                     rst_i,             // synchronous reset, active high
    input  wire                     start_i,           // a frame is complete
    input  wire [        WIDTH-1:0] temporal_level_i,  // a pixel has changed above this difference
    input  wire [        WIDTH+1:0] edge_half_i,       // half the level of `edge`, rounded down
    input  wire [        WIDTH-1:0] corner_level_i,    // level of `corner`
    output wire                     working_o,         // the address is that of a step
    output wire                     reopen_o,          // the frame is done
    // Where.
    output wire [    SLOT_BITS-1:0] slot_o,            // the slot
    output wire [    WORD_BITS-1:0] address_o,         // the address inside the slot
    output wire                     write_o,           // write the accumulator there
    output wire                     write_active_o,    // write if the first flag is set
    output wire                     write_border_o,    // write if the side is on the frame's border
    output wire [              1:0] side_o,            // left, right, top, bottom
    // Operations, as in serial_lane.
    output wire [     ACC_BITS-1:0] constant_o,        // the operand, unless from_memory
    output wire                     from_memory_o,     // the operand is the word read
    output wire                     subtract_o,        // invert the operand
    output wire                     by_sign_o,         // invert it if the accumulator is not negative
    output wire                     by_run_o,          // invert it if five were counted
    output wire                     carry_o,           // add one to an inverted operand
    output wire                     enable_o,          // the accumulator takes the sum
    output wire                     clear_o,           // the accumulator becomes 0
    output wire                     run_o,             // count in unary
    output wire                     run_corner_o,      // ... equal ones in a row
    output wire                     run_clear_o,       // the unary count becomes 0
    output wire                     count_o,           // score a hit
    output wire                     count_corner_o,    // ... of `corner`
    output wire                     double_o,          // the operand is the accumulator itself
    output wire                     divide_o,          // keep the sum only if it is not negative
    output wire                     deviate_o,         // the operand is |2^FRACTION * word - aux|
    output wire                     masked_o,          // do not add it unless its bit under the constant is 1
    output wire                     from_aux_o,        // the operand is aux
    output wire                     shift_o,           // scores move on by one lane
    output wire                     keep_o,            // the score becomes the accumulator
    output wire                     fetch_o,           // the score becomes the word read
    // The decision's inputs.
    output wire                     rotate_o,          // scores pass
    output wire                     unload_o,          // the word read leaves if its region is active
    output wire [   INDEX_BITS-1:0] index_o,           // of the score
    output wire [  REGION_BITS-1:0] region_o,          // that passes
    output wire [POSITION_BITS-1:0] position_o         // of the pixel that leaves
);

    // Limits: out of them elaboration stops at a module that does not exist.
    generate
        if (SIDE < 4 || SIDE > 64) begin : g_side SIDE_must_be_4_to_64 u_refused (); end
        if (FEATURES < 1 || FEATURES > 4) begin : g_features FEATURES_must_be_1_to_4 u_refused (); end
        if (LANES < 1) begin : g_lane_count LANES_must_be_1_or_more u_refused (); end
        if (FOLD < 1) begin : g_fold FOLD_must_be_1_or_more u_refused (); end
        if (LATE < 0 || LATE > 3) begin : g_late LATE_must_be_0_to_3 u_refused (); end
    endgenerate

    localparam PIXELS = SIDE * SIDE;
    localparam INNER = (DENOISED_SIDE - SIDE) / 2;  // the first center that is scored
    localparam SCORED_SIDE = MEDIAN != 0 ? DENOISED_SIDE : RAW_SIDE;
    localparam LEAVING_SIDE = RAW_PAYLOAD != 0 ? RAW_SIDE : SCORED_SIDE;
    localparam SIDE_BITS = $clog2(DENOISED_SIDE);
    localparam BORDERS = MEDIAN != 0 && INNER != 0;
    localparam SUMS = MAD || VARIANCE;
    localparam PLACES = WIDTH + COUNT_BITS;  // bits that the sum of `variance` has places for

    // Numbers that fit where they are put.
    /* verilator lint_off WIDTH */
    // First centers of the passes.
    localparam [WORD_BITS-1:0] WINDOW_START = (RAW_SIDE - DENOISED_SIDE) / 2 * (RAW_SIDE + 1);
    localparam [WORD_BITS-1:0] SCORED_START = MEDIAN != 0 ? DENOISED_BASE + INNER * (DENOISED_SIDE + 1)
        : (RAW_SIDE - SIDE) / 2 * (RAW_SIDE + 1);
    localparam [WORD_BITS-1:0] RAW_START = (RAW_SIDE - SIDE) / 2 * (RAW_SIDE + 1);
    localparam [WORD_BITS-1:0] LEAVING_START = RAW_PAYLOAD != 0 ? RAW_START : SCORED_START;
    localparam [WORD_BITS-1:0] FIRST_START = MEDIAN != 0 ? WINDOW_START : SCORED_START;
    localparam [WORD_BITS-1:0] LEFT_START = DENOISED_BASE + 1;
    localparam [WORD_BITS-1:0] RIGHT_START = DENOISED_BASE + DENOISED_SIDE - 2;
    localparam [WORD_BITS-1:0] TOP_START = DENOISED_BASE + DENOISED_SIDE;
    localparam [WORD_BITS-1:0] BOTTOM_START = DENOISED_BASE + (DENOISED_SIDE - 2) * DENOISED_SIDE;
    // From the last center of a row to the first of the next.
    localparam [WORD_BITS-1:0] WINDOW_SKIP = RAW_SIDE - DENOISED_SIDE + 1;
    localparam [WORD_BITS-1:0] SCORED_SKIP = SCORED_SIDE - SIDE + 1;
    localparam [WORD_BITS-1:0] LEAVING_SKIP = LEAVING_SIDE - SIDE + 1;
    localparam [WORD_BITS-1:0] ONE = 1;
    localparam [WORD_BITS-1:0] WINDOW_STRIDE = RAW_SIDE;
    localparam [WORD_BITS-1:0] SCORED_STRIDE = SCORED_SIDE;
    // Regions, linear squares and constants.
    localparam [REGION_BITS-1:0] LAST_LANE = (LANES - 1) * FOLD;
    localparam [REGION_BITS-1:0] REGION_STEP = FOLD;
    localparam [WORD_BITS-1:0] DENOISED_AT = DENOISED_BASE;
    localparam [WORD_BITS-1:0] REFERENCE_AT = REFERENCE_BASE;
    localparam [ACC_BITS-1:0] HALF_PIXELS = PIXELS / 2;
    localparam [SCALE_BITS-1:0] UNIT = 1;
    localparam [SCALE_BITS-1:0] DIVISOR = PIXELS;
    localparam [COUNT_BITS-1:0] FACTOR = PIXELS;
    localparam [INDEX_BITS-1:0] LAST_SCORE = FEATURES;
    localparam [3:0] LAST_DOUBLE = FRACTION - 1;
    localparam [SIDE_BITS-1:0] LAST_WIDE = DENOISED_SIDE - 1;
    localparam [SIDE_BITS-1:0] LAST_SIDE = SIDE - 1;
    localparam [SIDE_BITS-1:0] LAST_COUNTED = SIDE;
    /* verilator lint_on WIDTH */

    localparam [4:0] LOAD = 5'd0;      // a frame enters
    localparam [4:0] DRAIN = 5'd1;     // a clock for the last step
    localparam [4:0] START = 5'd2;     // median: the first candidate
    localparam [4:0] SEARCH = 5'd3;    // ... nine comparisons and an adjustment for each bit
    localparam [4:0] READ = 5'd4;      // a word to be written elsewhere, or compared
    localparam [4:0] IDLE = 5'd5;      // the accumulator is a step behind
    localparam [4:0] WRITE = 5'd6;
    localparam [4:0] REFERENCE = 5'd7;
    localparam [4:0] TEST = 5'd8;      // changed?
    localparam [4:0] ROTATE = 5'd9;
    localparam [4:0] GRADIENT = 5'd10;
    localparam [4:0] RING = 5'd11;
    localparam [4:0] SUM = 5'd12;
    localparam [4:0] DOUBLE = 5'd13;
    localparam [4:0] HALF = 5'd14;     // half the divisor
    localparam [4:0] DIVIDE = 5'd15;
    localparam [4:0] CLEAR = 5'd16;
    localparam [4:0] DEVIATE = 5'd17;
    localparam [4:0] SQUARE = 5'd18;   // words whose bit is set
    localparam [4:0] CORRECT = 5'd19;  // the square of the sum
    localparam [4:0] KEEP = 5'd20;
    localparam [4:0] UNLOAD = 5'd21;
    localparam [4:0] SHIFT = 5'd22;
    localparam [4:0] WAIT = 5'd23;     // ... two steps
    localparam [4:0] LONGER = 5'd24;   // ... three steps
    localparam [4:0] SETTLE = 5'd25;   // the score becomes whole
    localparam [4:0] FIRST = MEDIAN != 0 ? START : READ;
    localparam [4:0] BEHIND = LATE == 0 ? WRITE : LATE == 1 ? IDLE : LATE == 2 ? WAIT : LONGER;
    localparam [4:0] SCORED = DEEP != 0 ? SETTLE : ROTATE;

    localparam [1:0] TEMPORAL = 2'd0;
    localparam [1:0] BORDER = 2'd1;
    localparam [1:0] COPY = 2'd2;

    reg [4:0] state_q;
    reg [4:0] state;
    reg [1:0] job_q;
    reg [1:0] job;
    reg [3:0] tap_q;
    reg [1:0] part_q;  // half of a gradient, part of a ring's step, side of the border
    reg [SIDE_BITS-1:0] column_q;
    reg [SIDE_BITS-1:0] row_q;
    reg [WORD_BITS-1:0] center_q;
    reg [POSITION_BITS-1:0] position_q;
    reg [INDEX_BITS-1:0] index_q;
    reg [REGION_BITS-1:0] region_q;
    reg [SCALE_BITS-1:0] scale_q;

    // Where a pass ends.
    wire waiting = state_q == IDLE || (LATE > 1 && state_q == WAIT) || (LATE > 2 && state_q == LONGER);
    wire window_pass = MEDIAN != 0
        && (state_q == START || state_q == SEARCH || waiting || state_q == WRITE
            || state_q == REFERENCE || state_q == TEST) && job_q == TEMPORAL;
    wire bordering = BORDERS && job_q == BORDER;
    wire wide_pass = INNER != 0 && MEDIAN != 0 && (window_pass || bordering);
    wire [SIDE_BITS-1:0] last_place =
        wide_pass ? LAST_WIDE : LAST_SIDE;
    wire last_column = column_q == last_place;
    wire last_row = row_q == last_place;
    wire last_center = last_column && last_row;
    wire last_lane;
    wire last_slot;
    wire last_score = index_q == LAST_SCORE;

    // The step under way.
    wire testing = state_q == TEST;
    wire writing = state_q == WRITE;
    wire rotating = state_q == ROTATE;
    wire shifting = RASTER != 0 && state_q == SHIFT;
    wire unloading = state_q == UNLOAD;
    wire searching = MEDIAN != 0 && state_q == SEARCH;
    wire adjusting = searching && tap_q[3] && tap_q[0];
    wire in_gradient = EDGE && state_q == GRADIENT;
    wire in_ring = CORNER && state_q == RING;
    wire gradient_test = in_gradient && tap_q[2:0] == 3'd7;
    wire ring_test = in_ring && part_q == 2'd2;
    wire ring_last = tap_q == 4'd11;
    wire in_sum = SUMS && state_q == SUM;
    wire doubling = SUMS && state_q == DOUBLE;
    wire halving = MAD && state_q == HALF;
    wire dividing = SUMS && state_q == DIVIDE;
    wire clearing = SUMS && state_q == CLEAR;
    wire deviating = MAD && state_q == DEVIATE;
    wire squaring = VARIANCE && state_q == SQUARE;
    wire correcting = VARIANCE && state_q == CORRECT;
    wire keeping = SUMS && state_q == KEEP;
    wire reading = state_q == READ;
    wire relating = LAST_SENT != 0 && state_q == REFERENCE;

    // The feature that comes next, and whether it is the one with squares.
    wire [7:0] kinds = KINDS >> {index_q, 1'b0};
    wire [1:0] next_kind = FEATURES == 1 ? KINDS[1:0] : kinds[1:0];
    wire unused_kinds = |kinds;
    reg  squares_q;
    wire squares = VARIANCE && (!MAD || squares_q);

    wire walks = testing || (writing && job_q != TEMPORAL)
        || (in_gradient && tap_q[2:0] == 3'd7 && part_q[0]) || (ring_test && ring_last)
        || in_sum || deviating || squaring
        || (unloading && RASTER == 0) || (shifting && last_lane);
    wire pass_ends = walks && last_center;
    wire slot_ends = pass_ends && (unloading || shifting);
    wire border_ends = bordering && writing && last_column && part_q == 2'd3;

    // The squares of `variance`: bit by bit of the result from above, all pairs of bits of n and of
    // a word that meet there. `zip_q` has a 1 at each bit of a word that meets a 1 of n.
    wire [WIDTH-1:0] lowest;
    wire             more_pairs;
    wire             any_pairs;
    wire             corrects;
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
            assign more_pairs = |others;
            assign any_pairs = |zip_q[WIDTH-1:0];
            assign corrects = SUM_BITS == PLACES || !scale_q[PLACES-1];
            assign place_ends = squares
                && (correcting
                    || (!corrects && ((doubling && !any_pairs)
                        || (squaring && last_center && !more_pairs))));

            always @(posedge clk_i) begin
                if (clearing) zip_q <= {mirrored, {WIDTH{1'b0}}};
                else if (place_ends) zip_q <= zip_q >> 1;
                if (doubling) pairs_q <= zip_q[WIDTH-1:0];
                else if (squaring && last_center) pairs_q <= others;
            end
        end else begin : g_no_pairs
            assign corrects = 1'b0;
            assign lowest = {WIDTH{1'b0}};
            assign more_pairs = 1'b0;
            assign any_pairs = 1'b0;
            assign place_ends = 1'b0;
        end
    endgenerate

    // The constant that is shifted.
    wire divided = scale_q == (squares ? UNIT : MAD ? DIVISOR : UNIT);

    always @(posedge clk_i) begin
        // Made ready in the states that come before it is needed, so that it does not wait for the next state.
        if (MEDIAN != 0 && (state_q == LOAD || testing || unloading || shifting))
            scale_q <= UNIT << (WIDTH - 1);
        else if (in_sum)
            scale_q <= squares ? UNIT << (SUM_BITS - 1) : DIVISOR << (WIDTH + FRACTION - 1);
        else if (VARIANCE && clearing) scale_q <= UNIT << (PLACES - 1);
        else if (state_q == START || adjusting || dividing || place_ends) scale_q <= scale_q >> 1;
    end

    // The next step.
    always @* begin
        state = state_q;
        job = job_q;
        case (state_q)
            LOAD: if (start_i) begin
                state = FIRST;
                job = TEMPORAL;
            end
            DRAIN: state = LOAD;
            START: state = SEARCH;
            SEARCH: if (adjusting && scale_q == 0) state = BEHIND;
            READ: begin
                if (LAST_SENT != 0 && MEDIAN == 0 && job_q == TEMPORAL) state = REFERENCE;
                else state = BEHIND;
            end
            LONGER: state = WAIT;
            WAIT: state = IDLE;
            IDLE: state = WRITE;
            SETTLE: state = ROTATE;
            WRITE: begin
                if (job_q == TEMPORAL) state = LAST_SENT != 0 ? REFERENCE : TEST;
                else if (bordering) state = border_ends ? SCORED : READ;
                else state = last_center ? UNLOAD : READ;
            end
            REFERENCE: state = TEST;
            TEST: begin
                state = last_center ? SCORED : FIRST;
                if (last_center && BORDERS) begin
                    state = READ;
                    job = BORDER;
                end
            end
            ROTATE: if (last_lane) begin
                job = COPY;
                if (last_score) state = LAST_SENT != 0 ? READ : UNLOAD;
                else if (EDGE && next_kind == 2'd0) state = GRADIENT;
                else if (CORNER && next_kind == 2'd1) state = RING;
                else state = SUM;
            end
            GRADIENT, RING: if (pass_ends) state = SCORED;
            SUM: if (pass_ends) state = squares ? DIVIDE : FRACTION != 0 ? DOUBLE : HALF;
            DOUBLE: begin
                if (squares) state = any_pairs ? SQUARE : corrects ? CORRECT : DOUBLE;
                else if (tap_q == LAST_DOUBLE) state = HALF;
            end
            HALF: state = DIVIDE;
            DIVIDE: if (divided) state = CLEAR;
            CLEAR: state = squares ? DOUBLE : DEVIATE;
            DEVIATE: if (pass_ends) state = KEEP;
            SQUARE: if (last_center && !more_pairs) state = corrects ? CORRECT : DOUBLE;
            CORRECT: state = scale_q[0] ? KEEP : DOUBLE;
            KEEP: state = SCORED;
            UNLOAD: begin
                if (RASTER != 0) state = SHIFT;
                else if (last_center) state = last_slot ? DRAIN : FIRST;
            end
            SHIFT: if (last_lane) state = !last_center ? UNLOAD : last_slot ? DRAIN : FIRST;
            default: state = LOAD;
        endcase
        if (slot_ends) job = TEMPORAL;
    end

    always @(posedge clk_i) begin
        if (rst_i) begin
            state_q <= LOAD;
            job_q   <= TEMPORAL;
        end else begin
            state_q <= state;
            job_q   <= job;
        end

        // Inside a pixel.
        if (in_gradient) begin
            tap_q <= tap_q == 4'd2 ? 4'd4 : tap_q + 4'd1;  // 0, 1, 2, 4, 5, 6, and 7 compares
            if (gradient_test) begin
                tap_q <= 4'd0;
                part_q[0] <= !part_q[0];
            end
        end else if (in_ring) begin
            part_q <= ring_test ? 2'd0 : part_q + 2'd1;
            if (ring_test) tap_q <= ring_last ? 4'd0 : tap_q + 4'd1;
        end else if (bordering && (reading || writing || waiting)) begin
            tap_q <= 4'd0;
            if (writing && last_column) part_q <= part_q + 2'd1;
        end else if (searching || (doubling && !squares)) begin
            tap_q <= adjusting ? 4'd0 : tap_q + 4'd1;
            part_q <= 2'd0;
        end else begin
            tap_q <= 4'd0;
            part_q <= 2'd0;
        end
    end

    // The walk over the centers.
    wire [WORD_BITS-1:0] skip = window_pass ? WINDOW_SKIP
        : (unloading || shifting) ? LEAVING_SKIP : SCORED_SKIP;

    always @(posedge clk_i) begin
        if (state_q == LOAD || state_q == DRAIN || slot_ends) begin
            column_q   <= {SIDE_BITS{1'b0}};
            row_q      <= {SIDE_BITS{1'b0}};
            position_q <= {POSITION_BITS{1'b0}};
            center_q   <= FIRST_START;
        end else if (bordering && writing) begin
            column_q <= last_column ? {SIDE_BITS{1'b0}} : column_q + 1'b1;
            if (!last_column) center_q <= center_q + (part_q[1] ? ONE : SCORED_STRIDE);
            else case (part_q)
                2'd0: center_q <= RIGHT_START;
                2'd1: center_q <= TOP_START;
                2'd2: center_q <= BOTTOM_START;
                default: center_q <= SCORED_START;
            endcase
        end else if (walks) begin
            column_q   <= last_column ? {SIDE_BITS{1'b0}} : column_q + 1'b1;
            if (last_column) row_q <= last_row ? {SIDE_BITS{1'b0}} : row_q + 1'b1;
            position_q <= last_center ? {POSITION_BITS{1'b0}} : position_q + 1'b1;
            center_q   <= center_q + (last_column ? skip : ONE);
            if (last_center)
                center_q <= writing ? LEAVING_START : testing && BORDERS ? LEFT_START : SCORED_START;
        end else if (rotating && last_lane && last_score && LAST_SENT == 0) begin
            center_q <= LEAVING_START;
        end
    end

    // Slots, regions, scores.

    generate
        if (FOLD > 1) begin : g_slot
            localparam LAST_SLOT = FOLD - 1;
            reg [SLOT_BITS-1:0] slot_q;
            wire [REGION_BITS-1:0] first_region;
            assign last_slot = slot_q == LAST_SLOT[SLOT_BITS-1:0];
            assign slot_o = slot_q;

            always @(posedge clk_i) begin
                if (state_q == LOAD) slot_q <= {SLOT_BITS{1'b0}};
                else if (slot_ends) slot_q <= slot_q + 1'b1;

                if (rotating || shifting) region_q <= region_q + REGION_STEP;
                else region_q <= first_region;
            end

            if (REGION_BITS > SLOT_BITS) begin : g_first
                assign first_region = {{(REGION_BITS - SLOT_BITS) {1'b0}}, slot_q};
            end else begin : g_first_narrow
                assign first_region = slot_q;
            end
        end else begin : g_no_slot
            assign last_slot = 1'b1;
            assign slot_o = {SLOT_BITS{1'b0}};

            always @(posedge clk_i) begin
                if (rotating || shifting) region_q <= region_q + REGION_STEP;
                else region_q <= {REGION_BITS{1'b0}};
            end
        end
        if (LANES > 1) begin : g_lanes
            assign last_lane = region_q >= LAST_LANE;
        end else begin : g_lane
            assign last_lane = 1'b1;
            wire unused_region = |LAST_LANE;
        end
    endgenerate

    always @(posedge clk_i) begin
        if (state_q == LOAD || slot_ends) index_q <= {INDEX_BITS{1'b0}};
        else if (rotating && last_lane && !last_score) begin
            index_q   <= index_q + 1'b1;
            squares_q <= next_kind == 2'd3;
        end
    end

    // Neighbors, clockwise from above left; the last is the center itself.
    reg [3:0] neighbor;
    always @* begin
        if (searching) neighbor = tap_q;
        else if (in_gradient) neighbor = {1'b0, tap_q[2:0] + (part_q[0] ? 3'd1 : 3'd7)};
        else if (in_ring) neighbor = {part_q == 2'd1, tap_q[2:0]};
        else neighbor = 4'd8;
    end

    wire moved = !neighbor[3];
    wire up = moved && neighbor[2:0] <= 3'd2;
    wire down = moved && neighbor[2:0] >= 3'd4 && neighbor[2:0] <= 3'd6;
    wire left = moved && (neighbor[2:0] == 3'd0 || neighbor[2:0] >= 3'd6);
    wire right = moved && neighbor[2:0] >= 3'd2 && neighbor[2:0] <= 3'd4;

    reg [3:0] way;  // up, down, left, right
    always @* begin
        way[3] = up && (CLAMPS == 0 || row_q != 0);
        way[2] = down && (CLAMPS == 0 || !last_row);
        way[1] = left && (CLAMPS == 0 || column_q != 0);
        way[0] = right && (CLAMPS == 0 || !last_column);
        if (bordering && writing) begin
            way[3] = part_q == 2'd2;
            way[2] = part_q == 2'd3;
            way[1] = part_q == 2'd0;
            way[0] = part_q == 2'd1;
        end
    end

    function [WORD_BITS-1:0] distance(input [3:0] toward, input [WORD_BITS-1:0] stride);
        case (toward)
            4'b0001: distance = ONE;
            4'b0010: distance = {WORD_BITS{1'b1}};
            4'b0100: distance = stride;
            4'b0101: distance = stride + ONE;
            4'b0110: distance = stride - ONE;
            4'b1000: distance = ~stride + ONE;
            4'b1001: distance = ~stride + ONE + ONE;
            4'b1010: distance = ~stride;
            default: distance = {WORD_BITS{1'b0}};
        endcase
    endfunction

    wire [WORD_BITS-1:0] near = WINDOW_STRIDE == SCORED_STRIDE || !searching
        ? distance(way, SCORED_STRIDE) : distance(way, WINDOW_STRIDE);

    // Where the linear squares are.
    wire [WORD_BITS-1:0] position;
    wire [WORD_BITS-1:0] reference;
    wire counts;

    generate
        if (WORD_BITS > POSITION_BITS) begin : g_extended
            assign position = {{(WORD_BITS - POSITION_BITS) {1'b0}}, position_q};
        end else begin : g_position
            assign position = position_q;
        end
        if (BORDERS) begin : g_inside
            assign counts = column_q != 0 && column_q <= LAST_COUNTED
                && row_q != 0 && row_q <= LAST_COUNTED;
            if (LAST_SENT != 0) begin : g_reference
                reg [WORD_BITS-1:0] reference_q;
                always @(posedge clk_i) begin
                    if (!window_pass) reference_q <= REFERENCE_AT;
                    else if (testing && counts) reference_q <= reference_q + 1'b1;
                end
                assign reference = window_pass ? reference_q : REFERENCE_AT + position;
            end else begin : g_no_reference
                assign reference = REFERENCE_AT + position;
            end
        end else begin : g_all_inside
            assign counts = 1'b1;
            assign reference = REFERENCE_AT + position;
        end
    endgenerate

    wire to_denoised = MEDIAN != 0 && writing && job_q == TEMPORAL;
    wire to_reference = relating || (writing && (job_q == COPY || (MEDIAN == 0 && job_q == TEMPORAL)));

    assign address_o = to_denoised ? DENOISED_AT + position : to_reference ? reference : center_q + near;
    assign write_o = writing && job_q == TEMPORAL;
    assign write_active_o = LAST_SENT != 0 && writing && job_q == COPY;
    assign write_border_o = writing && bordering;
    assign side_o = part_q;

    // The lanes' work.
    reg [ACC_BITS-1:0] constant;
    wire [ACC_BITS+SCALE_BITS-1:0] wide_scale = {{ACC_BITS{1'b0}}, scale_q};
    wire [ACC_BITS+WIDTH-1:0] wide_temporal = {{ACC_BITS{1'b0}}, temporal_level_i};
    wire [ACC_BITS+WIDTH-1:0] wide_corner = {{ACC_BITS{1'b0}}, corner_level_i};
    wire [ACC_BITS+WIDTH+1:0] wide_half = {{ACC_BITS{1'b0}}, edge_half_i};
    wire [ACC_BITS+WIDTH-1:0] wide_lowest = {{ACC_BITS{1'b0}}, lowest};
    wire unused_wide = |wide_scale || |wide_temporal || |wide_corner || |wide_half || |wide_lowest;

    always @* begin
        constant = {ACC_BITS{1'b0}};
        if (testing) constant = wide_temporal[ACC_BITS-1:0];
        else if (in_gradient) constant = wide_half[ACC_BITS-1:0];
        else if (in_ring) constant = wide_corner[ACC_BITS-1:0];
        else if (halving) constant = HALF_PIXELS;
        else if (squaring) constant = wide_lowest[ACC_BITS-1:0];
        else if (MEDIAN != 0 || SUMS) constant = wide_scale[ACC_BITS-1:0];
    end

    wire tests = testing || gradient_test || ring_test;
    wire idle = state_q == LOAD || state_q == DRAIN;
    wire takes_old = writing && job_q == TEMPORAL && LAST_SENT == 0;

    assign constant_o = constant;
    assign from_memory_o = (searching && !adjusting) || reading || writing || relating
        || (DEEP != 0 && SUMS && unloading)
        || (in_gradient && !gradient_test) || (in_ring && !ring_test) || in_sum || squaring;
    assign subtract_o = (searching && !adjusting) || writing || relating || dividing || correcting
        || (in_gradient && !gradient_test && part_q[0] == tap_q[2])
        || (in_ring && part_q == 2'd1);
    assign by_sign_o = tests;
    assign by_run_o = adjusting;
    assign carry_o = !tests && !searching || (adjusting && scale_q != 0);
    assign enable_o = state_q == START || adjusting || reading || takes_old || relating
        || in_gradient || in_ring || in_sum || doubling || halving || dividing || deviating
        || squaring || correcting;
    assign clear_o = idle || tests || (writing && job_q != TEMPORAL) || clearing || keeping;
    assign run_o = (searching && !adjusting) || (gradient_test && !part_q[0]) || ring_test;
    assign run_corner_o = in_ring;
    assign run_clear_o = idle || adjusting || (gradient_test && part_q[0]) || (ring_test && ring_last);
    assign count_o = (testing && counts) || (gradient_test && part_q[0]) || (ring_test && ring_last);
    assign count_corner_o = in_ring;
    assign double_o = doubling;
    assign divide_o = dividing;
    assign deviate_o = deviating;
    assign masked_o = squaring || correcting;
    assign from_aux_o = correcting;
    assign shift_o = rotating || shifting;
    assign keep_o = keeping;
    assign fetch_o = RASTER != 0 && unloading;
    assign rotate_o = rotating;
    assign unload_o = RASTER != 0 ? shifting : unloading;
    assign index_o = index_q;
    assign region_o = region_q;
    assign position_o = position_q;
    assign working_o = !idle;
    assign reopen_o = state_q == DRAIN;

endmodule

`default_nettype wire
