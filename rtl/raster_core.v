// SPDX-License-Identifier: MIT OR Apache-2.0
// The whole camera for a frame that comes row by row, LANES pixels at every clock: windows, scores, decisions,
// and the pixels of active regions.
//
//     word -> rows -> median -> rows -> edge, corner -> counts -> votes -> decision
//                                  `-> center -> change <-> frame store
//                                          `-> buffer -> readout of active regions
//
// docs/raster.md says what happens when.
`default_nettype none

(* keep_hierarchy = "yes" *)
module raster_core #(
    parameter WIDTH = 8,             // bits of a pixel
    parameter LANES = 1,             // pixels of a word
    parameter SIDE = 8,              // rows of a region
    parameter COLUMNS = 240,         // regions side by side
    parameter ROWS = 135,            // regions one below the other
    parameter FRAME_WIDTH = 1920,    // pixels of a row of the frame
    parameter FRAME_HEIGHT = 1080,   // rows of the frame
    parameter ISOLATED = 0,          // 1: windows end at the borders of regions, not of the frame
    parameter MEDIAN = 1,            // 1: pixels are denoised
    parameter EDGE = 1,              // 1: edges are counted
    parameter CORNER = 0,            // 1: corners are counted
    parameter MAD = 0,               // 1: the mean absolute deviation is a score
    parameter VARIANCE = 0,          // 1: the variance is a score
    parameter ALL = 0,               // 1: every feature must vote; 0: one vote is enough
    parameter LAST_SENT = 0,         // 1: the reference is what was last sent; 0: the previous frame
    parameter BLANKS = 0,            // 1: a region without SRS loses its reference (LAST_SENT)
    parameter RAW = 0,               // 1: raw pixels leave; 0: denoised ones
    parameter DEEP = 0,              // 1: more registers, for a faster clock
    parameter SETTLE = 11,           // clocks from the last advance of a frame to its last decision
    parameter COUNT_BITS = 7,        // bits of a count, 0..SIDE * SIDE
    parameter EDGE_LEVEL_BITS = 11,  // bits of the level of edges
    parameter POSITION_BITS = 6,     // ceil(log2(SIDE * SIDE))
    parameter REGION_BITS = 15,      // ceil(log2(COLUMNS * ROWS))
    parameter SUM_BITS = 14,         // bits of the sum of a region's pixels
    parameter FRACTION = 0,          // fraction bits of the mean (MAD)
    parameter DIVIDEND_BITS = 14,    // bits of 2^FRACTION * sum + half of the pixels
    parameter MEAN_BITS = 8,         // bits of the mean
    parameter FACTOR_BITS = 1,       // bits of FACTOR
    parameter [FACTOR_BITS-1:0] FACTOR = 1,  // dividend * FACTOR >> SHIFT is dividend / pixels
    parameter SHIFT = 6,             // bits that are dropped of the product
    parameter MAD_BITS = 14,         // bits of the score of MAD
    parameter SQUARE_SUM_BITS = 22,  // bits of the sum of squares (VARIANCE)
    parameter PRODUCT_BITS = 28,     // bits of its products
    parameter VARIANCE_BITS = 26     // bits of its score
) (
    input  wire                       clk_i,               // clock, rising edge
    input  wire                       rst_i,               // synchronous reset, active high
    input  wire                       valid_i,             // a word is taken at this edge, if ready_o
    input  wire [    LANES*WIDTH-1:0] pixel_i,             // it, the left pixel in the lowest bits
    output wire                       ready_o,             // a word would be taken
    input  wire [EDGE_LEVEL_BITS-1:0] edge_level_i,        // a pixel is an edge above this
    input  wire [          WIDTH-1:0] corner_level_i,      // ... a corner
    input  wire [          WIDTH-1:0] temporal_level_i,    // ... has changed
    input  wire [     COUNT_BITS-1:0] edge_min_i,          // edges vote from this count on
    input  wire [     COUNT_BITS-1:0] corner_min_i,        // corners
    input  wire [       MAD_BITS-1:0] mad_min_i,           // the mean absolute deviation
    input  wire [  VARIANCE_BITS-1:0] variance_min_i,      // the variance
    input  wire [     COUNT_BITS-1:0] temporal_min_i,      // TRS from this count on
    output reg                        decision_valid_o,    // the decision for region_o
    output reg  [    REGION_BITS-1:0] region_o,            // the region that is decided
    output reg                        srs_o,               // spatial relevance
    output reg                        trs_o,               // temporal relevance
    output reg                        active_o,            // both
    output reg  [     COUNT_BITS-1:0] edge_score_o,        // edges
    output reg  [     COUNT_BITS-1:0] corner_score_o,      // corners
    output reg  [       MAD_BITS-1:0] mad_score_o,         // mean absolute deviation, times pixels and 2^FRACTION
    output reg  [  VARIANCE_BITS-1:0] variance_score_o,    // variance, times the square of the pixels
    output reg  [     COUNT_BITS-1:0] temporal_count_o,    // changed pixels
    input  wire                       forward_ready_i,     // the word on the port is taken
    output wire                       forward_valid_o,     // a word of an active region leaves
    output wire [    REGION_BITS-1:0] forward_region_o,    // its region
    output wire [  POSITION_BITS-1:0] forward_position_o,  // number in its region of its first pixel
    output reg  [    LANES*WIDTH-1:0] forward_pixel_o,     // that word
    output reg                        lost_o,              // a region was lost since reset
    output reg  [               15:0] lost_count_o         // how many, up to the largest number
);

    // Limits: out of them elaboration stops at a module that does not exist.
    generate
        if (LANES != 1 && LANES != 2 && LANES != 4) begin : g_lanes LANES_must_be_1_2_or_4 u_refused (); end
        if (SIDE % LANES != 0) begin : g_side SIDE_must_be_a_multiple_of_LANES u_refused (); end
        if (COLUMNS < 4) begin : g_columns COLUMNS_must_be_4_or_more u_refused (); end
        if (COLUMNS * SIDE < 16 * LANES) begin : g_row a_row_must_have_16_words_or_more u_refused (); end
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
        if (EDGE + CORNER + MAD + VARIANCE < 1) begin : g_feature a_feature_must_be_1 u_refused (); end
    endgenerate

    localparam WORD = LANES * WIDTH;
    localparam SEGMENT = SIDE / LANES;
    localparam ROW_WORDS = COLUMNS * SEGMENT;
    localparam TAKEN_WORDS = (FRAME_WIDTH + LANES - 1) / LANES;
    localparam REGIONS = COLUMNS * ROWS;
    localparam WORD_BITS = $clog2(ROW_WORDS);
    localparam HITS = EDGE + CORNER;
    localparam WINDOWS = MEDIAN + (HITS > 0 ? 1 : 0);
    localparam BANKS = MAD ? 3 : 2;

    // Clocks from one place to another; see docs/raster.md.
    localparam COLUMN_CLOCKS = DEEP ? 3 : 1;                           // from a word to the column of its window
    localparam MEDIAN_CLOCKS = MEDIAN ? COLUMN_CLOCKS + (DEEP ? 6 : 3) : 0;
    localparam CENTER_CLOCKS = MEDIAN_CLOCKS + (HITS > 0 ? COLUMN_CLOCKS : 0);  // ... to the center of the last window
    localparam STORE_CLOCKS = 2 + DEEP;                                // from there to the stores
    localparam HIT_CLOCKS = 4 + DEEP;                                  // ... to the hits

    // ---- When and where
    wire advance, pad, taken_end, repeated, in_tail;
    wire advance_segment_end, advance_row_end, advance_region_top, advance_region_bottom;
    wire [1:0] advance_left, advance_right, advance_top, advance_bottom;
    wire busy, frame_over;

    raster_control #(
        .ROW_WORDS(ROW_WORDS), .TAKEN_WORDS(TAKEN_WORDS), .ROWS(ROWS * SIDE), .TAKEN_ROWS(FRAME_HEIGHT),
        .WORD_BITS(WORD_BITS), .ROW_BITS($clog2(ROWS * SIDE)), .SIDE(SIDE), .SIDE_BITS($clog2(SIDE)),
        .SEGMENT(SEGMENT), .SEGMENT_BITS(SEGMENT > 1 ? $clog2(SEGMENT) : 1), .ISOLATED(ISOLATED), .WINDOWS(WINDOWS),
        .SETTLE(SETTLE), .SETTLE_BITS($clog2(SETTLE))
    ) u_control (
        .clk_i(clk_i), .rst_i(rst_i), .valid_i(valid_i), .busy_i(busy), .ready_o(ready_o),
        .step_o(advance), .pad_o(pad), .taken_end_o(taken_end), .repeat_o(repeated),
        .left_o(advance_left), .right_o(advance_right), .top_o(advance_top), .bottom_o(advance_bottom),
        .tail_o(in_tail), .segment_end_o(advance_segment_end), .row_end_o(advance_row_end),
        .region_top_o(advance_region_top), .region_bottom_o(advance_region_bottom),
        .frame_over_o(frame_over)
    );

    wire [WORD-1:0] made;
    raster_pad #(
        .WIDTH(WIDTH), .LANES(LANES), .REST(FRAME_WIDTH % LANES), .PADS(TAKEN_WORDS != ROW_WORDS)
    ) u_pad (
        .clk_i(clk_i), .step_i(advance), .pad_i(pad), .end_i(taken_end), .word_i(pixel_i), .word_o(made)
    );

    // ---- The words of the frame, a clock later if deep
    wire step, tail, segment_end, row_end, region_top, region_bottom, row_repeated;
    wire [1:0] left, right, top, bottom;
    wire [WORD-1:0] word;

    raster_pulse #(.DEPTH(DEEP)) u_step (.clk_i(clk_i), .rst_i(rst_i), .bit_i(advance), .bit_o(step));
    raster_pulse #(.DEPTH(DEEP)) u_in_tail (.clk_i(clk_i), .rst_i(rst_i), .bit_i(in_tail), .bit_o(tail));
    raster_delay #(.WIDTH(WORD + 13), .DEPTH(DEEP)) u_word (
        .clk_i(clk_i),
        .data_i({made, advance_left, advance_right, advance_top, advance_bottom, repeated,
                 advance_segment_end, advance_row_end, advance_region_top, advance_region_bottom}),
        .data_o({word, left, right, top, bottom, row_repeated, segment_end, row_end, region_top, region_bottom})
    );

    // ---- Denoise
    wire scored_step;              // the word of the last window
    wire [WORD-1:0] scored_word;
    wire [WORD-1:0] scored_raw;    // what it was before (RAW)
    wire scored_repeated;
    generate
        if (MEDIAN) begin : g_median
            wire column_step;
            wire [WORD-1:0] upper, middle, lower;
            wire column_left, column_right;

            raster_window #(
                .WORD_BITS(WORD), .ROW_WORDS(ROW_WORDS), .ADDRESS_BITS(WORD_BITS),
                .REPEATS(ROWS * SIDE != FRAME_HEIGHT), .DEEP(DEEP)
            ) u_raw_window (
                .clk_i(clk_i), .rst_i(rst_i), .step_i(step), .word_i(word), .top_i(top[0]), .bottom_i(bottom[0]),
                .repeat_i(row_repeated), .step_o(column_step), .upper_o(upper), .middle_o(middle), .lower_o(lower)
            );
            raster_delay #(.WIDTH(2), .DEPTH(COLUMN_CLOCKS)) u_sides (
                .clk_i(clk_i), .data_i({left[0], right[0]}), .data_o({column_left, column_right})
            );
            raster_median #(.WIDTH(WIDTH), .LANES(LANES), .DEEP(DEEP)) u_median (
                .clk_i(clk_i), .step_i(column_step), .left_i(column_left), .right_i(column_right),
                .upper_i(upper), .middle_i(middle), .lower_i(lower), .median_o(scored_word)
            );
            raster_pulse #(.DEPTH(MEDIAN_CLOCKS)) u_scored_step (
                .clk_i(clk_i), .rst_i(rst_i), .bit_i(step), .bit_o(scored_step)
            );
            assign scored_repeated = 1'b0;
            if (RAW) begin : g_raw
                reg [WORD-1:0] raw_q;
                always @(posedge clk_i) if (column_step) raw_q <= middle;
                // With the step that makes a word the center its column is in raw_q a clock later.
                raster_delay #(.WIDTH(WORD), .DEPTH(MEDIAN_CLOCKS - COLUMN_CLOCKS)) u_raw (
                    .clk_i(clk_i), .data_i(raw_q), .data_o(scored_raw)
                );
            end else begin : g_denoised
                assign scored_raw = scored_word;
            end
        end else begin : g_none
            assign scored_step = step;
            assign scored_raw = scored_word;
            if (HITS == 0 && ROWS * SIDE != FRAME_HEIGHT) begin : g_repeat
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
    wire [LANES-1:0] edges;
    wire [LANES-1:0] corners;
    wire [WORD-1:0] center_word;  // the center of the last window
    generate
        if (HITS > 0) begin : g_window
    wire column_step;
    wire [WORD-1:0] upper, middle, lower;
    wire column_top, column_bottom, column_left, column_right;
    reg [WORD-1:0] center_q;

    always @(posedge clk_i) if (column_step) center_q <= middle;
    assign center_word = center_q;

    raster_delay #(.WIDTH(2), .DEPTH(MEDIAN_CLOCKS)) u_ends (
        .clk_i(clk_i), .data_i({top[MEDIAN], bottom[MEDIAN]}), .data_o({column_top, column_bottom})
    );
    raster_delay #(.WIDTH(2), .DEPTH(CENTER_CLOCKS)) u_sides (
        .clk_i(clk_i), .data_i({left[MEDIAN], right[MEDIAN]}), .data_o({column_left, column_right})
    );
    raster_window #(
        .WORD_BITS(WORD), .ROW_WORDS(ROW_WORDS), .ADDRESS_BITS(WORD_BITS),
        .REPEATS(!MEDIAN && ROWS * SIDE != FRAME_HEIGHT), .DEEP(DEEP)
    ) u_window (
        .clk_i(clk_i), .rst_i(rst_i), .step_i(scored_step), .word_i(scored_word), .top_i(column_top),
        .bottom_i(column_bottom), .repeat_i(scored_repeated), .step_o(column_step), .upper_o(upper),
        .middle_o(middle), .lower_o(lower)
    );

        if (EDGE) begin : g_edge
            raster_edge #(.WIDTH(WIDTH), .LANES(LANES), .LEVEL_BITS(EDGE_LEVEL_BITS), .DEEP(DEEP)) u_edge (
                .clk_i(clk_i), .step_i(column_step), .left_i(column_left), .right_i(column_right),
                .upper_i(upper), .middle_i(middle), .lower_i(lower), .level_i(edge_level_i), .hit_o(edges)
            );
        end else begin : g_no_edge
            wire unused_edge_level = |edge_level_i || |edge_min_i;
            assign edges = {LANES{1'b0}};
        end
        if (CORNER) begin : g_corner
            raster_corner #(.WIDTH(WIDTH), .LANES(LANES), .DEEP(DEEP)) u_corner (
                .clk_i(clk_i), .step_i(column_step), .left_i(column_left), .right_i(column_right),
                .upper_i(upper), .middle_i(middle), .lower_i(lower), .level_i(corner_level_i), .hit_o(corners)
            );
        end else begin : g_no_corner
            wire unused_corner_level = |corner_level_i || |corner_min_i;
            assign corners = {LANES{1'b0}};
        end
        end else begin : g_no_window
            wire unused_window = |edge_level_i || |edge_min_i || |corner_level_i || |corner_min_i || scored_step
                                 || scored_repeated || |top || |bottom || |left || |right;
            assign edges = {LANES{1'b0}};
            assign corners = {LANES{1'b0}};
            assign center_word = scored_word;
        end
    endgenerate

    // ---- The center of the last window, its place in the frame, and the frame before
    wire [WORD-1:0] center;
    wire center_step, store_step, arriving_step, hit_step;

    raster_delay #(.WIDTH(WORD), .DEPTH(STORE_CLOCKS)) u_center (.clk_i(clk_i), .data_i(center_word), .data_o(center));
    raster_pulse #(.DEPTH(CENTER_CLOCKS)) u_center_step (
        .clk_i(clk_i), .rst_i(rst_i), .bit_i(tail), .bit_o(center_step)
    );
    raster_pulse #(.DEPTH(STORE_CLOCKS - 1)) u_arriving_step (
        .clk_i(clk_i), .rst_i(rst_i), .bit_i(center_step), .bit_o(arriving_step)
    );
    raster_pulse #(.DEPTH(1)) u_store_step (
        .clk_i(clk_i), .rst_i(rst_i), .bit_i(arriving_step), .bit_o(store_step)
    );
    raster_pulse #(.DEPTH(HIT_CLOCKS - STORE_CLOCKS)) u_hit_step (
        .clk_i(clk_i), .rst_i(rst_i), .bit_i(store_step), .bit_o(hit_step)
    );

    wire hit_segment_end, hit_row_end, hit_region_top, hit_region_bottom;
    raster_delay #(.WIDTH(4), .DEPTH(CENTER_CLOCKS + HIT_CLOCKS)) u_places (
        .clk_i(clk_i), .data_i({segment_end, row_end, region_top, region_bottom}),
        .data_o({hit_segment_end, hit_row_end, hit_region_top, hit_region_bottom})
    );

    reg first_frame_q;
    wire [WORD-1:0] reference;
    wire [LANES-1:0] changes;
    wire reference_write;
    wire [WORD-1:0] reference_word;
    wire [$clog2(ROW_WORDS*ROWS*SIDE)-1:0] reference_place;

    wire reference_read;
    raster_pulse #(.DEPTH(1)) u_reference_read (
        .clk_i(clk_i), .rst_i(rst_i), .bit_i(center_step), .bit_o(reference_read)
    );
    raster_store #(
        .WORD_BITS(WORD), .WORDS(ROW_WORDS * ROWS * SIDE), .ADDRESS_BITS($clog2(ROW_WORDS * ROWS * SIDE)),
        .RANDOM(LAST_SENT), .DEEP(DEEP)
    ) u_store (
        .clk_i(clk_i), .rst_i(rst_i), .read_i(reference_read), .reference_o(reference),
        .write_i(LAST_SENT ? reference_write : store_step), .place_i(reference_place),
        .word_i(LAST_SENT ? reference_word : center)
    );
    raster_change #(.WIDTH(WIDTH), .LANES(LANES)) u_change (
        .clk_i(clk_i), .word_i(center), .reference_i(reference), .level_i(temporal_level_i), .hit_o(changes)
    );

    // ---- Scores of a region whose last word has come
    wire [(HITS+1)*LANES-1:0] hits;
    wire [LANES-1:0] changed = LAST_SENT ? changes : changes | {LANES{first_frame_q}};
    wire done;
    wire [(HITS+1)*COUNT_BITS-1:0] counts;
    generate
        if (EDGE && CORNER) begin : g_both
            assign hits = {corners, edges, changed};
        end else if (HITS > 0) begin : g_one
            assign hits = {EDGE ? edges : corners, changed};
        end else begin : g_changes
            wire unused_hits = |edges || |corners;
            assign hits = changed;
        end
    endgenerate

    always @(posedge clk_i) begin
        if (rst_i) first_frame_q <= 1'b1;
        else if (frame_over) first_frame_q <= 1'b0;
    end

    raster_counts #(
        .LANES(LANES), .FEATURES(HITS + 1), .SIDE(SIDE), .COUNT_BITS(COUNT_BITS), .COLUMNS(COLUMNS),
        .COLUMN_BITS($clog2(COLUMNS)), .DEEP(DEEP)
    ) u_counts (
        .clk_i(clk_i), .rst_i(rst_i), .step_i(hit_step), .hits_i(hits),
        .segment_end_i(hit_segment_end), .row_end_i(hit_row_end), .region_top_i(hit_region_top),
        .region_bottom_i(hit_region_bottom), .done_o(done), .counts_o(counts)
    );

    localparam VARIANCE_CLOCKS = VARIANCE ? 3 : 0;
    wire [SUM_BITS-1:0] sum;
    wire [VARIANCE_BITS-1:0] variance;
    wire settled;  // all scores but that of MAD are there
    wire [(HITS+1)*COUNT_BITS-1:0] settled_counts;
    raster_pulse #(.DEPTH(VARIANCE_CLOCKS)) u_settled (.clk_i(clk_i), .rst_i(rst_i), .bit_i(done), .bit_o(settled));
    raster_delay #(.WIDTH((HITS + 1) * COUNT_BITS), .DEPTH(VARIANCE_CLOCKS)) u_settled_counts (
        .clk_i(clk_i), .data_i(counts), .data_o(settled_counts)
    );
    generate
        if (MAD || VARIANCE) begin : g_sums
            integer lane;
            // Pixels and squares of a word, two clocks behind its center.
            localparam WORD_SUM_BITS = WIDTH + $clog2(LANES);
            localparam WORD_SQUARE_BITS = 2 * WIDTH + $clog2(LANES);
            reg [WORD_SUM_BITS-1:0] word_sum, word_sum_q, word_sum_2q;
            always @* begin
                word_sum = {WORD_SUM_BITS{1'b0}};
                for (lane = 0; lane < LANES; lane = lane + 1)
                    word_sum = word_sum + {{(WORD_SUM_BITS - WIDTH) {1'b0}}, center[lane*WIDTH+:WIDTH]};
            end
            always @(posedge clk_i) begin
                word_sum_q  <= word_sum;
                word_sum_2q <= word_sum_q;
            end
            raster_sums #(
                .VALUE_BITS(WORD_SUM_BITS), .SUM_BITS(SUM_BITS), .COLUMNS(COLUMNS), .COLUMN_BITS($clog2(COLUMNS)),
                .DEEP(DEEP)
            ) u_sum (
                .clk_i(clk_i), .rst_i(rst_i), .step_i(hit_step), .value_i(word_sum_2q),
                .segment_end_i(hit_segment_end), .row_end_i(hit_row_end), .region_top_i(hit_region_top), .sum_o(sum)
            );

            if (VARIANCE) begin : g_variance
                reg [LANES*2*WIDTH-1:0] squares_q;
                reg [WORD_SQUARE_BITS-1:0] word_square, word_square_2q;
                wire [SQUARE_SUM_BITS-1:0] square_sum;
                always @* begin
                    word_square = {WORD_SQUARE_BITS{1'b0}};
                    for (lane = 0; lane < LANES; lane = lane + 1)
                        word_square = word_square + {{(WORD_SQUARE_BITS - 2 * WIDTH) {1'b0}}, squares_q[lane*2*WIDTH+:2*WIDTH]};
                end
                always @(posedge clk_i) begin
                    for (lane = 0; lane < LANES; lane = lane + 1)
                        squares_q[lane*2*WIDTH+:2*WIDTH] <= center[lane*WIDTH+:WIDTH] * center[lane*WIDTH+:WIDTH];
                    word_square_2q <= word_square;
                end
                raster_sums #(
                    .VALUE_BITS(WORD_SQUARE_BITS), .SUM_BITS(SQUARE_SUM_BITS), .COLUMNS(COLUMNS),
                    .COLUMN_BITS($clog2(COLUMNS)), .DEEP(DEEP)
                ) u_square_sum (
                    .clk_i(clk_i), .rst_i(rst_i), .step_i(hit_step), .value_i(word_square_2q),
                    .segment_end_i(hit_segment_end), .row_end_i(hit_row_end), .region_top_i(hit_region_top),
                    .sum_o(square_sum)
                );
                raster_variance #(
                    .PIXELS(SIDE * SIDE), .SUM_BITS(SUM_BITS), .SQUARE_SUM_BITS(SQUARE_SUM_BITS),
                    .PRODUCT_BITS(PRODUCT_BITS), .SCORE_BITS(VARIANCE_BITS)
                ) u_variance (
                    .clk_i(clk_i), .sum_i(sum), .square_sum_i(square_sum), .score_o(variance)
                );
            end else begin : g_no_variance
                assign variance = {VARIANCE_BITS{1'b0}};
            end
        end else begin : g_no_sums
            assign sum = {SUM_BITS{1'b0}};
            assign variance = {VARIANCE_BITS{1'b0}};
        end
    endgenerate

    // ---- Second pass
    localparam BUFFER_WORDS = BANKS * SIDE * ROW_WORDS;
    localparam START_BITS = $clog2(BUFFER_WORDS);
    localparam QUEUE_BITS = $clog2(BANKS * COLUMNS);  // all regions in the buffer may wait
    localparam JUDGED_BITS = VARIANCE_BITS + (HITS + 1) * COUNT_BITS;
    wire judged;  // all scores are there
    wire [MAD_BITS-1:0] judged_mad;
    wire [VARIANCE_BITS-1:0] judged_variance;
    wire [(HITS+1)*COUNT_BITS-1:0] judged_counts;
    wire pass_read;
    wire [START_BITS-1:0] pass_place;
    wire [WORD-1:0] pass_word;
    generate
        if (MAD) begin : g_mad
            wire [MEAN_BITS-1:0] mean, settled_mean;
            wire enter;
            wire [JUDGED_BITS-1:0] entering;
            wire [START_BITS-1:0] start;
            wire [2:0] unused_row;
            wire unused_place;
            localparam HALF = SIDE * SIDE / 2;
            region_mean #(
                .SUM_BITS(SUM_BITS), .FRACTION(FRACTION), .DIVIDEND_BITS(DIVIDEND_BITS), .MEAN_BITS(MEAN_BITS),
                .FACTOR_BITS(FACTOR_BITS), .HALF(HALF[DIVIDEND_BITS-1:0]), .FACTOR(FACTOR), .SHIFT(SHIFT)
            ) u_mean (
                .clk_i(clk_i), .done_i(done), .sum_i(sum), .mean_o(mean)
            );
            raster_delay #(.WIDTH(MEAN_BITS), .DEPTH(VARIANCE_CLOCKS)) u_settled_mean (
                .clk_i(clk_i), .data_i(mean), .data_o(settled_mean)
            );
            raster_pulse #(.DEPTH(1)) u_enter (.clk_i(clk_i), .rst_i(rst_i), .bit_i(settled), .bit_o(enter));
            raster_delay #(.WIDTH(JUDGED_BITS), .DEPTH(1)) u_entering (
                .clk_i(clk_i), .data_i({variance, settled_counts}), .data_o(entering)
            );
            raster_start #(
                .COLUMNS(COLUMNS), .ROWS(ROWS), .SEGMENT(SEGMENT), .SIDE(SIDE), .BANKS(BANKS),
                .START_BITS(START_BITS), .PLACE_BITS(1)
            ) u_pass_start (
                .clk_i(clk_i), .rst_i(rst_i), .step_i(enter), .row_o(unused_row), .start_o(start),
                .place_o(unused_place)
            );
            raster_pass #(
                .WIDTH(WIDTH), .LANES(LANES), .SIDE(SIDE), .SEGMENT(SEGMENT), .POSITION_BITS(POSITION_BITS),
                .ROW_WORDS(ROW_WORDS), .PLACE_BITS(START_BITS), .FRACTION(FRACTION), .MEAN_BITS(MEAN_BITS),
                .SUM_BITS(MAD_BITS), .EXTRA_BITS(JUDGED_BITS), .QUEUE_WORDS(1 << QUEUE_BITS),
                .QUEUE_BITS(QUEUE_BITS), .DEEP(DEEP)
            ) u_pass (
                .clk_i(clk_i), .rst_i(rst_i), .enter_i(enter), .mean_i(settled_mean), .start_i(start),
                .extra_i(entering), .read_o(pass_read), .place_o(pass_place), .word_i(pass_word), .done_o(judged),
                .sum_o(judged_mad), .extra_o({judged_variance, judged_counts})
            );
        end else begin : g_no_mad
            assign judged = settled;
            assign judged_mad = {MAD_BITS{1'b0}};
            assign judged_variance = variance;
            assign judged_counts = settled_counts;
            assign pass_read = 1'b0;
            assign pass_place = {START_BITS{1'b0}};
        end
    endgenerate

    // ---- Decision
    localparam BEFORE_LAST = REGIONS - 2;
    localparam ALL_PIXELS = SIDE * SIDE;
    localparam [3:0] PRESENT = {VARIANCE != 0, MAD != 0, CORNER != 0, EDGE != 0};
    localparam EDGE_PLACE = HITS > 0 ? 1 : 0;
    reg [REGION_BITS-1:0] region_q;  // the region that is judged
    reg last_region_q;
    reg no_reference_q;              // in the first frame no region has one
    wire [REGION_BITS-1:0] next_region = last_region_q ? {REGION_BITS{1'b0}} : region_q + 1'b1;
    wire reference_valid;            // of that region (LAST_SENT)
    wire [COUNT_BITS-1:0] temporal_count = !LAST_SENT || reference_valid ? judged_counts[COUNT_BITS-1:0] : ALL_PIXELS[COUNT_BITS-1:0];
    wire [COUNT_BITS-1:0] edge_count = judged_counts[EDGE_PLACE*COUNT_BITS+:COUNT_BITS];
    wire [COUNT_BITS-1:0] corner_count = judged_counts[HITS*COUNT_BITS+:COUNT_BITS];
    wire [3:0] votes;
    wire trs;
    vote #(.WIDTH(COUNT_BITS)) u_edge_vote (.score_i(edge_count), .minimum_i(edge_min_i), .vote_o(votes[0]));
    vote #(.WIDTH(COUNT_BITS)) u_corner_vote (.score_i(corner_count), .minimum_i(corner_min_i), .vote_o(votes[1]));
    vote #(.WIDTH(MAD_BITS)) u_mad_vote (.score_i(judged_mad), .minimum_i(mad_min_i), .vote_o(votes[2]));
    vote #(.WIDTH(VARIANCE_BITS)) u_variance_vote (
        .score_i(judged_variance), .minimum_i(variance_min_i), .vote_o(votes[3])
    );
    vote #(.WIDTH(COUNT_BITS)) u_trs (.score_i(temporal_count), .minimum_i(temporal_min_i), .vote_o(trs));

    wire decided, decided_trs;
    wire [3:0] decided_votes;
    wire [COUNT_BITS-1:0] decided_temporal, decided_edges, decided_corners;
    wire [MAD_BITS-1:0] decided_mad;
    wire [VARIANCE_BITS-1:0] decided_variance;
    wire [REGION_BITS-1:0] decided_region;
    wire decided_valid;  // its reference was valid
    raster_pulse #(.DEPTH(DEEP)) u_decided (.clk_i(clk_i), .rst_i(rst_i), .bit_i(judged), .bit_o(decided));
    raster_delay #(.WIDTH(6 + REGION_BITS + 3 * COUNT_BITS + MAD_BITS + VARIANCE_BITS), .DEPTH(DEEP)) u_judged (
        .clk_i(clk_i),
        .data_i({votes, trs, reference_valid, region_q, temporal_count, edge_count, corner_count, judged_mad,
                 judged_variance}),
        .data_o({decided_votes, decided_trs, decided_valid, decided_region, decided_temporal, decided_edges,
                 decided_corners, decided_mad, decided_variance})
    );
    wire srs = ALL ? &(decided_votes | ~PRESENT) : |(decided_votes & PRESENT);
    wire active = decided && srs && decided_trs;

    always @(posedge clk_i) begin
        decision_valid_o <= decided;
        srs_o            <= decided && srs;
        trs_o            <= decided && decided_trs;
        active_o         <= active;
        region_o         <= decided_region;
        temporal_count_o <= decided_temporal;
        edge_score_o     <= decided_edges;
        corner_score_o   <= decided_corners;
        mad_score_o      <= decided_mad;
        variance_score_o <= decided_variance;
        if (judged) begin
            region_q      <= next_region;
            last_region_q <= region_q == BEFORE_LAST[REGION_BITS-1:0];
            if (last_region_q) no_reference_q <= 1'b0;
        end
        if (rst_i) begin
            decision_valid_o <= 1'b0;
            srs_o            <= 1'b0;
            trs_o            <= 1'b0;
            active_o         <= 1'b0;
            region_q         <= {REGION_BITS{1'b0}};
            last_region_q    <= 1'b0;
            no_reference_q   <= 1'b1;
        end
    end

    // ---- Pixels that leave
    localparam LAST_PLACE = BUFFER_WORDS - 1;
    localparam PLACE_BITS = LAST_SENT ? $clog2(ROW_WORDS * ROWS * SIDE) : 1;
    localparam EXTRA_BITS = LAST_SENT ? PLACE_BITS + 1 : 1;

    // Where in the buffer the word that is stored goes, and in which row of regions it is.
    reg [START_BITS-1:0] store_place_q;
    reg store_end_q;
    reg fresh_row_q;  // the next word is the first of a row of regions
    reg [2:0] stored_row_q;
    wire store_row_end, store_region_bottom;
    raster_delay #(.WIDTH(2), .DEPTH(CENTER_CLOCKS + STORE_CLOCKS - 1)) u_store_places (
        .clk_i(clk_i), .data_i({row_end, region_bottom}), .data_o({store_row_end, store_region_bottom})
    );
    always @(posedge clk_i) begin
        if (store_step) begin
            store_place_q <= store_end_q ? {START_BITS{1'b0}} : store_place_q + 1'b1;
            store_end_q   <= store_place_q == LAST_PLACE[START_BITS-1:0] - 1'b1;
        end
        if (arriving_step) begin
            fresh_row_q <= store_row_end && store_region_bottom;
            if (fresh_row_q) stored_row_q <= stored_row_q + 1'b1;
        end
        if (rst_i) begin
            store_place_q <= {START_BITS{1'b0}};
            store_end_q   <= 1'b0;
            fresh_row_q   <= 1'b0;
            stored_row_q  <= 3'd0;
        end
    end

    // Where in the buffer and in the frame the region starts that is decided.
    wire [2:0] decided_row;
    wire [START_BITS-1:0] decided_start;
    wire [PLACE_BITS-1:0] decided_place;

    raster_start #(
        .COLUMNS(COLUMNS), .ROWS(ROWS), .SEGMENT(SEGMENT), .SIDE(SIDE), .BANKS(BANKS), .START_BITS(START_BITS),
        .FRAME(LAST_SENT), .PLACE_BITS(PLACE_BITS)
    ) u_start (
        .clk_i(clk_i), .rst_i(rst_i), .step_i(decision_valid_o), .row_o(decided_row), .start_o(decided_start),
        .place_o(decided_place)
    );
    wire fetch, out_step, lost, idle, fetch_first, fetch_segment_end;
    wire [START_BITS-1:0] fetch_place;
    wire [REGION_BITS-1:0] lost_region;
    wire [EXTRA_BITS-1:0] entered_extra, lost_extra, held_extra;

    raster_readout #(
        .LANES(LANES), .SIDE(SIDE), .SEGMENT(SEGMENT), .POSITION_BITS(POSITION_BITS), .REGION_BITS(REGION_BITS),
        .ROW_WORDS(ROW_WORDS), .START_BITS(START_BITS), .BANKS(BANKS), .EXTRA_BITS(EXTRA_BITS),
        .QUEUE_WORDS(1 << QUEUE_BITS), .QUEUE_BITS(QUEUE_BITS)
    ) u_readout (
        .clk_i(clk_i), .rst_i(rst_i), .enter_i(active_o), .row_i(decided_row), .region_i(region_o),
        .start_i(decided_start), .extra_i(entered_extra), .stored_row_i(stored_row_q), .ready_i(forward_ready_i),
        .fetch_o(fetch), .place_o(fetch_place), .step_o(out_step), .valid_o(forward_valid_o),
        .region_o(forward_region_o), .position_o(forward_position_o), .lost_o(lost), .lost_region_o(lost_region),
        .lost_extra_o(lost_extra), .held_extra_o(held_extra), .first_o(fetch_first),
        .segment_end_o(fetch_segment_end), .idle_o(idle)
    );

    wire [WORD-1:0] fetched;
    generate
        if (RAW) begin : g_raw
            wire [WORD-1:0] stored_raw;
            if (HITS > 0) begin : g_line
                wire [WORD-1:0] raw_center;
                raster_line #(.WORD_BITS(WORD), .ROW_WORDS(ROW_WORDS), .ADDRESS_BITS(WORD_BITS)) u_line (
                    .clk_i(clk_i), .rst_i(rst_i), .step_i(scored_step), .word_i(scored_raw), .word_o(raw_center)
                );
                raster_delay #(.WIDTH(WORD), .DEPTH(COLUMN_CLOCKS + STORE_CLOCKS)) u_raw (
                    .clk_i(clk_i), .data_i(raw_center), .data_o(stored_raw)
                );
            end else begin : g_beside
                raster_delay #(.WIDTH(WORD), .DEPTH(STORE_CLOCKS)) u_raw (
                    .clk_i(clk_i), .data_i(scored_raw), .data_o(stored_raw)
                );
            end
            raster_memory #(.WIDTH(WORD), .WORDS(BUFFER_WORDS), .ADDRESS_BITS(START_BITS)) u_buffer (
                .clk_i(clk_i), .write_i(store_step), .write_address_i(store_place_q), .data_i(stored_raw),
                .read_i(fetch), .read_address_i(fetch_place), .data_o(fetched)
            );
        end else begin : g_scored
            wire unused_raw = |scored_raw;
            raster_memory #(.WIDTH(WORD), .WORDS(BUFFER_WORDS), .ADDRESS_BITS(START_BITS)) u_buffer (
                .clk_i(clk_i), .write_i(store_step), .write_address_i(store_place_q), .data_i(center),
                .read_i(fetch), .read_address_i(fetch_place), .data_o(fetched)
            );
        end
    endgenerate

    // The second pass reads a copy.
    generate
        if (MAD) begin : g_copy
            raster_memory #(
                .WIDTH(WORD), .WORDS(BUFFER_WORDS), .ADDRESS_BITS(START_BITS), .OUTPUT_STAGE(DEEP)
            ) u_copy (
                .clk_i(clk_i), .write_i(store_step), .write_address_i(store_place_q), .data_i(center),
                .read_i(pass_read), .read_address_i(pass_place), .data_o(pass_word)
            );
        end else begin : g_no_copy
            assign pass_word = {WORD{1'b0}};
            wire unused_pass = pass_read || |pass_place || |pass_word || |sum;
        end
    endgenerate

    always @(posedge clk_i) begin
        if (out_step) forward_pixel_o <= fetched;
        if (lost) begin
            lost_o <= 1'b1;
            if (lost_count_o != 16'hFFFF) lost_count_o <= lost_count_o + 1'b1;
        end
        if (rst_i) begin
            lost_o       <= 1'b0;
            lost_count_o <= 16'd0;
        end
    end

    // ---- References of what was sent
    generate
        if (LAST_SENT) begin : g_sent
            // What is sent becomes the reference, a clock after it was fetched.
            reg fetched_q;
            reg [PLACE_BITS-1:0] sent_place_q, next_place_q;
            wire [PLACE_BITS-1:0] start = held_extra[PLACE_BITS-1:0];
            wire unused_mark = held_extra[PLACE_BITS];
            wire [PLACE_BITS-1:0] place = fetch_first ? start : next_place_q;
            localparam JUMP = ROW_WORDS - SEGMENT + 1;
            always @(posedge clk_i) begin
                fetched_q <= fetch && !rst_i;
                if (fetch) begin
                    sent_place_q <= place;
                    next_place_q <= place + (fetch_segment_end ? JUMP[PLACE_BITS-1:0] : {{(PLACE_BITS - 1) {1'b0}}, 1'b1});
                end
            end
            assign reference_write = fetched_q;
            assign reference_place = sent_place_q;
            if (RAW) begin : g_denoised
                raster_memory #(.WIDTH(WORD), .WORDS(BUFFER_WORDS), .ADDRESS_BITS(START_BITS)) u_denoised (
                    .clk_i(clk_i), .write_i(store_step), .write_address_i(store_place_q), .data_i(center),
                    .read_i(fetch), .read_address_i(fetch_place), .data_o(reference_word)
                );
            end else begin : g_same
                assign reference_word = fetched;
            end

            wire mark;
            raster_valid #(.REGIONS(REGIONS), .REGION_BITS(REGION_BITS), .DEEP(DEEP)) u_valid (
                .clk_i(clk_i), .rst_i(rst_i), .none_i(no_reference_q), .region_i(judged ? next_region : region_q),
                .valid_o(reference_valid),
                .decided_i(decided), .decided_region_i(decided_region),
                .next_i(srs && decided_trs ? 1'b1 : BLANKS && !srs ? 1'b0 : decided_valid), .mark_o(mark),
                .lost_i(lost), .lost_region_i(lost_region), .lost_mark_i(lost_extra[PLACE_BITS])
            );
            assign entered_extra = {mark, decided_place};
        end else begin : g_previous
            wire unused_places = |decided_place || |lost_region || |lost_extra || |held_extra || fetch_first || fetch_segment_end;
            assign entered_extra = 1'b0;
            assign reference_write = 1'b0;
            assign reference_word = {WORD{1'b0}};
            assign reference_place = {$clog2(ROW_WORDS*ROWS*SIDE){1'b0}};
            wire unused_reference = decided_valid || no_reference_q;
            assign reference_valid = 1'b1;
        end
    endgenerate

    // With few rows of regions the next frame waits until no region is under way.
    generate
        if (LAST_SENT && ROWS <= BANKS) begin : g_waits
            wire undecided;
            if (MAD) begin : g_undecided
                reg [QUEUE_BITS:0] regions_q;  // regions that wait for their second pass, and are in it
                wire [QUEUE_BITS:0] waiting = regions_q - {{QUEUE_BITS{1'b0}}, decided};
                always @(posedge clk_i) begin
                    if (rst_i) regions_q <= {(QUEUE_BITS + 1) {1'b0}};
                    else regions_q <= waiting + {{QUEUE_BITS{1'b0}}, settled};
                end
                assign undecided = settled || waiting != {(QUEUE_BITS + 1) {1'b0}};
            end else begin : g_decided
                assign undecided = 1'b0;
            end
            assign busy = !idle || active_o || active || undecided;
        end else begin : g_goes_on
            wire unused_idle = idle;
            assign busy = 1'b0;
        end
    endgenerate

endmodule

`default_nettype wire
