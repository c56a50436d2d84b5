// SPDX-License-Identifier: MIT OR Apache-2.0
// A queue of regions: a whole region waits with its pixels or means in lanes, as in docs/packets.md, and a region that is lost
// on the way never appears. An arbitrary region and an arbitrary one of its values are followed through the queue.
module properties #(parameter WIDTH = 1, LANES = 1, PIXELS = 4, MEANS = 0, COLUMNS = 2, REGION_BITS = 3, BITS = 16, PART_BITS = 2, PLACE_BITS = 2) (
    input wire clk_i, rst_i, valid, last, abort, frame, summary, read, take, follow, input wire [REGION_BITS-1:0] region,
    input wire [LANES*WIDTH-1:0] given, input wire [PART_BITS-1:0] part
);
    `include "reset.vh"
    localparam COLUMN_BITS = $clog2(COLUMNS);
    localparam LANE = WIDTH > 8 ? 16 : 8;
    localparam SENT = (PIXELS * LANE + 63) / 64 * 64 / LANE;  // number of lanes of the packet
    localparam IN_PART = BITS / LANE;
    localparam LATE = REGION_BITS - COLUMN_BITS + 2;          // number of clocks in which row and column are found
    wire ready, whole, whole_frame, waits, waits_frame, waits_summary;
    wire [REGION_BITS-COLUMN_BITS:0] row;
    wire [COLUMN_BITS-1:0] column;
    wire [BITS-1:0] found;

    // The input: a number of words of a region, or fewer and a loss.
    reg inside, own_summary;
    reg [7:0] words;
    wire [7:0] all_words = summary ? MEANS : PIXELS / LANES;
    packet_regions #(
        .WIDTH(WIDTH), .LANES(LANES), .PIXELS(PIXELS), .MEANS(MEANS), .COLUMNS(COLUMNS), .COLUMN_BITS(COLUMN_BITS),
        .REGION_BITS(REGION_BITS), .BITS(BITS), .PART_BITS(PART_BITS), .PLACE_BITS(PLACE_BITS)
    ) dut (
        .clk_i(clk_i), .rst_i(rst_i), .valid_i(valid), .region_i(region), .pixel_i(given), .first_i(!inside), .last_i(last),
        .abort_i(abort), .frame_i(frame), .summary_i(summary), .ready_o(ready), .whole_o(whole), .whole_frame_o(whole_frame),
        .valid_o(waits), .valid_frame_o(waits_frame), .summary_o(waits_summary), .row_o(row), .column_o(column), .read_i(read),
        .part_i(part), .part_o(found), .take_i(take)
    );
    wire comes = valid && ready;
    wire ends = comes && last && !abort;
    always @* begin
        assume(!take || waits);
        assume(MEANS != 0 || !summary);
        assume(!valid || !inside || summary == own_summary);
        assume(!valid || last == (abort || words + 1 == all_words));
        // A mean is on every pixel of its word.
        assume(!summary || given == {LANES{given[WIDTH-1:0]}});
    end
    always @(posedge clk_i) begin
        if (comes) begin
            inside      <= !last;
            own_summary <= summary;
            words       <= last ? 0 : words + 1;
        end
        if (rst_i) {inside, words} <= 0;
    end

    // The waiting regions; and a region that has come but is not yet known to be whole, with the clocks since then.
    reg [PLACE_BITS:0] waiting;
    reg late;
    reg [3:0] late_clocks;
    reg of_frame;
    wire its_frame = comes && !inside ? frame : of_frame;
    always @(posedge clk_i) begin
        waiting     <= waiting + whole - take;
        late        <= (ends || late) && !whole;
        late_clocks <= late ? late_clocks + 1 : 0;
        if (comes && !inside) of_frame <= frame;
        if (rst_i) {waiting, late, late_clocks} <= 0;
    end

    // The followed region: it comes, or it has come and `ahead` others are in front of it.
    (* anyconst *) reg [7:0] value;
    always @* assume(value < SENT);
    reg follows, has_come, its_summary;
    reg [PLACE_BITS:0] ahead;
    reg [REGION_BITS-1:0] its_region;
    reg [WIDTH-1:0] its_value;
    reg its_own_frame;
    wire begins = comes && !inside && follow && !follows;
    wire is_it = begins || (follows && !has_come);
    wire [7:0] here = value - words * (summary ? 1 : LANES);
    wire is_head = follows && has_come && ahead == 0;
    wire [LANE-1:0] lane = found >> value % IN_PART * LANE;
    always @(posedge clk_i) begin
        if (begins) {follows, has_come, its_summary, its_region, its_own_frame} <= {2'b10, summary, region, frame};
        if (comes && is_it && here < (summary ? 1 : LANES)) its_value <= given >> here * WIDTH;
        if (comes && is_it && abort) follows <= 0;
        if (whole && is_it && !(comes && abort)) begin
            has_come <= 1;
            ahead    <= waiting - take;
        end else if (take && has_come) begin
            ahead <= ahead - 1;
            if (ahead == 0) {follows, has_come} <= 0;
        end
        if (rst_i) {follows, has_come} <= 0;
    end

    // The part of the followed region that was read last, one clock ago or earlier.
    reg was_read;
    reg [WIDTH-1:0] wanted;
    wire [7:0] its_count = its_summary ? MEANS : PIXELS;
    always @(posedge clk_i) begin
        if (read) begin
            was_read <= is_head && part == value / IN_PART;
            wanted   <= value < its_count ? its_value : 0;
        end
        if (rst_i) was_read <= 0;
    end

    always @* if (started) begin
        // A region is whole once, after its last word, in time.
        assert(!whole || ends || late);
        if (whole) assert(whole_frame == its_frame);
        assert(!late || late_clocks < LATE);
        assert(waiting <= 1 << PLACE_BITS);
        assert(waits == (waiting != 0));
        assert(ready || waiting == 1 << PLACE_BITS || late);
        if (is_head) begin
            assert(waits_frame == its_own_frame && waits_summary == its_summary);
            assert(row == its_region / COLUMNS && column == its_region % COLUMNS);
        end
        if (was_read) assert(lane == wanted);
    end
endmodule
