// SPDX-License-Identifier: MIT OR Apache-2.0
// The rules of docs/raster.md under "Holding", "Steps" and "Lost regions", edge by edge, for every stall of the sink. The order of
// events of all regions is followed. An arbitrary region is watched from the queue to the port: it is held in its turn, its words
// leave once and in order, and it is lost exactly if it is stale. For all regions, a word is a first one exactly if the word before it
// was the last of its region.
module properties #(
    parameter LANES = 1, parameter SIDE = 2, parameter BANKS = 2, parameter DEEP = 0
) (
    input wire clk_i, rst_i, enter, pick, next_row, ready,
    input wire [2:0] some_row, input wire [1:0] some_region, input wire [3:0] some_start, input wire some_extra,
    input wire frame
);
    `include "reset.vh"
    localparam SEGMENT_WORDS = SIDE / LANES, ROW_WORDS = 5, QUEUE_WORDS = 4, POSITION_BITS = $clog2(SIDE * SIDE);
    localparam [4:0] LAST = SIDE * SIDE / LANES - 1;  // number of the last word of a region
    localparam WAIT = DEEP ? 3 : 2;                   // edges from the queue to the hold

    // The watched region, and by how many rows of regions the stored word is further down.
    (* anyconst *) wire [2:0] row;
    (* anyconst *) wire [1:0] region;
    (* anyconst *) wire [3:0] start;
    (* anyconst *) wire extra;
    localparam NONE = 2'd0, WAITS = 2'd1, HELD = 2'd2, OVER = 2'd3;
    reg [1:0] state = NONE;
    wire watched = enter && pick && state == NONE;
    reg [2:0] stored_row = 3'd0;
    reg [3:0] distance;
    wire [2:0] at_first = stored_row - row;
    wire stale = distance >= BANKS;

    wire fetch, step, valid, lost, lost_extra, held_extra, first, segment_end, idle;
    wire [3:0] place;
    wire begin_o, end_o, abort_o, frame_o;
    wire [1:0] region_o, lost_region, held_region;
    wire [POSITION_BITS-1:0] position_o;
    raster_readout #(
        .LANES(LANES), .SIDE(SIDE), .SEGMENT_WORDS(SEGMENT_WORDS), .POSITION_BITS(POSITION_BITS), .REGION_BITS(2),
        .ROW_WORDS(ROW_WORDS), .START_BITS(4), .BANKS(BANKS), .FRAME_BITS(1), .EXTRA_BITS(1), .QUEUE_BITS(2),
        .DEEP(DEEP)
    ) dut (
        .clk_i(clk_i), .rst_i(rst_i), .enter_i(enter), .row_i(watched ? row : some_row),
        .region_i(watched ? region : some_region), .start_i(watched ? start : some_start),
        .extra_i(watched ? extra : some_extra), .stored_row_i(stored_row), .frame_i(frame), .ready_i(ready), .fetch_o(fetch),
        .place_o(place), .step_o(step), .valid_o(valid), .region_o(region_o), .position_o(position_o),
        .begin_o(begin_o), .end_o(end_o), .abort_o(abort_o), .frame_o(frame_o), .lost_o(lost),
        .lost_region_o(lost_region), .lost_extra_o(lost_extra), .held_region_o(held_region), .held_extra_o(held_extra),
        .first_o(first), .segment_end_o(segment_end), .idle_o(idle)
    );

    // The state by docs/raster.md. The outputs say which of the other regions are stale.
    reg [2:0] waiting = 3'd0;      // number of regions in the queue
    reg [2:0] ahead;               // number of regions in front of the watched one
    reg [1:0] entered = 2'd0;      // one bit per edge before: a region entered then
    wire [2:0] recent = entered[0] + (DEEP ? entered[1] : 1'b0);
    reg [1:0] since = 2'd2;        // edges since the readout last started to hold a region, up to 2
    reg held = 1'b0;
    reg [4:0] word;                // number of the word of the held region that is fetched next
    wire last = fetch && word == LAST;
    wire held_lost = held && lost && !fetch;
    wire begins = (!held || last) && waiting > recent && since == 2'd2;
    // The word fetched at the step before, and the word on the port: whether it is of the watched region, and its number.
    reg fetched = 1'b0, fetched_ours, port = 1'b0, port_ours;
    reg [4:0] fetched_word, port_word;
    reg fetched_frame, port_frame;
    // The watched region was lost at the edge before; it was lost in the middle, after this word was fetched as its last.
    reg lost_ours = 1'b0, ended = 1'b0;
    reg [4:0] end_word;
    reg open = 1'b0;               // the word that was taken last is not the last of its region
    always @(posedge clk_i) begin
        if (next_row) stored_row <= stored_row + 3'd1;
        distance <= (watched ? {1'b0, at_first} : distance) + next_row;
        waiting <= waiting + enter - begins;
        entered <= {entered[0], enter};
        since <= begins ? 2'd1 : 2'd2;
        held <= begins ? !lost : held && !held_lost && !last;
        word <= begins ? 5'd0 : word + fetch;
        if (watched) begin
            state <= WAITS;
            ahead <= waiting - begins;
        end
        if (state == WAITS && begins) begin
            ahead <= ahead - 3'd1;
            if (ahead == 3'd0) state <= lost ? OVER : HELD;
        end
        if (state == HELD && (held_lost || last)) state <= OVER;
        if (step) begin
            fetched <= fetch;
            fetched_ours <= state == HELD;
            fetched_word <= word;
            fetched_frame <= frame;
            port_frame <= fetched_frame;
            port <= fetched;
            port_ours <= fetched_ours;
            port_word <= fetched_word;
        end
        lost_ours <= lost && (state == HELD ? held_lost : state == WAITS && begins && ahead == 3'd0);
        if (state == HELD && held_lost && word != 5'd0) begin
            ended <= 1'b1;
            end_word <= word - 5'd1;
        end
        if (valid && ready) open <= !end_o;
        if (rst_i) begin
            lost_ours <= 1'b0;
            ended   <= 1'b0;
            open    <= 1'b0;
            waiting <= 3'd0;
            entered <= 2'd0;
            since   <= 2'd2;
            held    <= 1'b0;
            state   <= NONE;
            fetched <= 1'b0;
            port    <= 1'b0;
        end
    end

    always @* begin
        // The queue has room for all regions of the buffer; rows of regions pass more slowly than stale regions leave the queue.
        assume(!(enter && waiting == QUEUE_WORDS - 1));
        if (watched) assume(at_first <= BANKS);
        if (state == WAITS || state == HELD) assume(distance <= 7);
    end

    always @* if (started && !rst_i) begin
        assert(step == (!port || ready));
        assert(valid == port);
        assert(fetch == (step && held && !held_lost));
        if (lost) assert(held_lost || begins);
        assert(idle == (waiting == 3'd0 && !held && !fetched && step));
        if (fetch) begin
            assert(first == (word == 5'd0));
            assert(segment_end == (word % SEGMENT_WORDS == SEGMENT_WORDS - 1));
        end
        if (state == WAITS && begins && ahead == 3'd0) assert(lost == stale);
        if (state == HELD) begin
            assert(held && held_lost == stale);
            assert(held_extra == extra);
        end
        if (lost && ((state == WAITS && begins && ahead == 3'd0) || state == HELD && held_lost)) begin
            assert(lost_region == region);
            assert(lost_extra == extra);
        end
        if (fetch && state == HELD) assert(place == 4'(start + word / SEGMENT_WORDS * ROW_WORDS + word % SEGMENT_WORDS));
        if (valid && port_ours) begin
            assert(region_o == region);
            assert(position_o == port_word * LANES);
            assert(abort_o == (ended && port_word == end_word));
            assert(end_o == (abort_o || port_word == LAST));
            assert(frame_o == port_frame);
        end
        if (valid) assert(begin_o == !open);
        if (lost_ours) begin
            assert(held_region == region);
            assert(held_extra == extra);
        end
    end
endmodule
