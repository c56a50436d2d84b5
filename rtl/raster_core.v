// SPDX-License-Identifier: MIT OR Apache-2.0
// The whole core of organization `raster`. A frame comes row by row, LANES pixels per clock; decisions, the pixels of active
// regions, and the means of irrelevant ones leave. docs/raster.md defines each output at each clock.
//
//     raster_pad -> raster_window -> median_columns -> raster_window -> raster_edge -> raster_counts -> raster_decision
//                                                     center `-> raster_change, with the references of raster_store
//                                                            `-> raster_forward: a buffer, and raster_readout
`default_nettype none

(* keep_hierarchy = "yes" *)
module raster_core #(
    // Frame and regions
    parameter WIDTH = 8,             // bits of a pixel
    parameter LANES = 1,             // pixels of a word
    parameter SIDE = 8,              // rows of a region
    parameter COLUMNS = 240,         // regions in a row of regions
    parameter ROWS = 135,            // rows of regions
    parameter FRAME_WIDTH = 1920,    // pixels of a row of the frame
    parameter FRAME_HEIGHT = 1080,   // rows of the frame
    parameter ISOLATED = 0,          // 1: windows end at the borders of regions; 0: at those of the frame
    parameter POSITION_BITS = 6,     // ceil(log2(SIDE * SIDE))
    parameter REGION_BITS = 15,      // ceil(log2(COLUMNS * ROWS))
    parameter COUNT_BITS = 7,        // bits of a count, 0..SIDE * SIDE
    // Filter, features and decision
    parameter FILTER = 1,            // pixels are denoised by 0: nothing; 1: the median; 2: the switching median; 3: the binomial mean
    parameter EDGE = 1,              // 1: regions have the score of `edge`
    parameter CORNER = 0,            // 1: regions have the score of `corner`
    parameter VARIANCE = 0,          // 1: regions have the score of `variance`
    parameter RANGE = 0,             // 1: regions have the score of `range`
    parameter SURFACE = 0,           // 1: regions have the score of `surface`
    parameter MAD = 0,               // 1: regions have the score of `mad`
    parameter SEGMENT = 0,           // 1: regions have the score of `segment`
    parameter ALL = 0,               // 1: every feature must vote; 0: one vote is enough
    parameter SCORE_BITS = 14,       // bits of all scores of a region: temporal count lowest, then edge, corner, variance, range, surface, mad, segment
    // Widths of the features
    parameter EDGE_LEVEL_BITS = 11,  // bits of the level of `edge`
    parameter SUM_BITS = 14,         // bits of a sum over a region of pixels or their differences (VARIANCE, SURFACE, MAD, SEGMENT)
    parameter VARIANCE_BITS = 1,     // bits of the score of `variance`
    parameter SQUARE_SUM_BITS = 22,  // bits of the sum of squares (VARIANCE)
    parameter PRODUCT_BITS = 28,     // bits of the products of the variance (VARIANCE)
    parameter MAD_BITS = 1,          // bits of the score of `mad`
    parameter SEGMENT_BITS = 1,      // bits of the score of `segment`
    parameter FRACTION = 0,          // fraction bits of the mean (MAD, SEGMENT)
    parameter DIVIDEND_BITS = 14,    // bits of 2^FRACTION * sum plus half of the pixels (MAD, SEGMENT)
    parameter MEAN_BITS = 8,         // bits of the mean (MAD, SEGMENT)
    parameter FACTOR_BITS = 1,       // bits of FACTOR (MAD, SEGMENT)
    parameter [FACTOR_BITS-1:0] FACTOR = 1,  // (dividend * FACTOR) >> SHIFT divides by the pixels of a region (MAD, SEGMENT)
    parameter SHIFT = 6,             // bits of the product that are dropped (MAD, SEGMENT)
    // Zones
    parameter ZONES = 0,             // 1: regions have classes
    parameter CLASS_ADDRESS_BITS = 1,  // bits of the number of a word of the map of classes (ZONES)
    parameter [2*COLUMNS*ROWS-1:0] CLASSES = 0,  // the first map, region 0 in the lowest bits (ZONES)
    // Reference and its store
    parameter LAST_SENT = 0,         // 1: the reference is what was last sent; 0: the previous frame
    parameter BLANKS = 0,            // 1: a region without SRS loses its reference (LAST_SENT)
    parameter STORE = 0,             // the references are in 0: block RAM; 1: UltraRAM; 2: RAM of one port; 3: memory outside the core
    // Pixels and means that leave
    parameter FORWARD = 1,           // 1: pixels of active regions leave; 0: only decisions do
    parameter RAW = 0,               // 1: raw pixels leave; 0: denoised ones
    parameter FRAME_BITS = 8,        // bits of the number of a frame, at least 2 (FORWARD)
    parameter BLOCKS = 0,            // regions without SRS send the means of BLOCKS * BLOCKS blocks; 0: they send nothing
    parameter BLOCK_SUM_BITS = 12,   // bits of the sum of a block plus half of its pixels (BLOCKS)
    parameter BLOCK_FACTOR_BITS = 1, // bits of BLOCK_FACTOR (BLOCKS)
    parameter [BLOCK_FACTOR_BITS-1:0] BLOCK_FACTOR = 1,  // (sum * BLOCK_FACTOR) >> BLOCK_SHIFT divides by the pixels of a block
    parameter BLOCK_SHIFT = 4,       // bits of the product that are dropped (BLOCKS)
    // Timing
    parameter DEEP = 0,              // 1: more registers, for a faster clock
    parameter SETTLE = 11            // clocks from the last advance of a frame to its last decision
) (
    // Clock and frame
    input  wire                       clk_i,               // clock, rising edge
    input  wire                       rst_i,               // synchronous reset, active high
    input  wire                       valid_i,             // a word is offered, and is taken with ready_o
    input  wire [    LANES*WIDTH-1:0] pixel_i,             // the word that comes in, its left pixel in the lowest bits
    output wire                       ready_o,             // the offered word is taken
    // Thresholds
    input  wire [EDGE_LEVEL_BITS-1:0] edge_level_i,        // a gradient above this level is a hit of `edge`
    input  wire [          WIDTH-1:0] corner_level_i,      // a neighbor differs from its center above this level (`corner`)
    input  wire [          WIDTH-1:0] segment_level_i,     // a pixel differs from the mean of its region above this level (`segment`)
    input  wire [          WIDTH-1:0] temporal_level_i,    // a pixel has changed above this difference
    input  wire [          WIDTH-1:0] summary_level_i,     // a mean that differs by more than this level is sent again (BLOCKS)
    input  wire [     SCORE_BITS-1:0] minima_i,            // smallest value at which each score votes; the lowest bits belong to TRS
    // Classes (ZONES), and the thresholds of keen regions and of those that are off
    input  wire                       zone_write_i,        // a word of the map of classes is written
    input  wire [CLASS_ADDRESS_BITS-1:0] zone_address_i,   // number of that word
    input  wire [               31:0] zone_word_i,         // the word: 16 classes, the first one in the lowest bits
    input  wire                       zone_commit_i,       // frames use the map that has been written
    output wire                       zone_pending_o,      // the committed map is not in use yet
    input  wire [EDGE_LEVEL_BITS-1:0] keen_edge_level_i,   // edge_level_i of keen regions
    input  wire [          WIDTH-1:0] keen_corner_level_i, // corner_level_i of keen regions
    input  wire [          WIDTH-1:0] keen_segment_level_i,  // segment_level_i of keen regions
    input  wire [          WIDTH-1:0] keen_temporal_level_i, // temporal_level_i of keen regions
    input  wire [          WIDTH-1:0] keen_summary_level_i,  // summary_level_i of keen regions
    input  wire [          WIDTH-1:0] off_summary_level_i, // summary_level_i of regions that are off
    input  wire [     SCORE_BITS-1:0] keen_minima_i,       // minima_i of keen regions
    // Decisions
    output wire                       decision_valid_o,    // the decision for region_o is on the ports
    output wire [    REGION_BITS-1:0] region_o,            // the region that is decided
    output wire                       srs_o,               // SRS, the spatial relevance of the region
    output wire                       trs_o,               // TRS, the temporal relevance of the region
    output wire                       active_o,            // SRS and TRS are both 1
    output wire                       summary_o,           // the means of region_o are sent (BLOCKS)
    output wire [     SCORE_BITS-1:0] scores_o,            // scores of region_o
    // Frame store outside the core (STORE 3)
    output wire                       reference_ready_o,   // the reference on the port is taken at the next edge (STORE 3)
    input  wire                       reference_valid_i,   // a reference is on the port
    input  wire [    LANES*WIDTH-1:0] reference_pixel_i,   // the reference on the port
    output wire                       store_valid_o,       // a word is to be stored (STORE 3)
    output wire [    LANES*WIDTH-1:0] store_pixel_o,       // the word to be stored
    output wire                       store_last_o,        // the word to be stored is the last of a row
    output wire                       underrun_o,          // a reference was missing at least once since reset (STORE 3)
    // Pixels and means that leave (FORWARD)
    input  wire                       forward_ready_i,     // the word on the forward ports is taken
    output wire                       forward_valid_o,     // a word is on the forward ports
    output wire [    REGION_BITS-1:0] forward_region_o,    // number of the region of the forwarded word
    output wire [  POSITION_BITS-1:0] forward_position_o,  // position in its region of the first pixel of the word
    output wire [    LANES*WIDTH-1:0] forward_pixel_o,     // the forwarded word
    output wire                       forward_first_o,     // the forwarded word is the first of its region
    output wire                       forward_last_o,      // the forwarded word is the last that comes of its region
    output wire                       forward_abort_o,     // the forwarded word is the last because its region was lost in the middle
    output wire [     FRAME_BITS-1:0] forward_frame_o,     // number since reset of the frame of the forwarded region
    output wire                       forward_summary_o,   // the forwarded word is the mean of a block (BLOCKS)
    // Lost regions (FORWARD)
    output wire                       lost_o,              // at least one region was lost since reset
    output wire [               15:0] lost_count_o,        // number of lost regions, up to the largest number of this width
    output wire                       lost_valid_o,        // a region was lost at the last edge
    output wire [    REGION_BITS-1:0] lost_region_o,       // number of the lost region
    output wire [     FRAME_BITS-1:0] lost_frame_o         // number since reset of the frame of the lost region
);

    // Limits: a value out of range stops elaboration at an instance of a module that does not exist.
    generate
        if (LANES != 1 && LANES != 2 && LANES != 4) begin : g_lanes LANES_must_be_1_2_or_4 u_refused (); end
        if (SIDE % LANES != 0) begin : g_side SIDE_must_be_a_multiple_of_LANES u_refused (); end
        if (COLUMNS < 4) begin : g_columns COLUMNS_must_be_4_or_more u_refused (); end
        if (COLUMNS * SIDE < 16 * LANES) begin : g_row a_row_must_have_16_words_or_more u_refused (); end
        if (WIDTH < 1 || WIDTH > 16) begin : g_pixel WIDTH_must_be_1_to_16 u_refused (); end
        if (SIDE < 2 || SIDE > 64) begin : g_region SIDE_must_be_2_to_64 u_refused (); end
        if (FRAME_WIDTH > 8192) begin : g_widest FRAME_WIDTH_must_be_8192_or_less u_refused (); end
        if (FRAME_HEIGHT > 16384) begin : g_highest FRAME_HEIGHT_must_be_16384_or_less u_refused (); end
        if (FRAME_WIDTH > COLUMNS * SIDE || FRAME_WIDTH + SIDE <= COLUMNS * SIDE) begin : g_width
            FRAME_WIDTH_must_need_COLUMNS u_refused ();
        end
        if (FRAME_HEIGHT > ROWS * SIDE || FRAME_HEIGHT + SIDE <= ROWS * SIDE) begin : g_height
            FRAME_HEIGHT_must_need_ROWS u_refused ();
        end
        if (COUNT_BITS != $clog2(SIDE * SIDE + 1)) begin : g_count_bits COUNT_BITS_must_hold_SIDE_squared u_refused (); end
        if (POSITION_BITS != $clog2(SIDE * SIDE)) begin : g_position_bits
            POSITION_BITS_must_be_clog2_of_SIDE_squared u_refused ();
        end
        if (REGION_BITS != $clog2(COLUMNS * ROWS)) begin : g_region_bits
            REGION_BITS_must_be_clog2_of_the_regions u_refused ();
        end
        if (LAST_SENT && !FORWARD) begin : g_forward_limit FORWARD_must_be_1_with_LAST_SENT u_refused (); end
        if (LAST_SENT && STORE > 1) begin : g_store_limit STORE_must_have_two_ports_with_LAST_SENT u_refused (); end
        if (BLOCKS > 0 && !FORWARD) begin : g_forward_means FORWARD_must_be_1_with_BLOCKS u_refused (); end
        if (FILTER < 0 || FILTER > 3) begin : g_filter_kind FILTER_must_be_0_to_3 u_refused (); end
        if (STORE < 0 || STORE > 3) begin : g_store_kind STORE_must_be_0_to_3 u_refused (); end
        if ((EDGE | CORNER | VARIANCE | RANGE | SURFACE | MAD | SEGMENT) != 1) begin : g_features
            flags_of_features_must_be_0_or_1_and_one_of_them_1 u_refused ();
        end
    endgenerate

    localparam WORD = LANES * WIDTH;
    localparam SEGMENT_WORDS = SIDE / LANES;
    localparam ROW_WORDS = COLUMNS * SEGMENT_WORDS;
    localparam TAKEN_WORDS = (FRAME_WIDTH + LANES - 1) / LANES;
    localparam REGIONS = COLUMNS * ROWS;
    localparam WORD_BITS = $clog2(ROW_WORDS);
    localparam HITS = EDGE + CORNER;  // features that count hits of a window
    localparam COUNTS_BITS = (HITS + 1) * COUNT_BITS;
    // Scores are in the order in which they are known, in raster_decision, too: counts, those made of the sums or extremes of a
    // region, and those that need a second pass.
    localparam RANGE_START = COUNTS_BITS + VARIANCE * VARIANCE_BITS;
    localparam SURFACE_START = RANGE_START + RANGE * WIDTH;
    localparam SETTLED_BITS = SURFACE_START + SURFACE * SUM_BITS;  // bits of all scores except those of the second pass
    localparam SEGMENT_START = SETTLED_BITS + MAD * MAD_BITS;
    localparam SECOND_PASS = MAD | SEGMENT;
    localparam VALUE_BITS = WIDTH + $clog2(LANES);  // bits of a sum over a word
    localparam FEATURE_WINDOW = EDGE | CORNER | SURFACE;
    localparam DENOISES = FILTER > 0 ? 1 : 0;
    localparam WINDOWS = DENOISES + FEATURE_WINDOW;
    localparam SETTLED_CLOCKS = VARIANCE ? 3 : SURFACE ? 2 : RANGE ? 1 : 0;  // from the counts to the last of the other scores: v in docs/raster.md
    // The way of a region to the readout may take longer than a short row; a third row of regions in the buffer covers that.
    localparam READOUT_CLOCKS = SETTLED_CLOCKS + (DEEP ? 10 : 7);
    localparam SHORT_ROW = ROW_WORDS - SEGMENT_WORDS < READOUT_CLOCKS ? 1 : 0;
    localparam BANKS = SECOND_PASS || SHORT_ROW ? 3 : 2;
    localparam BUFFER_WORDS = BANKS * SIDE * ROW_WORDS;
    localparam START_BITS = $clog2(BUFFER_WORDS);
    localparam FRAME_WORDS = ROW_WORDS * ROWS * SIDE;
    localparam PLACE_BITS = $clog2(FRAME_WORDS);
    localparam EXTERNAL = 3;
    localparam SWITCHING = 2;
    localparam BINOMIAL = 3;
    localparam REGION_COLUMN_BITS = $clog2(COLUMNS);
    localparam NUMBER_BITS = BLOCKS > 1 ? $clog2(BLOCKS * BLOCKS) : 1;  // bits of the number of a block

    // Clocks from one place in the pipeline to another; see docs/raster.md.
    localparam COLUMN_CLOCKS = DEEP ? 3 : 1;                           // from a word to its column of the window
    localparam FILTER_CLOCKS = DENOISES ? COLUMN_CLOCKS + (DEEP ? 6 : 3) : 0;
    localparam CENTER_CLOCKS = FILTER_CLOCKS + (FEATURE_WINDOW ? COLUMN_CLOCKS : 0);  // from a word to the center of the last window
    localparam STORE_CLOCKS = 2 + DEEP;                                // from center_word to `center`, which is stored
    localparam HIT_CLOCKS = 4 + DEEP;                                  // from center_word to its hits

    // With DEEP a large store is made of groups of banks. References come in order, so a reference can be requested early
    // enough to pass the groups: at the earliest at the advance with which its word reaches the tail.
    localparam BANK_BITS = 14;
    localparam STORE_BANKS = (FRAME_WORDS + (1 << BANK_BITS) - 1) >> BANK_BITS;
    localparam IN_GROUPS = DEEP && STORE == 0 && !LAST_SENT && STORE_BANKS > 1 && CENTER_CLOCKS > 2;
    localparam MOST_GROUPS = IN_GROUPS ? CENTER_CLOCKS - 2 : 1;
    localparam LEAST_GROUP_BITS = $clog2((STORE_BANKS + MOST_GROUPS - 1) / MOST_GROUPS);
    localparam GROUP_BITS = LEAST_GROUP_BITS > 1 ? LEAST_GROUP_BITS : 1;
    localparam GROUPS = IN_GROUPS ? (STORE_BANKS + (1 << GROUP_BITS) - 1) >> GROUP_BITS : 0;

    // ---- Advances and the place in the frame
    wire advance, pad, taken_end, repeated, in_tail;
    wire advance_segment_end, advance_row_end, advance_region_top, advance_region_bottom;
    wire [1:0] advance_left, advance_right, advance_top, advance_bottom;
    wire busy, frame_ends, frame_over;

    raster_control #(
        .ROW_WORDS(ROW_WORDS), .TAKEN_WORDS(TAKEN_WORDS), .ROWS(ROWS * SIDE), .TAKEN_ROWS(FRAME_HEIGHT),
        .WORD_BITS(WORD_BITS), .ROW_BITS($clog2(ROWS * SIDE)), .SIDE(SIDE), .SIDE_BITS($clog2(SIDE)),
        .SEGMENT_WORDS(SEGMENT_WORDS), .SEGMENT_BITS(SEGMENT_WORDS > 1 ? $clog2(SEGMENT_WORDS) : 1), .ISOLATED(ISOLATED), .WINDOWS(WINDOWS),
        .SETTLE(SETTLE), .SETTLE_BITS($clog2(SETTLE))
    ) u_control (
        .clk_i(clk_i), .rst_i(rst_i), .valid_i(valid_i), .busy_i(busy), .ready_o(ready_o),
        .step_o(advance), .pad_o(pad), .taken_end_o(taken_end), .repeat_o(repeated),
        .left_o(advance_left), .right_o(advance_right), .top_o(advance_top), .bottom_o(advance_bottom),
        .tail_o(in_tail), .segment_end_o(advance_segment_end), .row_end_o(advance_row_end),
        .region_top_o(advance_region_top), .region_bottom_o(advance_region_bottom),
        .frame_ends_o(frame_ends), .frame_over_o(frame_over)
    );

    wire [WORD-1:0] made;
    raster_pad #(
        .WIDTH(WIDTH), .LANES(LANES), .REST(FRAME_WIDTH % LANES), .PADS(TAKEN_WORDS != ROW_WORDS)
    ) u_pad (
        .clk_i(clk_i), .step_i(advance), .pad_i(pad), .end_i(taken_end), .word_i(pixel_i), .word_o(made)
    );

    // ---- The words of the frame, one clock later with DEEP
    wire step, tail, segment_end, row_end, region_top, region_bottom, row_repeated;
    wire [1:0] left, right, top, bottom;
    wire [WORD-1:0] word;

    bit_delay #(.DEPTH(DEEP)) u_step (.clk_i(clk_i), .rst_i(rst_i), .bit_i(advance), .bit_o(step));
    bit_delay #(.DEPTH(DEEP)) u_in_tail (.clk_i(clk_i), .rst_i(rst_i), .bit_i(in_tail), .bit_o(tail));
    word_delay #(.WIDTH(WORD + 13), .DEPTH(DEEP)) u_word (
        .clk_i(clk_i),
        .data_i({made, advance_left, advance_right, advance_top, advance_bottom, repeated,
                 advance_segment_end, advance_row_end, advance_region_top, advance_region_bottom}),
        .data_o({word, left, right, top, bottom, row_repeated, segment_end, row_end, region_top, region_bottom})
    );

    // ---- The classes of regions, and the levels that follow from them
    localparam [1:0] OFF = 2'd1;
    localparam [1:0] KEEN = 2'd2;
    wire [1:0] corner_class, edge_class, change_class, summary_class, settled_class, judged_class;
    wire [EDGE_LEVEL_BITS-1:0] edge_level = edge_class == KEEN ? keen_edge_level_i : edge_level_i;
    wire [WIDTH-1:0] corner_level = corner_class == KEEN ? keen_corner_level_i : corner_level_i;
    wire [WIDTH-1:0] temporal_level = change_class == KEEN ? keen_temporal_level_i : temporal_level_i;
    wire [WIDTH-1:0] summary_level = summary_class == KEEN ? keen_summary_level_i
        : summary_class == OFF ? off_summary_level_i : summary_level_i;
    generate
        if (ZONES) begin : g_zones
            raster_classes #(
                .COLUMNS(COLUMNS), .ROWS(ROWS), .REGION_BITS(REGION_BITS), .ADDRESS_BITS(CLASS_ADDRESS_BITS),
                .CLASSES(CLASSES), .CENTER_CLOCKS(CENTER_CLOCKS), .STORE_CLOCKS(STORE_CLOCKS), .HIT_CLOCKS(HIT_CLOCKS),
                .SETTLED_CLOCKS(SETTLED_CLOCKS), .DEEP(DEEP)
            ) u_classes (
                .clk_i(clk_i), .rst_i(rst_i), .write_i(zone_write_i), .address_i(zone_address_i), .word_i(zone_word_i),
                .commit_i(zone_commit_i), .pending_o(zone_pending_o), .advance_i(advance), .frame_ends_i(frame_ends),
                .step_i(tail), .segment_end_i(segment_end), .row_end_i(row_end), .region_bottom_i(region_bottom),
                .corner_class_o(corner_class), .edge_class_o(edge_class), .change_class_o(change_class),
                .summary_class_o(summary_class), .settled_class_o(settled_class)
            );
        end else begin : g_no_zones
            wire unused_zones = zone_write_i || |zone_address_i || |zone_word_i || zone_commit_i || frame_ends
                || |keen_segment_level_i || |keen_minima_i || |CLASSES;
            assign zone_pending_o = 1'b0;
            assign {corner_class, edge_class, change_class, summary_class, settled_class} = 10'd0;
        end
    endgenerate

    // ---- Denoising
    wire scored_step;              // a word enters the last window
    wire [WORD-1:0] scored_word;
    wire [WORD-1:0] scored_raw;    // that word before the filter (RAW)
    wire scored_repeated;
    generate
        if (DENOISES) begin : g_filter
            wire column_step;
            wire [WORD-1:0] upper, middle, lower;
            wire column_top, column_bottom, column_left, column_right;

            raster_window #(
                .WORD_BITS(WORD), .ROW_WORDS(ROW_WORDS), .ADDRESS_BITS(WORD_BITS),
                .REPEATS(ROWS * SIDE != FRAME_HEIGHT), .DEEP(DEEP)
            ) u_raw_window (
                .clk_i(clk_i), .rst_i(rst_i), .step_i(step), .word_i(word), .top_i(top[0]), .bottom_i(bottom[0]),
                .repeat_i(row_repeated), .step_o(column_step), .top_o(column_top), .bottom_o(column_bottom),
                .upper_o(upper), .middle_o(middle), .lower_o(lower)
            );
            word_delay #(.WIDTH(2), .DEPTH(COLUMN_CLOCKS)) u_sides (
                .clk_i(clk_i), .data_i({left[0], right[0]}), .data_o({column_left, column_right})
            );
            if (FILTER == BINOMIAL) begin : g_binomial
                binomial_columns #(.WIDTH(WIDTH), .LANES(LANES), .DEEP(DEEP)) u_binomial (
                    .clk_i(clk_i), .step_i(column_step), .left_i(column_left), .right_i(column_right), .top_i(column_top),
                    .bottom_i(column_bottom), .upper_i(upper), .middle_i(middle), .lower_i(lower), .mean_o(scored_word)
                );
            end else begin : g_median
                median_columns #(
                    .WIDTH(WIDTH), .LANES(LANES), .SWITCHING(FILTER == SWITCHING ? 1 : 0), .DEEP(DEEP)
                ) u_median (
                    .clk_i(clk_i), .step_i(column_step), .left_i(column_left), .right_i(column_right), .top_i(column_top),
                    .bottom_i(column_bottom), .upper_i(upper), .middle_i(middle), .lower_i(lower), .median_o(scored_word)
                );
            end
            bit_delay #(.DEPTH(FILTER_CLOCKS)) u_scored_step (
                .clk_i(clk_i), .rst_i(rst_i), .bit_i(step), .bit_o(scored_step)
            );
            assign scored_repeated = 1'b0;
            if (RAW) begin : g_raw
                reg [WORD-1:0] raw_q;
                always @(posedge clk_i) if (column_step) raw_q <= middle;
                // In the step that makes a word the center, its column is in raw_q one clock later.
                word_delay #(.WIDTH(WORD), .DEPTH(FILTER_CLOCKS - COLUMN_CLOCKS)) u_raw (
                    .clk_i(clk_i), .data_i(raw_q), .data_o(scored_raw)
                );
            end else begin : g_denoised
                assign scored_raw = scored_word;
            end
        end else begin : g_none
            assign scored_step = step;
            assign scored_raw = scored_word;
            if (!FEATURE_WINDOW && ROWS * SIDE != FRAME_HEIGHT) begin : g_repeat
                raster_repeat #(.WORD_BITS(WORD), .ROW_WORDS(ROW_WORDS), .ADDRESS_BITS(WORD_BITS)) u_repeat (
                    .clk_i(clk_i), .rst_i(rst_i), .step_i(step), .repeat_i(row_repeated), .word_i(word),
                    .word_o(scored_word)
                );
            end else begin : g_word
                assign scored_word = word;
            end
            assign scored_repeated = row_repeated;
        end
    endgenerate

    // ---- The windows of the features
    wire [(HITS+1)*LANES-1:0] hits;  // the changed pixels lowest, then the hits of every feature that counts
    wire [WORD-1:0] center_word;     // the center of the last window
    wire [4*VALUE_BITS-1:0] differences;  // sums over a word of differences of neighbors (SURFACE)
    wire unused_levels = |edge_level || |corner_level;
    generate
        if (FEATURE_WINDOW) begin : g_window
            wire column_step;
            wire [WORD-1:0] upper, middle, lower;
            wire scored_top, scored_bottom, column_top, column_bottom, column_left, column_right;
            reg [WORD-1:0] center_q;

            always @(posedge clk_i) if (column_step) center_q <= middle;
            assign center_word = center_q;

            word_delay #(.WIDTH(2), .DEPTH(FILTER_CLOCKS)) u_ends (
                .clk_i(clk_i), .data_i({top[DENOISES], bottom[DENOISES]}), .data_o({scored_top, scored_bottom})
            );
            word_delay #(.WIDTH(2), .DEPTH(CENTER_CLOCKS)) u_sides (
                .clk_i(clk_i), .data_i({left[DENOISES], right[DENOISES]}), .data_o({column_left, column_right})
            );
            raster_window #(
                .WORD_BITS(WORD), .ROW_WORDS(ROW_WORDS), .ADDRESS_BITS(WORD_BITS),
                .REPEATS(!DENOISES && ROWS * SIDE != FRAME_HEIGHT), .DEEP(DEEP)
            ) u_window (
                .clk_i(clk_i), .rst_i(rst_i), .step_i(scored_step), .word_i(scored_word), .top_i(scored_top),
                .bottom_i(scored_bottom), .repeat_i(scored_repeated), .step_o(column_step), .top_o(column_top),
                .bottom_o(column_bottom), .upper_o(upper), .middle_o(middle), .lower_o(lower)
            );

            if (EDGE) begin : g_edge
                raster_edge #(.WIDTH(WIDTH), .LANES(LANES), .LEVEL_BITS(EDGE_LEVEL_BITS), .DEEP(DEEP)) u_edge (
                    .clk_i(clk_i), .step_i(column_step), .left_i(column_left), .right_i(column_right),
                    .top_i(column_top), .bottom_i(column_bottom), .upper_i(upper), .middle_i(middle), .lower_i(lower),
                    .level_i(edge_level), .hit_o(hits[LANES+:LANES])
                );
            end
            if (CORNER) begin : g_corner
                raster_corner #(.WIDTH(WIDTH), .LANES(LANES), .DEEP(DEEP)) u_corner (
                    .clk_i(clk_i), .step_i(column_step), .left_i(column_left), .right_i(column_right),
                    .top_i(column_top), .bottom_i(column_bottom), .upper_i(upper), .middle_i(middle), .lower_i(lower),
                    .level_i(corner_level), .hit_o(hits[(EDGE+1)*LANES+:LANES])
                );
            end
            if (SURFACE) begin : g_displacement
                raster_displacement #(.WIDTH(WIDTH), .LANES(LANES), .VALUE_BITS(VALUE_BITS), .DEEP(DEEP)) u_displacement (
                    .clk_i(clk_i), .step_i(column_step), .left_i(column_left), .right_i(column_right),
                    .bottom_i(column_bottom), .middle_i(middle), .lower_i(lower), .values_o(differences)
                );
                if (HITS == 0) begin : g_no_hits
                    wire unused_top = column_top || |upper;
                end
            end else begin : g_no_displacement
                assign differences = {4 * VALUE_BITS{1'b0}};
            end
        end else begin : g_no_window
            wire unused_window = scored_step || scored_repeated || |top || |bottom || |left || |right;
            assign center_word = scored_word;
            assign differences = {4 * VALUE_BITS{1'b0}};
        end
    endgenerate

    // ---- The center of the last window, its place in the frame, and its reference
    wire [WORD-1:0] center;  // center_word, STORE_CLOCKS later: the word of store_step
    wire center_step, store_step, arriving_step, hit_step;

    word_delay #(.WIDTH(WORD), .DEPTH(STORE_CLOCKS)) u_center (.clk_i(clk_i), .data_i(center_word), .data_o(center));
    bit_delay #(.DEPTH(CENTER_CLOCKS)) u_center_step (
        .clk_i(clk_i), .rst_i(rst_i), .bit_i(tail), .bit_o(center_step)
    );
    bit_delay #(.DEPTH(STORE_CLOCKS - 1)) u_arriving_step (
        .clk_i(clk_i), .rst_i(rst_i), .bit_i(center_step), .bit_o(arriving_step)
    );
    bit_delay #(.DEPTH(1)) u_store_step (
        .clk_i(clk_i), .rst_i(rst_i), .bit_i(arriving_step), .bit_o(store_step)
    );
    bit_delay #(.DEPTH(HIT_CLOCKS - STORE_CLOCKS)) u_hit_step (
        .clk_i(clk_i), .rst_i(rst_i), .bit_i(store_step), .bit_o(hit_step)
    );

    wire hit_segment_end, hit_row_end, hit_region_top, hit_region_bottom;
    word_delay #(.WIDTH(4), .DEPTH(CENTER_CLOCKS + HIT_CLOCKS)) u_places (
        .clk_i(clk_i), .data_i({segment_end, row_end, region_top, region_bottom}),
        .data_o({hit_segment_end, hit_row_end, hit_region_top, hit_region_bottom})
    );

    reg first_frame_q;
    wire [WORD-1:0] reference;
    wire [LANES-1:0] changes;
    wire reference_write;  // a word that was sent becomes a reference (LAST_SENT)
    wire [WORD-1:0] reference_word;
    wire [PLACE_BITS-1:0] reference_place;

    wire reference_read;
    bit_delay #(.DEPTH(IN_GROUPS ? CENTER_CLOCKS - 2 - GROUPS : 1)) u_reference_read (
        .clk_i(clk_i), .rst_i(rst_i), .bit_i(IN_GROUPS ? in_tail : center_step), .bit_o(reference_read)
    );
    generate
        if (STORE == EXTERNAL) begin : g_external
            wire stored_row_end;
            wire unused_reference = reference_write || |reference_word || |reference_place;
            word_delay #(.WIDTH(1), .DEPTH(CENTER_CLOCKS + STORE_CLOCKS)) u_stored_row_end (
                .clk_i(clk_i), .data_i(row_end), .data_o(stored_row_end)
            );
            raster_external #(.WORD_BITS(WORD), .DEEP(DEEP)) u_external (
                .clk_i(clk_i), .rst_i(rst_i), .first_frame_i(first_frame_q), .read_i(reference_read),
                .reference_o(reference), .write_i(store_step), .word_i(center), .row_end_i(stored_row_end),
                .reference_ready_o(reference_ready_o), .reference_valid_i(reference_valid_i),
                .reference_pixel_i(reference_pixel_i), .store_valid_o(store_valid_o), .store_pixel_o(store_pixel_o),
                .store_last_o(store_last_o), .underrun_o(underrun_o)
            );
        end else begin : g_inside
            wire unused_outside = reference_valid_i || |reference_pixel_i;
            assign {reference_ready_o, store_valid_o, store_last_o, underrun_o} = 4'd0;
            assign store_pixel_o = {WORD{1'b0}};
            raster_store #(
                .WORD_BITS(WORD), .WORDS(FRAME_WORDS), .ADDRESS_BITS(PLACE_BITS), .KIND(STORE), .RANDOM(LAST_SENT),
                .DEEP(DEEP), .BANK_BITS(BANK_BITS), .GROUP_BITS(GROUP_BITS), .GROUPS(GROUPS)
            ) u_store (
                .clk_i(clk_i), .rst_i(rst_i), .read_i(reference_read), .reference_o(reference),
                .write_i(LAST_SENT ? reference_write : store_step), .place_i(reference_place),
                .word_i(LAST_SENT ? reference_word : center)
            );
        end
    endgenerate
    raster_change #(.WIDTH(WIDTH), .LANES(LANES), .DEEP(DEEP)) u_change (
        .clk_i(clk_i), .word_i(center), .reference_i(reference), .level_i(temporal_level), .hit_o(changes)
    );

    // ---- Scores of a region whose last word has come
    assign hits[LANES-1:0] = LAST_SENT ? changes : changes | {LANES{first_frame_q}};
    wire done;
    wire [COUNTS_BITS-1:0] counts;

    always @(posedge clk_i) begin
        if (rst_i) first_frame_q <= 1'b1;
        else if (frame_over) first_frame_q <= 1'b0;
    end

    raster_counts #(
        .LANES(LANES), .FEATURES(HITS + 1), .SIDE(SIDE), .COUNT_BITS(COUNT_BITS), .COLUMNS(COLUMNS),
        .COLUMN_BITS(REGION_COLUMN_BITS), .DEEP(DEEP)
    ) u_counts (
        .clk_i(clk_i), .rst_i(rst_i), .step_i(hit_step), .hits_i(hits),
        .segment_end_i(hit_segment_end), .row_end_i(hit_row_end), .region_top_i(hit_region_top),
        .region_bottom_i(hit_region_bottom), .done_o(done), .counts_o(counts)
    );

    // A leaf that looks at all pixels takes `center`, which comes two clocks before hit_step.
    wire [SUM_BITS-1:0] sum;
    wire settled;  // all scores except those of the second pass are there
    wire [SETTLED_BITS-1:0] settled_scores;
    bit_delay #(.DEPTH(SETTLED_CLOCKS)) u_settled (.clk_i(clk_i), .rst_i(rst_i), .bit_i(done), .bit_o(settled));
    word_delay #(.WIDTH(COUNTS_BITS), .DEPTH(SETTLED_CLOCKS)) u_settled_counts (
        .clk_i(clk_i), .data_i(counts), .data_o(settled_scores[COUNTS_BITS-1:0])
    );
    generate
        if (SECOND_PASS || VARIANCE) begin : g_moments
            wire [VARIANCE_BITS-1:0] variance;
            // A word is on `center` with its store_step, two clocks before its hit_step.
            raster_moments #(
                .WIDTH(WIDTH), .LANES(LANES), .SIDE(SIDE), .COLUMNS(COLUMNS), .VARIANCE(VARIANCE),
                .SUM_BITS(SUM_BITS), .SQUARE_SUM_BITS(SQUARE_SUM_BITS), .PRODUCT_BITS(PRODUCT_BITS),
                .VARIANCE_BITS(VARIANCE_BITS), .DEEP(DEEP)
            ) u_moments (
                .clk_i(clk_i), .rst_i(rst_i), .word_i(center), .step_i(hit_step), .segment_end_i(hit_segment_end),
                .row_end_i(hit_row_end), .region_top_i(hit_region_top), .sum_o(sum), .variance_o(variance)
            );
            if (VARIANCE) begin : g_variance
                assign settled_scores[COUNTS_BITS+:VARIANCE_BITS] = variance;
            end else begin : g_no_variance
                wire unused_variance = |variance;
            end
        end else begin : g_no_moments
            assign sum = {SUM_BITS{1'b0}};
        end
    endgenerate

    generate
        if (RANGE) begin : g_range
            wire [WIDTH-1:0] range;
            raster_range #(.WIDTH(WIDTH), .LANES(LANES), .COLUMNS(COLUMNS), .DEEP(DEEP)) u_range (
                .clk_i(clk_i), .rst_i(rst_i), .word_i(center), .step_i(hit_step), .segment_end_i(hit_segment_end),
                .row_end_i(hit_row_end), .region_top_i(hit_region_top), .range_o(range)
            );
            word_delay #(.WIDTH(WIDTH), .DEPTH(SETTLED_CLOCKS - 1)) u_range_delay (
                .clk_i(clk_i), .data_i(range), .data_o(settled_scores[RANGE_START+:WIDTH])
            );
        end
    endgenerate

    generate
        if (SURFACE) begin : g_surface
            wire [SUM_BITS-1:0] surface;
            raster_surface #(.VALUE_BITS(VALUE_BITS), .SUM_BITS(SUM_BITS), .COLUMNS(COLUMNS), .DEEP(DEEP)) u_surface (
                .clk_i(clk_i), .rst_i(rst_i), .step_i(hit_step), .values_i(differences),
                .segment_end_i(hit_segment_end), .row_end_i(hit_row_end), .region_top_i(hit_region_top),
                .score_o(surface)
            );
            word_delay #(.WIDTH(SUM_BITS), .DEPTH(SETTLED_CLOCKS - 2)) u_surface_delay (
                .clk_i(clk_i), .data_i(surface), .data_o(settled_scores[SURFACE_START+:SUM_BITS])
            );
        end else begin : g_no_surface
            wire unused_differences = |differences;
        end
    endgenerate

    // The place in the ring buffer of rows of regions where a word is stored.
    wire [START_BITS-1:0] store_place;
    generate
        if (FORWARD || SECOND_PASS) begin : g_ring
            raster_ring #(.WORDS(BUFFER_WORDS), .PLACE_BITS(START_BITS)) u_ring (
                .clk_i(clk_i), .rst_i(rst_i), .step_i(store_step), .place_o(store_place)
            );
        end else begin : g_no_ring
            assign store_place = {START_BITS{1'b0}};
            wire unused_ring = |store_place;
        end
    endgenerate

    // With SUMMARIES two bits come with the counts of a region: one of its means differs, and the screen shows its summary. With ZONES
    // the class of the region comes, too.
    localparam SUMMARIES = BLOCKS > 0 ? 1 : 0;
    localparam OTHER_BITS = SETTLED_BITS + 2 * SUMMARIES + 2 * ZONES;
    wire differs, settled_differs, judged_differs;
    wire shown, settled_shown, judged_shown;
    word_delay #(.WIDTH(2), .DEPTH(SETTLED_CLOCKS)) u_settled_summary (
        .clk_i(clk_i), .data_i({differs, shown}), .data_o({settled_differs, settled_shown})
    );

    wire judged;  // all scores of a region are there
    wire [SCORE_BITS-1:0] scores;
    generate
        if (SECOND_PASS) begin : g_deviation
            wire [OTHER_BITS-1:0] entering, leaving;
            assign entering[SETTLED_BITS-1:0] = settled_scores;
            assign scores[SETTLED_BITS-1:0] = leaving[SETTLED_BITS-1:0];
            if (SUMMARIES) begin : g_summary
                assign entering[SETTLED_BITS+:2] = {settled_differs, settled_shown};
                assign {judged_differs, judged_shown} = leaving[SETTLED_BITS+:2];
            end else begin : g_no_summary
                wire unused_summary = settled_differs || settled_shown;
                assign {judged_differs, judged_shown} = 2'd0;
            end
            if (ZONES) begin : g_class
                assign entering[OTHER_BITS-1-:2] = settled_class;
                assign judged_class = leaving[OTHER_BITS-1-:2];
            end else begin : g_no_class
                wire unused_class = |settled_class;
                assign judged_class = 2'd0;
            end
            wire [MAD_BITS-1:0] mad;
            wire [SEGMENT_BITS-1:0] segment;
            if (MAD) begin : g_mad
                assign scores[SETTLED_BITS+:MAD_BITS] = mad;
            end else begin : g_no_mad
                wire unused_mad = |mad;
            end
            if (SEGMENT) begin : g_segment
                assign scores[SEGMENT_START+:SEGMENT_BITS] = segment;
            end else begin : g_no_segment
                wire unused_segment = |segment;
            end
            raster_deviation #(
                .WIDTH(WIDTH), .LANES(LANES), .SIDE(SIDE), .SEGMENT_WORDS(SEGMENT_WORDS), .COLUMNS(COLUMNS), .ROWS(ROWS),
                .ROW_WORDS(ROW_WORDS), .BANKS(BANKS), .POSITION_BITS(POSITION_BITS), .START_BITS(START_BITS),
                .SUM_BITS(SUM_BITS), .FRACTION(FRACTION), .DIVIDEND_BITS(DIVIDEND_BITS), .MEAN_BITS(MEAN_BITS),
                .FACTOR_BITS(FACTOR_BITS), .FACTOR(FACTOR), .SHIFT(SHIFT), .MAD(MAD), .MAD_BITS(MAD_BITS),
                .SEGMENT(SEGMENT), .SEGMENT_BITS(SEGMENT_BITS), .COUNT_BITS(COUNT_BITS), .OTHER_BITS(OTHER_BITS), .ZONES(ZONES),
                .OTHER_CLOCKS(SETTLED_CLOCKS), .DEEP(DEEP)
            ) u_deviation (
                .clk_i(clk_i), .rst_i(rst_i), .segment_level_i(segment_level_i), .keen_segment_level_i(keen_segment_level_i), .store_i(store_step),
                .store_place_i(store_place), .word_i(center), .done_i(done), .sum_i(sum), .settled_i(settled),
                .other_i(entering), .judged_o(judged), .mad_o(mad), .segment_o(segment),
                .other_o(leaving)
            );
        end else begin : g_no_deviation
            wire unused_sum = |sum || |segment_level_i || |keen_segment_level_i;
            assign judged = settled;
            assign scores = settled_scores;
            assign {judged_differs, judged_shown} = {settled_differs, settled_shown};
            assign judged_class = settled_class;
        end
    endgenerate

    // ---- Decision
    wire decided;       // a region is decided
    wire will_be_active;
    wire will_be_sent;  // the summary of this region is sent
    wire mark;          // a mark that stays with the region (LAST_SENT)
    wire will_be_shown; // the screen shows the summary of this region
    wire [REGION_BITS-1:0] decided_region;
    wire last_region;   // with the decision: the region is the last of the frame
    wire lost_reference;  // a region is lost, so that its reference is no longer valid
    wire [REGION_BITS-1:0] lost_reference_region;
    wire lost_mark;

    raster_decision #(
        .HITS(HITS), .VARIANCE(VARIANCE), .RANGE(RANGE), .SURFACE(SURFACE), .MAD(MAD), .SEGMENT(SEGMENT), .ALL(ALL),
        .LAST_SENT(LAST_SENT), .BLANKS(BLANKS), .SUMMARIES(SUMMARIES), .ZONES(ZONES), .DEEP(DEEP), .PIXELS(SIDE * SIDE), .COUNT_BITS(COUNT_BITS),
        .VARIANCE_BITS(VARIANCE_BITS), .RANGE_BITS(WIDTH), .SURFACE_BITS(SUM_BITS), .MAD_BITS(MAD_BITS),
        .SEGMENT_BITS(SEGMENT_BITS), .REGIONS(REGIONS), .REGION_BITS(REGION_BITS), .SCORE_BITS(SCORE_BITS)
    ) u_decision (
        .clk_i(clk_i), .rst_i(rst_i), .judged_i(judged), .scores_i(scores), .minima_i(minima_i),
        .keen_minima_i(keen_minima_i), .class_i(judged_class),
        .shown_i(judged_shown), .differs_i(judged_differs), .lost_i(lost_reference),
        .lost_region_i(lost_reference_region), .lost_mark_i(lost_mark), .decided_o(decided),
        .will_be_active_o(will_be_active), .will_be_sent_o(will_be_sent), .will_be_shown_o(will_be_shown),
        .decided_region_o(decided_region), .mark_o(mark),
        .decision_valid_o(decision_valid_o), .region_o(region_o), .last_region_o(last_region), .srs_o(srs_o),
        .trs_o(trs_o), .active_o(active_o), .summary_o(summary_o), .scores_o(scores_o)
    );

    // ---- Pixels that leave
    wire idle;  // nothing waits to leave
    generate
        if (FORWARD) begin : g_forward
            wire store_row_end, store_region_bottom;
            wire [WORD-1:0] stored_raw;
            word_delay #(.WIDTH(2), .DEPTH(CENTER_CLOCKS + STORE_CLOCKS - 1)) u_store_places (
                .clk_i(clk_i), .data_i({row_end, region_bottom}), .data_o({store_row_end, store_region_bottom})
            );
            if (RAW && FEATURE_WINDOW) begin : g_line
                wire [WORD-1:0] raw_center;
                raster_line #(.WORD_BITS(WORD), .ROW_WORDS(ROW_WORDS), .ADDRESS_BITS(WORD_BITS)) u_line (
                    .clk_i(clk_i), .rst_i(rst_i), .step_i(scored_step), .word_i(scored_raw), .word_o(raw_center)
                );
                word_delay #(.WIDTH(WORD), .DEPTH(COLUMN_CLOCKS + STORE_CLOCKS)) u_raw (
                    .clk_i(clk_i), .data_i(raw_center), .data_o(stored_raw)
                );
            end else if (RAW) begin : g_beside
                word_delay #(.WIDTH(WORD), .DEPTH(STORE_CLOCKS)) u_raw (
                    .clk_i(clk_i), .data_i(scored_raw), .data_o(stored_raw)
                );
            end else begin : g_scored
                wire unused_raw = |scored_raw;
                assign stored_raw = {WORD{1'b0}};
            end

            // The means of regions that send a summary.
            wire mean_valid, sent, done_sending, done_lost;
            wire [REGION_COLUMN_BITS-1:0] mean_region;
            wire [1:0] mean_row;
            wire [NUMBER_BITS-1:0] mean_number, sent_number;
            wire [WIDTH-1:0] mean, sent_mean;
            wire [REGION_BITS-1:0] sent_region, done_region;
            if (BLOCKS > 0) begin : g_summary
                raster_summary #(
                    .WIDTH(WIDTH), .LANES(LANES), .SIDE(SIDE), .BLOCKS(BLOCKS), .COLUMNS(COLUMNS),
                    .COLUMN_BITS(REGION_COLUMN_BITS), .REGIONS(REGIONS), .REGION_BITS(REGION_BITS), .MEAN_BITS(NUMBER_BITS),
                    .SUM_BITS(BLOCK_SUM_BITS), .FACTOR_BITS(BLOCK_FACTOR_BITS), .FACTOR(BLOCK_FACTOR), .SHIFT(BLOCK_SHIFT),
                    .DEEP(DEEP)
                ) u_summary (
                    .clk_i(clk_i), .rst_i(rst_i), .step_i(arriving_step), .row_end_i(store_row_end),
                    .word_i(RAW ? stored_raw : center), .level_i(summary_level), .mean_valid_o(mean_valid),
                    .mean_region_o(mean_region), .mean_row_o(mean_row), .mean_number_o(mean_number), .mean_o(mean),
                    .differs_o(differs), .shown_o(shown), .decided_i(decided), .decided_region_i(decided_region),
                    .decided_shown_i(will_be_shown), .done_i(done_sending), .done_lost_i(done_lost),
                    .done_region_i(done_region), .sent_i(sent), .sent_region_i(sent_region), .sent_number_i(sent_number),
                    .sent_mean_i(sent_mean)
                );
            end else begin : g_no_summary
                wire unused_sent = |summary_level || sent || |sent_region || |sent_number || |sent_mean || done_sending
                                   || done_lost || |done_region || |decided_region || will_be_shown;
                assign {mean_valid, mean_region, mean_row, mean_number, mean, differs, shown} =
                    {(5 + REGION_COLUMN_BITS + NUMBER_BITS + WIDTH) {1'b0}};
            end

            raster_forward #(
                .WORD_BITS(WORD), .LANES(LANES), .SIDE(SIDE), .SEGMENT_WORDS(SEGMENT_WORDS), .COLUMNS(COLUMNS), .ROWS(ROWS),
                .ROW_WORDS(ROW_WORDS), .BANKS(BANKS), .RAW(RAW), .LAST_SENT(LAST_SENT), .DEEP(DEEP),
                .POSITION_BITS(POSITION_BITS), .REGION_BITS(REGION_BITS), .FRAME_BITS(FRAME_BITS),
                .START_BITS(START_BITS), .PLACE_BITS(PLACE_BITS), .BLOCKS(BLOCKS), .COLUMN_BITS(REGION_COLUMN_BITS),
                .MEAN_BITS(NUMBER_BITS)
            ) u_forward (
                .clk_i(clk_i), .rst_i(rst_i), .store_i(store_step), .store_place_i(store_place), .scored_i(center),
                .raw_i(stored_raw), .arriving_i(arriving_step), .rows_end_i(store_row_end && store_region_bottom),
                .decision_i(decision_valid_o), .active_i(active_o), .region_i(region_o), .last_region_i(last_region),
                .mark_i(mark), .summary_i(summary_o), .mean_valid_i(mean_valid),
                .mean_region_i(mean_region), .mean_row_i(mean_row), .mean_number_i(mean_number), .mean_i(mean),
                .ready_i(forward_ready_i), .valid_o(forward_valid_o), .region_o(forward_region_o),
                .position_o(forward_position_o), .pixel_o(forward_pixel_o), .first_o(forward_first_o),
                .last_o(forward_last_o), .abort_o(forward_abort_o), .frame_o(forward_frame_o), .summary_o(forward_summary_o), .lost_o(lost_o),
                .lost_count_o(lost_count_o), .lost_valid_o(lost_valid_o), .lost_region_o(lost_region_o),
                .lost_frame_o(lost_frame_o), .idle_o(idle), .reference_write_o(reference_write),
                .reference_place_o(reference_place), .reference_word_o(reference_word),
                .lost_reference_o(lost_reference), .lost_reference_region_o(lost_reference_region),
                .lost_mark_o(lost_mark), .done_o(done_sending), .done_lost_o(done_lost), .done_region_o(done_region),
                .sent_o(sent), .sent_region_o(sent_region), .sent_number_o(sent_number), .sent_mean_o(sent_mean)
            );
        end else begin : g_no_forward
            wire unused_forward = forward_ready_i || arriving_step || region_bottom || |scored_raw || mark || last_region || |summary_level
                || will_be_shown || |decided_region;
            assign {forward_valid_o, forward_region_o, forward_position_o, forward_pixel_o} =
                {(1 + REGION_BITS + POSITION_BITS + WORD) {1'b0}};
            assign {forward_first_o, forward_last_o, forward_abort_o, forward_summary_o, differs, shown} = 6'd0;
            assign {lost_o, lost_count_o, lost_valid_o, idle, reference_write} = {20{1'b0}};
            assign {lost_region_o, forward_frame_o, lost_frame_o} = {(REGION_BITS + 2 * FRAME_BITS) {1'b0}};
            assign reference_place = {PLACE_BITS{1'b0}};
            assign reference_word = {WORD{1'b0}};
            assign lost_reference = 1'b0;
            assign lost_reference_region = {REGION_BITS{1'b0}};
            assign lost_mark = 1'b0;
        end
    endgenerate

    // With few rows of regions, the next frame waits until no region is under way.
    generate
        if ((LAST_SENT || BLOCKS > 0) && ROWS <= BANKS) begin : g_waits
            wire undecided;
            if (SECOND_PASS) begin : g_undecided
                localparam REGIONS_BITS = $clog2(BANKS * COLUMNS) + 1;
                reg [REGIONS_BITS-1:0] regions_q;  // number of regions that wait for their second pass or are in it
                wire [REGIONS_BITS-1:0] waiting = regions_q - {{(REGIONS_BITS - 1) {1'b0}}, decided};
                always @(posedge clk_i) begin
                    if (rst_i) regions_q <= {REGIONS_BITS{1'b0}};
                    else regions_q <= waiting + {{(REGIONS_BITS - 1) {1'b0}}, settled};
                end
                assign undecided = settled || waiting != {REGIONS_BITS{1'b0}};
            end else begin : g_decided
                wire unused_decided = decided;
                assign undecided = 1'b0;
            end
            assign busy = !idle || active_o || summary_o || will_be_active || will_be_sent || undecided;
        end else begin : g_goes_on
            wire unused_idle = idle || decided || will_be_active || will_be_sent;
            assign busy = 1'b0;
        end
    endgenerate

endmodule

`default_nettype wire
