// SPDX-License-Identifier: MIT OR Apache-2.0
// Words of frames of ROWS x COLUMNS regions come row by row, with gaps and resets. For each of them raster_blocks gives the place
// in its block, the block, the region, and the row of regions, counted through all frames.
module properties #(
    parameter LANES = 1, parameter SIDE = 4, parameter BLOCKS = 2, parameter COLUMNS = 3, parameter ROWS = 2,
    parameter REGION_BITS = $clog2(COLUMNS * ROWS)
) (
    input wire clk_i, rst_i, step
);
    `include "reset.vh"
    localparam SEGMENT = SIDE / LANES, ROW_WORDS = COLUMNS * SEGMENT, BLOCK = SIDE / BLOCKS, WORDS = BLOCK / LANES;
    reg [3:0] word = 0;   // number of the word in its row
    reg [3:0] row = 0;    // number of the row in the frame
    reg [1:0] count = 0;  // number of rows of regions so far
    wire row_end = word == ROW_WORDS - 1;
    wire frame_end = row_end && row == ROWS * SIDE - 1;
    wire start, ends, upper, lower, over;
    wire [1:0] column, line, row_of_regions;
    wire [REGION_BITS-1:0] region;
    raster_blocks #(
        .LANES(LANES), .SIDE(SIDE), .BLOCKS(BLOCKS), .COLUMNS(COLUMNS), .REGIONS(COLUMNS * ROWS), .REGION_BITS(REGION_BITS)
    ) dut (
        .clk_i(clk_i), .rst_i(rst_i), .step_i(step), .row_end_i(row_end), .start_o(start), .end_o(ends), .upper_o(upper),
        .lower_o(lower), .column_o(column), .line_o(line), .region_o(region), .row_o(row_of_regions), .frame_end_o(over)
    );
    always @(posedge clk_i) begin
        if (step) begin
            word <= row_end ? 4'd0 : word + 4'd1;
            if (row_end) row <= frame_end ? 4'd0 : row + 4'd1;
            if (row_end && row % SIDE == SIDE - 1) count <= count + 2'd1;
        end
        if (rst_i) {word, row, count} <= 10'd0;
    end
    always @* if (started) begin
        assert(start == (word % WORDS == 0));
        assert(ends == (word % WORDS == WORDS - 1));
        assert(upper == (row % BLOCK == 0));
        assert(lower == (row % BLOCK == BLOCK - 1));
        assert(column == word % SEGMENT / WORDS);
        assert(line == row % SIDE / BLOCK);
        assert(region == row / SIDE * COLUMNS + word / SEGMENT);
        assert(row_of_regions == count);
        assert(over == (step && frame_end));
    end
endmodule
