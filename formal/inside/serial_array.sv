// SPDX-License-Identifier: MIT OR Apache-2.0
// The order of steps in a whole serial array: places of pixels and of steps inside their areas, every rotation once and in order,
// pixels that leave once and in order, and, with STEPS, the steps of a frame by docs/serial.md.
`include "reset.vh"
localparam F_N = SIDE * SIDE;
localparam F_RAW = RAW_SIDE * RAW_SIDE;
localparam F_DENOISED = DENOISED_SIDE * DENOISED_SIDE;
localparam F_COPIES = LAST_SENT != 0 || FLOW != 0;
localparam F_HAS_REFERENCE = FILTER == 0 || F_COPIES;
localparam F_WORDS = F_HAS_REFERENCE ? REFERENCE_BASE + F_N : DENOISED_BASE + F_DENOISED;

// The areas of a slot are one behind the other, and fit into it.
always @* begin
    if (FILTER != 0) assert(DENOISED_BASE >= F_RAW);
    if (F_HAS_REFERENCE) assert(REFERENCE_BASE >= (FILTER != 0 ? DENOISED_BASE + F_DENOISED : F_RAW));
    assert(F_WORDS <= (1 << WORD_BITS));
end

// Places. Either a frame enters or the array works on it.
wire f_write_active = controls[38];
wire f_write_border = controls[37];
wire f_write_mean = controls[34];
wire f_shift = controls[4];
wire f_shows_mean = controls[0];
wire f_in_reference = F_HAS_REFERENCE && word >= REFERENCE_BASE && word < REFERENCE_BASE + F_N;
wire f_in_denoised = FILTER != 0 && word >= DENOISED_BASE && word < DENOISED_BASE + F_DENOISED;
always @* if (started) begin
    assert(!(working && ready_o));
    if (RASTER != 0) assert(!(working && place));
    if (RASTER == 0 || place) begin
        assert(place_word < F_RAW);
        assert(place_slot < FOLD);
    end
    if (place) assert(place_lane < LANES);
    if (working) begin
        // While pixels around the region are denoised, which do not count, the address of the reference is behind it.
        assert(word < F_WORDS || (BORDERS && F_COPIES && word == F_WORDS));
        assert(slot < FOLD);
    end
    if (write || f_write_active || f_write_border) assert(working);
    if (f_write_mean) assert(write && returns && RASTER == 0);
    if (write) assert(f_write_mean ? word < F_RAW : FILTER != 0 ? f_in_denoised : f_in_reference);
    if (f_write_border) assert(f_in_denoised);
    if (f_write_active) assert(f_in_reference);
end

// Rotations: for each slot, each score and each lane, without a gap between lanes; the sums of all blocks follow the first rotation.
// Then come the pixels of the slot, and the means of all blocks.
localparam F_MEANS = BLOCKS * BLOCKS;
localparam F_BLOCKS = BLOCKS == 0 ? 1 : BLOCKS;
localparam F_LAST_OF_BLOCK = SIDE / F_BLOCKS - 1;
reg [7:0] f_slot, f_index, f_lane, f_position, f_block;
reg f_averaged, f_unloaded;
wire f_scored = f_index > FEATURES;
wire f_last_lane = f_lane == LANES - 1;
wire f_leaves = !returns && (RASTER != 0 ? unload && f_last_lane : unload);
wire f_returned = returns && (RASTER != 0 ? unload && f_last_lane : f_shows_mean);
wire f_last_block = f_block == F_MEANS - 1;
wire f_slot_ends = BLOCKS != 0 ? f_returned && f_last_block : f_leaves && f_position == F_N - 1;
always @(posedge clk_i) begin
    if (rst_i || reopen) begin
        f_slot     <= 0;
        f_index    <= 0;
        f_lane     <= 0;
        f_position <= 0;
        f_block    <= 0;
        f_averaged <= 0;
        f_unloaded <= 0;
    end else begin
        if (f_shift) f_lane <= f_last_lane ? 0 : f_lane + 1;
        if ((average && f_last_lane) || f_returned) f_block <= f_last_block ? 0 : f_block + 1;
        if (average && f_last_lane && f_last_block) f_averaged <= 1;
        if (rotate && f_last_lane) f_index <= f_index + 1;
        if (f_leaves) begin
            f_position <= f_position + 1;
            if (f_position == F_N - 1) begin
                f_position <= 0;
                f_unloaded <= 1;
            end
        end
        if (f_slot_ends) begin
            f_index    <= 0;
            f_averaged <= 0;
            f_unloaded <= 0;
            f_slot     <= f_slot + 1;
        end
    end
end
always @* if (started) begin
    if (f_lane != 0) assert(f_shift);
    assert(f_shift == (rotate || average || (RASTER != 0 ? unload : returns && f_shift)));
    if (average || returns || f_shows_mean || f_write_mean) assert(BLOCKS != 0);
    if (average) begin
        assert(!rotate && !unload && !returns && f_index == 1 && index == 0 && !f_averaged);
        assert(f_slot < FOLD && slot == f_slot && block == f_block && region == f_lane * FOLD + f_slot);
    end
    if (returns) begin
        assert(f_unloaded && !rotate && slot == f_slot && block == f_block);
        if (f_shift) assert(region == f_lane * FOLD + f_slot);
        if (BLOCKS != 0) assert(position == (f_block / F_BLOCKS * (F_LAST_OF_BLOCK + 1) + F_LAST_OF_BLOCK) * SIDE
            + f_block % F_BLOCKS * (F_LAST_OF_BLOCK + 1) + F_LAST_OF_BLOCK);
    end
    if (f_shows_mean) assert(returns && f_lane == 0);
    if (rotate) begin
        if (BLOCKS != 0) assert(f_averaged == (f_index != 0));
        assert(!unload && !f_scored && f_slot < FOLD && slot == f_slot && index == f_index);
        assert(region == f_lane * FOLD + f_slot);
    end
    if (unload) begin
        assert(f_scored && slot == f_slot);
        if (!returns) assert(!f_unloaded && position == f_position);
        if (RASTER != 0) assert(region == f_lane * FOLD + f_slot);
    end
    if (reopen) assert(f_slot == FOLD && f_index == 0 && f_lane == 0);
    if (ready_o) assert(f_slot == 0 && f_index == 0);
end

`ifdef STEPS
// One frame, without gaps and resets (by serial_steps.sby): the array is ready again when the contract says.
function integer f_bits(input integer value);
    for (f_bits = 0; value > 0; f_bits = f_bits + 1) value = value / 2;
