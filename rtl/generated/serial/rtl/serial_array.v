// SPDX-License-Identifier: MIT OR Apache-2.0
// The serial array: a feed, a sequencer, groups of registers, lanes in a ring, and one decision for all of them. It only
// connects these modules; the design gives every number. docs/serial.md defines each output at each clock.
//
// The scores of the lanes form a ring. In a rotation, lane 0 holds the score that passes the decision. The word that comes
// back enters the last lane, and after as many steps as there are lanes it is in the place of the score.
`default_nettype none

module serial_array #(
    // Grid, lanes and slots
    parameter COLUMNS = 2,          // regions in a row of regions
    parameter ROWS = 2,             // rows of regions
    parameter FOLD = 1,             // number of regions of a lane, its slots
    parameter LANES = 4,            // number of lanes that COLUMNS * ROWS regions need
    parameter RASTER = 0,           // 1: the frame enters row by row; 0: one pixel per lane
    parameter LANE_BITS = 2,        // bits of the number of a lane, at least 1
    parameter SLOT_BITS = 1,        // bits of the number of a slot, at least 1
    parameter REGION_BITS = 2,      // bits of the number of a region, empty slots included
    // Regions and their windows
    parameter WIDTH = 8,            // bits of a pixel, 1 to 16
    parameter SIDE = 8,             // pixels of a side of a region, 4 to 64
    parameter RAW_SIDE = 8,         // side of the square that is loaded: SIDE plus twice the halo
    parameter DENOISED_SIDE = 8,    // side of the square that is denoised; SIDE without a filter
    parameter FILTER = 1,           // 0: none; 1: `median3x3`; 2: `switching3x3`; 3: `binomial3x3`
    parameter SHARED = 0,           // 1: windows see neighboring regions; 0: windows repeat the region's own border
    parameter POSITION_BITS = 6,    // bits of the number of a pixel in the largest square of centers
    // Features and decision
    parameter FEATURES = 1,         // spatial features, 1 to 8
    parameter EDGE_INDEX = 1,       // number of the score of `edge`, from 1 on in the order of the ports; 0: there is none
    parameter CORNER_INDEX = 0,     // number of the score of `corner`; 0: there is none
    parameter MAD_INDEX = 0,        // number of the score of `mad`; 0: there is none
    parameter VARIANCE_INDEX = 0,   // number of the score of `variance`; 0: there is none
    parameter RANGE_INDEX = 0,      // number of the score of `range`; 0: there is none
    parameter SURFACE_INDEX = 0,    // number of the score of `surface`; 0: there is none
    parameter SEGMENT_INDEX = 0,    // number of the score of `segment`; 0: there is none
    parameter FLOW_INDEX = 0,       // number of the score of `flow`; 0: there is none
    parameter FLOW_RADIUS = 1,      // `flow`: largest |dx| and |dy|, 1 to 3
    parameter FLOW_FACTOR_BITS = 1, // `flow`: bits of a factor of a weight
    parameter [(FLOW_RADIUS+1)*FLOW_FACTOR_BITS-1:0] FLOW_FACTORS = 0,  // `flow`: the factors, see serial_flow
    parameter ALL = 0,              // 1: every feature must vote; 0: one vote is enough
    parameter FRACTION = 0,         // fraction bits of the mean of `mad` and `segment`, 0 to 12
    // Reference and what leaves
    parameter LAST_SENT = 0,        // 1: the reference is `last-sent`; 0: `previous`
    parameter BLANKS = 1,           // 1: irrelevant regions are shown as 0; 0: they are held
    parameter RAW_PAYLOAD = 0,      // 1: raw pixels leave; 0: the pixels that are scored
    // Means of blocks
    parameter BLOCKS = 0,           // blocks of a region's side whose means are sent: 1, 2 or 4; 0: none
    parameter MEAN_DROPPED = 0,     // bits of a block's sum that stay in the lane
    parameter MEAN_SUM_BITS = 8,    // bits of a block's sum that leave the lane
    parameter MEAN_FACTOR_BITS = 1, // bits of MEAN_FACTOR
    parameter [MEAN_FACTOR_BITS-1:0] MEAN_FACTOR = 1,  // (sum from the lane * MEAN_FACTOR) >> MEAN_SHIFT is the mean
    parameter MEAN_SHIFT = 0,       // bits of the product that are dropped
    // Memory of a lane
    parameter BLOCK = 0,            // 1: the memories are block RAM; 0: distributed RAM
    parameter DENOISED_BASE = 64,   // address in a slot where the denoised square starts
    parameter REFERENCE_BASE = 64,  // address in a slot where the reference starts
    parameter WORD_BITS = 7,        // bits of an address inside a slot
    parameter ADDRESS_BITS = 7,     // bits of an address in the memory of a lane: slot and word
    // Widths of scores and of the lane
    parameter INDEX_BITS = 1,       // bits of the number of a score
    parameter COUNT_BITS = 7,       // bits of a count of pixels, 0..SIDE * SIDE
    parameter SCORE_BITS = 7,       // bits of the widest score
    parameter SUM_BITS = 14,        // bits of the sum of a region
    parameter SCALE_BITS = 8,       // bits of the constant that is shifted from step to step
    parameter ACC_BITS = 11,        // bits of the accumulator, which is signed
    parameter AUX_BITS = 1,         // bits of the second word: a mean, a sum, the largest pixel or a quotient; at least 2
    parameter CHAIN_BITS = 7,       // bits of the word that goes around the ring of lanes
    parameter LEAST_BITS = 2,       // `flow`: bits of a sum times its weight
    parameter COORDINATE_BITS = 2,  // bits of dx and of dy of a displacement
    // Zones
    parameter ZONES = 0,            // 1: regions have classes
    parameter CLASS_ADDRESS_BITS = 1,  // bits of the number of a word of the map of classes
    parameter [2*COLUMNS*ROWS-1:0] CLASSES = 0,  // the first map, region 0 in the lowest bits
    // Timing
    parameter DEEP = 0              // 1: more registers, for a faster clock
) (
    // Clock and frame
    input  wire                                       clk_i,              // clock, rising edge
    input  wire                                       rst_i,              // synchronous reset, active high
    input  wire                                       valid_i,            // a pixel comes in
    output wire                                       ready_o,            // a pixel would be taken at the next edge
    input  wire [(RASTER != 0 ? 1 : LANES)*WIDTH-1:0] pixel_i,            // the pixel; `parallel`: one pixel per lane, lane 0 lowest
    // Thresholds
    input  wire [                          WIDTH-1:0] temporal_level_i,   // a pixel has changed above this difference
    input  wire [                          WIDTH+1:0] edge_half_i,        // half the level of `edge`, rounded down
    input  wire [                          WIDTH-1:0] corner_level_i,     // level of `corner`
    input  wire [                          WIDTH-1:0] segment_level_i,    // level of `segment`
    input  wire [        (FEATURES+1)*SCORE_BITS-1:0] minima_i,           // smallest scores that vote, that of TRS lowest
    input  wire [                          WIDTH-1:0] summary_level_i,    // a mean that differs by more than this level is sent again
    // Classes (ZONES), and the thresholds of keen regions and of those that are off
    input  wire                                       zone_write_i,       // a word of the map of classes is written
    input  wire [             CLASS_ADDRESS_BITS-1:0] zone_address_i,     // number of that word
    input  wire [                               31:0] zone_word_i,        // the word: 16 classes, the first one in the lowest bits
    input  wire                                       zone_commit_i,      // frames use the map that has been written
    output wire                                       zone_pending_o,     // the committed map is not in use yet
    input  wire [                          WIDTH-1:0] keen_temporal_level_i,  // temporal_level_i of keen regions
    input  wire [                          WIDTH+1:0] keen_edge_half_i,   // edge_half_i of keen regions
    input  wire [                          WIDTH-1:0] keen_corner_level_i,  // corner_level_i of keen regions
    input  wire [                          WIDTH-1:0] keen_segment_level_i, // segment_level_i of keen regions
    input  wire [        (FEATURES+1)*SCORE_BITS-1:0] keen_minima_i,      // minima_i of keen regions
    input  wire [                          WIDTH-1:0] keen_summary_level_i, // summary_level_i of keen regions
    input  wire [                          WIDTH-1:0] off_summary_level_i,  // summary_level_i of regions that are off
    // Scores and decisions
    output wire                                       score_valid_o,      // a score of region_o is on the ports
    output wire [                     INDEX_BITS-1:0] score_index_o,      // number of that score; 0 is the temporal count
    output wire [                    REGION_BITS-1:0] region_o,           // number of the region of the score and of the decision
    output wire [                     SCORE_BITS-1:0] score_o,            // the score
    output wire [                COORDINATE_BITS-1:0] displacement_x_o,   // `flow`: dx of region_o, with its score; else 0
    output wire [                COORDINATE_BITS-1:0] displacement_y_o,   // `flow`: dy of region_o, with its score; else 0
    output wire                                       decision_valid_o,   // the decision for region_o is on the ports
    output wire                                       srs_o,              // SRS, the spatial relevance; 0 unless decision_valid_o
    output wire                                       trs_o,              // TRS, the temporal relevance; 0 unless decision_valid_o
    output wire                                       active_o,           // SRS and TRS are both 1
    output wire                                       summary_o,          // the means of region_o are sent; 0 unless decision_valid_o
    // Pixels and means that leave
    output wire [      (RASTER != 0 ? 1 : LANES)-1:0] forward_valid_o,    // a pixel of an active region, or a mean, leaves
    output wire [(RASTER != 0 ? 1 : LANES)*WIDTH-1:0] forward_pixel_o,    // the pixel or mean that leaves
    output wire [                      SLOT_BITS-1:0] forward_slot_o,     // `parallel`: slot of that pixel's region in its lane
    output wire [                  POSITION_BITS-1:0] forward_position_o  // position of that pixel in its region
);

    // The features of the design.
    localparam EDGE = EDGE_INDEX != 0 ? 1 : 0;
    localparam CORNER = CORNER_INDEX != 0 ? 1 : 0;
    localparam MAD = MAD_INDEX != 0 ? 1 : 0;
    localparam VARIANCE = VARIANCE_INDEX != 0 ? 1 : 0;
    localparam RANGE = RANGE_INDEX != 0 ? 1 : 0;
    localparam SURFACE = SURFACE_INDEX != 0 ? 1 : 0;
    localparam SEGMENT = SEGMENT_INDEX != 0 ? 1 : 0;
    localparam FLOW = FLOW_INDEX != 0 ? 1 : 0;

    // The reference is copied after the last score: 1: by active regions; 2: by all regions; 0: it is overwritten pixel by pixel.
    localparam COPIES = LAST_SENT != 0 ? 1 : FLOW ? 2 : 0;

    // The areas of a slot: raw, denoised, reference.
    localparam HAS_DENOISED = FILTER != 0;
    localparam HAS_REFERENCE = FILTER == 0 || COPIES != 0;
    localparam RAW_END = RAW_SIDE * RAW_SIDE;
    localparam DENOISED_END = DENOISED_BASE + DENOISED_SIDE * DENOISED_SIDE;
    localparam REFERENCE_END = REFERENCE_BASE + SIDE * SIDE;

    // Limits: a value out of range stops elaboration at an instance of a module that does not exist.
    generate
        if (WIDTH < 1 || WIDTH > 16) begin : g_width WIDTH_must_be_1_to_16 u_refused (); end
        if (SIDE < 4 || SIDE > 64) begin : g_side SIDE_must_be_4_to_64 u_refused (); end
        if (COLUMNS < 1) begin : g_columns COLUMNS_must_be_1_or_more u_refused (); end
        if (ROWS < 1) begin : g_rows ROWS_must_be_1_or_more u_refused (); end
        if (FOLD < 1 || (FOLD > 1 && FOLD > COLUMNS * ROWS)) begin : g_fold
            FOLD_must_be_1_to_the_regions u_refused ();
        end
        if (COLUMNS > 0 && ROWS > 0 && LANES != (COLUMNS * ROWS + FOLD - 1) / FOLD) begin : g_lanes
            LANES_must_be_regions_by_FOLD_rounded_up u_refused ();
        end
        if (RAW_SIDE != SIDE && RAW_SIDE != SIDE + 2 && RAW_SIDE != SIDE + 4) begin : g_raw_side
            RAW_SIDE_must_be_SIDE_and_0_2_or_4 u_refused ();
        end
        if (DENOISED_SIDE != SIDE && DENOISED_SIDE != SIDE + 2) begin : g_denoised_side
            DENOISED_SIDE_must_be_SIDE_and_0_or_2 u_refused ();
        end
        if (FILTER < 0 || FILTER > 3) begin : g_filter FILTER_must_be_0_to_3 u_refused (); end
        if (SHARED != 0 && SHARED != 1) begin : g_shared SHARED_must_be_0_or_1 u_refused (); end
        if (LAST_SENT != 0 && LAST_SENT != 1) begin : g_last_sent
            LAST_SENT_must_be_0_or_1 u_refused ();
        end
        if (BLANKS != 0 && BLANKS != 1) begin : g_blanks BLANKS_must_be_0_or_1 u_refused (); end
        if (RAW_PAYLOAD != 0 && RAW_PAYLOAD != 1) begin : g_raw_payload
            RAW_PAYLOAD_must_be_0_or_1 u_refused ();
        end
        if (RASTER != 0 && RASTER != 1) begin : g_raster RASTER_must_be_0_or_1 u_refused (); end
        if (BLOCK != 0 && BLOCK != 1) begin : g_block BLOCK_must_be_0_or_1 u_refused (); end
        if (DEEP != 0 && DEEP != 1) begin : g_deep DEEP_must_be_0_or_1 u_refused (); end
        if (ALL != 0 && ALL != 1) begin : g_all ALL_must_be_0_or_1 u_refused (); end
        if (FEATURES < 1 || FEATURES > 8) begin : g_features FEATURES_must_be_1_to_8 u_refused (); end
        if (FEATURES != EDGE + CORNER + MAD + VARIANCE + RANGE + SURFACE + SEGMENT + FLOW) begin : g_indices
            FEATURES_must_count_the_features u_refused ();
        end
        if (FRACTION < 0 || FRACTION > 12) begin : g_fraction FRACTION_must_be_0_to_12 u_refused (); end
        if (BLOCKS != 0 && BLOCKS != 1 && BLOCKS != 2 && BLOCKS != 4) begin : g_blocks
            BLOCKS_must_be_0_1_2_or_4 u_refused ();
        end
        if ((BLOCKS == 2 && SIDE % 2 != 0) || (BLOCKS == 4 && SIDE % 4 != 0)) begin : g_divides
            BLOCKS_must_divide_SIDE u_refused ();
        end
        if (BLOCKS != 0 && MEAN_SUM_BITS > CHAIN_BITS) begin : g_mean_sum_bits
            MEAN_SUM_BITS_must_be_CHAIN_BITS_or_less u_refused ();
        end
        if (SLOT_BITS != (FOLD > 1 ? $clog2(FOLD) : 1)) begin : g_slot_bits
            SLOT_BITS_must_number_the_slots u_refused ();
        end
        if (ADDRESS_BITS != $clog2(FOLD << WORD_BITS)) begin : g_address_bits
            ADDRESS_BITS_must_address_the_memory u_refused ();
        end
        if (LANE_BITS != (LANES > 1 ? $clog2(LANES) : 1)) begin : g_lane_bits
            LANE_BITS_must_number_the_lanes u_refused ();
        end
        if (COUNT_BITS != $clog2(SIDE * SIDE + 1)) begin : g_count_bits
            COUNT_BITS_must_hold_the_pixels u_refused ();
        end
        // The areas of a slot are one behind the other, and fit into it.
        if (HAS_DENOISED && DENOISED_BASE < RAW_END) begin : g_denoised_base
            DENOISED_BASE_must_lie_behind_the_raw_area u_refused ();
        end
        if (HAS_REFERENCE && REFERENCE_BASE < (HAS_DENOISED ? DENOISED_END : RAW_END)) begin : g_reference_base
            REFERENCE_BASE_must_lie_behind_the_other_areas u_refused ();
        end
        if ((1 << WORD_BITS) < (HAS_REFERENCE ? REFERENCE_END : DENOISED_END)) begin : g_word_bits
            WORD_BITS_must_address_all_areas u_refused ();
        end
    endgenerate

    localparam GROUP_LANES = RASTER != 0 ? 64 : 96;  // lanes of a group; with RASTER a group selects one of its lanes by 8 rows and 8 columns
    localparam GROUPS = (LANES + GROUP_LANES - 1) / GROUP_LANES;
    localparam BORDERS = FILTER != 0 && DENOISED_SIDE != SIDE;
    localparam SUMMARIES = BLOCKS != 0 ? 1 : 0;
    localparam FLAGS = FEATURES > 1 || SUMMARIES ? 2 : 1;
    localparam BLOCK_BITS = BLOCKS > 1 ? $clog2(BLOCKS * BLOCKS) : 1;
    localparam CONTROL_BITS = 39;  // bits of the control word
    // Clocks from an address to its word, and from an address to the accumulator.
    localparam WORD = (BLOCK != 0 ? 1 : 0) + (DEEP != 0 ? 1 : 0);
    localparam LATE = WORD + (DEEP != 0 && (MAD || VARIANCE || RANGE || SURFACE || FLOW) ? 1 : 0);

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
    wire rotate, average, returns, unload;
    wire [BLOCK_BITS-1:0] block;
    wire [INDEX_BITS-1:0] index;
    wire [REGION_BITS-1:0] region;
    wire [POSITION_BITS-1:0] position;
    wire [ACC_BITS-1:0] constant, keen_constant;
    wire classing;
    wire [CONTROL_BITS-1:0] controls;

    serial_sequencer #(
        .WIDTH(WIDTH), .SIDE(SIDE), .RAW_SIDE(RAW_SIDE), .DENOISED_SIDE(DENOISED_SIDE), .FILTER(FILTER),
        .CLAMPS(SHARED != 0 ? 0 : 1), .COPIES(COPIES), .RAW_PAYLOAD(RAW_PAYLOAD), .RASTER(RASTER),
        .LATE(LATE), .DEEP(DEEP), .FOLD(FOLD), .LANES(LANES), .FEATURES(FEATURES),
        .EDGE_INDEX(EDGE_INDEX), .CORNER_INDEX(CORNER_INDEX), .MAD_INDEX(MAD_INDEX),
        .VARIANCE_INDEX(VARIANCE_INDEX), .RANGE_INDEX(RANGE_INDEX), .SURFACE_INDEX(SURFACE_INDEX), .SEGMENT_INDEX(SEGMENT_INDEX),
        .FLOW_INDEX(FLOW_INDEX), .FLOW_RADIUS(FLOW_RADIUS), .FLOW_FACTOR_BITS(FLOW_FACTOR_BITS), .FLOW_FACTORS(FLOW_FACTORS),
        .LEAST_BITS(LEAST_BITS), .COORDINATE_BITS(COORDINATE_BITS),
        .BLOCKS(BLOCKS), .BLOCK_BITS(BLOCK_BITS),
        .FRACTION(FRACTION), .SUM_BITS(SUM_BITS), .COUNT_BITS(COUNT_BITS), .DENOISED_BASE(DENOISED_BASE),
        .REFERENCE_BASE(REFERENCE_BASE), .WORD_BITS(WORD_BITS), .SLOT_BITS(SLOT_BITS),
        .REGION_BITS(REGION_BITS), .POSITION_BITS(POSITION_BITS), .INDEX_BITS(INDEX_BITS),
        .SCALE_BITS(SCALE_BITS), .ACC_BITS(ACC_BITS), .ZONES(ZONES)
    ) u_sequencer (
        .clk_i(clk_i), .rst_i(rst_i), .start_i(start), .temporal_level_i(temporal_level_i),
        .edge_half_i(edge_half_i), .corner_level_i(corner_level_i), .segment_level_i(segment_level_i),
        .keen_temporal_level_i(keen_temporal_level_i), .keen_edge_half_i(keen_edge_half_i),
        .keen_corner_level_i(keen_corner_level_i), .keen_segment_level_i(keen_segment_level_i),
        .keen_constant_o(keen_constant), .classing_o(classing), .working_o(working),
        .reopen_o(reopen), .slot_o(slot), .address_o(word), .write_o(write), .constant_o(constant),
        .controls_o(controls), .rotate_o(rotate), .average_o(average), .return_o(returns), .block_o(block), .unload_o(unload), .index_o(index), .region_o(region),
        .position_o(position)
    );

    wire [SLOT_BITS+WORD_BITS-1:0] full_address =
        working ? {slot, word} : {place_slot, place_word};
    wire unused_slot = |full_address;

    // The numbers that belong to the scores and pixels at the ports.
    localparam SHOWN_BITS = REGION_BITS + BLOCK_BITS + SLOT_BITS + POSITION_BITS + INDEX_BITS + 4;
    wire [SHOWN_BITS-1:0] shown, next_shown;
    wire shown_rotate, shown_average, shown_return, shown_unload;
    wire [BLOCK_BITS-1:0] shown_block;
    wire [SLOT_BITS-1:0] shown_slot;

    serial_shown #(.WIDTH(SHOWN_BITS), .LATE(LATE)) u_shown (
        .clk_i(clk_i), .rst_i(rst_i),
        .bits_i({rotate, average, returns, unload, slot, position, index, block, region}),
        .next_o(next_shown), .bits_o(shown)
    );
    assign {
        shown_rotate, shown_average, shown_return, shown_unload, shown_slot, forward_position_o, score_index_o,
        shown_block, region_o
    } = shown;
    assign forward_slot_o = shown_slot;

    // Groups.
    wire [GROUPS-1:0] loading;
    wire [GROUPS*8-1:0] rows;
    wire [GROUPS*8-1:0] columns;
    wire [GROUPS-1:0] writes;
    wire [GROUPS*ADDRESS_BITS-1:0] addresses;
    wire [GROUPS*WIDTH-1:0] pixels;
    wire [GROUPS*ACC_BITS-1:0] all_constant;
    wire [GROUPS*CONTROL_BITS-1:0] all_controls;
    wire [GROUPS*ACC_BITS-1:0] all_keen_constant;
    wire [GROUPS-1:0] all_classing;

    genvar i;
    generate
        for (i = 0; i < GROUPS; i = i + 1) begin : g_group
            serial_group #(
                .WIDTH(WIDTH), .ADDRESS_BITS(ADDRESS_BITS), .WORD(WORD), .LATE(LATE), .RASTER(RASTER),
                .GROUP(i), .LANE_BITS(LANE_BITS), .ACC_BITS(ACC_BITS), .COPIES(COPIES), .BORDERS(BORDERS),
                .FILTER(FILTER), .EDGE(EDGE), .CORNER(CORNER), .MAD(MAD), .VARIANCE(VARIANCE), .RANGE(RANGE), .SURFACE(SURFACE),
                .SEGMENT(SEGMENT), .FLOW(FLOW), .SUMMARIES(SUMMARIES), .ZONES(ZONES)
            ) u_group (
                .clk_i(clk_i), .rst_i(rst_i), .open_i(open), .valid_i(valid_i), .take_i(take),
                .pixel_i(pixel_i[WIDTH-1:0]), .place_i(place), .lane_i(place_lane),
                .address_i(full_address[ADDRESS_BITS-1:0]), .write_i(write),
                .constant_i(constant), .controls_i(controls), .keen_constant_i(keen_constant), .classing_i(classing),
                .loading_o(loading[i]), .pixel_o(pixels[i*WIDTH+:WIDTH]), .rows_o(rows[i*8+:8]),
                .columns_o(columns[i*8+:8]), .address_o(addresses[i*ADDRESS_BITS+:ADDRESS_BITS]),
                .write_o(writes[i]), .constant_o(all_constant[i*ACC_BITS+:ACC_BITS]),
                .controls_o(all_controls[i*CONTROL_BITS+:CONTROL_BITS]),
                .keen_constant_o(all_keen_constant[i*ACC_BITS+:ACC_BITS]), .classing_o(all_classing[i])
            );
        end
    endgenerate

    // Lanes.
    wire [(LANES+1)*CHAIN_BITS-1:0] ring;
    wire [(LANES+1)*FLAGS-1:0] flags;
    wire [LANES:0] keen;  // keen[i]: the region of lane i is keen; keen[LANES]: the region whose class passes is keen
    wire unused_keen = keen[0];
    wire [LANES*WIDTH-1:0] words;
    localparam DISPLACEMENT_BITS = FLOW ? 2 * COORDINATE_BITS : 1;
    wire [(LANES+1)*DISPLACEMENT_BITS-1:0] displacements;
    assign displacements[LANES*DISPLACEMENT_BITS+:DISPLACEMENT_BITS] = {DISPLACEMENT_BITS{1'b0}};

    wire [WIDTH-1:0] mean;
    wire [CHAIN_BITS+WIDTH-1:0] wide_mean = {{CHAIN_BITS{1'b0}}, mean};
    wire unused_mean = |wide_mean[CHAIN_BITS+:WIDTH];

    assign ring[LANES*CHAIN_BITS+:CHAIN_BITS] =
        RASTER == 0 && shown_return ? wide_mean[CHAIN_BITS-1:0] : {CHAIN_BITS{1'b0}};

    generate
        for (i = 0; i < LANES; i = i + 1) begin : g_lane
            localparam GROUP = i / GROUP_LANES;
            wire [ADDRESS_BITS-1:0] address = addresses[GROUP*ADDRESS_BITS+:ADDRESS_BITS];
            wire [3:0] sides;
            wire [WIDTH-1:0] pixel;
            wire lane_leaves;

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
                .WIDTH(WIDTH), .WORDS(FOLD << WORD_BITS), .ADDRESS_BITS(ADDRESS_BITS), .BLOCK(BLOCK), .DEEP(DEEP),
                .ACC_BITS(ACC_BITS), .CHAIN_BITS(CHAIN_BITS), .FLAGS(FLAGS), .RASTER(RASTER),
                .COPIES(COPIES), .BORDERS(BORDERS), .FILTER(FILTER), .EDGE(EDGE), .CORNER(CORNER),
                .MAD(MAD), .VARIANCE(VARIANCE), .RANGE(RANGE), .SURFACE(SURFACE), .SEGMENT(SEGMENT), .FLOW(FLOW), .FRACTION(FRACTION),
                .SUMMARIES(SUMMARIES), .DROPPED(MEAN_DROPPED), .AUX_BITS(AUX_BITS), .SUM_BITS(SUM_BITS), .PIXELS(SIDE * SIDE),
                .LEAST_BITS(LEAST_BITS), .DISPLACEMENT_BITS(DISPLACEMENT_BITS), .ZONES(ZONES)
            ) u_lane (
                .clk_i(clk_i), .loading_i(loading[GROUP]), .pixel_i(pixel), .address_i(address),
                .write_i(writes[GROUP]), .select_row_i(rows[GROUP*8+(i%64)/8]),
                .select_column_i(columns[GROUP*8+i%8]), .sides_i(sides),
                .constant_i(all_constant[GROUP*ACC_BITS+:ACC_BITS]),
                .controls_i(all_controls[GROUP*CONTROL_BITS+:CONTROL_BITS]),
                .keen_constant_i(all_keen_constant[GROUP*ACC_BITS+:ACC_BITS]), .classing_i(all_classing[GROUP]),
                .keen_i(keen[i+1]), .keen_o(keen[i]),
                .word_i(ring[(i+1)*CHAIN_BITS+:CHAIN_BITS]), .flags_i(flags[(i+1)*FLAGS+:FLAGS]),
                .word_o(ring[i*CHAIN_BITS+:CHAIN_BITS]), .flags_o(flags[i*FLAGS+:FLAGS]),
                .displacement_i(displacements[(i+1)*DISPLACEMENT_BITS+:DISPLACEMENT_BITS]),
                .displacement_o(displacements[i*DISPLACEMENT_BITS+:DISPLACEMENT_BITS]),
                .leaves_o(lane_leaves), .pixel_o(words[i*WIDTH+:WIDTH])
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

    // Classes.
    wire [1:0] passing_class;  // class of region_o

    generate
        if (ZONES) begin : g_zones
            localparam [1:0] KEEN = 2'd2;
            reg in_frame_q;  // the array takes a frame or works on one
            wire in_frame = (in_frame_q || (valid_i && ready_o)) && !reopen;
            assign keen[LANES] = passing_class == KEEN;

            always @(posedge clk_i) in_frame_q <= in_frame && !rst_i;

            class_memory #(
                .REGIONS(COLUMNS * ROWS), .REGION_BITS(REGION_BITS), .ADDRESS_BITS(CLASS_ADDRESS_BITS), .CLASSES(CLASSES)
            ) u_classes (
                .clk_i(clk_i), .rst_i(rst_i), .write_i(zone_write_i), .address_i(zone_address_i), .word_i(zone_word_i),
                .commit_i(zone_commit_i), .pending_o(zone_pending_o), .occupied_i(in_frame),
                .region_i(next_shown[REGION_BITS-1:0]), .class_o(passing_class)
            );
        end else begin : g_no_zones
            wire unused_zones = zone_write_i || |zone_address_i || |zone_word_i || zone_commit_i || |CLASSES;
            assign zone_pending_o = 1'b0;
            assign passing_class = 2'd0;
            assign keen[LANES] = 1'b0;
        end
    endgenerate

    // Decision.
    wire region_valid;
    wire [DISPLACEMENT_BITS-1:0] displacement;

    serial_decision #(
        .CHAIN_BITS(CHAIN_BITS), .SCORE_BITS(SCORE_BITS), .PIXELS(SIDE * SIDE), .FEATURES(FEATURES),
        .ALL(ALL), .SUMMARIES(SUMMARIES), .FLAGS(FLAGS), .LAST_SENT(LAST_SENT), .BLANKS(BLANKS), .REGIONS(COLUMNS * ROWS),
        .SLOTS(LANES * FOLD), .REGION_BITS(REGION_BITS), .INDEX_BITS(INDEX_BITS),
        .FLOW_INDEX(FLOW_INDEX), .DISPLACEMENT_BITS(DISPLACEMENT_BITS), .ZONES(ZONES)
    ) u_decision (
        .clk_i(clk_i), .rst_i(rst_i), .frame_i(reopen), .rotate_i(shown_rotate),
        .index_i(score_index_o), .region_i(region_o),
        .word_i(ring[CHAIN_BITS-1:0]), .flags_i(flags[FLAGS-1:0]), .displacement_i(displacements[DISPLACEMENT_BITS-1:0]), .minima_i(minima_i),
        .keen_minima_i(keen_minima_i), .class_i(passing_class),
        .summary_i(summary_o), .flags_o(flags[LANES*FLAGS+:FLAGS]), .region_valid_o(region_valid),
        .score_valid_o(score_valid_o), .score_o(score_o), .displacement_o(displacement), .decision_valid_o(decision_valid_o),
        .srs_o(srs_o), .trs_o(trs_o), .active_o(active_o)
    );
    wire unused_region_valid = region_valid;

    generate
        if (FLOW) begin : g_displacement
            assign displacement_x_o = displacement[0+:COORDINATE_BITS];
            assign displacement_y_o = displacement[COORDINATE_BITS+:COORDINATE_BITS];
        end else begin : g_no_displacement
            wire unused_displacement = |displacement;
            assign displacement_x_o = {COORDINATE_BITS{1'b0}};
            assign displacement_y_o = {COORDINATE_BITS{1'b0}};
        end
    endgenerate

    generate
        if (SUMMARIES) begin : g_summary
            serial_summary #(
                .WIDTH(WIDTH), .MEANS(BLOCKS * BLOCKS), .BLOCK_BITS(BLOCK_BITS), .SUM_BITS(MEAN_SUM_BITS),
                .FACTOR_BITS(MEAN_FACTOR_BITS), .FACTOR(MEAN_FACTOR), .SHIFT(MEAN_SHIFT), .SLOTS(LANES * FOLD),
                .REGION_BITS(REGION_BITS), .ZONES(ZONES)
            ) u_summary (
                .clk_i(clk_i), .rst_i(rst_i), .frame_i(reopen), .next_region_i(next_shown[REGION_BITS-1:0]),
                .next_block_i(next_shown[REGION_BITS+:BLOCK_BITS]), .region_i(region_o), .block_i(shown_block),
                .average_i(shown_average), .sum_i(ring[MEAN_SUM_BITS-1:0]), .decided_i(decision_valid_o),
                .srs_i(srs_o), .active_i(active_o), .level_i(summary_level_i), .keen_level_i(keen_summary_level_i),
                .off_level_i(off_summary_level_i), .class_i(passing_class), .summary_o(summary_o), .mean_o(mean)
            );
            wire unused_next = |next_shown[SHOWN_BITS-1:REGION_BITS+BLOCK_BITS];
        end else begin : g_no_summary
            wire unused_summary = |summary_level_i || |keen_summary_level_i || |off_summary_level_i || |next_shown || shown_average || |shown_block;
            assign summary_o = 1'b0;
            assign mean = {WIDTH{1'b0}};
        end
        if (RASTER != 0) begin : g_forward
            assign forward_valid_o = shown_unload && (shown_return ? flags[FLAGS-1] : flags[0]);
            assign forward_pixel_o = shown_return ? mean : ring[WIDTH-1:0];
            wire unused_words = |words;
        end else begin : g_parallel_unused
            wire unused_shown = shown_unload || |pixels;
        end
    endgenerate

endmodule

`default_nettype wire
