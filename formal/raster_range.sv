// SPDX-License-Identifier: MIT OR Apache-2.0
// The range of every region comes after its last word, and is the largest minus the smallest of its pixels. Frames are 4
// regions wide and follow one another; words come with gaps of any length, and a reset at any clock.
module properties #(parameter LANES = 1, parameter DEEP = 0) (
    input wire clk_i, rst_i, step, input wire [2*LANES-1:0] pixels
);
    `include "reset.vh"
    localparam SIDE = 2, WORDS = SIDE / LANES;  // words of a row of a region
    reg [1:0] word = 2'd0, column = 2'd0;
    reg row = 1'b0;
    wire segment_end = word == WORDS - 1;
    wire row_end = segment_end && column == 2'd3;
    always @(posedge clk_i) begin
        if (step) begin
            word <= segment_end ? 2'd0 : word + 2'd1;
            if (segment_end) column <= column + 2'd1;
            if (row_end) row <= !row;
        end
        if (rst_i) {word, column, row} <= 5'd0;
    end

    // A word comes two clocks before its step, so the first clock with a step is the third.
    reg [4*LANES-1:0] earlier = 0;
    reg second = 1'b0;
    always @(posedge clk_i) begin
        earlier <= {earlier, pixels};
        second <= started;
    end
    always @* if (!second) assume(!step);
    wire [2*LANES-1:0] stepped = earlier[2*LANES+:2*LANES];
    wire [1:0] range;
    raster_range #(.WIDTH(2), .LANES(LANES), .COLUMNS(4), .DEEP(DEEP)) dut (
        .clk_i(clk_i), .rst_i(rst_i), .word_i(pixels), .step_i(step), .segment_end_i(segment_end), .row_end_i(row_end),
        .region_top_i(!row), .range_o(range)
    );

    // The region of an arbitrary column: a bit for each value that it has had.
    (* anyconst *) wire [1:0] place;
    reg [3:0] had = 0;
    reg [3:0] now;
    reg [1:0] low, high;
    integer lane, each;
    always @* begin
        now = !row && word == 2'd0 ? 4'd0 : had;
        for (lane = 0; lane < LANES; lane = lane + 1) now = now | 4'd1 << stepped[2*lane+:2];
        low = 0;
        high = 0;
        for (each = 0; each < 4; each = each + 1) if (now[each]) high = each;
        for (each = 3; each >= 0; each = each - 1) if (now[each]) low = each;
    end
    // The expected port: the range comes three clocks after the last word, with DEEP four.
    reg [2+DEEP:0] due = 0;
    reg [2*(3+DEEP)-1:0] ranges = 0;
    always @(posedge clk_i) begin
        if (step && column == place) had <= now;
        due <= rst_i ? 0 : {due, step && segment_end && row && column == place};
        ranges <= {ranges, high - low};
    end
    always @* if (started && due[2+DEEP]) assert(range == ranges[2*(2+DEEP)+:2]);
endmodule
