// SPDX-License-Identifier: MIT OR Apache-2.0
// Sends the pixels of active regions from a buffer that holds the last rows of regions. With LAST_SENT a word becomes the
// reference one clock after it was fetched. With BLOCKS it also sends the means of irrelevant regions, from a second buffer.
// The output register is that of the buffer's memory, if nothing else uses the word that was read (READ_FOR_ITSELF).
`default_nettype none

module raster_forward #(
    parameter WORD_BITS = 8,       // bits of a word
    parameter LANES = 1,           // pixels of a word
    parameter SIDE = 8,            // rows of a region
    parameter SEGMENT_WORDS = 8,   // words of a row of a region: SIDE / LANES
    parameter COLUMNS = 240,       // regions in a row of regions
    parameter ROWS = 135,          // rows of regions
    parameter ROW_WORDS = 1920,    // words of a row of the frame
    parameter BANKS = 2,           // rows of regions in the buffer, 2 or 3
    parameter RAW = 0,             // 1: raw pixels leave; 0: the pixels that were scored
    parameter LAST_SENT = 0,       // 1: the reference is what was last sent
    parameter DEEP = 0,            // 1: one more register behind the queue of regions
    parameter POSITION_BITS = 6,   // ceil(log2(SIDE * SIDE))
    parameter REGION_BITS = 15,    // ceil(log2(COLUMNS * ROWS))
    parameter FRAME_BITS = 8,      // bits of the number of a frame, at least 2
    parameter START_BITS = 15,     // ceil(log2(BANKS * SIDE * ROW_WORDS))
    parameter PLACE_BITS = 21,     // ceil(log2(ROW_WORDS * ROWS * SIDE))
    parameter BLOCKS = 0,          // blocks of a region's side; 0: no means are sent
    parameter COLUMN_BITS = 8,     // ceil(log2(COLUMNS))
    parameter MEAN_BITS = 1        // ceil(log2(BLOCKS * BLOCKS)), at least 1
) (
    input  wire                     clk_i,                    // clock, rising edge
    input  wire                     rst_i,                    // synchronous reset, active high
    input  wire                     store_i,                  // a word is stored at this edge
    input  wire [   START_BITS-1:0] store_place_i,            // place in the buffer of that word
    input  wire [    WORD_BITS-1:0] scored_i,                 // the word that is stored, as it was scored
    input  wire [    WORD_BITS-1:0] raw_i,                    // the same word before the filter (RAW)
    input  wire                     arriving_i,               // a word is stored at the next edge
    input  wire                     rows_end_i,               // that word is the last of a row of regions
    input  wire                     decision_i,               // a region is decided, in the order of the regions
    input  wire                     active_i,                 // the decided region is active, so that its pixels leave
    input  wire [  REGION_BITS-1:0] region_i,                 // number of the decided region
    input  wire                     last_region_i,            // the decided region is the last of its frame
    input  wire                     mark_i,                   // a mark that stays with the region
    input  wire                     summary_i,                // the means of the decided region are sent (BLOCKS)
    input  wire                     mean_valid_i,             // a mean is stored at this edge (BLOCKS)
    input  wire [  COLUMN_BITS-1:0] mean_region_i,            // low bits of the number of the region of that mean
    input  wire [              1:0] mean_row_i,               // row of regions of that mean, modulo 4
    input  wire [    MEAN_BITS-1:0] mean_number_i,            // number of the block of that mean in its region
    input  wire [WORD_BITS/LANES-1:0] mean_i,                 // the mean that is stored
    input  wire                     ready_i,                  // the sink takes the word on the port
    output wire                     valid_o,                  // a word is on the port
    output wire [  REGION_BITS-1:0] region_o,                 // number of the region of the word on the port
    output wire [POSITION_BITS-1:0] position_o,               // position in its region of the first pixel of the word
    output wire [    WORD_BITS-1:0] pixel_o,                  // the word on the port
    output wire                     first_o,                  // the word on the port is the first of its region
    output wire                     last_o,                   // the word on the port is the last that comes of its region
    output wire                     abort_o,                  // the word on the port is the last because its region was lost in the middle
    output wire [   FRAME_BITS-1:0] frame_o,                  // number since reset of the frame of the word's region
    output wire                     summary_o,                // the word on the port is a mean (BLOCKS)
    output reg                      lost_o,                   // at least one region was lost since reset
    output reg  [             15:0] lost_count_o,             // number of lost regions, up to the largest number of this width
    output reg                      lost_valid_o,             // a region was lost at the last edge
    output wire [  REGION_BITS-1:0] lost_region_o,            // number of the lost region
    output wire [   FRAME_BITS-1:0] lost_frame_o,             // number since reset of the frame of the lost region
    output wire                     idle_o,                   // after this edge nothing waits, is held, fetched or on the port
    output wire                     reference_write_o,        // a word that was fetched becomes a reference (LAST_SENT)
    output wire [   PLACE_BITS-1:0] reference_place_o,        // number of that word in the frame
    output wire [    WORD_BITS-1:0] reference_word_o,         // the word that becomes a reference
    output wire                     lost_reference_o,         // a region is lost at this edge (LAST_SENT)
    output wire [  REGION_BITS-1:0] lost_reference_region_o,  // number of the lost region
    output wire                     lost_mark_o,              // mark_i of the lost region
    output wire                     done_o,                   // all words of a region are fetched, or it was lost one clock ago (BLOCKS)
    output wire                     done_lost_o,              // with done_o: the region was lost
    output wire [  REGION_BITS-1:0] done_region_o,            // number of that region
    output wire                     sent_o,                   // a mean was fetched two clocks ago (BLOCKS)
    output wire [  REGION_BITS-1:0] sent_region_o,            // number of the region of that mean
    output wire [    MEAN_BITS-1:0] sent_number_o,            // number of the block of that mean in its region
    output wire [WORD_BITS/LANES-1:0] sent_mean_o             // the mean that was fetched
);

    localparam WORDS = BANKS * SIDE * ROW_WORDS;
    localparam READ_FOR_ITSELF = !LAST_SENT || RAW;  // 1: only the port uses the word that the buffer reads
    localparam QUEUE_BITS = $clog2(BANKS * COLUMNS);  // log2 of the regions in the buffer: all of them may wait
    localparam FRAME_PLACE_BITS = LAST_SENT ? PLACE_BITS : 1;
    // A waiting region keeps only the low bits of its frame's number. Until it is held or lost, the row of regions that is decided
    // is at most BANKS rows after it, so that the other bits are known.
    localparam LOW_BITS = ROWS < BANKS ? 2 : 1;
    localparam PIXEL_BITS = LOW_BITS + (LAST_SENT ? PLACE_BITS + 1 : 0);
    localparam EXTRA_BITS = PIXEL_BITS + (BLOCKS > 0 ? 1 : 0);

    // Limits: a value out of range stops elaboration at an instance of a module that does not exist.
    generate
        if (FRAME_BITS < 2) begin : g_frame_bits FRAME_BITS_must_be_2_or_more u_refused (); end
    endgenerate

    // The row of regions of the word that is stored, modulo 8.
    reg fresh_row_q;  // the next word is the first of a row of regions
    reg [2:0] stored_row_q;
    always @(posedge clk_i) begin
        if (arriving_i) begin
            fresh_row_q <= rows_end_i;
            if (fresh_row_q) stored_row_q <= stored_row_q + 1'b1;
        end
        if (rst_i) begin
            fresh_row_q  <= 1'b0;
            stored_row_q <= 3'd0;
        end
    end

    // The places in the buffer and in the frame where the decided region starts.
    wire [2:0] decided_row;
    wire [START_BITS-1:0] decided_start;
    wire [FRAME_PLACE_BITS-1:0] decided_place;
    wire [EXTRA_BITS-1:0] entered_extra, lost_extra, held_extra;

    raster_start #(
        .COLUMNS(COLUMNS), .ROWS(ROWS), .SEGMENT_WORDS(SEGMENT_WORDS), .SIDE(SIDE), .BANKS(BANKS), .START_BITS(START_BITS),
        .FRAME(LAST_SENT), .PLACE_BITS(FRAME_PLACE_BITS)
    ) u_start (
        .clk_i(clk_i), .rst_i(rst_i), .step_i(decision_i), .row_o(decided_row), .start_o(decided_start),
        .place_o(decided_place)
    );

    // The frame of the decided region, and the frame of the region that is held or was lost.
    reg [FRAME_BITS-1:0] frame_q;
    wire [LOW_BITS-1:0] frames_ago = frame_q[LOW_BITS-1:0] - held_extra[LOW_BITS-1:0];
    wire [FRAME_BITS-1:0] held_frame = frame_q - {{(FRAME_BITS - LOW_BITS) {1'b0}}, frames_ago};
    always @(posedge clk_i) begin
        if (rst_i) frame_q <= {FRAME_BITS{1'b0}};
        else if (decision_i && last_region_i) frame_q <= frame_q + 1'b1;
    end

    wire fetch, step, lost, fetch_first, fetch_segment_end, fetch_last;
    wire [START_BITS-1:0] fetch_place;
    wire [MEAN_BITS-1:0] fetch_mean;
    wire [2:0] held_row;
    wire [WORD_BITS-1:0] fetched;

    raster_readout #(
        .LANES(LANES), .SIDE(SIDE), .SEGMENT_WORDS(SEGMENT_WORDS), .POSITION_BITS(POSITION_BITS), .REGION_BITS(REGION_BITS),
        .ROW_WORDS(ROW_WORDS), .START_BITS(START_BITS), .BANKS(BANKS), .FRAME_BITS(FRAME_BITS),
        .EXTRA_BITS(EXTRA_BITS), .QUEUE_BITS(QUEUE_BITS), .BLOCKS(BLOCKS), .MEAN_BITS(MEAN_BITS), .DEEP(DEEP)
    ) u_readout (
        .clk_i(clk_i), .rst_i(rst_i), .enter_i(active_i || (BLOCKS > 0 && summary_i)), .row_i(decided_row), .region_i(region_i),
        .start_i(decided_start), .extra_i(entered_extra), .stored_row_i(stored_row_q), .frame_i(held_frame),
        .ready_i(ready_i), .fetch_o(fetch), .place_o(fetch_place), .mean_o(fetch_mean), .step_o(step), .valid_o(valid_o), .region_o(region_o),
        .position_o(position_o), .begin_o(first_o), .end_o(last_o), .abort_o(abort_o), .frame_o(frame_o), .summary_o(summary_o),
        .lost_o(lost), .lost_region_o(lost_reference_region_o), .lost_extra_o(lost_extra),
        .held_region_o(lost_region_o), .held_extra_o(held_extra), .held_row_o(held_row), .first_o(fetch_first),
        .segment_end_o(fetch_segment_end), .fetch_last_o(fetch_last), .idle_o(idle_o)
    );

    // The condition for a fetch comes late in a clock, so a word is read at every step.
    wire [WORD_BITS-1:0] pixel;
    raster_memory #(
        .WIDTH(WORD_BITS), .WORDS(WORDS), .ADDRESS_BITS(START_BITS), .OUTPUT_STAGE(READ_FOR_ITSELF)
    ) u_buffer (
        .clk_i(clk_i), .write_i(store_i), .write_address_i(store_place_i), .data_i(RAW ? raw_i : scored_i),
        .read_i(step), .read_address_i(fetch_place), .output_i(step), .data_o(fetched)
    );
    generate
        if (READ_FOR_ITSELF) begin : g_port
            assign pixel = fetched;
        end else begin : g_register
            reg [WORD_BITS-1:0] pixel_q;
            always @(posedge clk_i) if (step) pixel_q <= fetched;
            assign pixel = pixel_q;
        end
    endgenerate

    assign lost_frame_o = held_frame;
    always @(posedge clk_i) begin
        lost_valid_o <= lost;
        if (lost) begin
            lost_o <= 1'b1;
            if (lost_count_o != 16'hFFFF) lost_count_o <= lost_count_o + 1'b1;
        end
        if (rst_i) begin
            lost_o       <= 1'b0;
            lost_count_o <= 16'd0;
            lost_valid_o <= 1'b0;
        end
    end

    generate
        if (!RAW) begin : g_scored
            wire unused_raw = |raw_i;
        end
        if (LAST_SENT) begin : g_sent
            // A word fetched while means leave is not a sent pixel. The walk through the words also runs beyond the region then.
            wire means = BLOCKS > 0 && held_extra[EXTRA_BITS-1];
            reg fetched_q;
            reg [PLACE_BITS-1:0] sent_place_q, next_place_q;
            wire [PLACE_BITS-1:0] place = fetch_first ? held_extra[LOW_BITS+:PLACE_BITS] : next_place_q;
            localparam JUMP = ROW_WORDS - SEGMENT_WORDS + 1;
            always @(posedge clk_i) begin
                fetched_q <= fetch && !means && !rst_i;
                if (fetch) begin
                    sent_place_q <= place;
                    next_place_q <= place + (fetch_segment_end ? JUMP[PLACE_BITS-1:0] : {{(PLACE_BITS - 1) {1'b0}}, 1'b1});
                end
            end
            assign reference_write_o = fetched_q;
            assign reference_place_o = sent_place_q;
            if (RAW) begin : g_denoised
                raster_memory #(.WIDTH(WORD_BITS), .WORDS(WORDS), .ADDRESS_BITS(START_BITS)) u_denoised (
                    .clk_i(clk_i), .write_i(store_i), .write_address_i(store_place_i), .data_i(scored_i),
                    .read_i(step), .read_address_i(fetch_place), .output_i(1'b1), .data_o(reference_word_o)
                );
            end else begin : g_same
                assign reference_word_o = fetched;
            end
            wire unused_mark = held_extra[PIXEL_BITS-1] || |lost_extra;
            assign entered_extra[PIXEL_BITS-1:0] = {mark_i, decided_place, frame_q[LOW_BITS-1:0]};
            assign lost_reference_o = lost;
            assign lost_mark_o = lost_extra[PIXEL_BITS-1];
        end else begin : g_previous
            wire unused_places = |decided_place || |lost_extra || fetch_first || fetch_segment_end || mark_i;
            assign entered_extra[PIXEL_BITS-1:0] = frame_q[LOW_BITS-1:0];
            assign reference_write_o = 1'b0;
            assign reference_word_o = {WORD_BITS{1'b0}};
            assign reference_place_o = {PLACE_BITS{1'b0}};
            assign lost_reference_o = 1'b0;
            assign lost_mark_o = 1'b0;
        end
    endgenerate

    // The means. lost_region_o also numbers the held region; its low bits distinguish the regions of a row. The word for the port
    // is selected behind registers, because a memory shows late in a clock what it has read. A fetch of a region that sends
    // pixels also writes where its sent means are kept; the screen shows no summary of it, so these means are not used.
    generate
        if (BLOCKS > 0) begin : g_means
            localparam WIDTH = WORD_BITS / LANES;
            localparam ROW_BITS = BANKS > 2 ? 2 : 1;
            localparam MEANS = BLOCKS * BLOCKS << (ROW_BITS + COLUMN_BITS);
            localparam AT_BITS = $clog2(MEANS);
            wire [ROW_BITS+COLUMN_BITS+MEAN_BITS-1:0] stored_at = {mean_row_i[ROW_BITS-1:0], mean_region_i, mean_number_i};
            wire [ROW_BITS+COLUMN_BITS+MEAN_BITS-1:0] fetched_at = {held_row[ROW_BITS-1:0], lost_region_o[COLUMN_BITS-1:0], fetch_mean};
            // With one block, a mean has no number.
            wire unused_bits = |mean_row_i || |held_row || stored_at[0] || fetched_at[0] || held_extra[EXTRA_BITS-1];
            localparam LOWEST = BLOCKS == 1 ? MEAN_BITS : 0;
            // The word that the memory has read goes on, at every clock, to the sent means. So the port keeps its own copy.
            wire [WIDTH-1:0] mean;
            reg [WIDTH-1:0] kept_q;
            reg stepped_q;
            wire [WIDTH-1:0] shown = stepped_q ? mean : kept_q;
            always @(posedge clk_i) begin
                stepped_q <= step;
                kept_q    <= shown;
            end
            raster_memory #(.WIDTH(WIDTH), .WORDS(MEANS), .ADDRESS_BITS(AT_BITS), .OUTPUT_STAGE(1)) u_means (
                .clk_i(clk_i), .write_i(mean_valid_i), .write_address_i(stored_at[LOWEST+:AT_BITS]), .data_i(mean_i),
                .read_i(step), .read_address_i(fetched_at[LOWEST+:AT_BITS]), .output_i(1'b1), .data_o(mean)
            );
            assign sent_mean_o = mean;
            bit_delay #(.DEPTH(2)) u_sent (.clk_i(clk_i), .rst_i(rst_i), .bit_i(fetch), .bit_o(sent_o));
            word_delay #(.WIDTH(REGION_BITS + MEAN_BITS), .DEPTH(2)) u_sent_at (
                .clk_i(clk_i), .data_i({lost_region_o, fetch_mean}), .data_o({sent_region_o, sent_number_o})
            );
            assign pixel_o = summary_o ? {LANES{shown}} : pixel;
            assign entered_extra[EXTRA_BITS-1] = summary_i;
            // One clock after its loss a lost region is no longer held, but its number is still there.
            assign done_o = fetch_last || lost_valid_o;
            assign done_lost_o = lost_valid_o;
            assign done_region_o = lost_region_o;
        end else begin : g_pixels
            wire unused_means = mean_valid_i || |mean_region_i || |mean_row_i || |mean_number_i || |mean_i || |fetch_mean || |held_row
                                || fetch_last || fetch;
            assign pixel_o = pixel;
            assign {done_o, done_lost_o, done_region_o} = {(2 + REGION_BITS) {1'b0}};
            assign sent_o = 1'b0;
            assign sent_region_o = {REGION_BITS{1'b0}};
            assign sent_number_o = {MEAN_BITS{1'b0}};
            assign sent_mean_o = {(WORD_BITS / LANES) {1'b0}};
        end
    endgenerate

endmodule

`default_nettype wire
