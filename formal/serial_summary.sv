// SPDX-License-Identifier: MIT OR Apache-2.0
// An arbitrary region is followed: the sums of its blocks in order, its decision, and its means as they leave. The sent values
// must be those of the contract.
module properties #(
    parameter WIDTH = 1, parameter MEANS = 4, parameter AREA = 4, parameter SUM_BITS = 3, parameter FACTOR_BITS = 1,
    parameter [FACTOR_BITS-1:0] FACTOR = 1, parameter SHIFT = 2, parameter ZONES = 0
) (
    input wire clk_i, rst_i, frame, average, decided, srs, trs,
    input wire [1:0] next_region, next_class, next_map, input wire [(MEANS > 1 ? $clog2(MEANS) : 1)-1:0] next_block,
    input wire [SUM_BITS-1:0] sum
);
    `include "reset.vh"
    localparam BLOCK_BITS = MEANS > 1 ? $clog2(MEANS) : 1;
    localparam SLOTS = 3;
    (* anyconst *) wire [1:0] watched;
    (* anyconst *) wire [WIDTH-1:0] level, keen_level, off_level;
    reg [1:0] region;
    // The class of the region that passes. That of the watched region changes only with a frame.
    reg [1:0] passing_class, watched_class;
    reg [BLOCK_BITS-1:0] block;
    always @(posedge clk_i) begin
        region <= next_region;
        block  <= next_block;
        passing_class <= next_class;
        if (rst_i || frame) watched_class <= next_map;
    end
    wire [WIDTH-1:0] own_level = !ZONES ? level : watched_class == 2 ? keen_level : watched_class == 1 ? off_level : level;
    wire here = region == watched;

    // The sequencer: sums of all blocks, block by block; some idle clocks; decisions; the frame is done.
    reg [4:0] averaged;  // number of blocks of the watched region that have passed
    reg decides;         // decisions are made, and means leave
    reg done;            // the watched region is decided
    reg [2:0] since;     // clocks since a sum has passed
    always @* begin
        assume(watched < SLOTS);
        assume(next_region < SLOTS && next_block < MEANS);
        assume(sum <= AREA * ((1 << WIDTH) - 1) + AREA / 2);
        assume(!average || !decided);
        if (average) assume(!decides);
        if (average && here) assume(block == averaged && averaged < MEANS);
        if (decided) assume(since > 2);
        if (decided && here) assume(averaged == MEANS && !done);
        if (frame) assume(done && !average && !decided);
        if (here) assume(passing_class == watched_class);
    end
    always @(posedge clk_i) begin
        since <= average ? 0 : since == 7 ? 7 : since + 1;
        if (rst_i || frame) begin
            averaged <= 0;
            decides  <= 0;
            done     <= 0;
        end else begin
            if (average && here) averaged <= averaged + 1;
            if (decided) decides <= 1;
            if (decided && here) done <= 1;
        end
    end

    wire summary;
    wire [WIDTH-1:0] mean;
    serial_summary #(
        .WIDTH(WIDTH), .MEANS(MEANS), .BLOCK_BITS(BLOCK_BITS), .SUM_BITS(SUM_BITS), .FACTOR_BITS(FACTOR_BITS),
        .FACTOR(FACTOR), .SHIFT(SHIFT), .SLOTS(SLOTS), .REGION_BITS(2), .ZONES(ZONES)
    ) dut (
        .clk_i(clk_i), .rst_i(rst_i), .frame_i(frame), .next_region_i(next_region), .next_block_i(next_block),
        .region_i(region), .block_i(block), .average_i(average), .sum_i(sum), .decided_i(decided),
        .srs_i(decided && srs), .active_i(decided && srs && trs), .level_i(level),
        .keen_level_i(keen_level), .off_level_i(off_level), .class_i(passing_class), .summary_o(summary), .mean_o(mean)
    );

    // The values by the contract.
    reg [WIDTH*MEANS-1:0] means, shown;
    reg shows, differs;
    localparam [SUM_BITS-1:0] DIVISOR = AREA;  // no wider than the sum, because a divider of 32 bits takes Yosys seconds
    wire [WIDTH-1:0] now = sum / DIVISOR;
    wire [WIDTH*MEANS-1:0] shown_here = shown >> (WIDTH * block);
    wire [WIDTH-1:0] old = shown_here[WIDTH-1:0];
    wire due = !srs && (!shows || differs);
    always @(posedge clk_i) begin
        if (average && here) begin
            means[WIDTH*block+:WIDTH] <= now;
            differs <= (averaged != 0 && differs) || (now > old ? now - old : old - now) > own_level;
        end
        if (rst_i) shows <= 0;
        else if (decided && here) begin
            shows <= !(srs && trs) && (shows || due);
            if (due) shown <= means;
        end
    end
    always @* if (started) begin
        if (!decided) assert(!summary);
        if (decided && here) assert(summary == due);
        // The shown mean can be read whenever no sum passes.
        if (here && shows && done) assert(mean == old);
    end
endmodule
