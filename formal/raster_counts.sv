// SPDX-License-Identifier: MIT OR Apache-2.0
// Every region is counted once, after its last row, and its count has all its hits. Frames are 4 regions wide and follow one
// another; words come with gaps of any length, and a reset at any clock.
module properties #(
    parameter LANES = 1, parameter SIDE = 2, parameter DEEP = 0,
    parameter COUNT_BITS = $clog2(SIDE * SIDE + 1)
) (
    input wire clk_i, rst_i, step, input wire [LANES-1:0] hits
);
    `include "reset.vh"
    localparam WORDS = SIDE / LANES;  // words of a row of a region
    reg [1:0] word = 2'd0, column = 2'd0, row = 2'd0;
    wire segment_end = word == WORDS - 1;
    wire row_end = segment_end && column == 2'd3;
    wire bottom = row == SIDE - 1;
    always @(posedge clk_i) begin
        if (step) begin
            word <= segment_end ? 2'd0 : word + 2'd1;
            if (segment_end) column <= column + 2'd1;
            if (row_end) row <= bottom ? 2'd0 : row + 2'd1;
        end
        if (rst_i) {word, column, row} <= 6'd0;
    end

    wire done;
    wire [COUNT_BITS-1:0] count;
    raster_counts #(
        .LANES(LANES), .FEATURES(1), .SIDE(SIDE), .COUNT_BITS(COUNT_BITS), .COLUMNS(4), .COLUMN_BITS(2), .DEEP(DEEP)
    ) dut (
        .clk_i(clk_i), .rst_i(rst_i), .step_i(step), .hits_i(hits), .segment_end_i(segment_end), .row_end_i(row_end),
        .region_top_i(row == 2'd0), .region_bottom_i(bottom), .done_o(done), .counts_o(count)
    );

    // The region of an arbitrary column.
    (* anyconst *) wire [1:0] place;
    reg [COUNT_BITS-1:0] total = 0;
    reg [COUNT_BITS-1:0] now;
    integer lane;
    always @* begin
        now = row == 2'd0 && word == 2'd0 ? 0 : total;
        for (lane = 0; lane < LANES; lane = lane + 1) now = now + hits[lane];
    end
    // The expected ports, and the column that they belong to.
    reg [1+DEEP:0] due = 0, ours = 0;
    reg [(2+DEEP)*COUNT_BITS-1:0] counts = 0;
    always @(posedge clk_i) begin
        if (step && column == place) total <= now;
        due <= rst_i ? 0 : {due[DEEP:0], step && segment_end && bottom};
        ours <= {ours[DEEP:0], column == place};
        counts <= {counts[(1+DEEP)*COUNT_BITS-1:0], now};
    end
    always @* if (started) begin
        assert(done == due[1+DEEP]);
        if (done && ours[1+DEEP]) assert(count == counts[(1+DEEP)*COUNT_BITS+:COUNT_BITS]);
    end
endmodule
