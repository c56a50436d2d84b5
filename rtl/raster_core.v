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
    parameter ALL = 0,               // 1: every feature must vote; 0: one vote is enough
    parameter LAST_SENT = 0,         // 1: the reference is what was last sent; 0: the previous frame
    parameter BLANKS = 0,            // 1: a region without SRS loses its reference (LAST_SENT)
    parameter RAW = 0,               // 1: raw pixels leave; 0: denoised ones
    parameter DEEP = 0,              // 1: more registers, for a faster clock
    parameter SETTLE = 11,           // clocks from the last advance of a frame to its last decision
    parameter COUNT_BITS = 7,        // bits of a count, 0..SIDE * SIDE
    parameter EDGE_LEVEL_BITS = 11,  // bits of the level of edges
    parameter POSITION_BITS = 6,     // ceil(log2(SIDE * SIDE))
    parameter REGION_BITS = 15       // ceil(log2(COLUMNS * ROWS))
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
    input  wire [     COUNT_BITS-1:0] temporal_min_i,      // TRS from this count on
    output reg                        decision_valid_o,    // the decision for region_o
    output reg  [    REGION_BITS-1:0] region_o,            // the region that is decided
    output reg                        srs_o,               // spatial relevance
    output reg                        trs_o,               // temporal relevance
    output reg                        active_o,            // both
    output reg  [     COUNT_BITS-1:0] edge_score_o,        // edges
    output reg  [     COUNT_BITS-1:0] corner_score_o,      // corners
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
        if (EDGE + CORNER < 1) begin : g_feature EDGE_or_CORNER_must_be_1 u_refused (); end
    endgenerate

    localparam WORD = LANES * WIDTH;
    localparam SEGMENT = SIDE / LANES;
    localparam ROW_WORDS = COLUMNS * SEGMENT;
    localparam TAKEN_WORDS = (FRAME_WIDTH + LANES - 1) / LANES;
    localparam REGIONS = COLUMNS * ROWS;
    localparam WORD_BITS = $clog2(ROW_WORDS);
    localparam WINDOWS = MEDIAN + 1;
    localparam BANKS = 2;

    // Clocks from one place to another; see docs/raster.md.
    localparam COLUMN_CLOCKS = DEEP ? 3 : 1;                           // from a word to the column of its window
    localparam MEDIAN_CLOCKS = MEDIAN ? COLUMN_CLOCKS + (DEEP ? 6 : 3) : 0;
    localparam CENTER_CLOCKS = MEDIAN_CLOCKS + COLUMN_CLOCKS;          // ... to the center of the last window
    localparam STORE_CLOCKS = 2 + DEEP;                                // from there to the stores
    localparam HIT_CLOCKS = 4 + DEEP;                                  // ... to the hits

    // ---- When and where
    wire advance, pad, taken_end, repeated, in_tail;
    wire advance_segment_end, advance_row_end, advance_region_top, advance_region_bottom;
    wire [1:0] advance_left, advance_right, advance_top, advance_bottom;
    wire busy;

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
        .region_top_o(advance_region_top), .region_bottom_o(advance_region_bottom)
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
            assign scored_word = word;
            assign scored_raw = word;
            assign scored_repeated = row_repeated;
        end
    endgenerate

    // ---- The windows of the features
    wire column_step;
    wire [WORD-1:0] upper, middle, lower;
    wire column_top, column_bottom, column_left, column_right;

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

    wire [LANES-1:0] edges;
    wire [LANES-1:0] corners;
    generate
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
    endgenerate

    // ---- The center of the last window, its place in the frame, and the frame before
    reg [WORD-1:0] center_q;
    wire [WORD-1:0] center;
    wire center_step, store_step, arriving_step, hit_step;

    always @(posedge clk_i) if (column_step) center_q <= middle;

    raster_delay #(.WIDTH(WORD), .DEPTH(STORE_CLOCKS)) u_center (.clk_i(clk_i), .data_i(center_q), .data_o(center));
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

    // ---- Counts
    localparam FEATURES = EDGE + CORNER;
    wire [FEATURES*LANES-1:0] hits;
    wire [LANES-1:0] changed = LAST_SENT ? changes : changes | {LANES{first_frame_q}};
    wire done;
    wire [(FEATURES+1)*COUNT_BITS-1:0] counts;
    generate
        if (EDGE && CORNER) begin : g_both
            assign hits = {corners, edges};
        end else begin : g_one
            assign hits = EDGE ? edges : corners;
        end
    endgenerate

    raster_counts #(
        .LANES(LANES), .FEATURES(FEATURES + 1), .SIDE(SIDE), .COUNT_BITS(COUNT_BITS), .COLUMNS(COLUMNS),
        .COLUMN_BITS($clog2(COLUMNS)), .DEEP(DEEP)
    ) u_counts (
        .clk_i(clk_i), .rst_i(rst_i), .step_i(hit_step), .hits_i({hits, changed}),
        .segment_end_i(hit_segment_end), .row_end_i(hit_row_end), .region_top_i(hit_region_top),
        .region_bottom_i(hit_region_bottom), .done_o(done), .counts_o(counts)
    );

    // ---- Decision
    localparam [REGION_BITS-1:0] BEFORE_LAST = REGIONS - 2;
    localparam [COUNT_BITS-1:0] ALL_PIXELS = SIDE * SIDE;
    reg [REGION_BITS-1:0] region_q;  // of the counts
    reg last_region_q;
    wire [REGION_BITS-1:0] next_region = last_region_q ? {REGION_BITS{1'b0}} : region_q + 1'b1;
    wire reference_valid;            // of that region (LAST_SENT)
    wire [COUNT_BITS-1:0] temporal_count = !LAST_SENT || reference_valid ? counts[COUNT_BITS-1:0] : ALL_PIXELS;
    wire [FEATURES*COUNT_BITS-1:0] scores = counts[COUNT_BITS+:FEATURES*COUNT_BITS];
    wire [FEATURES*COUNT_BITS-1:0] minima;
    wire [FEATURES-1:0] votes;
    wire trs;
    genvar feature;
    generate
        if (EDGE && CORNER) begin : g_two_minima
            assign minima = {corner_min_i, edge_min_i};
        end else begin : g_minimum
            assign minima = EDGE ? edge_min_i : corner_min_i;
        end
        for (feature = 0; feature < FEATURES; feature = feature + 1) begin : g_vote
            vote #(.WIDTH(COUNT_BITS)) u_vote (
                .score_i(scores[feature*COUNT_BITS+:COUNT_BITS]), .minimum_i(minima[feature*COUNT_BITS+:COUNT_BITS]),
                .vote_o(votes[feature])
            );
        end
    endgenerate
    vote #(.WIDTH(COUNT_BITS)) u_trs (.score_i(temporal_count), .minimum_i(temporal_min_i), .vote_o(trs));

    wire decided, voted_trs;
    wire [FEATURES-1:0] voted;
    wire [COUNT_BITS-1:0] decided_count;
    wire [FEATURES*COUNT_BITS-1:0] decided_scores;
    wire [REGION_BITS-1:0] decided_region;
    wire decided_valid;  // its reference was valid
    raster_pulse #(.DEPTH(DEEP)) u_decided (.clk_i(clk_i), .rst_i(rst_i), .bit_i(done), .bit_o(decided));
    raster_delay #(.WIDTH((FEATURES + 1) * (COUNT_BITS + 1) + REGION_BITS + 1), .DEPTH(DEEP)) u_votes (
        .clk_i(clk_i), .data_i({votes, trs, scores, temporal_count, region_q, reference_valid}),
        .data_o({voted, voted_trs, decided_scores, decided_count, decided_region, decided_valid})
    );
    wire srs = ALL ? &voted : |voted;

    always @(posedge clk_i) begin
        decision_valid_o <= decided;
        srs_o            <= decided && srs;
        trs_o            <= decided && voted_trs;
        active_o         <= decided && srs && voted_trs;
        region_o         <= decided_region;
        temporal_count_o <= decided_count;
        if (EDGE) edge_score_o <= decided_scores[COUNT_BITS-1:0];
        if (CORNER) corner_score_o <= decided_scores[(FEATURES-1)*COUNT_BITS+:COUNT_BITS];
        if (done) begin
            region_q      <= next_region;
            last_region_q <= region_q == BEFORE_LAST;
            if (last_region_q) first_frame_q <= 1'b0;
        end
        if (rst_i) begin
            decision_valid_o <= 1'b0;
            srs_o            <= 1'b0;
            trs_o            <= 1'b0;
            active_o         <= 1'b0;
            region_q         <= {REGION_BITS{1'b0}};
            last_region_q    <= 1'b0;
            first_frame_q    <= 1'b1;
        end
    end

    // ---- Pixels that leave
    localparam BUFFER_WORDS = BANKS * SIDE * ROW_WORDS;
    localparam START_BITS = $clog2(BUFFER_WORDS);
    localparam [START_BITS-1:0] LAST_PLACE = BUFFER_WORDS - 1;
    localparam QUEUE_BITS = $clog2(2 * COLUMNS);
    localparam PLACE_BITS = LAST_SENT ? $clog2(ROW_WORDS * ROWS * SIDE) : 1;
    localparam EXTRA_BITS = LAST_SENT ? PLACE_BITS + 1 : 1;

    // Where in the buffer the word that is stored goes, and in which row of regions it is.
    reg [START_BITS-1:0] store_place_q;
    reg store_end_q;
    reg fresh_row_q;  // the next word is the first of a row of regions
    reg [1:0] stored_row_q;
    wire store_row_end, store_region_bottom;
    raster_delay #(.WIDTH(2), .DEPTH(CENTER_CLOCKS + STORE_CLOCKS - 1)) u_store_places (
        .clk_i(clk_i), .data_i({row_end, region_bottom}), .data_o({store_row_end, store_region_bottom})
    );
    always @(posedge clk_i) begin
        if (store_step) begin
            store_place_q <= store_end_q ? {START_BITS{1'b0}} : store_place_q + 1'b1;
            store_end_q   <= store_place_q == LAST_PLACE - 1'b1;
        end
        if (arriving_step) begin
            fresh_row_q <= store_row_end && store_region_bottom;
            if (fresh_row_q) stored_row_q <= stored_row_q + 1'b1;
        end
        if (rst_i) begin
            store_place_q <= {START_BITS{1'b0}};
            store_end_q   <= 1'b0;
            fresh_row_q   <= 1'b0;
            stored_row_q  <= 2'd0;
        end
    end

    // Where in the buffer and in the frame the region starts that is decided.
    wire [1:0] decided_row;
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
            wire [WORD-1:0] raw_center;
            raster_line #(.WORD_BITS(WORD), .ROW_WORDS(ROW_WORDS), .ADDRESS_BITS(WORD_BITS)) u_line (
                .clk_i(clk_i), .rst_i(rst_i), .step_i(scored_step), .word_i(scored_raw), .word_o(raw_center)
            );
            wire [WORD-1:0] stored_raw;
            raster_delay #(.WIDTH(WORD), .DEPTH(COLUMN_CLOCKS + STORE_CLOCKS)) u_raw (
                .clk_i(clk_i), .data_i(raw_center), .data_o(stored_raw)
            );
            raster_memory #(.WIDTH(WORD), .WORDS(BUFFER_WORDS), .ADDRESS_BITS(START_BITS)) u_buffer (
                .clk_i(clk_i), .write_i(store_step), .write_address_i(store_place_q), .data_i(stored_raw),
                .read_i(fetch), .read_address_i(fetch_place), .data_o(fetched)
            );
        end else begin : g_scored
            raster_memory #(.WIDTH(WORD), .WORDS(BUFFER_WORDS), .ADDRESS_BITS(START_BITS)) u_buffer (
                .clk_i(clk_i), .write_i(store_step), .write_address_i(store_place_q), .data_i(center),
                .read_i(fetch), .read_address_i(fetch_place), .data_o(fetched)
            );
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
            wire [PLACE_BITS-1:0] place = fetch_first ? start : next_place_q;
            localparam [PLACE_BITS-1:0] JUMP = ROW_WORDS - SEGMENT + 1;
            always @(posedge clk_i) begin
                fetched_q <= fetch && !rst_i;
                if (fetch) begin
                    sent_place_q <= place;
                    next_place_q <= place + (fetch_segment_end ? JUMP : {{(PLACE_BITS - 1) {1'b0}}, 1'b1});
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
                .clk_i(clk_i), .rst_i(rst_i), .none_i(first_frame_q), .region_i(done ? next_region : region_q),
                .valid_o(reference_valid),
                .decided_i(decided), .decided_region_i(decided_region),
                .next_i(srs && voted_trs ? 1'b1 : BLANKS && !srs ? 1'b0 : decided_valid), .mark_o(mark),
                .lost_i(lost), .lost_region_i(lost_region), .lost_mark_i(lost_extra[PLACE_BITS])
            );
            assign entered_extra = {mark, decided_place};
        end else begin : g_previous
            wire unused_places = |decided_place || |lost_region || |lost_extra || |held_extra || fetch_first || fetch_segment_end;
            assign entered_extra = 1'b0;
            assign reference_write = 1'b0;
            assign reference_word = {WORD{1'b0}};
            assign reference_place = {$clog2(ROW_WORDS*ROWS*SIDE){1'b0}};
            assign reference_valid = 1'b1;
        end
    endgenerate

    assign busy = LAST_SENT && ROWS <= BANKS && (!idle || active_o || (decided && srs && voted_trs));

endmodule

`default_nettype wire
