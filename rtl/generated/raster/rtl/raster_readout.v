// SPDX-License-Identifier: MIT OR Apache-2.0
// Chooses the next region whose pixels or means leave, and the next of its words.
//
// Regions that send something wait in a queue. One of them is held, and one of its words is fetched from the buffer at each
// step; a step is an edge at which the port is free. A region is stale, and lost, once the place of its row of regions in the
// buffer is reused. docs/raster.md defines each clock ("Pixels that leave").
`default_nettype none

module raster_readout #(
    parameter LANES = 1,          // pixels of a word
    parameter SIDE = 8,           // rows of a region
    parameter SEGMENT_WORDS = 8,  // words of a row of a region: SIDE / LANES
    parameter POSITION_BITS = 6,  // ceil(log2(SIDE * SIDE))
    parameter REGION_BITS = 15,   // bits of the number of a region
    parameter ROW_WORDS = 1920,   // words of a row of the frame
    parameter START_BITS = 15,    // bits of a place in the buffer
    parameter BANKS = 2,          // rows of regions in the buffer, 2 or 3
    parameter FRAME_BITS = 8,     // bits of the number of a frame
    parameter EXTRA_BITS = 1,     // bits that stay with a region
    parameter QUEUE_BITS = 9,     // log2 of the regions that can wait
    parameter BLOCKS = 0,         // blocks of a region's side; 0: no means are sent
    parameter MEAN_BITS = 1,      // ceil(log2(BLOCKS * BLOCKS)), at least 1
    parameter DEEP = 0            // 0: a region can be held two clocks after it entered the queue; 1: three
) (
    input  wire                     clk_i,           // clock, rising edge
    input  wire                     rst_i,           // synchronous reset, active high
    input  wire                     enter_i,         // a region enters the queue
    input  wire [              2:0] row_i,           // row of regions of that region, modulo 8
    input  wire [  REGION_BITS-1:0] region_i,        // number of that region
    input  wire [   START_BITS-1:0] start_i,         // place in the buffer of the region's first word
    input  wire [   EXTRA_BITS-1:0] extra_i,         // bits that stay with the region; the highest bit says that it sends means (BLOCKS)
    input  wire [              2:0] stored_row_i,    // row of regions of the word that is stored at this edge, modulo 8
    input  wire [   FRAME_BITS-1:0] frame_i,         // number of the frame of the held region
    input  wire                     ready_i,         // the sink takes the word on the port
    output wire                     fetch_o,         // a word is fetched at this edge
    output wire [   START_BITS-1:0] place_o,         // place in the buffer of the word that is fetched
    output wire [    MEAN_BITS-1:0] mean_o,          // number of the block of the mean that is fetched (BLOCKS)
    output wire                     step_o,          // the port takes the word that was fetched at the step before
    output reg                      valid_o,         // a word is on the port
    output reg  [  REGION_BITS-1:0] region_o,        // number of the region of the word on the port
    output reg  [POSITION_BITS-1:0] position_o,      // position in its region of the first pixel of the word
    output reg                      begin_o,         // the word on the port is the first of its region
    output reg                      end_o,           // the word on the port is the last that comes of its region
    output reg                      abort_o,         // the word on the port is the last because its region was lost
    output reg  [   FRAME_BITS-1:0] frame_o,         // number of the frame of the word's region
    output wire                     summary_o,       // the word on the port is a mean (BLOCKS)
    output wire                     lost_o,          // a region is lost at this edge
    output wire [  REGION_BITS-1:0] lost_region_o,   // number of the lost region
    output wire [   EXTRA_BITS-1:0] lost_extra_o,    // extra_i of the lost region
    output wire [  REGION_BITS-1:0] held_region_o,   // number of the region that is held, or that was held or lost last
    output wire [   EXTRA_BITS-1:0] held_extra_o,    // extra_i of that region
    output wire [              2:0] held_row_o,      // row of regions of that region, modulo 8
    output wire                     first_o,         // the word that is fetched is the first of its region
    output wire                     segment_end_o,   // the word that is fetched is the last of a row of its region
    output wire                     fetch_last_o,    // the last word of a region is fetched at this edge
    output wire                     idle_o           // after this edge nothing waits, is held, fetched or on the port
);

    // Limits: a value out of range stops elaboration at an instance of a module that does not exist.
    generate
        if (BANKS != 2 && BANKS != 3) begin : g_banks BANKS_must_be_2_or_3 u_refused (); end
    endgenerate

    localparam ENTRY_BITS = 3 + REGION_BITS + START_BITS + EXTRA_BITS;
    localparam [2:0] AGE = BANKS;

    // The queue of waiting regions.
    wire take;
    wire queued;        // a region waits in the queue
    wire oldest_valid;
    wire [ENTRY_BITS-1:0] oldest;

    raster_queue #(.WIDTH(ENTRY_BITS), .BITS(QUEUE_BITS), .DEEP(DEEP)) u_queue (
        .clk_i(clk_i), .rst_i(rst_i), .enter_i(enter_i), .entry_i({extra_i, start_i, region_i, row_i}),
        .take_i(take), .valid_o(oldest_valid), .oldest_o(oldest), .waits_o(queued)
    );

    wire [2:0] oldest_row = oldest[2:0];
    wire [REGION_BITS-1:0] oldest_region = oldest[3+:REGION_BITS];
    wire [START_BITS-1:0] oldest_start = oldest[3+REGION_BITS+:START_BITS];
    wire [EXTRA_BITS-1:0] oldest_extra = oldest[3+REGION_BITS+START_BITS+:EXTRA_BITS];
    wire [2:0] oldest_age = stored_row_i - oldest_row;
    wire oldest_stale = oldest_age >= AGE;

    // The region that is held.
    reg held_q;
    reg [2:0] row_q;
    reg [REGION_BITS-1:0] held_region_q;
    reg [EXTRA_BITS-1:0] extra_q;
    wire [POSITION_BITS-1:0] position;
    wire last;
    wire [2:0] held_age = stored_row_i - row_q;
    wire held_stale = held_q && held_age >= AGE;
    wire fetch = step_o && held_q && !held_stale;
    wire fetch_last = fetch && last;

    wire means = BLOCKS > 0 && extra_q[EXTRA_BITS-1];

    assign take = oldest_valid && (!held_q || fetch_last);

    raster_walk #(
        .LANES(LANES), .SIDE(SIDE), .SEGMENT_WORDS(SEGMENT_WORDS), .POSITION_BITS(POSITION_BITS), .ROW_WORDS(ROW_WORDS),
        .PLACE_BITS(START_BITS), .BLOCKS(BLOCKS), .MEAN_BITS(MEAN_BITS)
    ) u_walk (
        .clk_i(clk_i), .begin_i(take), .start_i(oldest_start), .step_i(fetch), .means_i(means),
        .place_o(place_o), .mean_o(mean_o), .position_o(position), .first_o(first_o), .segment_end_o(segment_end_o), .last_o(last)
    );

    always @(posedge clk_i) begin
        if (take) begin
            row_q         <= oldest_row;
            held_region_q <= oldest_region;
            extra_q       <= oldest_extra;
        end
        held_q <= take ? !oldest_stale : held_q && !held_stale && !fetch_last;
        if (rst_i) held_q <= 1'b0;
    end

    // The word that was fetched, and the word on the port. While a region is held of which a word was fetched, the last fetched
    // word is of that region. So this word ends the region if it is lost.
    wire abort = held_stale && !first_o;
    reg fetched_q, fetched_first_q, fetched_last_q;
    reg aborted_q;  // the region of the fetched word is lost
    reg [FRAME_BITS-1:0] fetched_frame_q;
    reg [REGION_BITS-1:0] fetched_region_q;
    reg [POSITION_BITS-1:0] fetched_at_q;

    always @(posedge clk_i) begin
        if (step_o) begin
            fetched_q        <= fetch;
            fetched_region_q <= held_region_q;
            fetched_at_q     <= position;
            fetched_first_q  <= first_o;
            fetched_last_q   <= last;
            fetched_frame_q  <= frame_i;
            valid_o          <= fetched_q;
            region_o         <= fetched_region_q;
            position_o       <= fetched_at_q;
            begin_o          <= fetched_first_q;
            end_o            <= fetched_last_q || aborted_q || abort;
            abort_o          <= aborted_q || abort;
            frame_o          <= fetched_frame_q;
        end
        aborted_q <= !step_o && (aborted_q || abort);
        if (rst_i) begin
            fetched_q <= 1'b0;
            valid_o   <= 1'b0;
        end
    end

    generate
        if (BLOCKS > 0) begin : g_means
            reg fetched_means_q, means_q;
            always @(posedge clk_i) if (step_o) {means_q, fetched_means_q} <= {fetched_means_q, means};
            assign summary_o = means_q;
        end else begin : g_pixels
            assign summary_o = 1'b0;
        end
    endgenerate

    assign step_o = !valid_o || ready_i;
    assign fetch_o = fetch;
    assign lost_o = held_stale || (take && oldest_stale);
    assign lost_region_o = held_stale ? held_region_q : oldest_region;
    assign lost_extra_o = held_stale ? extra_q : oldest_extra;
    assign held_region_o = held_region_q;
    assign held_extra_o = extra_q;
    assign held_row_o = row_q;
    assign fetch_last_o = fetch_last;
    assign idle_o = !queued && !held_q && !fetched_q && step_o;

endmodule

`default_nettype wire
