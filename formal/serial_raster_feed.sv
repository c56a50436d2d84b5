// SPDX-License-Identifier: MIT OR Apache-2.0
// The places of the pixels of a frame that enters row by row. An arbitrary place (a region, a word of its square) is watched: a write
// there is of the pixel that the padded frame shows there, and each frame writes it once. Also: the feed is ready until the last
// pixel is taken, not while a pixel has places left, and no place is outside the areas.
module properties #(
    parameter SIDE = 4, parameter HALO = 0, parameter COLUMNS = 2, parameter ROWS = 2, parameter FOLD = 1
) (
    input wire clk_i, reopen
);
    reg started = 1'b0;
    always @(posedge clk_i) started <= 1'b1;
    wire rst_i = !started, valid = 1'b1;
    localparam STRIDE = SIDE + 2 * HALO, WORDS = STRIDE * STRIDE, REGIONS = COLUMNS * ROWS;
    localparam LANES = (REGIONS + FOLD - 1) / FOLD;
    localparam WORD_BITS = $clog2(WORDS), SLOT_BITS = FOLD > 1 ? $clog2(FOLD) : 1, LANE_BITS = LANES > 1 ? $clog2(LANES) : 1;
    wire ready, take, place, last;
    wire [LANE_BITS-1:0] lane;
    wire [SLOT_BITS-1:0] slot;
    wire [WORD_BITS-1:0] word;
    serial_raster_feed #(
        .SIDE(SIDE), .HALO(HALO), .COLUMNS(COLUMNS), .ROWS(ROWS), .FOLD(FOLD), .WORD_BITS(WORD_BITS),
        .SLOT_BITS(SLOT_BITS), .LANE_BITS(LANE_BITS)
    ) dut (
        .clk_i(clk_i), .rst_i(rst_i), .valid_i(valid), .reopen_i(reopen), .ready_o(ready), .take_o(take),
        .place_o(place), .last_o(last), .lane_o(lane), .slot_o(slot), .word_o(word)
    );
    // The frame, pixel by pixel.
    reg [5:0] x, y;  // place of the next pixel, or of the one that has places left
    reg [7:0] placed;  // number of places that it had before this clock
    wire [7:0] wanted = shows(x, COLUMNS) * shows(y, ROWS);
    wire moves = placed == wanted - 1;
    reg closed;      // all pixels have all places
    wire last_pixel = x == COLUMNS * SIDE - 1 && y == ROWS * SIDE - 1;
    always @* if (started && !closed) assume(!reopen);  // the sequencer reopens only a closed feed
    // The pixel of the padded frame that belongs to the watched place.
    (* anyconst *) reg [5:0] column, row, across, down;
    always @* assume(column < COLUMNS && row < ROWS && across < STRIDE && down < STRIDE);
    wire [7:0] plain_x = column * SIDE + across, plain_y = row * SIDE + down;  // coordinates plus HALO
    wire [7:0] shown_x = plain_x < HALO ? 0 : plain_x - HALO >= COLUMNS * SIDE ? COLUMNS * SIDE - 1 : plain_x - HALO;
    wire [7:0] shown_y = plain_y < HALO ? 0 : plain_y - HALO >= ROWS * SIDE ? ROWS * SIDE - 1 : plain_y - HALO;
    wire [7:0] region = row * COLUMNS + column;
    wire here = place && lane == region / FOLD && slot == region % FOLD && word == down * STRIDE + across;
    reg written;
    always @(posedge clk_i) begin
        if (rst_i) begin
            x       <= 0;
            y       <= 0;
            closed  <= 0;
            written <= 0;
        end else begin
            if (here) written <= 1;
            if (place && moves) begin
                x <= x == COLUMNS * SIDE - 1 ? 0 : x + 1;
                if (x == COLUMNS * SIDE - 1) y <= last_pixel ? 0 : y + 1;
                if (last_pixel) closed <= 1;
            end
            if (closed && reopen) begin
                closed  <= 0;
                written <= 0;
            end
        end
    end
    // The number of places of a pixel, c(x) * c(y) of docs/serial.md, counted over the regions and their squares.
    function integer shows(input [7:0] at, input integer regions);
        integer r, w, p;
        begin
            shows = 0;
            for (r = 0; r < regions; r = r + 1) for (w = 0; w < STRIDE; w = w + 1) begin
                p = r * SIDE + w - HALO;
                p = p < 0 ? 0 : p >= regions * SIDE ? regions * SIDE - 1 : p;
                if (p == at) shows = shows + 1;
            end
        end
    endfunction
    always @(posedge clk_i) begin
        if (rst_i) placed <= 0;
        else if (place) placed <= moves ? 0 : placed + 1;
    end
    always @* if (started) begin
        assert(ready == (!closed && placed == 0));
        assert(take == (ready && valid));
        assert(place == (take || placed != 0));
        assert(last == (place && moves && last_pixel));
        if (place) assert(lane < LANES && slot < FOLD && word < WORDS && lane * FOLD + slot < REGIONS);
        if (here) assert(!written && x == shown_x && y == shown_y);
        if (closed) assert(written);
    end
endmodule
