// SPDX-License-Identifier: MIT OR Apache-2.0
// Adds up values of words over regions, all of them in parallel, as raster_counts.v counts hits. The regions of one row of
// regions are added up at a time. sums_o comes two clocks after the last values of a region, with DEEP three.
`default_nettype none

module raster_sums #(
    parameter VALUES = 1,       // number of values that are added up in parallel
    parameter VALUE_BITS = 8,   // bits of a value
    parameter SUM_BITS = 14,    // bits of the sum of a region
    parameter COLUMNS = 240,    // regions in a row of regions
    parameter COLUMN_BITS = 8,  // ceil(log2(COLUMNS))
    parameter DEEP = 0          // 0: sums come two clocks after the last values; 1: three clocks
) (
    input  wire                         clk_i,          // clock, rising edge
    input  wire                         rst_i,          // synchronous reset, active high
    input  wire                         step_i,         // the values of a word come in
    input  wire [VALUES*VALUE_BITS-1:0] values_i,       // values of that word
    input  wire                         segment_end_i,  // the word is the last of a row of its region
    input  wire                         row_end_i,      // the word is the last of its row of the frame
    input  wire                         region_top_i,   // the word is in the first row of its region
    output reg  [  VALUES*SUM_BITS-1:0] sums_o          // sums of the rows of a region so far
);

    // Limits: a value out of range stops elaboration at an instance of a module that does not exist.
    generate
        if (SUM_BITS < VALUE_BITS) begin : g_sum_bits SUM_BITS_must_be_VALUE_BITS_or_more u_refused (); end
        if (COLUMNS < 4) begin : g_columns COLUMNS_must_be_4_or_more u_refused (); end
    endgenerate

    reg [VALUES*SUM_BITS-1:0] row_q;
    reg fresh_q;  // the next word is the first of a row of its region
    reg ended_q, top_q;
    reg [COLUMN_BITS-1:0] column_q, old_column_q;
    // Each process has a loop variable of its own: tools take one that two of them share for a register with two drivers.
    integer value, each;

    always @(posedge clk_i) begin
        ended_q      <= step_i && segment_end_i && !rst_i;
        top_q        <= region_top_i;
        old_column_q <= column_q;
        if (step_i) begin
            fresh_q <= segment_end_i;
            for (value = 0; value < VALUES; value = value + 1)
                row_q[value*SUM_BITS+:SUM_BITS] <= (fresh_q ? {SUM_BITS{1'b0}} : row_q[value*SUM_BITS+:SUM_BITS])
                    + {{(SUM_BITS - VALUE_BITS) {1'b0}}, values_i[value*VALUE_BITS+:VALUE_BITS]};
            if (segment_end_i) column_q <= row_end_i ? {COLUMN_BITS{1'b0}} : column_q + 1'b1;
        end
        if (rst_i) begin
            fresh_q  <= 1'b1;
            column_q <= {COLUMN_BITS{1'b0}};
        end
    end

    wire [VALUES*SUM_BITS-1:0] above, row;
    wire ended, top;
    wire [COLUMN_BITS-1:0] column;
    reg written_q;
    reg [COLUMN_BITS-1:0] write_column_q;

    raster_memory #(
        .WIDTH(VALUES * SUM_BITS), .WORDS(COLUMNS), .ADDRESS_BITS(COLUMN_BITS), .OUTPUT_STAGE(DEEP)
    ) u_rows (
        .clk_i(clk_i), .write_i(written_q), .write_address_i(write_column_q), .data_i(sums_o),
        .read_i(1'b1), .read_address_i(column_q), .output_i(1'b1), .data_o(above)
    );
    bit_delay #(.DEPTH(DEEP)) u_ended (.clk_i(clk_i), .rst_i(rst_i), .bit_i(ended_q), .bit_o(ended));
    word_delay #(.WIDTH(VALUES * SUM_BITS + COLUMN_BITS + 1), .DEPTH(DEEP)) u_row (
        .clk_i(clk_i), .data_i({row_q, old_column_q, top_q}), .data_o({row, column, top})
    );

    always @(posedge clk_i) begin
        for (each = 0; each < VALUES; each = each + 1)
            sums_o[each*SUM_BITS+:SUM_BITS] <= row[each*SUM_BITS+:SUM_BITS]
                + (top ? {SUM_BITS{1'b0}} : above[each*SUM_BITS+:SUM_BITS]);
        written_q      <= ended && !rst_i;
        write_column_q <= column;
    end

endmodule

`default_nettype wire
