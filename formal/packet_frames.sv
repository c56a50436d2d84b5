// SPDX-License-Identifier: MIT OR Apache-2.0
// Frames by docs/axi.md and docs/packets.md: one whose packets leave, and one that is taken after it. The modules around act only
// on frames that are under way: a region leaves or is lost once, after it was decided.
module properties #(parameter PENDING_BITS = 2, REGION_BITS = 2, ROW_BITS = 1) (
    input wire clk_i, rst_i, forget, begins, skips, sends, decided_last, row_dropped, whole, whole_frame, lost, lost_frame, opened, ended,
    input wire [63:0] now
);
    `include "reset.vh"
    wire admit, behind, busy, announced, first, frame, closed;
    wire [63:0] frame_time;
    wire [31:0] number, frames;
    wire [REGION_BITS:0] dropped;
    wire [ROW_BITS:0] dropped_rows;

    // The frame that leaves and the one after it; `under` is their number.
    reg [1:0] under;
    reg [1:0] is_open, is_decided;  // the FRAME packet has left; all regions are decided
    reg parity;                     // lowest bit of the number since reset of the older frame
    reg is_first;                   // no FRAME packet has left since then
    reg [31:0] count, number_0, number_1;
    reg [63:0] time_0, time_1;
    reg [PENDING_BITS:0] pending_0, pending_1;
    reg [REGION_BITS:0] dropped_0, dropped_1;
    reg [ROW_BITS:0] rows_0, rows_1;
    reg front;                      // the older frame was also the older one at the clock before
    wire newest = under == 2;
    wire deciding = under != 0 && !is_decided[newest];

    packet_frames #(.PENDING_BITS(PENDING_BITS), .REGION_BITS(REGION_BITS), .ROW_BITS(ROW_BITS)) dut (
        .clk_i(clk_i), .rst_i(rst_i), .forget_i(forget), .time_i(now), .begin_i(begins), .skip_i(skips),
        .decided_frame_i(parity ^ newest), .decided_last_i(decided_last), .sends_i(sends), .row_dropped_i(row_dropped),
        .whole_i(whole), .whole_frame_i(whole_frame), .lost_i(lost), .lost_frame_i(lost_frame), .opened_i(opened), .ended_i(ended),
        .admit_o(admit), .behind_o(behind), .busy_o(busy), .announced_o(announced), .first_o(first), .time_o(frame_time),
        .number_o(number), .frames_o(frames), .frame_o(frame), .closed_o(closed), .dropped_o(dropped), .dropped_rows_o(dropped_rows)
    );

    // The frame of a region: 1 for the newer one.
    wire whole_1 = whole_frame != parity, lost_1 = lost_frame != parity;
    wire [1:0] leave_0 = (whole && !whole_1) + (lost && !lost_1);
    wire [1:0] leave_1 = (whole && whole_1) + (lost && lost_1);
    always @* begin
        assume(!begins || (admit && !skips));
        assume(!(sends || decided_last || row_dropped) || deciding);
        assume(!opened || (under != 0 && !is_open[0] && announced));
        assume(!ended || (under != 0 && is_open[0] && closed));
        assume(!forget || (under == 0 && !begins));
        assume(under != 0 || leave_0 == 0);
        assume(under == 2 || leave_1 == 0);
        assume(leave_0 <= pending_0 && leave_1 <= pending_1);
        // Counters are as wide as a frame and the buffer need.
        assume(!sends || (pending_0 + pending_1 < (1 << PENDING_BITS) - 1));
        assume(!(lost && !lost_1) || dropped_0 < (1 << REGION_BITS));
        assume(!(lost && lost_1) || dropped_1 < (1 << REGION_BITS));
        assume(!row_dropped || (newest ? rows_1 : rows_0) < (1 << ROW_BITS));
    end

    // The state of each frame after this edge, before the older one ends.
    wire [1:0] now_open = {is_open[1], is_open[0] || opened};
    wire [1:0] now_decided = is_decided | (decided_last ? (newest ? 2'b10 : 2'b01) : 2'b00);
    wire [PENDING_BITS:0] now_pending_0 = pending_0 + (sends && !newest) - leave_0;
    wire [PENDING_BITS:0] now_pending_1 = pending_1 + (sends && newest) - leave_1;
    wire [REGION_BITS:0] now_dropped_0 = dropped_0 + (lost && !lost_1), now_dropped_1 = dropped_1 + (lost && lost_1);
    wire [ROW_BITS:0] now_rows_0 = rows_0 + (row_dropped && !newest), now_rows_1 = rows_1 + (row_dropped && newest);
    wire [1:0] left = under - ended;
    always @(posedge clk_i) begin
        front      <= under != 0 && !ended;
        is_open    <= now_open;
        is_decided <= now_decided;
        {pending_0, pending_1, dropped_0, dropped_1, rows_0, rows_1}
            <= {now_pending_0, now_pending_1, now_dropped_0, now_dropped_1, now_rows_0, now_rows_1};
        if (ended) begin
            parity     <= !parity;
            is_open    <= {1'b0, now_open[1]};
            is_decided <= {1'b0, now_decided[1]};
            {pending_0, dropped_0, rows_0} <= {now_pending_1, now_dropped_1, now_rows_1};
            {pending_1, dropped_1, rows_1} <= 0;
            {number_0, time_0}             <= {number_1, time_1};
        end
        if (opened) is_first <= 0;
        if (begins) begin
            if (left == 0) {number_0, time_0} <= {count, now};
            else {number_1, time_1} <= {count, now};
        end
        under <= left + begins;
        count <= count + (begins || skips);
        if (rst_i || forget) begin
            {under, is_open, is_decided, parity, front} <= 0;
            {pending_0, pending_1, dropped_0, dropped_1, rows_0, rows_1} <= 0;
            is_first <= 1;
        end
        if (rst_i) count <= 0;
    end

    always @* if (started) begin
        assert(under <= 2);
        // A frame may begin once the one before is decided and its FRAME packet has left.
        assert(admit == (under == 0 || (is_open[newest] && is_decided[newest])));
        assert(behind == (under != 0 && !is_open[newest] && is_decided[newest]));
        assert(busy == (under != 0));
        assert(frames == count);
        if (under == 0) assert(!announced);
        if (under != 0) begin
            assert(announced == !is_open[newest]);
            assert(frame == parity);
            if (!is_open[0]) assert(first == is_first && frame_time == time_0);
            if (front) assert(number == number_0);
            assert(closed == (is_decided[0] && pending_0 == 0));
            assert(dropped == dropped_0 && dropped_rows == rows_0);
        end
    end
endmodule
