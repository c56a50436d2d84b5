// SPDX-License-Identifier: MIT OR Apache-2.0
// Computes the largest minus the smallest pixel of every region, as raster_sums.v computes sums. The regions of one row of
// regions are worked on at a time. range_o comes three clocks after the last word of a region, with DEEP four.
`default_nettype none

module raster_range #(
    parameter WIDTH = 8,     // bits of a pixel
    parameter LANES = 1,     // pixels of a word
    parameter COLUMNS = 240, // regions in a row of regions
    parameter DEEP = 0       // 0: the range comes three clocks after the last word; 1: four clocks
) (
    input  wire                   clk_i,          // clock, rising edge
    input  wire                   rst_i,          // synchronous reset, active high
    input  wire [LANES*WIDTH-1:0] word_i,         // a word, which comes two clocks before its step
    input  wire                   step_i,         // the word is taken at this edge
    input  wire                   segment_end_i,  // the word is the last of a row of its region
    input  wire                   row_end_i,      // the word is the last of its row of the frame
    input  wire                   region_top_i,   // the word is in the first row of its region
    output reg  [      WIDTH-1:0] range_o         // range of the rows of a region so far
);

    // Limits: a value out of range stops elaboration at an instance of a module that does not exist.
    generate
        if (COLUMNS < 4) begin : g_columns COLUMNS_must_be_4_or_more u_refused (); end
    endgenerate

    localparam COLUMN_BITS = $clog2(COLUMNS);
    integer lane;

    // The extremes of a word.
    reg [WIDTH-1:0] word_low, word_high, word_low_q, word_high_q, word_low_2q, word_high_2q;
    always @* begin
        word_low  = word_i[WIDTH-1:0];
        word_high = word_i[WIDTH-1:0];
        for (lane = 1; lane < LANES; lane = lane + 1) begin
            word_low  = word_i[lane*WIDTH+:WIDTH] < word_low ? word_i[lane*WIDTH+:WIDTH] : word_low;
            word_high = word_i[lane*WIDTH+:WIDTH] > word_high ? word_i[lane*WIDTH+:WIDTH] : word_high;
        end
    end
    always @(posedge clk_i) begin
        {word_low_q, word_high_q}   <= {word_low, word_high};
        {word_low_2q, word_high_2q} <= {word_low_q, word_high_q};
    end

    // The extremes of the current row of a region.
    reg [WIDTH-1:0] row_low_q, row_high_q;
    reg fresh_q;  // the next word is the first of a row of its region
    reg ended_q, top_q;
    reg [COLUMN_BITS-1:0] column_q, old_column_q;

    always @(posedge clk_i) begin
        ended_q      <= step_i && segment_end_i && !rst_i;
        top_q        <= region_top_i;
        old_column_q <= column_q;
        if (step_i) begin
            fresh_q <= segment_end_i;
            if (fresh_q || word_low_2q < row_low_q) row_low_q <= word_low_2q;
            if (fresh_q || word_high_2q > row_high_q) row_high_q <= word_high_2q;
            if (segment_end_i) column_q <= row_end_i ? {COLUMN_BITS{1'b0}} : column_q + 1'b1;
        end
        if (rst_i) begin
            fresh_q  <= 1'b1;
            column_q <= {COLUMN_BITS{1'b0}};
        end
    end

    // The extremes of the rows above it.
    wire [WIDTH-1:0] low_above, high_above, row_low, row_high;
    wire ended, top;
    wire [COLUMN_BITS-1:0] column;
    reg [WIDTH-1:0] low_q, high_q;
    reg written_q;
    reg [COLUMN_BITS-1:0] write_column_q;

    raster_memory #(
        .WIDTH(2 * WIDTH), .WORDS(COLUMNS), .ADDRESS_BITS(COLUMN_BITS), .OUTPUT_STAGE(DEEP)
    ) u_rows (
        .clk_i(clk_i), .write_i(written_q), .write_address_i(write_column_q), .data_i({low_q, high_q}),
        .read_i(1'b1), .read_address_i(column_q), .output_i(1'b1), .data_o({low_above, high_above})
    );
    bit_delay #(.DEPTH(DEEP)) u_ended (.clk_i(clk_i), .rst_i(rst_i), .bit_i(ended_q), .bit_o(ended));
    word_delay #(.WIDTH(2 * WIDTH + COLUMN_BITS + 1), .DEPTH(DEEP)) u_row (
        .clk_i(clk_i), .data_i({row_low_q, row_high_q, old_column_q, top_q}), .data_o({row_low, row_high, column, top})
    );

    always @(posedge clk_i) begin
        low_q          <= top || row_low < low_above ? row_low : low_above;
        high_q         <= top || row_high > high_above ? row_high : high_above;
        written_q      <= ended && !rst_i;
        write_column_q <= column;
        range_o        <= high_q - low_q;
    end

endmodule

`default_nettype wire
