// SPDX-License-Identifier: MIT OR Apache-2.0
// raster_start gives the places of regions in order, in the buffer and in the frame, and raster_walk those of the words of a
// region, row by row, or with BLOCKS the means of its blocks. A walk begins at any clock, and ends with the last word or earlier.
module properties #(
    parameter LANES = 1, parameter SIDE = 2, parameter COLUMNS = 4, parameter ROWS = 3, parameter BANKS = 2,
    parameter SEGMENT_WORDS = SIDE / LANES, parameter ROW_WORDS = COLUMNS * SEGMENT_WORDS,
    parameter START_BITS = $clog2(BANKS * SIDE * ROW_WORDS), parameter PLACE_BITS = $clog2(ROWS * SIDE * ROW_WORDS),
    parameter POSITION_BITS = $clog2(SIDE * SIDE), parameter BLOCKS = 0
) (
    input wire clk_i, rst_i, next_region, begins, next_word, means, input wire [START_BITS-1:0] from
);
    `include "reset.vh"
    wire [2:0] row_of_regions;
    wire [START_BITS-1:0] start;
    wire [PLACE_BITS-1:0] place;
    raster_start #(
        .COLUMNS(COLUMNS), .ROWS(ROWS), .SEGMENT_WORDS(SEGMENT_WORDS), .SIDE(SIDE), .BANKS(BANKS), .START_BITS(START_BITS),
        .FRAME(1), .PLACE_BITS(PLACE_BITS)
    ) u_start (
        .clk_i(clk_i), .rst_i(rst_i), .step_i(next_region), .row_o(row_of_regions), .start_o(start), .place_o(place)
    );
    wire [START_BITS-1:0] word;
    wire [POSITION_BITS-1:0] position;
    wire first, segment_end, last;
    wire [3:0] mean;
    reg walks_means = 1'b0;
    raster_walk #(
        .LANES(LANES), .SIDE(SIDE), .SEGMENT_WORDS(SEGMENT_WORDS), .POSITION_BITS(POSITION_BITS), .ROW_WORDS(ROW_WORDS),
        .PLACE_BITS(START_BITS), .BLOCKS(BLOCKS), .MEAN_BITS(4)
    ) u_walk (
        .clk_i(clk_i), .begin_i(begins), .start_i(from), .step_i(next_word), .means_i(walks_means), .mean_o(mean), .place_o(word), .position_o(position),
        .first_o(first), .segment_end_o(segment_end), .last_o(last)
    );

    // The region: its column, its row in the frame and in the buffer, and its row counted through all frames, modulo 8.
    reg [2:0] column = 0, row = 0, bank = 0, count = 0;
    // The word of the region, and the place where the walk began.
    reg walks = 1'b0;
    reg [4:0] number = 0;
    reg [START_BITS-1:0] origin = 0;
    always @(posedge clk_i) begin
        if (next_region) begin
            column <= column == COLUMNS - 1 ? 3'd0 : column + 3'd1;
            if (column == COLUMNS - 1) begin
                row   <= row == ROWS - 1 ? 3'd0 : row + 3'd1;
                bank  <= bank == BANKS - 1 ? 3'd0 : bank + 3'd1;
                count <= count + 3'd1;
            end
        end
        if (rst_i) {column, row, bank, count} <= 12'd0;
        if (begins) begin
            walks  <= 1'b1;
            walks_means <= BLOCKS > 0 && means;
            number <= 5'd0;
            origin <= from;
        end else if (next_word) number <= number + 5'd1;
    end
    localparam BLOCK = BLOCKS > 0 ? SIDE / BLOCKS : 1;
    wire [START_BITS-1:0] walked = origin + (number / SEGMENT_WORDS) * ROW_WORDS + number % SEGMENT_WORDS;
    always @* begin
        if (walks && last) assume(!next_word || begins);
        if (started) begin
            assert(start == bank * SIDE * ROW_WORDS + column * SEGMENT_WORDS);
            assert(place == row * SIDE * ROW_WORDS + column * SEGMENT_WORDS);
            assert(row_of_regions == count);
        end
        if (walks && walks_means) begin
            assert(BLOCKS == 1 || mean == number);
            assert(position == number / BLOCKS * BLOCK * SIDE + number % BLOCKS * BLOCK);
            assert(first == (number == 0));
            assert(last == (number == BLOCKS * BLOCKS - 1));
        end
        if (walks && !walks_means) begin
            assert(word == walked);
            assert(position == number * LANES);
            assert(first == (number == 0));
            assert(segment_end == (number % SEGMENT_WORDS == SEGMENT_WORDS - 1));
            assert(last == (number == SIDE * SEGMENT_WORDS - 1));
        end
    end
endmodule
