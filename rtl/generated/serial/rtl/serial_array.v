// SPDX-License-Identifier: MIT OR Apache-2.0
// The serial array: a feed, a sequencer, groups of registers, lanes in a ring, and one decision for
// all of them. It only connects; every number comes from the design.
//
// The scores of the lanes form a ring. In a rotation lane 0 holds the score that passes the decision;
// what that gives back enters the last lane, and after as many steps as there are lanes it is where the
// score was.
`default_nettype none

module serial_array #(
    parameter COLUMNS = 28,        // regions side by side
    parameter ROWS = 28,           // regions one below the other
    parameter FOLD = 1,            // regions of a lane
    parameter LANES = 784,
    parameter WIDTH = 8,           // bits of a pixel
    parameter SIDE = 8,            // of a region
    parameter RAW_SIDE = 8,        // of the square that is loaded
    parameter CLEAN_SIDE = 8,      // of the square that is denoised; without a filter, SIDE
    parameter MEDIAN = 1,
    parameter SHARED = 0,
    parameter LAST_SENT = 0,
    parameter BLANKS = 1,
    parameter RAW_PAYLOAD = 0,
    parameter RASTER = 0,
    parameter BLOCK = 0,           // 1: block RAM
    parameter FEATURES = 1,
    parameter [7:0] KINDS = 8'd0,  // two bits for each, the first lowest: edge, corner, mad, variance
    parameter ALL = 0,
    parameter FRACTION = 0,
    parameter CLEAN_BASE = 64,
    parameter KEPT_BASE = 64,
    parameter WORD_BITS = 7,
    parameter SLOT_BITS = 1,
    parameter ADDRESS_BITS = 7,
    parameter LANE_BITS = 10,
    parameter REGION_BITS = 10,
    parameter POSITION_BITS = 6,
    parameter INDEX_BITS = 1,
    parameter COUNT_BITS = 7,
    parameter SCORE_BITS = 7,
    parameter SUM_BITS = 14,
    parameter SCALE_BITS = 8,
    parameter ACC_BITS = 11,
    parameter AUX_BITS = 1,
    parameter CHAIN_BITS = 7
) (
    input  wire                                     clk_i,
    input  wire                                     rst_i,
    input  wire                                     valid_i,
    output wire                                     ready_o,
    input  wire [(RASTER != 0 ? 1 : LANES)*WIDTH-1:0] pixel_i,
    input  wire [                        WIDTH-1:0] temporal_level_i,
    input  wire [                        WIDTH+1:0] edge_half_i,       // half the level of `edge`
    input  wire [                        WIDTH-1:0] corner_level_i,
    input  wire [      (FEATURES+1)*SCORE_BITS-1:0] minima_i,
    output wire                                     score_valid_o,
    output wire [                   INDEX_BITS-1:0] score_index_o,
    output wire [                  REGION_BITS-1:0] region_o,
    output wire [                   SCORE_BITS-1:0] score_o,
    output wire                                     decision_valid_o,
    output wire                                     srs_o,
    output wire                                     trs_o,
    output wire                                     active_o,
    output wire [      (RASTER != 0 ? 1 : LANES)-1:0] forward_valid_o,
    output wire [(RASTER != 0 ? 1 : LANES)*WIDTH-1:0] forward_pixel_o,
    output wire [                    SLOT_BITS-1:0] forward_slot_o,
    output wire [                POSITION_BITS-1:0] forward_position_o
);

    localparam GROUP_LANES = RASTER != 0 ? 64 : 96;  // a group selects one of 64
    localparam GROUPS = (LANES + GROUP_LANES - 1) / GROUP_LANES;
    localparam EDGE = KINDS[1:0] == 0 || (FEATURES > 1 && KINDS[3:2] == 0)
        || (FEATURES > 2 && KINDS[5:4] == 0) || (FEATURES > 3 && KINDS[7:6] == 0);
    localparam CORNER = KINDS[1:0] == 1 || (FEATURES > 1 && KINDS[3:2] == 1)
        || (FEATURES > 2 && KINDS[5:4] == 1) || (FEATURES > 3 && KINDS[7:6] == 1);
    localparam MAD = KINDS[1:0] == 2 || (FEATURES > 1 && KINDS[3:2] == 2)
        || (FEATURES > 2 && KINDS[5:4] == 2) || (FEATURES > 3 && KINDS[7:6] == 2);
    localparam VARIANCE = KINDS[1:0] == 3 || (FEATURES > 1 && KINDS[3:2] == 3)
        || (FEATURES > 2 && KINDS[5:4] == 3) || (FEATURES > 3 && KINDS[7:6] == 3);
    localparam SUMS = MAD || VARIANCE;
    localparam BORDERS = MEDIAN != 0 && CLEAN_SIDE != SIDE;
    localparam FLAGS = FEATURES > 1 ? 2 : 1;

    // Which controls the design uses.
    localparam ACCESS_BITS = 4;
    localparam [0:0] HAS_BORDERS = BORDERS;
    localparam [0:0] HAS_COPIES = LAST_SENT != 0;
    localparam [0:0] HAS_MEDIAN = MEDIAN != 0;
    localparam [0:0] HAS_RUN = MEDIAN != 0 || EDGE || CORNER;
    localparam [0:0] HAS_CORNER = CORNER;
    localparam [0:0] HAS_MAD = MAD;
    localparam [0:0] HAS_VARIANCE = VARIANCE;
    localparam [0:0] HAS_SUMS = SUMS;
    localparam [0:0] HAS_RASTER = RASTER != 0;
    localparam [ACCESS_BITS-1:0] ACCESS_USED = {HAS_COPIES, {3{HAS_BORDERS}}};
    localparam EXECUTE_BITS = ACC_BITS + 22;
    localparam [EXECUTE_BITS-1:0] EXECUTE_USED = {
        {ACC_BITS{1'b1}}, 3'b111, HAS_MEDIAN, 3'b111,
        HAS_RUN, HAS_CORNER, HAS_RUN, 1'b1, HAS_CORNER,
        HAS_SUMS, HAS_SUMS, HAS_MAD, HAS_VARIANCE, HAS_VARIANCE,
        1'b1, HAS_SUMS, HAS_RASTER, 1'b1, !HAS_RASTER
    };

    // Feed.
    wire working, reopen, start, open, take, place;
    wire [LANE_BITS-1:0] place_lane;
    wire [SLOT_BITS-1:0] place_slot;
    wire [WORD_BITS-1:0] place_word;

    generate
        if (RASTER != 0) begin : g_raster_feed
            serial_raster_feed #(
                .SIDE(SIDE), .HALO((RAW_SIDE - SIDE) / 2), .COLUMNS(COLUMNS), .ROWS(ROWS), .FOLD(FOLD),
                .WORD_BITS(WORD_BITS), .SLOT_BITS(SLOT_BITS), .LANE_BITS(LANE_BITS)
            ) u_feed (
                .clk_i(clk_i), .rst_i(rst_i), .valid_i(valid_i), .reopen_i(reopen), .ready_o(ready_o),
                .take_o(take), .place_o(place), .last_o(start), .lane_o(place_lane),
                .slot_o(place_slot), .word_o(place_word)
            );
            assign open = 1'b0;
        end else begin : g_parallel_feed
            serial_parallel_feed #(
                .PIXELS(RAW_SIDE * RAW_SIDE), .FOLD(FOLD), .WORD_BITS(WORD_BITS), .SLOT_BITS(SLOT_BITS)
            ) u_feed (
                .clk_i(clk_i), .rst_i(rst_i), .valid_i(valid_i), .reopen_i(reopen), .ready_o(ready_o),
                .open_o(open), .last_o(start), .slot_o(place_slot), .word_o(place_word)
            );
            assign take = 1'b0;
            assign place = 1'b0;
            assign place_lane = {LANE_BITS{1'b0}};
        end
    endgenerate

    // Sequencer.
    wire [SLOT_BITS-1:0] slot;
    wire [WORD_BITS-1:0] word;
    wire write;
    wire [ACCESS_BITS-1:0] access;
    wire [EXECUTE_BITS-1:0] execute;
    wire rotate, unload;
    wire [INDEX_BITS-1:0] index;
    wire [REGION_BITS-1:0] region;
    wire [POSITION_BITS-1:0] position;
    wire [ACC_BITS-1:0] constant;
    wire from_memory, subtract, by_sign, by_run, carry, enable, clear;
    wire run, run_corner, run_clear, count, count_corner;
    wire double, divide, deviate, masked, from_aux;
    wire shift, keep, fetch, chain_clear;
    wire write_active, write_border;
    wire [1:0] side;

    assign access = {write_active, write_border, side};
    assign execute = {
        constant, from_memory, subtract, by_sign, by_run, carry, enable, clear,
        run, run_corner, run_clear, count, count_corner,
        double, divide, deviate, masked, from_aux,
        shift, keep, fetch, chain_clear, unload
    };

    serial_sequencer #(
        .WIDTH(WIDTH), .SIDE(SIDE), .RAW_SIDE(RAW_SIDE), .CLEAN_SIDE(CLEAN_SIDE), .MEDIAN(MEDIAN),
        .CLAMPS(SHARED != 0 ? 0 : 1), .LAST_SENT(LAST_SENT), .RAW_PAYLOAD(RAW_PAYLOAD), .RASTER(RASTER),
        .BLOCK(BLOCK), .FOLD(FOLD), .LANES(LANES), .FEATURES(FEATURES), .KINDS(KINDS),
        .FRACTION(FRACTION), .SUM_BITS(SUM_BITS), .COUNT_BITS(COUNT_BITS), .CLEAN_BASE(CLEAN_BASE),
        .KEPT_BASE(KEPT_BASE), .WORD_BITS(WORD_BITS), .SLOT_BITS(SLOT_BITS), .REGION_BITS(REGION_BITS),
        .POSITION_BITS(POSITION_BITS), .INDEX_BITS(INDEX_BITS), .SCALE_BITS(SCALE_BITS),
        .ACC_BITS(ACC_BITS)
    ) u_sequencer (
        .clk_i(clk_i), .rst_i(rst_i), .start_i(start), .temporal_level_i(temporal_level_i),
        .edge_half_i(edge_half_i), .corner_level_i(corner_level_i), .working_o(working),
        .reopen_o(reopen), .slot_o(slot), .address_o(word), .write_o(write),
        .write_active_o(write_active), .write_border_o(write_border), .side_o(side),
        .constant_o(constant), .from_memory_o(from_memory), .subtract_o(subtract), .by_sign_o(by_sign),
        .by_run_o(by_run), .carry_o(carry), .enable_o(enable), .clear_o(clear), .run_o(run),
        .run_corner_o(run_corner), .run_clear_o(run_clear), .count_o(count),
        .count_corner_o(count_corner), .double_o(double), .divide_o(divide), .deviate_o(deviate),
        .masked_o(masked), .from_aux_o(from_aux), .shift_o(shift), .keep_o(keep), .fetch_o(fetch),
        .chain_clear_o(chain_clear), .rotate_o(rotate), .unload_o(unload), .index_o(index),
        .region_o(region), .position_o(position)
    );

    wire [SLOT_BITS+WORD_BITS-1:0] full_address =
        working ? {slot, word} : {place_slot, place_word};
    wire unused_slot = |full_address;

    // What goes with the scores and pixels at the ports.
    localparam SHOWN_BITS = REGION_BITS + SLOT_BITS + POSITION_BITS + INDEX_BITS + 2;
    wire [SHOWN_BITS-1:0] shown;
    wire shown_rotate, shown_unload;
    wire [SLOT_BITS-1:0] shown_slot;

    serial_shown #(.WIDTH(SHOWN_BITS), .BLOCK(BLOCK)) u_shown (
        .clk_i(clk_i), .rst_i(rst_i), .bits_i({rotate, unload, slot, position, index, region}),
        .bits_o(shown)
    );
    assign {shown_rotate, shown_unload, shown_slot, forward_position_o, score_index_o, region_o} = shown;
    assign forward_slot_o = shown_slot;

    // Groups.
    wire [GROUPS-1:0] loading;
    wire [GROUPS*8-1:0] rows;
    wire [GROUPS*8-1:0] columns;
    wire [GROUPS-1:0] writes;
    wire [GROUPS*ADDRESS_BITS-1:0] addresses;
    wire [GROUPS*ACCESS_BITS-1:0] accesses;
    wire [GROUPS*EXECUTE_BITS-1:0] executes;
    wire [GROUPS*WIDTH-1:0] pixels;

    genvar i;
    generate
        for (i = 0; i < GROUPS; i = i + 1) begin : g_group
            serial_group #(
                .WIDTH(WIDTH), .ADDRESS_BITS(ADDRESS_BITS), .BLOCK(BLOCK), .RASTER(RASTER), .GROUP(i),
                .LANE_BITS(LANE_BITS), .ACCESS_BITS(ACCESS_BITS), .ACCESS_USED(ACCESS_USED),
                .EXECUTE_BITS(EXECUTE_BITS), .EXECUTE_USED(EXECUTE_USED)
            ) u_group (
                .clk_i(clk_i), .rst_i(rst_i), .open_i(open), .valid_i(valid_i), .take_i(take),
                .pixel_i(pixel_i[WIDTH-1:0]), .place_i(place), .lane_i(place_lane),
                .address_i(full_address[ADDRESS_BITS-1:0]), .write_i(write), .access_i(access),
                .execute_i(execute), .loading_o(loading[i]), .pixel_o(pixels[i*WIDTH+:WIDTH]),
                .rows_o(rows[i*8+:8]), .columns_o(columns[i*8+:8]),
                .address_o(addresses[i*ADDRESS_BITS+:ADDRESS_BITS]), .write_o(writes[i]),
                .access_o(accesses[i*ACCESS_BITS+:ACCESS_BITS]),
                .execute_o(executes[i*EXECUTE_BITS+:EXECUTE_BITS])
            );
        end
    endgenerate

    // Lanes.
    wire [(LANES+1)*CHAIN_BITS-1:0] ring;
    wire [(LANES+1)*FLAGS-1:0] flags;
    wire [LANES*WIDTH-1:0] words;

    assign ring[LANES*CHAIN_BITS+:CHAIN_BITS] = {CHAIN_BITS{1'b0}};

    generate
        for (i = 0; i < LANES; i = i + 1) begin : g_lane
            localparam GROUP = i / GROUP_LANES;
            wire [ADDRESS_BITS-1:0] address = addresses[GROUP*ADDRESS_BITS+:ADDRESS_BITS];
            wire [3:0] sides;
            wire [WIDTH-1:0] pixel;
            wire [ACC_BITS-1:0] lane_constant;
            wire lane_from_memory, lane_subtract, lane_by_sign, lane_by_run, lane_carry, lane_enable;
            wire lane_clear, lane_run, lane_run_corner, lane_run_clear, lane_count, lane_count_corner;
            wire lane_double, lane_divide, lane_deviate, lane_masked, lane_from_aux;
            wire lane_shift, lane_keep, lane_fetch, lane_chain_clear, lane_unload;
            wire lane_write_active, lane_write_border, lane_leaves;
            wire [1:0] lane_side;

            assign {lane_write_active, lane_write_border, lane_side} =
                accesses[GROUP*ACCESS_BITS+:ACCESS_BITS];
            assign {
                lane_constant, lane_from_memory, lane_subtract, lane_by_sign, lane_by_run, lane_carry,
                lane_enable, lane_clear, lane_run, lane_run_corner, lane_run_clear, lane_count,
                lane_count_corner, lane_double, lane_divide, lane_deviate, lane_masked, lane_from_aux,
                lane_shift, lane_keep, lane_fetch, lane_chain_clear, lane_unload
            } = executes[GROUP*EXECUTE_BITS+:EXECUTE_BITS];

            if (!BORDERS) begin : g_no_sides
                assign sides = 4'b0000;
            end else if (FOLD == 1) begin : g_own_sides
                assign sides = {
                    i / COLUMNS == ROWS - 1, i / COLUMNS == 0, i % COLUMNS == COLUMNS - 1, i % COLUMNS == 0
                };
            end else begin : g_sides
                serial_sides #(
                    .FIRST(i * FOLD), .COLUMNS(COLUMNS), .ROWS(ROWS), .SLOT_BITS(SLOT_BITS)
                ) u_sides (
                    .slot_i(address[ADDRESS_BITS-1:WORD_BITS]), .sides_o(sides)
                );
            end

            serial_lane #(
                .WIDTH(WIDTH), .WORDS(FOLD << WORD_BITS), .ADDRESS_BITS(ADDRESS_BITS), .BLOCK(BLOCK),
                .ACC_BITS(ACC_BITS), .CHAIN_BITS(CHAIN_BITS), .FLAGS(FLAGS), .RASTER(RASTER),
                .COPIES(LAST_SENT), .BORDERS(BORDERS), .MEDIAN(MEDIAN), .EDGE(EDGE), .CORNER(CORNER),
                .MAD(MAD), .VARIANCE(VARIANCE), .FRACTION(FRACTION), .AUX_BITS(AUX_BITS)
            ) u_lane (
                .clk_i(clk_i), .loading_i(loading[GROUP]), .pixel_i(pixel), .address_i(address),
                .write_i(writes[GROUP]), .select_row_i(rows[GROUP*8+(i%64)/8]),
                .select_column_i(columns[GROUP*8+i%8]), .write_active_i(lane_write_active),
                .write_border_i(lane_write_border), .side_i(lane_side), .sides_i(sides),
                .constant_i(lane_constant), .from_memory_i(lane_from_memory),
                .subtract_i(lane_subtract), .by_sign_i(lane_by_sign), .by_run_i(lane_by_run),
                .carry_i(lane_carry), .enable_i(lane_enable), .clear_i(lane_clear), .run_i(lane_run),
                .run_corner_i(lane_run_corner), .run_clear_i(lane_run_clear), .count_i(lane_count),
                .count_corner_i(lane_count_corner), .double_i(lane_double), .divide_i(lane_divide),
                .deviate_i(lane_deviate), .masked_i(lane_masked), .from_aux_i(lane_from_aux),
                .shift_i(lane_shift), .unload_i(lane_unload), .keep_i(lane_keep), .fetch_i(lane_fetch),
                .chain_clear_i(lane_chain_clear), .word_i(ring[(i+1)*CHAIN_BITS+:CHAIN_BITS]),
                .flags_i(flags[(i+1)*FLAGS+:FLAGS]), .word_o(ring[i*CHAIN_BITS+:CHAIN_BITS]),
                .flags_o(flags[i*FLAGS+:FLAGS]), .leaves_o(lane_leaves), .pixel_o(words[i*WIDTH+:WIDTH])
            );

            if (RASTER != 0) begin : g_group_pixel
                wire unused_leaves = lane_leaves;
                assign pixel = pixels[GROUP*WIDTH+:WIDTH];
            end else begin : g_own_pixel
                assign pixel = pixel_i[i*WIDTH+:WIDTH];
                assign forward_valid_o[i] = lane_leaves;
                assign forward_pixel_o[i*WIDTH+:WIDTH] = words[i*WIDTH+:WIDTH];
            end
        end
    endgenerate

    // Decision.
    wire region_valid;

    serial_decision #(
        .CHAIN_BITS(CHAIN_BITS), .SCORE_BITS(SCORE_BITS), .PIXELS(SIDE * SIDE), .FEATURES(FEATURES),
        .ALL(ALL), .FLAGS(FLAGS), .LAST_SENT(LAST_SENT), .BLANKS(BLANKS), .REGIONS(COLUMNS * ROWS),
        .SLOTS(LANES * FOLD), .REGION_BITS(REGION_BITS), .INDEX_BITS(INDEX_BITS)
    ) u_decision (
        .clk_i(clk_i), .rst_i(rst_i), .frame_i(reopen), .rotate_i(shown_rotate),
        .index_i(score_index_o), .region_i(region_o),
        .word_i(ring[CHAIN_BITS-1:0]), .flags_i(flags[FLAGS-1:0]), .minima_i(minima_i),
        .flags_o(flags[LANES*FLAGS+:FLAGS]), .region_valid_o(region_valid),
        .score_valid_o(score_valid_o), .score_o(score_o), .decision_valid_o(decision_valid_o),
        .srs_o(srs_o), .trs_o(trs_o), .active_o(active_o)
    );
    wire unused_region_valid = region_valid;

    generate
        if (RASTER != 0) begin : g_forward
            assign forward_valid_o = shown_unload && flags[0];
            assign forward_pixel_o = ring[WIDTH-1:0];
            wire unused_words = |words;
        end else begin : g_parallel_unused
            wire unused_shown = shown_unload || |pixels;
        end
    endgenerate

endmodule

`default_nettype wire