endfunction
function integer f_ones(input integer value);
    for (f_ones = 0; value > 0; value = value / 2) f_ones = f_ones + value % 2;
endfunction
function integer f_common(input integer radius);  // the least common multiple of SIDE, SIDE - 1, .. SIDE - radius
    for (f_common = SIDE; f_common % (SIDE - 1) != 0 || (radius > 1 && f_common % (SIDE - 2) != 0)
        || (radius > 2 && f_common % (SIDE - 3) != 0); f_common = f_common + SIDE) begin end
endfunction
localparam F_SUM = f_bits(F_N * ((1 << WIDTH) - 1));
localparam F_PRODUCT = f_bits(f_common(FLOW_RADIUS) * f_common(FLOW_RADIUS) * ((1 << WIDTH) - 1));
localparam F_PLACES = (2 * FLOW_RADIUS + 1) * (2 * FLOW_RADIUS + 1);
localparam F_LINE = SIDE * (2 * FLOW_RADIUS + 1) - FLOW_RADIUS * (FLOW_RADIUS + 1);
localparam F_PASSES = (EDGE != 0 ? 14 * F_N : 0) + (CORNER != 0 ? 36 * F_N : 0)
    + (RANGE != 0 ? 4 * F_N + WIDTH + 2 : 0)
    + (SURFACE != 0 ? 8 * F_N + 11 * f_bits(F_N * ((1 << WIDTH) - 1)) + 5 : 0)
    + (SEGMENT != 0 ? 4 * F_N + 4 * WIDTH + 9 : 0)
    + (FLOW != 0 ? 2 * F_LINE * F_LINE + F_PLACES * (2 * F_SUM + F_PRODUCT + 1) + 3 * F_SUM + F_PRODUCT + 3 : 0)
    + (MAD != 0 ? 2 * F_N + WIDTH + 2 * FRACTION + 3 : 0)
    + (VARIANCE != 0 ? F_N + WIDTH * F_N * f_ones(F_N) + 2 * f_bits(F_N * ((1 << WIDTH) - 1)) + WIDTH + f_bits(F_N) + 2 : 0);
localparam F_COMPUTES = MAD != 0 || VARIANCE != 0 || RANGE != 0 || SURFACE != 0 || FLOW != 0;
localparam F_Q = (BLOCK != 0 ? 1 : 0) + (DEEP == 0 ? 0 : F_COMPUTES ? 2 : 1);
localparam F_STEPS = FOLD * (
    (FILTER == 3 ? F_DENOISED * (51 + F_Q)
        : FILTER != 0 ? F_DENOISED * (10 * WIDTH + (FILTER == 2 ? 22 : 3) + F_COPIES + F_Q) : F_COPIES ? 3 * F_N : F_N * (3 + F_Q))
    + (BORDERS ? 4 * (SIDE + 2) * (2 + F_Q) : 0)
    + (LANES + (DEEP != 0 ? 1 : 0)) * (FEATURES + 1)
    + F_PASSES
    + (F_COPIES ? F_N * (2 + F_Q) : 0)
    + (RASTER != 0 ? F_N * (1 + LANES) : F_N)
    + (BLOCKS != 0 ? F_N + F_MEANS * (2 + LANES + (DEEP != 0 ? 1 : 0)) + F_MEANS * (LANES + (RASTER != 0 ? 1 : 2 + F_Q)) : 0));
reg [15:0] f_since;
reg f_waits, f_done;
always @(posedge clk_i) begin
    f_since <= start ? 0 : f_since + 1;
    if (rst_i) f_waits <= 0;
    else if (start) f_waits <= 1;
    else if (ready_o) f_waits <= 0;
end
always @* if (started && f_waits) begin
    assert(f_since <= F_STEPS + 1);
    if (ready_o) assert(f_since == F_STEPS + 1);
end

// The run is long enough: a frame takes this many clocks.
localparam F_TAKE = RASTER != 0 ? COLUMNS * ROWS * F_RAW : FOLD * F_RAW;
reg [15:0] f_clock;
always @(posedge clk_i) begin
    f_clock <= rst_i ? 0 : f_clock + 1;
    if (rst_i) f_done <= 0;
    else if (f_waits && ready_o) f_done <= 1;
end
always @* if (started) assert(f_done == (f_clock > F_TAKE + F_STEPS + 1));
`endif
