// SPDX-License-Identifier: MIT OR Apache-2.0
// The sequencer of the serial array: for each step where the lanes work, on which word, and what they do. One step per clock,
// the same for all lanes.
//
// The outputs to the lanes are registered once before they reach a lane (serial_group). Controls for the word read, and for
// the operand, are registered again if these come later than the address.
`default_nettype none

module serial_sequencer #(
    parameter WIDTH = 8,            // bits of a pixel
    parameter SIDE = 8,             // pixels of a side of a region
    parameter RAW_SIDE = 8,         // side of the square that is loaded
    parameter DENOISED_SIDE = 8,    // side of the square that is denoised
    parameter FILTER = 1,           // 0: none; 1: `median3x3`; 2: `switching3x3`; 3: `binomial3x3`
    parameter CLAMPS = 1,           // 1: a window repeats the border of its square
    parameter COPIES = 0,           // not 0: the reference is copied after the last score; 0: it is overwritten pixel by pixel
    parameter RAW_PAYLOAD = 0,      // 1: raw pixels leave; 0: the pixels that are scored
    parameter RASTER = 0,           // 1: pixels leave through the chain of scores
    parameter LATE = 0,             // clocks from an address to the accumulator, 0 to 3
    parameter DEEP = 0,             // 1: a score is whole one clock after its last step
    parameter FOLD = 1,             // regions of a lane
    parameter LANES = 784,          // lanes of the array
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
    parameter LEAST_BITS = 2,       // `flow`: bits of a sum times its weight
    parameter COORDINATE_BITS = 2,  // `flow`: bits of dx and of dy
    parameter BLOCKS = 0,           // blocks of a region's side whose means are sent: 1, 2 or 4; 0: none
    parameter BLOCK_BITS = 1,       // bits of the number of a block, at least 1
    parameter FRACTION = 0,         // fraction bits of the mean of `mad` and `segment`
    parameter SUM_BITS = 14,        // bits of the sum of a region
    parameter COUNT_BITS = 7,       // bits of the number of pixels of a region
    parameter DENOISED_BASE = 64,   // address in a slot where the denoised square starts
    parameter REFERENCE_BASE = 64,  // address in a slot where the reference starts
    parameter WORD_BITS = 7,        // bits of an address inside a slot
    parameter SLOT_BITS = 1,        // bits of the number of a slot, at least 1
    parameter REGION_BITS = 10,     // bits of the number of a region, empty slots included
    parameter POSITION_BITS = 6,    // bits of the number of a pixel in the larger square of centers
    parameter INDEX_BITS = 1,       // bits of the number of a score
    parameter SCALE_BITS = 8,       // bits of the constant that is shifted from step to step
    parameter ACC_BITS = 11,        // bits of the accumulator
    parameter ZONES = 0             // 1: regions have classes
) (
    input  wire                     clk_i,             // clock, rising edge
    input  wire                     rst_i,             // synchronous reset, active high
    input  wire                     start_i,           // a frame is complete
    input  wire [        WIDTH-1:0] temporal_level_i,  // a pixel has changed above this difference
    input  wire [        WIDTH+1:0] edge_half_i,       // half the level of `edge`, rounded down
    input  wire [        WIDTH-1:0] corner_level_i,    // level of `corner`
    input  wire [        WIDTH-1:0] segment_level_i,   // level of `segment`
    input  wire [        WIDTH-1:0] keen_temporal_level_i,  // temporal_level_i of keen regions
    input  wire [        WIDTH+1:0] keen_edge_half_i,  // edge_half_i of keen regions
    input  wire [        WIDTH-1:0] keen_corner_level_i,  // corner_level_i of keen regions
    input  wire [        WIDTH-1:0] keen_segment_level_i,  // segment_level_i of keen regions
    output wire                     working_o,         // the address is that of a step
    output wire                     reopen_o,          // the frame is done
    // Outputs to the lanes.
    output wire [    SLOT_BITS-1:0] slot_o,            // number of the slot
    output wire [    WORD_BITS-1:0] address_o,         // the address inside the slot
    output wire                     write_o,           // the accumulator is written to this address
    output wire [     ACC_BITS-1:0] constant_o,        // the constant
    output wire [     ACC_BITS-1:0] keen_constant_o,   // the constant of keen regions (ZONES)
    output wire                     classing_o,        // classes move on by one lane (ZONES)
    output wire [             38:0] controls_o,        // the control word, see serial_controls
    // Outputs to the decision.
    output wire                     rotate_o,          // scores pass
    output wire                     average_o,         // sums of blocks pass
    output wire                     return_o,          // means leave
    output wire [   BLOCK_BITS-1:0] block_o,           // number of the block of that sum or mean
    output wire                     unload_o,          // the word read leaves if its region is active
    output wire [   INDEX_BITS-1:0] index_o,           // number of the score that passes
    output wire [  REGION_BITS-1:0] region_o,          // number of the region that passes
    output wire [POSITION_BITS-1:0] position_o         // position of the pixel that leaves
);

    // Limits: a value out of range stops elaboration at an instance of a module that does not exist.
    generate
        if (SIDE < 4 || SIDE > 64) begin : g_side SIDE_must_be_4_to_64 u_refused (); end
        if (FEATURES < 1 || FEATURES > 8) begin : g_features FEATURES_must_be_1_to_8 u_refused (); end
        if (LANES < 1) begin : g_lane_count LANES_must_be_1_or_more u_refused (); end
        if (FOLD < 1) begin : g_fold FOLD_must_be_1_or_more u_refused (); end
        if (LATE < 0 || LATE > 3) begin : g_late LATE_must_be_0_to_3 u_refused (); end
    endgenerate

    localparam EDGE = EDGE_INDEX != 0 ? 1 : 0;
    localparam CORNER = CORNER_INDEX != 0 ? 1 : 0;
    localparam MAD = MAD_INDEX != 0 ? 1 : 0;
    localparam VARIANCE = VARIANCE_INDEX != 0 ? 1 : 0;
    localparam RANGE = RANGE_INDEX != 0 ? 1 : 0;
    localparam SURFACE = SURFACE_INDEX != 0 ? 1 : 0;
    localparam SEGMENT = SEGMENT_INDEX != 0 ? 1 : 0;
    localparam FLOW = FLOW_INDEX != 0 ? 1 : 0;
    localparam BORDERS = FILTER != 0 && DENOISED_SIDE != SIDE;

    wire [50:0] step;
    wire [3:0] tap;
    wire [1:0] part;
    wire walks, block_ends, slot_ends, last_column, last_center, counts, squares;
    wire last_lane, first_score, last_score, last_block, last_slot;
    wire spent, divided, last_place, corrects, any_pairs, more_pairs;
    wire next_edge, next_corner, next_range, next_surface, next_flow, ranges, surfaces, segments, flows;

    // The displacement of `flow`.
    wire [2:0] stage;
    wire compared, right, down, last_displacement;
    wire [1:0] columns;
    wire [1:0] rows;
    wire [2*FLOW_FACTOR_BITS-1:0] weight;
    wire [2*COORDINATE_BITS-1:0] preceding;

    wire loading, draining, rotating, unloading, shifting;
    wire averaging, returning;
    wire [41:0] unused_step;
    wire [1:0] unused_last;
    assign {loading, draining, rotating, unloading, shifting, unused_step, averaging, returning, unused_last} = step;
    assign working_o = !loading && !draining;
    assign reopen_o = draining;
    assign rotate_o = rotating && !averaging && !returning;
    assign average_o = rotating && averaging;
    assign return_o = returning;
    assign unload_o = RASTER != 0 ? shifting : unloading;

    // The regions, slots and scores.
    serial_regions #(
        .FOLD(FOLD), .LANES(LANES), .FEATURES(FEATURES), .EDGE_INDEX(EDGE_INDEX),
        .CORNER_INDEX(CORNER_INDEX), .MAD_INDEX(MAD_INDEX), .VARIANCE_INDEX(VARIANCE_INDEX), .RANGE_INDEX(RANGE_INDEX),
        .SURFACE_INDEX(SURFACE_INDEX), .SEGMENT_INDEX(SEGMENT_INDEX), .FLOW_INDEX(FLOW_INDEX),
        .MEANS(BLOCKS * BLOCKS), .BLOCK_BITS(BLOCK_BITS), .SLOT_BITS(SLOT_BITS), .REGION_BITS(REGION_BITS),
        .INDEX_BITS(INDEX_BITS), .ZONES(ZONES)
    ) u_regions (
        .clk_i(clk_i), .loading_i(loading), .rotating_i(rotating), .shifting_i(shifting),
        .classing_i(classing_o), .averaging_i(averaging), .block_ends_i(block_ends), .slot_ends_i(slot_ends), .slot_o(slot_o),
        .last_slot_o(last_slot), .index_o(index_o), .first_score_o(first_score), .last_score_o(last_score),
        .block_o(block_o), .last_block_o(last_block), .next_edge_o(next_edge),
        .next_corner_o(next_corner), .next_range_o(next_range), .next_surface_o(next_surface), .next_flow_o(next_flow), .ranges_o(ranges), .squares_o(squares),
        .surfaces_o(surfaces), .segments_o(segments), .flows_o(flows), .region_o(region_o), .last_lane_o(last_lane)
    );

    // The steps.
    serial_states #(
        .FILTER(FILTER), .BORDERS(BORDERS), .COPIES(COPIES), .RASTER(RASTER), .LATE(LATE), .DEEP(DEEP),
        .EDGE(EDGE), .CORNER(CORNER), .MAD(MAD), .VARIANCE(VARIANCE), .RANGE(RANGE), .SURFACE(SURFACE), .SEGMENT(SEGMENT), .FLOW(FLOW),
        .FRACTION(FRACTION),
        .SUMMARIES(BLOCKS != 0 ? 1 : 0), .ZONES(ZONES)
    ) u_states (
        .clk_i(clk_i), .rst_i(rst_i), .start_i(start_i), .last_column_i(last_column),
        .last_center_i(last_center), .last_lane_i(last_lane), .first_score_i(first_score), .last_score_i(last_score),
        .last_block_i(last_block), .last_slot_i(last_slot), .next_edge_i(next_edge),
        .next_corner_i(next_corner), .next_range_i(next_range), .next_surface_i(next_surface), .next_flow_i(next_flow), .ranges_i(ranges),
        .squares_i(squares), .surfaces_i(surfaces), .segments_i(segments), .flows_i(flows), .last_displacement_i(last_displacement), .spent_i(spent),
        .divided_i(divided), .last_place_i(last_place), .corrects_i(corrects), .any_pairs_i(any_pairs),
        .more_pairs_i(more_pairs), .step_o(step), .tap_o(tap), .part_o(part), .walks_o(walks),
        .block_ends_o(block_ends), .slot_ends_o(slot_ends), .classing_o(classing_o), .stage_o(stage), .compared_o(compared)
    );

    generate
        if (FLOW) begin : g_flow
            serial_flow #(
                .RADIUS(FLOW_RADIUS), .FACTOR_BITS(FLOW_FACTOR_BITS), .FACTORS(FLOW_FACTORS), .COORDINATE_BITS(COORDINATE_BITS)
            ) u_flow (
                .clk_i(clk_i), .restart_i(rotating), .next_i(compared), .columns_o(columns), .rows_o(rows), .right_o(right),
                .down_o(down), .last_o(last_displacement), .weight_o(weight), .preceding_o(preceding)
            );
        end else begin : g_no_flow
            wire unused_flow = compared || |FLOW_FACTORS;
            assign columns = 2'd0;
            assign rows = 2'd0;
            assign right = 1'b0;
            assign down = 1'b0;
            assign last_displacement = 1'b0;
            assign weight = {2 * FLOW_FACTOR_BITS{1'b0}};
            assign preceding = {2 * COORDINATE_BITS{1'b0}};
        end
    endgenerate

    // The addresses.
    serial_addresses #(
        .SIDE(SIDE), .RAW_SIDE(RAW_SIDE), .DENOISED_SIDE(DENOISED_SIDE), .FILTER(FILTER), .CLAMPS(CLAMPS),
        .COPIES(COPIES), .FLOW(FLOW), .RAW_PAYLOAD(RAW_PAYLOAD), .BLOCKS(BLOCKS), .BLOCK_BITS(BLOCK_BITS), .DENOISED_BASE(DENOISED_BASE),
        .REFERENCE_BASE(REFERENCE_BASE), .WORD_BITS(WORD_BITS), .POSITION_BITS(POSITION_BITS)
    ) u_addresses (
        .clk_i(clk_i), .step_i(step), .tap_i(tap), .part_i(part), .walks_i(walks), .slot_ends_i(slot_ends),
        .last_lane_i(last_lane), .first_score_i(first_score), .last_score_i(last_score), .block_i(block_o),
        .last_block_i(last_block), .columns_i(columns), .rows_i(rows), .right_i(right), .down_i(down), .address_o(address_o), .write_o(write_o),
        .position_o(position_o), .last_column_o(last_column), .last_center_o(last_center), .counts_o(counts)
    );

    // The constants and the controls.
    serial_constant #(
        .WIDTH(WIDTH), .SIDE(SIDE), .FILTER(FILTER), .MAD(MAD), .VARIANCE(VARIANCE), .RANGE(RANGE), .SURFACE(SURFACE),
        .SEGMENT(SEGMENT), .FLOW(FLOW), .WEIGHT_BITS(2 * FLOW_FACTOR_BITS), .LEAST_BITS(LEAST_BITS),
        .DISPLACEMENT_BITS(2 * COORDINATE_BITS), .FRACTION(FRACTION),
        .BLOCK(BLOCKS != 0 ? (SIDE / (BLOCKS != 0 ? BLOCKS : 1)) * (SIDE / (BLOCKS != 0 ? BLOCKS : 1)) : 1),
        .SUM_BITS(SUM_BITS), .COUNT_BITS(COUNT_BITS), .SCALE_BITS(SCALE_BITS), .ACC_BITS(ACC_BITS)
    ) u_constant (
        .clk_i(clk_i), .step_i(step), .last_center_i(last_center), .ranges_i(ranges), .squares_i(squares),
        .surfaces_i(surfaces), .segments_i(segments), .flows_i(flows), .stage_i(stage), .weight_i(weight), .preceding_i(preceding),
        .temporal_level_i(temporal_level_i), .edge_half_i(edge_half_i),
        .corner_level_i(corner_level_i), .segment_level_i(segment_level_i),
        .keen_temporal_level_i(keen_temporal_level_i), .keen_edge_half_i(keen_edge_half_i),
        .keen_corner_level_i(keen_corner_level_i), .keen_segment_level_i(keen_segment_level_i),
        .constant_o(constant_o), .keen_constant_o(keen_constant_o), .spent_o(spent), .divided_o(divided), .last_place_o(last_place),
        .corrects_o(corrects), .any_pairs_o(any_pairs), .more_pairs_o(more_pairs)
    );

    serial_controls #(
        .FILTER(FILTER), .COPIES(COPIES), .RASTER(RASTER),
        .KEEPS(MAD || VARIANCE || RANGE || SURFACE || SEGMENT || FLOW || BLOCKS != 0 ? 1 : 0)
    ) u_controls (
        .step_i(step), .tap_i(tap), .part_i(part), .counts_i(counts), .spent_i(spent), .controls_o(controls_o)
    );

endmodule

`default_nettype wire
