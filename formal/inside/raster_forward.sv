// SPDX-License-Identifier: MIT OR Apache-2.0
// An arbitrary active region of an arbitrary frame is followed from its decision to the port: its words leave once, in order, and are
// those that were stored of this frame, from a first to a last, with the number of its frame. Or it is lost, because the first word of
// a later row of regions replaced one in the buffer; then its number comes, and the part of it that left ends with abort. Words come
// at every clock after one reset, and a decision as many clocks after the last word of its region as the core needs (frames of one row
// of regions have a gap between them); the sink stalls at random.
`include "reset.vh"
localparam F_N = SIDE * SEGMENT_WORDS;                 // words of a region
localparam F_ROW = SIDE * ROW_WORDS;             // words of a row of regions
localparam F_DECIDED = (DEEP ? 6 : 4) + 1;       // clocks from a region's last word to its decision

// ---- The input: words in order, and decisions
reg [5:0] f_arriving = 6'd0;                     // number in its row of regions of the word that arrives next
reg [5:0] f_stored = 6'd0;                       // number in its row of regions of the word that is stored next
reg f_store = 1'b0;
reg [3:0] f_pause = 4'd0;                        // clocks left of the gap
reg [START_BITS-1:0] f_place = 0;
reg [F_DECIDED:0] f_done = 0;
reg [REGION_BITS-1:0] f_region = 0;              // number of the region that is decided next
reg [REGION_BITS-1:0] f_first = 0;               // number of the first region of the row of regions that is stored
wire [5:0] f_column = f_stored % ROW_WORDS;
wire f_last_word = store_i && f_stored >= (SIDE - 1) * ROW_WORDS && f_column % SEGMENT_WORDS == SEGMENT_WORDS - 1;
always @* begin
    if (started) assume(!rst_i);
    assume(arriving_i == (started && f_pause == 4'd0));
    assume(rows_end_i == (f_arriving == F_ROW - 1));
    assume(store_i == f_store);
    assume(store_place_i == f_place);
    assume(decision_i == f_done[F_DECIDED-1]);
    assume(decision_i || !active_i && !summary_i);
    assume(!active_i || !summary_i);
    assume(region_i == f_region);
    assume(last_region_i == (f_region == COLUMNS * ROWS - 1));
end
always @(posedge clk_i) begin
    f_store <= arriving_i;
    if (f_pause != 4'd0) f_pause <= f_pause - 4'd1;
    else if (ROWS == 1 && arriving_i && f_arriving == F_ROW - 1) f_pause <= 4'd9;
    if (arriving_i) f_arriving <= f_arriving == F_ROW - 1 ? 6'd0 : f_arriving + 6'd1;
    if (store_i) begin
        f_stored <= f_stored == F_ROW - 1 ? 6'd0 : f_stored + 6'd1;
        f_place <= f_place == WORDS - 1 ? 0 : f_place + 1;
        if (f_stored == F_ROW - 1) f_first <= f_first == COLUMNS * (ROWS - 1) ? 0 : f_first + COLUMNS;
    end
    f_done <= {f_done, f_last_word};
    if (decision_i) f_region <= f_region == COLUMNS * ROWS - 1 ? 0 : f_region + 1;
    if (rst_i) begin
        f_arriving <= 6'd0;
        f_store    <= 1'b0;
        f_stored   <= 6'd0;
        f_place    <= 0;
        f_first    <= 0;
        f_done     <= 0;
        f_region   <= 0;
    end
end

// ---- The watched region and its watched word
(* anyconst *) wire [REGION_BITS-1:0] f_ours;
(* anyconst *) wire [3:0] f_word;
(* anyseq *) wire f_pick;
always @* assume(f_ours < COLUMNS * ROWS && f_word < F_N);
reg f_latest;   // the word as it was stored last
reg f_kept;     // the word as it was stored in the watched frame
wire [5:0] f_at = f_word / SEGMENT_WORDS * ROW_WORDS + (f_ours % COLUMNS) * SEGMENT_WORDS + f_word % SEGMENT_WORDS;
reg [1:0] f_state = 2'd0;
localparam F_NONE = 2'd0, F_WAITS = 2'd1, F_HELD = 2'd2, F_OVER = 2'd3;
wire f_enters = active_i || BLOCKS > 0 && summary_i;  // the region sends pixels or means, which are equally many words
reg f_means;                                     // the watched region sends means
wire f_watched = f_enters && f_pick && f_state == F_NONE && region_i == f_ours;
reg [2:0] f_rows;      // number of rows of regions of which words are stored, from that of the watched region on
wire f_next_row = store_i && f_stored == 6'd0;
wire f_stale = f_rows + f_next_row > BANKS;
// For the decided region it is one or two, because words of the next row may have come.
reg [2:0] f_stored_rows = 3'd0, f_decided_rows = 3'd0;  // number of rows of regions that have begun; number of those that are decided
wire [2:0] f_count = f_stored_rows - f_decided_rows;
always @(posedge clk_i) begin
    f_stored_rows <= f_stored_rows + f_next_row;
    if (decision_i && f_region % COLUMNS == COLUMNS - 1) f_decided_rows <= f_decided_rows + 3'd1;
    if (rst_i) begin
        f_stored_rows  <= 3'd0;
        f_decided_rows <= 3'd0;
    end
end
always @(posedge clk_i) begin
    if (store_i && f_ours >= f_first && f_ours < f_first + COLUMNS && f_stored == f_at) f_latest <= scored_i[0];
end

// ---- The events by docs/raster.md
reg [3:0] f_waiting = 4'd0, f_ahead;
reg [1:0] f_entered = 2'd0, f_since = 2'd2;
reg f_held = 1'b0;
reg [3:0] f_next;
wire [3:0] f_recent = f_entered[0] + (DEEP ? f_entered[1] : 1'b0);
wire f_last = fetch && f_next == F_N - 1;
wire f_held_lost = f_held && lost && !fetch;
wire f_begins = (!f_held || f_last) && f_waiting > f_recent && f_since == 2'd2;
reg f_fetched = 1'b0, f_fetched_ours, f_port = 1'b0, f_port_ours;
reg [3:0] f_fetched_word, f_port_word;
reg [FRAME_BITS-1:0] f_frame = 0, f_our_frame;  // number of the decided frame; number of the watched frame
reg f_lost_ours = 1'b0, f_ended = 1'b0;         // lost at the edge before; lost in the middle, after this word
reg [3:0] f_end_word;
always @(posedge clk_i) begin
    f_waiting <= f_waiting + f_enters - f_begins;
    f_entered <= {f_entered[0], f_enters};
    f_since <= f_begins ? 2'd1 : 2'd2;
    f_held <= f_begins ? !lost : f_held && !f_held_lost && !f_last;
    f_next <= f_begins ? 4'd0 : f_next + fetch;
    if (decision_i && f_region == COLUMNS * ROWS - 1) f_frame <= f_frame + 1'b1;
    f_lost_ours <= lost && (f_state == F_HELD ? f_held_lost : f_state == F_WAITS && f_begins && f_ahead == 4'd0);
    if (f_state == F_HELD && f_held_lost && f_next != 4'd0) begin
        f_ended <= 1'b1;
        f_end_word <= f_next - 4'd1;
    end
    if (f_watched) begin
        f_our_frame <= f_frame;
        f_means <= summary_i;
        f_state <= F_WAITS;
        f_ahead <= f_waiting - f_begins;
        f_kept <= f_latest;
    end
    f_rows <= (f_watched ? f_count : f_rows) + f_next_row;
    if (f_state == F_WAITS && f_begins) begin
        f_ahead <= f_ahead - 4'd1;
        if (f_ahead == 4'd0) f_state <= lost ? F_OVER : F_HELD;
    end
    if (f_state == F_HELD && (f_held_lost || f_last)) f_state <= F_OVER;
    if (step) begin
        f_fetched <= fetch;
        f_fetched_ours <= f_state == F_HELD;
        f_fetched_word <= f_next;
        f_port <= f_fetched;
        f_port_ours <= f_fetched_ours;
        f_port_word <= f_fetched_word;
    end
    if (rst_i) begin
        f_waiting <= 4'd0;
        f_entered <= 2'd0;
        f_since   <= 2'd2;
        f_held    <= 1'b0;
        f_state   <= F_NONE;
        f_fetched <= 1'b0;
        f_port    <= 1'b0;
        f_frame   <= 0;
        f_ended   <= 1'b0;
        f_lost_ours <= 1'b0;
    end
end
always @* if (started && !rst_i) begin
    assert(f_waiting < 1 << QUEUE_BITS);
    assert(fetch == (step && f_held && !f_held_lost));
    assert(valid_o == f_port);
    if (lost) assert(f_held_lost || f_begins);
    if (f_state == F_WAITS && f_begins && f_ahead == 4'd0) assert(lost == f_stale);
    if (f_state == F_HELD) assert(f_held_lost == f_stale);
    if (valid_o && f_port_ours) begin
        assert(region_o == f_ours);
        assert(position_o == f_port_word * LANES);
        // In frames of one row the word of the next frame may be stored before the decision, and f_latest is that word.
        if (ROWS > 1 && f_port_word == f_word && !f_means) assert(pixel_o[0] == f_kept);
        if (BLOCKS > 0) assert(summary_o == f_means);
        assert(first_o == (f_port_word == 4'd0));
        assert(abort_o == (f_ended && f_port_word == f_end_word));
        assert(last_o == (abort_o || f_port_word == F_N - 1));
        assert(frame_o == f_our_frame);
    end
    if (f_lost_ours) assert(lost_valid_o && lost_region_o == f_ours && lost_frame_o == f_our_frame);
end

// ---- References of `last-sent`: every word of an active region becomes one, at its place in the frame, and no mean does
reg f_wrote = 1'b0, f_wrote_ours;                // a word was fetched at the edge before
reg [3:0] f_wrote_word;
wire [PLACE_BITS-1:0] f_frame_place = f_ours / COLUMNS * F_ROW + (f_ours % COLUMNS) * SEGMENT_WORDS
                                      + f_wrote_word / SEGMENT_WORDS * ROW_WORDS + f_wrote_word % SEGMENT_WORDS;
always @(posedge clk_i) begin
    f_wrote <= fetch && !rst_i;
    f_wrote_ours <= f_state == F_HELD;
    f_wrote_word <= f_next;
end
always @* if (started && !rst_i && LAST_SENT) begin
    if (!f_wrote) assert(!reference_write_o);
    if (f_wrote && f_wrote_ours) begin
        assert(reference_write_o == !f_means);
        if (!f_means) assert(reference_place_o == f_frame_place);
        if (!f_means && f_wrote_word == f_word) assert(reference_word_o[0] == f_kept);
    end
end
