// SPDX-License-Identifier: MIT OR Apache-2.0
// The score of every region comes after its last word, and is the smallest one of its four sums. Regions have two rows of WORDS
// words. Frames are 4 regions wide and follow one another; words come with gaps of any length, and a reset at any clock.
module properties #(parameter WORDS = 1, parameter DEEP = 0) (
    input wire clk_i, rst_i, step, input wire [3:0] values
);
    `include "reset.vh"
    localparam SUM_BITS = 3;
    reg word = 1'b0, row = 1'b0;
    reg [1:0] column = 2'd0;
    wire segment_end = word == WORDS - 1;
    wire row_end = segment_end && column == 2'd3;
    always @(posedge clk_i) begin
        if (step) begin
            word <= segment_end ? 1'b0 : word + 1'b1;
            if (segment_end) column <= column + 2'd1;
            if (row_end) row <= !row;
        end
        if (rst_i) {word, column, row} <= 4'd0;
    end

    wire [SUM_BITS-1:0] score;
    raster_surface #(.VALUE_BITS(1), .SUM_BITS(SUM_BITS), .COLUMNS(4), .DEEP(DEEP)) dut (
        .clk_i(clk_i), .rst_i(rst_i), .step_i(step), .values_i(values), .segment_end_i(segment_end), .row_end_i(row_end),
        .region_top_i(!row), .score_o(score)
    );

    // The region of an arbitrary column.
    (* anyconst *) wire [1:0] place;
    reg [4*SUM_BITS-1:0] sums = 0;
    reg [4*SUM_BITS-1:0] now;
    reg [SUM_BITS-1:0] smallest;
    integer each;
    always @* begin
        now = !row && word == 1'b0 ? 0 : sums;
        for (each = 0; each < 4; each = each + 1)
            now[each*SUM_BITS+:SUM_BITS] = now[each*SUM_BITS+:SUM_BITS] + values[each];
        smallest = now[0+:SUM_BITS];
        for (each = 1; each < 4; each = each + 1)
            if (now[each*SUM_BITS+:SUM_BITS] < smallest) smallest = now[each*SUM_BITS+:SUM_BITS];
    end
    // The expected port: the score comes four clocks after the last values, with DEEP five.
    reg [3+DEEP:0] due = 0;
    reg [SUM_BITS*(4+DEEP)-1:0] scores = 0;
    always @(posedge clk_i) begin
        if (step && column == place) sums <= now;
        due <= rst_i ? 0 : {due, step && segment_end && row && column == place};
        scores <= {scores, smallest};
    end
    always @* if (started && due[3+DEEP]) assert(score == scores[SUM_BITS*(3+DEEP)+:SUM_BITS]);
endmodule
